//! Large convex bodies inside a closed triangle mesh, with facets in k fixed directions (k-dops).
//!
//! *Problem.* Find bodies {x : uⱼ·x ≤ hⱼ} inside a mesh that cover as much of its inside as possible.
//! *Idea.* Coordinates are rounded to a grid of 2⁻²⁴ of the longest side ([`mesh`]). A body without a triangle in its interior
//! moves its facet i outward until the first triangle: the *event* of facet i, which is the least uᵢ·x over all triangles
//! clipped by the other facets ([`clip`]). A tree that stores the least uⱼ·x of its triangles for each direction finds it
//! ([`tree`]). Bodies grow by events from points deep inside, are ruined in a few facets and grown again ([`grow`]); each new
//! body is to cover points that no other body covers ([`pack`]).
//! *Guarantee.* Each body lies inside the mesh as given: weights of facets separate each triangle from it, in whole numbers
//! ([`proof`]). Nothing is claimed about how large such bodies can be.
//! *Trap.* A facet that slides as far as it can before the others makes needles: facets take turns with limited steps first. A
//! facet that the others make redundant never meets a triangle: it stops where the others end.
//! *Reference.* Klosowski et al., Efficient collision detection using bounding volume hierarchies of k-dops, IEEE TVCG 4(1),
//! 1998, for the directions and the tree.

mod clip;
mod coverage;
mod directions;
mod grow;
mod mesh;
mod pack;
mod polytope;
mod proof;
pub(crate) mod random;
mod samples;
mod tree;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use taut_certify::{BodiesCertificate, InscribedBodies, Solution, Stop, Trace};
use taut_points::{InputError, Monitor, PointSource};

use crate::Error;

use self::directions::Directions;
use self::mesh::GridMesh;
use self::random::Random;
use self::tree::Tree;

pub use self::mesh::triangle_rows;

/// Points by which coverage is reported; the search does not see them. The standard error is below 0.2 %.
const REPORTED_POINTS: usize = 60_000;

/// How to look for bodies. Write `DopsOptions { directions: 26, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct DopsOptions<'a> {
    /// Directions of the facets: 6, 14, 18 or 26. Default 18.
    pub directions: usize,
    /// Most bodies to find, from 1 to 1000; fewer are found where no more fit. Default 1.
    pub count: usize,
    /// Whether no two bodies may overlap. Default false.
    pub disjoint: bool,
    /// How many events one search may compute, at least 1; smaller sets of directions are searched as well. Default 200,000.
    pub events: u64,
    /// Where the random choices begin. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for DopsOptions<'_> {
    fn default() -> Self {
        DopsOptions {
            directions: 18,
            count: 1,
            disjoint: false,
            events: 200_000,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

/// Finds large bodies with facets in k directions inside a closed triangle mesh.
///
/// Each row is a triangle: the three coordinates of each of its three corners. [`triangle_rows`] makes such rows from vertices
/// and triangles. The rows are read once and kept in memory. Bodies depend on the mesh and the options alone.
///
/// The search with k = 26 also improves the bodies of k = 18 and 14, and these the bodies of k = 6, so that more directions never
/// cover fewer of the points that the search counts.
///
/// # Errors
/// [`Error::Open`] with an edge where the mesh is not closed, [`Error::NoInside`], [`Error::Grid`], and [`Error::Input`] for bad
/// rows or options, and for what reading says.
pub fn inscribed_dops(
    triangles: &dyn PointSource,
    options: &DopsOptions<'_>,
) -> Result<Solution<InscribedBodies>, Error> {
    check_options(options)?;
    let mesh = GridMesh::read(triangles, &options.monitor)?;
    let mut random = Random::new(options.seed);
    let directions = Directions::of(options.directions);
    let tree = Tree::new(&mesh.corners, &directions);
    let points = samples::points(&tree, pack::SCORED_POINTS, &mut random);
    let packed = pack::pack(&mesh, &directions, &tree, &points, options)?;
    let found = proof::prove(&mesh, &directions, &tree, packed.bodies, options.disjoint)?;
    if found.bodies.is_empty() {
        return Err(Error::NoInside);
    }
    let reported = samples::points(&tree, REPORTED_POINTS, &mut random);
    let covered = coverage::covered(&reported, &found.bodies);
    let counters = [
        ("covered", covered),
        ("events", packed.events),
        ("facets", directions.len() as u64),
        ("sample_points", reported.len() as u64),
        ("searched_covered", packed.covered),
        ("searched_points", points.len() as u64),
        ("triangles", mesh.corners.len() as u64),
    ];
    let trace = Trace {
        method: "dops".to_owned(),
        stop: Stop::NodeBudget,
        passes: 1,
        iterations: packed.events,
        core_set: found.proofs.iter().map(|proof| proof.combined.len() as u64).sum(),
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    let answer = InscribedBodies {
        exponent: mesh.exponent,
        origin: mesh.origin,
        disjoint: options.disjoint,
        bodies: found.bodies,
    };
    let (proofs, pairs, points_hash) = (found.proofs, found.pairs, mesh.points_hash);
    let certificate = BodiesCertificate { proofs, pairs, points_hash };
    Ok(Solution { answer, certificate, trace })
}

fn check_options(options: &DopsOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value: String, expected| Err(InputError::Option { name, value, expected });
    if !directions::KINDS.contains(&options.directions) {
        return wrong("directions", options.directions.to_string(), "6, 14, 18 or 26");
    }
    if !(1..=1000).contains(&options.count) {
        return wrong("count", options.count.to_string(), "from 1 to 1000");
    }
    if options.events == 0 {
        return wrong("events", "0".to_owned(), "at least 1");
    }
    Ok(())
}
