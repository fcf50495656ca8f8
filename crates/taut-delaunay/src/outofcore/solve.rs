//! The node function: what one cell of the tree finishes, and what it passes up.
//!
//! *Problem.* Triangulate the points of a cell without knowing the others, keep what is already part of the triangulation
//! of all points, and pass on as little as possible.
//! *Idea.* Let T be the Delaunay triangulation of the sites that come to the node. A simplex is *final* if its sphere
//! meets no box with points of other cells; final simplices are written and forgotten. What goes up are the sites of the
//! others, and the facets between the two kinds, frozen. The node above triangulates the sites of its children again and
//! finds, within the frozen facets, what is unfinished (`facets`).
//! *Why it is right.* A site that does not go up has its whole star in the finished part F, and F is part of the Delaunay
//! triangulation of all points. So each simplex of the rest has its vertices among the sites that went up, is empty, and
//! is in their Delaunay triangulation; the frozen facets are there too and separate it from what is not real.
//! *Why few simplices are asked.* The points of a node lie in a convex cell and all other points outside. The simplices in
//! conflict with such a point p are connected through facets, and one of them is a ghost, as p is beyond the hull. So who
//! starts at the ghosts and goes on through simplices that may conflict, meets all of them; what is not met is final.
//! *Trap.* Ghosts can be final too, or the hull of a grid would go up to the root. If only ghosts are not, a finite simplex
//! behind one goes up with them, so that what goes up spans all dimensions.
//! *Trap.* A node whose sites do not span all dimensions passes everything on.

use taut_oblivious::machine::prefetch;
use taut_points::{Monitor, OrderBy};

use super::facets::{FrozenLinks, States, facet_of, renumbered, unfinished};
use super::front::{Front, FrozenFacet, Link};
use super::points::{FETCH_AHEAD, NodePoints, OrderedSites, order_sites};
use super::tree::Tree;
use crate::affine::Span;
use crate::canonical::arrangement;
use crate::geometry::{ConflictZone, Geometry};
use crate::kernel::{Kernel, Settings};
use crate::rounds::insert_all;
use crate::simplex::{GHOST, decode};
use crate::sites::{Magnitudes, Scale};
use crate::{Error, InsertionOrder};

/// What all nodes of a triangulation have in common.
pub struct Whole<const D: usize> {
    /// The boxes of all cells, scaled.
    pub(super) tree: Tree<D>,
    pub(super) scale: Scale,
    pub(super) settings: Settings,
    /// In a stream, whose tree has the places where points may still come, whatever the node: a point of each connected part
    /// of these, scaled.
    seeds: Option<Vec<[f64; D]>>,
}

impl<const D: usize> Whole<D> {
    /// What the nodes of `tree` must know of all its points; `vectors` is true if vector instructions are used where the
    /// machine has them, which changes no byte.
    pub fn new(tree: &Tree<D>, magnitudes: Magnitudes, vectors: bool) -> Self {
        let (scale, settings) = magnitudes.normalization(vectors);
        Self { tree: tree.scaled(scale), scale, settings, seeds: None }
    }

    /// What a chunk of a stream must know: `tree` has the places where points may still come, and `seeds` a point of each
    /// connected part of these that may lie within the hull of the points so far.
    pub(super) fn open(
        tree: &Tree<D>,
        mut seeds: Vec<[f64; D]>,
        magnitudes: Magnitudes,
        vectors: bool,
    ) -> Self {
        let (scale, settings) = magnitudes.normalization(vectors);
        seeds.iter_mut().flatten().for_each(|x| *x = scale.apply(*x));
        Self { tree: tree.scaled_outward(scale), scale, settings, seeds: Some(seeds) }
    }

    /// The cell of the tree that the points of a node come from; none in a stream.
    fn own_cell(&self, node: u32) -> Option<u32> {
        self.seeds.is_none().then_some(node)
    }
}

/// The mesh of a node whose sites span all dimensions, and what is known of its simplices.
pub(super) struct Solved<const D: usize, const V: usize, G: Geometry<D, V>> {
    pub(super) mesh: G::Mesh,
    pub(super) states: States,
    pub(super) links: FrozenLinks,
    /// The simplices that are not final.
    pub(super) open: Vec<u32>,
    /// The smallest row of each site.
    pub(super) rows: Vec<u64>,
    pub(super) duplicates: Vec<[u64; 2]>,
}

