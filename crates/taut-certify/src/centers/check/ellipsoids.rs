//! Ellipsoids {m + v : vvᵀ ⪯ S}: whether each that counts lies whole in one of the balls, and the points of them that prove the
//! lower bound.
//!
//! *Upper bound.* A ball holds an ellipsoid where the test says so that a ball around ellipsoids has
//! ([`excess`](crate::ball::check::ellipsoids::excess)), without any tolerance. Balls that do not hold the center m are not asked.
//! *Lower bound.* A ball that holds an ellipsoid holds each of its points, so an ellipsoid is a group of points, those that the
//! core-set names by directions. Of such a point p a place q is known, and a length e with |p − q| ≤ e. A ball of a radius less
//! than ρ that holds p has its center less than ρ + e from q: q is an item like a ball of the radius −e.
//! *Units.* Places are those from the first center, times a power of two that brings the radius near 1. Rounding them to `f64` makes e
//! some 2⁻⁵³ of how far they are from there; with the bound of the points themselves it is ρ that pays for it.
//! *Assignment.* The center named for an ellipsoid must be that from which it reaches least far, but for [`REACH_SLACK`] of this.
//! Where nothing but lengths beyond the largest number is to be compared, it may be any.
//! *Guarantee.* No ellipsoid is taken to be inside that is not. One that touches the border to the last digits of `f64` may not be
//! recognized as inside.

use taut_points::{Cancelled, Monitor, PointSource, ReadError, Rows};

use super::super::{Centers, CentersCertificate, CentersViolation};
use super::core::Core;
use super::distance::{Scale, kappa, square, thresholds};
use super::item::Kind;
use super::meter::Meter;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::ball::check::ellipsoids::{as_ellipsoid, excess};
use crate::ellipsoid::check::enclosure::kind_of;
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::item::Item;
use crate::ellipsoid::check::lower_bound::Touching;
use crate::ellipsoid::check::reach;
use crate::hashed_pass::{KeptRows, WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Items};

/// By this part of how far an ellipsoid reaches, a center may be farther than that from which it reaches least far.
const REACH_SLACK: f64 = 1e-9;

/// The balls, ready to be compared with ellipsoids.
pub(super) struct EllipsoidEnclosure<'a> {
    answer: &'a Centers,
    dim: usize,
    scale: Scale,
}

impl<'a> EllipsoidEnclosure<'a> {
    pub(super) fn of(answer: &'a Centers, dim: usize) -> Self {
        EllipsoidEnclosure { answer, dim, scale: Scale::of(answer.radius) }
    }

    /// Reads all rows once; returns those of the core-set.
    pub(super) fn check(
        &self,
        source: &dyn PointSource,
        certificate: &CentersCertificate,
        monitor: &Monitor<'_>,
    ) -> Result<KeptRows, CheckError> {
        let wanted = WantedRows::of(&certificate.core_set);
        let claimed = certificate.points_hash;
        let around_first = as_ellipsoid(&self.answer.centers[0], &[], self.answer.radius);
        let first_frame = Frame::of(&around_first);
        let (blocks, kept) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            all_finite(first, rows)?;
            self.block(first, rows, &first_frame, &mut Meter::of(monitor))
        })?;
        match blocks.into_iter().flatten().next() {
            Some(problem) => Err(problem.into()),
            None => Ok(kept),
        }
    }

    /// The first row outside or assigned wrongly; an error if a row is no ellipsoid at all.
    fn block(
        &self,
        first: u64,
        rows: &Rows<'_>,
        frame: &Frame<'_>,
        meter: &mut Meter<'_>,
    ) -> Result<Option<CentersViolation>, CheckError> {
        let mut values = vec![0.0; Items::Ellipsoids.columns(self.dim)];
        let (mut problem, mut held_by) = (None, 0);
        for number in 0..rows.len() {
            rows.copy_row(number, &mut values);
            let row = first + number as u64;
            let item = Item::of(Items::Ellipsoids, self.dim, &values);
            item.is_valid(row, kind_of(rows))?;
            if problem.is_none() {
                problem = self.row(row, &item, frame, &mut held_by, meter)?.err();
            }
        }
        Ok(problem)
    }

    /// `held_by` is the center whose ball is asked first, and becomes that whose ball holds the item.
    fn row(
        &self,
        row: u64,
        item: &Item<'_>,
        frame: &Frame<'_>,
        held_by: &mut usize,
        meter: &mut Meter<'_>,
    ) -> Result<Result<(), CentersViolation>, Cancelled> {
        let centers = &self.answer.centers;
        if let Some(&center) = self.answer.assignment.get(row as usize) {
            if center as usize >= centers.len() {
                return Ok(Err(CentersViolation::NoSuchCenter { row, center }));
            }
            *held_by = center as usize;
            if let Some(nearer) = self.nearer(item, *held_by, meter)? {
                return Ok(Err(CentersViolation::Assignment { row, center, nearer }));
            }
        }
        if self.answer.outliers.binary_search(&row).is_ok() {
            return Ok(Ok(()));
        }
        let others = (0..centers.len()).filter(|center| center != held_by);
        for center in std::iter::once(*held_by).chain(others) {
            meter.spend(self.dim)?;
            let (_, beyond) = thresholds(self.answer.radius, kappa(self.dim), self.scale);
            if square(item.center(), &centers[center], [self.scale.up, 1.0]) > beyond {
                continue;
            }
            meter.spend(self.steps())?;
            if excess(&frame.around(&centers[center]), self.answer.radius, item) <= 0.0 {
                *held_by = center;
                return Ok(Ok(()));
            }
        }
        Ok(Err(self.outside(row, item, meter)?))
    }

    /// Another center from which an item reaches less far.
    fn nearer(
        &self,
        item: &Item<'_>,
        assigned: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<usize>, Cancelled> {
        let centers = &self.answer.centers;
        meter.spend(self.steps())?;
        let own = reach_from(&centers[assigned], item);
        for (center, place) in centers.iter().enumerate().filter(|(other, _)| *other != assigned) {
            meter.spend(self.dim)?;
            // The center of the item is nearer than the farthest of its points.
            let may_be_nearer = distance(item.center(), place) < own;
            if !may_be_nearer {
                continue;
            }
            meter.spend(self.steps())?;
            if reach_from(place, item) < own * (1.0 - REACH_SLACK - self.rounding()) {
                return Ok(Some(center));
            }
        }
        Ok(None)
    }

    /// What factors of matrices of d rows may be off by, relatively.
    fn rounding(&self) -> f64 {
        32.0 * ((self.dim + 4) * (self.dim + 4)) as f64 * U
    }

    /// As how many steps a test counts.
    fn steps(&self) -> usize {
        64 * self.dim * self.dim
    }

    /// How far an item that lies in no ball reaches, for people to read.
    fn outside(
        &self,
        row: u64,
        item: &Item<'_>,
        meter: &mut Meter<'_>,
    ) -> Result<CentersViolation, Cancelled> {
        let mut least = (f64::INFINITY, 0);
        for (center, place) in self.answer.centers.iter().enumerate() {
            meter.spend(self.steps())?;
            let reach = reach_from(place, item);
            if reach < least.0 {
                least = (reach, center);
            }
        }
        let ((distance, center), radius) = (least, self.answer.radius);
        let excess = distance - radius;
        Ok(CentersViolation::Outside { row, center, distance, radius, excess })
    }
}

