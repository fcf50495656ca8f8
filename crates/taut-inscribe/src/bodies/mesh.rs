//! A triangle mesh that is closed, if need be by caps, with corners on a grid.

use std::collections::{HashMap, HashSet};

use taut_points::{InputError, Monitor, PointSource, PointsHash, hash_block, map_blocks};

use super::caps;
use crate::Error;

/// The longest side has from 2²³ to 2²⁴ units of the grid.
const SIDE_BITS: i32 = 24;

/// Units for which neither they nor their cubes leave the range of normal numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -300..=310;

/// Coordinates in units are below this: farther from the origin a mesh has no digits left.
const UNITS_MAX: f64 = (1u64 << 60) as f64;

/// Units from the origin of the grid to a point beside the mesh, at most: a certificate allows coordinates up to 2³⁰.
const POINT_UNITS_MAX: f64 = (1u64 << 29) as f64;

/// Most triangles, so that rows have 32-bit numbers.
const TRIANGLES_MAX: u64 = u32::MAX as u64 / 4;

/// The part of the view from an inner point that caps may fill. From near a flat cap it is a half; from the middle of half a ball it
/// is 0.3, and a third is reached in bowls that are flatter.
const CAPS_VIEW_MAX: f64 = 1.0 / 3.0;

/// The corners of a triangle, as given.
type Triangle = [[f64; 3]; 3];

/// A closed mesh on the grid: corner y stands for (`origin` + y)·2^`exponent`.
pub(super) struct GridMesh {
    pub(super) exponent: i32,
    pub(super) origin: [i64; 3],
    /// The corners of each row and then of each cap, rounded to the nearest point of the grid. Coordinates are from 0 to 2²⁴ + 1; rows
    /// that are points beyond the bounding box of the triangles are moved to at most 2 units from it.
    pub(super) corners: Vec<[[i32; 3]; 3]>,
    /// The triangles that close the mesh: corner c of row r is number 3·r + c.
    pub(super) caps: Vec<[u64; 3]>,
    /// Whether all coordinates are on the grid.
    pub(super) is_exact: bool,
    /// How many rows are points.
    pub(super) points: u64,
    pub(super) points_hash: PointsHash,
}

impl GridMesh {
    /// Reads the rows and closes holes, if this is asked for. Refuses other meshes that are not closed, and those that do not fit
    /// the grid.
    pub(super) fn read(
        source: &dyn PointSource,
        close_holes: bool,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        if source.dim() != 9 {
            let (dim, expected) = (source.dim(), "9, those of the three corners of a triangle");
            return Err(InputError::Dimension { dim, expected }.into());
        }
        let points = source.len();
        if points > TRIANGLES_MAX {
            return Err(InputError::TooManyPoints { points, most: TRIANGLES_MAX }.into());
        }
        let (mut triangles, points_hash) = rows(source, monitor)?;
        let caps = match is_closed(&triangles) {
            true => vec![],
            false => Boundary::of(&triangles).close(close_holes, &triangles, monitor)?,
        };
        let all = triangles.as_flattened();
        let closing: Vec<Triangle> =
            caps.iter().map(|cap| cap.map(|corner| all[corner as usize])).collect();
        triangles.extend(closing);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut points = 0;
        for triangle in &triangles {
            if is_point(triangle) {
                points += 1;
                continue;
            }
            for corner in triangle {
                for c in 0..3 {
                    (low[c], high[c]) = (low[c].min(corner[c]), high[c].max(corner[c]));
                }
            }
        }
        let side = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
        if side == 0.0 {
            return Err(Error::NoInside);
        }
        let exponent = exponent_of(side) - (SIDE_BITS - 1);
        if !EXPONENTS.contains(&exponent) {
            return Err(Error::Grid { side });
        }
        let per_unit = 2f64.powi(-exponent);
        if low.iter().chain(&high).any(|x| (x * per_unit).abs() >= UNITS_MAX) {
            return Err(Error::Grid { side });
        }
        let origin = low.map(|x| (x * per_unit).floor() as i64);
        // Beyond the bounding box a point meets no body, wherever it is.
        let [least, most] = [low, high].map(|corner| corner.map(|x| x * per_unit));
        let mut is_exact = true;
        let mut corners = Vec::with_capacity(triangles.len());
        for (row, triangle) in triangles.iter().enumerate() {
            let units = triangle.map(|corner| corner.map(|x| x * per_unit));
            for (x, units) in triangle.as_flattened().iter().zip(units.as_flattened()) {
                is_exact &= *units == units.round() && units / per_unit == *x;
            }
            let off = |c: usize| units[0][c] - origin[c] as f64;
            if is_point(triangle) && (0..3).any(|c| off(c).abs() > POINT_UNITS_MAX) {
                return Err(Error::FarPoint { row: row as u64 });
            }
            corners.push(units.map(|corner| {
                [0, 1, 2].map(|c| {
                    let near = corner[c].clamp(least[c].floor() - 2.0, most[c].ceil() + 2.0);
                    (near.round() as i64 - origin[c]) as i32
                })
            }));
        }
        Ok(GridMesh { exponent, origin, corners, caps, is_exact, points, points_hash })
    }

