//! The place of every row next to it on the curves, and how far off it is.
//!
//! *Distance.* The projection of a row on an edge is found in `f64`; any number t in [0, 1] names a point of the edge, so the distance
//! to it, with all its roundings added, is no less than that of the curve. A vector p − a is right to u of its size, and
//! w = (p − a) − t·(b − a) to 4u of |p − a| and |b − a|.
//! *Trap.* Beside a vertex of 1e308 coordinates of 1e-150 underflow when all are scaled alike: what scaling takes is added.

use std::collections::HashMap;

use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, Monitor, ReadError};

use super::super::{Curve, CurveCertificate, CurveComponent, CurveViolation};
use super::edges::Edges;
use crate::CheckError;
use crate::arithmetic::U;

/// A thread takes this many rows at once.
const ROWS_PER_TASK: usize = 1 << 12;

/// A row next to the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) row: usize,
    pub(super) edge: usize,
    /// The share of the edge before it.
    pub(super) t: f64,
    /// Distance from the curve, rounded up, in scaled units; more than 0 on the left.
    pub(super) offset: f64,
}

/// All rows.
pub(super) struct Placed {
    /// Distinct rows that are no outliers, ascending.
    pub(super) inliers: Vec<Foot>,
    /// Distinct outliers, in scaled units.
    pub(super) outliers: Vec<(usize, [f64; 2])>,
    /// The largest distance of an inlier, rounded up, in units of the input.
    pub(super) band: f64,
    /// Whether vertices are rows, so that inliers are vertices.
    pub(super) is_exact: bool,
}

pub(super) fn place(
    curve: &Curve,
    certificate: &CurveCertificate,
    edges: &Edges,
    rows: &[[f64; 2]],
    monitor: &Monitor<'_>,
) -> Result<Placed, CheckError> {
    let mut is_outlier = vec![false; rows.len()];
    curve.outliers.iter().for_each(|&row| is_outlier[row as usize] = true);
    let (outliers, inliers): (Vec<usize>, Vec<usize>) =
        distinct(rows, &is_outlier).into_iter().partition(|&row| is_outlier[row]);
    let is_exact = curve.curves.first().is_some_and(|first| !first.rows.is_empty());
    let feet = match is_exact {
        true => at_vertices(edges, rows, &inliers)?,
        false => next_to(edges, rows, &inliers, monitor).map_err(ReadError::from)?,
    };
    let off = |projection: &Foot| edges.unscaled(projection.offset.abs());
    let is_within = |projection: &&Foot| off(projection) <= certificate.band;
    if let Some(projection) = feet.iter().find(|projection| !is_within(projection)) {
        let (row, distance) = (projection.row as u64, off(projection));
        return Err(CurveViolation::OutsideBand { row, distance, band: certificate.band }.into());
    }
    if !curve.places.is_empty() {
        places(curve, edges, rows, monitor)?;
    }
    Ok(Placed::of(edges, rows, feet, outliers, is_exact))
}

impl Placed {
    /// Places of distinct rows, of which some are outliers.
    pub(super) fn of(
        edges: &Edges,
        rows: &[[f64; 2]],
        inliers: Vec<Foot>,
        outliers: Vec<usize>,
        is_exact: bool,
    ) -> Self {
        let scaled = |row: usize| (row, rows[row].map(|x| x * edges.scale));
        let widest =
            inliers.iter().fold(0.0f64, |most, projection| most.max(projection.offset.abs()));
        let band = edges.unscaled(widest);
        let outliers = outliers.into_iter().map(scaled).collect();
        Self { inliers, outliers, band, is_exact }
    }
}

/// The vertices of closed curves as places of the rows that they are.
pub(super) fn of_vertices(curves: &[CurveComponent]) -> Vec<Foot> {
    let rows = curves.iter().flat_map(|one| &one.rows);
    rows.enumerate()
        .map(|(edge, &row)| Foot { row: row as usize, edge, t: 0.0, offset: 0.0 })
        .collect()
}

