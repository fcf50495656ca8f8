//! How often the default method finds the right curves, without outliers and with a tenth of them.

use super::*;

/// Connectivity over many draws.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let pool = context.pool()?;
    let options = CurveOptions::default();
    let mut table = Table::new(
        "curve | outliers:% | n | right | wrong seeds | rms:ee | Hausdorff:ee | median time of a \
            draw:s",
    );
    for (outliers, share, what) in [(0.0, 0.95, ""), (0.1, 0.85, ", a tenth outliers")] {
        for name in CURVES {
            let truth = truth(name, TestCurve::VERTICES)?;
            let n = (1000.0 * truth.length_over_feature).ceil() as usize;
            let noise = CurveNoise { outliers, ..NOISE };
            let seeds = context.seeds.clone();
            let trials = Trials::run(Some(&pool), (name, &truth), n, &noise, &options, seeds)?;
            let mut row = trials.row();
            row["outliers"] = outliers.into();
            table.push(row);
            trials.judge_right(out, what, share);
        }
    }
    out.table("", table);
    Ok(())
}
