//! The two passes over the points: moments and flags, then distances in the metric of the rows kept.

use taut_points::{Monitor, PointSource, PointsHash, Rows, hash_block, map_blocks};

use super::super::{RobustCertificate, RobustEllipsoid, RobustMethod};
use crate::arithmetic::{DoubleDouble, Field, Ring, U, factorise};
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::hull::{HullTest, length};
use crate::{CheckError, Violation};

/// What is granted at most where coordinates have few digits left.
const SLACK_MAX: f64 = 0.1;

/// What is to be read.
pub(super) struct Scan<'a> {
    pub(super) answer: &'a RobustEllipsoid,
    pub(super) certificate: &'a RobustCertificate,
    pub(super) frame: &'a Frame<'a>,
    pub(super) hull: Option<&'a HullTest<'a>>,
}

/// Σ 1, Σ y and Σ yy′.
#[derive(Clone)]
pub(super) struct Sums {
    count: u64,
    first: Vec<DoubleDouble>,
    /// The lower triangle by rows.
    second: Vec<DoubleDouble>,
}

/// What the first pass finds.
pub(super) struct First {
    pub(super) kept: Sums,
    pub(super) weighed: Sums,
    pub(super) on_hull: u64,
    /// |x_b − c_b| + |c_b| at most, over the rows kept.
    reach: Vec<f64>,
}

/// Mean and factorised covariance of y over the rows kept.
pub(super) struct Metric {
    mean: Vec<f64>,
    /// C = LDL′: L below the diagonal, D on it.
    lower: Vec<f64>,
}

impl Sums {
    fn new(rank: usize) -> Self {
        let zero = DoubleDouble::of(0.0);
        Sums { count: 0, first: vec![zero; rank], second: vec![zero; rank * (rank + 1) / 2] }
    }

    fn add(&mut self, y: &[DoubleDouble]) {
        self.count += 1;
        let mut entries = self.second.iter_mut();
        for (a, (sum, value)) in self.first.iter_mut().zip(y).enumerate() {
            *sum = sum.plus(value);
            for (entry, other) in entries.by_ref().take(a + 1).zip(y) {
                *entry = entry.plus(&value.times(other));
            }
        }
    }

    fn merge(&mut self, other: &Sums) {
        self.count += other.count;
        let pairs = self.first.iter_mut().chain(&mut self.second);
        for (sum, term) in pairs.zip(other.first.iter().chain(&other.second)) {
            *sum = sum.plus(term);
        }
    }

    /// Mean and covariance, divisor k − 1, the lower triangle by rows.
    fn estimate(&self) -> (Vec<DoubleDouble>, Vec<DoubleDouble>) {
        let count = DoubleDouble::of(self.count as f64);
        let less = DoubleDouble::of(self.count.saturating_sub(1).max(1) as f64);
        let mean: Vec<DoubleDouble> = self.first.iter().map(|s| s.over(&count)).collect();
        let mut covariance = self.second.clone();
        let mut entries = covariance.iter_mut();
        for (a, value) in mean.iter().enumerate() {
            for (entry, other) in entries.by_ref().take(a + 1).zip(&mean) {
                *entry = entry.minus(&value.times(other).times(&count)).over(&less);
            }
        }
        (mean, covariance)
    }

    /// Whether the mean is 0 and the covariance I/border.
    pub(super) fn is_standard(
        &self,
        border: f64,
        rank: usize,
        slack: f64,
    ) -> Result<(), Violation> {
        let (mean, covariance) = self.estimate();
        let wrong =
            |what: String, claimed, found| Err(Violation::Estimate { what, claimed, found });
        for (a, value) in mean.iter().enumerate() {
            let is_zero = value.rounded().abs() <= slack;
            if !is_zero {
                let what = format!("coordinate {a} of the centre, in the frame of the ellipsoid,");
                return wrong(what, 0.0, value.rounded());
            }
        }
        for a in 0..rank {
            for b in 0..=a {
                let wanted = f64::from(u8::from(a == b));
                let found = covariance[a * (a + 1) / 2 + b].rounded() * border;
                let agrees = (found - wanted).abs() <= slack;
                if !agrees {
                    let what =
                        format!("entry ({a}, {b}) of the scatter, in the frame of the ellipsoid,");
                    return wrong(what, wanted, found);
                }
            }
        }
        Ok(())
    }
}

