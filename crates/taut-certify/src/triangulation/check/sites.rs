//! The rows that simplices name: their coordinates, ready for determinants, and which rows were named at all.
//!
//! *Idea.* Simplices follow space, rows come in any order. Nothing is renumbered or copied for that: the few
//! thousand rows that simplices name again and again for a while are kept at hand ([`Recent`]), so that most rows are
//! fetched from memory once. What grows with the input is one byte for a row.

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};

use super::super::{MeshViolation, SiteHash};
use super::input::Input;
use super::signs::lexicographic;

/// Stands for no row.
pub(super) const NO_SITE: u32 = u32::MAX;

/// The rows as vertices.
pub(super) struct Sites<'a, const D: usize> {
    input: &'a Input<'a, D>,
    /// The order in which determinants take the coordinates, if it is another.
    axes: Option<[usize; D]>,
    /// States whether a row was named. Of single bits, each would have to be set by one locked operation, for which the
    /// loads that follow wait.
    named: Vec<AtomicBool>,
}

impl<'a, const D: usize> Sites<'a, D> {
    /// All rows, none of them named.
    pub(super) fn of(input: &'a Input<'a, D>) -> Self {
        let named = (0..input.len()).map(|_| AtomicBool::new(false)).collect();
        Sites { input, axes: None, named }
    }

    /// Tests whether these ids are rows: `width` of each simplex from number `first` on.
    #[inline(always)]
    pub(super) fn have_all(
        &self,
        ids: &[u32],
        width: usize,
        first: usize,
    ) -> Result<(), MeshViolation> {
        let is_wrong = |id: u32| id as usize >= self.rows();
        if !is_wrong(ids.iter().fold(0, |largest, &id| largest.max(id))) {
            return Ok(());
        }
        match ids.iter().position(|&id| is_wrong(id)) {
            None => Ok(()),
            Some(place) => {
                let (position, id) = (first + place / width, ids[place]);
                Err(MeshViolation::Id { list: "simplices", position, id })
            }
        }
    }

    /// The same rows, with their coordinates in this order.
    pub(super) fn with_axes(self, axes: [usize; D]) -> Self {
        Sites { axes: Some(axes), ..self }
    }

    /// Number of rows, vertices or not.
    pub(super) fn rows(&self) -> usize {
        self.input.len()
    }

    /// All about a row, which is noted to be a vertex.
    #[inline(always)]
    fn vertex(&self, id: u32) -> Vertex<D> {
        self.name(id);
        let row = self.input.row(id);
        Vertex { id, hash: SiteHash::of(&row), point: self.ready(&row) }
    }

    /// The scaled coordinates of a row.
    #[inline(always)]
    pub(super) fn point(&self, id: u32) -> [f64; D] {
        self.ready(&self.input.row(id))
    }

    #[inline(always)]
    fn ready(&self, row: &[f64; D]) -> [f64; D] {
        let point = self.input.scaled(row);
        match self.axes {
            None => point,
            Some(axes) => axes.map(|k| point[k]),
        }
    }

    /// The same of some rows.
    #[inline(always)]
    pub(super) fn gather<const V: usize>(&self, ids: &[u32; V]) -> [[f64; D]; V] {
        let mut points = [[0.0; D]; V];
        for i in 0..V {
            points[i] = self.point(ids[i]);
        }
        points
    }

    /// Notes that a row is a vertex.
    #[inline(always)]
    fn name(&self, id: u32) {
        self.named[id as usize].store(true, Ordering::Relaxed);
    }

    pub(super) fn is_named(&self, id: u32) -> bool {
        self.named.get(id as usize).is_some_and(|named| named.load(Ordering::Relaxed))
    }

    pub(super) fn count(&self) -> usize {
        self.named.iter().map(|named| usize::from(named.load(Ordering::Relaxed))).sum()
    }

    /// The rows that were named, ascending.
    fn all_named(&self) -> impl Iterator<Item = u32> {
        (0..self.rows() as u32).filter(|&id| self.is_named(id))
    }

    /// Every row is a vertex, or listed once as equal to a vertex that stands before it. All vertices were named.
    ///
    /// That this vertex is the first of the equal rows follows: the others are no vertices, as no two simplices of a
    /// tiling name one place by two ids, so they are listed, and each after the vertex.
    pub(super) fn covers(&self, duplicates: &[[u32; 2]]) -> Result<(), MeshViolation> {
        let (input, n) = (self.input, self.rows() as u32);
        let mut before = None;
        for (position, &[row, first]) in duplicates.iter().enumerate() {
            let problem = match () {
                () if row >= n || first >= n => "there are not so many points",
                () if before.is_some_and(|before| before >= row) => "the list is not ascending",
                () if first >= row => "the second must be the earlier one",
                () if input.row(row) != input.row(first) => "they differ",
                () if self.is_named(row) => "the first is a vertex",
                () if !self.is_named(first) => "the second is no vertex",
                () => {
                    before = Some(row);
                    continue;
                }
            };
            return Err(MeshViolation::Duplicate { position, row, first, problem });
        }
        if self.count() + duplicates.len() == self.rows() {
            return Ok(());
        }
        let mut listed = duplicates.iter().map(|d| d[0]).peekable();
        let is_missing = |&row: &u32| !self.is_named(row) && listed.next_if_eq(&row).is_none();
        match (0..n).find(is_missing) {
            Some(row) => Err(MeshViolation::Missing { row }),
            None => Ok(()),
        }
    }

