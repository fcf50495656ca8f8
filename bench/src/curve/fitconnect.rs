//! Opponents published errors of FitConnect, which is not run: its figures are from one draw of the same law.

use super::*;

const N: usize = 2000;
/// Curve, rms, Hausdorff distance and seconds of FitConnect.
const FITCONNECT: [(&str, f64, f64, &str); 5] = [
    ("circle", 0.0133, 0.038, "3.1–5.6"),
    ("ellipse3", 0.0214, 0.076, "11.9"),
    ("flower5", 0.0226, 0.062, "1.1"),
    ("bumpy", 0.0224, 0.084, "14.2"),
    ("gear20", 0.0217, 0.135, ".72"),
];

/// Errors and times row by row.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let threads = context.last_threads();
    let options = CurveOptions { threads: Some(threads), ..CurveOptions::default() };
    let mut table = Table::new(
        "curve | rms:ee | FitConnect's rms:ee | ratio:x | Hausdorff:ee | FitConnect's \
            Hausdorff:ee | right | time:s | FitConnect's [s]",
    );
    for (name, their_rms, their_hausdorff, their_seconds) in FITCONNECT {
        let truth = truth(name, TestCurve::VERTICES)?;
        let seeds = context.seeds.clone();
        // One draw after another, so that times are those of a draw alone.
        let trials = Trials::run(None, (name, &truth), N, &NOISE, &options, seeds)?;
        let ratio = trials.rms() / their_rms;
        let worst = trials.trials.iter().map(|trial| trial.seconds).fold(0.0, f64::max);
        let mut row = trials.row();
        row["FitConnect's rms"] = their_rms.into();
        row["FitConnect's Hausdorff"] = their_hausdorff.into();
        row["FitConnect's [s]"] = their_seconds.into();
        row["ratio"] = ratio.into();
        row["time"] = worst.into();
        table.push(row);
        out.at_most(format!("{name}: rms over FitConnect's"), ratio, [1.0, 0.5], Unit::Times);
        trials.judge_right(out, "", 1.0);
        out.at_most(format!("{name}: time"), worst, [0.05, 0.01], Unit::Seconds);
    }
    out.table(&format!("n = {N}, the slowest of all draws, {threads} threads"), table);
    Ok(())
}
