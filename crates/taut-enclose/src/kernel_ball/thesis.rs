//! Algorithm 11 of the thesis: steps to the farthest point, a given number of them, each over all points.
//!
//! *Idea.* Keep aₖ = Σ λᵢρ(xₖ, xᵢ) for all points. The farthest point q is that of the largest a; with s = 1/(t + 2) in step t,
//! λ ← (1 − s)λ + s·e_q, a ← (1 − s)a + sρ(·, x_q), and D ← (1 − s)²D + s(1 − s)a_q. It begins with a point that is far from a drawn
//! one and the point that is farthest from that.
//! *Difference.* The thesis moves the support to the front of the list by swaps, which loses a point where the two swaps meet; here the
//! support is a list of row numbers.
//! *Guarantee.* The objective falls like 1/t; the certificate says how near it came.
//! *Cost.* O(nd) for each step, and n numbers.

use std::collections::BTreeMap;

use taut_certify::{Kernel, Solution, Stop, Trace};
use taut_points::PointSource;

use super::features::Features;
use super::first::{First, first_pass};
use super::solve::{finish, out_of_range};
use super::{KernelBall, KernelBallMethod, KernelBallOptions};
use crate::Error;

pub(super) fn solve(
    source: &dyn PointSource,
    options: &KernelBallOptions<'_>,
) -> Result<Solution<KernelBall>, Error> {
    let First { hash, is_one_point } = first_pass(source, &options.monitor)?;
    let mut state = State { source, options, mean: vec![], passes: 1, own: 0.0 };
    let drawn = options.seed % source.len();
    let first = farthest(&state.distances(drawn)?);
    state.mean = state.distances(first)?;
    let second = farthest(&state.mean);
    let mut lambda = BTreeMap::from([(first, 1.0)]);
    let (mut spread, mut taken) = (0.0, 2);
    if second != first {
        spread = state.step(second, 0.5, spread, &mut lambda)?;
        for t in 3..=options.steps {
            if state.passes >= options.max_passes {
                break;
            }
            let next = farthest(&state.mean);
            spread = state.step(next, 1.0 / (t + 2) as f64, spread, &mut lambda)?;
            taken = t;
        }
    }
    let upper = state.mean.iter().copied().fold(0.0, f64::max) - spread;
    let is_flat = upper == 0.0 && (is_one_point || options.kernel == Kernel::Precomputed);
    if !(is_flat || upper.is_finite() && spread > f64::MIN_POSITIVE / f64::EPSILON) {
        return Err(out_of_range(options.kernel));
    }
    let gap = if upper == 0.0 { 0.0 } else { upper / spread - 1.0 };
    let trace = Trace {
        method: KernelBallMethod::Thesis.name().to_owned(),
        stop: if gap <= options.epsilon { Stop::Converged } else { Stop::PassBudget },
        passes: state.passes,
        iterations: taken,
        core_set: lambda.len() as u64,
        ..Trace::default()
    };
    Ok(finish(
        source,
        options,
        hash,
        lambda.into_iter().unzip(),
        upper,
        [upper, spread, state.own],
        trace,
    ))
}

struct State<'a> {
    source: &'a dyn PointSource,
    options: &'a KernelBallOptions<'a>,
    /// aₖ of all points.
    mean: Vec<f64>,
    passes: u64,
    /// The largest K(x, x), for kernels that need it.
    own: f64,
}

impl State<'_> {
    /// ρ from row `id` to all.
    fn distances(&mut self, id: u64) -> Result<Vec<f64>, Error> {
        let (kernel, dim) = (self.options.kernel, self.source.dim());
        let from = Features::read(kernel, self.source, vec![id])?;
        self.passes += 1;
        self.options.monitor.pass(self.passes, self.source.len());
        let blocks = taut_points::map_blocks(self.source, &self.options.monitor, |first, rows| {
            let features = Features::block(kernel, first, &rows, dim);
            let mut out = vec![0.0; rows.len()];
            features.distances_from(kernel, &from, 0, dim, &mut out);
            Ok::<_, Error>((out, features.own_largest()))
        })?;
        self.own = blocks.iter().map(|block| block.1).fold(0.0, f64::max);
        Ok(blocks.into_iter().flat_map(|block| block.0).collect())
    }

    /// λ ← (1 − s)λ + s·e_q; returns the new D.
    fn step(
        &mut self,
        next: u64,
        s: f64,
        spread: f64,
        lambda: &mut BTreeMap<u64, f64>,
    ) -> Result<f64, Error> {
        let distances = self.distances(next)?;
        let at = self.mean[next as usize];
        lambda.values_mut().for_each(|l| *l *= 1.0 - s);
        *lambda.entry(next).or_insert(0.0) += s;
        for (a, rho) in self.mean.iter_mut().zip(&distances) {
            *a += s * (rho - *a);
        }
        Ok((1.0 - s) * ((1.0 - s) * spread + s * at))
    }
}

/// The first of the farthest.
fn farthest(distances: &[f64]) -> u64 {
    let largest = distances.iter().copied().fold(0.0, f64::max);
    distances.iter().position(|&x| x == largest).unwrap_or(0) as u64
}
