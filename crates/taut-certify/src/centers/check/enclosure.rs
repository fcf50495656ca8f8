//! Tests exactly whether every row that counts lies in one of the balls, and whether the rows are those the certificate
//! speaks of.
//!
//! *Problem.* For each of n rows, some center c with w·|p − c| + r ≤ R; in one pass.
//! *Idea.* The center that held the row before is asked first, then those that are not too far along some axis
//! ([`CenterTree`]). What plain arithmetic leaves open is decided in whole numbers, by [`compare`].
//! *Assignment.* Where it is given, the center named for a row must be the nearest but for what a sum in `f64` may be off
//! by, |p − c| ≤ |p − c'|·(1 + (d + 32)u) + 4ur for every other c': which of centers that are equally near by rounding is
//! the first, depends on the order of a sum. Rows left out are assigned like others.
//! *Guarantee.* No row is misjudged by R, so the first row found outside does not depend on threads.

use std::cmp::Ordering;

use taut_points::{Cancelled, Monitor, PointSource, Points, Rows, Scalar};

use super::super::{Centers, CentersCertificate, CentersViolation};
use super::center_tree::CenterTree;
use super::distance::{Scale, compare, factors, is_same_place, kappa, square, thresholds};
use super::item::{Item, Kind};
use super::meter::Meter;
use crate::CheckError;
use crate::arithmetic::U;
use crate::hashed_pass::{KeptRows, WantedRows, hashed_pass};

/// The balls, ready to be compared with rows.
pub(super) struct Enclosure<'a> {
    answer: &'a Centers,
    kind: Kind,
    scale: Scale,
    kappa: f64,
    center_tree: CenterTree,
}

impl<'a> Enclosure<'a> {
    pub(super) fn of(answer: &'a Centers, kind: Kind) -> Self {
        let dim = answer.centers[0].len();
        let center_tree = CenterTree::of(&answer.centers);
        let scale = Scale::of(answer.radius);
        Enclosure { answer, kind, scale, kappa: kappa(dim), center_tree }
    }

