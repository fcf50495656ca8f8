//! The claims of a surface, its certificate and its verdict, one after the other.

use num_bigint::Sign;
use taut::Solution;
use taut::certify::Surface;
use taut::certify::{SurfaceDoubt, SurfaceMode, SurfaceVerdict};

use super::super::lattice::{Lattice, difference, dot};
use super::convex::normal;
use super::scene::Scene;
use super::shape::Shape;
use super::{Judged, balls, ensure, lists, sides};

pub(super) fn judge(
    solution: &Solution<Surface>,
    verdict: &SurfaceVerdict,
    scene: &Scene,
) -> Judged {
    let (surface, certificate) = (&solution.answer, &solution.certificate);
    lists::rows(surface, scene)?;
    let triangles = &surface.triangles;
    let shape = Shape::of(triangles);
    let topology = &shape.topology;
    ensure(surface.topology == *topology, || {
        format!("the topology is told to be {:?}, and is {topology:?}", surface.topology)
    })?;
    let is_site = lists::sites(surface, scene.places.len());
    balls::judge(solution, scene, &is_site)?;
    mode(certificate.mode, &shape, triangles, scene)?;
    for &row in &surface.unused.interior {
        let depth = sides::depth(scene.at(row), triangles, &shape, scene, None);
        ensure(depth.is_some_and(|depth| depth % 2 == 1), || {
            format!("row {row} is not inside: {depth:?} around it")
        })?;
    }
    let is_embedded = !triangles.iter().any(|&triangle| scene.is_flat(triangle))
        && !(0..triangles.len()).any(|one| {
            (one + 1..triangles.len()).any(|other| scene.do_meet(triangles[one], triangles[other]))
        });
    let is_surface = topology.non_manifold_edges + topology.non_manifold_vertices == 0;
    let is_oriented = topology.inconsistent_edges == 0;
    let closed = || (0..shape.is_closed.len()).filter(|&number| shape.is_closed[number]);
    let is_outward = is_surface
        && is_oriented
        && is_embedded
        && closed().all(|number| faces_outwards(number, triangles, &shape, scene).is_ok());
    let is_delaunay = certificate.apexes.len() == triangles.len();
    let is_sound = is_outward && is_delaunay && !triangles.is_empty();
    for (what, claimed, truth) in [
        ("embedded", certificate.embedded, is_embedded),
        ("embedded", verdict.is_embedded, is_embedded),
        ("outward", certificate.outward, is_outward),
        ("outward", verdict.is_outward, is_outward),
        ("closed", verdict.is_closed, topology.boundary_edges == 0),
        ("manifold", verdict.is_manifold, is_surface),
        ("oriented", verdict.is_oriented, is_oriented),
        ("delaunay", verdict.is_delaunay, is_delaunay),
        ("sound", verdict.is_sound, is_sound),
        ("confident", verdict.is_confident, certificate.doubts.is_empty()),
        ("certified", verdict.certified, verdict.doubt.is_none()),
    ] {
        ensure(claimed == truth, || format!("{what} is told to be {claimed}"))?;
    }
    for (what, claimed, truth) in [
        ("triangles", verdict.triangles, triangles.len() as u64),
        ("vertices", verdict.vertices, topology.vertices),
        ("components", verdict.components, topology.components.len() as u64),
        ("boundary loops", verdict.boundary_loops, topology.boundary_loops),
        ("outliers", verdict.outliers, surface.unused.outliers.len() as u64),
    ] {
        ensure(claimed == truth, || format!("{claimed} {what} are told, there are {truth}"))?;
    }
    ensure(verdict.genus == topology.genus, || format!("the genus is told {:?}", verdict.genus))?;
    match verdict.doubt {
        Some(SurfaceDoubt::Topology { reason, row }) => {
            let first = certificate.doubts.first();
            let is_first = first
                .is_some_and(|doubt| doubt.reason == reason && doubt.rows.first() == Some(&row));
            ensure(is_sound && is_first, || format!("{reason} is not the first doubt"))
        }
        Some(doubt) => ensure(is_so(doubt, triangles, &shape, scene, verdict), || {
            format!("this is not so: {doubt:?}")
        }),
        None => ensure(is_sound && certificate.doubts.is_empty(), || {
            "certified, though it is not".into()
        }),
    }
}

