//! The passes over the points: moments, flags, distances in the metric of the rows kept.
//!
//! Each pass hashes what it reads, so that a source that changes between two of them is found out.

use taut_points::{Monitor, PointSource, Rows};

use super::super::{RobustCertificate, RobustEllipsoid, RobustMethod, Unweighted};
use super::cursor::{Cursor, compare, lacks};
use super::slack::Slack;
use super::sums::{Metric, Sums};
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::ellipsoid::check::enclosure::FAR_OUT;
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::hull::{HullTest, length};
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Violation};

/// The tolerance of the checker of ellipsoids at a border, from both sides.
const BORDER_TOLERANCE: f64 = 2e-12;

/// The objects that the passes read for.
pub(super) struct Passes<'a> {
    pub(super) answer: &'a RobustEllipsoid,
    pub(super) certificate: &'a RobustCertificate,
    pub(super) frame: &'a Frame<'a>,
    pub(super) hull: Option<&'a HullTest<'a>>,
}

/// The result of the first pass.
pub(super) struct Moments {
    pub(super) kept: Sums,
    pub(super) weighed: Sums,
    pub(super) on_hull: u64,
    /// |x − c| and |x| at most, by coordinate, over the rows kept.
    pub(super) extents: Vec<f64>,
    pub(super) coordinates: Vec<f64>,
}

pub(super) enum KeptMetric<'a> {
    /// That of the ellipsoid around them, and up to which distance rows lie strictly inside.
    Ellipsoid { frame: &'a Frame<'a>, inside: f64 },
    /// That of their mean and covariance.
    Moments(&'a Metric),
}

/// The result of the pass over distances.
struct Distances {
    /// The squared distance of the farthest row kept and the nearest row left out, and which they are.
    far: (f64, u64),
    near: (f64, u64),
    /// Rows kept that do not reach the border of the ellipsoid around them.
    inside: u64,
    /// Sums over the rows within the quantile, where nothing is weighed again.
    within: Sums,
}

