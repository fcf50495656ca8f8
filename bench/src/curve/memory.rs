//! Memory of a reconstruction above its input.

use super::*;

/// The bytes per point that reconstruction may take at its peak.
const BYTES_PER_POINT_MAX: f64 = 300.0;

/// Peaks of the methods that are quick.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(1_000_000);
    let truth = truth("bumpy", TestCurve::VERTICES)?;
    let threads = context.last_threads();
    let file = context.file("points.f64");
    let mut table = Table::new("method | points | B/point:0 | why");
    for (method, delta) in [
        (CurveMethod::Auto, 0.05),
        (CurveMethod::Auto, 0.0),
        (CurveMethod::NnCrust, 0.0),
        (CurveMethod::HnnCrust, 0.0),
        (CurveMethod::OneStepCrust, 0.0),
        (CurveMethod::Crust, 0.0),
    ] {
        let noise = CurveNoise { delta, ..NOISE };
        write_raw(&file, &sample_curve(&truth, n, &noise, context.seeds.start).points)?;
        let points = if delta > 0.0 { "noisy" } else { "clean" };
        let built = one::alone(method, threads, &file, context.limit)?;
        let peak = built.as_ref().ok().and_then(Build::bytes_per_point);
        let name = method.name();
        table.push(json!({
            "method": name, "points": points, "B/point": peak, "why": built.as_ref().err(), "build": built.as_ref().ok(),
        }));
        let what = format!("{name}, {points}: bytes per point");
        out.at_most(what, peak, BYTES_PER_POINT_MAX, Unit::Fixed(0));
    }
    out.table(&format!("n = {n}, {threads} threads"), table);
    Ok(())
}
