//! In which simplices many points lie.
//!
//! *Idea.* A walk starts where the one before ended. Points that come in an order in which walks are short, as a sample of them
//! tells, are answered as they come, others along a Hilbert curve. A step looks at all facets of a simplex at once: relative to the
//! point their sides have most products in common, and one bound on the errors of all.
//! *Guarantee.* Exact: a side within its bound is decided by the exact predicate. A point on the boundary of several simplices is
//! in the one with the lowest number.
//! *Why walks end.* A step goes through any facet that the point is beyond; in a Delaunay triangulation no such walk comes back.

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, Points};
use taut_predicates::{Sign, plane, space};

use super::{NOWHERE, TASK, TriangulationIndex};
use crate::Error;
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::query::locator::Locator;
use crate::simplex::{GHOST, decode};
use crate::sites::row;
use crate::vector::{cross, difference, dot, mapped};

/// Simplices that a walk from the answer before may visit; then it starts again from the nearest site.
const WALK_STEPS_MAX: usize = 40;

/// Runs of the sample that tells whether points come in order.
const SAMPLE_RUNS: usize = 16;
/// Points of each of them.
const SAMPLE_RUN: usize = 9;
/// Points come in order if walks from one to the next visit at most this many simplices on average: then a curve through them,
/// whose walks visit two to four, would not pay for the sort.
const ORDERED_STEPS_MAX: usize = 8;

/// Greatest difference of coordinates for which the errors below hold, as of the filters of the predicates.
const DIFFERENCE_MAX: f64 = (1u64 << 41) as f64;

/// More than a side of a triangle is off by, relative to the product of the greatest differences along x and y: four roundings of
/// 2⁻⁵³ in each of two monomials as in the filter of `orient`, and as much again to spare.
const PLANE_ERROR: f64 = 8.0 * f64::EPSILON;
/// Likewise of a tetrahedron: eight roundings in each of six monomials, and a third as much to spare.
const SPACE_ERROR: f64 = 32.0 * f64::EPSILON;

/// Computes on which sides of its facets a simplex has a point.
pub(super) trait Sides<const D: usize, const V: usize>: Geometry<D, V> {
    /// For each corner a number whose sign is that of the orientation after `q` took the place of this corner, if its magnitude is
    /// above the bound that comes second.
    fn sides(corners: [[f64; D]; V], q: [f64; D]) -> ([f64; V], f64);
}

/// The error of products of differences, one along each axis, of these points relative to another.
#[inline(always)]
fn error_bound<const D: usize>(relative: &[[f64; D]], error: f64, underflow: f64) -> f64 {
    let mut reach = [0.0f64; D];
    for p in relative {
        for i in 0..D {
            reach[i] = if p[i].abs() > reach[i] { p[i].abs() } else { reach[i] };
        }
    }
    if reach.iter().all(|&x| x <= DIFFERENCE_MAX) {
        error * reach.iter().product::<f64>() + underflow
    } else {
        f64::INFINITY
    }
}

impl Sides<2, 3> for InPlane {
    #[inline(always)]
    fn sides(corners: [[f64; 2]; 3], q: [f64; 2]) -> ([f64; 3], f64) {
        let [a, b, c] = mapped(corners, |p| difference(p, q));
        let turn = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let bound = error_bound(&[a, b, c], PLANE_ERROR, plane::UNDERFLOW_ERROR);
        ([turn(b, c), turn(c, a), turn(a, b)], bound)
    }
}

impl Sides<3, 4> for InSpace {
    #[inline(always)]
    fn sides(corners: [[f64; 3]; 4], q: [f64; 3]) -> ([f64; 4], f64) {
        let [a, b, c, d] = mapped(corners, |p| difference(p, q));
        let (ab, cd) = (cross(a, b), cross(c, d));
        let bound = error_bound(&[a, b, c, d], SPACE_ERROR, space::UNDERFLOW_ERROR);
        ([dot(b, cd), -dot(a, cd), dot(d, ab), -dot(c, ab)], bound)
    }
}

