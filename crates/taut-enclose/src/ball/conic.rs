//! The ball of a core-set by a conic solver: formula (1) of the thesis.
//!
//! *Problem.* min r subject to |c − cᵢ| + rᵢ ≤ r for the items of X: one second-order cone (r − rᵢ, c − cᵢ) for each.
//! *Idea.* All that matters of X lies in its affine hull, of dimension m < |X|. Factoring the Gram matrix of the
//! cᵢ − c₁ gives coordinates there, the same distances to rounding, and a problem whose size does not depend on d.
//! *Multipliers.* The dual variables of the cones, (tᵢ, zᵢ) with |zᵢ| ≤ tᵢ, satisfy Σ tᵢ = 1 and Σ zᵢ = 0; at the
//! optimum zᵢ = −tᵢ(c − cᵢ)/|c − cᵢ|. So c = Σ λᵢcᵢ with λᵢ in proportion to tᵢ/|c − cᵢ|, where |c − cᵢ| = r − rᵢ: for points
//! λᵢ = tᵢ, and a ball that holds all others has all the weight.
//! *Aim.* The dual is flat at its optimum: a gap γ leaves λ uncertain by √γ, and with it Σ λᵢcᵢ, while the solver's own
//! center is good to γ. So λ is moved the least way that takes Σ λᵢcᵢ to that center ([`aim`]): 1e-7 becomes 1e-12.
//! *Guarantee.* None is taken from the solver: the caller measures center and multipliers in ℝᵈ.
//! *Trap.* The solver is primal-dual and stops with tᵢ of 1e-9 where 0 is meant; these are dropped.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SecondOrderConeT, SolverStatus,
};
use taut_kernels::vector::dot;
use taut_points::OrderBy;

use super::factor::Factor;
use super::working_set::WorkingSet;
use crate::Error;

/// An item lies in the hull of those before it when its squared distance to it is below this part of its squared norm:
/// leaving that out changes no squared distance by more.
const IN_HULL: f64 = 1e-13;
/// Multipliers below this part of the largest stand for 0.
const MULTIPLIER_RATIO_MIN: f64 = 1e-9;
/// An item depends on others when its pivot is below this part of its squared norm, as in the default method.
const DEPENDENT_RATIO: f64 = 1e-11;

/// When the solver gets nowhere, it is asked for less in steps of this factor, down to [`ACCURACY_MAX`].
const ACCURACY_STEP: f64 = 100.0;
/// The solver is asked for no coarser relative accuracy than this.
const ACCURACY_MAX: f64 = 1e-6;

/// The items of a set in coordinates of their affine hull, with item 0 as origin.
#[derive(Default)]
pub(super) struct Hull {
    /// Row i of the Cholesky factor of the Gram matrix: as many coordinates as the hull had then.
    coordinates: Vec<Vec<f64>>,
    /// The items that brought a new dimension.
    pivots: Vec<usize>,
}

impl Hull {
    /// Takes in the items that were added to the set, whose origin must be its item 0.
    pub(super) fn grow(&mut self, set: &WorkingSet) {
        for i in self.coordinates.len()..set.len() {
            let gram = set.gram_row(i);
            let mut x = Vec::with_capacity(self.pivots.len() + 1);
            for (k, &pivot) in self.pivots.iter().enumerate() {
                let other = &self.coordinates[pivot];
                x.push((gram[pivot] - dot(&x, &other[..k])) / other[k]);
            }
            let beyond = gram[i] - dot(&x, &x);
            if beyond > IN_HULL * gram[i] && self.pivots.len() < set.dim() {
                x.push(beyond.sqrt());
                self.pivots.push(i);
            }
            self.coordinates.push(x);
        }
    }

    fn coordinate(&self, i: usize, k: usize) -> f64 {
        self.coordinates[i].get(k).copied().unwrap_or(0.0)
    }

    fn dim(&self) -> usize {
        self.pivots.len()
    }
}

/// The answer of the conic solver.
pub(super) struct Answer {
    /// A multiplier for each item; they sum to 1.
    pub(super) lambda: Vec<f64>,
    /// Steps of its interior-point method.
    pub(super) steps: u64,
}

