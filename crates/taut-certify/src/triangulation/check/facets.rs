//! Facets: how the simplices pair up across them, which way they face, and whether each pair is locally Delaunay.
//!
//! *Idea.* Each inner facet is visited once, from the simplex with the smaller number. Which facets those are, and which
//! of its vertices a neighbor has beyond one, nobody can foretell; so a batch of simplices is taken in three rounds,
//! none of which has a branch that is guessed wrong often:
//! 1. for each simplex N, O and a list of its facets that name a later simplex ([`Batch::prepare`]);
//! 2. for each of these the neighbor and the in-sphere test in plain arithmetic ([`Batch::cross`], [`Batch::test`]);
//! 3. for what 2 left open, ties where plain arithmetic is exact ([`Complex::settle`]), then all near ties of the batch
//!    together ([`NearTies`]), and what is still open one by one: also all that is wrong.
//!
//! The memory accesses of one round do not wait for each other.

use std::cmp::Ordering;

use taut_points::parallel::ParallelSlice;

use super::super::{Fingerprint, MeshViolation, NO_NEIGHBOR, SiteHash};
use super::geometry::{Geometry, Lifted, largest};
use super::near_ties::NearTies;
use super::signs::{Conflict, Signs, UNDERFLOW, sign_of};
use super::sites::{NO_SITE, Recent, Sites};
use crate::unrolled::unrolled;

/// Simplices in a block of work.
const BLOCK: usize = 1 << 13;

/// Simplices that go through the rounds together. What is known of them stays in the second cache; with fewer, more of the
/// vertices beyond them have not been met yet.
const BATCH: usize = 1024;

/// This many facets are settled together: what is gathered for them stays in the first cache.
const FACETS_PER_SETTLING: usize = 64;

/// Facet i of a simplex as seen from outside: its vertices in positive order.
pub(super) trait Facets<const F: usize> {
    /// The vertices of facet `i`, in positive order.
    fn facet(&self, i: usize) -> [u32; F];

    /// The vertex of `other` beyond `face`, and 0 if `back`, the neighbors of `other`, has `number` opposite just that
    /// vertex; if not, some number and one that is not 0, as perhaps where `number` stands there twice.
    fn beyond(face: &[u32; F], other: &Self, back: &Self, number: u32) -> (u32, u32);

    /// Tests whether two facets are one, seen from its two sides: whether an odd permutation takes one to the other.
    fn are_opposite(f: &[u32; F], g: &[u32; F]) -> bool;

    /// The same facet, from the same side, from a vertex on that only the facet tells.
    fn turned(facet: [u32; F]) -> [u32; F];
}

impl Facets<2> for [u32; 3] {
    #[inline(always)]
    fn facet(&self, i: usize) -> [u32; 2] {
        const PLACES: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
        let [a, b] = PLACES[i];
        [self[a], self[b]]
    }

    #[inline(always)]
    fn beyond(&[a, b]: &[u32; 2], other: &Self, back: &Self, number: u32) -> (u32, u32) {
        let off =
            |i: usize, j: usize, k: usize| (back[i] ^ number) | (other[j] ^ b) | (other[k] ^ a);
        // The rest of three numbers when two of them are taken away.
        let rest = other[0] ^ other[1] ^ other[2] ^ a ^ b;
        (rest, off(0, 1, 2).min(off(1, 2, 0)).min(off(2, 0, 1)))
    }

    #[inline(always)]
    fn are_opposite(&[a, b]: &[u32; 2], g: &[u32; 2]) -> bool {
        *g == [b, a]
    }

    #[inline(always)]
    fn turned(edge: [u32; 2]) -> [u32; 2] {
        edge
    }
}

impl Facets<3> for [u32; 4] {
    #[inline(always)]
    fn facet(&self, i: usize) -> [u32; 3] {
        const PLACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        let [a, b, c] = PLACES[i];
        [self[a], self[b], self[c]]
    }

    #[inline(always)]
    fn beyond(&[a, b, c]: &[u32; 3], other: &Self, back: &Self, number: u32) -> (u32, u32) {
        let at = |place: usize| usize::from(back[place] == number);
        let place = (at(1) + 2 * at(2) + 3 * at(3)) & 3;
        let g = other.facet(place);
        let off = |x, y, z| (g[0] ^ x) | (g[1] ^ y) | (g[2] ^ z);
        let turned = off(a, c, b).min(off(c, b, a)).min(off(b, a, c));
        (other[place], (back[place] ^ number) | turned)
    }

