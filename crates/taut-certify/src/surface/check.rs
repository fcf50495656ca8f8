//! The checker of surfaces, in arithmetic of its own.
//!
//! *Problem.* Given rows and triangles of them, prove what the answer and its certificate say: which rows are used and why the others
//! are not, what the triangles are as a surface, that they meet nowhere else than along what they share, that each has an empty ball,
//! and that closed components face outwards. Every step is exact.
//! 1. *Lists.* Triangles name three different rows, no three twice; every other row is in just one list of unused ones; rows in one
//!    place are known as duplicates, all of them. [`structure`], [`usage`]
//! 2. *Topology.* Edges are sorted sides; components, fans at vertices and loops are sets joined along them. [`topology`]
//! 3. *Balls.* A tree over the points leaves out boxes that are surely outside; exact signs decide about the others. [`balls`],
//!    [`sphere`], [`ball`]
//! 4. *Embedding.* Two triangles with empty balls cannot meet unless both have further points on their spheres. A tree over those, or
//!    over all where there are no balls, lists the pairs that can; exact signs decide. [`crossing`], [`separated`], [`meet`]
//! 5. *Sides.* The sign of the volume tells which way a closed component faces, rays through the others how deep it lies. [`sides`]
//!
//! *Delaunay.* A triangle with an empty ball is a face of a Delaunay cell, or lies in one whose sphere has more than four points:
//! strictly inside is what counts, so that any way to divide such a cell is accepted. Where points were moved all this is said of
//! their new places. Outliers are no points here.
//! *Doubts.* No checker knows what was sampled. So doubts of the method about its topology are taken as they are: a surface is *sound* if
//! all of the above is so, and *certified* if it is sound and its method has no doubt.
//! *Claims.* What is claimed must be so, no more and no less. That a surface is no manifold, say, is no violation if its topology
//! says so: it is then the reason not to call it certified.
//! *Cost.* O(n log n), beside the points whose boxes reach into balls and the pairs of triangles whose boxes meet. Balls among
//! coordinates that no power of two brings below 1 without loss are judged without boxes, point by point.

mod ball;
mod balls;
mod buckets;
mod crossing;
mod meet;
mod places;
mod radius;
mod separated;
mod sets;
mod sides;
mod sphere;
mod structure;
mod topology;
mod tree;
mod usage;

use taut_points::{Monitor, PointSource};

use self::topology::Shape;
use super::{
    Surface, SurfaceCertificate, SurfaceDoubt, SurfaceMode, SurfaceVerdict, SurfaceViolation,
};
use crate::CheckError;

/// The largest deviation of a displacement from the one claimed, relatively, for those who round on another way.
const DISPLACEMENT_SLACK: f64 = 1e-9;

pub(super) fn check(
    surface: &Surface,
    certificate: &SurfaceCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<SurfaceVerdict, CheckError> {
    structure::check(surface, certificate, source)?;
    // What is refused first is named first, whichever thread is done first.
    let (once, places) = taut_points::parallel::join(
        || structure::twice(&surface.triangles),
        || places::read(surface, certificate, source, monitor),
    );
    once?;
    let (places, displacement) = places?;
    let claimed = certificate.displacement;
    // Subnormal numbers may differ by some of the least of them.
    let least = if displacement > 0.0 { 4.0 * f64::from_bits(1) } else { 0.0 };
    let slack = DISPLACEMENT_SLACK * displacement + least;
    let agrees = (claimed - displacement).abs() <= slack && displacement.is_finite();
    if !agrees {
        return Err(SurfaceViolation::Displacement { claimed, found: displacement }.into());
    }
    // One thread joins sides and corners, a third of the work, while the others search for points in balls.
    let (shape, balls) = taut_points::parallel::join(
        || Shape::of(&surface.triangles, places.all.len()),
        || -> Result<_, SurfaceViolation> {
            let sites = usage::check(surface, &places)?;
            Ok(balls::check(surface, certificate, &places, sites, monitor))
        },
    );
    let balls = balls?;
    topology::compare(&surface.topology, &shape.topology)?;
    match (certificate.mode, shape.bare) {
        (SurfaceMode::Closed, Some(edge)) => return Err(SurfaceViolation::Open { edge }.into()),
        (SurfaceMode::Alpha { radius }, _) => radius::check(surface, &places, radius)?,
        _ => {}
    }
    let faces = crossing::Faces::of(&surface.triangles, &places);
    // Where some ball is not what it is said to be, nothing follows from any; two triangles that meet are named first.
    let (independent, balls) = match balls {
        Ok(independent) => (independent, Ok(())),
        Err(CheckError::Rejected(violation)) => (vec![], Err(violation)),
        Err(unread) => return Err(unread),
    };
    let crossing = faces.crossing(&independent, monitor)?;
    match (crossing, certificate.embedded) {
        (Some(doubt), true) => return Err(SurfaceViolation::NotEmbedded { doubt }.into()),
        (None, false) => return Err(SurfaceViolation::Embedded.into()),
        _ => {}
    }
    balls?;
    sides::interior(surface, &shape, &faces)?;
    let inward = match shape.doubt.or(crossing) {
        None => sides::inward(&shape, &faces),
        doubt => doubt,
    };
    match (inward, certificate.outward) {
        (Some(doubt), true) => return Err(SurfaceViolation::NotOutward { doubt }.into()),
        (None, false) => return Err(SurfaceViolation::Outward.into()),
        _ => {}
    }
    let is_delaunay = certificate.apexes.len() == surface.triangles.len();
    let empty = surface.triangles.is_empty().then_some(SurfaceDoubt::Empty);
    let unsound = empty.or(inward).or((!is_delaunay).then_some(SurfaceDoubt::NoBalls));
    let in_topology = certificate.doubts.first().and_then(|doubt| {
        let row = *doubt.rows.first()?;
        Some(SurfaceDoubt::Topology { reason: doubt.reason, row })
    });
    let doubt = unsound.or(in_topology);
    let found = &shape.topology;
    Ok(SurfaceVerdict {
        rows: source.len(),
        triangles: surface.triangles.len() as u64,
        vertices: found.vertices,
        components: found.components.len() as u64,
        boundary_loops: found.boundary_loops,
        genus: found.genus,
        outliers: surface.unused.outliers.len() as u64,
        is_closed: found.is_closed(),
        is_manifold: found.is_manifold(),
        is_oriented: found.is_oriented(),
        is_embedded: crossing.is_none(),
        is_delaunay,
        is_outward: inward.is_none(),
        displacement,
        is_sound: unsound.is_none(),
        is_confident: in_topology.is_none(),
        certified: doubt.is_none(),
        doubt,
    })
}
