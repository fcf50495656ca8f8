//! A triangulation of the plane or of space, whichever the points ask for.

use taut::certify::Triangulation;
use taut::delaunay::{Error, Plane, Space};
use taut::points::{InputError, Rows, Scalar, Scratch};
use taut::{DelaunayOptions, Monitor, PointSource, Points, Solution};

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

    /// With simplices that are numbered by the points alone, so that what is listed by number does not depend on threads.
    pub(super) fn renumbered(self) -> Self {
        match self {
            Built::Plane(built) => Built::Plane(built.renumbered()),
            Built::Space(built) => Built::Space(built.renumbered()),
        }
    }
}
