//! The report about an answer: the same fields on the terminal, beside pictures and in the tour.

pub(crate) mod ball;
pub(crate) mod centers;
pub(crate) mod curve;
pub(crate) mod dop;
pub(crate) mod ellipsoid;
pub(crate) mod inscribed;
pub(crate) mod kernel_ball;
pub(crate) mod order;
pub(crate) mod robust;
pub(crate) mod surface;
pub(crate) mod triangulation;

use anyhow::bail;
use taut::certify::Answer;
use taut::certify::Stop;
use taut::{Items, PointSource, Solution};
use taut_draw::Figures;

use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::numbers::{abridged, coordinates, count, counted, gap};
use crate::output::picture::{self, Drawing, PictureOptions};

/// An answer, the points it belongs to, and what the checker proved (`None` where it was not asked).
pub(crate) struct Report<'a, A: Answer> {
    pub(crate) found: &'a Solution<A>,
    pub(crate) points: &'a Opened,
    pub(crate) verdict: Option<A::Verdict>,
}

/// The report and the pictures of one kind of answer.
pub(crate) trait Summary: Answer + Figures {
    /// The name in messages of an answer that no file holds yet.
    const FOUND: &'static str;

    /// Returns one line that names the answer.
    fn title(report: &Report<'_, Self>) -> String;

    /// The numbers, each with its name.
    fn fields(report: &Report<'_, Self>) -> Vec<Field>;

    /// Coordinates of a place.
    fn dim(report: &Report<'_, Self>) -> usize;

    /// Why the answer has no picture, if it has none.
    fn no_picture(_found: &Solution<Self>) -> Option<&'static str> {
        None
    }

    /// Returns what the checker found to be so.
    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims;
}

impl<A: Summary> Report<'_, A> {
    pub(crate) fn title(&self) -> String {
        A::title(self)
    }

    pub(crate) fn fields(&self) -> Vec<Field> {
        A::fields(self)
    }

    /// Pictures and what stands beside them.
    pub(crate) fn drawing(&self, style: &PictureOptions) -> anyhow::Result<Drawing> {
        if let Some(why) = A::no_picture(self.found) {
            bail!(why)
        }
        let options = style.options(self.points.names(A::dim(self)));
        let figures = A::figures(self.found, self.points.source(), &options)
            .map_err(|error| picture::refused(error, self.points))?;
        Ok(Drawing {
            title: self.title(),
            heading: self.points.name().to_owned(),
            fields: self.fields().into_iter().map(picture::field).collect(),
            figures,
        })
    }
}

/// A number with its name, and what there is to say about it where there is room for words.
#[derive(Clone)]
pub(crate) struct Field {
    pub(crate) name: &'static str,
    pub(crate) value: String,
    pub(crate) remark: Option<String>,
    /// The strength of the evidence for it; `None` for what is only told.
    pub(crate) standing: Option<EvidenceKind>,
    /// The rows that the remark names, from 0.
    pub(crate) rows: Vec<u64>,
}

/// The strength of the evidence for a claim: `docs/certificates.md` says for each why.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum EvidenceKind {
    /// Derived from the input and the certificate alone.
    Proved,
    /// Found in the data by a test that can be wrong.
    Evidence,
}

impl EvidenceKind {
    fn word(self) -> &'static str {
        match self {
            EvidenceKind::Proved => "proved",
            EvidenceKind::Evidence => "evidence",
        }
    }
}

impl Field {
    pub(crate) fn new(name: &'static str, value: impl Into<String>) -> Self {
        Field { name, value: value.into(), remark: None, standing: None, rows: vec![] }
    }

    /// A claim that the checker derived.
    pub(crate) fn proved(name: &'static str, value: impl Into<String>) -> Self {
        Field { standing: Some(EvidenceKind::Proved), ..Field::new(name, value) }
    }

    /// A claim that a test found likely.
    pub(crate) fn evidence(name: &'static str, value: impl Into<String>) -> Self {
        Field { standing: Some(EvidenceKind::Evidence), ..Field::new(name, value) }
    }

    pub(crate) fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = Some(remark.into());
        self
    }
}

/// The findings of a checker about an answer: their subject in one line, and claim by claim.
pub(crate) struct Claims {
    /// The answer, the inputs that it is about and how many of them, and the options it rests on.
    pub(crate) what: String,
    /// The gap proved, for answers that have one.
    pub(crate) gap: Option<f64>,
    pub(crate) fields: Vec<Field>,
}

impl Claims {
    /// All of it as text, the gap in the first line.
    pub(crate) fn text(&self) -> String {
        let within = match self.gap {
            Some(proved) => format!("Verified within a gap of {}", gap(proved)),
            None => "Verified".to_owned(),
        };
        text(&format!("{within}: {}", self.what), &self.fields)
    }
}

/// Returns how many inputs there are, of which kind, and in how many dimensions: "5,000 points in 3 dimensions".
pub(crate) fn inputs(items: Items, rows: u64, columns: usize) -> String {
    let dim = counted(items.dim(columns) as u64, "dimension");
    format!("{} in {dim}", counted(rows, noun(items)))
}

/// Says which part of the rows a claim is about, where outliers are left out of it: "200 of 400 points; 200 (50 %) are …".
pub(crate) fn without_outliers(used: u64, rows: u64, outliers: u64, place: &str) -> String {
    let about = match used == rows {
        true => format!("{} {place}", counted(rows, "point")),
        false => format!("{} of {} {place}", count(used), counted(rows, "point")),
    };
    match outliers {
        0 => about,
        _ => format!("{about}; {} left out as {}", share(outliers, rows), plural(outliers)),
    }
}

