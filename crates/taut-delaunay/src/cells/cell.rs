//! One cell: the complete stars of a run of sites, from those sites and as few others as prove it.
//!
//! Idea: triangulate the cell's own sites with a halo a few spacings wide. Then every simplex at an own site must be
//! shown empty of all other sites: most are deep inside (`clean`); of the others most have a sphere smaller than the
//! way to the nearest site left out; the rest is asked of the index, and a site found in conflict is inserted and the
//! new simplices asked in turn.
//! Guarantee: at the end no site of the whole set conflicts with a simplex at an own site, ghosts included, so the
//! stars of the own sites are those of the triangulation of all sites: exact, ties included, for any halo.
//! Trap: a halo of fixed width is never enough. At the hull there are slivers with spheres of any size.
//! Trap: where every sphere touches most sites (points on a circle), a cell would ask about all sites for each simplex
//! it makes. It gives up after a number of questions, and the whole is triangulated in one.
//! The halo is the second of the three functions of the cells (assign), this module the third (triangulate).

use std::collections::HashSet;
use std::ops::{Index as At, Range};
use std::sync::atomic::{AtomicBool, Ordering};

use taut_points::Monitor;

use super::clean::Clean;
use super::geometry::{ConflictZone, Geometry, conflicts};
use super::index::{Bounds, Index, LEAF_SIZE, Node};
use crate::Error;
use crate::InsertionOrder;
use crate::kernel::{Counters, Kernel, Settings};
use crate::rounds::insert_all;
use crate::simplex::{GHOST, Simplex, decode};

/// Width of the first halo in mean spacings. Wider costs sites, narrower costs questions to the index: in space
/// (`bench delaunay threads-space`) 1.5 and 2 take the same time and 1 a quarter more; in the plane it hardly matters.
const fn halo_spacings(d: usize) -> f64 {
    if d == 2 { 3.0 } else { 1.5 }
}

/// Every cell triangulates this many sites of the other cells too, evenly along the curve: they keep spheres outside
/// the cell small.
const SCATTERED_SITES: usize = 512;

/// The distance to which a leaf looks for sites that were left out, in multiples of its extent.
const CLEARANCE_EXTENTS: f64 = 2.0;

/// A cell gives up if more than one simplex in so many is doubtful: on uniform points it is one in a hundred at most; on
/// a circle or a sphere, where every sphere touches all sites, one in three; on a torus, whose inner spheres touch a
/// whole meridian, one in sixteen.
const DOUBTFUL_SHARE: usize = 20;

/// Sites that a cell may ask about for each of its own before it gives up: on uniform points it asks about one for fifty
/// in the plane and two in space, in clusters of space up to fifteen.
const QUESTIONS_EACH: u64 = 24;

/// Most sites that one leaf may add to the halo: the box of a sparse leaf may lie over all of a dense cell.
const HALO_EACH: usize = 4 * LEAF_SIZE;

pub(crate) struct SharedData<'a, const D: usize, const V: usize> {
    pub(crate) sites: &'a [[f64; D]],
    pub(crate) index: &'a Index<D>,
    /// Affinely independent sites.
    pub(crate) start: [u32; V],
    pub(crate) settings: Settings,
    pub(crate) order: (InsertionOrder, u64),
    /// Set by the first cell that gives up.
    pub(crate) hopeless: &'a AtomicBool,
}

/// A cell with the stars of its own sites complete.
pub(crate) struct Cell<const V: usize> {
    /// Its own sites.
    pub(crate) own: Range<u32>,
    /// The site of each vertex of its mesh.
    pub(crate) sites: Vec<u32>,
    /// Where `own` lies in `sites`.
    pub(crate) own_local: Range<u32>,
    pub(crate) simplices: Vec<Simplex<V>>,
    /// The slots that have own sites and others, and perhaps some that had.
    pub(crate) mixed: Vec<u32>,
    pub(crate) counters: Counters,
}

/// A set of sites, a word per leaf of the index.
struct SiteSet(Vec<u64>);

impl SiteSet {
    fn insert(&mut self, site: u32) {
        self.0[site as usize / LEAF_SIZE] |= 1 << (site as usize % LEAF_SIZE);
    }

