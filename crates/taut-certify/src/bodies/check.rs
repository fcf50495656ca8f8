//! The checker of inscribed bodies, in whole numbers.
//!
//! *Grid.* Each coordinate lies between two whole numbers of units, its floor and its ceiling, which are found exactly: [`grid`].
//! *Surfaces.* A tenth number of a row names its surface: 0 for the mesh, 1, 2, … for solids, −1 for walls and points.
//! *Points.* A row with three equal corners is a point. It has no edges and no ray crosses it; that no body contains it is checked as for
//! any triangle.
//! *Closed.* Each edge of the mesh belongs to an even number of triangles and caps, and each edge of a solid to an even number of its own
//! triangles, by the coordinates as given. Caps have corners
//! of the mesh, and are no more than triangulations of its holes need: [`closed`]. From here on caps are triangles of the mesh.
//! *Empty.* No triangle meets the interior of a body, wherever its corners lie between floor and ceiling: [`empty`].
//! *Inside.* One point of each body is inside the mesh whose corners are the floors, and in none of the solids, by the parity of exact
//! crossings with each surface: [`parity`]. Moved from the coordinates as given to their floors, triangles never meet the body, so that
//! this holds for the surfaces as given. A body is convex, no triangle meets it, and one point is inside: so all of it is inside, and
//! bounded. A wall has no inside; no triangle of it meets a body.
//! *At.* The points and the ends of segments given are in the first bodies, wherever they lie between floor and ceiling.
//! *Volume.* The volume of each body comes from its exact vertices, with bounded rounding: [`volume`].
//! *Cost.* O(n log n) for n triangles, and O(n) for most bodies.

mod closed;
mod disjoint;
mod empty;
mod grid;
mod parity;
pub(crate) mod volume;

use taut_points::{Monitor, PointSource};

use self::grid::{Boxes, Grid};
use super::{BodiesCertificate, BodiesVerdict, BodiesViolation, ConvexBody, InscribedBodies};
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Violation};

/// The corners of a triangle, as given.
type Triangle = [[f64; 3]; 3];

/// The number of the mesh, whose caps belong to it.
const MESH: i32 = 0;

/// The number of walls and points.
const WALL: i32 = -1;

/// Entries of a normal are at most this, so that all sums and products fit into 128 bits.
const NORMAL_MAX: i64 = 1 << 16;

/// Offsets are at most this, for the same reason.
const OFFSET_MAX: i64 = 1 << 48;

/// Weights are at most this, for the same reason: with 4 facets and coordinates of 2³⁰ a sum is below 2¹¹¹.
const WEIGHT_MAX: u64 = 1 << 57;

/// Facets of a body, at most.
const FACETS_MAX: usize = 256;

/// How much the volume claimed may differ from the volume proved, relatively.
const VOLUME_SLACK: f64 = 1e-9;

