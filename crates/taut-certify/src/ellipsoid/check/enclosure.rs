//! Decides whether every item lies in the ellipsoid, and whether the rows are those the certificate speaks of: one pass.
//!
//! *Problem.* |F(x − c)| ≤ 1 for every row but those left out, and how far it is exceeded at worst.
//! *Idea.* Two stages, the second asked only about what the first left open.
//! 1. Plain: [`panel`](super::panel) finds |y|² for y = F(x − c) in `f64`, with one bound on the rounding for 128 rows.
//!    Balls and ellipsoids have a first stage of their own: [`reach`](super::reach).
//! 2. Doubled: the same to about 1e-30, so that what |y| exceeds 1 by is known to far less than its tolerance.
//!
//! *Guarantee.* No row is judged by a rounded number: all that is accepted is inside up to the excess reported.
//! *Trap.* NaN satisfies no comparison, but is skipped by `f64::max`: rows are searched for it first.

use taut_points::{Monitor, PointSource, Rows, ScalarKind};

use super::super::EllipsoidCertificate;
use super::frame::Frame;
use super::hull::HullTest;
use super::item::Item;
use super::panel::Panel;
use super::reach;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::hashed_pass::{KeptRows, WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Items, Violation};

/// By how much |F(x − c)| may exceed 1; what it does exceed by is charged to the gap.
///
/// A solver in plain `f64` knows where its ellipsoid ends to some 1e-13, even for points near its surface.
const EXCESS_MAX: f64 = 1e-12;

/// 2³⁰⁰: a length from which on squares are not formed, as they could overflow.
pub(crate) const FAR_OUT: f64 = f64::from_bits((1023 + 300) << 52);

pub(super) struct Enclosed {
    /// By how much |F(x − c)| exceeds 1 at worst, rounded up.
    pub(super) excess: f64,
    /// The distance that items reach from c, by coordinate, times the scale of the frame; rounded up.
    pub(super) extents: Vec<f64>,
    /// The distance of the farthest row from the hull, rounded up; 0 when there is none.
    pub(super) off_hull: f64,
    /// From where to where the set reaches, by coordinate; −∞ to ∞ backwards when there is no hull.
    pub(super) lows: Vec<f64>,
    pub(super) highs: Vec<f64>,
}

/// One ellipsoid, ready to be compared with rows.
pub(super) struct Enclosure<'a> {
    frame: &'a Frame<'a>,
    items: Items,
    left_out: &'a [u64],
    hull: Option<&'a HullTest<'a>>,
}

impl<'a> Enclosure<'a> {
    pub(super) fn of(
        frame: &'a Frame<'a>,
        hull: Option<&'a HullTest<'a>>,
        certificate: &'a EllipsoidCertificate,
    ) -> Self {
        Enclosure { frame, items: certificate.items, left_out: &certificate.left_out, hull }
    }