    /// Reads all rows once; returns those of the core-set and those that are centers.
    pub(super) fn check(
        &self,
        source: &dyn PointSource,
        certificate: &CentersCertificate,
        monitor: &Monitor<'_>,
    ) -> Result<KeptRows, CheckError> {
        let wanted = WantedRows::of(certificate.core_set.iter().chain(&self.answer.rows));
        let claimed = certificate.points_hash;
        let (blocks, kept) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            self.block(first, rows, monitor)
        })?;
        match blocks.into_iter().flatten().next() {
            Some(problem) => Err(problem.into()),
            None => Ok(kept),
        }
    }

    /// The first row of a block that is outside or assigned wrongly; an error if a row is no item at all.
    pub(super) fn block(
        &self,
        first: u64,
        rows: &Rows<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<Option<CentersViolation>, CheckError> {
        let mut meter = Meter::of(monitor);
        match rows {
            Rows::F32(points) => self.rows(first, points, &mut meter),
            Rows::F64(points) => self.rows(first, points, &mut meter),
        }
    }

    /// The first row outside or assigned wrongly; an error if a row is no item at all.
    fn rows<T: Scalar>(
        &self,
        first: u64,
        points: &Points<'_, T>,
        meter: &mut Meter<'_>,
    ) -> Result<Option<CentersViolation>, CheckError> {
        let left_out = &self.answer.outliers;
        let mut left_out = &left_out[left_out.partition_point(|&row| row < first)..];
        let mut problem = None;
        let mut held_by = 0;
        for (number, row) in (first..).zip(points.rows()) {
            self.kind.is_valid(number, row)?;
            if problem.is_some() {
                continue;
            }
            let item = self.kind.item(row);
            let counts = left_out.first() != Some(&number);
            left_out = &left_out[usize::from(!counts)..];
            problem = self.row(number, &item, counts, &mut held_by, meter)?.err();
        }
        Ok(problem)
    }

    /// `held_by` is the center that held the row before, and becomes the one that holds this.
    #[inline(always)]
    fn row<T: Scalar>(
        &self,
        number: u64,
        item: &Item<'_, T>,
        counts: bool,
        held_by: &mut usize,
        meter: &mut Meter<'_>,
    ) -> Result<Result<(), CentersViolation>, Cancelled> {
        match self.assigned(number, item, meter)? {
            Err(violation) => return Ok(Err(violation)),
            Ok(Some(assigned)) => *held_by = assigned,
            Ok(None) => {}
        }
        match !counts || self.is_held(item, held_by, meter)? {
            true => Ok(Ok(())),
            false => Ok(Err(self.outside(number, item))),
        }
    }

    /// Tests whether a ball holds the item; `held_by` is the one asked first, and becomes the one that does.
    #[inline(always)]
    fn is_held<T: Scalar>(
        &self,
        item: &Item<'_, T>,
        held_by: &mut usize,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        let centers = &self.answer.centers;
        let rho = self.answer.radius - item.radius;
        if rho < 0.0 {
            return Ok(false);
        }
        let reach = rho / item.weight;
        if reach == 0.0 {
            // Not even the least number: nothing but the very place of the center.
            let is_same = |center: usize| is_same_place(item.position, &centers[center]);
            return self.find(item.position, 0.0, is_same, held_by, meter);
        }
        let (inside, _) = thresholds(rho, self.kappa, self.scale);
        // What underflows is nothing beside this.
        if inside > 1e-150
            && let Some(factors) = factors(item.weight, self.scale)
        {
            let plainly = |center: usize| square(item.position, &centers[center], factors) < inside;
            if self.find(item.position, reach * (1.0 + 1e-9), plainly, held_by, meter)? {
                return Ok(true);
            }
        }
        let rho = [self.answer.radius, -item.radius];
        for (center, place) in centers.iter().enumerate() {
            let reaches = compare(item.position, place, item.weight, &rho, self.scale, meter)?;
            if reaches != Ordering::Greater {
                *held_by = center;
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns true if some center, of all that are so near and perhaps of others, passes a test; the one that did last is asked
    /// first.
    #[inline(always)]
    fn find<T: Scalar>(
        &self,
        place: &[T],
        reach: f64,
        mut test: impl FnMut(usize) -> bool,
        held_by: &mut usize,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        let mut asked = 1;
        let found = match test(*held_by) {
            true => Some(*held_by),
            false => self.center_tree.find(place, reach, |center| {
                asked += 1;
                test(center)
            }),
        };
        meter.spend(asked * place.len())?;
        if let Some(found) = found {
            *held_by = found;
        }
        Ok(found.is_some())
    }

    /// The center to which an item is assigned, if it is the nearest.
    fn assigned<T: Scalar>(
        &self,
        row: u64,
        item: &Item<'_, T>,
        meter: &mut Meter<'_>,
    ) -> Result<Result<Option<usize>, CentersViolation>, Cancelled> {
        let Some(&center) = self.answer.assignment.get(row as usize) else { return Ok(Ok(None)) };
        let named = center as usize;
        if named >= self.answer.centers.len() {
            return Ok(Err(CentersViolation::NoSuchCenter { row, center }));
        }
        let distance = |center: usize| distance(item.position, &self.answer.centers[center]);
        let own = distance(named);
        let slack = 1.0 + (item.position.len() + 32) as f64 * U;
        let mut asked = 1;
        let is_nearer = |other: usize| {
            asked += 1;
            distance(other) * slack + 4.0 * U * item.radius < own
        };
        let nearer = self.center_tree.find(item.position, own * (1.0 + 1e-9), is_nearer);
        meter.spend(asked * item.position.len())?;
        Ok(match nearer {
            Some(nearer) => Err(CentersViolation::Assignment { row, center, nearer }),
            None => Ok(Some(named)),
        })
    }

    /// Returns how far the item reaches from the center next to it, for people to read.
    fn outside<T: Scalar>(&self, row: u64, item: &Item<'_, T>) -> CentersViolation {
        let reach = |center: &Vec<f64>| item.weight * distance(item.position, center) + item.radius;
        let mut nearest = (0, f64::INFINITY);
        for (center, distance) in self.answer.centers.iter().map(reach).enumerate() {
            if distance < nearest.1 {
                nearest = (center, distance);
            }
        }
        let ((center, distance), radius) = (nearest, self.answer.radius);
        // By how little it is outside, may be less than the rounding of the distance.
        let excess = (distance - radius).max(radius * f64::EPSILON / 2.0);
        CentersViolation::Outside { row, center, distance, radius, excess }
    }
}

/// |p − c| to a few units in the last place, whatever its size.
pub(super) fn distance<T: Scalar>(position: &[T], center: &[f64]) -> f64 {
    let differences = || position.iter().zip(center).map(|(&x, &c)| x.into() - c);
    let plain: f64 = differences().map(|d| d * d).sum();
    if (1e-280..1e280).contains(&plain) {
        return plain.sqrt();
    }
    let largest = differences().fold(0.0, |m: f64, d| m.max(d.abs()));
    if largest == 0.0 || largest.is_infinite() {
        return largest;
    }
    largest * differences().map(|d| (d / largest).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use taut_points::hash_points;

    use super::super::distance::tests::EXACTLY;
    use super::*;
    use crate::{Items, LowerBound, Placement};

    /// Tests whether rows are held, and how many comparisons took whole numbers.
    fn held(
        rows: &[f64],
        dim: usize,
        kind: Kind,
        centers: Vec<Vec<f64>>,
        radius: f64,
    ) -> (bool, u64) {
        let (points, monitor) = (Points::new(rows, dim).unwrap(), Monitor::silent());
        let (lower_bound, none) = (0.0, vec![]);
        let answer = Centers {
            centers,
            rows: vec![],
            radius,
            lower_bound,
            outliers: none,
            assignment: vec![],
        };
        let before = EXACTLY.get();
        let certificate = CentersCertificate {
            items: Items::Points,
            weights: false,
            group: None,
            placement: Placement::Free,
            k: answer.centers.len() as u64,
            outliers: 0,
            core_set: vec![],
            directions: vec![],
            proof: LowerBound::Separated,
            gap: 0.0,
            points_hash: hash_points(&points, &monitor).unwrap(),
        };
        let is_held = Enclosure::of(&answer, kind).check(&points, &certificate, &monitor).is_ok();
        (is_held, EXACTLY.get() - before)
    }

    #[test]
    fn rows_that_have_to_be_centers_are_compared_plainly() {
        let centers: Vec<Vec<f64>> =
            (0..300).map(|i| vec![f64::from(i * i % 307), f64::from(i) * 0.1 - 3.0]).collect();
        let rows: Vec<f64> = centers.iter().rev().cycle().take(3000).flatten().copied().collect();
        assert_eq!(held(&rows, 2, Kind::Points, centers.clone(), 0.0), (true, 0));
        let mut other = rows.clone();
        other[4001] = other[4001].next_up();
        assert_eq!(held(&other, 2, Kind::Points, centers.clone(), 0.0), (false, 0));
        // Zeros of either sign are one place.
        assert_eq!(held(&[-0.0, 0.0], 2, Kind::Points, vec![vec![0.0, -0.0]], 0.0), (true, 0));
        let with = |extra: f64| -> Vec<f64> {
            rows.chunks(2).flat_map(|row| [row[0], row[1], extra]).collect()
        };
        // Balls as large as they may be, and larger ones.
        assert_eq!(held(&with(2.5), 3, Kind::Balls, centers.clone(), 2.5), (true, 0));
        assert_eq!(held(&with(2.5), 3, Kind::Balls, centers.clone(), 2.4), (false, 0));
        // Weights beside which no distance is small enough, and weights far from 1.
        for weight in [1e-300, 1.0, 1e300] {
            assert_eq!(held(&with(weight), 3, Kind::Weighted, centers.clone(), 0.0), (true, 0));
        }
        assert_eq!(held(&with(1e300), 3, Kind::Weighted, centers.clone(), 1e-300), (true, 0));
        assert_eq!(held(&with(1e150), 3, Kind::Weighted, centers.clone(), 1e148), (true, 0));
        assert_eq!(
            held(&with(1e-150), 3, Kind::Weighted, centers[..9].to_vec(), 1e-152),
            (false, 0)
        );
    }
}
