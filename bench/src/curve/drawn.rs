//! Inputs drawn from curves whose truth is known, what was found of them, and how good that is.

use super::*;

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
    seed: u64,
    quality: Quality,
    pub(super) seconds: f64,
    noise: f64,
}

/// Draws of one curve by one law.
pub(super) struct Trials {
    name: &'static str,
    n: usize,
    pub(super) trials: Vec<Trial>,
}

impl Trials {
    /// Draws n points for each seed and judges what is found; draws run beside each other on the threads of `pool`.
    ///
    /// Without a pool they run one after the other: beside each other a thread that waits for its draw works on another
    /// one, whose time it is told.
    pub(super) fn run(
        pool: Option<&rayon::ThreadPool>,
        (name, truth): (&'static str, &TruthCurves),
        n: usize,
        noise: &CurveNoise,
        options: &CurveOptions<'_>,
        mut seeds: Range<u64>,
    ) -> Result<Self> {
        let lines = true_lines(truth);
        let trial = |seed| -> Result<Trial> {
            let sample = sample_curve(truth, n, noise, seed);
            let (found, seconds) = solve(&sample.points, options)?;
            let quality = compare(&lines, &found_lines(&found.answer));
            Ok(Trial { seed, quality, seconds, noise: found.answer.noise })
        };
        let trials = match pool {
            Some(pool) => pool.install(|| seeds.into_par_iter().map(trial).collect::<Result<_>>()),
            None => seeds.try_fold(vec![], |mut trials, seed| {
                trials.push(trial(seed)?);
                Ok(trials)
            }),
        };
        Ok(Trials { name, n, trials: trials? })
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
    fn median(&self, of: impl Fn(&Trial) -> f64) -> f64 {
        let values: Vec<f64> = self.trials.iter().map(of).collect();
        Summary::of(&values).map_or(f64::NAN, |summary| summary.median)
    }

    /// How many of all are right.
    pub(super) fn right_of_all(&self) -> String {
        format!("{} of {}", self.right(), self.trials.len())
    }

    /// Judges whether at least this share is right.
    pub(super) fn judge_right(&self, out: &mut Outcome, what: &str, share: f64) {
        let is_met = self.right() as f64 >= share * self.trials.len() as f64;
        let goal = format!("{}{what}: right in {} of 100", self.name, 100.0 * share);
        out.must(goal, self.right_of_all(), is_met);
    }

    /// A row of a table: what was found, and all draws for the report.
    pub(super) fn row(&self) -> Value {
        let wrong = self.trials.iter().filter(|trial| !trial.quality.topology_right());
        let wrong: Vec<u64> = wrong.map(|trial| trial.seed).collect();
        let trials = self.trials.iter().map(|trial| {
            let q = &trial.quality;
            json!({
                "seed": trial.seed, "seconds": trial.seconds, "noise": trial.noise,
                "vertex_rms": q.vertex_rms, "vertex_max": q.vertex_max, "hausdorff": q.hausdorff,
                "loops": q.loops_found, "homeomorphic": q.homeomorphic, "crossings": q.crossings,
            })
        });
        json!({
            "curve": self.name, "n": self.n, "right": self.right_of_all(), "wrong seeds": few(&wrong),
            "rms": self.rms(), "largest": self.median(|trial| trial.quality.vertex_max),
            "Hausdorff": self.median(|trial| trial.quality.hausdorff),
            "noise told": self.median(|trial| trial.noise),
            "median time of a draw": self.median(|trial| trial.seconds),
            "trials": trials.collect::<Value>(),
        })
    }
}

/// The first few seeds.
pub(super) fn few(seeds: &[u64]) -> String {
    let few: Vec<String> = seeds.iter().take(5).map(u64::to_string).collect();
    few.join(" ") + if seeds.len() > 5 { " …" } else { "" }
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
