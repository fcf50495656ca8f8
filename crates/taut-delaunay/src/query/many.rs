//! Many questions at a time, in rows of the input and canonical numbers of simplices.
//!
//! Idea: questions are answered along a Hilbert curve, in runs of a fixed length on all threads, so a walk starts where the one
//! before ended, a few simplices away. A walk that is not there soon starts again from the nearest site.
//! Guarantee: each answer is that of the question alone: it depends neither on the others nor on the number of threads. A point on
//! the boundary of several simplices is in the one with the lowest number.

mod circumcenters;
mod diagram;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use taut_oblivious::hilbert_order;
use taut_points::{Monitor, Points};
use taut_predicates::Sign;

use super::locator::{Directory, Locator};
use crate::canonical::{CanonicalOrder, arrangement};
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::simplex::{GHOST, decode};
use crate::sites::row;
use crate::{Error, Plane, Space, Triangulation};

pub use diagram::VoronoiDiagram;

/// In place of a simplex: the point is outside the hull.
pub const NOWHERE: u32 = u32::MAX;

/// Questions of one task: as many as make a jump along the curve rare, and still many tasks.
const TASK: usize = 1 << 10;
/// Simplices that a walk from the answer before may visit; then it starts again from the nearest site.
const WALK_STEPS_MAX: usize = 40;

/// A triangulation that answers many questions at a time, in rows of the input and canonical numbers of simplices.
pub struct TriangulationIndex<const D: usize, const V: usize> {
    triangulation: Triangulation<D, V>,
    directory: Directory<D>,
    order: CanonicalOrder,
}

