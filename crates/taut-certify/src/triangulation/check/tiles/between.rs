//! Facets whose two simplices are not at hand together: in two tiles, or far apart in one.
//!
//! *Idea.* Each side of such a facet is a record: the rows of the facet in ascending order, which way it faces, where it is,
//! what it says of its other side, and the coordinates of its simplex. Sorted by rows, the two sides come together.
//! *Proof.* Of a facet there are two sides that face opposite ways, each names the other as the format has it, and the vertex
//! beyond is not in conflict; or there is one side, and a later tile says that it lies on the hull.

use std::path::Path;

use super::super::signs::Conflict;
use super::sort::Sorter;
use super::{TilesError, TilesViolation};

/// What a simplex says of its other side across a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Across {
    /// It is in a later tile.
    LaterTile,
    /// It is this facet: tile << 32 | code.
    Link(u64),
    /// It is of this simplex of the same tile.
    Simplex(u32),
}

/// One side of a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<const D: usize, const V: usize> {
    pub(super) tile: u32,
    pub(super) simplex: u32,
    pub(super) facet: usize,
    /// The vertices of the simplex, as the input has them.
    pub(super) points: [[f64; D]; V],
    pub(super) rows: [u64; V],
    pub(super) across: Across,
}

impl<const D: usize, const V: usize> Side<D, V> {
    /// The place of the facet: tile << 32 | simplex << 2 | facet.
    fn place(&self) -> u64 {
        u64::from(self.tile) << 32 | u64::from(self.simplex) << 2 | self.facet as u64
    }

    /// The rows of the facet in ascending order, and whether an odd permutation has put them in order, counted from the
    /// order of the simplex with the vertex of the facet in front.
    fn key<const F: usize>(&self) -> ([u64; F], bool) {
        let mut key = [0; F];
        let mut others = (0..V).filter(|&i| i != self.facet);
        for row in &mut key {
            *row = others.next().map_or(0, |i| self.rows[i]);
        }
        let mut is_odd = self.facet % 2 == 1;
        for i in 1..F {
            for j in (1..=i).rev() {
                if key[j - 1] > key[j] {
                    key.swap(j - 1, j);
                    is_odd = !is_odd;
                }
            }
        }
        (key, is_odd)
    }

    fn record<const F: usize, const W: usize>(&self) -> [u64; W] {
        let (key, is_odd) = self.key::<F>();
        let (kind, other) = match self.across {
            Across::LaterTile => (0, 0),
            Across::Link(place) => (1, place),
            Across::Simplex(simplex) => (2, u64::from(simplex)),
        };
        let mut record = [0; W];
        record[..F].copy_from_slice(&key);
        record[F] = u64::from(is_odd) | kind << 1;
        record[F + 1] = self.place();
        record[F + 2] = other;
        record[F + 3..F + 3 + V].copy_from_slice(&self.rows);
        for (word, x) in record[F + 3 + V..].iter_mut().zip(self.points.as_flattened()) {
            *word = x.to_bits();
        }
        record
    }

    fn of_record<const F: usize, const W: usize>(record: &[u64; W]) -> Self {
        let (kind, place, other) = (record[F] >> 1, record[F + 1], record[F + 2]);
        let across = match kind {
            0 => Across::LaterTile,
            1 => Across::Link(other),
            _ => Across::Simplex(other as u32),
        };
        let mut points = [[0.0; D]; V];
        for (x, &word) in points.as_flattened_mut().iter_mut().zip(&record[F + 3 + V..]) {
            *x = f64::from_bits(word);
        }
        let rows = std::array::from_fn(|i| record[F + 3 + i]);
        let (tile, code) = ((place >> 32) as u32, place as u32);
        Side { tile, simplex: code >> 2, facet: code as usize & 3, points, rows, across }
    }

    fn neighbor(&self, problem: &'static str) -> TilesViolation {
        let (tile, simplex, facet) = (self.tile, u64::from(self.simplex), self.facet);
        TilesViolation::Neighbor { tile, simplex, facet, problem }
    }

    /// Tests whether this side names the other one.
    fn names(&self, other: &Self) -> bool {
        match (self.across, other.across) {
            (Across::Simplex(simplex), Across::Simplex(back)) => {
                self.tile == other.tile && simplex == other.simplex && back == self.simplex
            }
            (Across::Link(place), Across::LaterTile) => {
                self.tile != other.tile && place == other.place()
            }
            (Across::LaterTile, Across::Link(_)) => other.names(self),
            _ => false,
        }
    }
}