impl Passes<'_> {
    /// Reads all rows once, and makes sure that they are those the certificate speaks of.
    fn pass<T: Send>(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
        block: impl Fn(u64, &Rows<'_>) -> Result<T, Violation> + Sync + Send,
    ) -> Result<Vec<T>, CheckError> {
        let (claimed, wanted) = (self.certificate.points_hash, WantedRows::none());
        let (blocks, _) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            all_finite(first, rows)?;
            Ok(block(first, rows))
        })?;
        Ok(blocks.into_iter().collect::<Result<_, _>>()?)
    }

    /// Moments of the rows kept and of those not weighed out.
    pub(super) fn moments(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Moments, CheckError> {
        let blocks = self.pass(source, monitor, |first, rows| self.moments_of(first, rows))?;
        let mut all = self.nothing();
        for block in blocks {
            all.kept.merge(&block.kept);
            all.weighed.merge(&block.weighed);
            all.on_hull += block.on_hull;
            widen(&mut all.extents, block.extents.iter().copied());
            widen(&mut all.coordinates, block.coordinates.iter().copied());
        }
        Ok(all)
    }

    fn nothing(&self) -> Moments {
        let (rank, dim) = (self.frame.rank, self.frame.dim);
        Moments {
            kept: Sums::new(rank),
            weighed: Sums::new(rank),
            on_hull: 0,
            extents: vec![0.0; dim],
            coordinates: vec![0.0; dim],
        }
    }

    fn moments_of(&self, first: u64, rows: &Rows<'_>) -> Result<Moments, Violation> {
        let mut left_out = Cursor::from(&self.certificate.left_out, first);
        let mut weighed_out = Cursor::from(&self.certificate.weighed_out, first);
        let mut found = self.nothing();
        let mut row = vec![0.0; self.frame.dim];
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            let id = first + i as u64;
            let (is_kept, is_weighed) = (!left_out.names(id), !weighed_out.names(id));
            if !self.is_on_hull(&row) {
                let is_weighed = is_weighed && self.certificate.method != RobustMethod::Trim;
                for (list, stays) in [("left out", is_kept), ("weighed out", is_weighed)] {
                    if stays {
                        return Err(lacks(list, id, f64::INFINITY));
                    }
                }
                continue;
            }
            found.on_hull += 1;
            if !is_kept && !is_weighed {
                continue;
            }
            let y = self.frame.image(&self.frame.offset::<DoubleDouble>(&row));
            if is_kept {
                found.kept.add(&y);
                let offsets = row.iter().zip(self.frame.center).map(|(x, c)| (x - c).abs());
                widen(&mut found.extents, offsets);
                widen(&mut found.coordinates, row.iter().map(|x| x.abs()));
            }
            if is_weighed {
                found.weighed.add(&y);
            }
        }
        Ok(found)
    }

    fn is_on_hull(&self, row: &[f64]) -> bool {
        self.hull.is_none_or(|hull| hull.is_within(row, self.frame))
    }

    /// Tests whether the outliers are the rows outside the ellipsoid or off the hull, as a user would find in `f64`. Returns by
    /// how much at most a row is on the wrong side of the border.
    pub(super) fn flags(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<f64, CheckError> {
        let blocks = self.pass(source, monitor, |first, rows| {
            let mut outliers = Cursor::from(&self.answer.outliers, first);
            let mut row = vec![0.0; self.frame.dim];
            let mut most = 0.0f64;
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let id = first + i as u64;
                most = most.max(self.flag(id, &row, outliers.names(id))?);
            }
            Ok(most)
        })?;
        Ok(blocks.into_iter().fold(0.0, f64::max))
    }

    /// By how much a row is on the wrong side, if that is no more than rounding.
    fn flag(&self, id: u64, row: &[f64], is_outlier: bool) -> Result<f64, Violation> {
        if !self.is_on_hull(row) {
            compare("outliers", is_outlier, id, f64::INFINITY, 0.0)?;
            return Ok(0.0);
        }
        let offset = self.frame.offset::<f64>(row);
        let norm = length(&self.frame.image(&offset));
        let has_square = norm < FAR_OUT;
        if !has_square {
            compare("outliers", is_outlier, id, far_out(self.frame, row), 0.0)?;
            return Ok(0.0);
        }
        let sizes: Vec<f64> = offset.iter().map(|x| x.abs()).collect();
        let mut slack = self.frame.image_error::<f64>(&sizes, None) + 8.0 * U;
        if self.certificate.method == RobustMethod::Trim {
            slack += BORDER_TOLERANCE;
        }
        let is_clear = (norm - 1.0).abs() > 2.0 * slack;
        if is_clear {
            compare("outliers", is_outlier, id, norm, 0.0)?;
            return Ok(0.0);
        }
        let image = self.frame.image(&self.frame.offset::<DoubleDouble>(row));
        let square =
            image.iter().fold(DoubleDouble::of(-1.0), |sum, y| sum.plus(&y.times(y))).rounded();
        let beyond = square / (1.0 + (1.0 + square).max(0.0).sqrt());
        compare("outliers", is_outlier, id, 1.0 + beyond, slack)?;
        Ok(if is_outlier { -beyond } else { beyond }.max(0.0))
    }

    /// Distances in the metric of the rows kept: none of these may be farther than a row left out, rows weighed out are
    /// those beyond the quantile, and the ellipsoid around the rows kept holds no more than were asked for but on its
    /// border.
    pub(super) fn distances(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
        around: &KeptMetric<'_>,
        slack: &Slack,
    ) -> Result<(), CheckError> {
        let slack = slack.of_places;
        let border = self.certificate.cutoff * self.certificate.raw_scale;
        let is_trimmed = self.certificate.method == RobustMethod::Trim;
        let reweighted = self.certificate.unweighted.is_none();
        let rank = self.frame.rank;
        let inside = match around {
            KeptMetric::Ellipsoid { inside, .. } => *inside,
            KeptMetric::Moments(_) => f64::NEG_INFINITY,
        };
        let blocks = self.pass(source, monitor, |first, rows| {
            let mut left_out = Cursor::from(&self.certificate.left_out, first);
            let mut weighed_out = Cursor::from(&self.certificate.weighed_out, first);
            let mut row = vec![0.0; self.frame.dim];
            let mut found = Distances::nothing(rank);
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let id = first + i as u64;
                let (is_out, is_weighed_out) = (left_out.names(id), weighed_out.names(id));
                if !self.is_on_hull(&row) {
                    continue;
                }
                let y = || self.frame.image(&self.frame.offset::<DoubleDouble>(&row));
                let square = match around {
                    KeptMetric::Ellipsoid { frame, .. } => {
                        let norm = length(&frame.image(&frame.offset::<f64>(&row)));
                        if norm < FAR_OUT { norm * norm } else { far_out(frame, &row) }
                    }
                    KeptMetric::Moments(metric) => match metric.square(&y()) {
                        square if square.is_nan() => far_out(self.frame, &row),
                        square => square,
                    },
                };
                found.take(id, is_out, square);
                if !is_out && square.sqrt() < inside {
                    found.inside += 1;
                }
                if is_trimmed {
                    continue;
                }
                let distance = (square / border).sqrt();
                if reweighted {
                    compare("weighed out", is_weighed_out, id, distance, slack)?;
                } else if distance <= 1.0 - slack {
                    found.within.add(&y());
                }
            }
            Ok(found)
        })?;
        let mut all = Distances::nothing(rank);
        blocks.iter().for_each(|block| all.merge(block));
        all.judge(self.certificate, slack, rank)?;
        Ok(())
    }
}

