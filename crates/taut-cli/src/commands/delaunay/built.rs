//! A triangulation of the plane or of space, whichever the points ask for.

use taut::certify::Triangulation;
use taut::delaunay::{Counters, Error};
use taut::delaunay::{Plane, Space};
use taut::points::{InputError, Rows, Scalar, Scratch};
use taut::{DelaunayOptions, Monitor, PointSource, Points, Solution};

use crate::output::numbers::{count, counted};
use crate::reports::Field;

pub(super) enum Built {
    Plane(Plane),
    Space(Space),
}

impl Built {
    pub(super) fn new(
        source: &dyn PointSource,
        options: &DelaunayOptions<'_>,
    ) -> Result<Self, Error> {
        fn build<T: Scalar>(
            points: &Points<'_, T>,
            options: &DelaunayOptions<'_>,
        ) -> Result<Built, Error> {
            match points.dim() {
                2 => Ok(Built::Plane(Plane::build(points, options)?)),
                3 => Ok(Built::Space(Space::build(points, options)?)),
                dim => {
                    let expected = "2, the plane, or 3, space";
                    Err(InputError::Dimension { dim, expected }.into())
                }
            }
        }
        let mut scratch = Scratch::new();
        match source.read(0..source.len(), &mut scratch)? {
            Rows::F32(points) => build(&points, options),
            Rows::F64(points) => build(&points, options),
        }
    }

    pub(super) fn solution(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Triangulation>, Error> {
        let mut scratch = Scratch::new();
        match (self, source.read(0..source.len(), &mut scratch)?) {
            (Built::Plane(built), Rows::F32(points)) => built.solution(&points, monitor),
            (Built::Plane(built), Rows::F64(points)) => built.solution(&points, monitor),
            (Built::Space(built), Rows::F32(points)) => built.solution(&points, monitor),
            (Built::Space(built), Rows::F64(points)) => built.solution(&points, monitor),
        }
    }

    fn counters(&self) -> &Counters {
        match self {
            Built::Plane(built) => built.counters(),
            Built::Space(built) => built.counters(),
        }
    }

    /// Returns how the signs were decided. It depends on the threads, so it is for the terminal alone.
    pub(super) fn signs(&self) -> Field {
        let counters = self.counters();
        let (all, stages) = (counters.orientations + counters.conflict_tests, counters.stages);
        Field::new("signs", count(all)).remark(format!(
            "{} by exact whole numbers, {} by double-double, {} by long integers, {}",
            count(stages.integer),
            count(stages.double_double),
            count(stages.wide + stages.unbounded),
            counted(stages.ties, "tie")
        ))
    }
}
