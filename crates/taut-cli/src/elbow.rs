//! `taut centers --elbow`: the radius for each of a range of k, as a table, a file and a plot.

use anyhow::bail;
use taut::{CentersOptions, Items, centers_of_source};
use taut_draw::{ElbowStep, elbow_figure};

use crate::centers::outcome;
use crate::clock::Clock;
use crate::delivery::{Delivery, Desk};
use crate::exit::Outcome;
use crate::numbers::{count, counted, exact, gap, short};
use crate::picture::{self, Drawing, Look};
use crate::reading::Opened;
use crate::report::{self, Fact, noun};
use crate::verify::judge;
use crate::writing::{self, Outputs};

/// From the first k to the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    first: usize,
    last: usize,
}

/// Reads `2..8`.
pub(crate) fn range(text: &str) -> Result<Range, String> {
    let ends = text.split_once("..").and_then(|(first, last)| {
        Some(Range { first: first.trim().parse().ok()?, last: last.trim().parse().ok()? })
    });
    ends.filter(|range| 1 <= range.first && range.first <= range.last).ok_or_else(|| {
        "expected two whole numbers from 1, the smaller first, such as 2..8".to_owned()
    })
}

/// What was found for one k.
struct Row {
    step: ElbowStep,
    gap: f64,
    nodes: u64,
    core_set: usize,
    ended: Outcome,
}

/// Opens, solves and checks for each k, writes and says.
pub(crate) fn run(
    range: &Range,
    items: Items,
    options: &CentersOptions,
    desk: &Desk<'_>,
    delivery: &Delivery,
) -> anyhow::Result<Outcome> {
    let picture = delivery.look_at_places(desk.path)?;
    if let Some(out) = &delivery.out
        && out.extension().is_some_and(|extension| extension == "json")
    {
        bail!(
            "{}: -o writes the table of --elbow as CSV; the answer of one k is JSON",
            out.display()
        );
    }
    let watch = desk.effort.start()?;
    let mut clock = Clock::start();
    let points = desk.reading.open(desk.path)?;
    clock.lap("reading");
    let mut rows = Vec::new();
    for k in range.first..=range.last {
        let found = watch
            .during(&format!("solving k = {k}"), |monitor| {
                centers_of_source(points.source(), items, k, options, monitor)
            })
            .map_err(|error| points.explain(error))?;
        if delivery.is_verified()
            && let Err(violation) = judge(&found, &points, &watch)?
        {
            let violation = points.explain_violation(&violation, "the centres found");
            writing::complain(&format!("the check failed for k = {k}: {violation}"));
            return Ok(Outcome::CheckFailed);
        }
        let (radius, lower_bound) = (found.answer.radius, found.answer.lower_bound);
        rows.push(Row {
            step: ElbowStep { k: k as u64, radius, lower_bound },
            gap: found.certificate.gap,
            nodes: found.trace.iterations,
            core_set: found.certificate.core_set.len(),
            ended: outcome(&found, options.epsilon),
        });
    }
    let checked = if delivery.is_verified() { "solving and checking" } else { "solving" };
    clock.lap(checked);

    let title = title(&points, items);
    let verified = match delivery.is_verified() {
        true => Fact::new("verified", "yes").remark("both bounds, for each k"),
        false => Fact::new("verified", "not checked"),
    };
    let drawn = picture
        .map(|picture| picture.draw(drawing(&title, &points, &rows, &verified)?, &Look::default()))
        .transpose()?;
    let mut outputs = Outputs::default();
    if let Some(out) = &delivery.out {
        outputs.add(out, csv(&rows).as_bytes())?;
    }
    if let (Some(path), Some(drawn)) = (&delivery.draw, drawn) {
        outputs.add(path, &drawn)?;
    }
    // Where the table goes to standard output, nothing else does.
    let is_free = delivery.out.as_deref().is_none_or(|out| !writing::is_stream(out));
    if is_free && !desk.effort.quiet {
        outputs.say(&format!("{title}\n{}", table(&rows)));
        outputs.say(&report::text("", &[verified, clock.fact()])[1..]);
    }
    outputs.finish()?;
    let is_early = rows.iter().any(|row| row.ended == Outcome::StoppedEarly);
    Ok(if is_early { Outcome::StoppedEarly } else { Outcome::Done })
}

fn title(points: &Opened, items: Items) -> String {
    let around = counted(points.source().len(), noun(items));
    format!("Radius by number of centres of {around}")
}

/// Columns for a terminal.
fn table(rows: &[Row]) -> String {
    let head = ["k", "radius", "lower bound", "gap", "nodes", "core-set"].map(str::to_owned);
    let cells = rows.iter().map(|row| {
        let ElbowStep { k, radius, lower_bound } = row.step;
        let early = if row.ended == Outcome::StoppedEarly { "; stopped early" } else { "" };
        [
            count(k),
            short(radius),
            short(lower_bound),
            bounded(&row.step, row.gap),
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

/// The gap, where there is a bound.
fn bounded(step: &ElbowStep, proved: f64) -> String {
    if step.lower_bound > 0.0 || step.radius == 0.0 { gap(proved) } else { "none".to_owned() }
}

fn csv(rows: &[Row]) -> String {
    let mut text = "k,radius,lower_bound,nodes,core_set\n".to_owned();
    for Row { step: ElbowStep { k, radius, lower_bound }, nodes, core_set, .. } in rows {
        text += &format!("{k},{},{},{nodes},{core_set}\n", exact(*radius), exact(*lower_bound));
    }
    text
}

fn drawing(title: &str, points: &Opened, rows: &[Row], verified: &Fact) -> anyhow::Result<Drawing> {
    let steps: Vec<ElbowStep> = rows.iter().map(|row| row.step).collect();
    let figure = elbow_figure(&steps, &Look::default().options(vec![]))
        .map_err(|error| picture::refused(error, points))?;
    let fact = |row: &Row| {
        let ElbowStep { k, radius, lower_bound } = row.step;
        let value = format!("{} to {}", short(lower_bound), short(radius));
        taut_draw::Fact::new(format!("k = {k}"), value)
    };
    let verified = taut_draw::Fact::new(verified.name, verified.value.clone());
    Ok(Drawing {
        title: title.to_owned(),
        heading: points.name().to_owned(),
        facts: rows.iter().map(fact).chain([verified]).collect(),
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
        for wrong in ["", "3", "0..2", "5..2", "1..x", "-1..2", "1...2", "1.5..2"] {
            assert!(range(wrong).unwrap_err().contains("such as 2..8"), "{wrong}");
        }
    }
}
