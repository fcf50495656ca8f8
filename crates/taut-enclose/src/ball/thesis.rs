//! Algorithm 1 of the thesis: one far point per pass, a conic solver on the core-set. Kept so that its tables and
//! figures can be rerun; [`super::core_set`] is faster and more accurate.
//!
//! *Problem.* As [`super::core_set`].
//! *Idea.* X is the core-set. Find a (1 + δ)-approximate ball B of X by the solver; if (1 + ε/2)·B holds everything,
//! stop; otherwise add the item that reaches farthest. `pure` starts from X = {q, q′}; `fast` first makes d/3 steps
//! of Algorithm 10 ([`super::badoiu_clarkson`]) and starts from the far points these met, many of them more than once.
//! *Guarantee.* R ≤ (1 + ε)·R*, proved; |X| = O(1/ε). An item at distance D > r raises the radius r of X to at least
//! (D² + r²)/(2D), more than the 1 + ε²/33 of Lemma 2.3.2.
//! *Departures.* δ is an option, by default ε², as in the experiments of the thesis; the analysis asks for ε²/163 ([`delta_of_the_lemma`]),
//! which is what a core-set is solved to when δ turns out to be too coarse. The test of step 5 is made from
//! c = Σ λᵢcᵢ, with as radius what holds X from there, and the stop asks for the proved gap, too. For balls the
//! farthest is the one with the largest |c − cᵢ| + rᵢ. Clarabel stands in for SDPT3.
//! *Trap.* A conic solver ends some way above rounding, here at gaps of 1e-13 to 1e-11. What it cannot tell apart must
//! not be added one item a pass endlessly: when everything reaches as far as X does, up to the solver's own gap on X, it
//! is asked for all it can give, and then the method stops with [`Stop::Rounding`].
//! *Evidence.* The thesis names Bădoiu and Clarkson for the steps of the fast variant, not its own Algorithm 10. With
//! the start and the lengths of Algorithm 10 they meet 29 or 30 points in 85 steps on the USPS data, as the thesis
//! reports (30); from p with lengths 1/(i + 1) they meet 35 or 36.
//! *Reference.* Thesis, sections 2.2 to 2.4: Kumar, Mitchell and Yıldırım, ALENEX 2003.

use taut_certify::Stop;

use super::BallOptions;
use super::badoiu_clarkson::Iterate;
use super::conic::{self, Hull};
use super::outcome::Outcome;
use super::run::{Run, Start, diameter_pair};
use super::working_set::WorkingSet;
use crate::Error;
use crate::item_reader::ItemReader;

/// The conic solver is asked for no finer relative accuracy than this.
const ACCURACY_MIN: f64 = 1e-12;

/// Algorithm 1 from the pair (q, q′).
pub(super) fn pure(
    reader: &mut ItemReader<'_>,
    options: &BallOptions<'_>,
) -> Result<Outcome, Error> {
    let mut run = Run::new(reader, options)?;
    match diameter_pair(&mut run)? {
        Start::Pair(set) => algorithm_1(run, set),
        Start::Done(stop, set) => Ok(run.end(stop, &set)),
    }
}

/// Algorithm 1 from the far points that d/3 steps of Algorithm 10 meet.
pub(super) fn fast(
    reader: &mut ItemReader<'_>,
    options: &BallOptions<'_>,
) -> Result<Outcome, Error> {
    let mut run = Run::new(reader, options)?;
    let mut iterate = match diameter_pair(&mut run)? {
        Start::Pair(set) => Iterate::from_middle(set),
        Start::Done(stop, set) => return Ok(run.end(stop, &set)),
    };
    let mut outliers: Vec<u64> = vec![];
    for step in 1..=run.reader.dim() as u64 / 3 {
        let evaluation = run.evaluation(&iterate.set, &iterate.lambda)?;
        if run.reached(&evaluation) {
            return Ok(run.end(Stop::Converged, &iterate.set));
        }
        if run.spent() {
            return Ok(run.end(Stop::PassBudget, &iterate.set));
        }
        if !outliers.contains(&evaluation.farthest) {
            outliers.push(evaluation.farthest);
        }
        iterate.step(&mut run, &evaluation)?;
        run.outcome.count("steps", step);
    }
    // In few dimensions the steps are too few to make a start other than the pair.
    if outliers.len() < 2 {
        outliers = vec![iterate.set.id(0), iterate.set.id(1)];
    }
    let set = run.set_of(&outliers)?;
    algorithm_1(run, set)
}

/// δ of Lemma 2.3.4: a (1 + δ)-approximate ball of X leads to a (1 + ε)-approximate one of all items.
fn delta_of_the_lemma(epsilon: f64) -> f64 {
    epsilon * epsilon / 163.0
}

/// The loop of Algorithm 1.
fn algorithm_1(mut run: Run<'_, '_>, mut set: WorkingSet) -> Result<Outcome, Error> {
    let epsilon = run.options.epsilon;
    let first = run.options.delta.unwrap_or(epsilon * epsilon);
    let finer = [first, delta_of_the_lemma(epsilon), 0.0].map(|d| d.max(ACCURACY_MIN));
    let mut deltas = finer.into_iter();
    let mut delta = deltas.next().expect("there are three");
    let mut hull = Hull::default();
    let (mut solves, mut interior) = (0, 0);
    let stop = loop {
        hull.grow(&set);
        let answer = conic::solve(&set, &hull, delta)?;
        solves += 1;
        interior += answer.steps;
        let evaluation = run.evaluation(&set, &answer.lambda)?;
        if run.reached(&evaluation) && evaluation.upper <= (1.0 + epsilon / 2.0) * evaluation.held {
            break Stop::Converged;
        }
        if run.spent() {
            break Stop::PassBudget;
        }
        // r′/r − 1 for X itself: what the solver left open.
        let left_open = evaluation.held / evaluation.lower - 1.0;
        let told_apart = evaluation.upper > (1.0 + left_open.max(f64::EPSILON)) * evaluation.held;
        if told_apart && !set.contains(evaluation.farthest) {
            run.add(&mut set, evaluation.farthest)?;
        } else {
            match deltas.find(|&finer| finer < delta) {
                Some(finer) => delta = finer,
                None => {
                    break if run.reached(&evaluation) { Stop::Converged } else { Stop::Rounding };
                }
            }
        }
    };
    run.outcome.iterations += solves;
    run.outcome.count("conic_solves", solves);
    run.outcome.count("interior_point_steps", interior);
    Ok(run.end(stop, &set))
}
