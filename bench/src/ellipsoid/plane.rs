//! Ellipses around a million points, beside CGAL, whose ellipse is judged as well.

use super::*;

/// CGAL's program, as `bench/setup` builds it.
const PEER: &str = "cgal-min-ellipse";

/// Numbers of an ellipse of CGAL's, c and Q; its support points come after them.
const NUMBERS: usize = 6;

/// Runs all laws.
pub(super) fn run(context: &Context, out: &mut Outcome, laws: &[Law]) -> Result<()> {
    let n = context.count(1_000_000);
    for law in laws {
        let values = law.draw(n, 2, SEED)?;
        let what = format!("{law}, {n} × 2");
        let solved = solve(context, context.runs, &values, 2, &[PEER])?;
        let support = &solved.rounds.found.certificate.support;
        let proved = ellipse_support(&Points::new(&values, 2)?, support, &Monitor::silent());
        let mut table = Table::new(&format!("program | {} | answer", columns()));
        table.push(joined([json!({ "program": "taut" }), solved.cells()]));
        let peer = solved.rounds.peer().context("one peer")?;
        let their_support = peer.answer.as_ref().map(|answer| {
            let (ellipse, support) = answer.center.split_at(NUMBERS.min(answer.center.len()));
            let judged = Judgement::of(&values, 2, ellipse, solved.verdict.as_ref().ok());
            table.push(json!({
                "program": PEER, "least": peer.least(), "support": answer.support, "answer": judged.to_string(),
            }));
            rows_of(support, &values)
        });
        if their_support.is_none() {
            table.push(json!({ "program": PEER, "answer": peer.said() }));
        }
        out.table(&what, table);
        if let Some((ratio, rounds)) = solved.rounds.faster(peer) {
            // Each round of CGAL's has a shuffle of its own: the least is that of its luckiest.
            let by_rounds = range(rounds, times);
            println!("- faster than CGAL: {} times; by rounds {by_rounds}", times(ratio));
        }
        let mut found = solved.found();
        match &proved {
            Ok(proved) => println!("- support {}", told(proved, their_support.as_deref())),
            Err(why) => found.reject(Some(format!("its support: {why}"))),
        }
        out.keep("solved", solved.json());
        out.keep("support", json!([proved.ok().map(|proved| proved.rows), their_support]));
        out.judge(&found);
        out.close(&what);
    }
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
        "proved by exact arithmetic: rows {rows:?}, {on_border} on the border, {near_border} \
            took whole numbers{same}"
    )
}

/// The rows that are these points, ascending.
fn rows_of(points: &[f64], values: &[f64]) -> Vec<u64> {
    let points: &[[f64; 2]] = points.as_chunks().0;
    let all: &[[f64; 2]] = values.as_chunks().0;
    (0u64..).zip(all).filter(|(_, row)| points.contains(row)).map(|(row, _)| row).collect()
}