    #[inline(always)]
    fn are_opposite(&[a, b, c]: &[u32; 3], g: &[u32; 3]) -> bool {
        // Without a branch, as any of the three is as likely.
        let is = |x, y, z| (g[0] == x) & (g[1] == y) & (g[2] == z);
        is(a, c, b) | is(c, b, a) | is(b, a, c)
    }

    #[inline(always)]
    fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
        match () {
            () if a < b && a < c => [a, b, c],
            () if b < c => [b, c, a],
            () => [c, a, b],
        }
    }
}

/// The claims of the facets of all simplices.
#[derive(Default)]
pub(super) struct Paired<const F: usize> {
    /// The facets without a neighbor, in the order of the simplices.
    pub(super) open: Vec<[u32; F]>,
    pub(super) fingerprint: Fingerprint,
    pub(super) ties: u64,
    pub(super) refined: u64,
    /// Facets that name a neighbor after, and before, their own simplex.
    ahead: u64,
    behind: u64,
}

/// The simplices of one kind, with their neighbors.
pub(super) struct Complex<'a, const D: usize, const V: usize> {
    pub(super) sites: &'a Sites<'a, D>,
    pub(super) signs: Signs,
    pub(super) simplices: &'a [[u32; V]],
    pub(super) neighbors: &'a [[u32; V]],
}

