//! Facets: how the simplices pair up across them, which way they face, and whether each pair is locally Delaunay.

use rayon::prelude::*;

use super::super::{Fingerprint, MeshViolation, NO_NEIGHBOR};
use super::geometry::{Geometry, Lifted};
use super::signs::{Signs, UNDERFLOW};
use super::sites::Sites;

/// Simplices in a block of work.
const BLOCK: usize = 1 << 13;

/// Facet i of a simplex as seen from outside: its vertices in positive order.
pub(super) trait Facets<const F: usize> {
    /// The vertices of facet `i`, in positive order.
    fn facet(&self, i: usize) -> [u32; F];

    /// Whether two facets are one, seen from its two sides: whether an odd permutation takes one to the other.
    fn are_opposite(f: &[u32; F], g: &[u32; F]) -> bool;
}

impl Facets<2> for [u32; 3] {
    #[inline(always)]
    fn facet(&self, i: usize) -> [u32; 2] {
        const PLACES: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
        let [a, b] = PLACES[i];
        [self[a], self[b]]
    }

    #[inline(always)]
    fn are_opposite(&[a, b]: &[u32; 2], g: &[u32; 2]) -> bool {
        *g == [b, a]
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
    fn are_opposite(&[a, b, c]: &[u32; 3], g: &[u32; 3]) -> bool {
        // Without a branch, as any of the three is as likely.
        let is = |x, y, z| (g[0] == x) & (g[1] == y) & (g[2] == z);
        is(a, c, b) | is(c, b, a) | is(b, a, c)
    }
}

/// What the facets of all simplices have to say.
#[derive(Default)]
pub(super) struct Paired {
    /// (simplex, facet) of the facets without a neighbour.
    pub(super) open: Vec<(u32, u8)>,
    pub(super) fingerprint: Fingerprint,
    pub(super) ties: u64,
    pub(super) refined: u64,
    /// Facets that name a neighbour after, and before, their own simplex.
    ahead: u64,
    behind: u64,
}

/// The simplices of one kind, with their neighbours.
pub(super) struct Complex<'a, const D: usize, const V: usize> {
    pub(super) sites: &'a Sites<D>,
    pub(super) signs: Signs,
    pub(super) simplices: &'a [[u32; V]],
    pub(super) neighbors: &'a [[u32; V]],
}

impl<const D: usize, const V: usize> Complex<'_, D, V> {
    /// Every simplex is positively oriented, every facet has another side or is open, and no apex of a neighbour is in
    /// conflict.
    pub(super) fn check<G: Geometry<D, V>, const F: usize>(&self) -> Result<Paired, MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let blocks: Vec<_> = self
            .simplices
            .par_chunks(BLOCK)
            .enumerate()
            .map(|(block, simplices)| self.block::<G, F>(block * BLOCK, simplices))
            .collect();
        let mut all = Paired::default();
        for block in blocks {
            let block = block?;
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
        first: usize,
        simplices: &[[u32; V]],
    ) -> Result<Paired, MeshViolation>
    where
        [u32; V]: Facets<F>,
    {
        let mut block = Paired::default();
        for (number, simplex) in (first..).zip(simplices) {
            block
                .fingerprint
                .add(std::array::from_fn::<_, V, _>(|i| self.sites.hashes[simplex[i] as usize]));
            let points = self.sites.gather(simplex);
            let prepared = Prepared::<D>::of::<G, V>(&points);
            if !(self.signs.is_filtered && prepared.is_positive::<G, V>()) {
                block.refined += 1;
                if self.signs.orientation::<G, D, V>(&points).is_le() {
                    return Err(MeshViolation::Orientation { simplex: number });
                }
            }
            // Which facets name a later simplex nobody can foretell, so no branch depends on it.
            let neighbors = &self.neighbors[number];
            let (mut later, mut count) = ([0; V], 0);
            for facet in 0..V {
                later[count] = facet;
                count += usize::from(neighbors[facet] as usize >= number);
            }
            block.behind += (V - count) as u64;
            for &facet in &later[..count] {
                let neighbor = neighbors[facet];
                if neighbor == NO_NEIGHBOR {
                    block.open.push((number as u32, facet as u8));
                    continue;
                }
                block.ahead += 1;
                let apex = self.across(number, facet, neighbor)?;
                let q = &self.sites.points[apex as usize];
                if self.signs.is_filtered && prepared.is_outside::<G, V>(&points[0], q) {
                    continue;
                }
                block.refined += 1;
                let conflict = self.signs.conflict::<G, D, V>(&points, q);
                block.ties += u64::from(conflict.is_tie);
                if conflict.is_inside {
                    return Err(MeshViolation::Conflict {
                        simplex: number,
                        neighbor: neighbor as usize,
                        row: self.sites.rows[apex as usize],
                        tie: conflict.is_tie,
                    });
                }
            }
        }
        Ok(block)
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

/// N and O of a simplex in plain arithmetic, for all its facets.
struct Prepared<const D: usize> {
    lifted: Lifted<f64, D>,
    max: [f64; D],
}

impl<const D: usize> Prepared<D> {
    #[inline(always)]
    fn of<G: Geometry<D, V>, const V: usize>(points: &[[f64; D]; V]) -> Self {
        let mut edges = [[0.0; D]; V];
        let mut max = [0.0f64; D];
        for i in 1..V {
            for k in 0..D {
                edges[i - 1][k] = points[i][k] - points[0][k];
                max[k] = max[k].max(edges[i - 1][k].abs());
            }
        }
        Prepared { lifted: G::lifted(&edges[..V - 1]), max }
    }

    #[inline(always)]
    fn is_positive<G: Geometry<D, V>, const V: usize>(&self) -> bool {
        self.lifted.orientation > G::ORIENTATION.rounding * G::volume(&self.max) + UNDERFLOW
    }

    #[inline(always)]
    fn is_outside<G: Geometry<D, V>, const V: usize>(&self, p: &[f64; D], q: &[f64; D]) -> bool {
        let (mut r, mut max) = (*q, self.max);
        for k in 0..D {
            r[k] -= p[k];
            max[k] = max[k].max(r[k].abs());
        }
        G::in_sphere(&self.lifted, &r)
            < -(G::IN_SPHERE.rounding * G::lifted_volume(&max) + UNDERFLOW)
    }
}