/// Where a walk ended.
enum End {
    /// In this simplex, on the facets whose bits are set.
    Inside(u32, u8),
    /// At this ghost.
    Outside(u32),
    /// Nowhere within the steps allowed.
    Lost,
}

impl<const D: usize, const V: usize> TriangulationIndex<D, V> {
    /// Walks towards `point` from `start`, through facets that it lies beyond; says how many simplices it visited.
    #[inline]
    fn walk<G: Sides<D, V>>(&self, point: [f64; D], start: u32, steps_max: usize) -> (End, usize) {
        let simplices = self.triangulation.slots();
        let sites = &self.triangulation.sites;
        let scaled = sites.scale.of_row(point);
        let back = sites.scale.inverse();
        // A point that does not survive the scale of the sites is looked for among the coordinates as they were given.
        let survives = (0..D).all(|i| back.apply(scaled[i]) == point[i]);
        let target = if survives { scaled } else { point };
        let mut here = start;
        for step in 1..=steps_max {
            if here >= self.count {
                return (End::Outside(here), step);
            }
            let simplex = &simplices[here as usize];
            let corners = mapped(simplex.vertices, |v| {
                let site = sites.coordinates[v as usize];
                if survives { site } else { back.of_row(site) }
            });
            let (sides, bound) = G::sides(corners, target);
            let mut least = 0;
            for i in 1..V {
                least = if sides[i] < sides[least] { i } else { least };
            }
            if sides[least] < -bound {
                here = decode(simplex.neighbors[least]).0;
                continue;
            }
            // What is not a number is in doubt, too.
            let in_doubt = (0..V).filter(|&i| sides[i] <= bound || sides[i].is_nan());
            let (mut next, mut touched) = (None, 0);
            for i in in_doubt {
                let mut with_point = corners;
                with_point[i] = target;
                match G::orientation(with_point) {
                    Sign::Negative => next = Some(i),
                    Sign::Zero => touched |= 1 << i,
                    Sign::Positive => {}
                }
            }
            match next {
                None => return (End::Inside(here, touched), step),
                Some(i) => here = decode(simplex.neighbors[i]).0,
            }
        }
        (End::Lost, steps_max)
    }

    /// The lowest number of the simplices that hold `point`, one of which is `first`, on the facets `touched` of it.
    fn lowest<G: Sides<D, V>>(&self, point: [f64; D], first: u32, touched: u8) -> u32 {
        let simplices = self.triangulation.slots();
        let mut lowest = first;
        let (mut open, mut seen) = (vec![(first, touched)], vec![first]);
        while let Some((t, touched)) = open.pop() {
            for i in (0..V).filter(|i| touched >> i & 1 == 1) {
                let (other, _) = decode(simplices[t as usize].neighbors[i]);
                if other >= self.count || seen.contains(&other) {
                    continue;
                }
                seen.push(other);
                // One step: the point is in it, on the facet it was reached through at least.
                if let (End::Inside(t, touched), _) = self.walk::<G>(point, other, 1) {
                    lowest = lowest.min(t);
                    open.push((t, touched));
                }
            }
        }
        lowest
    }

    /// The simplex of one point, and how many were visited from that of the one before.
    #[inline]
    fn locate_next<G: Sides<D, V>>(
        &self,
        locator: &Locator<'_, D, V>,
        last: &mut Option<u32>,
        point: [f64; D],
    ) -> (u32, usize) {
        if point.iter().any(|x| !x.is_finite()) {
            return (NOWHERE, 0);
        }
        let (mut end, visited) = match *last {
            Some(start) => self.walk::<G>(point, start, WALK_STEPS_MAX),
            None => (End::Lost, 0),
        };
        if let End::Lost = end {
            let Some(site) = locator.nearest(point) else { return (NOWHERE, visited) };
            let start = self.directory.at_site[site as usize];
            (end, _) = self.walk::<G>(point, start, usize::MAX);
        }
        let number = match end {
            End::Inside(t, touched) => {
                *last = Some(t);
                if touched == 0 { t } else { self.lowest::<G>(point, t, touched) }
            }
            End::Outside(ghost) => {
                let simplex = &self.triangulation.slots()[ghost as usize];
                let apex = simplex.vertices.iter().position(|&v| v == GHOST);
                *last = apex.map(|apex| decode(simplex.neighbors[apex]).0);
                NOWHERE
            }
            End::Lost => NOWHERE,
        };
        (number, visited)
    }