impl Distances {
    fn nothing(rank: usize) -> Self {
        Distances {
            far: (f64::NEG_INFINITY, 0),
            near: (f64::INFINITY, 0),
            inside: 0,
            within: Sums::new(rank),
        }
    }

    fn take(&mut self, row: u64, is_out: bool, square: f64) {
        if is_out && (square < self.near.0 || square.is_nan()) {
            self.near = (square, row);
        }
        if !is_out && (square > self.far.0 || square.is_nan()) {
            self.far = (square, row);
        }
    }

    fn merge(&mut self, other: &Distances) {
        if other.far.0 > self.far.0 || other.far.0.is_nan() {
            self.far = other.far;
        }
        if other.near.0 < self.near.0 || other.near.0.is_nan() {
            self.near = other.near;
        }
        self.inside += other.inside;
        self.within.merge(&other.within);
    }

    fn judge(
        &self,
        certificate: &RobustCertificate,
        slack: f64,
        rank: usize,
    ) -> Result<(), Violation> {
        let is_nearest =
            self.far.0 <= self.near.0 * (1.0 + slack) + slack && self.far.0 < f64::INFINITY;
        if !is_nearest {
            let ((distance, kept), (nearer, other)) = (self.far, self.near);
            return Err(Violation::NotNearest { kept, distance, other, nearer });
        }
        if self.inside >= certificate.kept {
            return Err(Violation::Spare { inside: self.inside, kept: certificate.kept });
        }
        match certificate.unweighted {
            Some(why @ Unweighted::Flat) if !self.within.is_flat(rank) => {
                Err(Violation::Reweighting { reason: why.reason() })
            }
            _ => Ok(()),
        }
    }
}

/// An infinite distance for a row that lies far outside; NaN, which is refused, for one of which nothing is known.
fn far_out(frame: &Frame<'_>, row: &[f64]) -> f64 {
    if frame.is_far_out(row) { f64::INFINITY } else { f64::NAN }
}

fn widen(most: &mut [f64], sizes: impl Iterator<Item = f64>) {
    most.iter_mut().zip(sizes).for_each(|(most, size)| *most = most.max(size));
}