    /// Reads all rows once; returns those of the support too.
    pub(super) fn check(
        &self,
        source: &dyn PointSource,
        certificate: &EllipsoidCertificate,
        monitor: &Monitor<'_>,
    ) -> Result<(Enclosed, KeptRows), CheckError> {
        let wanted = WantedRows::of(&certificate.support);
        let claimed = certificate.points_hash;
        let (blocks, support) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            Ok(self.valid_block(first, rows)?)
        })?;
        let mut all = Enclosed::nothing(self.frame.dim);
        for block in blocks {
            all.merge(&block?);
        }
        Ok((all, support))
    }

    /// What a block of rows finds, or the first item outside; an error if a number is NaN or infinite.
    pub(super) fn valid_block(
        &self,
        first: u64,
        rows: &Rows<'_>,
    ) -> Result<Result<Enclosed, Violation>, Violation> {
        if !is_finite(rows) {
            all_finite(first, rows)?;
        }
        Ok(self.block(first, rows))
    }

    fn block(&self, first: u64, rows: &Rows<'_>) -> Result<Enclosed, Violation> {
        let (n, columns) = (rows.len(), self.items.columns(self.frame.dim));
        let mut found = Enclosed::nothing(self.frame.dim);
        let mut values = Vec::with_capacity(Panel::ROWS * columns);
        for start in (0..n).step_by(Panel::ROWS) {
            let count = Panel::ROWS.min(n - start);
            let range = start * columns..(start + count) * columns;
            values.clear();
            match rows {
                Rows::F32(points) => {
                    values.extend(points.values()[range].iter().map(|&v| f64::from(v)));
                }
                Rows::F64(points) => values.extend_from_slice(&points.values()[range]),
            }
            let first = first + start as u64;
            match self.items {
                Items::Points => self.points(first, &values, &mut found)?,
                Items::Balls | Items::Ellipsoids => {
                    self.shapes(first, &values, kind_of(rows), &mut found)?;
                }
            }
        }
        Ok(found)
    }

    /// The rows among those from `first` on that are left out, counted from there.
    fn left_out_of(&self, first: u64, count: usize) -> impl Iterator<Item = usize> {
        let from = self.left_out.partition_point(|&row| row < first);
        let end = first + count as u64;
        let rows = self.left_out[from..].iter().take_while(move |&&row| row < end);
        rows.map(move |row| (row - first) as usize)
    }

    fn points(&self, first: u64, values: &[f64], found: &mut Enclosed) -> Result<(), Violation> {
        let dim = self.frame.dim;
        let mut panel = Panel::of(self.frame, values);
        let left_out: Vec<usize> = self.left_out_of(first, panel.rows()).collect();
        left_out.iter().for_each(|&row| panel.forget(row));
        let threshold = panel.measure(self.frame);
        found.widen(panel.extents());
        // Rows of the panel that need a look of their own; the center, which stands for those left out, is inside.
        for row in panel.beyond(threshold) {
            found.take(first + row as u64, self.excess(&values[row * dim..][..dim]))?;
        }
        for row in left_out {
            let point = &values[row * dim..][..dim];
            // Off the hull is outside, wherever the projection lies.
            if !self.hull.is_some_and(|hull| hull.is_off(point, self.frame)) {
                reaches_outside(first + row as u64, self.excess(point))?;
            }
        }
        if let Some(hull) = self.hull {
            let mut left_out = self.left_out_of(first, panel.rows()).peekable();
            for (row, point) in values.chunks_exact(dim).enumerate() {
                if left_out.next_if_eq(&row).is_none() {
                    let off = hull.judge(first + row as u64, &Item::Point(point), self.frame)?;
                    found.off_hull = found.off_hull.max(off);
                    found.reach(&Item::Point(point));
                }
            }
        }
        Ok(())
    }

    /// |F(x − c)| − 1, rounded up where it is positive; a lower bound where it is far above 1, NaN where it is not known.
    fn excess(&self, point: &[f64]) -> f64 {
        let offset: Vec<DoubleDouble> = self.frame.offset(point);
        let sizes: Vec<f64> = offset.iter().map(|x| x.rounded().abs()).collect();
        let error = self.frame.image_error::<DoubleDouble>(&sizes, None);
        let image = self.frame.image(&offset);
        let has_square = image.iter().all(|y| y.rounded().abs() < FAR_OUT);
        if !has_square {
            return if self.frame.is_far_out(point) { FAR_OUT } else { f64::NAN };
        }
        let square = image.iter().fold(DoubleDouble::of(-1.0), |sum, y| sum.plus(&y.times(y)));
        excess_of_square(square, image.len()) + error
    }

    fn shapes(
        &self,
        first: u64,
        values: &[f64],
        kind: ScalarKind,
        found: &mut Enclosed,
    ) -> Result<(), Violation> {
        let columns = self.items.columns(self.frame.dim);
        let count = values.len() / columns;
        let mut left_out = self.left_out_of(first, count).peekable();
        for (row, values) in values.chunks_exact(columns).enumerate() {
            let number = first + row as u64;
            let item = Item::of(self.items, self.frame.dim, values);
            item.is_valid(number, kind)?;
            if left_out.next_if_eq(&row).is_some() {
                reaches_outside(number, reach::excess(self.frame, &item))?;
                continue;
            }
            found.widen(&item.extents(self.frame));
            if let Some(hull) = &self.hull {
                let off = hull.judge(number, &item, self.frame)?;
                found.off_hull = found.off_hull.max(off);
                found.reach(&item);
            }
            found.take(number, reach::excess(self.frame, &item))?;
        }
        Ok(())
    }
}

