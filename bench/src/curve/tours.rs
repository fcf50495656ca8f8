//! Tours beside those of Concorde's Lin-Kernighan and of LKH.

use super::*;

/// Units of the longer side of the box, as peers take whole numbers.
const UNITS: f64 = 1e6;

/// A tour and what it cost.
struct Tour {
    length: f64,
    seconds: f64,
    /// The proved lower bound of taut's.
    bound: Option<f64>,
    said: String,
}

fn length(points: &[f64], order: impl Iterator<Item = usize>) -> f64 {
    let at: Vec<[f64; 2]> = order.map(|row| [points[2 * row], points[2 * row + 1]]).collect();
    (0..at.len())
        .map(|i| {
            let (a, b) = (at[i], at[(i + 1) % at.len()]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        })
        .sum()
}

/// taut's tour: the least time of all rounds.
fn ours(context: &Context, points: &[f64], threads: usize) -> Result<Tour> {
    let options = CurveOptions {
        method: CurveMethod::Tour,
        threads: Some(threads),
        ..CurveOptions::default()
    };
    let (found, mut least) = solve(points, &options)?;
    for _ in 1..context.runs {
        least = least.min(solve(points, &options)?.1);
    }
    let rows: Vec<usize> = found
        .answer
        .curves
        .iter()
        .flat_map(|curve| curve.rows.iter().map(|&row| row as usize))
        .collect();
    let is_one = found.answer.curves.len() == 1 && found.answer.curves[0].closed;
    let verdict = found.check(&Points::new(points, 2)?);
    let said = match (&verdict, is_one) {
        (Err(why), _) => format!("REJECTED: {why}"),
        (Ok(_), false) => "WRONG: no single closed curve".to_owned(),
        (Ok(_), true) if rows.len() != points.len() / 2 => format!("WRONG: {} points", rows.len()),
        (Ok(_), true) => "checked".to_owned(),
    };
    let bound = found.certificate.tour.as_ref().filter(|_| verdict.is_ok()).map(|tour| tour.lower);
    Ok(Tour { length: length(points, rows.into_iter()), seconds: least, bound, said })
}

/// A peer's tour of the points as whole numbers, measured as they are.
fn theirs(context: &Context, peer: &str, points: &[f64]) -> Result<Result<Tour, Silence>> {
    let (mut low, mut side) = ([f64::INFINITY; 2], 0.0f64);
    for p in points.chunks_exact(2) {
        low = [low[0].min(p[0]), low[1].min(p[1])];
    }
    for p in points.chunks_exact(2) {
        side = side.max(p[0] - low[0]).max(p[1] - low[1]);
    }
    let whole: Vec<f64> = points
        .iter()
        .enumerate()
        .map(|(i, v)| ((v - low[i % 2]) * (UNITS / side)).round())
        .collect();
    let Answer { seconds, center: order, .. } = match peer::ask(context, peer, (&whole, 2))? {
        Ok(answer) => answer,
        Err(silence) => return Ok(Err(silence)),
    };
    let rows = || order.iter().map(|&row| row as usize);
    ensure!(is_permutation(rows(), points.len() / 2), "{peer}: not a tour of all points");
    let length = length(points, rows());
    Ok(Ok(Tour { length, seconds, bound: None, said: "lengths rounded".to_owned() }))
}

/// Times, lengths and bounds.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let seed = context.seeds.start;
    let threads = context.last_threads();
    let clean = CurveNoise { delta: 0.0, ..NOISE };
    let (small, large) = (context.count(5000), context.count(100_000));
    let flower = truth("flower5", TestCurve::VERTICES)?;
    let bumpy = truth("bumpy", TestCurve::VERTICES)?;
    let on = |truth, n| sample_curve(truth, n, &clean, seed).points;
    let uniform = |n| generate::<f64>(Distribution::Uniform, n, 2, seed);
    let inputs: [(&str, Vec<f64>, &[&str]); 5] = [
        ("flower5", on(&flower, small), &["concorde", "elkai"]),
        ("bumpy", on(&bumpy, small), &["concorde"]),
        ("uniform", uniform(small)?, &["concorde"]),
        ("bumpy", on(&bumpy, large), &[]),
        ("uniform", uniform(large)?, &[]),
    ];
    let mut table = Table::new(
        "points | n | program | length ÷ taut's:6 | time:s | ÷ taut's:x | over its bound:% | remark",
    );
    for (points, values, peers) in &inputs {
        let n = values.len() / 2;
        let ours = ours(context, values, threads)?;
        let gap = ours.bound.map(|bound| ours.length / bound - 1.0);
        table.push(json!({
            "points": points, "n": n, "program": "taut", "length ÷ taut's": 1.0, "time": ours.seconds, "÷ taut's": 1.0,
            "over its bound": gap, "remark": ours.said, "length": ours.length, "bound": ours.bound,
        }));
        let name = format!("{points}, n = {n}");
        let is_verified = gap.is_some() && ours.said == "checked";
        let shown = gap.map_or(String::new(), |gap| {
            format!(", tour at most {} longer", Unit::Percent.show(gap))
        });
        out.must(format!("{name}: bound verified"), format!("{}{shown}", ours.said), is_verified);
        for &peer in *peers {
            let theirs = theirs(context, peer, values)?;
            let [length, time] = match &theirs {
                Ok(tour) => [tour.length / ours.length, tour.seconds / ours.seconds].map(Some),
                Err(_) => [None; 2],
            };
            let remark = match &theirs {
                Ok(tour) => tour.said.clone(),
                Err(silence) => silence.to_string(),
            };
            table.push(json!({
                "points": points, "n": n, "program": peer, "length ÷ taut's": length, "÷ taut's": time,
                "time": theirs.ok().map(|tour| tour.seconds), "remark": remark,
            }));
            if peer != "concorde" {
                continue;
            }
            // Whole numbers are 1e-6 of the box apart.
            for (what, value, bound, unit) in [
                ("time of Concorde's Lin-Kernighan over ours", time, 10.0, Unit::Times),
                ("length of Concorde's over ours", length, 1.0 - 1e-9, Unit::Fixed(6)),
            ] {
                let is_aim = *points == "uniform";
                let bounds = if is_aim { aim_only(bound) } else { bound.into() };
                out.at_least(format!("{name}: {what}"), value, bounds, unit);
            }
        }
        if n == large {
            out.at_most(format!("{name}: time"), ours.seconds, [2.0, 1.0], Unit::Seconds);
        }
    }
    out.table(&format!("{threads} threads"), table);
    Ok(())
}
