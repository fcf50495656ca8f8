//! The hull of all tiles: one convex polygon or surface, winding once around the points.
//!
//! *Idea.* The proofs are those of `polygon` and `polyhedron`, from ridge to ridge: each looks at the two facets at one ridge
//! alone, a vertex of a polygon or an edge of a surface. So facets are sorted by their ridges, and no list of the hull is in
//! memory.
//! *Polygon.* Each vertex is the end of one edge and the beginning of one other, it is no dent, and one vertex in all is a
//! local minimum in lexicographic order. The edges form cycles; each cycle has such a minimum, so there is one cycle, and it
//! turns round once.
//! *Surface.* Conditions 1 to 4 of `polyhedron`. At an edge from the smallest point v to x the third vertices of its two
//! triangles come before and after x in a cycle around v, so the local minima of all cycles around v are counted from edges.
//! Each cycle has one, as no two neighbors in it lie in one direction from v: they are a facet of a simplex that is not flat.
//! So one minimum in all means one cycle that winds once.
//! *Trap.* Rows stand for places here, which the coverage proves: each row has one place, and no two sites are equal.

use std::cmp::Ordering;
use std::path::Path;

use super::super::geometry::{Geometry, Tetrahedra, Triangles};
use super::super::polygon::turns_back;
use super::super::polyhedron::{is_before, is_dent};
use super::super::signs::{Signs, lexicographic};
use super::sort::Sorter;
use super::{TilesError, TilesViolation};

/// Takes the facets of the hull.
pub(super) trait Hull<const D: usize, const V: usize, const F: usize> {
    /// The first simplex of all.
    fn begin(&mut self, simplex: &[[f64; D]; V]);

    /// A facet, positively oriented from outside.
    fn add(&mut self, rows: [u64; F], points: [[f64; D]; F]) -> Result<(), TilesError>;

    /// Proves that the facets are the hull.
    fn check(self) -> Result<(), TilesError>;
}

/// The ends of a chain, or a single point.
pub(super) struct Ends {
    count: u64,
    expected: u64,
}

impl Ends {
    pub(super) fn new(expected: u64) -> Self {
        Ends { count: 0, expected }
    }
}

impl<const D: usize, const V: usize, const F: usize> Hull<D, V, F> for Ends {
    fn begin(&mut self, _: &[[f64; D]; V]) {}

    fn add(&mut self, rows: [u64; F], _: [[f64; D]; F]) -> Result<(), TilesError> {
        self.count += 1;
        match self.count > self.expected {
            true => {
                Err(TilesViolation::HullOpen { row: rows.first().copied().unwrap_or(0) }.into())
            }
            false => Ok(()),
        }
    }

    fn check(self) -> Result<(), TilesError> {
        match self.count == self.expected {
            true => Ok(()),
            false => Err(TilesViolation::HullOpen { row: 0 }.into()),
        }
    }
}

fn bits<const D: usize>(to: &mut [u64], p: &[f64; D]) {
    for (word, x) in to.iter_mut().zip(p) {
        *word = x.to_bits();
    }
}

fn of_bits<const D: usize>(words: &[u64]) -> [f64; D] {
    std::array::from_fn(|k| f64::from_bits(words[k]))
}

/// The edges around a polygon, as records of `W` = 3 + 2D words.
pub(super) struct Polygon<const D: usize, const W: usize> {
    signs: Signs,
    corners: Sorter<W>,
}

impl<const D: usize, const W: usize> Polygon<D, W> {
    pub(super) fn new(signs: Signs, folder: &Path, memory: u64) -> Self {
        debug_assert_eq!(W, 3 + 2 * D);
        Polygon { signs, corners: Sorter::new(folder, memory) }
    }

    /// Adds one end of an edge: (row of the vertex, 0 where the edge leaves it, row of the other end).
    fn corner(
        &mut self,
        [at, direction, other]: [u64; 3],
        [p, q]: [[f64; D]; 2],
    ) -> Result<(), TilesError> {
        let mut record = [0; W];
        record[..3].copy_from_slice(&[at, direction, other]);
        bits(&mut record[3..], &p);
        bits(&mut record[3 + D..], &q);
        self.corners.push(record)
    }
}