/// The rows but those that equal one before them, ascending; outliers equal outliers alone.
fn distinct(rows: &[[f64; 2]], is_outlier: &[bool]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    // −0 equals 0.
    let key = |row: usize| [rows[row][0] + 0.0, rows[row][1] + 0.0];
    order.par_sort_unstable_by(|&i, &j| {
        let ([a, b], [c, d]) = (key(i), key(j));
        let by_place = a.total_cmp(&c).then(b.total_cmp(&d));
        by_place.then(is_outlier[i].cmp(&is_outlier[j])).then(i.cmp(&j))
    });
    order.dedup_by_key(|row| (key(*row).map(f64::to_bits), is_outlier[*row]));
    order.par_sort_unstable();
    order
}

/// Rows at the vertices that they are, or are equal to.
fn at_vertices(
    edges: &Edges,
    rows: &[[f64; 2]],
    inliers: &[usize],
) -> Result<Vec<Foot>, CurveViolation> {
    // −0 equals 0, but is another pattern of bits.
    let key = |p: [f64; 2]| p.map(|x| (x + 0.0).to_bits());
    let mut vertices = HashMap::with_capacity(edges.exact.len());
    for (vertex, &place) in edges.exact.iter().enumerate() {
        if let Some(before) = vertices.insert(key(place), vertex) {
            let name = |vertex: usize| {
                let curve = edges.first_vertex.partition_point(|&first| first <= vertex) - 1;
                (curve, vertex - edges.first_vertex[curve])
            };
            let ((curve, vertex), (other, other_vertex)) = (name(vertex), name(before));
            return Err(CurveViolation::Repeated { curve, vertex, other, other_vertex });
        }
    }
    let projection = |&row: &usize| {
        let found = vertices.get(&key(rows[row])).copied();
        let vertex = found.ok_or(CurveViolation::NoVertex { row: row as u64 })?;
        let curve = edges.first_vertex.partition_point(|&first| first <= vertex) - 1;
        let edge = edges.first_edge[curve] + (vertex - edges.first_vertex[curve]);
        // The last vertex of an open curve is at the end of an edge.
        Ok(match edge < edges.first_edge[curve + 1] {
            true => Foot { row, edge, t: 0.0, offset: 0.0 },
            false => Foot { row, edge: edge - 1, t: 1.0, offset: 0.0 },
        })
    };
    inliers.iter().map(projection).collect()
}

/// Rows next to the edges. A row that no edge is near, as far as squares go, is infinitely far from the first.
pub(super) fn next_to(
    edges: &Edges,
    rows: &[[f64; 2]],
    inliers: &[usize],
    monitor: &Monitor<'_>,
) -> Result<Vec<Foot>, Cancelled> {
    let projection = |&row: &usize| {
        let p = rows[row].map(|x| x * edges.scale);
        match nearest(edges, p, f64::INFINITY) {
            Some((edge, t)) => {
                let offset = distance(edges, p, edge, t) * side(edges, p, edge);
                Foot { row, edge, t, offset }
            }
            None => Foot { row, edge: 0, t: 0.0, offset: f64::INFINITY },
        }
    };
    let of_task = |task: &[usize]| -> Result<Vec<Foot>, Cancelled> {
        monitor.check()?;
        Ok(task.iter().map(projection).collect())
    };
    let tasks = inliers.par_chunks(ROWS_PER_TASK);
    let feet: Vec<Vec<Foot>> = tasks.map(of_task).collect::<Result<_, _>>()?;
    Ok(feet.into_iter().flatten().collect())
}

/// The edge next to p, if one is nearer than `most`, and the share of it before the projection.
pub(super) fn nearest(edges: &Edges, p: [f64; 2], most: f64) -> Option<(usize, f64)> {
    let (mut best, mut found) = (most * most, None);
    edges.tree.least(
        &mut best,
        |area, _| area.distance_squared(p),
        |edge, best| {
            let t = projection(edges, p, edge);
            let [x, y] = beside(edges, p, edge, t);
            let squared = x * x + y * y;
            if squared < *best {
                (*best, found) = (squared, Some((edge, t)));
            }
        },
    );
    found
}

