//! The checker of an order.
//!
//! *Idea.* A grid over the box of the points gives each a place on the curve; along the order places do not fall. Where
//! many points share a cell the same is asked of them, with a grid over their own box; few are in order of their
//! coordinates, then of their numbers.
//! *Guarantee.* Exact: there is one such order of the points, and it is this one.
//! *Trap.* A cell is a quotient in double precision: the operations of the definition are repeated one by one.

use taut_points::{Monitor, PointSource, PointsHash, hash_block, map_blocks};

use super::{Order, OrderCertificate, OrderVerdict, OrderViolation, cell};
use crate::hashed_pass::all_finite;
use crate::{CheckError, Violation};

/// Up to this many points of one cell are in order of their coordinates.
const COORDINATE_ORDER_MAX: usize = 6;

pub(super) fn check(
    answer: &Order,
    certificate: &OrderCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<OrderVerdict, CheckError> {
    let (dim, points) = (source.dim(), source.len());
    if !(2..=3).contains(&dim) {
        return Err(OrderViolation::Dimension { dim }.into());
    }
    monitor.pass(1, points);
    let places = read(certificate, source, monitor)?;
    each_row_once(answer, points)?;
    let at = |row: u64| &places[row as usize * dim..][..dim];
    let mut grids = 0;
    // Stretches of the order whose points share a cell of every grid so far.
    let mut open = vec![(0, answer.rows.len())];
    while let Some((start, end)) = open.pop() {
        monitor.check().map_err(taut_points::ReadError::from)?;
        let rows = &answer.rows[start..end];
        let descends = |i: usize| {
            let place = (start + i) as u64;
            CheckError::from(OrderViolation::Descent { place, row: answer.rows[start + i] })
        };
        if let Some(grid) = (start == 0 && end == answer.rows.len()
            || rows.len() > COORDINATE_ORDER_MAX)
            .then(|| Grid::over(rows.iter().map(|&row| at(row)), dim))
            .flatten()
        {
            grids += 1;
            let keys: Vec<u64> = rows.iter().map(|&row| grid.key(answer.curve, at(row))).collect();
            if let Some(i) = keys.windows(2).position(|pair| pair[1] < pair[0]) {
                return Err(descends(i + 1));
            }
            let mut first = start;
            for run in keys.chunk_by(|a, b| a == b) {
                if run.len() > 1 {
                    open.push((first, first + run.len()));
                }
                first += run.len();
            }
            continue;
        }
        // Points all equal are in order of their numbers, too.
        let before = |a: u64, b: u64| match at(a).partial_cmp(at(b)) {
            Some(order) => order.then(a.cmp(&b)).is_lt(),
            None => false,
        };
        if let Some(i) = rows.windows(2).position(|pair| !before(pair[0], pair[1])) {
            return Err(descends(i + 1));
        }
    }
    Ok(OrderVerdict { points, grids })
}

/// All coordinates, which must be finite and those of the certificate.
fn read(
    certificate: &OrderCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Vec<f64>, CheckError> {
    let dim = source.dim();
    let blocks = map_blocks(source, monitor, |first, rows| {
        all_finite(first, &rows)?;
        let mut values = vec![0.0; rows.len() * dim];
        values.chunks_exact_mut(dim).enumerate().for_each(|(i, row)| rows.copy_row(i, row));
        Ok::<_, CheckError>((hash_block(&rows), values))
    })?;
    let hashes: Vec<_> = blocks.iter().map(|block| block.0).collect();
    let found = PointsHash::of_blocks(source.len(), dim, hashes);
    if found != certificate.points_hash {
        let (claimed, found) = (certificate.points_hash.to_string(), found.to_string());
        return Err(Violation::Hash { claimed, found }.into());
    }
    Ok(blocks.into_iter().flat_map(|block| block.1).collect())
}

fn each_row_once(answer: &Order, points: u64) -> Result<(), OrderViolation> {
    let mut seen = vec![false; points as usize];
    for (place, &row) in (0..).zip(&answer.rows) {
        let is_new = seen.get_mut(row as usize).is_some_and(|seen| !std::mem::replace(seen, true));
        if !is_new {
            return Err(OrderViolation::Row { place, row, points });
        }
    }
    match seen.iter().position(|seen| !seen) {
        None => Ok(()),
        Some(row) => {
            let (place, row) = (answer.rows.len() as u64, row as u64);
            Err(OrderViolation::Row { place, row, points })
        }
    }
}

/// A grid over a box, with the same scale on all axes.
struct Grid {
    low: Vec<f64>,
    half: f64,
    lift: f64,
    scale: f64,
    bits: u32,
}

impl Grid {
    /// None where all points are equal.
    fn over<'a>(points: impl Iterator<Item = &'a [f64]> + Clone, dim: usize) -> Option<Self> {
        let (mut low, mut high) = (vec![f64::INFINITY; dim], vec![f64::NEG_INFINITY; dim]);
        for point in points {
            for i in 0..dim {
                low[i] = low[i].min(point[i]);
                high[i] = high[i].max(point[i]);
            }
        }
        let widest =
            |part: f64| low.iter().zip(&high).map(|(l, h)| h * part - l * part).fold(0.0, f64::max);
        // Extents may overflow; half of them do not.
        let half = if widest(1.0) < f64::INFINITY { 1.0 } else { 0.5 };
        let extent = widest(half);
        // No point at all, or one place.
        if extent <= 0.0 {
            return None;
        }
        let lift = if extent < 1e-290 { 2f64.powi(600) } else { 1.0 };
        let bits = if dim == 2 { 16 } else { 10 };
        let scale = f64::from(1u32 << bits) / (extent * lift);
        Some(Self { low: low.iter().map(|l| l * half).collect(), half, lift, scale, bits })
    }

    /// The place on the curve of the cell of a point.
    fn key(&self, curve: super::OrderCurve, point: &[f64]) -> u64 {
        let last = (1u32 << self.bits) - 1;
        let mut cell = [0; 3];
        for ((c, x), low) in cell.iter_mut().zip(point).zip(&self.low) {
            *c = (((x * self.half - low) * self.lift * self.scale) as u32).min(last);
        }
        cell::place(curve, &cell[..point.len()], self.bits)
    }
}