impl<const D: usize, const W: usize> Hull<D, 3, 2> for Polygon<D, W>
where
    Triangles: Geometry<D, 3>,
{
    fn begin(&mut self, _: &[[f64; D]; 3]) {}

    fn add(&mut self, [a, b]: [u64; 2], [p, q]: [[f64; D]; 2]) -> Result<(), TilesError> {
        self.corner([a, 0, b], [p, q])?;
        self.corner([b, 1, a], [q, p])
    }

    fn check(self) -> Result<(), TilesError> {
        let mut corners = self.corners.sorted()?;
        let (mut minima, mut last) = (0u64, 0);
        while let Some(out) = corners.next()? {
            let row = out[0];
            last = row;
            let back = corners.next_if(|next| next[0] == row)?;
            let open = TilesError::from(TilesViolation::HullOpen { row });
            let Some(back) = back.filter(|back| out[1] == 0 && back[1] == 1) else {
                return Err(open);
            };
            if corners.next_if(|next| next[0] == row)?.is_some() {
                return Err(open);
            }
            let (at, after): ([f64; D], [f64; D]) = (of_bits(&out[3..]), of_bits(&out[3 + D..]));
            let before: [f64; D] = of_bits(&back[3 + D..]);
            if turns_back(&self.signs, &[before, at, after]) {
                return Err(TilesViolation::HullDent { row, beyond: out[2] }.into());
            }
            let is_minimum =
                lexicographic(&at, &before).is_lt() && lexicographic(&at, &after).is_lt();
            minima += u64::from(is_minimum);
        }
        match minima {
            1 => Ok(()),
            _ => Err(TilesViolation::HullWinding { row: last }.into()),
        }
    }
}

/// Words of an edge of a triangle: the rows of its ends, ascending, whether the triangle runs along it the other way, the
/// row of the third vertex, and their coordinates.
const RIDGE_WORDS: usize = 4 + 9;

/// The triangles of a surface in space.
pub(super) struct Surface {
    signs: Signs,
    ridges: Sorter<RIDGE_WORDS>,
    /// The smallest point.
    smallest: (u64, [f64; 3]),
    /// The vertices of the first tetrahedron.
    first: Vec<[f64; 3]>,
}

impl Surface {
    pub(super) fn new(signs: Signs, smallest: (u64, [f64; 3]), folder: &Path, memory: u64) -> Self {
        Surface { signs, ridges: Sorter::new(folder, memory), smallest, first: vec![] }
    }
}

impl Hull<3, 4, 3> for Surface {
    fn begin(&mut self, simplex: &[[f64; 3]; 4]) {
        self.first = simplex.to_vec();
    }

    fn add(&mut self, rows: [u64; 3], [a, b, c]: [[f64; 3]; 3]) -> Result<(), TilesError> {
        for inner in self.first.iter().chain([&self.smallest.1]) {
            if self.signs.orientation::<Tetrahedra, 3, 4>(&[a, b, c, *inner]) == Ordering::Greater {
                return Err(TilesViolation::HullWinding { row: rows[0] }.into());
            }
        }
        let points = [a, b, c];
        for k in 0..3 {
            let (i, j, third) = (k, (k + 1) % 3, (k + 2) % 3);
            let is_turned = rows[i] > rows[j];
            let (low, high) = if is_turned { (j, i) } else { (i, j) };
            let mut record = [0; RIDGE_WORDS];
            record[..4].copy_from_slice(&[
                rows[low],
                rows[high],
                u64::from(is_turned),
                rows[third],
            ]);
            for (place, point) in [low, high, third].into_iter().enumerate() {
                bits(&mut record[4 + 3 * place..], &points[point]);
            }
            self.ridges.push(record)?;
        }
        Ok(())
    }

    fn check(self) -> Result<(), TilesError> {
        let (v, apex) = self.smallest;
        let mut ridges = self.ridges.sorted()?;
        let mut minima = 0u64;
        while let Some(ridge) = ridges.next()? {
            let is_same = |other: &[u64; RIDGE_WORDS]| other[..2] == ridge[..2];
            let other = ridges.next_if(is_same)?;
            let open = TilesError::from(TilesViolation::HullOpen { row: ridge[0] });
            let Some(other) = other.filter(|other| ridge[2] == 0 && other[2] == 1) else {
                return Err(open);
            };
            if ridges.next_if(is_same)?.is_some() {
                return Err(open);
            }
            let [a, b, c] = [0, 1, 2].map(|k| of_bits::<3>(&ridge[4 + 3 * k..]));
            let d = of_bits::<3>(&other[4 + 6..]);
            if is_dent(&self.signs, &[a, b, c, d]) {
                return Err(TilesViolation::HullDent { row: ridge[0], beyond: other[3] }.into());
            }
            if ridge[..2].contains(&v) {
                let x = if ridge[0] == v { b } else { a };
                let is_first = |y: &[f64; 3]| is_before(&self.signs, &apex, &x, y);
                minima += u64::from(is_first(&c) && is_first(&d));
            }
        }
        match minima {
            1 => Ok(()),
            _ => Err(TilesViolation::HullWinding { row: v }.into()),
        }
    }
}
