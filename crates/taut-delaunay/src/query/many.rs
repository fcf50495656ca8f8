//! Many questions at a time, in rows of the input and canonical numbers of simplices.
//!
//! Idea: questions are answered along a Hilbert curve, in runs of a fixed length on all threads, so that each finds in the cache
//! what the one before has read.
//! Guarantee: each answer is that of the question alone: it depends neither on the others nor on the number of threads. A point on
//! the boundary of several simplices is in the one with the lowest number.

mod circumcenters;
mod diagram;
mod locate;
mod star;
#[cfg(test)]
mod tests;

use std::ops::Range;

use taut_oblivious::hilbert_order;
use taut_points::parallel::ParallelSlice;
use taut_points::{InputError, Monitor, Points};

use super::locator::{Directory, Locator};
use crate::geometry::{InPlane, InSpace};
use crate::sites::row;
use crate::{Error, Plane, Space, Triangulation};

pub use diagram::VoronoiDiagram;

/// In place of a simplex: the point is outside the hull.
pub const NOWHERE: u32 = u32::MAX;

/// Questions of one task: as many as make a jump along the curve rare, and still many tasks.
const TASK: usize = 1 << 10;

/// A triangulation that answers many questions at a time, in rows of the input and canonical numbers of simplices.
pub struct TriangulationIndex<const D: usize, const V: usize> {
    /// In canonical order: the number of a simplex is that of its slot.
    triangulation: Triangulation<D, V>,
    directory: Directory<D>,
    /// Finite simplices, which come before the ghosts.
    count: u32,
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

impl<const D: usize, const V: usize> TriangulationIndex<D, V> {
    /// Takes a triangulation and makes it ready for questions. O(simplices).
    pub fn new(triangulation: Triangulation<D, V>) -> Self {
        // Where a walk begins and a star ends must not depend on threads.
        let triangulation = triangulation.renumbered();
        let directory = triangulation.directory();
        let count = triangulation.slots().iter().filter(|simplex| !simplex.is_ghost()).count();
        Self { triangulation, directory, count: count as u32 }
    }

    /// The triangulation.
    pub fn triangulation(&self) -> &Triangulation<D, V> {
        &self.triangulation
    }

    /// The slots of the simplices, which are their numbers in the answer of [`solution`](Triangulation::solution); ghosts come
    /// after them.
    pub fn slots(&self) -> Range<u32> {
        0..self.count
    }

    fn locator(&self) -> Locator<'_, D, V> {
        self.triangulation.locator_by(&self.directory)
    }

    /// Refuses points of another dimension.
    fn check_dim(points: &Points<'_, f64>) -> Result<(), Error> {
        let dim = points.dim();
        let expected = if D == 2 {
            "2, as the triangulation is one of the plane"
        } else {
            "3, as the triangulation is one of space"
        };
        if dim == D { Ok(()) } else { Err(InputError::Dimension { dim, expected }.into()) }
    }

    /// The answers of runs of questions along a Hilbert curve, in the order of the questions.
    fn along_curve<T: Clone + Default + Send, S>(
        &self,
        points: &Points<'_, f64>,
        monitor: &Monitor<'_>,
        start: impl Fn() -> S + Sync,
        answer: impl Fn(&mut S, [f64; D]) -> T + Sync,
    ) -> Result<Vec<T>, Error> {
        Self::check_dim(points)?;
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
    /// [`Error::Input`] for points of another dimension, and when the monitor stops the work.
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
}

/// The same questions in the plane and in space.
macro_rules! many {
    ($d:literal, $v:literal, $triangulation:ty, $geometry:ty) => {
        impl TriangulationIndex<$d, $v> {
            /// The number of the simplex in which each point lies, exactly; [`NOWHERE`] outside the hull, for points that are
            /// not finite, and everywhere if the sites do not span all dimensions.
            ///
            /// # Errors
            /// [`Error::Input`] for points of another dimension, and when the monitor stops the work.
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
            /// [`Error::Input`] for points of another dimension, and when the monitor stops the work.
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
            /// [`Error::OtherPoints`] if there are not as many values as rows, [`Error::Input`] for points of another dimension, and
            /// when the monitor stops the work.
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
