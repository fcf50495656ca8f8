//! The parts that the methods of the thesis share: where they start, and the pass from a convex combination with its bounds.
//!
//! A combination λ over a set X of items is a center c = Σ λᵢcᵢ. It proves a lower bound on R* by itself, and one pass
//! from c gives the upper bound and the item that reaches farthest, which is all these methods ask of a pass.

use taut_certify::{Items, PassBounds, Stop};
use taut_kernels::{Center, relative_error};

use super::BallOptions;
use super::core_set::{ROUNDING, lower_bound};
use super::outcome::Outcome;
use super::working_set::WorkingSet;
use crate::Error;
use crate::item_reader::{ItemReader, Query};

/// A method at work.
pub(super) struct Run<'s, 'a> {
    pub(super) reader: &'s mut ItemReader<'a>,
    pub(super) options: &'s BallOptions<'s>,
    pub(super) outcome: Outcome,
    offered: bool,
}

/// The result of a pass from a combination.
pub(super) struct Evaluation {
    /// The item that reaches farthest.
    pub(super) farthest: u64,
    /// Its reach: the radius that encloses all items.
    pub(super) upper: f64,
    /// The radius that encloses X from this center.
    #[cfg(feature = "conic")]
    pub(super) held: f64,
    /// The lower bound on R* that λ proves.
    pub(super) lower: f64,
}

impl Evaluation {
    /// `upper / lower − 1`.
    pub(super) fn gap(&self) -> f64 {
        if self.upper == 0.0 { 0.0 } else { self.upper / self.lower - 1.0 }
    }
}

impl<'s, 'a> Run<'s, 'a> {
    /// Makes the first pass, which settles scale and hash and finds fault with the input.
    pub(super) fn new(
        reader: &'s mut ItemReader<'a>,
        options: &'s BallOptions<'s>,
    ) -> Result<Self, Error> {
        reader.first(1)?;
        Ok(Run { reader, options, outcome: Outcome::new(), offered: false })
    }

    /// The item p of Lemma 2.1.1, "any": the one that the seed names.
    pub(super) fn seed_item(&self) -> u64 {
        self.options.seed % self.reader.len()
    }

    /// The set X of these different items; rows will be taken relative to the first.
    pub(super) fn set_of(&self, ids: &[u64]) -> Result<WorkingSet, Error> {
        let rows = self.reader.rows(ids)?;
        let mut set = WorkingSet::new(rows[..self.reader.dim()].to_vec(), 0.0);
        set.add(ids, rows, self.reader.items() == Items::Balls);
        Ok(set)
    }

    /// X ← X ∪ {item}.
    pub(super) fn add(&self, set: &mut WorkingSet, id: u64) -> Result<(), Error> {
        set.add(&[id], self.reader.rows(&[id])?, self.reader.items() == Items::Balls);
        Ok(())
    }

    /// One pass from Σ λᵢcᵢ over X; λ has a place for each item of X and sums to 1 up to rounding.
    pub(super) fn evaluation(
        &mut self,
        set: &WorkingSet,
        lambda: &[f64],
    ) -> Result<Evaluation, Error> {
        let total: f64 = lambda.iter().sum();
        let support: Vec<usize> = (0..set.len()).filter(|&i| lambda[i] > 0.0).collect();
        let weights: Vec<f64> = support.iter().map(|&i| lambda[i] / total).collect();
        let offset = set.combination(&support, &weights);
        let reach = |i: usize| {
            let squares = set.row(i).iter().zip(&offset).map(|(x, c)| (x - c) * (x - c));
            squares.sum::<f64>().sqrt() + set.radius(i)
        };
        let held = (0..set.len()).map(reach).fold(0.0, f64::max);
        // No ball is smaller than one it holds.
        let lower = (0..set.len())
            .map(|i| set.radius(i))
            .fold(lower_bound(set, &support, &weights), f64::max);

        let center = match support[..] {
            // One item is its own center, to the last bit.
            [only] => {
                let row = self.reader.rows(&[set.id(only)])?;
                Center { high: row[..self.reader.dim()].to_vec(), low: vec![] }
            }
            _ => set.center(&support, &weights, lower),
        };
        let above = held * held * (1.0 - 4.0 * relative_error(self.reader.dim())).max(0.0);
        let keep = set.len() + 64;
        let query = Query { center: &center, above, keep, by_face_above: None };
        let found = self.reader.farthest(query)?;
        let upper = found.farthest.reach2.sqrt();
        let evaluation = Evaluation {
            farthest: found.farthest.id,
            upper,
            #[cfg(feature = "conic")]
            held,
            lower,
        };
        // A single point proves nothing yet, unless it is all there is.
        if lower > 0.0 || upper == 0.0 {
            self.outcome.bounds(PassBounds { lower, upper, working_set: set.len() as u64 });
            let ids = support.iter().map(|&i| set.id(i)).collect();
            self.outcome.offer(evaluation.gap(), || (ids, weights, center, found));
            self.offered = true;
        }
        Ok(evaluation)
    }