/// The result of a node.
pub(super) enum Outcome<const D: usize, const V: usize, G: Geometry<D, V>> {
    /// The sites span all dimensions.
    Full(Solved<D, V, G>),
    /// They do not: nothing is final, all goes up.
    Lower { front: Front<D>, duplicates: Vec<[u64; 2]> },
}

/// Triangulates the points of `node` and tells final simplices from others; at the root all are final.
pub(super) fn solve<const D: usize, const V: usize, G: Geometry<D, V>>(
    whole: &Whole<D>,
    node: u32,
    points: NodePoints<D>,
    facets: Vec<FrozenFacet<D>>,
    monitor: &Monitor<'_>,
) -> Result<Outcome<D, V, G>, Error> {
    let OrderedSites { places, rows, duplicates } = order_sites(&points, whole.scale);
    let facets = reorder(&places, points.rows.len(), facets);
    let at = |i: usize| points.coordinates[places[i] as usize];
    let scaled = |i: usize| {
        // Points are not in the order of the curve.
        if let Some(&soon) = places.get(i + FETCH_AHEAD) {
            prefetch(&points.coordinates, soon as usize);
        }
        at(i).map(|x| whole.scale.apply(x))
    };
    let Some(start) = start_simplex::<D, V, G>(places.len(), scaled) else {
        let coordinates = (0..places.len()).map(at).collect();
        return Ok(Outcome::Lower { front: Front { coordinates, rows, facets }, duplicates });
    };
    let mut mesh = G::Mesh::gather(places.len(), scaled, whole.settings);
    drop((points, places));
    mesh.start(start);
    insert_all(&mut mesh, &start, (InsertionOrder::Strided, 0), monitor)?;
    let (mut states, links) = unfinished::<D, V>(mesh.simplices(), rows.len(), facets)?;
    let mut hint = mesh.last();
    let mut within: Vec<u32> = Vec::new();
    for &seed in whole.seeds.iter().flatten() {
        hint = mesh.locate(seed, hint);
        within.push(hint);
    }
    let open = mark_open::<D, V, G>(whole, node, &mesh, &within, &mut states);
    Ok(Outcome::Full(Solved { mesh, states, links, open, rows, duplicates }))
}

/// The facets under the new numbers of the sites.
fn reorder<const D: usize>(
    places: &[u32],
    points: usize,
    mut facets: Vec<FrozenFacet<D>>,
) -> Vec<FrozenFacet<D>> {
    if facets.is_empty() {
        return facets;
    }
    let mut numbers = vec![0u32; points];
    (0u32..).zip(places).for_each(|(number, &place)| numbers[place as usize] = number);
    for facet in &mut facets {
        facet.vertices = renumbered(facet.vertices, |v| numbers[v as usize]);
    }
    facets
}

/// Affinely independent sites; `None` if there are none.
///
/// Looks at a few sites first: where the first thousand span all dimensions, the others need no copy.
fn start_simplex<const D: usize, const V: usize, G: Geometry<D, V>>(
    count: usize,
    site: impl Fn(usize) -> [f64; D],
) -> Option<[u32; V]> {
    const TRIED_FIRST: usize = 1024;
    [count.min(TRIED_FIRST), count].into_iter().find_map(|tried| {
        let sites: Vec<[f64; D]> = (0..tried).map(&site).collect();
        match G::span(&sites) {
            Span::Full(start) => Some(start),
            _ => None,
        }
    })
}

