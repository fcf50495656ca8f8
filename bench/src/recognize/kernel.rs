//! Times, duals and gaps of balls of a Gaussian kernel.

use taut_certify::Kernel;
use taut_enclose::{KernelBallOptions, kernel_ball};

use super::*;

/// One input: points, dimension, γ, ν, and how many times faster than scikit-learn it must and should be solved; no bound of a ratio for
/// sets that are too large for it.
struct Case {
    name: &'static str,
    n: usize,
    dim: usize,
    gamma: f64,
    nu: Option<f64>,
    faster: Option<[f64; 2]>,
    seconds: Option<[f64; 2]>,
}

const CASES: [Case; 5] = [
    Case { name: "2·10⁴ × 30, hard", n: 20_000, faster: Some([10.0, 20.0]), ..NORMAL },
    Case {
        name: "2·10⁴ × 30, ν = 0.01",
        n: 20_000,
        nu: Some(0.01),
        faster: Some([10.0, 40.0]),
        ..NORMAL
    },
    Case { name: "10⁵ × 30, hard", n: 100_000, ..NORMAL },
    Case { name: "10⁶ × 30, hard", n: 1_000_000, seconds: Some([0.5, 0.13]), ..NORMAL },
    // So narrow that more than 2,000 points are on the border.
    Case {
        name: "2·10⁴ × 10, narrow, hard",
        n: 20_000,
        dim: 10,
        gamma: 0.3,
        faster: Some([1.5, 3.0]),
        ..NORMAL
    },
];

const NORMAL: Case =
    Case { name: "", n: 0, dim: 30, gamma: 1.0 / 60.0, nu: None, faster: None, seconds: None };

/// Normal points, each solved by taut and by its peer.
pub(super) fn balls(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "input | support | D:8 | taut:s | gap:e | check:s | scikit-learn:s | its support | its D:8 | why",
    );
    for case in &CASES {
        let n = context.size(case.n, case.n / 20);
        let values = generate(Distribution::Normal, n, case.dim, SEED)?;
        let points = Points::new(&values, case.dim)?;
        let kernel = Kernel::Gaussian { gamma: case.gamma };
        let options = KernelBallOptions { kernel, nu: case.nu, ..Default::default() };
        let (mut times, mut last) = (vec![], None);
        for _ in 0..context.runs {
            let start = Instant::now();
            let found = context.pool()?.install(|| kernel_ball(&points, &options))?;
            times.push(start.elapsed().as_secs_f64());
            last = Some(found);
        }
        let (Some(found), Some(seconds)) = (last, least(times)) else { continue };
        let start = Instant::now();
        let verdict = found.check(&points)?;
        let check = start.elapsed().as_secs_f64();
        ensure!(verdict.gap <= 1e-6, "{}: gap {}", case.name, verdict.gap);
        let mut row = json!({
            "input": case.name, "support": found.answer.support.len(), "D": verdict.lower, "taut": seconds,
            "gap": verdict.gap, "check": check,
        });
        if let Some(bounds) = case.seconds {
            out.at_most(format!("{}: time", case.name), seconds, bounds, Unit::Seconds);
        }
        if case.seconds.is_none() {
            let nu = case.nu.map_or("hard".to_owned(), |nu| nu.to_string());
            let peer = format!("one-class-{nu}-{}", case.gamma);
            match peer::ask(context, &peer, (&values, case.dim))? {
                Err(why) => row["why"] = json!(why),
                Ok(theirs) => {
                    row["scikit-learn"] = json!(theirs.seconds);
                    row["its support"] = json!(theirs.support);
                    row["its D"] = json!(theirs.radius);
                    let ratio = theirs.seconds / seconds;
                    if let Some(bounds) = case.faster {
                        let what = format!("{}: scikit-learn's time over ours", case.name);
                        out.at_least(what, ratio, bounds, Unit::Times);
                    }
                    let apart = (theirs.radius / verdict.lower - 1.0).abs();
                    // Its tolerance is on gradients of the dual: some 1e-6 of its value.
                    out.at_most(format!("{}: duals apart", case.name), apart, 5e-6, Unit::Error);
                }
            }
        }
        table.push(row);
    }
    out.table("gap of the objective at most 1e-6, proved", table);
    Ok(())
}
