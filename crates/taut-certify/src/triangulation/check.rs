//! The proof that a list of simplices is *the* Delaunay triangulation of a list of points, in one linear pass.
//!
//! *Problem.* Given n rows, simplices by row numbers, the neighbors of each, the facets of the hull and the duplicates:
//! is each part what it is said to be? Every step below is exact.
//! 1. *Vertices.* Each row is a vertex of a simplex, or is listed as a duplicate: equal to an earlier row that is a
//!    vertex. [`sites`]
//! 2. *Orientation.* Each simplex is positively oriented, not flat. [`facets`]
//! 3. *Facets.* Each facet has a simplex on its other side, which names it in turn and runs along it the other way, or
//!    else it is listed on the hull, and the hull has no others. [`facets`]
//! 4. *Hull.* The facets of the hull form one closed surface that bounds a convex body and winds around it once.
//!    [`polygon`], [`polyhedron`]
//! 5. *Emptiness.* Across each inner facet the far vertex of the neighbor is outside the circumsphere; where it lies on
//!    it, the perturbation that makes the triangulation unique puts it outside. [`signs`]
//!
//! *Tiling, from 1 to 4.* Let c(p) be the number of simplices that contain p, for p on no facet. When p crosses a facet
//! with a simplex on either side, both positively oriented, it leaves one and enters the other: c changes on the hull
//! alone, by 1, up on the way in. As the hull winds once around a convex body B, c is 1 in B and 0 outside: the simplices
//! tile B without overlap. All vertices lie in B, so B is the convex hull of all rows. And no place has two ids: the
//! simplices around one place hang together by facets that contain it, and facets pair up by ids.
//!
//! *Delaunay, from 5.* Lift each site p to |p|², raised by an infinitesimal amount that is infinitely larger for the
//! lexicographically larger of two sites; that is a real small number ε to growing powers, and each of the finitely many
//! signs below is constant for all small enough ε > 0. Linear on each simplex, this is a continuous function on B, and 5
//! says that it is strictly convex across each inner facet, so it is convex (a segment in general position meets facets
//! in their interiors alone). A convex function through all lifted sites, linear on simplices with vertices among them,
//! is the lower hull of the lifted sites; its pieces are the simplices, and there is only one such function. So these
//! simplices are the perturbed Delaunay triangulation, and each has an empty open circumsphere.
//!
//! *Flat faces of the hull* need no rule of their own. A convex function on B is convex on each face of B, so in a face
//! the facets of the hull are the lower hull of the lifted sites of that face: the perturbed Delaunay triangulation of
//! these alone, whatever lies behind. As the perturbation never touches an orientation, no simplex is flat, and none is
//! missing where four points of the hull are on a line or a plane.
//!
//! *Identities.* T = 2n − 2 − h in the plane, Euler's formula for the hull and that of the whole complex in space follow
//! from the tiling, and so does the sum of the volumes; they would prove nothing more. In space Euler's formula does not
//! even stand in for the winding number: see [`polyhedron`]. Counts and the fingerprint are compared with those of the
//! certificate, so that it says nothing untrue.
//!
//! *Less than full dimension.* That the points lie on a line or on a plane is decided from all rows. In a plane of
//! space the same proof runs on two coordinates in which the plane is not upright, with |p|² of all three. On a line the
//! edges must be a chain in lexicographic order.
//!
//! *Cost.* O(n + simplices), beside a sort of the facets of the hull in space, and of those listed if they come in another
//! order than the simplices. Simplices that follow space name a row while it is at hand, so each row is fetched about
//! once. Beside the input and what is checked, a byte for each row is kept; the step of the hull takes 4 bytes for each row
//! and 16 for each of its edges in the plane, 8 and 44 for each of its triangles in space; 56 and 60 where the list of the
//! hull has to be sorted. Few bytes, as a first touch of memory costs more here than the arithmetic on what is put there.
//! *Reference.* Delaunay's lemma for regular triangulations: Edelsbrunner, Geometry and Topology for Mesh Generation,
//! 2001, section 1.3. Coverings by facet crossings: Mehlhorn et al., Comput. Geom. 12, 1999.