    /// The sites of a leaf that are not in the set.
    fn missing(&self, leaf: Node, run: Range<u32>) -> impl Iterator<Item = u32> + use<> {
        let mut absent = !self.0[leaf.place];
        let end = run.end;
        std::iter::from_fn(move || {
            let bit = absent.trailing_zeros();
            let site = run.start + bit;
            absent &= absent.wrapping_sub(1);
            (bit < LEAF_SIZE as u32 && site < end).then_some(site)
        })
    }
}

impl<const D: usize, const V: usize> SharedData<'_, D, V> {
    /// Triangulates the cell of the sites `own`, which begin and end at leaves of the index. `None` if this or another
    /// cell gave up, as it depends on most of the other sites.
    pub(crate) fn triangulate<G: Geometry<D, V>>(
        &self,
        own: Range<u32>,
        monitor: &Monitor<'_>,
    ) -> Result<Option<Cell<V>>, Error> {
        let mut here = SiteSet(vec![0; self.sites.len().div_ceil(LEAF_SIZE)]);
        for leaf in own.start as usize / LEAF_SIZE..(own.end as usize).div_ceil(LEAF_SIZE) {
            here.0[leaf] = u64::MAX;
        }
        self.scatter(&mut here);
        self.assign_halo(&own, &mut here);
        let mut sites: Vec<u32> = Vec::with_capacity(own.len() + own.len() / 8);
        for (leaf, &word) in here.0.iter().enumerate() {
            let first = (leaf * LEAF_SIZE) as u32;
            sites.extend(
                (0..LEAF_SIZE as u32).filter(|bit| word >> bit & 1 == 1).map(|bit| first + bit),
            );
        }
        // The last leaf may be shorter than its word.
        sites.truncate(sites.partition_point(|&s| (s as usize) < self.sites.len()));
        let place = |site: u32| sites.partition_point(|&s| s < site) as u32;
        let own_local = place(own.start)..place(own.end);
        let start = self.start.map(place);
        let mut mesh =
            G::Mesh::gather(sites.len(), |i| self.sites[sites[i] as usize], self.settings);
        mesh.start(start);
        insert_all(&mut mesh, &start, self.order, monitor)?;
        let clearance = self.clearances(&own, &here);
        let missing = |leaf| here.missing(leaf, self.index.run(leaf));
        let clean = Clean::of(self.index, self.sites, &own, missing);
        let mut cell = Certifying::<D, V, G> {
            whole: self,
            own: own.clone(),
            here,
            sites,
            clearance,
            clean,
            mesh,
            questions: 0,
            mixed: vec![],
            open: vec![],
        };
        if !cell.certify(&own_local, monitor)? {
            return Ok(None);
        }
        let (simplices, _, counters) = cell.mesh.finish();
        let (sites, mixed) = (cell.sites, cell.mixed);
        Ok(Some(Cell { own, sites, own_local, simplices, mixed, counters }))
    }

    /// Adds the start simplex, sites evenly along the curve, and the extreme sites in some directions.
    fn scatter(&self, here: &mut SiteSet) {
        self.start.iter().for_each(|&s| here.insert(s));
        for node in self.index.level_of_about(SCATTERED_SITES) {
            here.insert(self.index.run(node).start);
        }
        for direction in directions::<D>() {
            here.insert(self.extreme(direction));
        }
    }

    /// The site farthest in a direction: branch and bound over the boxes.
    fn extreme(&self, direction: [f64; D]) -> u32 {
        let dot = |p: [f64; D]| (0..D).map(|i| direction[i] * p[i]).sum::<f64>();
        let bound = |b: &Bounds<D>| {
            dot(std::array::from_fn(|i| if direction[i] > 0.0 { b.high[i] } else { b.low[i] }))
        };
        let best = std::cell::Cell::new((f64::NEG_INFINITY, 0));
        let keep = |index: &Index<D>, node| bound(index.bounds(node)) > best.get().0;
        self.index.visit(&mut Vec::new(), keep, |leaf| {
            for s in self.index.run(leaf) {
                let reached = dot(self.sites[s as usize]);
                if reached > best.get().0 {
                    best.set((reached, s));
                }
            }
            false
        });
        best.get().1
    }

    /// The leaves of a run of sites.
    fn leaves(own: &Range<u32>) -> impl Iterator<Item = Node> + use<D, V> {
        (own.start as usize / LEAF_SIZE..(own.end as usize).div_ceil(LEAF_SIZE))
            .map(|place| Node { level: 0, place })
    }

    /// Returns true if a node has only sites of `own`.
    fn is_own(&self, own: &Range<u32>, node: Node) -> bool {
        let run = self.index.run(node);
        own.start <= run.start && run.end <= own.end
    }

    /// Adds each site of other cells that is near a leaf of this one.
    fn assign_halo(&self, own: &Range<u32>, here: &mut SiteSet) {
        let mut open = Vec::new();
        for leaf in Self::leaves(own) {
            let bounds = *self.index.bounds(leaf);
            let per_axis = (self.index.run(leaf).len() as f64).powf(1.0 / D as f64);
            let width = halo_spacings(D) * bounds.extent() / per_axis;
            let width = width * width;
            let near = |index: &Index<D>, node| {
                !self.is_own(own, node) && index.bounds(node).distance_squared(&bounds) <= width
            };
            let mut added = 0;
            self.index.visit(&mut open, near, |other| {
                for site in here.missing(other, self.index.run(other)) {
                    if bounds.distance_squared_to(self.sites[site as usize]) <= width {
                        here.insert(site);
                        added += 1;
                    }
                }
                added >= HALO_EACH
            });
        }
    }

    /// For each own leaf, the squared distance from its box to the nearest site that is not in the mesh, or less: the
    /// search ends at a few times the extent of the leaf, as only the rare simplex is larger, and a search without end
    /// took most of the time of a build.
    fn clearances(&self, own: &Range<u32>, here: &SiteSet) -> Vec<f64> {
        let mut open = Vec::new();
        Self::leaves(own)
            .map(|leaf| {
                let bounds = self.index.bounds(leaf);
                let far = CLEARANCE_EXTENTS * bounds.extent();
                let nearest = std::cell::Cell::new(far * far);
                let keep = |index: &Index<D>, node| {
                    !self.is_own(own, node)
                        && index.bounds(node).distance_squared(bounds) < nearest.get()
                };
                self.index.visit(&mut open, keep, |other| {
                    for site in here.missing(other, self.index.run(other)) {
                        nearest.set(
                            nearest
                                .get()
                                .min(bounds.distance_squared_to(self.sites[site as usize])),
                        );
                    }
                    false
                });
                nearest.get()
            })
            .collect()
    }
}