/// The ball of the set, to the relative accuracy `tolerance`.
pub(super) fn solve(set: &WorkingSet, hull: &Hull, tolerance: f64) -> Result<Answer, Error> {
    let (items, dim) = (set.len(), hull.dim());
    let spread = (0..items).map(|i| set.norm2(i)).fold(0.0, f64::max).sqrt();
    if dim == 0 {
        // All centers are one: the largest ball holds the others.
        let largest = (1..items).fold(0, |l, i| if set.radius(i) > set.radius(l) { i } else { l });
        let mut lambda = vec![0.0; items];
        lambda[largest] = 1.0;
        return Ok(Answer { lambda, steps: 0 });
    }
    // Variables c₁ … c_m and r, in units of the spread; slack of item i: (r − rᵢ, c − cᵢ) = b − A(c, r). All radii are
    // less the largest, which changes r by as much and keeps digits where the radii are much larger than the spread.
    let largest = (0..items).map(|i| set.radius(i)).fold(0.0, f64::max);
    let rows = items * (dim + 1);
    let b: Vec<f64> = (0..items)
        .flat_map(|i| {
            let center = (0..dim).map(move |k| -hull.coordinate(i, k) / spread);
            std::iter::once((largest - set.radius(i)) / spread).chain(center)
        })
        .collect();
    let a = CscMatrix::new(
        rows,
        dim + 1,
        (0..=dim + 1).map(|column| column * items).collect(),
        (1..=dim).chain([0]).flat_map(|k| (0..items).map(move |i| i * (dim + 1) + k)).collect(),
        vec![-1.0; items * (dim + 1)],
    );
    let mut objective = vec![0.0; dim + 1];
    objective[dim] = 1.0;
    let cones = vec![SecondOrderConeT(dim + 1); items];
    let quadratic = CscMatrix::zeros((dim + 1, dim + 1));
    let failed = |status: String| Error::Conic { status, points: items };
    let (mut tolerance, mut steps) = (tolerance, 0);
    let solution = loop {
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .max_threads(1)
            .tol_gap_abs(tolerance)
            .tol_gap_rel(tolerance)
            .tol_feas(tolerance)
            .build()
            .expect("the settings are in range");
        let mut solver = DefaultSolver::new(&quadratic, &objective, &a, &b, &cones, settings)
            .map_err(|error| failed(error.to_string()))?;
        solver.solve();
        steps += u64::from(solver.solution.iterations);
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => break solver.solution,
            // On nearly cospherical items a tolerance out of reach can end in nothing at all.
            SolverStatus::InsufficientProgress if tolerance < ACCURACY_MAX => {
                tolerance *= ACCURACY_STEP
            }
            status => return Err(failed(status.to_string())),
        }
    };
    let duals: Vec<f64> = solution.z.chunks_exact(dim + 1).map(|z| z[0]).collect();
    let distances: Vec<f64> = (0..items)
        .map(|i| {
            let squares = (0..dim).map(|k| {
                let difference = solution.x[k] - hull.coordinate(i, k) / spread;
                difference * difference
            });
            squares.sum::<f64>().sqrt()
        })
        .collect();
    let mut lambda = multipliers(&duals, &distances);
    let center: Vec<f64> = solution.x[..dim].iter().map(|c| c * spread).collect();
    aim(set, hull, &mut lambda, &center);
    Ok(Answer { lambda, steps })
}

/// λᵢ in proportion to tᵢ/|c − cᵢ|, without what stands for 0.
fn multipliers(duals: &[f64], distances: &[f64]) -> Vec<f64> {
    let mut lambda: Vec<f64> = duals
        .iter()
        .zip(distances)
        .map(|(&t, &distance)| t.max(0.0) / distance.max(f64::MIN_POSITIVE.sqrt()))
        .collect();
    let largest = lambda.iter().copied().fold(0.0, f64::max);
    for l in &mut lambda {
        *l = if *l < MULTIPLIER_RATIO_MIN * largest { 0.0 } else { *l / largest };
    }
    let total: f64 = lambda.iter().sum();
    lambda.iter_mut().for_each(|l| *l /= total);
    lambda
}

