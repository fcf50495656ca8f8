//! The parts that the kernel of the plane and the kernel of space have in common, so that rounds, threads and canonical order are
//! written once.

use taut_predicates::Stages;

use crate::simplex::Simplex;

/// A mesh under construction: a Delaunay triangulation of the sites inserted so far, closed by ghosts.
///
/// Sites are numbered by the caller; coordinates are normalized (no −0; magnitudes at most 2⁴⁰, or `filtered` is off).
/// The perturbation is lexicographic in the coordinates, so the mesh is a function of the set of inserted sites.
pub(crate) trait Kernel<const D: usize, const V: usize>: Sized {
    /// A mesh over these sites, none of them inserted yet.
    fn new(sites: Vec<[f64; D]>, settings: Settings) -> Self;

    /// The same over `count` sites, of which `site(i)` is number i.
    fn gather(count: usize, site: impl Fn(usize) -> [f64; D], settings: Settings) -> Self {
        Self::new((0..count).map(site).collect(), settings)
    }

    fn site_count(&self) -> u32;

    fn site(&self, site: u32) -> [f64; D];

    /// Begins with `first`, which must be affinely independent (any orientation).
    fn start(&mut self, first: [u32; V]);

    /// Inserts sites in this order; none of them may be in the mesh already, all are distinct points. Begins the walk
    /// to each at the last simplex made.
    fn insert(&mut self, sites: &[u32]) -> Result<(), TooMany>;

    /// All slots, dead ones included.
    fn simplices(&self) -> &[Simplex<V>];

    /// A live simplex; after an insertion, one that has the site inserted last.
    fn last(&self) -> u32;

    /// The simplex (a ghost if outside the hull) that holds `q`, walking from the live simplex `hint`.
    fn locate(&mut self, q: [f64; D], hint: u32) -> u32;

    /// The slots (dead ones included), the sites if giving them back takes no memory, and the counters.
    fn finish(self) -> (Vec<Simplex<V>>, Option<Vec<[f64; D]>>, Counters);
}

/// The properties that the kernels must know of the coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Every coordinate is an integer.
    pub(crate) integral: bool,
    /// Magnitudes allow floating filters; otherwise each sign is taken exactly.
    pub(crate) filtered: bool,
    /// True if vector instructions may be used where the machine has them; without, the scalar path runs (the meshes are
    /// identical).
    pub(crate) vectors: bool,
}

/// Simplices are numbered with 30 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooMany;

/// Events of a build. They depend on how it was done (order, threads, vectors), with several threads on who came first, and on
/// nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Sites inserted, those of the first simplex included.
    pub insertions: u64,
    /// Simplices visited by the walks to the sites.
    pub walk_steps: u64,
    /// Orientation tests, filtered or not.
    pub orientations: u64,
    /// In-circle or in-sphere tests, filtered or not.
    pub conflict_tests: u64,
    /// Simplices made and destroyed again.
    pub replaced: u64,
    /// Where the signs were decided: each orientation and conflict test counts once.
    pub stages: Stages,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.insertions += other.insertions;
        self.walk_steps += other.walk_steps;
        self.orientations += other.orientations;
        self.conflict_tests += other.conflict_tests;
        self.replaced += other.replaced;
        self.stages += other.stages;
    }
}