    /// Tells from a sample whether walks from one point to the next are short.
    fn is_in_order<G: Sides<D, V>>(
        &self,
        locator: &Locator<'_, D, V>,
        points: &Points<'_, f64>,
    ) -> bool {
        if points.len() < SAMPLE_RUNS * SAMPLE_RUN {
            return true;
        }
        let apart = points.len() / SAMPLE_RUNS;
        let mut visited = 0;
        for run in 0..SAMPLE_RUNS {
            let mut last = None;
            for i in run * apart..run * apart + SAMPLE_RUN {
                visited += self.locate_next::<G>(locator, &mut last, row(points, i)).1;
            }
        }
        visited <= ORDERED_STEPS_MAX * SAMPLE_RUNS * (SAMPLE_RUN - 1)
    }

    pub(super) fn locate_by<G: Sides<D, V>>(
        &self,
        points: &Points<'_, f64>,
        monitor: &Monitor<'_>,
    ) -> Result<Vec<u32>, Error> {
        Self::check_dim(points)?;
        if self.count == 0 {
            return Ok(vec![NOWHERE; points.len()]);
        }
        let locator = self.locator();
        let locate = |last: &mut Option<u32>, point| self.locate_next::<G>(&locator, last, point).0;
        if !self.is_in_order::<G>(&locator, points) {
            return self.along_curve(points, monitor, || None, locate);
        }
        let mut numbers = vec![NOWHERE; points.len()];
        numbers.par_chunks_mut(TASK).enumerate().try_for_each(
            |(task, run)| -> Result<(), Error> {
                monitor.check()?;
                let mut last = None;
                for (number, i) in run.iter_mut().zip(task * TASK..) {
                    *number = locate(&mut last, row(points, i));
                }
                Ok(())
            },
        )?;
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::numbers;

    /// Beyond its bound a side has the sign of the exact predicate, also close to facets, far away, and where nothing is finite.
    #[test]
    fn sides_beyond_their_bound_are_right() {
        fn check<const D: usize, const V: usize, G: Sides<D, V>>(values: &[f64]) {
            let points: &[[f64; D]] = values.as_chunks::<D>().0;
            let (mut certain, mut doubtful) = (0, 0);
            for simplex in points.chunks_exact(V + 1) {
                let mut corners: [[f64; D]; V] = std::array::from_fn(|i| simplex[i]);
                if G::orientation(corners) == Sign::Negative {
                    corners.swap(0, 1);
                }
                let mean: [f64; D] = std::array::from_fn(|k| 0.5 * (corners[0][k] + corners[1][k]));
                for q in [
                    simplex[V],
                    mean,
                    corners[V - 1],
                    mean.map(|x| x * 1e9),
                    mean.map(|x| x * 1e300),
                ] {
                    let (sides, bound) = G::sides(corners, q);
                    for i in 0..V {
                        let mut with_q = corners;
                        with_q[i] = q;
                        if sides[i].abs() > bound {
                            assert_eq!(Sign::from(sides[i]), G::orientation(with_q), "{with_q:?}");
                            certain += 1;
                        } else {
                            doubtful += 1;
                        }
                    }
                }
            }
            assert!(certain > 1000 && doubtful > 100, "{certain} {doubtful}");
        }
        check::<2, 3, InPlane>(&numbers(8000, 1));
        check::<3, 4, InSpace>(&numbers(15000, 2));
    }
}