/// Moves λ the way that takes Σ λᵢcᵢ to `center`, or as near as λ ≥ 0 allows. Only items that are affinely independent
/// are moved, chosen by their λ, the largest first; there is one way to move these.
fn aim(set: &WorkingSet, hull: &Hull, lambda: &mut [f64], center: &[f64]) {
    let sigma = (0..set.len()).map(|i| set.norm2(i)).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..set.len()).filter(|&i| lambda[i] > 0.0).collect();
    order.order_by(&|&i, &j| lambda[j].total_cmp(&lambda[i]));
    let mut factor = Factor::default();
    let mut support: Vec<usize> = vec![];
    for i in order {
        let column: Vec<f64> = support.iter().map(|&j| set.gram_row(i)[j] + sigma).collect();
        let z = factor.forward(&column);
        let pivot2 = set.norm2(i) + sigma - dot(&z, &z);
        if pivot2 > DEPENDENT_RATIO * (set.norm2(i) + sigma) && support.len() <= hull.dim() {
            factor.append(&z, pivot2.sqrt(), 0.0);
            support.push(i);
        }
    }
    while !support.is_empty() {
        let mut missing = center.to_vec();
        for (i, &l) in lambda.iter().enumerate() {
            missing.iter_mut().zip(&hull.coordinates[i]).for_each(|(m, x)| *m -= l * x);
        }
        let along: Vec<f64> = support
            .iter()
            .map(|&i| hull.coordinates[i].iter().zip(&missing).map(|(x, m)| x * m).sum())
            .collect();
        let change = factor.correction(&along);
        // The first to become 0 leaves, and the others go on.
        let mut first = None;
        let mut step = 1.0;
        for (position, (&i, &c)) in support.iter().zip(&change).enumerate() {
            if c < 0.0 && lambda[i] < -c * step {
                (first, step) = (Some(position), lambda[i] / -c);
            }
        }
        for (&i, c) in support.iter().zip(&change) {
            lambda[i] = (lambda[i] + step * c).max(0.0);
        }
        let Some(first) = first else { return };
        lambda[support[first]] = 0.0;
        factor.delete(first);
        support.remove(first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The set of `rows`, each with a radius in the last place, relative to the first.
    fn set_of(rows: &[&[f64]]) -> (WorkingSet, Hull) {
        let dim = rows[0].len() - 1;
        let mut set = WorkingSet::new(rows[0][..dim].to_vec(), 0.0);
        for (id, row) in (0..).zip(rows) {
            set.add(&[id], row.to_vec(), true);
        }
        let mut hull = Hull::default();
        hull.grow(&set);
        (set, hull)
    }

    fn close(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance);
        assert!(near, "{found:?} is not {expected:?}");
    }

    #[test]
    fn the_hull_keeps_distances_and_has_its_own_dimension() {
        // A tetrahedron in ℝ⁵, its centroid, and a vertex again: dimension 3.
        let vertices = [
            [1.0, 2.0, 3.0, 4.0, 5.0, 0.0],
            [2.0, 2.0, 1.0, 0.0, 5.0, 0.0],
            [0.0, 1.0, 0.0, 1.0, 0.0, 0.0],
            [3.0, 0.0, 2.0, 2.0, 1.0, 0.0],
        ];
        let centroid: [f64; 6] =
            std::array::from_fn(|j| vertices.iter().map(|v| v[j]).sum::<f64>() / 4.0);
        let mut rows: Vec<&[f64]> = vertices.iter().map(|v| &v[..]).collect();
        rows.extend([&centroid[..], &vertices[2][..]]);
        let (_, hull) = set_of(&rows);
        assert_eq!(hull.dim(), 3);
        for (i, p) in rows.iter().enumerate() {
            for (j, q) in rows.iter().enumerate() {
                let squares = |d: f64| d * d;
                let there: f64 =
                    (0..3).map(|k| squares(hull.coordinate(i, k) - hull.coordinate(j, k))).sum();
                let here: f64 = p.iter().zip(*q).map(|(p, q)| squares(p - q)).sum();
                assert!((there - here).abs() < 1e-12, "{i} {j}: {there} {here}");
            }
        }
    }

    #[test]
    fn multipliers_of_points_give_the_circumcenter() {
        // The right angle is on the sphere, too, and carries nothing: the solver knows λ only to a root there.
        let (set, hull) =
            set_of(&[&[0.0, 0.0, 0.0], &[3.0, 0.0, 0.0], &[0.0, 4.0, 0.0], &[1.0, 1.0, 0.0]]);
        let answer = solve(&set, &hull, 1e-12).unwrap();
        close(&answer.lambda, &[0.0, 0.5, 0.5, 0.0], 1e-5);
        assert!(answer.steps > 0);
        // An equilateral triangle: all the same.
        let (set, hull) = set_of(&[&[0.0, 0.0, 0.0], &[2.0, 0.0, 0.0], &[1.0, 3f64.sqrt(), 0.0]]);
        close(&solve(&set, &hull, 1e-12).unwrap().lambda, &[1.0 / 3.0; 3], 1e-10);
    }

    #[test]
    fn multipliers_of_balls_weigh_by_the_distance_of_the_center() {
        // On a line: radius 1 at 0 and 2 at 7 are held by radius 5 around 4, which is 4 and 3 away from them.
        let (set, hull) = set_of(&[&[0.0, 1.0], &[7.0, 2.0], &[3.0, 0.5]]);
        let answer = solve(&set, &hull, 1e-12).unwrap();
        close(&answer.lambda, &[3.0 / 7.0, 4.0 / 7.0, 0.0], 1e-10);
        // One ball holds the other, with and without a common center.
        let (set, hull) = set_of(&[&[0.0, 1.0], &[1.0, 5.0]]);
        close(&solve(&set, &hull, 1e-12).unwrap().lambda, &[0.0, 1.0], 1e-6);
        let (set, hull) = set_of(&[&[2.0, 1.0], &[2.0, 5.0]]);
        close(&solve(&set, &hull, 1e-12).unwrap().lambda, &[0.0, 1.0], 0.0);
    }
}
