//! Weights of facets that separate two bodies.
//!
//! *Idea.* One facet of either body keeps the other body out. At the vertex of the other that is nearest to this facet three
//! facets meet, a positive combination of whose normals is opposite to it.

use taut_points::OrderBy;

use super::super::directions::gcd;
use super::super::polytope::{self, Sides};
use super::super::vectors::dot;

/// How near to a vertex a facet passes that meets there, in units: rounding, and the units by which facets have moved inward.
const VERTEX_UNITS_MAX: f64 = 8.0;

/// How far the other body may reach over a facet before it is moved inward, in units; rounding is below one.
const OVERLAP_UNITS_MAX: f64 = 8.0;

/// Facets that meet at a vertex and are tried, at most.
const FACETS_AT_VERTEX_MAX: usize = 12;

/// A body with its vertices.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) sides: Sides,
    vertices: Vec<[f64; 3]>,
}

impl Shape {
    pub(super) fn of(sides: &Sides, inside: [i32; 3]) -> Self {
        Shape { sides: sides.clone(), vertices: polytope::facets(sides, inside).concat() }
    }

    /// The least of a linear function on the body, where the body is bounded by vertices.
    fn least(&self, u: [f64; 3]) -> f64 {
        self.vertices.iter().map(|&v| dot(u, v)).fold(f64::INFINITY, f64::min)
    }
}

/// Returns facets and weights that separate two bodies, after moving facets of the second one inward by some units where this
/// helps. Facets of the second count on from those of the first.
pub(super) fn separation(one: &Shape, two: &mut Shape) -> Option<Vec<u64>> {
    let overlap = |by: &Shape, other: &Shape, j: usize| {
        let u = by.sides.normals[j];
        (by.sides.offsets[j] - other.least(u)) / dot(u, u).sqrt()
    };
    let of_one = (0..one.sides.normals.len()).map(|j| (overlap(one, two, j), true, j));
    let of_two = (0..two.sides.normals.len()).map(|j| (overlap(two, one, j), false, j));
    let mut facets: Vec<(f64, bool, usize)> = of_one.chain(of_two).collect();
    facets.retain(|facet| facet.0 <= OVERLAP_UNITS_MAX);
    facets.order_by(&|a, b| a.0.total_cmp(&b.0));
    facets.into_iter().find_map(|(_, is_of_one, j)| match is_of_one {
        true => {
            let (triple, weights, weight) =
                opposed(&two.sides, &two.vertices, one.sides.normals[j])?;
            let limit = -i128::from(weight) * whole(one.sides.offsets[j]);
            while sum(&two.sides, triple, weights) > limit {
                for (&facet, &weight) in triple.iter().zip(&weights) {
                    two.sides.offsets[facet] -= f64::from(u8::from(weight > 0));
                }
            }
            let first = one.sides.normals.len();
            Some(entry(
                [j, triple[0] + first, triple[1] + first, triple[2] + first],
                weight,
                weights,
            ))
        }
        false => {
            let (triple, weights, weight) =
                opposed(&one.sides, &one.vertices, two.sides.normals[j])?;
            let most = -sum(&one.sides, triple, weights);
            let most = most.div_euclid(i128::from(weight)) as f64;
            two.sides.offsets[j] = two.sides.offsets[j].min(most);
            Some(entry(
                [j + one.sides.normals.len(), triple[0], triple[1], triple[2]],
                weight,
                weights,
            ))
        }
    })
}

fn whole(offset: f64) -> i128 {
    offset as i128
}

fn sum(sides: &Sides, triple: [usize; 3], weights: [i64; 3]) -> i128 {
    triple
        .iter()
        .zip(weights)
        .map(|(&j, weight)| i128::from(weight) * whole(sides.offsets[j]))
        .sum()
}

fn entry(facets: [usize; 4], weight: i64, [a, b, c]: [i64; 3]) -> Vec<u64> {
    let terms = facets.into_iter().zip([weight, a, b, c]).filter(|term| term.1 > 0);
    terms.flat_map(|(facet, weight)| [facet as u64, weight as u64]).collect()
}

