//! `taut centers --elbow`: the radius for each of a range of k, as a table, a file and a plot.
//!
//! *Idea.* Centers for k are centers for k + 1, and what no k + 1 balls can do no k can: searches that were stopped are mended by
//! those beside them, so that neither the radius nor the bound ever rises with k. A radius of 0 ends the range.

use anyhow::bail;
use taut::certify::Centers;
use taut::certify::Stop;
use taut::{CentersOptions, Items, Solution, centers};
use taut_draw::{ElbowStep, elbow_figure};
use taut_io::{Column, Format, Table};

use crate::clock::Clock;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::numbers::{count, counted, exact, gap, short};
use crate::output::picture::{self, Drawing, PictureOptions};
use crate::output::tables::{self, is_table};
use crate::output::writing::{Outputs, names_json};
use crate::pipeline::{Input, Output, check};
use crate::reports::{self, Field, noun};
use crate::watch::Watch;

/// From the first k to the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    first: usize,
    last: usize,
}

/// Most values of k in a range: more make no plot, and each is a search of its own.
const STEPS_MOST: usize = 1000;

/// Reads `2..8`.
pub(crate) fn range(text: &str) -> Result<Range, String> {
    let ends = text.split_once("..").and_then(|(first, last)| {
        Some(Range { first: first.trim().parse().ok()?, last: last.trim().parse().ok()? })
    });
    let range = ends
        .filter(|range| 1 <= range.first && range.first <= range.last)
        .ok_or("expected two whole numbers from 1, the smaller first, such as 2..8")?;
    match range.last - range.first < STEPS_MOST {
        true => Ok(range),
        false => Err(format!("expected at most {STEPS_MOST} values of k, such as 2..8")),
    }
}

/// The result for one k.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    step: ElbowStep,
    /// Why the search for this k ended.
    stop: Stop,
    nodes: u64,
    core_set: usize,
}

impl Row {
    fn of(k: usize, found: &Solution<Centers>) -> Self {
        let (radius, lower_bound) = (found.answer.radius, found.answer.lower_bound);
        Row {
            step: ElbowStep { k: k as u64, radius, lower_bound },
            stop: found.trace.stop,
            nodes: found.trace.iterations,
            core_set: found.certificate.core_set.len(),
        }
    }

    /// The relative gap, rounded up, where there is a bound to have one.
    fn gap(&self) -> Option<f64> {
        let ElbowStep { radius, lower_bound, .. } = self.step;
        match (radius == lower_bound, lower_bound > 0.0) {
            (true, _) => Some(0.0),
            (false, true) => Some(((radius / lower_bound).next_up() - 1.0).next_up()),
            (false, false) => None,
        }
    }

    /// Tests whether this k has the gap that was asked for; a search beside it may have helped.
    fn ended(&self, epsilon: f64) -> Outcome {
        match self.gap() {
            Some(gap) if gap <= epsilon => Outcome::Done,
            gap => reports::outcome(self.stop, gap.unwrap_or(f64::MAX), epsilon),
        }
    }
}

/// Gives each k what those beside it have proved for it: the radius of fewer centers, the bound of more.
fn carry_over(rows: &mut [Row]) {
    for i in 1..rows.len() {
        rows[i].step.radius = rows[i].step.radius.min(rows[i - 1].step.radius);
    }
    for i in (1..rows.len()).rev() {
        rows[i - 1].step.lower_bound = rows[i - 1].step.lower_bound.max(rows[i].step.lower_bound);
    }
}