/// |p − c| in the size of its largest part.
fn distance(p: &[f64], c: &[f64]) -> f64 {
    let largest = p.iter().zip(c).fold(0.0f64, |most, (p, c)| most.max((p - c).abs()));
    if largest == 0.0 || largest == f64::INFINITY {
        return largest;
    }
    largest * p.iter().zip(c).map(|(p, c)| ((p - c) / largest).powi(2)).sum::<f64>().sqrt()
}

/// How far an item reaches from a center, measured in a unit of about that; infinite where it is no number.
fn reach_from(center: &[f64], item: &Item<'_>) -> f64 {
    let widest = (0..center.len()).map(|j| item.width(j, 1.0)).fold(0.0, f64::max);
    let unit = distance(item.center(), center).max(widest);
    if unit == 0.0 {
        return 0.0;
    }
    let as_ellipsoid = as_ellipsoid(center, &[], unit);
    let length = reach::length(&Frame::of(&as_ellipsoid), item);
    if length.is_nan() { f64::INFINITY } else { unit * length }
}

/// The points that the core-set names, each ellipsoid a group of them. Every row is already known to be an ellipsoid.
pub(super) fn core(
    answer: &Centers,
    certificate: &CentersCertificate,
    dim: usize,
    kept: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<Core, CheckError> {
    let around_first = as_ellipsoid(&answer.centers[0], &[], answer.radius);
    let frame = Frame::of(&around_first);
    let mut items = Vec::with_capacity(certificate.core_set.len() * (dim + 1));
    for (&row, direction) in certificate.core_set.iter().zip(&certificate.directions) {
        monitor.check().map_err(ReadError::from)?;
        let item = Item::of(Items::Ellipsoids, dim, kept.row(row));
        let (place, error) = place(&frame, &item, direction);
        items.extend(place);
        items.push(-error);
        if !items[items.len() - dim - 1..].iter().all(|value| value.is_finite()) {
            return Err(CentersViolation::TooFar { row }.into());
        }
    }
    let lower = answer.lower_bound * frame.scale;
    // A product with a power of two is exact unless it is subnormal.
    let bound = if lower / frame.scale < answer.lower_bound { lower.next_up() } else { lower };
    let core = Core::of(&items, dim + 1, Kind::Balls, bound);
    Ok(core.with_groups(certificate.core_set.iter().copied()))
}

/// A place near a point of an item, and a length that the two are not farther apart than, both in the unit of the frame.
fn place(frame: &Frame<'_>, item: &Item<'_>, direction: &[f64]) -> (Vec<f64>, f64) {
    let touching = Touching::of(frame, item, direction);
    let errors = touching.coordinate_errors();
    let offset = touching.offset;
    let places: Vec<f64> = offset.iter().map(DoubleDouble::rounded).collect();
    let mut error = 0.0;
    for (j, (x, place)) in offset.iter().zip(&places).enumerate() {
        let rest = x.minus(&DoubleDouble::of(*place)).rounded().abs();
        let of_point = errors.as_ref().map_or(0.0, |errors| errors[j]);
        error += rest + of_point + 8.0 * DoubleDouble::ROUNDOFF * place.abs() + f64::MIN_POSITIVE;
    }
    (places, error * (1.0 + (frame.dim + 8) as f64 * U))
}