/// Sides of facets with `F` vertices, as records of `W` = F + 3 + V + V·D words.
pub(super) struct Between<const D: usize, const V: usize, const F: usize, const W: usize> {
    sides: Sorter<W>,
    /// Facets that a link puts on the hull.
    outside: Sorter<1>,
    unpaired: Sorter<1>,
    count: u64,
}

impl<const D: usize, const V: usize, const F: usize, const W: usize> Between<D, V, F, W> {
    pub(super) fn new(folder: &Path, memory: u64) -> Self {
        debug_assert_eq!(W, F + 3 + V + V * D);
        Between {
            sides: Sorter::new(folder, memory / 3 * 2),
            outside: Sorter::new(folder, memory / 6),
            unpaired: Sorter::new(folder, memory / 6),
            count: 0,
        }
    }

    /// The sides that were added.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    pub(super) fn add(&mut self, side: &Side<D, V>) -> Result<(), TilesError> {
        self.count += 1;
        self.sides.push(side.record::<F, W>())
    }

    /// Adds a facet that a link puts on the hull: tile << 32 | code.
    pub(super) fn add_outside(&mut self, place: u64) -> Result<(), TilesError> {
        self.outside.push([place])
    }

    /// Pairs all sides. `conflict` tells of a side and the vertex beyond whether they are in conflict, `open` takes the sides
    /// on the hull. Returns the number of ties.
    pub(super) fn check(
        self,
        conflict: impl Fn(&[[f64; D]; V], &[f64; D]) -> Conflict,
        mut open: impl FnMut(&Side<D, V>) -> Result<(), TilesError>,
        mut progress: impl FnMut(u64) -> Result<(), TilesError>,
    ) -> Result<u64, TilesError> {
        /// Sides between two reports of progress.
        const REPORT_SIDES: u64 = 1 << 16;
        let Between { sides, outside, mut unpaired, .. } = self;
        let mut sides = sides.sorted()?;
        let (mut ties, mut done) = (0, 0);
        while let Some(record) = sides.next()? {
            let side = Side::<D, V>::of_record::<F, W>(&record);
            let is_same = |other: &[u64; W]| other[..F] == record[..F];
            let Some(other) = sides.next_if(is_same)? else {
                if side.across != Across::LaterTile {
                    let problem = "the simplex that it names does not have this facet";
                    return Err(side.neighbor(problem).into());
                }
                unpaired.push([side.place()])?;
                open(&side)?;
                continue;
            };
            let is_one_sided = (record[F] ^ other[F]) & 1 == 0;
            let other = Side::<D, V>::of_record::<F, W>(&other);
            if is_one_sided || sides.next_if(is_same)?.is_some() {
                let problem = "it is one of more than two, or of two on one side";
                return Err(side.neighbor(problem).into());
            }
            if !side.names(&other) {
                let problem = "its other side is another than the tiles say";
                return Err(side.neighbor(problem).into());
            }
            let found = conflict(&side.points, &other.points[other.facet]);
            ties += u64::from(found.is_tie);
            if found.is_inside {
                let (tile, simplex) = (side.tile, u64::from(side.simplex));
                let (row, tie) = (other.rows[other.facet], found.is_tie);
                return Err(TilesViolation::Conflict { tile, simplex, row, tie }.into());
            }
            done += 2;
            if done % REPORT_SIDES == 0 {
                progress(REPORT_SIDES)?;
            }
        }
        compare(unpaired, outside)?;
        Ok(ties)
    }
}

/// The facets without another side must be those that links put on the hull.
fn compare(unpaired: Sorter<1>, outside: Sorter<1>) -> Result<(), TilesError> {
    let (mut unpaired, mut outside) = (unpaired.sorted()?, outside.sorted()?);
    loop {
        let (found, claimed) = (unpaired.next()?, outside.next()?);
        if found == claimed {
            if found.is_none() {
                return Ok(());
            }
            continue;
        }
        let (place, problem) = match (found, claimed) {
            (Some([found]), claimed) if claimed.is_none_or(|[claimed]| found < claimed) => {
                (found, "it has no other side, and no tile says that it lies on the hull")
            }
            (_, Some([claimed])) => {
                (claimed, "a tile says that it lies on the hull, but that is not so")
            }
            _ => return Ok(()),
        };
        let (tile, code) = ((place >> 32) as u32, place as u32);
        let (simplex, facet) = (u64::from(code >> 2), code as usize & 3);
        return Err(TilesViolation::Neighbor { tile, simplex, facet, problem }.into());
    }
}
