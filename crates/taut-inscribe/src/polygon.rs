//! The rings of a polygon: its edges without those of no length, and the rows that they come from.
//!
//! Rows (x, y) are one ring. Rows (x, y, r) are rings, r being the number of the ring: 0 in the first row, and in each other
//! row that of the row before or one more. The last row of a ring may repeat its first, and a row the one before it.

use taut_points::{InputError, Monitor, PointSource, PointsHash, hash_block, map_blocks};
use taut_predicates::plane::orient;

use crate::Error;
use crate::runs::Runs;
use crate::simple;

/// Most rows of a polygon, so that edges have 32-bit numbers.
const ROWS_MAX: u64 = u32::MAX as u64;

/// The two ends of an edge.
pub(crate) type Segment = [[f64; 2]; 2];

/// The edges of rings that neither meet nor touch each other or themselves.
pub(crate) struct Polygon {
    /// The edges with coordinates as given, ring by ring, each from a vertex to the next.
    pub(crate) edges: Vec<Segment>,
    /// The row at which each edge begins: of equal rows that follow each other, the last.
    pub(crate) rows: Vec<u64>,
    pub(crate) points_hash: PointsHash,
    /// Boxes around runs of the edges.
    pub(crate) runs: Runs,
}

impl Polygon {
    /// Reads the rows and refuses rings that meet.
    pub(crate) fn read(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<Self, Error> {
        if !(2..=3).contains(&source.dim()) {
            let (dim, expected) =
                (source.dim(), "2, as vertices have, or 3: x, y and the number of the ring");
            return Err(InputError::Dimension { dim, expected }.into());
        }
        let points = source.len();
        if points > ROWS_MAX {
            return Err(InputError::TooManyPoints { points, most: ROWS_MAX }.into());
        }
        let (all, points_hash) = rows(source, monitor)?;
        let mut loops = Loops::default();
        let (mut rows, mut ends) = (vec![], vec![]);
        for (number, ring) in rings(&all)?.into_iter().enumerate() {
            let after = |row: usize| if row + 1 == ring.end { ring.start } else { row + 1 };
            let vertex = |row: usize| [all[row][0], all[row][1]];
            let kept: Vec<usize> =
                ring.clone().filter(|&row| vertex(row) != vertex(after(row))).collect();
            if kept.len() < 3 {
                // Two vertices there and back have two edges; a single point has none.
                let distinct = kept.len().max(ring.len().min(1));
                return Err(Error::TooFewVertices { ring: number, distinct });
            }
            loops.push(&kept.iter().map(|&row| vertex(row)).collect::<Vec<_>>());
            rows.extend(kept.iter().map(|&row| row as u64));
            ends.extend(kept.iter().map(|&row| after(row) as u64));
        }
        let runs = Runs::of(&loops.segments);
        if let Some(edges) = simple::crossing(&loops, &runs, monitor)? {
            let [edge, other] = edges.map(|edge| [rows[edge], ends[edge]]);
            return Err(Error::NotSimple { edge, other });
        }
        Ok(Polygon { edges: loops.segments, rows, points_hash, runs })
    }
}

/// Closed chains of edges.
#[derive(Default)]
pub(crate) struct Loops {
    pub(crate) segments: Vec<Segment>,
    /// The edge that begins where an edge ends.
    pub(crate) after: Vec<u32>,
}

impl Loops {
    /// One ring.
    #[cfg(test)]
    pub(crate) fn of_ring(ring: &[[f64; 2]]) -> Self {
        let mut loops = Loops::default();
        loops.push(ring);
        loops
    }

    /// Adds a ring by its vertices, of which no two that follow each other are equal.
    pub(crate) fn push(&mut self, ring: &[[f64; 2]]) {
        let first = self.segments.len();
        for (i, &vertex) in ring.iter().enumerate() {
            let next = if i + 1 == ring.len() { 0 } else { i + 1 };
            self.segments.push([vertex, ring[next]]);
            self.after.push((first + next) as u32);
        }
    }
}

/// Whether an odd number of edges cross the horizontal line through p to the left of it.
pub(crate) fn is_inside(edges: impl Iterator<Item = Segment>, p: [f64; 2]) -> bool {
    let is_left = |[a, b]: &Segment| {
        if (a[1] <= p[1]) == (b[1] <= p[1]) {
            return false;
        }
        let (low, high) = if a[1] <= p[1] { (*a, *b) } else { (*b, *a) };
        !orient(low, high, p).is_positive()
    };
    edges.filter(is_left).count() % 2 == 1
}

/// Whether an area, and the upper bound that a gap makes of it, are so far from the ends of the range of numbers that a checker finds them
/// again by other products.
pub(crate) fn is_measurable(area: f64, gap: f64) -> bool {
    // Comparisons with NaN are false.
    area >= 1024.0 * f64::MIN_POSITIVE && area * (1.0 + gap) <= f64::MAX / 16.0
}

/// The rows of each ring; one ring without rows if there are none.
fn rings(all: &[[f64; 3]]) -> Result<Vec<std::ops::Range<usize>>, Error> {
    let (mut found, mut start, mut number) = (vec![], 0, 0.0);
    for (row, &[_, _, value]) in all.iter().enumerate() {
        if value == number {
            continue;
        }
        if row == 0 || value != number + 1.0 {
            return Err(Error::RingNumber { row: row as u64, value });
        }
        found.push(start..row);
        (start, number) = (row, value);
    }
    found.push(start..all.len());
    Ok(found)
}

/// All rows, which must be finite, and their hash; the third number is 0 where rows have two.
fn rows(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Vec<[f64; 3]>, PointsHash), Error> {
    monitor.pass(1, source.len());
    let blocks = map_blocks(source, monitor, |first, rows| {
        rows.check_finite(first)?;
        let mut point = [0.0; 3];
        let points = (0..rows.len()).map(|row| {
            rows.copy_row(row, &mut point[..source.dim()]);
            point
        });
        Ok::<_, Error>((hash_block(&rows), points.collect::<Vec<_>>()))
    })?;
    let hashes = blocks.iter().map(|block| block.0);
    let hash = PointsHash::of_blocks(source.len(), source.dim(), hashes);
    Ok((blocks.into_iter().flat_map(|block| block.1).collect(), hash))
}
