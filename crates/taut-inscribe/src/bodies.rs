//! Large convex bodies inside a triangle mesh and among points, with facets in k fixed directions (k-dops) or in any directions.
//!
//! *Problem.* Find bodies {x : uⱼ·x ≤ hⱼ} inside a mesh that cover as much of its inside as possible.
//! *Idea.* Coordinates are rounded to a grid of 2⁻²⁴ of the longest side ([`mesh`]), and holes are closed if this is asked for
//! ([`caps`]). A k-dop without a triangle in its interior moves its facet i outward until the first triangle: the *event* of
//! facet i, which is the least uᵢ·x over all triangles clipped by the other facets ([`clip`]). A tree that stores the least uⱼ·x
//! of its triangles for each direction finds it ([`tree`]). Bodies grow by events from points deep inside, are ruined in a few
//! facets and grown again ([`grow`]). Facets in any directions are planes around a center, through the nearest points of
//! triangles in the metric of a smaller body ([`free`]). Each new body is to cover points that no other body covers ([`pack`]). If fewer bodies are wanted, pairs are merged ([`merge`]).
//! *Guarantee.* Each body lies inside the mesh as given: weights of facets separate each triangle from it, in whole numbers
//! ([`proof`]). Nothing is claimed about how large such bodies can be.
//! *Trap.* A facet that slides as far as it can before the others makes needles: facets take turns with limited steps first. A
//! facet that the others make redundant never meets a triangle: it stops where the others end.
//! *Reference.* Klosowski et al., Efficient collision detection using bounding volume hierarchies of k-dops, IEEE TVCG 4(1),
//! 1998, for the directions and the tree.

mod caps;
mod clip;
mod cloud;
mod coverage;
mod directions;
mod free;
mod given;
mod grow;
mod lines;
mod merge;
mod mesh;
mod options;
mod pack;
mod polytope;
mod proof;
mod rows;
mod samples;
mod scene;
mod scores;
mod segment;
mod thesis;
mod tree;
mod vectors;
mod warm;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

use taut_certify::{BodiesCertificate, InscribedBodies, Solution, Stop, Trace};
use taut_points::PointSource;

use crate::Error;

use self::directions::Directions;
use self::free::Free;
use self::lines::Sample;
use self::mesh::GridMesh;
use self::pack::{Family, Input, Packing};
use self::proof::Proved;
use self::tree::Tree;
use crate::random::Random;

pub use self::options::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, Objective, ThesisSeeds,
};
pub use self::rows::{box_rows, point_rows, triangle_rows};
pub use self::scene::Scene;

pub(crate) use self::mesh::check_dim;

/// Points by which coverage is reported; the search does not see them. The standard error is below 0.2 %.
const REPORTED_POINTS: usize = 60_000;

/// The same where each body is around a given point: how much of the mesh they cover matters less there than the time. Standard error below
/// 1 %.
const REPORTED_POINTS_GIVEN: usize = 3_000;

