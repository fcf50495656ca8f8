//! The convex hull of points with whole coordinates in ℝ⁵.
//!
//! *Idea.* Points are inserted in the order given. The facets that a point sees are replaced by those that join it to their border: the
//! ridges that belong to one of them only.
//! *Guarantee.* The signs are exact, in integers. A facet in whose plane a point lies does not see it, so that a point in the affine hull
//! of a ridge never sees one of its two facets alone, and no facet is flat.
//! *Cost.* A test of each facet for each point, and about n² facets.
//! *Reference.* Seidel's beneath-and-beyond method: Edelsbrunner, Algorithms in Combinatorial Geometry, 1987, section 8.4.

use taut_points::{Cancelled, Monitor};

/// Coordinates of a point.
pub(super) type Point = [i64; 5];

/// Largest difference of two coordinates, so that no determinant overflows: their product of five, times 5! and 6, is below 2¹²⁵.
pub(super) const DIFFERENCE_MAX: i64 = 1 << 23;

/// A simplex of the border, and the half-space n·x ≤ h of the hull.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    /// Numbers of points, ascending.
    pub(super) corners: [u32; 5],
    pub(super) normal: [i128; 5],
    pub(super) offset: i128,
}

impl Facet {
    /// Whether a point is strictly beyond the facet.
    fn sees(&self, x: &Point) -> bool {
        dot(&self.normal, x) > self.offset
    }
}

fn dot(normal: &[i128; 5], x: &Point) -> i128 {
    normal.iter().zip(x).map(|(&n, &x)| n * i128::from(x)).sum()
}

/// The facets of the convex hull; none if all points are on a hyperplane.
pub(super) fn facets(points: &[Point], monitor: &Monitor<'_>) -> Result<Vec<Facet>, Cancelled> {
    let Some(first) = simplex(points) else { return Ok(vec![]) };
    let inner: Point = std::array::from_fn(|k| first.iter().map(|&i| points[i as usize][k]).sum());
    let facet = |corners: [u32; 5]| facet(points, corners, &inner, first.len() as i128);
    let mut facets: Vec<Facet> = vec![];
    for left_out in 0..first.len() {
        let mut kept = first.iter().enumerate().filter(|(i, _)| *i != left_out).map(|pair| *pair.1);
        facets.push(facet(std::array::from_fn(|_| kept.next().unwrap_or_default())));
    }
    for (number, x) in points.iter().enumerate() {
        monitor.check()?;
        let number = number as u32;
        if first.contains(&number) {
            continue;
        }
        let mut ridges: Vec<[u32; 4]> = vec![];
        facets.retain(|facet| {
            let sees = facet.sees(x);
            if sees {
                ridges.extend((0..5).map(|k| without(&facet.corners, k)));
            }
            !sees
        });
        ridges.sort_unstable();
        for same in ridges.chunk_by(|one, other| one == other) {
            if let [[a, b, c, d]] = *same {
                let mut corners = [a, b, c, d, number];
                corners.sort_unstable();
                facets.push(facet(corners));
            }
        }
    }
    Ok(facets)
}

/// The corners of a facet but one.
fn without(corners: &[u32; 5], left_out: usize) -> [u32; 4] {
    std::array::from_fn(|k| corners[if k < left_out { k } else { k + 1 }])
}

/// The facet with some corners that has a point inside, given as a sum of `count` points.
fn facet(points: &[Point], corners: [u32; 5], inner: &Point, count: i128) -> Facet {
    let [o, rest @ ..] = corners.map(|i| points[i as usize]);
    let rows = rest.map(|p| -> Point { std::array::from_fn(|k| p[k] - o[k]) });
    let mut normal = cofactors(&rows);
    let mut offset = dot(&normal, &o);
    if dot(&normal, inner) > count * offset {
        (normal, offset) = (normal.map(|n| -n), -offset);
    }
    Facet { corners, normal, offset }
}

