//! Ellipses around a million points, beside CGAL, whose ellipse is judged as well.

use anyhow::Result;
use serde_json::json;

use super::Context;
use super::case::Case;
use super::goals;
use super::judgement::Judgement;
use super::laws::Law;
use super::points::{COLUMNS, solve};
use crate::input::{SEED, write_rows};
use crate::stats::{seconds, times};
use crate::table::Table;

/// CGAL's program, as `bench/setup` builds it.
const PEER: &str = "cgal-min-ellipse";
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
        let mut table = Table::new(&[&["program"], &COLUMNS[..], &["answer"]].concat());
        table.push([vec!["taut".to_owned()], solved.cells(), vec![String::new()]].concat());
        let mut row = vec![PEER.to_owned()];
        row.resize(COLUMNS.len() + 1, String::new());
        let mut judged = String::new();
        match &solved.rounds.peer {
            Some(Ok((answer, _))) => {
                row[1] = solved.rounds.peer_seconds().map(seconds).unwrap_or_default();
                row[COLUMNS.len()] = answer.support.to_string();
                let verdict = solved.verdict.as_ref().ok();
                judged = Judgement::of(&values, 2, &answer.center, verdict).to_string();
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
        let goals = goals::print(&[case.must], &[case.aim], &solved.measured());
        println!();
        all.push(json!({ "input": what, "solved": solved.json(), "peer": judged, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}