    /// Whether the mesh without its caps makes a point an inner one: caps fill less than a third of the view from there.
    pub(super) fn sees_mesh(&self, p: [i32; 3]) -> bool {
        let rows = self.corners.len() - self.caps.len();
        let filled: f64 = self.corners[rows..].iter().map(|cap| caps::solid_angle(cap, p)).sum();
        filled < CAPS_VIEW_MAX * 4.0 * std::f64::consts::PI
    }

    /// The place of a point on the grid, rounded; `None` beyond the bounding box of the mesh, or for what is no number.
    pub(super) fn place(&self, point: [f64; 3]) -> Option<[i32; 3]> {
        let per_unit = 2f64.powi(-self.exponent);
        let place = [0, 1, 2].map(|c| (point[c] * per_unit).round() - self.origin[c] as f64);
        let most = f64::from(1 << SIDE_BITS);
        place.iter().all(|x| (0.0..=most).contains(x)).then(|| place.map(|x| x as i32))
    }
}

/// Whether a row is a point that bodies do not contain: a triangle with three equal corners.
pub(super) fn is_point([a, b, c]: &Triangle) -> bool {
    a == b && b == c
}

/// The exponent e of a positive number with 2^e ≤ x < 2^(e + 1); less for subnormal numbers, more for what is not finite.
fn exponent_of(x: f64) -> i32 {
    (x.to_bits() >> 52) as i32 - 1023
}

/// All rows, which must be finite, and their hash.
fn rows(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Vec<Triangle>, PointsHash), Error> {
    monitor.pass(1, source.len());
    let blocks = map_blocks(source, monitor, |first, rows| {
        if let Some((row, column, value)) = rows.first_non_finite() {
            let row = first + row as u64;
            return Err(Error::Input(InputError::NonFinite { row, column, value }));
        }
        let mut row = [0.0; 9];
        let triangles = (0..rows.len()).map(|k| {
            rows.copy_row(k, &mut row);
            [[row[0], row[1], row[2]], [row[3], row[4], row[5]], [row[6], row[7], row[8]]]
        });
        Ok((hash_block(&rows), triangles.collect::<Vec<_>>()))
    })?;
    let hashes = blocks.iter().map(|block| block.0);
    let hash = PointsHash::of_blocks(source.len(), source.dim(), hashes);
    Ok((blocks.into_iter().flat_map(|block| block.1).collect(), hash))
}