    /// Every row is a vertex or equals one. All vertices were named.
    pub(super) fn covers_all_places(&self) -> Result<(), MeshViolation> {
        if self.count() == self.rows() {
            return Ok(());
        }
        // −0 was turned into 0, so equal coordinates have equal bits.
        let place = |row: u32| self.input.row(row).map(f64::to_bits);
        let others = || (0..self.rows() as u32).filter(|&row| !self.is_named(row));
        let mut open: HashSet<[u64; D]> = others().map(place).collect();
        for id in self.all_named() {
            open.remove(&place(id));
        }
        match others().find(|&row| open.contains(&place(row))) {
            Some(row) => Err(MeshViolation::Missing { row }),
            None => Ok(()),
        }
    }

    /// The lexicographically smallest vertex.
    pub(super) fn smallest(&self) -> u32 {
        let smaller = |a: u32, b: u32| {
            if lexicographic(&self.point(b), &self.point(a)).is_lt() { b } else { a }
        };
        self.all_named().reduce(smaller).unwrap_or(NO_SITE)
    }

    /// Another vertex with the coordinates of `id`.
    pub(super) fn twin_of(&self, id: u32) -> Option<u32> {
        let place = self.point(id);
        self.all_named().find(|&other| other != id && self.point(other) == place)
    }
}

/// A vertex with all that is asked about it.
#[derive(Clone, Copy)]
pub(super) struct Vertex<const D: usize> {
    id: u32,
    pub(super) hash: SiteHash,
    pub(super) point: [f64; D],
}

/// Vertices met a short while ago, each at a place that its id tells.
///
/// No branch depends on what is at hand, and loads from memory do not wait for each other: rows are asked for first
/// ([`Recent::want`]), then brought all together.
pub(super) struct Recent<const D: usize> {
    /// The id that was last asked for at each place.
    wanted: Vec<u32>,
    /// The vertex at each place.
    vertices: Vec<Vertex<D>>,
    /// The first `count` are the ids that are not at hand.
    missing: Vec<u32>,
    count: usize,
}

impl<const D: usize> Recent<D> {
    /// Of a Hilbert order, this many keep nearly all that will come again, and stay in the second cache.
    const BITS: u32 = 12;

    pub(super) fn new(room: usize) -> Self {
        let nothing = Vertex { id: NO_SITE, hash: SiteHash::default(), point: [0.0; D] };
        Recent {
            wanted: vec![NO_SITE; 1 << Self::BITS],
            vertices: vec![nothing; 1 << Self::BITS],
            missing: vec![NO_SITE; room + 1],
            count: 0,
        }
    }

    /// Fibonacci hashing, as ids at equal distances would meet in one place.
    #[inline(always)]
    fn place(id: u32) -> usize {
        (id.wrapping_mul(0x9E37_79B9) >> (u32::BITS - Self::BITS)) as usize
    }

    /// Asks for the rows that `ids` gives, at most `room` before the next [`Recent::bring`]; for none by [`NO_SITE`].
    #[inline(always)]
    pub(super) fn want(&mut self, ids: impl Iterator<Item = u32>) {
        let Recent { wanted, missing, count, .. } = self;
        let (wanted, missing) = (wanted.as_mut_slice(), missing.as_mut_slice());
        // A local number, as one in memory would be stored and loaded again for each id.
        let mut end = *count;
        for id in ids {
            let wanted = &mut wanted[Self::place(id)];
            missing[end] = id;
            end += usize::from((*wanted != id) & (id != NO_SITE));
            *wanted = id;
        }
        *count = end;
    }

    /// Has all that were asked for at hand.
    #[inline(always)]
    pub(super) fn bring(&mut self, sites: &Sites<'_, D>) {
        let missing = &self.missing[..self.count];
        let touch = |all: u64, &id: &u32| all ^ sites.input.row(id)[0].to_bits();
        std::hint::black_box(missing.iter().fold(0, touch));
        for &id in missing {
            self.vertices[Self::place(id)] = sites.vertex(id);
        }
        self.count = 0;
    }

    /// A vertex that was brought.
    #[inline(always)]
    pub(super) fn vertex(&mut self, sites: &Sites<'_, D>, id: u32) -> &Vertex<D> {
        let vertex = &mut self.vertices[Self::place(id)];
        if vertex.id != id {
            // Another one was brought to the same place.
            *vertex = sites.vertex(id);
        }
        vertex
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Monitor, Points, Scratch};

    use super::*;

    #[test]
    fn rows_that_share_a_place_do_not_stand_for_each_other() {
        let values: Vec<f64> = (0..40_000).map(f64::from).collect();
        let points = Points::new(&values, 2).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<2>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let sites = Sites::of(&input);
        let mut recent = Recent::new(20_000);
        for round in 0..2 {
            for id in (0..20_000).step_by(1 + round) {
                recent.want([id].into_iter());
            }
            recent.want([NO_SITE].into_iter());
            recent.bring(&sites);
            for id in (0..20_000).rev() {
                let vertex = recent.vertex(&sites, id);
                assert_eq!((vertex.id, vertex.point), (id, sites.point(id)));
            }
        }
        assert_eq!(sites.count(), 20_000);
        assert!(!sites.is_named(20_000) && !sites.is_named(NO_SITE));
    }

    #[test]
    fn an_id_that_is_no_row_is_named_by_its_place() {
        let points = Points::new(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0], 2).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<2>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let found = Sites::of(&input).have_all(&[0, 1, 2, 0, 2, 3], 3, 7);
        let expected = MeshViolation::Id { list: "simplices", position: 8, id: 3 };
        assert_eq!(found, Err(expected));
    }
}