/// Opens, solves and checks for each k, writes and says.
pub(crate) fn run(
    range: &Range,
    open: &dyn Fn(&Watch) -> anyhow::Result<Opened>,
    options_for: &dyn Fn(&Opened) -> anyhow::Result<CentersOptions<'static>>,
    input: Input<'_>,
    output: Output<'_>,
) -> anyhow::Result<Outcome> {
    let picture = output.check_files(input.path, &[])?;
    if let Some(out) = output.out
        && !(is_table(out) || names_json(out))
    {
        bail!(
            "{}: -o writes the table of --elbow as .json, {}; name one of these",
            out.display(),
            tables::extensions()
        );
    }
    let watch = input.effort.start()?;
    let mut clock = Clock::start();
    let points = open(&watch)?;
    let options = options_for(&points)?;
    clock.lap("reading");
    let mut rows = Vec::new();
    for k in range.first..=range.last {
        let found = watch
            .during(&format!("solving k = {k}"), |monitor| {
                centers(points.source(), k, &CentersOptions { monitor: *monitor, ..options })
            })
            .map_err(|error| points.explain(error))?;
        if check(&found, &points, &watch, output, &format!(" for k = {k}"))?.is_err() {
            return Ok(Outcome::CheckFailed);
        }
        let row = Row::of(k, &found);
        let (radius, gap) = (short(row.step.radius), bounded(&row));
        watch
            .print(&format!("k = {k}: radius {radius}, gap {gap}; {}", reports::stopped(row.stop)));
        rows.push(row);
        if found.answer.radius == 0.0 {
            break;
        }
    }
    carry_over(&mut rows);
    let checked = if output.no_verify { "solving" } else { "solving and checking" };
    clock.lap(checked);

    let title = title(&points, options.inputs);
    let verified = match output.no_verify {
        false => Field::new("verified", "yes").remark("both bounds, for each k"),
        true => Field::new("verified", "not checked"),
    };
    let drawn = picture
        .map(|picture| {
            picture.draw(drawing(&title, &points, &rows, &verified)?, &PictureOptions::default())
        })
        .transpose()?;
    let mut outputs = Outputs::default();
    if let Some(out) = output.out {
        let is_json = out.extension().is_some_and(|name| name.eq_ignore_ascii_case("json"));
        match Format::of_path(out) {
            _ if is_json => outputs.add(out, json(&rows).as_bytes())?,
            // The gap is left empty where there is none, which no column of numbers can be.
            (Some(Format::Csv), None) | (None, _) => outputs.add(out, csv(&rows).as_bytes())?,
            _ => outputs.add_table(out, &rows_as_table(&rows))?,
        }
    }
    if let (Some(path), Some(drawn)) = (output.draw, drawn) {
        outputs.add(path, &drawn)?;
    }
    // Where the table goes to standard output, nothing else does.
    if !output.is_standard_output() && output.json {
        outputs.print(&json(&rows));
    } else if !output.is_standard_output() && !input.effort.quiet {
        outputs.print(&format!("{title}\n{}", table(&rows, options.epsilon)));
        let fields: Vec<Field> = [end_of(&rows, range), Some(verified), Some(clock.field())]
            .into_iter()
            .flatten()
            .chain(points.notes())
            .collect();
        outputs.print(&reports::text("", &fields)[1..]);
    }
    outputs.finish()?;
    let is_early = rows.iter().any(|row| row.ended(options.epsilon) == Outcome::StoppedEarly);
    Ok(if is_early { Outcome::StoppedEarly } else { Outcome::Done })
}

fn title(points: &Opened, items: Items) -> String {
    let around = counted(points.source().len(), noun(items));
    format!("Radius by number of centers of {around}")
}

/// Where the range ended before its last k.
fn end_of(rows: &[Row], range: &Range) -> Option<Field> {
    let last = rows.last()?.step.k;
    (last < range.last as u64).then(|| {
        Field::new("ended", format!("at k = {}", count(last)))
            .remark("the radius is 0, and is for every larger k")
    })
}

/// Columns for a terminal.
fn table(rows: &[Row], epsilon: f64) -> String {
    let head = ["k", "radius", "lower bound", "gap", "nodes", "core-set"].map(str::to_owned);
    let cells = rows.iter().map(|row| {
        let ElbowStep { k, radius, lower_bound } = row.step;
        let early = match row.ended(epsilon) {
            Outcome::StoppedEarly => format!("; {}", reports::stopped(row.stop)),
            _ => String::new(),
        };
        [
            count(k),
            short(radius),
            short(lower_bound),
            bounded(row),
            count(row.nodes),
            format!("{}{early}", count(row.core_set as u64)),
        ]
    });
    let lines: Vec<[String; 6]> = std::iter::once(head).chain(cells).collect();
    let widths: [usize; 6] =
        std::array::from_fn(|i| lines.iter().map(|line| line[i].len()).max().unwrap_or(0));
    let mut text = String::new();
    for line in &lines {
        let cells = line.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
        text += &format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    text
}

/// The gap in words.
fn bounded(row: &Row) -> String {
    row.gap().map_or("none".to_owned(), gap)
}

/// The table for other programs. The gap is empty where there is none.
fn csv(rows: &[Row]) -> String {
    let mut text = "k,radius,lower_bound,gap,stop,nodes,core_set\n".to_owned();
    for row in rows {
        let Row { step: ElbowStep { k, radius, lower_bound }, stop, nodes, core_set } = row;
        let (radius, lower_bound) = (exact(*radius), exact(*lower_bound));
        let (gap, stop) = (row.gap().map(exact).unwrap_or_default(), name_of(*stop));
        text += &format!("{k},{radius},{lower_bound},{gap},{stop},{nodes},{core_set}\n");
    }
    text
}

/// The table as a list of objects.
fn json(rows: &[Row]) -> String {
    let row = |row: &Row| {
        let Row { step: ElbowStep { k, radius, lower_bound }, stop, nodes, core_set } = row;
        serde_json::json!({
            "k": k, "radius": radius, "lower_bound": lower_bound, "gap": row.gap(),
            "stop": name_of(*stop), "nodes": nodes, "core_set": core_set,
        })
    };
    format!("{:#}\n", serde_json::Value::Array(rows.iter().map(row).collect()))
}

/// The table in columns; the gap is NaN where there is none.
fn rows_as_table(rows: &[Row]) -> Table {
    let whole = |value: fn(&Row) -> u64| Column::Whole(rows.iter().map(value).collect());
    let real = |value: fn(&Row) -> f64| Column::Real(rows.iter().map(value).collect());
    Table::new()
        .with("k", whole(|row| row.step.k))
        .with("radius", real(|row| row.step.radius))
        .with("lower_bound", real(|row| row.step.lower_bound))
        .with("gap", real(|row| row.gap().unwrap_or(f64::NAN)))
        .with("stop", Column::Text(rows.iter().map(|row| name_of(row.stop).to_owned()).collect()))
        .with("nodes", whole(|row| row.nodes))
        .with("core_set", whole(|row| row.core_set as u64))
}

/// The word that the JSON of an answer has for it.
fn name_of(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Rounding => "rounding",
        Stop::PassBudget => "pass-budget",
        Stop::NodeBudget => "node-budget",
        Stop::ProofBudget => "proof-budget",
    }
}