/// The share of an edge before the projection of p.
fn projection(edges: &Edges, p: [f64; 2], edge: usize) -> f64 {
    let [a, b] = edges.segment(edge);
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    // An edge of one vertex gives NaN.
    if t > 0.0 { t.min(1.0) } else { 0.0 }
}

/// p less the point of an edge.
#[inline(always)]
fn beside(edges: &Edges, p: [f64; 2], edge: usize, t: f64) -> [f64; 2] {
    let [a, b] = edges.segment(edge);
    match t {
        1.0 => [p[0] - b[0], p[1] - b[1]],
        _ => {
            let along = |k: usize| (p[k] - a[k]) - t * (b[k] - a[k]);
            [along(0), along(1)]
        }
    }
}

/// The distance from the point of an edge, rounded up.
fn distance(edges: &Edges, p: [f64; 2], edge: usize, t: f64) -> f64 {
    let [x, y] = beside(edges, p, edge, t);
    let [a, b] = edges.segment(edge);
    let sizes: f64 = match t {
        0.0 | 1.0 => x.abs() + y.abs(),
        _ => (0..2).map(|k| (p[k] - a[k]).abs() + (b[k] - a[k]).abs()).sum(),
    };
    match x == 0.0 && y == 0.0 && (t == 0.0 || t == 1.0) {
        // Each of the two is off by what was lost of two coordinates.
        true => 4.0 * edges.lost,
        // Each operation on numbers near the least may lose half of it besides.
        false => {
            let lost = 8.0 * (edges.lost + f64::from_bits(1));
            x.hypot(y) * (1.0 + 8.0 * U) + 8.0 * U * sizes + lost
        }
    }
}

/// 1 on the left of an edge, −1 on the right.
fn side(edges: &Edges, p: [f64; 2], edge: usize) -> f64 {
    let [a, b] = edges.segment(edge);
    let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    if turn < 0.0 { -1.0 } else { 1.0 }
}

/// Distances below this have squares that underflow, in scaled units: beside a vertex of 1e300 nothing tells which of two
/// edges is the nearer one when both are 1e140 off.
const SQUARES_LEAST: f64 = f64::from_bits((1023 - 530) << 52);

/// Whether places named are next to their rows, as far as rounding of the coordinates of row and edges tells.
fn places(
    curve: &Curve,
    edges: &Edges,
    rows: &[[f64; 2]],
    monitor: &Monitor<'_>,
) -> Result<(), CheckError> {
    let largest =
        |points: &[[f64; 2]]| points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let pairs: Vec<usize> = (0..rows.len()).collect();
    pairs.par_chunks(ROWS_PER_TASK).try_for_each(|block| {
        monitor.check().map_err(ReadError::from)?;
        block.iter().try_for_each(|&row| {
            let (p, place) = (rows[row].map(|x| x * edges.scale), curve.places[row]);
            let of = place.0 as usize;
            let (first, count) =
                (edges.first_edge[of], edges.first_edge[of + 1] - edges.first_edge[of]);
            let edge = (place.1 as usize).min(count - 1);
            let claimed =
                distance(edges, p, first + edge, place.1.fract().max(place.1 - edge as f64));
            // Only squares beyond the largest number leave no edge: the row is then 1e150 off, vertices are at most about
            // 1e100 apart in scaled units, and every place is as near as any but for rounding.
            let Some((near, t)) = nearest(edges, p, f64::INFINITY) else { return Ok(()) };
            let next = distance(edges, p, near, t);
            let [a, b] = edges.segment(first + edge);
            let [c, d] = edges.segment(near);
            let size = 2.0 * largest(&[p, a, b, c, d]) + next + f64::MIN_POSITIVE;
            let size = size + SQUARES_LEAST / (64.0 * U);
            // The sum of a vertex' number and a share has fewer digits than the share.
            let moved = place.1 * (b[0] - a[0]).hypot(b[1] - a[1]);
            match claimed <= next * (1.0 + 1e-9) + 64.0 * U * size + 4.0 * U * moved {
                true => Ok(()),
                false => {
                    let (distance, nearest) = (claimed / edges.scale, next / edges.scale);
                    Err(CurveViolation::FarPlace { row: row as u64, distance, nearest })
                }
            }
        })?;
        Ok(())
    })
}
