//! The words about an answer: the same fields on the terminal, beside pictures, in the tour and in the browser.
//!
//! A [`Report`] tells what was found, [`Claims`] what a checker proved. [`text`] prints either, a field a line. There is one
//! [`Summary`] for each kind of answer.
//!
//! ```
//! use taut::{BallOptions, Points, ball};
//! use taut_report::{Report, Summary, text};
//!
//! let points = Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;
//! let found = ball(&points, &BallOptions::default())?;
//! let verdict = found.check(&points)?;
//! let claims = Summary::claims(&found, &verdict, &points).text();
//! assert!(claims.contains("ball of radius 1 around 3 points in 2 dimensions\n"), "{claims}");
//! assert!(claims.contains("≤ smallest radius ≤ 1; proved\n"), "{claims}");
//! let report = Report { found: &found, points: &points, verdict: Some(verdict) };
//! let printed = text(&report.title(), &report.fields());
//! assert!(printed.starts_with("Smallest ball around 3 points in 2 dimensions\n  radius    1\n"), "{printed}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod ball;
pub mod bodies;
mod centers;
mod circle;
mod convex;
mod curve;
mod dop;
mod ellipse;
mod ellipsoid;
mod inscribed;
mod kernel_ball;
pub mod numbers;
mod order;
mod oriented;
mod pictures;
mod rectangle;
mod robust;
pub mod surface;
mod triangle;
pub mod triangulation;

use taut::certify::Answer;
use taut::certify::Stop;
use taut::{Items, PointSource, Solution};
use taut_draw::Figures;

use crate::numbers::{abridged, coordinates, count, counted, gap};

pub use pictures::worth_drawing;

/// An answer, the points it belongs to, and what the checker proved (`None` where it was not asked).
pub struct Report<'a, A: Answer> {
    /// The answer.
    pub found: &'a Solution<A>,
    /// The points.
    pub points: &'a dyn PointSource,
    /// The finding of the checker.
    pub verdict: Option<A::Verdict>,
}

/// The report and the pictures of one kind of answer.
pub trait Summary: Answer + Figures {
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
    /// Returns one line that names the answer.
    pub fn title(&self) -> String {
        A::title(self)
    }

    /// Returns the numbers, each with its name.
    pub fn fields(&self) -> Vec<Field> {
        A::fields(self)
    }
}

/// A number with its name, and what there is to say about it where there is room for words.
#[derive(Clone, Debug)]
pub struct Field {
    /// The name of the number.
    pub name: &'static str,
    /// The number, as people read it.
    pub value: String,
    /// Further words.
    pub remark: Option<String>,
    /// The strength of the evidence for it; `None` for what is only told.
    pub standing: Option<EvidenceKind>,
    /// The rows that the remark names, from 0.
    pub rows: Vec<u64>,
}

/// The strength of the evidence for a claim: `docs/certificates.md` says for each why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EvidenceKind {
    /// Derived from the input and the certificate alone.
    Proved,
    /// Found in the data by a test that can be wrong.
    Evidence,
}

impl EvidenceKind {
    /// Returns the word that stands before a remark.
    pub fn word(self) -> &'static str {
        match self {
            EvidenceKind::Proved => "proved",
            EvidenceKind::Evidence => "evidence",
        }
    }
}

impl Field {
    /// What is only told.
    pub fn new(name: &'static str, value: impl Into<String>) -> Self {
        Field { name, value: value.into(), remark: None, standing: None, rows: vec![] }
    }

    /// A claim that the checker derived.
    pub fn proved(name: &'static str, value: impl Into<String>) -> Self {
        Field { standing: Some(EvidenceKind::Proved), ..Field::new(name, value) }
    }

    /// A claim that a test found likely.
    pub fn evidence(name: &'static str, value: impl Into<String>) -> Self {
        Field { standing: Some(EvidenceKind::Evidence), ..Field::new(name, value) }
    }

    /// The same field with a remark.
    pub fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = Some(remark.into());
        self
    }
}

/// The findings of a checker about an answer: their subject in one line, and claim by claim.
pub struct Claims {
    /// The answer, the inputs that it is about and how many of them, and the options it rests on.
    pub what: String,
    /// The gap proved, for answers that have one.
    pub gap: Option<f64>,
    /// The claims.
    pub fields: Vec<Field>,
}

impl Claims {
    /// All of it as text, the gap in the first line.
    pub fn text(&self) -> String {
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
pub fn share(some: u64, all: u64) -> String {
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

/// Returns what a row is called.
pub fn noun(items: Items) -> &'static str {
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
pub fn remark_of_rows(rows: &[u64], name: impl Fn(u64) -> String) -> Option<String> {
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

/// Says why a solver stopped.
pub fn stopped(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Rounding => "stopped where this method's rounding allows no smaller gap",
        Stop::PassBudget => "stopped early by the budget of passes",
        Stop::NodeBudget => "stopped early by the budget of nodes",
        Stop::ProofBudget => "the proof of a smaller gap takes more nodes than are granted",
    }
}

/// Title and fields as text, a field a line, the values in one column.
pub fn text(title: &str, fields: &[Field]) -> String {
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
