//! Inputs drawn from curves whose truth is known, what was found of them, and how good that is.

use std::ops::Range;
use std::time::Instant;

use anyhow::{Context as _, Result};
use rayon::prelude::*;
use serde_json::{Value, json};
use taut_certify::{Curve, Solution};
use taut_mesh::{Polyline, Quality, compare};
use taut_points::{
    Points,
    generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve},
};
use taut_reconstruct::{CurveOptions, curve};

use crate::stats::Summary;

/// The six test curves.
pub(super) const CURVES: [&str; 6] = ["circle", "ellipse3", "flower5", "bumpy", "gear20", "multi4"];

/// The noise of most sections: δ = 0.05 of the least local feature size, along the normal.
pub(super) const NOISE: CurveNoise =
    CurveNoise { delta: 0.05, gaussian: false, uniform_arc: false, outliers: 0.0 };

/// The curve of that name, measured at as many points.
pub(super) fn truth(name: &str, vertices: usize) -> Result<TruthCurves> {
    Ok(TestCurve::named(name)
        .with_context(|| format!("no curve is called {name}"))?
        .build_with(vertices))
}

/// The true curves as polylines.
pub(super) fn true_lines(truth: &TruthCurves) -> Vec<Polyline<'_>> {
    let curves = truth.loops.iter().zip(&truth.closed);
    curves.map(|(vertices, &closed)| Polyline { vertices, closed }).collect()
}

/// The found curves as polylines.
pub(super) fn found_lines(found: &Curve) -> Vec<Polyline<'_>> {
    let curves = found.curves.iter();
    curves.map(|curve| Polyline { vertices: &curve.vertices, closed: curve.closed }).collect()
}

/// The edges of the found curves, as pairs of rows.
pub(super) fn found_edges(found: &Curve) -> Vec<[u64; 2]> {
    let mut edges = Vec::new();
    for curve in &found.curves {
        edges.extend(curve.rows.windows(2).map(|pair| [pair[0], pair[1]]));
        if let (true, [first, .., last]) = (curve.closed, &curve.rows[..]) {
            edges.push([*last, *first]);
        }
    }
    edges
}

/// Solves, and takes the time of it by the clock.
pub(super) fn solve(values: &[f64], options: &CurveOptions<'_>) -> Result<(Solution<Curve>, f64)> {
    let points = Points::new(values, 2)?;
    let start = Instant::now();
    let found = curve(&points, options)?;
    Ok((found, start.elapsed().as_secs_f64()))
}

/// One draw, and what was found of it.
pub(super) struct Trial {
    pub(super) seed: u64,
    pub(super) quality: Quality,
    pub(super) seconds: f64,
    pub(super) noise: f64,
}

/// Draws of one curve by one law.
pub(super) struct Trials {
    pub(super) n: usize,
    pub(super) trials: Vec<Trial>,
}

impl Trials {
    /// Draws n points for each seed and judges what is found; draws run beside each other on the threads of `pool`.
    pub(super) fn run(
        pool: &rayon::ThreadPool,
        truth: &TruthCurves,
        n: usize,
        noise: &CurveNoise,
        options: &CurveOptions<'_>,
        seeds: Range<u64>,
    ) -> Result<Self> {
        let trial = Self::trial(truth, n, noise, options);
        let seeds: Vec<u64> = seeds.collect();
        let trials = pool.install(|| seeds.into_par_iter().map(trial).collect::<Result<_>>())?;
        Ok(Trials { n, trials })
    }

    /// The same one after the other. Beside each other a thread that waits for its draw works on another one, whose time it is told.
    pub(super) fn timed(
        pool: &rayon::ThreadPool,
        truth: &TruthCurves,
        n: usize,
        noise: &CurveNoise,
        options: &CurveOptions<'_>,
        seeds: Range<u64>,
    ) -> Result<Self> {
        let trial = Self::trial(truth, n, noise, options);
        let trials = pool.install(|| seeds.map(trial).collect::<Result<_>>())?;
        Ok(Trials { n, trials })
    }

    fn trial<'a>(
        truth: &'a TruthCurves,
        n: usize,
        noise: &'a CurveNoise,
        options: &'a CurveOptions<'a>,
    ) -> impl Fn(u64) -> Result<Trial> + Sync + 'a {
        let lines = true_lines(truth);
        move |seed| {
            let sample = sample_curve(truth, n, noise, seed);
            let (found, seconds) = solve(&sample.points, options)?;
            let quality = compare(&lines, &found_lines(&found.answer));
            Ok(Trial { seed, quality, seconds, noise: found.answer.noise })
        }
    }

    /// How many are right in connectivity and without crossings.
    pub(super) fn right(&self) -> usize {
        self.trials.iter().filter(|trial| trial.quality.topology_right()).count()
    }

    /// Root mean square over all draws of the distance of vertices from the curve.
    pub(super) fn rms(&self) -> f64 {
        let squares = self.trials.iter().map(|trial| trial.quality.vertex_rms.powi(2)).sum::<f64>();
        (squares / self.trials.len() as f64).sqrt()
    }

    /// The middle of what `of` tells of each draw.
    pub(super) fn median(&self, of: impl Fn(&Trial) -> f64) -> f64 {
        let values: Vec<f64> = self.trials.iter().map(of).collect();
        Summary::of(&values).map_or(f64::NAN, |summary| summary.median)
    }

    /// The seeds that went wrong, the first few.
    pub(super) fn wrong(&self) -> String {
        let mut wrong = self.trials.iter().filter(|trial| !trial.quality.topology_right());
        let seeds: Vec<String> =
            wrong.by_ref().take(5).map(|trial| trial.seed.to_string()).collect();
        let more = if wrong.next().is_some() { " …" } else { "" };
        seeds.join(" ") + more
    }

    /// For the report.
    pub(super) fn json(&self) -> Value {
        let trials = self.trials.iter().map(|trial| {
            let q = &trial.quality;
            json!({
                "seed": trial.seed, "seconds": trial.seconds, "noise": trial.noise,
                "vertex_rms": q.vertex_rms, "vertex_max": q.vertex_max, "hausdorff": q.hausdorff,
                "loops": q.loops_found, "homeomorphic": q.homeomorphic, "crossings": q.crossings,
            })
        });
        json!({ "n": self.n, "trials": trials.collect::<Vec<_>>() })
    }
}

/// A pool of as many threads.
pub(super) fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}

/// Errors as they are read best.
pub(super) fn error(value: f64) -> String {
    format!("{value:.2e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_certify::CurveComponent;

    #[test]
    fn edges_of_closed_curves_lead_back() {
        let component = |rows: &[u64], closed| CurveComponent {
            vertices: vec![[0.0; 2]; rows.len()],
            closed,
            rows: rows.to_vec(),
        };
        let curves =
            vec![component(&[4, 2, 7], true), component(&[1, 0], false), component(&[9], true)];
        let found = Curve { curves, noise: 0.0, outliers: vec![], places: vec![] };
        assert_eq!(found_edges(&found), [[4, 2], [2, 7], [7, 4], [1, 0]]);
    }
}