mod facets;
mod geometry;
mod input;
mod line;
mod listed;
mod near_ties;
mod pairing;
mod plain;
mod polygon;
mod polyhedron;
mod prove;
mod signs;
mod sites;
mod tiles;

use taut_points::{Monitor, PointSource, Scratch};

use self::prove::Claim;
use super::{
    MeshViolation, Triangulation, TriangulationCertificate, TriangulationCounts,
    TriangulationVerdict,
};
use crate::{CheckError, Violation};

pub(crate) use self::geometry::{Gabriel, Geometry, Lifted, Tetrahedra, cross};
pub(crate) use self::input::{Input, turn};
pub(crate) use self::signs::{Signs, UNDERFLOW};
pub use plain::check_simplices;
pub use tiles::{
    TilesError, TilesOptions, TilesVerdict, TilesViolation, check_tiles, check_tiles_disk,
};

pub(super) fn check(
    answer: &Triangulation,
    certificate: &TriangulationCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<TriangulationVerdict, CheckError> {
    let found = source.dim();
    if usize::from(answer.dimension) != found || !(2..=3).contains(&found) {
        return Err(MeshViolation::Dimension { claimed: answer.dimension, found }.into());
    }
    lengths(answer, certificate)?;
    let claim = Claim {
        hull_dimension: answer.hull_dimension,
        simplices: &answer.simplices,
        neighbors: &certificate.neighbors,
        lists: Some((&answer.hull, &answer.duplicates)),
    };
    let mut scratch = Scratch::new();
    let verdict = match found {
        2 => prove::plane(&read(certificate, source, &mut scratch, monitor)?, &claim)?,
        _ => prove::space(&read(certificate, source, &mut scratch, monitor)?, &claim)?,
    };
    counts(&certificate.counts, &verdict.counts)?;
    if verdict.fingerprint == certificate.fingerprint {
        return Ok(verdict);
    }
    let (claimed, found) = (certificate.fingerprint, verdict.fingerprint);
    Err(MeshViolation::Fingerprint { claimed, found }.into())
}

/// Lists hold whole rows, and as many neighbors as vertices or none.
fn lengths(
    answer: &Triangulation,
    certificate: &TriangulationCertificate,
) -> Result<(), Violation> {
    let width = answer.hull_dimension.map_or(0, usize::from);
    let rows = |list: &[u32], width: usize| list.len() / width.max(1) * width;
    for (what, list, expected) in [
        (
            "the list of simplices",
            &answer.simplices,
            rows(&answer.simplices, answer.vertices_per_simplex()),
        ),
        ("the list of hull facets", &answer.hull, rows(&answer.hull, width)),
        (
            "the list of neighbors",
            &certificate.neighbors,
            if certificate.neighbors.is_empty() { 0 } else { answer.simplices.len() },
        ),
    ] {
        if list.len() != expected {
            return Err(Violation::Length { what, found: list.len(), expected });
        }
    }
    Ok(())
}

/// The rows, if they are those the certificate speaks of.
fn read<'a, const D: usize>(
    certificate: &TriangulationCertificate,
    source: &'a dyn PointSource,
    scratch: &'a mut Scratch,
    monitor: &Monitor<'_>,
) -> Result<Input<'a, D>, CheckError> {
    let input = Input::<D>::read(source, scratch, monitor)?;
    if input.hash == certificate.points_hash {
        return Ok(input);
    }
    let (claimed, found) = (certificate.points_hash.to_string(), input.hash.to_string());
    Err(Violation::Hash { claimed, found }.into())
}

fn counts(claimed: &TriangulationCounts, found: &TriangulationCounts) -> Result<(), MeshViolation> {
    for (what, claimed, found) in [
        ("distinct points", claimed.sites, found.sites),
        ("simplices", claimed.simplices, found.simplices),
        ("hull facets", claimed.hull, found.hull),
    ] {
        if claimed != found {
            return Err(MeshViolation::Count { what, claimed, found });
        }
    }
    Ok(())
}
