//! Minimum enclosing ball by steps to the farthest point, and nothing else: Algorithm 10 of the thesis.
//!
//! *Problem.* As [`super::core_set`].
//! *Idea.* Move the center a shrinking part β of the way to the point that reaches farthest: c ← c + β(p − c), from the
//! middle of the pair (q, q′) with β = 1/(i + 2), i = 3, 4, …
//! *Multipliers.* The step to an item of X is λ ← (1 − β)λ + βe, so c stays a convex combination of the points visited
//! and proves a lower bound at every step. For points the bound changes to r² ← (1 − β)(r² + βD²), D the farthest
//! distance; it may fall, as β does not ask what would be best.
//! *Balls.* The farthest point of a ball lies beyond its center cᵢ: the step to it is a step to cᵢ by βD/(D − rᵢ).
//! Where that would go past cᵢ it ends at cᵢ, which keeps λ convex.
//! *Guarantee.* R ≤ (1 + ε)·R* after 1/ε² steps of O(nd). The steps end as soon as the multipliers prove the gap, or
//! with the budget of passes; the trace says what was reached.
//! *Trap.* The gap falls like 1/i and jumps: ε = 1e-3 takes hundreds of passes where the default method takes three.
//! *Reference.* Bădoiu and Clarkson, Smaller core-sets for balls, SODA 2003.

use taut_certify::Stop;

use super::BallOptions;
use super::outcome::Outcome;
use super::run::{Evaluation, Run, Start, diameter_pair};
use super::working_set::WorkingSet;
use crate::Error;
use crate::item_reader::ItemReader;

/// A center on its way: multipliers over the items visited.
pub(super) struct Iterate {
    pub(super) set: WorkingSet,
    pub(super) lambda: Vec<f64>,
    /// The i of the next step.
    i: u64,
}

impl Iterate {
    /// c₃, the middle of the pair.
    pub(super) fn from_middle(pair: WorkingSet) -> Self {
        Iterate { set: pair, lambda: vec![0.5, 0.5], i: 3 }
    }

    /// The part β = 1/(i + 2) of the way to the farthest point of the item that reaches farthest.
    pub(super) fn step(
        &mut self,
        run: &mut Run<'_, '_>,
        evaluation: &Evaluation,
    ) -> Result<(), Error> {
        let beta = 1.0 / (self.i + 2) as f64;
        self.i += 1;
        run.outcome.iterations += 1;
        let i = match self.set.position(evaluation.farthest) {
            Some(i) => i,
            None => {
                run.add(&mut self.set, evaluation.farthest)?;
                self.lambda.push(0.0);
                self.set.len() - 1
            }
        };
        let to_center = evaluation.upper - self.set.radius(i);
        // For a point this is β itself.
        let beta = if self.set.radius(i) == 0.0 {
            beta
        } else if to_center > beta * evaluation.upper {
            beta * evaluation.upper / to_center
        } else {
            1.0
        };
        self.lambda.iter_mut().for_each(|l| *l *= 1.0 - beta);
        self.lambda[i] += beta;
        Ok(())
    }
}

pub(super) fn solve(
    reader: &mut ItemReader<'_>,
    options: &BallOptions<'_>,
) -> Result<Outcome, Error> {
    let mut run = Run::new(reader, options)?;
    let set = match diameter_pair(&mut run)? {
        Start::Pair(set) => set,
        Start::Done(stop, set) => return Ok(run.end(stop, &set)),
    };
    let mut iterate = Iterate::from_middle(set);
    loop {
        let evaluation = run.evaluation(&iterate.set, &iterate.lambda)?;
        if run.reached(&evaluation) {
            return Ok(run.end(Stop::Converged, &iterate.set));
        }
        if run.spent() {
            return Ok(run.end(Stop::PassBudget, &iterate.set));
        }
        iterate.step(&mut run, &evaluation)?;
    }
}