/// Returns what the surface promises to be.
fn mode(mode: SurfaceMode, shape: &Shape, triangles: &[[u32; 3]], scene: &Scene) -> Judged {
    match mode {
        SurfaceMode::Closed => ensure(shape.topology.boundary_edges == 0, || "not closed".into()),
        SurfaceMode::Open => Ok(()),
        SurfaceMode::Alpha { radius } => {
            ensure(radius >= 0.0 && radius.is_finite(), || format!("the radius is {radius}"))?;
            let is_small = |triangle: &[u32; 3]| {
                let corners = triangle.map(|row| scene.places[row as usize]);
                let at = Lattice::of(&[corners.as_flattened(), &[radius, 0.0, 0.0]].concat(), 3);
                let [a, b, c, r] = &at.points[..] else { return false };
                // The square of the radius is |u|²|v|²|w|²/4|n|².
                let square = |p: &[num_bigint::BigInt], q: &[num_bigint::BigInt]| {
                    let edge = difference(q, p);
                    dot(&edge, &edge)
                };
                let n = normal([a, b, c]);
                let sides = square(a, b) * square(b, c) * square(c, a);
                !scene.is_flat(*triangle) && sides <= dot(r, r) * dot(&n, &n) * 4
            };
            let large = triangles.iter().find(|triangle| !is_small(triangle));
            ensure(large.is_none(), || format!("triangle {large:?} has a larger circle"))
        }
    }
}

/// Tests whether a closed component has behind it what it bounds; the depth at which it lies if not.
fn faces_outwards(
    number: usize,
    triangles: &[[u32; 3]],
    shape: &Shape,
    scene: &Scene,
) -> Result<(), usize> {
    let first = shape.topology.components[number].first_triangle as usize;
    let vertex = scene.at(triangles[first][0]);
    let depth = sides::depth(vertex, triangles, shape, scene, Some(number)).unwrap_or(0);
    let expected = if depth.is_multiple_of(2) { Sign::Plus } else { Sign::Minus };
    match sides::volume(triangles, shape, scene, number) == expected {
        true => Ok(()),
        false => Err(depth),
    }
}

/// Tests whether a reason not to certify is as it is told.
fn is_so(
    doubt: SurfaceDoubt,
    triangles: &[[u32; 3]],
    shape: &Shape,
    scene: &Scene,
    verdict: &SurfaceVerdict,
) -> bool {
    let at = |number: u32| triangles.get(number as usize).copied();
    match doubt {
        SurfaceDoubt::Empty => triangles.is_empty(),
        SurfaceDoubt::NonManifoldEdge { edge, triangles } => {
            triangles > 2 && shape.edges.get(&edge).is_some_and(|at| at.len() == triangles)
        }
        SurfaceDoubt::NonManifoldVertex { row, fans } => fans > 1 && shape.fans(row, None) == fans,
        SurfaceDoubt::OneSided { component } => {
            shape.topology.components.get(component).is_some_and(|one| !one.orientable)
        }
        SurfaceDoubt::NotOriented { triangles } => shape.edges.values().any(|at| {
            matches!(at[..], [one, other] if one.1 == other.1
                && [[one.0, other.0], [other.0, one.0]].contains(&triangles.map(|t| t as usize)))
        }),
        SurfaceDoubt::Flat { triangle } => {
            at(triangle).is_some_and(|triangle| scene.is_flat(triangle))
        }
        SurfaceDoubt::Crossing { triangles: [one, other] } => match (at(one), at(other)) {
            (Some(a), Some(b)) => one != other && scene.do_meet(a, b),
            _ => false,
        },
        SurfaceDoubt::Inward { component, depth } => {
            shape.is_closed.get(component) == Some(&true)
                && faces_outwards(component, triangles, shape, scene) == Err(depth)
        }
        SurfaceDoubt::NoBalls => !verdict.is_delaunay,
        _ => false,
    }
}
