//! Ellipses around a million points, beside CGAL, whose ellipse is judged as well.

use anyhow::Result;
use serde_json::json;
use taut_certify::{EllipseSupport, ellipse_support};
use taut_points::{Monitor, Points};

use super::Context;
use super::case::Case;
use super::judgement::Judgement;
use super::laws::Law;
use super::points::{COLUMNS, solve};
use crate::goals;
use crate::input::{SEED, write_rows};
use crate::stats::{seconds, times};
use crate::table::Table;

/// CGAL's program, as `bench/setup` builds it.
const PEER: &str = "cgal-min-ellipse";

/// Numbers of an ellipse of CGAL's, c and Q; its support points come after them.
const NUMBERS: usize = 6;

/// Runs the case under all laws.
pub(super) fn run(context: &mut Context, case: &Case, laws: &[Law]) -> Result<()> {
    let n = if context.quick { 100_000 } else { 1_000_000 };
    let mut all = Vec::new();
    for law in laws {
        let values = law.draw(n, 2, SEED)?;
        let what = format!("{law}, {n} × 2");
        let file = context.temp.path().join("points");
        write_rows(&file, &values, 2)?;
        let solved = solve(context, &values, 2, Some((PEER, &file)))?;
        let support = &solved.rounds.found.certificate.support;
        let proved = ellipse_support(&Points::new(&values, 2)?, support, &Monitor::silent());
        let mut table = Table::new(&[&["program"], &COLUMNS[..], &["answer"]].concat());
        table.push([vec!["taut".to_owned()], solved.cells(), vec![String::new()]].concat());
        let mut row = vec![PEER.to_owned()];
        row.resize(COLUMNS.len() + 1, String::new());
        let mut judged = String::new();
        let mut their_support = None;
        match &solved.rounds.peer {
            Some(Ok((answer, _))) => {
                row[1] = solved.rounds.peer_seconds().map(seconds).unwrap_or_default();
                row[COLUMNS.len()] = answer.support.to_string();
                let verdict = solved.verdict.as_ref().ok();
                let (ellipse, support) = answer.center.split_at(NUMBERS.min(answer.center.len()));
                judged = Judgement::of(&values, 2, ellipse, verdict).to_string();
                their_support = Some(rows_of(support, &values));
                row.push(judged.clone());
            }
            Some(Err(silence)) => row.push(silence.to_string()),
            None => row.push("not asked".to_owned()),
        }
        table.push(row);
        println!("{what}\n\n{table}");
        if let Some((ratio, rounds)) = solved.rounds.faster() {
            // Each round of CGAL's has a shuffle of its own: the least is that of its luckiest.
            let [least, middle, most] = [rounds.min, rounds.median, rounds.max].map(times);
            println!(
                "- faster than CGAL: {} times; by rounds {middle}, {least} to {most}",
                times(ratio)
            );
        }
        let mut measured = solved.measured();
        match &proved {
            Ok(proved) => println!("- support {}", told(proved, their_support.as_deref())),
            Err(why) => measured.rejected = Some(format!("its support: {why}")),
        }
        let goals = goals::print(&[case.must], &[case.aim], &measured);
        println!();
        all.push(json!({
            "input": what,
            "solved": solved.json(),
            "support": proved.ok().map(|proved| proved.rows),
            "peer": judged,
            "peer_support": their_support,
            "goals": goals,
        }));
    }
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}

/// What exact arithmetic says of our support, and whether CGAL's is the same.
fn told(proved: &EllipseSupport, theirs: Option<&[u64]>) -> String {
    let EllipseSupport { rows, on_border, near_border } = proved;
    let same = match theirs {
        None => "",
        Some(theirs) if theirs == rows => "; CGAL's is the same",
        Some(_) => "; CGAL's is another",
    };
    format!(
        "proved by exact arithmetic: rows {rows:?}, {on_border} on the border, {near_border} took whole numbers{same}"
    )
}

/// The rows that are these points, ascending.
fn rows_of(points: &[f64], values: &[f64]) -> Vec<u64> {
    let points: &[[f64; 2]] = points.as_chunks().0;
    let all: &[[f64; 2]] = values.as_chunks().0;
    (0u64..).zip(all).filter(|(_, row)| points.contains(row)).map(|(row, _)| row).collect()
}
