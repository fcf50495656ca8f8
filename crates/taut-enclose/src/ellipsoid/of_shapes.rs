//! The minimum volume enclosing ellipsoid of balls or ellipsoids: working sets of touching points.
//!
//! *Problem.* Items {m + v : vv′ ⪯ S}: the ellipsoid of least volume that encloses them all.
//! *Idea.* It is that of the points of all items, of which there is no end; but the methods for points only ask who lies
//! outside. So the working set holds points of items, each known by its item and a direction; its ellipsoid is found as for
//! points ([`newton`](super::newton)), a pass asks every item for its farthest point ([`pass`]), those outside join the working set, and so
//! on until none is outside by more than the wanted gap. The multipliers of the working set prove the bound.
//! *Guarantee.* Lower bounds never fall. All items are brought once to a frame in which a sample of them is round, with
//! twice the digits; there, neither units nor the ratio of axes matter.
//! *Cost.* O(r³) for an item that may reach outside, O(r²) for any other, in each of a dozen passes or two.
//! *Trap.* Where an item touches in a circle, as a ball does that lies on an axis of the answer, its farthest point is
//! any of a continuum; a method that is told one at a time crawls along. So an item names several points at once.
//! *Reference.* Yıldırım, SIAM J. Optim. 17(3), 2006, for core-sets of ellipsoids; the oracle is the trust-region
//! problem.

mod base;
mod pass;
mod proof;
mod rounds;
mod support_points;

use taut_certify::{Ellipsoid, EllipsoidCertificate, Solution, Trace};
use taut_kernels::Center;
use taut_kernels::vector::add_scaled;
use taut_points::{InputError, Monitor, OwnedPoints, PointSource};

use self::base::Base;
use super::flat::{self, RankResult, lifted};
use super::point_reader::PointReader;
use super::rounds::center_of;
use super::sample::Sample;
use super::whitener::Rebased;
use super::{EllipsoidMethod, EllipsoidOptions};
use crate::Error;
use crate::shapes::Shapes;
use crate::shapes::frame::Map;

/// Solves the balls or ellipsoids of a source.
pub(super) fn solve(
    source: &dyn PointSource,
    options: &EllipsoidOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    if options.method != EllipsoidMethod::Newton {
        return Err(Error::Input(InputError::Option {
            name: "method",
            value: options.method.name().to_owned(),
            expected: "newton, the one method for balls and ellipsoids",
        }));
    }
    let shapes = Shapes::read(source, options.inputs, monitor)?;
    let generators = generators(&shapes)?;
    let silent = Monitor { cancel: monitor.cancel, ..Monitor::silent() };
    let mut reader = PointReader::new(&generators, &silent)?;
    match flat::decide_rank(&mut reader, options)? {
        RankResult::Full(sample, whitener) => {
            let dim = shapes.dim();
            let base = Base {
                center: center_of(&sample.origin, &whitener),
                matrix: whitener.matrix().to_vec(),
                lower: whitener.matrix().to_vec(),
                directions: None,
                rank: dim,
            };
            base.solve(&shapes, options, monitor)
        }
        RankResult::Flat(found) => in_flat(&shapes, &found, &generators, options, monitor),
    }
}

/// Points of the items that span what they span.
fn generators(shapes: &Shapes) -> Result<OwnedPoints<f64>, Error> {
    let mut values = vec![];
    for i in 0..shapes.len() {
        let center = shapes.center(i);
        let axes = shapes.factor(i);
        if axes.len() == 0 {
            values.extend_from_slice(center);
        }
        for axis in axes {
            for sign in [1.0, -1.0] {
                values.extend(center.iter().zip(axis).map(|(m, e)| m + sign * e));
            }
        }
    }
    if values.iter().any(|v| !v.is_finite()) {
        return Err(Error::Overflow);
    }
    Ok(OwnedPoints::new(values, shapes.dim()).expect("whole rows, one at least"))
}

/// Items that lie in an affine subspace, which `found` knows.
fn in_flat(
    shapes: &Shapes,
    found: &Solution<Ellipsoid>,
    generators: &OwnedPoints<f64>,
    options: &EllipsoidOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let answer = &found.answer;
    let rank = answer.rank();
    let center = Center { high: answer.center.clone(), low: answer.center_tail.clone() };
    let basis = answer.hull.as_ref().map_or(vec![], |hull| hull.basis.concat());
    if rank == 0 {
        return Ok(single(shapes, found));
    }
    let map = Map { matrix: &basis, center: &center };
    let points = generators.view();
    let images = points.rows().flat_map(|row| map.point(row)).collect();
    let projected = OwnedPoints::new(images, rank).expect("whole rows, one at least");
    let silent = Monitor::silent();
    let reader = PointReader::new(&projected, &silent)?;
    let sample = Sample::new(&reader)?;
    let (whitener, how) = sample.whitener(&sample.extents());
    if how == Rebased::Never {
        return Err(Error::Overflow);
    }
    let origin = center_of(&sample.origin, &whitener);
    let mut matrix = vec![0.0; rank * shapes.dim()];
    for (row, m) in matrix.chunks_exact_mut(shapes.dim()).zip(whitener.matrix().chunks_exact(rank))
    {
        for (&m, direction) in m.iter().zip(basis.chunks_exact(shapes.dim())) {
            add_scaled(row, m, direction);
        }
    }
    let mut lifted = lifted(&center.high, &basis, &origin);
    lifted.low.iter_mut().zip(&center.low).for_each(|(low, tail)| *low += tail);
    let base = Base {
        center: lifted,
        matrix,
        lower: whitener.matrix().to_vec(),
        directions: Some(basis),
        rank,
    };
    base.solve(shapes, options, monitor)
}

/// Items that are all one point.
fn single(shapes: &Shapes, found: &Solution<Ellipsoid>) -> Solution<Ellipsoid> {
    let answer = found.answer.clone();
    let certificate = EllipsoidCertificate {
        items: shapes.items(),
        directions: vec![vec![0.0; shapes.dim()]],
        points_hash: shapes.hash(),
        ..found.certificate.clone()
    };
    let trace = Trace { passes: 1, ..found.trace.clone() };
    Solution { answer, certificate, trace }
}
