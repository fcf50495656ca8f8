//! The algorithm of section 4.1 of the thesis where its theorem holds.

use super::*;

/// δ = 1 / 9ρ² for ρ = 4.
const DELTA: f64 = 1.0 / 144.0;
/// Curves and numbers of points whose centers are compared with those of the plain implementation.
const COMPARED_CURVES: [(&str, [usize; 3]); 2] =
    [("circle", [1000, 4000, 16_000]), ("flower5", [1000, 4000, 16_000])];
/// How many samples of each case are drawn.
const DRAWS_PER_CASE: u64 = 40;

/// The rms of the distances of the plain implementation's centers from the curve, over all draws.
fn plain(
    context: &Context,
    truth: &TruthCurves,
    n: usize,
    noise: &CurveNoise,
    seeds: Range<u64>,
) -> Result<Result<f64, Silence>> {
    let lines = true_lines(truth);
    let (mut squares, draws) = (0.0, seeds.clone().count());
    for seed in seeds {
        let points = sample_curve(truth, n, noise, seed).points;
        match peer::ask(context, "plain-curve", (&points, 2))? {
            Ok(answer) => {
                let vertices = answer.center.as_chunks::<2>().0;
                let polyline = Polyline { vertices, closed: false };
                squares += compare(&lines, &[polyline]).vertex_rms.powi(2);
            }
            Err(silence) => return Ok(Err(silence)),
        }
    }
    Ok(Ok((squares / draws as f64).sqrt()))
}

/// Connectivity over many draws, then errors beside those that are known.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (pool, seeds) = (context.pool()?, context.seeds.clone());
    let thesis = CurveThesisOptions { rho: 4.0, ..CurveThesisOptions::DEFAULT };
    let options = CurveOptions { method: CurveMethod::Thesis(thesis), ..CurveOptions::default() };
    let noise = CurveNoise { delta: DELTA, ..CurveNoise::default() };
    let mut table = Table::new(
        "curve | n | right | wrong seeds | rms:ee | Hausdorff:ee | median time of a draw:s",
    );
    for name in CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        let n = (context.size(800.0, 80.0) * truth.length_over_feature).ceil() as usize;
        let trials = Trials::run(Some(&pool), (name, &truth), n, &noise, &options, seeds.clone())?;
        table.push(trials.row());
        trials.judge_right(out, "", 0.95);
    }
    out.table("", table);
    let told = CurveThesisOptions { feature: Some(1.0), ..thesis };
    let told = CurveOptions { method: CurveMethod::Thesis(told), ..options };
    let few = seeds.start..seeds.end.min(seeds.start + DRAWS_PER_CASE);
    let mut table = Table::new("curve | n | rms:ee | plain rms:ee | why");
    for (name, sizes) in COMPARED_CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        for n in sizes {
            let trials = Trials::run(Some(&pool), (name, &truth), n, &noise, &told, few.clone())?;
            let ours = trials.rms();
            let plain = plain(context, &truth, n, &noise, few.clone())?;
            let mut row = trials.row();
            match plain {
                Ok(theirs) => row["plain rms"] = theirs.into(),
                Err(ref silence) => row["why"] = silence.to_string().into(),
            }
            table.push(row);
            let what = format!("{name}, n = {n}: rms of the centers over the plain one's");
            out.at_most(what, plain.ok().map(|theirs| ours / theirs), 1.0, Unit::Fixed(6));
        }
    }
    out.table("centers beside those of the plain implementation", table);
    Ok(())
}
