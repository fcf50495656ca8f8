//! The ellipsoid of a working set of points: Newton's method on the dual, each quadratic model solved exactly.
//!
//! *Problem.* Points p₁…p_k, m = d + 1: multipliers u ≥ 0 that maximize f(u) = ln det Σ uᵢqᵢqᵢ′ − m·Σuᵢ, qᵢ = (pᵢ, 1).
//! Its maximizer sums to 1 by itself, and is that of the D-optimal design, the dual of the ellipsoid.
//! *Idea.* In coordinates in which Σ uᵢwᵢwᵢ′ = 1 the second-order model of f is a non-negative least squares ([`nnls`]),
//! solved from the points in use; then a step towards its solution, as long as f rises.
//! *Guarantee.* f never falls by a step of Newton's. Near the optimum the number of right digits doubles with each step, degenerate or not:
//! five to seven steps from uniform multipliers, one to three from those of a smaller working set.
//! *Hard working sets*, whose models take too many exchanges, go to an interior-point method ([`interior`]), and from then on each of
//! their rounds starts there. Where its answer has to be that of few points, the active set takes it from its largest multipliers.
//! *Trap.* The largest leverage does not fall with every step: the best multipliers are kept.
//! *Reference.* Sun and Freund, Operations Research 52(5), 2004, and Bowman and Heath, Math. Prog. Comp. 15, 2023, take
//! Newton steps on the face of the points in use and drop one point at a time; here the face is part of each model.

use taut_points::{Monitor, ReadError};

use super::counters::Counters;
use super::dense::line_search;
use super::interior;
use super::nnls::{self, Outcome};
use super::whitener::{Rebased, Whitened, Whitener};
use super::working_set::WorkingSet;
use crate::Error;

/// A covariance this near the identity needs no further turn of the whitener.
pub(super) const REBASE_TOLERANCE: f64 = 0.1;
/// Gradients below this part of the largest excess leverage are left to the next step.
const GRADIENT_RATIO_MIN: f64 = 0.02;
/// Where N is nearer to 1 than this, the whole step is taken without a line search.
const WHOLE_STEP: f64 = 0.2;
/// After this many steps rounding is what is left; hard working sets have needed thirty.
const STEPS_MAX: usize = 200;
/// Of smaller gaps than [`SMALL_GAP`], this many steps that do not improve the best leverage show that it is the best.
const STEPS_WITHOUT_PROGRESS_MAX: usize = 3;
/// The interior-point method starts from the ellipsoid of before only where points are outside by less than this gap.
const START_GAP_MAX: f64 = 1.0;
/// The interior-point method is to come nearer than is enough by this factor: what it hands back is normalized once more.
const INTERIOR_RATIO: f64 = 0.3;
/// Below this gap, rounding may be what keeps the leverage from improving.
const SMALL_GAP: f64 = 1e-6;

/// The logarithm of what the ellipsoid has to grow by in volume: (d/2)·ln(largest/d) for a largest |y|².
pub(super) fn gap(dim: usize, largest: f64) -> f64 {
    let dim = dim as f64;
    (0.5 * dim * (largest / dim).ln()).max(0.0)
}

/// The gap of a working set that is small enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerance {
    /// As long as every model is solved by pivots.
    pub(super) easy: f64,
    /// Once it takes the interior-point method, which comes nearer by a digit in three steps rather than by all.
    pub(super) hard: f64,
    /// True if a basis is wanted, so that the interior-point method's multipliers on all points will not do.
    pub(super) basis: bool,
}

impl Tolerance {
    /// As small as rounding lets it be.
    pub(super) const NONE: Self = Tolerance { easy: 0.0, hard: 0.0, basis: true };
}

/// Improves the multipliers of a working set until its gap is at most the tolerance, or rounding is in the way.
///
/// Ends with the whitener of the multipliers, and says by what factor each |y|² may exceed d in the working set.
pub(super) fn solve(
    set: &mut WorkingSet,
    whitener: &mut Whitener,
    tolerance: Tolerance,
    counters: &mut Counters,
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let dim = set.dim();
    let m = dim + 1;
    let mut best: Option<(f64, Vec<f64>)> = None;
    // The least since multipliers were left out.
    let mut least = f64::INFINITY;
    let mut progress_left = STEPS_WITHOUT_PROGRESS_MAX;
    let interior_steps = counters.interior;
    let interior_tolerance = INTERIOR_RATIO * tolerance.hard;
    // True while the multipliers are those of the interior-point method, on all points.
    let mut full = interior_steps > 0 && !interior::is_basis(set);
    // True where these are so good that a start of that method would go back.
    let mut is_too_near = false;
    if full {
        let largest = whitener.apply(set).largest();
        let outside = gap(dim, largest);
        full = outside < START_GAP_MAX;
        if full && outside > tolerance.hard {
            is_too_near = !interior::can_start(dim, largest);
            if !is_too_near {
                interior::solve(set, whitener, interior_tolerance, counters, monitor)?;
            }
        }
    }
    let mut whitened = Whitened::default();
    for _ in 0..STEPS_MAX {
        monitor.check().map_err(ReadError::from)?;
        if whitener.rebase(set, REBASE_TOLERANCE) == Rebased::Never {
            break;
        }
        whitener.apply_in_place(set, &mut whitened);
        let largest = whitened.largest();
        if best.as_ref().is_none_or(|(least, _)| largest < *least) {
            best = Some((largest, set.weights().to_vec()));
        }
        let best_gap = best.as_ref().map_or(f64::INFINITY, |(largest, _)| gap(dim, *largest));
        let tried = is_too_near || counters.interior > interior_steps;
        let enough = if full || tried { tolerance.hard } else { tolerance.easy };
        if full && (tolerance.basis || best_gap > enough) {
            interior::keep_basis(set);
            (full, least) = (false, f64::INFINITY);
            continue;
        }
        if largest < least {
            least = largest;
        } else if gap(dim, largest) < SMALL_GAP {
            progress_left -= 1;
        }
        if gap(dim, largest) <= enough {
            if tolerance.basis {
                best = Some((largest, set.weights().to_vec()));
            }
            break;
        }
        if progress_left == 0 {
            break;
        }
        counters.steps += 1;
        let excess = largest - dim as f64;
        // Where there is an answer that will do but for its size, no other is worth many exchanges.
        let patience = nnls::patience(set.len(), dim, tried && best_gap > enough);
        let u = set.weights();
        let model = nnls::solve(dim, &whitened, u, GRADIENT_RATIO_MIN * excess, patience, counters);
        let step = match model {
            Outcome::Solved(step) => step,
            // Once: models made at its basis are short.
            Outcome::Stuck if !tried && best_gap > tolerance.hard => {
                interior::solve(set, whitener, interior_tolerance, counters, monitor)?;
                full = true;
                continue;
            }
            Outcome::Stuck => break,
        };
        let t = length(&step.matrix, m);
        if t < 1e-12 {
            break;
        }
        let weights = set.weights_mut();
        weights.iter_mut().for_each(|u| *u *= 1.0 - t);
        for (i, v) in step.weights {
            weights[i] += t * v;
        }
        set.normalize();
    }
    let Some((largest, weights)) = best else { return Ok(f64::INFINITY) };
    if weights != set.weights() {
        set.weights_mut().copy_from_slice(&weights);
        whitener.rebase(set, REBASE_TOLERANCE);
    }
    Ok(largest)
}