/// "yes", and of how many points where outliers are left out of the claim.
pub(crate) fn yes_without_outliers(rows: u64, outliers: u64) -> String {
    match outliers {
        0 => "yes".to_owned(),
        _ => format!("yes, of {} of {}", count(rows - outliers), counted(rows, "point")),
    }
}

fn plural(outliers: u64) -> &'static str {
    if outliers == 1 { "an outlier" } else { "outliers" }
}

/// A number of rows and which part of all rows that is: "200 (50 %)".
pub(crate) fn share(some: u64, all: u64) -> String {
    if some == 0 {
        return "none".to_owned();
    }
    let percent = 100.0 * some as f64 / all.max(1) as f64;
    let percent = match percent {
        small if small < 0.1 => "less than 0.1".to_owned(),
        nearly if some < all && nearly > 99.0 => format!("more than {:.0}", nearly.floor()),
        small if small < 10.0 => format!("{small:.1}"),
        large => format!("{large:.0}"),
    };
    format!("{} ({percent} %)", count(some))
}

pub(crate) fn noun(items: Items) -> &'static str {
    match items {
        Items::Points => "point",
        Items::Balls => "ball",
        Items::Ellipsoids => "ellipsoid",
    }
}

/// The center beside a size, with a word on what is left out of many coordinates.
pub(crate) fn center(center: &[f64], size: f64) -> Field {
    let mut field = Field::new("center", coordinates(center, size));
    if abridged(center) {
        field.value += &format!(" {} in all", count(center.len() as u64));
        field = field.remark("the JSON holds them (-o FILE)");
    }
    field
}

/// The numbers of at most this many rows are shown.
const SHOWN_ROWS_MAX: usize = 8;

/// Returns how many rows there are, and the numbers of the first, counted from 1 as in the file.
pub(crate) fn rows_of(name: &'static str, rows: &[u64]) -> Field {
    let mut field = Field::new(name, count(rows.len() as u64));
    field.rows = rows.to_vec();
    field.remark = remark_of_rows(rows, |row| row.saturating_add(1).to_string());
    field
}

/// Names the first of some rows; `None` where there are none.
pub(crate) fn remark_of_rows(rows: &[u64], name: impl Fn(u64) -> String) -> Option<String> {
    let named: Vec<String> = rows.iter().take(SHOWN_ROWS_MAX).map(|&row| name(row)).collect();
    let more =
        if rows.len() > SHOWN_ROWS_MAX { ", …; the JSON holds them (-o FILE)" } else { "" };
    match named.len() {
        0 => None,
        1 => Some(format!("row {}", named[0])),
        _ => Some(format!("rows {}{more}", named.join(", "))),
    }
}

/// The gap, as proved (then with what that means) or as the solver says; and which of the two it is.
pub(crate) fn gap_and_verified(
    proved: Option<(f64, String)>,
    claimed: f64,
    verified: String,
) -> [Field; 2] {
    match proved {
        Some((proved, meaning)) => [
            Field::new("gap", gap(proved)).remark(meaning),
            Field::new("verified", "yes").remark(verified),
        ],
        None => [
            Field::new("gap", gap(claimed)).remark("as the solver says"),
            Field::new("verified", "not checked"),
        ],
    }
}

pub(crate) fn stopped(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Rounding => "stopped where this method's rounding allows no smaller gap",
        Stop::PassBudget => "stopped early by the budget of passes",
        Stop::NodeBudget => "stopped early by the budget of nodes",
        Stop::ProofBudget => "the proof of a smaller gap takes more nodes than are granted",
    }
}

/// Title and fields as text, a field a line, the values in one column.
pub(crate) fn text(title: &str, fields: &[Field]) -> String {
    let width = fields.iter().map(|field| field.name.len() + 1).max().unwrap_or(0).max(10);
    let lines = fields.iter().map(|Field { name, value, remark, standing, .. }| {
        let said = match (standing, remark) {
            (Some(standing), Some(remark)) => format!("; {}: {remark}", standing.word()),
            (Some(standing), None) => format!("; {}", standing.word()),
            (None, Some(remark)) => format!("; {remark}"),
            (None, None) => String::new(),
        };
        format!("  {name:<width$}{value}{said}\n")
    });
    std::iter::once(format!("{title}\n")).chain(lines).collect()
}

/// Tests whether a run that asked for the gap `epsilon`, stopped for that reason and has the gap `gap` got what it asked for.
pub(crate) fn outcome(stop: Stop, gap: f64, epsilon: f64) -> Outcome {
    match stop {
        Stop::PassBudget | Stop::NodeBudget | Stop::ProofBudget => Outcome::StoppedEarly,
        // ε = 0 asks for what rounding allows, and has it; a positive ε is a promise that was not kept.
        Stop::Rounding if epsilon > 0.0 && gap > epsilon => Outcome::StoppedEarly,
        Stop::Rounding | Stop::Converged => Outcome::Done,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_promise_that_was_not_kept_is_no_success() {
        for (stop, epsilon, expected) in [
            (Stop::Converged, 1e-9, Outcome::Done),
            (Stop::Converged, 0.0, Outcome::Done),
            (Stop::Rounding, 0.0, Outcome::Done),
            (Stop::Rounding, 1e-9, Outcome::Done),
            (Stop::Rounding, 1e-15, Outcome::StoppedEarly),
            (Stop::PassBudget, 1e-9, Outcome::StoppedEarly),
            (Stop::NodeBudget, 1e-9, Outcome::StoppedEarly),
            (Stop::ProofBudget, 1e-9, Outcome::StoppedEarly),
        ] {
            assert_eq!(outcome(stop, 1e-12, epsilon), expected, "{stop:?} with ε = {epsilon}");
        }
    }
}