    /// Returns true if the gap is as small as was asked.
    pub(super) fn reached(&self, evaluation: &Evaluation) -> bool {
        evaluation.gap() <= if self.options.epsilon > 0.0 { self.options.epsilon } else { ROUNDING }
    }

    /// Returns true if the passes are used up and there is something to return.
    pub(super) fn spent(&self) -> bool {
        self.offered && self.reader.passes() >= self.options.max_passes
    }

    /// The outcome of a run that ended with X.
    pub(super) fn end(mut self, stop: Stop, set: &WorkingSet) -> Outcome {
        self.outcome.stop = Some(stop);
        self.outcome.core_set = set.len() as u64;
        self.outcome
    }
}

/// A start, unless it is already the end.
pub(super) enum Start {
    /// X = {q, q′}.
    Pair(WorkingSet),
    /// One item is the answer.
    Done(Stop, WorkingSet),
}

/// The approximate diameter of Lemma 2.1.1: q farthest from p, q′ farthest from q; at least 1/√3 of the diameter.
pub(super) fn diameter_pair(run: &mut Run<'_, '_>) -> Result<Start, Error> {
    let p = run.set_of(&[run.seed_item()])?;
    let from_p = run.evaluation(&p, &[1.0])?;
    if run.reached(&from_p) {
        return Ok(Start::Done(Stop::Converged, p));
    }
    let mut set = run.set_of(&[from_p.farthest])?;
    let from_q = run.evaluation(&set, &[1.0])?;
    if run.reached(&from_q) {
        return Ok(Start::Done(Stop::Converged, set));
    }
    if set.contains(from_q.farthest) {
        // A ball that reaches beyond all others even from its own center is the answer, to rounding.
        return Ok(Start::Done(Stop::Rounding, set));
    }
    run.add(&mut set, from_q.farthest)?;
    Ok(Start::Pair(set))
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, Monitor, Points, generate};

    use super::*;

    #[test]
    fn the_pair_is_at_least_the_diameter_over_root_three() {
        for (seed, distribution) in
            [Distribution::Normal, Distribution::Uniform, Distribution::Sphere]
                .into_iter()
                .enumerate()
        {
            let values: Vec<f64> = generate(distribution, 200, 3, seed as u64).unwrap();
            let points = Points::new(&values, 3).unwrap();
            let monitor = Monitor::silent();
            let mut reader = ItemReader::new(&points, Items::Points, &monitor).unwrap();
            let options = BallOptions { seed: 17 * seed as u64, ..BallOptions::default() };
            let mut run = Run::new(&mut reader, &options).unwrap();
            let Start::Pair(pair) = diameter_pair(&mut run).unwrap() else { panic!("no pair") };
            let distance = |a: &[f64], b: &[f64]| -> f64 {
                a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let diameter = values
                .chunks(3)
                .flat_map(|a| values.chunks(3).map(move |b| distance(a, b)))
                .fold(0.0, f64::max);
            let found = distance(pair.row(0), pair.row(1));
            assert!(found <= diameter * (1.0 + 1e-12));
            assert!(3f64.sqrt() * found >= diameter, "{found} of {diameter}");
        }
    }
}