/// The natural neighbors of many points, those of point i at `starts[i]..starts[i + 1]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NaturalNeighbors {
    /// One more than there are points.
    pub starts: Vec<u64>,
    /// Rows of the input.
    pub rows: Vec<u32>,
    /// Sibson's coordinates; those of a point sum to 1. A point outside the hull has none.
    pub weights: Vec<f64>,
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
    /// Takes a triangulation and makes it ready for questions. O(simplices).
    pub fn new(triangulation: Triangulation<D, V>) -> Self {
        // Where a walk begins and a star ends must not depend on threads.
        let triangulation = triangulation.renumbered();
        let directory = triangulation.directory();
        let order = CanonicalOrder::of(triangulation.slots(), triangulation.site_count());
        Self { triangulation, directory, order }
    }

    /// The triangulation.
    pub fn triangulation(&self) -> &Triangulation<D, V> {
        &self.triangulation
    }

    /// The number of a simplex in the answer of [`solution`](Triangulation::solution), from its number in
    /// [`slots`](Triangulation::slots).
    ///
    /// # Panics
    /// If there is no such slot.
    pub fn number(&self, slot: u32) -> u32 {
        self.order.places[slot as usize]
    }

    /// The slots of all simplices in the order of their numbers.
    pub fn slots(&self) -> &[u32] {
        &self.order.finite
    }

    fn locator(&self) -> Locator<'_, D, V> {
        self.triangulation.locator_by(&self.directory)
    }

    /// The sites of simplex `number` in the order of the answer.
    fn vertices(&self, number: usize) -> [u32; V] {
        let vertices = self.triangulation.vertices(self.order.finite[number]);
        arrangement(&vertices).map(|i| vertices[usize::from(i)])
    }

    /// The answers of runs of questions along a Hilbert curve, in the order of the questions.
    fn along_curve<T: Clone + Default + Send, S>(
        &self,
        points: &Points<'_, f64>,
        monitor: &Monitor<'_>,
        start: impl Fn() -> S + Sync,
        answer: impl Fn(&mut S, [f64; D]) -> T + Sync,
    ) -> Result<Vec<T>, Error> {
        let at = |i: usize| row::<f64, D>(points, i);
        let order = hilbert_order(points.len(), at);
        let runs = order
            .par_chunks(TASK)
            .map(|run| -> Result<Vec<T>, Error> {
                monitor.check()?;
                let mut state = start();
                Ok(run.iter().map(|&i| answer(&mut state, at(i as usize))).collect())
            })
            .collect::<Result<Vec<_>, Error>>()?;
        let mut answers = vec![T::default(); points.len()];
        for (run, found) in order.chunks(TASK).zip(runs) {
            run.iter().zip(found).for_each(|(&i, answer)| answers[i as usize] = answer);
        }
        Ok(answers)
    }

    /// The row nearest to each point, as [`Locator::nearest`]; [`NOWHERE`] where there is none.
    ///
    /// # Errors
    /// [`Error::Input`] when the monitor stops the work.
    pub fn nearest(
        &self,
        points: &Points<'_, f64>,
        monitor: &Monitor<'_>,
    ) -> Result<Vec<u32>, Error> {
        let locator = self.locator();
        self.along_curve(
            points,
            monitor,
            || (),
            |(), point| locator.nearest(point).map_or(NOWHERE, |site| self.triangulation.row(site)),
        )
    }

    /// Walks towards `point` from `start`, through facets that it lies beyond.
    fn walk<G: Geometry<D, V>>(&self, point: [f64; D], start: u32, steps_max: usize) -> End {
        let simplices = self.triangulation.slots();
        let sites = &self.triangulation.sites;
        let scaled = point.map(|x| sites.scale.apply(x));
        let back = sites.scale.inverse();
        // A point that does not survive the scale of the sites is looked for among the coordinates as they were given.
        let survives = (0..D).all(|i| back.apply(scaled[i]) == point[i]);
        let target = if survives { scaled } else { point };
        let (mut here, mut came_through) = (start, V);
        for _ in 0..steps_max {
            let simplex = &simplices[here as usize];
            if simplex.is_ghost() {
                return End::Outside(here);
            }
            let corners = simplex.vertices.map(|v| {
                let site = sites.coordinates[v as usize];
                if survives { site } else { site.map(|x| back.apply(x)) }
            });
            let (mut next, mut touched) = (None, 0);
            for i in (0..V).filter(|&i| i != came_through) {
                let mut with_point = corners;
                with_point[i] = target;
                match G::orientation(with_point) {
                    Sign::Negative => {
                        next = Some(i);
                        break;
                    }
                    Sign::Zero => touched |= 1 << i,
                    Sign::Positive => {}
                }
            }
            match next {
                None => return End::Inside(here, touched),
                Some(i) => (here, came_through) = decode(simplex.neighbors[i]),
            }
        }
        End::Lost
    }

    /// The lowest number of the simplices that hold `point`, one of which is `first`, on the facets `touched` of it.
    fn lowest<G: Geometry<D, V>>(&self, point: [f64; D], first: u32, touched: u8) -> u32 {
        let simplices = self.triangulation.slots();
        let mut lowest = self.number(first);
        let (mut open, mut seen) = (vec![(first, touched)], vec![first]);
        while let Some((t, touched)) = open.pop() {
            for i in (0..V).filter(|i| touched >> i & 1 == 1) {
                let (other, _) = decode(simplices[t as usize].neighbors[i]);
                if simplices[other as usize].is_ghost() || seen.contains(&other) {
                    continue;
                }
                seen.push(other);
                // One step: the point is in it, on the facet it was reached through at least.
                if let End::Inside(t, touched) = self.walk::<G>(point, other, 1) {
                    lowest = lowest.min(self.number(t));
                    open.push((t, touched));
                }
            }
        }
        lowest
    }

    fn locate_by<G: Geometry<D, V>>(
        &self,
        points: &Points<'_, f64>,
        monitor: &Monitor<'_>,
    ) -> Result<Vec<u32>, Error> {
        let simplices = self.triangulation.slots();
        if simplices.is_empty() {
            return Ok(vec![NOWHERE; points.len()]);
        }
        let locator = self.locator();
        self.along_curve(
            points,
            monitor,
            || None,
            |last: &mut Option<u32>, point| {
                if point.iter().any(|x| !x.is_finite()) {
                    return NOWHERE;
                }
                let mut end = match *last {
                    Some(start) => self.walk::<G>(point, start, WALK_STEPS_MAX),
                    None => End::Lost,
                };
                if let End::Lost = end {
                    let Some(site) = locator.nearest(point) else { return NOWHERE };
                    let start = self.directory.at_site[site as usize];
                    end = self.walk::<G>(point, start, usize::MAX);
                }
                match end {
                    End::Inside(t, touched) => {
                        *last = Some(t);
                        if touched == 0 {
                            self.number(t)
                        } else {
                            self.lowest::<G>(point, t, touched)
                        }
                    }
                    End::Outside(ghost) => {
                        let simplex = &simplices[ghost as usize];
                        let apex = simplex.vertices.iter().position(|&v| v == GHOST);
                        *last = apex.map(|apex| decode(simplex.neighbors[apex]).0);
                        NOWHERE
                    }
                    End::Lost => NOWHERE,
                }
            },
        )
    }
}

