//! The answer with its certificate.

use std::collections::BTreeMap;

use taut_certify::{
    Apex, Solution, Stop, Surface, SurfaceCertificate, SurfaceComponent, SurfaceMethod,
    SurfaceTopology, Trace, UnusedRows,
};
use taut_mesh::Topology;
use taut_points::PointsHash;

use super::answer::{Found, Unused};
use super::options::SurfaceMode;

/// What was found, as the checker wants it.
pub(super) fn certified(
    found: Found,
    mode: SurfaceMode,
    points_hash: PointsHash,
) -> Solution<Surface> {
    let Found { triangles, apexes, unused, topology, flips, repairs, frustration: _, .. } = found;
    let is_surface = topology.is_manifold() && topology.is_oriented();
    let mut rows = UnusedRows::default();
    for point in unused {
        match point.reason {
            Unused::Duplicate { of } => rows.duplicates.push([point.row, of]),
            // Where sheets touch, inside is not a matter of single components.
            Unused::Inside if is_surface && mode == SurfaceMode::Closed => {
                rows.interior.push(point.row);
            }
            _ => rows.unreferenced.push(point.row),
        }
    }
    let counters = [("flips", flips), ("repairs", repairs)];
    let certificate = SurfaceCertificate {
        method: SurfaceMethod::Tree,
        mode: match mode {
            SurfaceMode::Closed => taut_certify::SurfaceMode::Closed,
            SurfaceMode::Open => taut_certify::SurfaceMode::Open,
        },
        apexes: apexes.into_iter().map(Apex::Row).collect(),
        // Facets of one triangulation have common edges and vertices alone.
        embedded: true,
        // Each closed component has cells that are inside behind it; of what is no surface nothing is claimed.
        outward: is_surface,
        displacement: 0.0,
        points_hash,
    };
    let trace = Trace {
        method: SurfaceMethod::Tree.name().into(),
        stop: Stop::Converged,
        passes: 1,
        counters: counters.map(|(name, count)| (name.to_owned(), count)).into_iter().collect::<BTreeMap<_, _>>(),
        ..Trace::default()
    };
    let answer = Surface { vertices: Vec::new(), triangles, topology: numbers(&topology), unused: rows };
    Solution { answer, certificate, trace }
}

/// The topology as the certificate has it.
fn numbers(found: &Topology) -> SurfaceTopology {
    let components = found.components.iter().map(|one| SurfaceComponent {
        first_triangle: one.first_triangle,
        vertices: one.vertices as u64,
        edges: one.edges as u64,
        triangles: one.triangles as u64,
        boundary_loops: one.boundary_loops as u64,
        orientable: one.orientable,
        genus: one.genus,
    });
    SurfaceTopology {
        vertices: found.vertices as u64,
        edges: found.edges as u64,
        boundary_edges: found.boundary_edges as u64,
        boundary_loops: found.boundary_loops.len() as u64,
        non_manifold_edges: found.non_manifold_edges as u64,
        non_manifold_vertices: found.non_manifold_vertices as u64,
        inconsistent_edges: found.inconsistent_edges as u64,
        euler_characteristic: found.euler_characteristic,
        genus: found.genus,
        components: components.collect(),
    }
}
