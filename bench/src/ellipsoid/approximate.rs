//! Programs that enclose points in an ellipsoid that need not be the smallest: what it costs, and how much larger it is.

use super::*;

/// CGAL's `Approximate_min_ellipsoid_d` by its ε, and dynesty's bounding ellipsoid.
const PEERS: [&str; 3] = ["cgal-approximate-0.01", "cgal-approximate-0.001", "dynesty"];
/// Numbers and dimensions of points; CGAL's program would need minutes for more of them in ten dimensions.
const INPUTS: [(usize, usize); 3] = [(10_000, 2), (10_000, 3), (1000, 10)];

/// Runs all inputs beside all programs.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    for (n, d) in INPUTS {
        let n = context.count(n);
        let values = Law::Normal.draw(n, d, SEED)?;
        let solved = solve(context, context.runs, &values, d, &PEERS)?;
        let ours = solved.rounds.found.answer.log_volume;
        let mut table =
            Table::new("program | least:s | ÷ taut:x | volume ÷ least:8 | points outside");
        let time = solved.rounds.clock();
        table.push(json!(["taut", time, 1.0, 1.0, "none"]));
        for peer in &solved.rounds.peers {
            let answer = peer.answer.as_ref();
            let judged = answer.map(|answer| Judgement::of(&values, d, &answer.center, None));
            table.push(json!({
                "program": peer.name, "least": peer.least(),
                "÷ taut": solved.rounds.faster(peer).map(|(ratio, _)| ratio),
                "volume ÷ least": judged.map(|judged| (judged.log_volume - ours).exp()),
                "points outside": judged.map_or(peer.said(), |judged| match judged.found.outside {
                    0 => "none".to_owned(),
                    n => format!("{n}, by up to {:.1e}", judged.found.excess),
                }),
            }));
        }
        let what = format!("normal, {n} × {d}");
        out.table(&what, table);
        out.keep("solved", solved.json());
        out.judge(&solved.found());
        out.close(&what);
    }
    Ok(())
}