/// Finds large convex bodies inside a triangle mesh.
///
/// Each row is a triangle: the three coordinates of each of its three corners. [`triangle_rows`] makes such rows from vertices
/// and triangles. The rows are read once and kept in memory. Bodies depend on the mesh and the options alone.
///
/// *Obstacles.* A row with three equal corners is a point that no body contains: [`point_rows`] makes them. Among points alone
/// bodies need a mesh around these, as that of [`box_rows`]. Rows of 10 numbers have the number of a surface as their last one: 0 for
/// the mesh, whose rows come first, 1, 2, … for solids, which are closed and hold no body, and −1 for what has no inside. [`Scene`]
/// makes such rows of surfaces.
///
/// The search for k-dops with k = 26 also improves the bodies of k = 18 and 14, and these the bodies of k = 6, so that more
/// directions never cover fewer of the points that the search counts. One body alone is improved by its volume, and more directions
/// never make it smaller.
///
/// # Errors
/// [`Error::Open`] with an edge where the mesh is not closed, unless [`BodiesOptions::close_holes`] is set; [`Error::NoInside`],
/// [`Error::Ambiguous`], [`Error::At`], [`Error::Grid`], [`Error::FarPoint`], [`Error::FarObstacle`], [`Error::Surface`],
/// [`Error::OpenSolid`], and [`Error::Input`] for bad rows or options, and for what reading says.
pub fn inscribed_bodies(
    triangles: &dyn PointSource,
    options: &BodiesOptions<'_>,
) -> Result<Solution<InscribedBodies>, Error> {
    options.check()?;
    let mesh = GridMesh::read(triangles, options.close_holes, &options.monitor)?;
    let mut random = Random::new(options.seed);
    let kind = if let BodyShape::Dop(kind) = options.shape { kind } else { 6 };
    let tree =
        Arc::new(Tree::of_surfaces(&mesh.corners, &mesh.surfaces, &Arc::new(Directions::of(kind))));
    let turned = match options.shape {
        BodyShape::Directions(given) => Arc::new(tree.turned(&Arc::new(Directions::given(given)?))),
        _ => Arc::clone(&tree),
    };
    let given = given::starts(&mesh, &tree, options)?;
    let [scored, reported] = match options.at.len() >= options.count {
        true => [pack::SCORED_POINTS_GIVEN, REPORTED_POINTS_GIVEN],
        false => [pack::SCORED_POINTS, REPORTED_POINTS],
    };
    let points = samples::points(&tree, scored, &mut random);
    let mut hidden = || Sample::draw(&tree, lines::SCORED_LINES, &mut random);
    let lines = (options.objective == Objective::Occlusion).then(&mut hidden);
    let input = Input::new(&mesh, &tree, &points, lines.as_ref(), &given, options);
    let (found, searched) = search(&input, &turned)?;
    if found.bodies.is_empty() {
        return Err(if mesh.caps.is_empty() { Error::NoInside } else { Error::Ambiguous });
    }
    let reported = samples::points(&tree, reported, &mut random);
    let covered = coverage::covered(&reported, &found.bodies);
    let facets = found.bodies.iter().map(|body| body.normals.len() as u64).sum();
    let counters = [
        ("covered", covered),
        ("events", searched.events),
        ("facets", facets),
        ("sample_points", reported.len() as u64),
        ("searched_bodies", searched.bodies),
        ("searched_covered", searched.covered),
        ("searched_hidden", searched.hidden),
        ("searched_lines", lines.map_or(0, |lines| lines.lines.len() as u64)),
        ("searched_points", points.len() as u64),
        ("obstacle_points", mesh.points),
        ("obstacle_solids", mesh.solids),
        ("triangles", mesh.triangles),
    ];
    let method = match (options.method, options.shape) {
        (BodiesMethod::Thesis(_), _) => "thesis",
        (BodiesMethod::Recreate, BodyShape::Dop(_) | BodyShape::Directions(_)) => "dops",
        (BodiesMethod::Recreate, BodyShape::Free(_)) => "free",
    };
    let trace = Trace {
        method: method.to_owned(),
        stop: Stop::NodeBudget,
        passes: 1,
        iterations: searched.events,
        core_set: found.proofs.iter().map(|proof| proof.combined.len() as u64).sum(),
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    let answer = InscribedBodies {
        exponent: mesh.exponent,
        origin: mesh.origin,
        disjoint: options.is_disjoint(),
        caps: mesh.caps,
        at: options.at.to_vec(),
        ends: options.ends.to_vec(),
        bodies: found.bodies,
    };
    let (proofs, pairs, points_hash) = (found.proofs, found.pairs, mesh.points_hash);
    let certificate = BodiesCertificate { proofs, pairs, points_hash };
    Ok(Solution { answer, certificate, trace })
}

/// Figures of a search.
struct Searched {
    bodies: u64,
    events: u64,
    /// How many of the points to cover bodies cover.
    covered: u64,
    /// How many of the lines to hide bodies hide.
    hidden: u64,
}

/// Finds and proves bodies.
fn search(input: &Input<'_>, tree: &Arc<Tree>) -> Result<(Proved, Searched), Error> {
    let options = input.options;
    if let BodiesMethod::Thesis(thesis) = &options.method {
        let thesis::Packed { dops, events, covered } = thesis::pack(input, tree, thesis)?;
        let searched = Searched { bodies: dops.len() as u64, events, covered, hidden: 0 };
        return Ok((proof::prove(input.mesh, tree, dops, true)?, searched));
    }
    match options.shape {
        BodyShape::Dop(_) | BodyShape::Directions(_) => {
            let found = warm::pack(input, tree)?;
            let searched = Searched {
                bodies: found.bodies.len() as u64,
                events: found.events,
                covered: found.covered,
                hidden: found.hidden,
            };
            let proved = proof::prove(input.mesh, tree, found.bodies, options.disjoint)?;
            Ok((proved, searched))
        }
        BodyShape::Free(facets) => {
            let random = Random::new(options.seed);
            let family = Free::new(tree, random, facets, options.monitor);
            let mut packing = Packing::new(input, family);
            packing.fill(options.events)?;
            if let Some(loss) = options.merge_within {
                packing.merge(loss, options.events / merge::EVENTS_PART)?;
            }
            let searched = Searched {
                bodies: packing.bodies.len() as u64,
                events: packing.family.events(),
                covered: packing.covered(),
                hidden: packing.hidden(),
            };
            let proved = free::prove(input.mesh, tree, packing.bodies, options.disjoint)?;
            Ok((proved, searched))
        }
    }
}