/// The vector that is perpendicular to four others: the signed minors, each by Laplace's rule over pairs of rows.
fn cofactors(rows: &[Point; 4]) -> [i128; 5] {
    let minor = |one: usize, other: usize, i: usize, j: usize| {
        i128::from(rows[one][i] * rows[other][j] - rows[one][j] * rows[other][i])
    };
    std::array::from_fn(|left_out| {
        let [a, b, c, d]: [usize; 4] =
            std::array::from_fn(|k| if k < left_out { k } else { k + 1 });
        let upper = |i, j| minor(0, 1, i, j);
        let lower = |i, j| minor(2, 3, i, j);
        let sum = upper(a, b) * lower(c, d) - upper(a, c) * lower(b, d)
            + upper(a, d) * lower(b, c)
            + upper(b, c) * lower(a, d)
            - upper(b, d) * lower(a, c)
            + upper(c, d) * lower(a, b);
        if left_out % 2 == 0 { sum } else { -sum }
    })
}

/// Six points that span the space, each the farthest from the flat of those before; `None` if there are none.
fn simplex(points: &[Point]) -> Option<[u32; 6]> {
    let mut chosen = [0u32; 6];
    let mut axes: Vec<[f64; 5]> = vec![];
    let origin = points.first()?;
    let away = |x: &Point, axes: &[[f64; 5]]| -> [f64; 5] {
        let mut rest: [f64; 5] = std::array::from_fn(|k| (x[k] - origin[k]) as f64);
        for axis in axes {
            let along: f64 = axis.iter().zip(rest).map(|(a, x)| a * x).sum();
            rest.iter_mut().zip(axis).for_each(|(x, a)| *x -= along * a);
        }
        rest
    };
    let length = |x: &[f64; 5]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    for place in &mut chosen[1..] {
        let far = |i: &usize| length(&away(&points[*i], &axes));
        let next = (0..points.len()).max_by(|one, other| far(one).total_cmp(&far(other)))?;
        let rest = away(&points[next], &axes);
        let size = length(&rest);
        // Whole coordinates: what is nearer is rounding.
        if size < 0.5 {
            return None;
        }
        axes.push(rest.map(|x| x / size));
        *place = next as u32;
    }
    chosen.sort_unstable();
    let [o, p @ ..] = chosen.map(|i| points[i as usize]);
    let rows = p.map(|p| -> Point { std::array::from_fn(|k| p[k] - o[k]) });
    let normal = cofactors(&[rows[0], rows[1], rows[2], rows[3]]);
    (dot(&normal, &rows[4]) != 0).then_some(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn all_points_are_behind_all_facets_and_ridges_have_two() {
        let mut random = Random::new(5);
        for (size, range) in [(6, 3), (12, 2), (30, 4), (40, 1000)] {
            let points: Vec<Point> =
                (0..size).map(|_| std::array::from_fn(|_| random.below(range) as i64)).collect();
            let found = facets(&points, &Monitor::silent()).unwrap();
            assert_eq!(found.is_empty(), simplex(&points).is_none());
            let mut ridges: Vec<[u32; 4]> = vec![];
            for facet in &found {
                assert!(!points.iter().any(|x| facet.sees(x)), "{facet:?}");
                let on = |&i: &u32| dot(&facet.normal, &points[i as usize]) == facet.offset;
                assert!(facet.corners.iter().all(on) && facet.normal != [0; 5]);
                ridges.extend((0..5).map(|k| without(&facet.corners, k)));
            }
            ridges.sort_unstable();
            assert!(ridges.chunk_by(|one, other| one == other).all(|same| same.len() == 2));
        }
    }

    #[test]
    fn the_cyclic_polytope_has_its_facets() {
        // On the moment curve: 2·C(n − 3, 2) facets in dimension 5, by Gale's evenness condition.
        let points: Vec<Point> =
            (-5..=5i64).map(|t| [t, t * t, t.pow(3), t.pow(4), t.pow(5)]).collect();
        assert_eq!(facets(&points, &Monitor::silent()).unwrap().len(), 2 * 28);
        let flat: Vec<Point> = points.iter().map(|p| [p[0], p[1], p[2], p[3], 7]).collect();
        assert!(facets(&flat, &Monitor::silent()).unwrap().is_empty());
    }

    #[test]
    fn the_largest_coordinates_do_not_overflow() {
        let mut random = Random::new(9);
        let points: Vec<Point> = (0..24)
            .map(|_| std::array::from_fn(|_| DIFFERENCE_MAX * random.below(2) as i64))
            .collect();
        let found = facets(&points, &Monitor::silent()).unwrap();
        assert!(found.iter().all(|facet| !points.iter().any(|x| facet.sees(x))));
    }
}