/// Returns how far to go towards the solution of the model, N being the matrix of that.
fn length(matrix: &[f64], m: usize) -> f64 {
    let mut e = matrix.to_vec();
    let mut square = 0.0;
    for a in 0..m {
        e[a * m + a] -= 1.0;
        for b in 0..=a {
            square += if a == b { 1.0 } else { 2.0 } * e[a * m + b] * e[a * m + b];
        }
    }
    if square < WHOLE_STEP * WHOLE_STEP {
        return 1.0;
    }
    // The last entry of N is Σv.
    line_search(&e, m, m as f64 * e[m * m - 1])
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::*;

    fn solved(rows: &[f64], dim: usize) -> (WorkingSet, f64) {
        let mut set = WorkingSet::new(dim);
        for (i, row) in rows.chunks_exact(dim).enumerate() {
            set.push(i as u64, row, 1.0);
        }
        set.normalize();
        let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
        let (mut counters, monitor) = (Counters::default(), Monitor::silent());
        let tolerance = Tolerance { easy: 1e-13, hard: 1e-13, basis: true };
        let largest = solve(&mut set, &mut whitener, tolerance, &mut counters, &monitor).unwrap();
        (set, largest)
    }

    #[test]
    fn known_designs_are_found() {
        // A triangle with an inner point, which gets no weight; a square with its center.
        let (set, largest) = solved(&[0.0, 0.0, 5.0, 0.0, 0.0, 1.0, 1.0, 0.25], 2);
        assert!(gap(2, largest) <= 1e-13);
        assert!(set.weights()[..3].iter().all(|u| (u - 1.0 / 3.0).abs() < 1e-13));
        assert_eq!(set.weights()[3], 0.0);
        let (set, largest) = solved(&[1.0, 1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 0.0, 0.0], 2);
        assert!(gap(2, largest) <= 1e-13);
        assert_eq!(set.weights()[4], 0.0);
        // On a line the two ends, half and half.
        let (set, largest) = solved(&[3.0, -1.0, 0.5, 2.9], 1);
        assert!(gap(1, largest) <= 1e-13);
        assert!(set.weights()[..2].iter().all(|u| (u - 0.5).abs() < 1e-15));
        assert_eq!(set.weights()[2..], [0.0, 0.0]);
    }

    /// Where a start of the interior-point method would go back, the active set comes nearer by itself.
    #[test]
    fn a_set_that_is_nearly_solved_is_left_to_the_active_set() {
        let (n, dim) = (300, 5);
        let shell = Distribution::Shell { thickness: 1e-8 };
        let rows: Vec<f64> = generate(shell, n, dim, 6).unwrap();
        let mut set = WorkingSet::of_rows(dim, (0..n as u64).collect(), &rows);
        let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
        let (mut counters, monitor) = (Counters::default(), Monitor::silent());
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        interior::solve(&mut set, &whitener, 1e-12, &mut counters, &monitor).unwrap();
        whitener.rebase(&set, REBASE_TOLERANCE);
        let (before, steps) = (whitener.apply(&set).largest(), counters.interior);
        assert!(!interior::can_start(dim, before) && !interior::is_basis(&set));
        let tolerance = Tolerance { easy: 0.0, hard: 0.5 * gap(dim, before), basis: true };
        let largest = solve(&mut set, &mut whitener, tolerance, &mut counters, &monitor).unwrap();
        assert_eq!(counters.interior, steps);
        assert!(largest <= before && counters.steps > 0, "{largest} {before}");
    }

    #[test]
    fn a_gap_is_the_growth_in_volume() {
        assert_eq!((gap(3, 3.0), gap(3, 2.9)), (0.0, 0.0));
        assert!((gap(2, 4.0) - 2f64.ln()).abs() < 1e-15);
    }
}