impl<const D: usize, const V: usize> Complex<'_, D, V> {
    /// Every id is a row, every simplex is positively oriented, every facet has another side or is open, and no apex of a
    /// neighbor is in conflict.
    pub(super) fn check<G: Geometry<D, V>, const F: usize>(
        &self,
    ) -> Result<Paired<F>, MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let blocks: Vec<_> = self
            .simplices
            .par_chunks(BLOCK)
            .enumerate()
            // A batch has half a megabyte to be made.
            .with_min_len(8)
            .map_init(Batch::new, |batch, (block, simplices)| {
                self.block::<G, F>(batch, block * BLOCK, simplices)
            })
            .collect();
        let blocks = blocks.into_iter().collect::<Result<Vec<Paired<F>>, MeshViolation>>();
        if blocks.is_err() {
            // A wrong id may have been met from another simplex first, and is what is to be told.
            self.sites.have_all(self.simplices.as_flattened(), V, 0)?;
        }
        let blocks = blocks?;
        let mut all = Paired::default();
        all.open.reserve_exact(blocks.iter().map(|block| block.open.len()).sum());
        for block in blocks {
            all.open.extend(block.open);
            all.fingerprint.merge(block.fingerprint);
            all.ties += block.ties;
            all.refined += block.refined;
            all.ahead += block.ahead;
            all.behind += block.behind;
        }
        // Each facet that names a later simplex was found among those of that simplex which name an earlier one, no
        // two of them the same one. If there are as many of either, all were found.
        if all.ahead != all.behind
            && let Some(violation) = self.one_sided::<F>()
        {
            return Err(violation);
        }
        Ok(all)
    }

    fn block<G: Geometry<D, V>, const F: usize>(
        &self,
        batch: &mut Batch<D, V>,
        first: usize,
        simplices: &[[u32; V]],
    ) -> Result<Paired<F>, MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let mut paired = Paired::default();
        // A block that failed before may have left some, and each would leave more.
        batch.near_ties.forget();
        let starts = (first..first + simplices.len()).step_by(BATCH);
        for (first, simplices) in starts.zip(simplices.chunks(BATCH)) {
            // While they are at hand: a pass of its own would bring them all from memory once more.
            self.sites.have_all(simplices.as_flattened(), V, first)?;
            let ahead = batch.prepare::<G, F>(self, first, simplices, &mut paired)?;
            paired.ahead += ahead as u64;
            paired.behind += (V * simplices.len() - ahead) as u64;
            batch.cross(self, first, ahead);
            let open = batch.test::<G>(self, ahead);
            let Batch { open: listed, near_ties, .. } = &mut *batch;
            for some in listed[..open].chunks(FACETS_PER_SETTLING) {
                for facet in some {
                    self.settle::<G, F>(first, facet, near_ties, &mut paired)?;
                }
                near_ties.settle::<G, D, V>(self, first, |facet, conflict| {
                    self.conclude(first, facet, conflict, &mut paired)
                })?;
            }
        }
        Ok(paired)
    }

    /// Returns what is to be said of the orientation of a simplex, exactly.
    #[inline(never)]
    fn is_positive<G: Geometry<D, V>>(&self, simplex: usize) -> Result<(), MeshViolation> {
        match self.signs.orientation::<G, D, V>(&self.sites.gather(&self.simplices[simplex])) {
            Ordering::Greater => Ok(()),
            _ => Err(MeshViolation::Orientation { simplex }),
        }
    }

    /// Returns what is to be said of a facet that [`Batch::test`] left open, unless it is a near tie.
    fn settle<G: Geometry<D, V>, const F: usize>(
        &self,
        first: usize,
        facet: &Facet,
        near_ties: &mut NearTies,
        paired: &mut Paired<F>,
    ) -> Result<(), MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let number = first + facet.ahead.place as usize / 4;
        if facet.ahead.neighbor == NO_NEIGHBOR {
            paired.ahead -= 1;
            paired.open.push(self.simplices[number].facet(facet.ahead.place as usize % 4));
            return Ok(());
        }
        let (mut facet, is_tested) = (*facet, facet.apex != NO_SITE);
        if !is_tested {
            // Wrong, unless the neighbor names this simplex twice: once too often, which the counts show.
            facet.apex =
                self.across(number, facet.ahead.place as usize % 4, facet.ahead.neighbor)?;
            self.sites.have_all(&[facet.apex], 1, facet.ahead.neighbor as usize)?;
        }
        paired.refined += 1;
        let Tested { value, largest, .. } = facet.tested;
        let conflict = if !(self.signs.is_filtered && is_tested) {
            let (simplex, apex) = self.points(first, &facet);
            self.signs.conflict::<G, D, V>(&simplex, &apex)
        } else if largest <= G::IN_SPHERE.exact_max * self.signs.quantum {
            let (simplex, apex) = self.points(first, &facet);
            self.signs.conflict_of::<G, D, V>(&simplex, &apex, sign_of(value))
        } else {
            near_ties.push(facet);
            return Ok(());
        };
        self.conclude(first, &facet, conflict, paired)
    }

    /// The vertices of the simplex of a facet, and the vertex beyond it.
    #[inline(always)]
    pub(super) fn points(&self, first: usize, facet: &Facet) -> ([[f64; D]; V], [f64; D]) {
        let simplex = &self.simplices[first + facet.ahead.place as usize / 4];
        (self.sites.gather(simplex), self.sites.point(facet.apex))
    }

    fn conclude<const F: usize>(
        &self,
        first: usize,
        facet: &Facet,
        conflict: Conflict,
        paired: &mut Paired<F>,
    ) -> Result<(), MeshViolation> {
        paired.ties += u64::from(conflict.is_tie);
        if !conflict.is_inside {
            return Ok(());
        }
        Err(MeshViolation::Conflict {
            simplex: first + facet.ahead.place as usize / 4,
            neighbor: facet.ahead.neighbor as usize,
            row: facet.apex,
            tie: conflict.is_tie,
        })
    }

    /// The vertex beyond facet `facet` of `number`, in the later simplex `neighbor` that is named there.
    #[inline(always)]
    fn across<const F: usize>(
        &self,
        number: usize,
        facet: usize,
        neighbor: u32,
    ) -> Result<u32, MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let problem = match self.simplices.get(neighbor as usize) {
            None => "there are not so many simplices",
            Some(_) if neighbor as usize == number => "that is itself",
            Some(other) => {
                let back = &self.neighbors[neighbor as usize];
                let face = self.simplices[number].facet(facet);
                let mut places = 0u32;
                for place in 0..V {
                    places |= u32::from(back[place] == number as u32) << place;
                }
                // One place, unless the lists are wrong.
                while places != 0 {
                    let place = places.trailing_zeros() as usize;
                    if <[u32; V]>::are_opposite(&face, &other.facet(place)) {
                        return Ok(other[place]);
                    }
                    places &= places - 1;
                }
                "that does not name it back across the same facet"
            }
        };
        Err(MeshViolation::Neighbor { simplex: number, facet, neighbor, problem })
    }

    /// The simplex and the facet of an open facet, by its place among them.
    pub(super) fn open_facet(&self, place: usize) -> (usize, usize) {
        let facets = self.neighbors.as_flattened().iter().enumerate();
        let mut open = facets.filter(|&(_, &neighbor)| neighbor == NO_NEIGHBOR);
        let at = open.nth(place).map_or(0, |(at, _)| at);
        (at / V, at % V)
    }

    /// The first facet that names an earlier simplex by which it is not named.
    fn one_sided<const F: usize>(&self) -> Option<MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        (0..self.simplices.len()).find_map(|number| {
            (0..V).find_map(|facet| {
                let neighbor = self.neighbors[number][facet];
                if neighbor as usize >= number {
                    return None;
                }
                self.across(number, facet, neighbor).err()
            })
        })
    }
}

/// A facet that names a later simplex, itself or none.
#[derive(Clone, Copy, Default)]
pub(super) struct Ahead {
    /// 4·(place of the simplex in the batch) + facet.
    place: u32,
    neighbor: u32,
}

