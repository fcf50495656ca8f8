//! Programs that enclose points in an ellipsoid that need not be the smallest: what it costs, and how much larger it is.

use anyhow::Result;
use serde_json::json;

use super::Context;
use super::case::Case;
use super::judgement::Judgement;
use super::laws::Law;
use super::points::solve;
use crate::goals;
use crate::input::{SEED, write_rows};
use crate::stats::{seconds, times};
use crate::table::Table;

/// CGAL's `Approximate_min_ellipsoid_d` by its ε, and dynesty's bounding ellipsoid.
const PEERS: [&str; 3] = ["cgal-approximate-0.01", "cgal-approximate-0.001", "dynesty"];
/// Numbers and dimensions of points; CGAL's program would need minutes for more of them in ten dimensions.
const INPUTS: [(usize, usize); 3] = [(10_000, 2), (10_000, 3), (1000, 10)];

/// Runs all inputs beside all programs.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let mut all = vec![];
    for (n, d) in INPUTS {
        let n = if context.quick { n / 10 } else { n };
        let values = Law::Normal.draw(n, d, SEED)?;
        let file = context.temp.path().join("points");
        write_rows(&file, &values, d)?;
        let mut table =
            Table::new(&["program", "clock", "÷ taut", "volume ÷ least", "points outside"]);
        let (mut report, mut taut) = (vec![], None);
        for peer in PEERS {
            let solved = solve(context, &values, d, Some((peer, &file)))?;
            let ours = solved.rounds.found.answer.log_volume;
            let mut row = vec![peer.to_owned()];
            let judged = match &solved.rounds.peer {
                Some(Ok((answer, _))) => {
                    let judged = Judgement::of(&values, d, &answer.center, None);
                    row.push(solved.rounds.peer_seconds().map(seconds).unwrap_or_default());
                    row.push(solved.rounds.faster().map(|(r, _)| times(r)).unwrap_or_default());
                    row.push(format!("{:.8}", (judged.log_volume - ours).exp()));
                    row.push(match judged.outside {
                        0 => "none".to_owned(),
                        n => format!("{n}, by up to {:.1e}", judged.excess),
                    });
                    Some(judged.log_volume - ours)
                }
                Some(Err(silence)) => {
                    row.push(silence.to_string());
                    None
                }
                None => None,
            };
            row.resize(5, String::new());
            table.push(row);
            report.push(json!({
                "peer": peer, "log_volume_more": judged, "solved": solved.json(),
            }));
            taut = Some(solved);
        }
        let Some(solved) = taut else { continue };
        let time = solved.rounds.clock().map(seconds).unwrap_or_default();
        table.push(vec!["taut".into(), time, "1".into(), "1".into(), "none".into()]);
        println!("normal, {n} × {d}\n\n{table}");
        let goals = goals::print(&[case.must], &[case.aim], &solved.measured());
        println!();
        all.push(json!({ "input": [n, d], "peers": report, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}