/// Whether each edge belongs to an even number of triangles. Faster than to sort the edges, which an open mesh needs.
pub(super) fn is_closed(triangles: &[Triangle]) -> bool {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::with_capacity(triangles.len());
    let mut odd: HashSet<[u32; 2]> = HashSet::with_capacity(triangles.len());
    for triangle in triangles {
        // −0 and 0 are one number.
        let [a, b, c] = triangle.map(|corner| {
            let next = numbers.len() as u32;
            *numbers.entry(corner.map(|x| (x + 0.0).to_bits())).or_insert(next)
        });
        for ends in [[a, b], [b, c], [c, a]] {
            let edge = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            if ends[0] != ends[1] && !odd.remove(&edge) {
                odd.insert(edge);
            }
        }
    }
    odd.is_empty()
}

/// The edges of a mesh that belong to an odd number of triangles.
struct Boundary {
    /// The vertex of each corner: those with equal coordinates are one.
    vertex: Vec<u32>,
    /// The ends of each such edge, and a triangle with it.
    edges: Vec<([u32; 2], u32)>,
}

impl Boundary {
    fn of(triangles: &[Triangle]) -> Self {
        let mut corners: Vec<(usize, [f64; 3])> =
            triangles.as_flattened().iter().copied().enumerate().collect();
        // Equal numbers compare as equal here, 0 and −0 among them; none is NaN.
        let order =
            |a: &[f64; 3], b: &[f64; 3]| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal);
        corners.sort_by(|a, b| order(&a.1, &b.1));
        let mut vertex = vec![0u32; corners.len()];
        for (number, same) in corners.chunk_by(|a, b| a.1 == b.1).enumerate() {
            same.iter().for_each(|&(corner, _)| vertex[corner] = number as u32);
        }
        let mut edges: Vec<([u32; 2], u32)> = vec![];
        for (row, triangle) in vertex.as_chunks::<3>().0.iter().enumerate() {
            let [a, b, c] = *triangle;
            let sides = [[a, b], [b, c], [c, a]].into_iter().filter(|[from, to]| from != to);
            edges.extend(sides.map(|[from, to]| ([from.min(to), from.max(to)], row as u32)));
        }
        edges.sort_unstable();
        let same = edges.chunk_by(|one, other| one.0 == other.0);
        let edges = same.filter(|same| same.len() % 2 == 1).map(|same| same[0]).collect();
        Boundary { vertex, edges }
    }

    /// Triangles that close the mesh, or the error of an open mesh.
    fn close(
        &self,
        is_wanted: bool,
        triangles: &[Triangle],
        monitor: &Monitor<'_>,
    ) -> Result<Vec<[u64; 3]>, Error> {
        match self.open_edge(triangles) {
            Some(error) if !is_wanted => Err(error),
            Some(_) => self.caps(triangles, monitor),
            None => Ok(vec![]),
        }
    }

    /// The error of an open mesh.
    fn open_edge(&self, triangles: &[Triangle]) -> Option<Error> {
        let &(ends, row) = self.edges.first()?;
        let place = |number: u32| {
            let corner = (0..3).find(|&corner| self.vertex[3 * row as usize + corner] == number);
            triangles[row as usize][corner.unwrap_or(0)]
        };
        let [from, to] = ends.map(place);
        Some(Error::Open { edges: self.edges.len() as u64, row: row.into(), from, to })
    }

    /// Triangles that close the mesh, by the numbers of corners.
    fn caps(&self, triangles: &[Triangle], monitor: &Monitor<'_>) -> Result<Vec<[u64; 3]>, Error> {
        let vertices = self.vertex.iter().max().map_or(0, |&last| last as usize + 1);
        // Of each vertex the first corner.
        let mut corner = vec![0usize; vertices];
        for (at, &vertex) in self.vertex.iter().enumerate().rev() {
            corner[vertex as usize] = at;
        }
        let edges: Vec<[u32; 2]> = self.edges.iter().map(|edge| edge.0).collect();
        let place = |vertex: u32| triangles.as_flattened()[corner[vertex as usize]];
        let caps = caps::caps(&edges, &place, monitor)?;
        Ok(caps.into_iter().map(|cap| cap.map(|vertex| corner[vertex as usize] as u64)).collect())
    }
}