pub(super) fn check(
    answer: &InscribedBodies,
    certificate: &BodiesCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<BodiesVerdict, CheckError> {
    if !matches!(source.dim(), 9 | 10) {
        return Err(BodiesViolation::Triangles { dim: source.dim() }.into());
    }
    if answer.bodies.is_empty() {
        return Err(BodiesViolation::NoBody.into());
    }
    monitor.pass(1, source.len());
    let (mut triangles, mut surfaces) = read(source, certificate, monitor)?;
    let rows = triangles.len();
    lengths(answer, certificate)?;
    let kind = |is_point: bool, of: fn(i32) -> bool| {
        let is_kind = |&(triangle, &surface): &(&Triangle, &i32)| {
            (triangle[0] == triangle[1] && triangle[1] == triangle[2]) == is_point && of(surface)
        };
        triangles.iter().zip(&surfaces).filter(is_kind).count() as u64
    };
    let (points, walls) = (kind(true, |_| true), kind(false, |surface| surface == WALL));
    let of_mesh = kind(false, |surface| surface == MESH);
    let closing = caps(&triangles, &answer.caps)?;
    surfaces.extend(closing.iter().map(|_| MESH));
    triangles.extend(closing);
    let solids = closed::are_closed(&triangles, &surfaces, rows)?;
    let grid = Grid::of(answer.exponent, answer.origin)?;
    let boxes = Boxes::of(&triangles, rows, &grid)?;
    let unit = grid::power_of_two(answer.exponent);
    let mut verdict = BodiesVerdict {
        bodies: answer.bodies.len() as u64,
        disjoint: answer.disjoint,
        caps: answer.caps.len() as u64,
        triangles: of_mesh,
        points,
        solids,
        walls,
        at: answer.at.len() as u64,
        volume_lower: 0.0,
        volume_upper: 0.0,
        largest: 0.0,
    };
    for (at, (body, proof)) in answer.bodies.iter().zip(&certificate.proofs).enumerate() {
        monitor.check().map_err(taut_points::ReadError::from)?;
        facets(at, body)?;
        empty::is_empty(at, body, proof, &boxes)?;
        contains(at, body, proof.inside)?;
        if !parity::is_inside(proof.inside, &boxes, &surfaces) {
            return Err(BodiesViolation::Outside { body: at }.into());
        }
        for point in answer.at.get(at).into_iter().chain(answer.ends.get(at)) {
            reaches(at, body, grid.around(*point)?)?;
        }
        let [lower, upper] = volume::bounds(body, proof.inside).map(|v| v * unit * unit * unit);
        let is_right = body.volume >= lower * (1.0 - VOLUME_SLACK)
            && body.volume <= upper * (1.0 + VOLUME_SLACK);
        if !is_right {
            let (claimed, found) = (body.volume, lower / 2.0 + upper / 2.0);
            return Err(BodiesViolation::Volume { body: at, claimed, found }.into());
        }
        verdict.volume_lower = (verdict.volume_lower + lower).next_down().max(0.0);
        verdict.volume_upper = (verdict.volume_upper + upper).next_up();
        verdict.largest = verdict.largest.max(lower);
    }
    if answer.disjoint {
        disjoint::are_disjoint(&answer.bodies, &certificate.pairs)?;
    }
    Ok(verdict)
}

/// Reads all triangles, which must be finite and those of the hash, and the numbers of their surfaces.
fn read(
    source: &dyn PointSource,
    certificate: &BodiesCertificate,
    monitor: &Monitor<'_>,
) -> Result<(Vec<Triangle>, Vec<i32>), CheckError> {
    let (claimed, dim) = (certificate.points_hash, source.dim());
    let (blocks, _) = hashed_pass(source, claimed, WantedRows::none(), monitor, |first, rows| {
        all_finite(first, rows)?;
        let mut row = [0.0; 10];
        let (mut triangles, mut surfaces) = (vec![], vec![]);
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row[..dim]);
            let [a, b, c, d, e, f, g, h, i, surface] = row;
            triangles.push([[a, b, c], [d, e, f], [g, h, i]]);
            surfaces.push(named_surface(first + k as u64, surface)?);
        }
        Ok((triangles, surfaces))
    })?;
    let (mut triangles, mut surfaces) = (vec![], vec![]);
    for (block, numbers) in blocks {
        triangles.extend(block);
        surfaces.extend(numbers);
    }
    Ok((triangles, surfaces))
}

/// The number of a surface: a whole number of at least −1.
fn named_surface(row: u64, value: f64) -> Result<i32, BodiesViolation> {
    let surface = value as i32;
    match f64::from(surface) == value && surface >= WALL {
        true => Ok(surface),
        false => Err(BodiesViolation::Surface { row, value }),
    }
}