/// The same, with the vertex beyond it, or [`NO_SITE`] where there is none to be had.
#[derive(Clone, Copy, Default)]
pub(super) struct Facet {
    ahead: Ahead,
    apex: u32,
    pub(super) tested: Tested,
}

#[cfg(test)]
impl Facet {
    /// The first facet of a simplex, by its place in the batch, with the vertex beyond it.
    pub(super) fn beyond(place: usize, apex: u32) -> Self {
        let ahead = Ahead { place: 4 * place as u32, neighbor: NO_NEIGHBOR };
        Facet { ahead, apex, tested: Tested::default() }
    }
}

/// A few simplices on their way through the rounds. The lists have room for all facets, and stay as long as that.
struct Batch<const D: usize, const V: usize> {
    recent: Recent<D>,
    prepared: Vec<Prepared<D>>,
    ahead: Vec<Ahead>,
    /// The vertex beyond each of these facets, or [`NO_SITE`].
    apexes: Vec<u32>,
    /// Those facets that plain arithmetic did not settle.
    open: Vec<Facet>,
    near_ties: NearTies,
}

impl<const D: usize, const V: usize> Batch<D, V> {
    fn new() -> Self {
        Batch {
            recent: Recent::new(BATCH * V),
            prepared: Vec::with_capacity(BATCH),
            ahead: vec![Ahead::default(); BATCH * V + 1],
            apexes: vec![NO_SITE; BATCH * V],
            open: vec![Facet::default(); BATCH * V + 1],
            near_ties: NearTies::new(),
        }
    }

    /// Round 1: how many facets are listed in `ahead`. Checks the orientation on the way.
    #[inline(always)]
    fn prepare<G: Geometry<D, V>, const F: usize>(
        &mut self,
        complex: &Complex<'_, D, V>,
        first: usize,
        simplices: &[[u32; V]],
        paired: &mut Paired<F>,
    ) -> Result<usize, MeshViolation> {
        let Complex { sites, signs, neighbors, .. } = complex;
        self.prepared.clear();
        let mut count = 0;
        self.recent.want(simplices.as_flattened().iter().copied());
        self.recent.bring(sites);
        let rows = simplices.iter().zip(&neighbors[first..first + simplices.len()]);
        for (place, (simplex, neighbors)) in rows.enumerate() {
            let number = first + place;
            let (mut hashes, mut points) = ([SiteHash::default(); V], [[0.0; D]; V]);
            unrolled!(i < V, {
                let vertex = self.recent.vertex(sites, simplex[i]);
                (hashes[i], points[i]) = (vertex.hash, vertex.point);
            });
            paired.fingerprint.add(hashes);
            let prepared = Prepared::<D>::of::<G, V>(&points);
            if !(signs.is_filtered && prepared.is_positive::<G, V>()) {
                paired.refined += 1;
                complex.is_positive::<G>(number)?;
            }
            self.prepared.push(prepared);
            unrolled!(facet < V, {
                let neighbor = neighbors[facet];
                self.ahead[count] = Ahead { place: (4 * place + facet) as u32, neighbor };
                count += usize::from(neighbor as usize >= number);
            });
        }
        Ok(count)
    }

