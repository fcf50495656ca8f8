//! Minimum enclosing ball by Frank–Wolfe steps on the dual.

use taut_certify::{Ball, BallCertificate, Items, PassBounds, Solution, Stop, Trace};
use taut_points::{Monitor, PointSource, gather, hash_points, is_empty, map_blocks};

use super::BallOptions;
use crate::Error;

pub(super) fn solve(
    source: &dyn PointSource,
    items: Items,
    options: &BallOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    if is_empty(source) {
        return Err(Error::Empty);
    }
    let mut c = gather(source, &[0])?;
    let mut lambda = std::collections::BTreeMap::from([(0u64, 1.0)]);
    let mut r2 = 0.0f64;
    let mut trace = Trace { method: "frank-wolfe".into(), ..Trace::default() };
    let far2 = loop {
        trace.passes += 1;
        monitor.pass(trace.passes, source.len());
        let best = map_blocks(source, monitor, |first, rows| {
            let mut row = vec![0.0; c.len()];
            let mut best = (f64::NEG_INFINITY, 0);
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let v: f64 = row.iter().zip(&c).map(|(x, c)| (x - c) * (x - c)).sum();
                if v > best.0 {
                    best = (v, first + i as u64);
                }
            }
            if let Some((row, column, value)) = rows.first_non_finite() {
                return Err(Error::NonFinite { row: first + row as u64, column, value });
            }
            Ok::<_, Error>(best)
        })?;
        let (far2, far) =
            best.into_iter().fold((f64::NEG_INFINITY, 0), |a, b| if b.0 > a.0 { b } else { a });
        trace.history.push(PassBounds {
            lower: r2.sqrt(),
            upper: far2.sqrt(),
            working_set: lambda.len() as u64,
        });
        if far2 <= (1.0 + options.epsilon.max(1e-4)).powi(2) * r2 || far2 == 0.0 {
            break far2;
        }
        if trace.passes == options.max_passes.min(20_000) {
            trace.stop = Stop::PassBudget;
            break far2;
        }
        let beta = (far2 - r2) / (2.0 * far2);
        lambda.values_mut().for_each(|l| *l *= 1.0 - beta);
        *lambda.entry(far).or_insert(0.0) += beta;
        let p = gather(source, &[far])?;
        for (c, p) in c.iter_mut().zip(p) {
            *c += beta * (p - *c);
        }
        r2 = (1.0 - beta) * (r2 + beta * far2);
    };
    let radius = far2.sqrt() * (1.0 + 1e-15);
    trace.core_set = lambda.len() as u64;
    let certificate = BallCertificate {
        items,
        support: lambda.keys().copied().collect(),
        multipliers: lambda.values().copied().collect(),
        gap: if r2 > 0.0 { radius / r2.sqrt() - 1.0 } else { 0.0 },
        points_hash: hash_points(source, monitor)?,
    };
    Ok(Solution { answer: Ball { center: c, center_tail: vec![], radius }, certificate, trace })
}