/// Refuses lists whose lengths do not agree.
fn lengths(answer: &InscribedBodies, certificate: &BodiesCertificate) -> Result<(), Violation> {
    let bodies = answer.bodies.len();
    let agree = |what, found, expected| match found == expected {
        true => Ok(()),
        false => Err(Violation::Length { what, found, expected }),
    };
    agree("the list of proofs", certificate.proofs.len(), bodies)?;
    let pairs = if answer.disjoint { bodies * bodies.saturating_sub(1) / 2 } else { 0 };
    agree("the list of pairs", certificate.pairs.len(), pairs)?;
    // Each point needs a body; there may be more bodies.
    agree("the list of points given", answer.at.len(), answer.at.len().min(bodies))?;
    let ends = answer.ends.len();
    agree("the list of ends of segments", ends, if ends > 0 { answer.at.len() } else { 0 })
}

/// The caps as triangles.
fn caps(triangles: &[Triangle], caps: &[[u64; 3]]) -> Result<Vec<Triangle>, BodiesViolation> {
    let corners = triangles.as_flattened();
    let place = |corner: u64| usize::try_from(corner).ok().and_then(|at| corners.get(at).copied());
    let closing: Option<Vec<Triangle>> =
        caps.iter().map(|&[a, b, c]| Some([place(a)?, place(b)?, place(c)?])).collect();
    closing.ok_or(BodiesViolation::Caps { problem: "name a corner that the mesh does not have" })
}

/// Checks that a body contains a point, wherever it is in its box.
fn reaches(
    body: usize,
    found: &ConvexBody,
    [low, high]: [[i64; 3]; 2],
) -> Result<(), BodiesViolation> {
    let is_below = |(normal, &offset): (&[i64; 3], &i64)| {
        let ends = |c: usize| if normal[c] > 0 { high[c] } else { low[c] };
        (0..3).map(|c| normal[c] * ends(c)).sum::<i64>() <= offset
    };
    match found.normals.iter().zip(&found.offsets).all(is_below) {
        true => Ok(()),
        false => Err(BodiesViolation::At { body }),
    }
}

/// Checks the half-spaces of a body one by one.
fn facets(body: usize, found: &ConvexBody) -> Result<(), BodiesViolation> {
    let facets = found.normals.len();
    if !(4..=FACETS_MAX).contains(&facets) || facets != found.offsets.len() {
        let problem = "has not from 4 to 256 normals, or another number of offsets";
        return Err(BodiesViolation::Body { body, problem });
    }
    let wrong = |facet, problem| Err(BodiesViolation::Facet { body, facet, problem });
    for (facet, normal) in found.normals.iter().enumerate() {
        if normal.iter().any(|&n| !(-NORMAL_MAX..=NORMAL_MAX).contains(&n)) {
            return wrong(facet, "has a normal with an entry above 2^16");
        }
        if normal.iter().fold(0, |divisor, &n| gcd(divisor, n.unsigned_abs())) != 1 {
            return wrong(facet, "has a normal whose entries have a common divisor");
        }
        if found.normals[..facet].contains(normal) {
            return wrong(facet, "has the normal of an earlier facet");
        }
        if !(-OFFSET_MAX..=OFFSET_MAX).contains(&found.offsets[facet]) {
            return wrong(facet, "has an offset above 2^48");
        }
    }
    Ok(())
}

/// Checks that a point of the grid is in the interior of a body.
fn contains(body: usize, found: &ConvexBody, point: [i64; 3]) -> Result<(), BodiesViolation> {
    let is_near = point.iter().all(|c| (-grid::COORDINATE_MAX..=grid::COORDINATE_MAX).contains(c));
    let is_below = |(normal, &offset): (&[i64; 3], &i64)| {
        let along: i64 = normal.iter().zip(&point).map(|(n, y)| n * y).sum();
        along < offset
    };
    match is_near && found.normals.iter().zip(&found.offsets).all(is_below) {
        true => Ok(()),
        false => {
            let problem = "does not have the point of its proof in its interior";
            Err(BodiesViolation::Body { body, problem })
        }
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