fn drawing(
    title: &str,
    points: &Opened,
    rows: &[Row],
    verified: &Field,
) -> anyhow::Result<Drawing> {
    let steps: Vec<ElbowStep> = rows.iter().map(|row| row.step).collect();
    let figure = elbow_figure(&steps, &PictureOptions::default().options(vec![]))
        .map_err(|error| picture::refused(error, points))?;
    let field = |row: &Row| {
        let ElbowStep { k, radius, lower_bound } = row.step;
        let value = format!("{} to {}, gap {}", short(lower_bound), short(radius), bounded(row));
        taut_draw::Field::new(format!("k = {k}"), value)
    };
    let verified = taut_draw::Field::new(verified.name, verified.value.clone());
    Ok(Drawing {
        title: title.to_owned(),
        heading: points.name().to_owned(),
        fields: rows.iter().map(field).chain([verified]).chain(picture::notes(points)).collect(),
        figures: vec![figure],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_two_ends() {
        assert_eq!(range("2..8"), Ok(Range { first: 2, last: 8 }));
        assert_eq!(range("3..3"), Ok(Range { first: 3, last: 3 }));
        assert_eq!(range("5..1004"), Ok(Range { first: 5, last: 1004 }));
        let huge = format!("1..{}", usize::MAX);
        for wrong in ["", "3", "0..2", "5..2", "1..x", "-1..2", "1...2", "1.5..2", "5..1005", &huge]
        {
            assert!(range(wrong).unwrap_err().contains("such as 2..8"), "{wrong}");
        }
    }

    #[test]
    fn neighbors_mend_what_a_budget_left() {
        let row = |k, radius, lower_bound, stop| Row {
            step: ElbowStep { k, radius, lower_bound },
            stop,
            nodes: 0,
            core_set: 0,
        };
        let (done, early) = (Stop::Converged, Stop::NodeBudget);
        let mut rows = [
            row(1, 8.0, 3.0, early),
            row(2, 6.0, 6.0, done),
            row(3, 7.0, 2.0, early),
            row(4, 4.0, 3.0, early),
            row(5, 0.0, 0.0, done),
        ];
        carry_over(&mut rows);
        let bounds = rows.each_ref().map(|row| (row.step.radius, row.step.lower_bound));
        assert_eq!(bounds, [(8.0, 6.0), (6.0, 6.0), (6.0, 3.0), (4.0, 3.0), (0.0, 0.0)]);
        let gaps = rows.each_ref().map(|row| row.gap().unwrap());
        assert!(
            (gaps[0] - 1.0 / 3.0).abs() < 1e-15 && gaps[1] == 0.0 && gaps[2] >= 1.0,
            "{gaps:?}"
        );
        assert_eq!(rows[0].ended(0.34), Outcome::Done);
        assert_eq!(rows[0].ended(0.33), Outcome::StoppedEarly);
        assert_eq!(row(2, 1.0, 0.0, early).gap(), None);
    }
}