/// The axes and the diagonals, both ways.
fn directions<const D: usize>() -> impl Iterator<Item = [f64; D]> {
    (0..3usize.pow(D as u32))
        .map(|code| std::array::from_fn(|i| (code / 3usize.pow(i as u32) % 3) as f64 - 1.0))
        .filter(|direction: &[f64; D]| direction.iter().any(|&x| x != 0.0))
}

/// A cell while its simplices are being shown to be empty.
struct Certifying<'a, const D: usize, const V: usize, G: Geometry<D, V>> {
    whole: &'a SharedData<'a, D, V>,
    own: Range<u32>,
    here: SiteSet,
    sites: Vec<u32>,
    /// By own leaf, squared.
    clearance: Vec<f64>,
    clean: Clean,
    mesh: G::Mesh,
    /// Sites that simplices were held against.
    questions: u64,
    /// As in [`Cell`].
    mixed: Vec<u32>,
    /// Scratch of queries.
    open: Vec<Node>,
}

impl<const D: usize, const V: usize, G: Geometry<D, V>> Certifying<'_, D, V, G> {
    /// Completes the stars of the own sites; false if that was given up.
    fn certify(&mut self, own: &Range<u32>, monitor: &Monitor<'_>) -> Result<bool, Error> {
        let most = QUESTIONS_EACH * u64::from(own.end - own.start);
        let mut doubtful: Vec<(u32, [u32; V])> = Vec::new();
        for t in 0..self.mesh.simplices().len() as u32 {
            let vertices = &self.mesh.simplices()[t as usize].vertices;
            let count = vertices
                .iter()
                .filter(|&&v| v.wrapping_sub(own.start) < own.end - own.start)
                .count();
            if count > 0 {
                doubtful.extend(self.doubt(own, t));
                if count < V {
                    self.mixed.push(t);
                }
            }
        }
        if doubtful.len() > self.mesh.simplices().len() / DOUBTFUL_SHARE {
            self.whole.hopeless.store(true, Ordering::Relaxed);
        }
        let mut star = Vec::new();
        while let Some((t, vertices)) = doubtful.pop() {
            // An insertion in the meantime may have replaced it.
            if self.mesh.simplices()[t as usize].vertices != vertices {
                continue;
            }
            if self.questions > most {
                self.whole.hopeless.store(true, Ordering::Relaxed);
            }
            if self.whole.hopeless.load(Ordering::Relaxed) {
                return Ok(false);
            }
            let Some(site) = self.conflicting(t) else { continue };
            self.here.insert(site);
            self.sites.push(site);
            let local = self.mesh.push(self.whole.sites[site as usize]);
            self.mesh.insert(&[local])?;
            star_of(self.mesh.simplices(), self.mesh.last(), local, &mut star);
            doubtful.extend(star.iter().filter_map(|&t| self.doubt(own, t)));
            self.mixed.extend(&star);
            monitor.check()?;
        }
        self.mixed.sort_unstable();
        self.mixed.dedup();
        Ok(true)
    }

    /// Slot `t` with its vertices if it holds a simplex at an own site that may reach a site that was left out.
    #[inline(always)]
    fn doubt(&self, own: &Range<u32>, t: u32) -> Option<(u32, [u32; V])> {
        let simplex = &self.mesh.simplices()[t as usize];
        // Dead slots have no vertex among the own sites, nor have ghosts at infinity.
        let places = simplex.vertices.map(|v| v.wrapping_sub(own.start));
        let count = own.end - own.start;
        if places.iter().all(|&place| place < count) && self.clean.holds(places) {
            return None;
        }
        let place = places.into_iter().find(|&place| place < count)?;
        let near = !simplex.is_live() || self.is_near(&simplex.vertices, place);
        (!near).then_some((t, simplex.vertices))
    }

    /// Tests whether the sphere of a simplex is too small to reach a site that was left out; `own` is the place of one of its
    /// vertices among the own sites.
    #[inline(always)]
    fn is_near(&self, vertices: &[u32; V], own: u32) -> bool {
        // Own sites begin with a leaf.
        let clearance = self.clearance[own as usize / LEAF_SIZE];
        let mut corners = [[0.0; D]; V];
        for (corner, &v) in corners.iter_mut().zip(vertices) {
            if v == GHOST {
                return false;
            }
            *corner = self.mesh.site(v);
        }
        G::reach(corners).within(clearance)
    }

    /// A site of the whole set that conflicts with simplex `t`, if there is one: among those of the first leaf that
    /// has some, the deepest.
    fn conflicting(&mut self, t: u32) -> Option<u32> {
        let simplices = self.mesh.simplices();
        let vertices = simplices[t as usize].vertices;
        let site = |v: u32| self.whole.sites[self.sites[v as usize] as usize];
        let behind =
            |apex: usize| simplices[decode(simplices[t as usize].neighbors[apex]).0 as usize];
        let zone = ConflictZone::of::<G>(vertices, |apex| behind(apex).vertices, site);
        let index = self.whole.index;
        let mut found: Option<(f64, u32)> = None;
        let mut questions = 0;
        let keep = |index: &Index<D>, node| {
            !self.whole.is_own(&self.own, node) && zone.may_meet::<G>(index.bounds(node))
        };
        let mut open = std::mem::take(&mut self.open);
        index.visit(&mut open, keep, |leaf| {
            for other in self.here.missing(leaf, index.run(leaf)) {
                questions += 1;
                let q = self.whole.sites[other as usize];
                let depth = zone.reach.depth(q);
                if found.is_none_or(|(deepest, _)| depth > deepest)
                    && conflicts::<D, V, G>(simplices, t, site, q)
                {
                    found = Some((depth, other));
                }
            }
            found.is_some()
        });
        self.open = open;
        self.questions += questions;
        found.map(|(_, site)| site)
    }
}

/// The simplices at vertex `v`, one of which is `t`.
pub(crate) fn star_of<const V: usize>(
    simplices: &(impl At<usize, Output = Simplex<V>> + ?Sized),
    t: u32,
    v: u32,
    star: &mut Vec<u32>,
) {
    star.clear();
    star.push(t);
    let mut seen = HashSet::from([t]);
    let mut next = 0;
    while next < star.len() {
        let simplex = &simplices[star[next] as usize];
        for i in 0..V {
            let (neighbor, _) = decode(simplex.neighbors[i]);
            if simplex.vertices[i] != v && seen.insert(neighbor) {
                star.push(neighbor);
            }
        }
        next += 1;
    }
}