impl First {
    /// The tolerance for numbers in the frame: `slack`, and what rounding of coordinates leaves open.
    pub(super) fn slack(&self, frame: &Frame<'_>, slack: f64) -> f64 {
        let noise = |row: &[f64]| -> f64 {
            row.iter().zip(&self.reach).map(|(f, reach)| f.abs() * reach).sum()
        };
        let noise: f64 = (0..frame.rank).map(|a| noise(frame.full_row(a))).fold(0.0, f64::max);
        (slack + 16.0 * (frame.dim + 4) as f64 * U * noise * frame.scale).min(SLACK_MAX)
    }
}

impl Metric {
    /// None where the covariance is singular.
    pub(super) fn of(sums: &Sums, rank: usize) -> Option<Self> {
        let (mean, mut covariance) = sums.estimate();
        factorise(&mut covariance, rank).then(|| Metric {
            mean: mean.iter().map(Field::rounded).collect(),
            lower: covariance.iter().map(Field::rounded).collect(),
        })
    }

    /// ln det C.
    pub(super) fn log_det(&self) -> f64 {
        (0..self.mean.len()).map(|a| self.lower[a * (a + 3) / 2].ln()).sum()
    }

    /// (y − ȳ)′C⁻¹(y − ȳ).
    fn square(&self, y: &[DoubleDouble]) -> f64 {
        let mut z: Vec<f64> = vec![];
        let mut square = 0.0;
        for (a, (y, mean)) in y.iter().zip(&self.mean).enumerate() {
            let row = &self.lower[a * (a + 1) / 2..];
            let along: f64 = row.iter().zip(&z).map(|(l, z)| l * z).sum();
            let value = y.minus(&DoubleDouble::of(*mean)).rounded() - along;
            square += value * value / row[a];
            z.push(value);
        }
        square
    }
}

/// Whether a row is in an ascending list, asked for ascending rows.
struct Cursor<'a> {
    rows: &'a [u64],
}

impl<'a> Cursor<'a> {
    fn from(rows: &'a [u64], first: u64) -> Self {
        Cursor { rows: &rows[rows.partition_point(|&row| row < first)..] }
    }

    fn names(&mut self, row: u64) -> bool {
        let found = self.rows.first() == Some(&row);
        if found {
            self.rows = &self.rows[1..];
        }
        found
    }
}