/// Facets that meet at the lowest vertex along a normal, with weights whose sum is opposite to a multiple of the normal.
fn opposed(
    sides: &Sides,
    vertices: &[[f64; 3]],
    normal: [f64; 3],
) -> Option<([usize; 3], [i64; 3], i64)> {
    let vertex = vertices.iter().min_by(|a, b| dot(normal, **a).total_cmp(&dot(normal, **b)))?;
    let mut meeting: Vec<(f64, usize)> = (0..sides.normals.len())
        .map(|j| {
            let u = sides.normals[j];
            ((sides.offsets[j] - dot(u, *vertex)).abs() / dot(u, u).sqrt(), j)
        })
        .filter(|near| near.0 <= VERTEX_UNITS_MAX)
        .collect();
    meeting.order_by(&|a, b| a.0.total_cmp(&b.0));
    meeting.truncate(FACETS_AT_VERTEX_MAX);
    let target = normal.map(|x| -x as i64);
    for (at, &(_, i)) in meeting.iter().enumerate() {
        for (next, &(_, j)) in meeting[..at].iter().enumerate() {
            for &(_, k) in &meeting[..next] {
                let [u, v, w] = [i, j, k].map(|facet| sides.normals[facet].map(|x| x as i64));
                let divisor = determinant(u, v, w);
                let weights = [
                    determinant(target, v, w),
                    determinant(u, target, w),
                    determinant(u, v, target),
                ];
                let weights = weights.map(|weight| weight * divisor.signum());
                if divisor != 0 && weights.iter().all(|&weight| weight >= 0) {
                    let all = weights.iter().fold(divisor.abs(), |all, &weight| gcd(all, weight));
                    return Some((
                        [i, j, k],
                        weights.map(|weight| weight / all),
                        divisor.abs() / all,
                    ));
                }
            }
        }
    }
    None
}

fn determinant(u: [i64; 3], v: [i64; 3], w: [i64; 3]) -> i64 {
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: f64, high: f64) -> Shape {
        let axes =
            [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let normals: Vec<[f64; 3]> = axes.into_iter().chain([[0.0, 0.0, -1.0]]).collect();
        let offsets = (0..6).map(|j| if j % 2 == 0 { high } else { -low }).collect();
        Shape::of(&Sides { normals, offsets }, [f64::midpoint(low, high) as i32; 3])
    }

    #[test]
    fn cubes_that_touch_are_separated_and_those_that_overlap_are_not() {
        let one = cube(0.0, 100.0);
        let mut two = cube(100.0, 300.0);
        let found = separation(&one, &mut two).unwrap();
        assert_eq!(found.len(), 4, "{found:?}");
        assert_eq!(two.sides.offsets, cube(100.0, 300.0).sides.offsets);
        // By one unit of overlap a facet of the second moves.
        let mut two = cube(99.0, 300.0);
        separation(&one, &mut two).unwrap();
        assert_eq!(two.sides.offsets.iter().sum::<f64>(), 3.0 * (300.0 - 99.0) - 1.0);
        assert!(separation(&one, &mut cube(50.0, 300.0)).is_none());
    }

    #[test]
    fn a_tilted_facet_needs_three_facets_of_the_other() {
        let one = cube(0.0, 100.0);
        let mut two = cube(90.0, 300.0);
        two.sides.normals.push([-3.0, -2.0, -1.0]);
        two.sides.offsets.push(-601.0);
        let mut two = Shape::of(&two.sides, [200; 3]);
        let found = separation(&one, &mut two).unwrap();
        let mut terms = found.as_chunks::<2>().0.to_vec();
        terms.sort_unstable();
        assert_eq!(terms, [[0, 3], [2, 2], [4, 1], [12, 1]]);
        let mut near = Shape { sides: two.sides.clone(), ..two.clone() };
        near.sides.offsets[6] = -595.0;
        separation(&one, &mut near).unwrap();
        assert_eq!(near.sides.offsets[6], -600.0);
    }
}