    /// Round 2, first half: the apexes of the first `count` facets.
    #[inline(always)]
    fn cross<const F: usize>(&mut self, complex: &Complex<'_, D, V>, first: usize, count: usize)
    where
        [u32; V]: Facets<F>,
    {
        let Complex { simplices, neighbors, .. } = *complex;
        let rows = complex.sites.rows();
        let ahead = &self.ahead[..count];
        // Some of these are far away. Touched in a loop of nothing else, many are on their way at the same time.
        let touch = |all: u32, ahead: &Ahead| {
            let at = ahead.neighbor as usize;
            all ^ simplices.get(at).map_or(0, |s| s[0]) ^ neighbors.get(at).map_or(0, |n| n[0])
        };
        std::hint::black_box(ahead.iter().fold(0, touch));
        let facets = self.apexes.iter_mut().zip(ahead);
        self.recent.want(facets.map(|(apex, &Ahead { place, neighbor })| {
            let (number, facet) = (first + place as usize / 4, place as usize % 4);
            let neighbor = neighbor as usize;
            *apex = NO_SITE;
            if let (Some(other), Some(back)) = (simplices.get(neighbor), neighbors.get(neighbor)) {
                let face = simplices[number].facet(facet);
                let (beyond, off) = <[u32; V]>::beyond(&face, other, back, number as u32);
                let is_right = (off == 0) & (neighbor != number) & ((beyond as usize) < rows);
                // Without a branch, NO_SITE for whatever is off.
                *apex = beyond | u32::from(is_right).wrapping_sub(1);
            }
            *apex
        }));
        self.recent.bring(complex.sites);
    }

    /// Round 2, second half: how many facets are listed in `open`.
    #[inline(always)]
    fn test<G: Geometry<D, V>>(&mut self, complex: &Complex<'_, D, V>, count: usize) -> usize {
        let (sites, is_filtered) = (complex.sites, complex.signs.is_filtered);
        let mut open = 0;
        for (&ahead, &apex) in self.ahead[..count].iter().zip(&self.apexes) {
            let prepared = &self.prepared[ahead.place as usize / 4];
            let tested = match apex {
                NO_SITE => Tested::default(),
                apex => prepared.test::<G, V>(&self.recent.vertex(sites, apex).point),
            };
            let is_settled = is_filtered & tested.is_outside::<G, D, V>();
            self.open[open] = Facet { ahead, apex, tested };
            open += usize::from(!is_settled);
        }
        open
    }
}

/// N and O of a simplex in plain arithmetic, for all its facets.
struct Prepared<const D: usize> {
    /// a₀
    origin: [f64; D],
    lifted: Lifted<f64, D>,
    max: [f64; D],
}

impl<const D: usize> Prepared<D> {
    #[inline(always)]
    fn of<G: Geometry<D, V>, const V: usize>(points: &[[f64; D]; V]) -> Self {
        let mut edges = [[0.0; D]; V];
        let mut max = [0.0f64; D];
        unrolled!(i < V - 1, {
            unrolled!(k < D, {
                edges[i][k] = points[i + 1][k] - points[0][k];
                max[k] = max[k].max(edges[i][k].abs());
            });
        });
        Prepared { origin: points[0], lifted: G::lifted(&edges[..V - 1]), max }
    }

    #[inline(always)]
    fn is_positive<G: Geometry<D, V>, const V: usize>(&self) -> bool {
        self.lifted.orientation > G::ORIENTATION.rounding * G::volume(&self.max) + UNDERFLOW
    }

    #[inline(always)]
    fn test<G: Geometry<D, V>, const V: usize>(&self, q: &[f64; D]) -> Tested {
        let (mut r, mut max) = (*q, self.max);
        unrolled!(k < D, {
            r[k] -= self.origin[k];
            max[k] = max[k].max(r[k].abs());
        });
        Tested {
            value: G::in_sphere(&self.lifted, &r),
            size: G::lifted_volume(&max),
            largest: largest(&max),
        }
    }
}

/// D in plain arithmetic.
#[derive(Clone, Copy, Default)]
pub(super) struct Tested {
    value: f64,
    /// The largest monomial there can be.
    pub(super) size: f64,
    /// The largest difference of coordinates.
    largest: f64,
}

impl Tested {
    #[inline(always)]
    fn is_outside<G: Geometry<D, V>, const D: usize, const V: usize>(&self) -> bool {
        self.value < -(G::IN_SPHERE.rounding * self.size + UNDERFLOW)
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Monitor, Points, Scratch};

    use super::super::geometry::Triangles;
    use super::super::input::Input;
    use super::super::pairing;
    use super::*;

    #[test]
    fn a_block_that_failed_leaves_nothing_to_the_next() {
        let values = [0.0, 0.0, 0.7, 0.1, 0.9, 0.9, 0.1, 0.6];
        let points = Points::new(&values, 2).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<2>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let sites = Sites::of(&input);
        let mut batch = Batch::new();
        let mut judge = |simplices: &[[u32; 3]], is_spoilt: bool| {
            let mut neighbors = pairing::pair(simplices, sites.rows()).unwrap();
            if is_spoilt {
                neighbors[0][2] = 1;
            }
            let signs = input.signs();
            let complex = Complex { sites: &sites, signs, simplices, neighbors: &neighbors };
            complex.block::<Triangles, 2>(&mut batch, 0, simplices).map(|paired| paired.open.len())
        };
        let (right, wrong) = ([[0, 1, 3], [1, 2, 3]], [[0, 1, 2], [0, 2, 3]]);
        let conflict = judge(&wrong, false);
        assert!(matches!(conflict, Err(MeshViolation::Conflict { .. })), "{conflict:?}");
        assert_eq!(judge(&right, false), Ok(4));
        // The conflict waits among the near ties when the block fails on another facet.
        let spoilt = judge(&wrong, true);
        assert!(matches!(spoilt, Err(MeshViolation::Neighbor { .. })), "{spoilt:?}");
        assert_eq!(judge(&right, false), Ok(4));
    }
}