/// The same questions in the plane and in space.
macro_rules! many {
    ($d:literal, $v:literal, $triangulation:ty, $geometry:ty) => {
        impl TriangulationIndex<$d, $v> {
            /// The number of the simplex in which each point lies, exactly; [`NOWHERE`] outside the hull, for points that are
            /// not finite, and everywhere if the sites do not span all dimensions.
            ///
            /// # Errors
            /// [`Error::Input`] when the monitor stops the work.
            pub fn locate(
                &self,
                points: &Points<'_, f64>,
                monitor: &Monitor<'_>,
            ) -> Result<Vec<u32>, Error> {
                self.locate_by::<$geometry>(points, monitor)
            }

            /// The natural neighbors of each point with Sibson's coordinates, as
            /// [`natural_coordinates`](Locator::natural_coordinates).
            ///
            /// # Errors
            /// [`Error::Input`] when the monitor stops the work.
            pub fn natural_coordinates(
                &self,
                points: &Points<'_, f64>,
                monitor: &Monitor<'_>,
            ) -> Result<NaturalNeighbors, Error> {
                let locator = self.locator();
                let found = self.along_curve(
                    points,
                    monitor,
                    || (),
                    |(), point| locator.natural_coordinates(point).unwrap_or_default(),
                )?;
                let mut all = NaturalNeighbors { starts: vec![0], ..Default::default() };
                for coordinates in found {
                    for (site, weight) in coordinates {
                        all.rows.push(self.triangulation.row(site));
                        all.weights.push(weight);
                    }
                    all.starts.push(all.rows.len() as u64);
                }
                Ok(all)
            }

            /// The natural-neighbor interpolant at each point of one value for each row of the input; NaN outside the hull.
            /// Of equal rows the value of the first counts.
            ///
            /// # Errors
            /// [`Error::OtherPoints`] if there are not as many values as rows, [`Error::Input`] when the monitor stops the work.
            pub fn interpolate(
                &self,
                values: &[f64],
                points: &Points<'_, f64>,
                monitor: &Monitor<'_>,
            ) -> Result<Vec<f64>, Error> {
                let rows = self.triangulation.site_count() + self.triangulation.duplicates().len();
                if values.len() != rows {
                    let (built, given) = (rows as u64, values.len() as u64);
                    return Err(Error::OtherPoints { built, given });
                }
                let locator = self.locator();
                self.along_curve(
                    points,
                    monitor,
                    || (),
                    |(), point| locator.interpolate(values, point).unwrap_or(f64::NAN),
                )
            }
        }

        impl From<$triangulation> for TriangulationIndex<$d, $v> {
            fn from(triangulation: $triangulation) -> Self {
                Self::new(triangulation)
            }
        }
    };
}
many!(2, 3, Plane, InPlane);
many!(3, 4, Space, InSpace);