impl Scan<'_> {
    /// Hash, moments, flags.
    pub(super) fn first(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<First, CheckError> {
        let blocks = map_blocks(source, monitor, |first, rows| {
            if let Some((row, column, value)) = rows.first_non_finite() {
                let row = first + row as u64;
                return Err(CheckError::from(Violation::NonFinite { row, column, value }));
            }
            Ok((hash_block(&rows), self.block(first, &rows)))
        })?;
        let hashes = blocks.iter().map(|block| block.0);
        let found = PointsHash::of_blocks(source.len(), source.dim(), hashes);
        if found != self.certificate.points_hash {
            let claimed = self.certificate.points_hash.to_string();
            return Err(Violation::Hash { claimed, found: found.to_string() }.into());
        }
        let mut all = self.nothing();
        for (_, block) in blocks {
            let block = block?;
            all.kept.merge(&block.kept);
            all.weighed.merge(&block.weighed);
            all.on_hull += block.on_hull;
            all.reach.iter_mut().zip(block.reach).for_each(|(r, v)| *r = r.max(v));
        }
        let slack = all.slack(self.frame, super::SLACK);
        self.flags(source, monitor, slack)?;
        Ok(all)
    }

    fn nothing(&self) -> First {
        let rank = self.frame.rank;
        First {
            kept: Sums::new(rank),
            weighed: Sums::new(rank),
            on_hull: 0,
            reach: vec![0.0; self.frame.dim],
        }
    }

    fn block(&self, first: u64, rows: &Rows<'_>) -> Result<First, Violation> {
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
                for ((reach, x), c) in found.reach.iter_mut().zip(&row).zip(self.frame.center) {
                    *reach = reach.max((x - c).abs() + c.abs());
                }
            }
            if is_weighed {
                found.weighed.add(&y);
            }
        }
        Ok(found)
    }

    fn is_on_hull(&self, row: &[f64]) -> bool {
        let (Some(test), Some(hull)) = (self.hull, &self.answer.hull) else { return true };
        let offset = self.frame.offset::<f64>(row);
        length(&test.off(&offset)) <= hull.distance * self.frame.scale
    }

    /// Whether the rows flagged are those outside the ellipsoid or off the hull.
    fn flags(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
        slack: f64,
    ) -> Result<(), CheckError> {
        map_blocks(source, monitor, |first, rows| {
            let mut flagged = Cursor::from(&self.answer.flagged, first);
            let mut row = vec![0.0; self.frame.dim];
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let id = first + i as u64;
                let norm = if self.is_on_hull(&row) {
                    let y = self.frame.image(&self.frame.offset::<f64>(&row));
                    length(&y)
                } else {
                    f64::INFINITY
                };
                compare("flagged", flagged.names(id), id, norm, slack)?;
            }
            Ok::<(), CheckError>(())
        })?;
        Ok(())
    }

    /// Distances in the metric of the rows kept: from `around`, the ellipsoid around them, or from their moments.
    pub(super) fn second(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
        around: Option<&Frame<'_>>,
        raw: Option<&Metric>,
        reweighted: bool,
        slack: f64,
    ) -> Result<(), CheckError> {
        let border = self.certificate.cutoff * self.certificate.raw_scale;
        let ends = map_blocks(source, monitor, |first, rows| {
            let mut left_out = Cursor::from(&self.certificate.left_out, first);
            let mut weighed_out = Cursor::from(&self.certificate.weighed_out, first);
            let mut row = vec![0.0; self.frame.dim];
            let (mut far, mut near) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let id = first + i as u64;
                let (is_out, is_weighed_out) = (left_out.names(id), weighed_out.names(id));
                if !self.is_on_hull(&row) {
                    continue;
                }
                let square = match (around, raw) {
                    (Some(around), _) => length(&around.image(&around.offset::<f64>(&row))).powi(2),
                    (None, Some(raw)) => {
                        raw.square(&self.frame.image(&self.frame.offset::<DoubleDouble>(&row)))
                    }
                    (None, None) => f64::INFINITY,
                };
                if is_out && square < near.0 {
                    near = (square, id);
                }
                if !is_out && (square > far.0 || square.is_nan()) {
                    far = (square, id);
                }
                if reweighted {
                    let distance = (square / border).sqrt();
                    compare("weighed out", is_weighed_out, id, distance, slack)?;
                }
            }
            Ok::<_, CheckError>((far, near))
        })?;
        let mut far = (f64::NEG_INFINITY, 0);
        let mut near = (f64::INFINITY, 0);
        for (one, other) in ends {
            far = if one.0 > far.0 || one.0.is_nan() { one } else { far };
            near = if other.0 < near.0 { other } else { near };
        }
        let is_nearest = far.0 <= near.0 * (1.0 + slack) + slack;
        if is_nearest {
            return Ok(());
        }
        let ((distance, kept), (nearer, other)) = (far, near);
        Err(Violation::NotNearest { kept, distance, other, nearer }.into())
    }
}

/// Whether a row is listed just when it lies beyond the border, at 1.
fn compare(
    list: &'static str,
    is_listed: bool,
    row: u64,
    distance: f64,
    slack: f64,
) -> Result<(), Violation> {
    let inside = distance <= 1.0 + slack;
    if !is_listed && !inside {
        return Err(lacks(list, row, distance));
    }
    if is_listed && distance < 1.0 - slack {
        return Err(Violation::Listed { list, problem: "names", row, distance });
    }
    Ok(())
}

fn lacks(list: &'static str, row: u64, distance: f64) -> Violation {
    Violation::Listed { list, problem: "lacks", row, distance }
}