/// Marks the unfinished simplices that a point outside the node may conflict with, and lists them. Those are connected with
/// a ghost or with a simplex of `within`.
fn mark_open<const D: usize, const V: usize, G: Geometry<D, V>>(
    whole: &Whole<D>,
    node: u32,
    mesh: &G::Mesh,
    within: &[u32],
    states: &mut States,
) -> Vec<u32> {
    let simplices = mesh.simplices();
    let mut ghosts: Vec<u32> = Vec::new();
    for t in 0..simplices.len() as u32 {
        if states.is_unfinished_ghost(t) {
            ghosts.push(t);
        }
    }
    let site = |v: u32| mesh.site(v);
    let own = whole.own_cell(node);
    let mut nodes = Vec::new();
    let mut may_conflict = |t: u32| {
        // Rounding depends on the order of the vertices, and that on how the mesh was built.
        let arranged = |t: u32| {
            let vertices = &simplices[t as usize].vertices;
            arrangement(vertices).map(|i| vertices[usize::from(i)])
        };
        let vertices = arranged(t);
        let behind = |_: usize| {
            let simplex = &simplices[t as usize];
            let apex = simplex.vertices.iter().position(|&v| v == GHOST).unwrap_or(0);
            arranged(decode(simplex.neighbors[apex]).0)
        };
        // What cannot be filtered cannot be bounded by boxes either.
        let zone = ConflictZone::<D, V>::of::<G>(vertices, behind, site);
        let may_meet = |b: &_| !whole.settings.filtered || zone.may_meet::<G>(b);
        !whole.tree.outside_is_clear(own, &mut nodes, may_meet)
    };
    let mut open: Vec<u32> = Vec::new();
    let mut asked = vec![0u64; simplices.len().div_ceil(64)];
    let mut ask = |t: u32, states: &mut States, open: &mut Vec<u32>| {
        let (word, bit) = (&mut asked[t as usize / 64], 1u64 << (t % 64));
        if states.is_unfinished(t) && *word & bit == 0 {
            *word |= bit;
            if may_conflict(t) {
                states.set_open(t);
                open.push(t);
            }
        }
    };
    ghosts.iter().chain(within).for_each(|&t| ask(t, states, &mut open));
    let mut next = 0;
    while next < open.len() {
        for neighbor in simplices[open[next] as usize].neighbors {
            ask(decode(neighbor).0, states, &mut open);
        }
        next += 1;
    }
    open.sort_unstable();
    open
}

impl<const D: usize, const V: usize, G: Geometry<D, V>> Solved<D, V, G> {
    /// Marks the sites that go up.
    pub(super) fn sites_up(&self) -> Vec<bool> {
        let simplices = self.mesh.simplices();
        let mut up = vec![false; self.rows.len()];
        let mut mark = |t: u32| {
            let vertices = simplices[t as usize].vertices.into_iter();
            vertices.filter(|&v| v != GHOST).for_each(|v| up[v as usize] = true);
        };
        self.open.iter().for_each(|&t| mark(t));
        if self.open.iter().all(|&t| simplices[t as usize].is_ghost()) {
            // Of several such simplices the one of the smallest vertices, a choice that the set of points decides.
            let behind = self.open.iter().map(|&t| {
                let ghost = &simplices[t as usize];
                let apex = ghost.vertices.iter().position(|&v| v == GHOST).unwrap_or(0);
                let behind = decode(ghost.neighbors[apex]).0;
                let mut vertices = simplices[behind as usize].vertices;
                vertices.sort_unstable();
                (vertices, behind)
            });
            if let Some((_, behind)) = behind.min() {
                mark(behind);
            }
        }
        up
    }

    /// What goes up. `up` is of [`sites_up`](Self::sites_up), `side` gives the code in `tile` of a facet of a final finite
    /// simplex, and `unscale` leads back to the coordinates as given.
    pub(super) fn front(
        &self,
        tile: u32,
        up: &[bool],
        side: impl Fn(u32, usize) -> u32,
        unscale: Scale,
    ) -> Front<D> {
        let simplices = self.mesh.simplices();
        let mut places = vec![GHOST; up.len()];
        let mut front = Front::empty();
        for (v, _) in (0u32..).zip(up).filter(|&(_, &up)| up) {
            places[v as usize] = front.rows.len() as u32;
            front.coordinates.push(self.mesh.site(v).map(|x| unscale.apply(x)));
            front.rows.push(self.rows[v as usize]);
        }
        for &t in &self.open {
            let simplex = &simplices[t as usize];
            for i in 0..V {
                let (other, facet) = decode(simplex.neighbors[i]);
                let link = if self.states.is_frozen(t, i) {
                    self.links.get(t, i)
                } else if self.states.is_open(other) {
                    continue;
                } else if simplices[other as usize].is_ghost() {
                    Link::HULL
                } else {
                    Link { tile, code: side(other, facet) }
                };
                let facet = facet_of::<D, V>(&simplex.vertices, i);
                let vertices = renumbered(facet, |v| places[v as usize]);
                front.facets.push(FrozenFacet { vertices, link });
            }
        }
        front.facets.order_by_key(|f| f.vertices);
        front
    }
}