/// √(1 + t) − 1, or a little more, for a number t that was formed as −1 and about `steps` terms that are not negative.
pub(super) fn excess_of_square<N: Field>(t: N, steps: usize) -> f64 {
    let t = t.rounded();
    let rounding = (steps + 8) as f64 * 4.0 * N::ROUNDOFF * (2.0 + t.abs());
    let t = t + 4.0 * U * t.abs() + rounding;
    if t.is_nan() {
        return f64::INFINITY;
    }
    if t > 1.0 { (1.0 + t).sqrt() - 1.0 } else { t / 2.0 }
}

/// In which numbers rows are given.
pub(crate) fn kind_of(rows: &Rows<'_>) -> ScalarKind {
    match rows {
        Rows::F32(_) => ScalarKind::F32,
        Rows::F64(_) => ScalarKind::F64,
    }
}

/// Returns true if all coordinates are finite, in a form that compilers turn into vector instructions.
fn is_finite(rows: &Rows<'_>) -> bool {
    match rows {
        Rows::F32(points) => points.values().iter().fold(true, |all, v| all & v.is_finite()),
        Rows::F64(points) => points.values().iter().fold(true, |all, v| all & v.is_finite()),
    }
}

/// Refuses to leave out what lies inside, or what is not known to lie outside.
fn reaches_outside(row: u64, excess: f64) -> Result<(), Violation> {
    let is_outside = excess >= -EXCESS_MAX && excess.is_finite();
    if is_outside { Ok(()) } else { Err(Violation::NotOutside { row, norm: 1.0 + excess }) }
}

impl Enclosed {
    /// What rows of full rank were found to reach.
    pub(super) fn of(excess: f64, extents: Vec<f64>) -> Self {
        let nothing = Enclosed::nothing(extents.len());
        Enclosed { excess, extents, ..nothing }
    }

    fn nothing(dim: usize) -> Self {
        Enclosed {
            excess: 0.0,
            off_hull: 0.0,
            extents: vec![0.0; dim],
            lows: vec![f64::INFINITY; dim],
            highs: vec![f64::NEG_INFINITY; dim],
        }
    }

    /// Takes in by how much one row exceeds the ellipsoid.
    fn take(&mut self, row: u64, excess: f64) -> Result<(), Violation> {
        if excess <= EXCESS_MAX {
            self.excess = self.excess.max(excess);
            return Ok(());
        }
        Err(Violation::OutsideEllipsoid { row, norm: 1.0 + excess, excess })
    }

    fn widen(&mut self, extents: &[f64]) {
        self.extents.iter_mut().zip(extents).for_each(|(most, v)| *most = most.max(*v));
    }

    fn reach(&mut self, item: &Item<'_>) {
        for (j, &x) in item.center().iter().enumerate() {
            let width = item.width(j, 1.0);
            self.lows[j] = self.lows[j].min(x - width);
            self.highs[j] = self.highs[j].max(x + width);
        }
    }

    fn merge(&mut self, other: &Enclosed) {
        self.excess = self.excess.max(other.excess);
        self.off_hull = self.off_hull.max(other.off_hull);
        self.widen(&other.extents);
        self.lows.iter_mut().zip(&other.lows).for_each(|(low, v)| *low = low.min(*v));
        self.highs.iter_mut().zip(&other.highs).for_each(|(high, v)| *high = high.max(*v));
    }
}
