//! Tests what must hold of any surface that is found through points.

use taut_certify::{Solution, Surface};
use taut_mesh::{Topology, TriangleMesh, self_intersections, topology};
use taut_points::Points;
use taut_reconstruct::{SurfaceOptions, surface};

type Point = [f64; 3];

/// A surface in the terms of these tests.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct JudgedSurface {
    pub(crate) solution: Solution<Surface>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) topology: Topology,
}

impl JudgedSurface {
    /// Without boundary and without defect, and not empty.
    pub(crate) fn is_closed(&self) -> bool {
        !self.triangles.is_empty() && self.topology.is_manifold() && self.topology.is_closed()
    }

    /// Returns true if each point but copies of others is a vertex.
    pub(crate) fn is_through_all(&self) -> bool {
        let unused = &self.solution.answer.unused;
        let rows = [&unused.outliers, &unused.interior, &unused.unreferenced];
        rows.iter().all(|rows| rows.is_empty())
    }
}

/// The closed surface through points.
pub(crate) fn closed(points: &[Point]) -> JudgedSurface {
    found(points, &SurfaceOptions::default())
}

/// The surface through points, by these options, once it has passed what any must pass.
pub(crate) fn found(points: &[Point], options: &SurfaceOptions<'_>) -> JudgedSurface {
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    let solution = surface(&view, options).expect("points that span space");
    let answer = &solution.answer;
    let triangles = answer.triangles.clone();
    let places = if answer.vertices.is_empty() { points } else { &answer.vertices };
    let mesh = TriangleMesh::new(places, &triangles).expect("rows that exist");
    let topology = topology(&mesh);
    assert_eq!(topology.degenerate_triangles + topology.duplicate_triangles, 0);
    assert_eq!(self_intersections(&mesh).is_embedded(), solution.certificate.embedded);
    let verdict = solution.check(&view).expect("a sound certificate");
    let is_two_sided = topology.components.iter().all(|part| part.orientable);
    assert!(topology.is_oriented() || !is_two_sided);
    assert_eq!(
        verdict.is_sound,
        topology.is_manifold()
            && is_two_sided
            && verdict.is_embedded
            && verdict.is_delaunay
            && !triangles.is_empty(),
        "{:?}",
        verdict.doubt
    );
    assert_eq!(verdict.is_confident, solution.certificate.doubts.is_empty());
    assert_eq!(verdict.certified, verdict.is_sound && verdict.is_confident);
    if topology.is_closed() && topology.is_oriented() && !triangles.is_empty() {
        // About one of the points, in units of their extent.
        let base = places[0];
        let apart = |p: Point| [0, 1, 2].map(|k| p[k] - base[k]);
        let size = places.iter().flat_map(|&p| apart(p)).fold(0.0f64, |most, x| most.max(x.abs()));
        let of = |t: &[u32; 3]| volume(t.map(|row| apart(places[row as usize]).map(|x| x / size)));
        assert!(triangles.iter().map(of).sum::<f64>() > 0.0, "seen from outside");
    }
    JudgedSurface { triangles, topology, solution }
}

/// Six times the volume between a place and a triangle seen from it.
fn volume([a, b, c]: [Point; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// A closed surface through all points, with so many components and handles.
#[track_caller]
pub(crate) fn assert_exact(found: &JudgedSurface, components: usize, genus: u64) {
    let t = &found.topology;
    assert_eq!((t.components.len(), t.genus), (components, Some(genus)));
    assert!(found.is_closed() && found.is_through_all());
}
