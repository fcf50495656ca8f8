//! Surfaces by hand for the tests of their checker, with certificates that are true unless a test changes them.
#![allow(dead_code)] // Each test file uses its part of this.

pub(crate) mod oracle;

use taut_certify::{
    Apex, CheckError, Solution, Surface, SurfaceCertificate, SurfaceComponent, SurfaceMethod,
    SurfaceMode, SurfaceTopology, SurfaceVerdict, SurfaceViolation, Trace, Violation,
};
use taut_mesh::{TriangleMesh, topology};
use taut_points::{Monitor, Points, hash_points};

pub(crate) type Point = [f64; 3];

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Case {
    pub(crate) solution: Solution<Surface>,
    pub(crate) rows: Vec<Point>,
}

impl Case {
    /// Triangles on rows, all of whose balls are claimed to be the smallest and empty, embedded and facing outwards.
    pub(crate) fn of(rows: Vec<Point>, triangles: Vec<[u32; 3]>) -> Self {
        let apexes = vec![Apex::Gabriel; triangles.len()];
        let certificate = SurfaceCertificate {
            method: SurfaceMethod::Tree,
            mode: SurfaceMode::Open,
            apexes,
            embedded: true,
            outward: true,
            displacement: 0.0,
            doubts: vec![],
            points_hash: hash_points(&Points::new(&[0.0; 0], 3).unwrap(), &Monitor::silent())
                .unwrap(),
        };
        let answer = Surface { triangles, ..Surface::default() };
        let mut case =
            Case { solution: Solution { answer, certificate, trace: Trace::default() }, rows };
        case.fit();
        case
    }

    /// Makes hash, topology and lists of unused rows those of rows and triangles.
    pub(crate) fn fit(&mut self) {
        self.hash();
        self.topology();
        let places = self.places();
        let answer = &mut self.solution.answer;
        let (duplicates, unreferenced) =
            (&mut answer.unused.duplicates, &mut answer.unused.unreferenced);
        duplicates.clear();
        unreferenced.clear();
        for (row, place) in places.iter().enumerate() {
            let first = places.iter().position(|other| other == place).unwrap();
            let row = row as u32;
            let used = answer.triangles.iter().flatten().any(|&corner| corner == row);
            let elsewhere =
                answer.unused.outliers.contains(&row) || answer.unused.interior.contains(&row);
            match () {
                () if (first as u32) < row => duplicates.push([row, first as u32]),
                () if used || elsewhere => {}
                () => unreferenced.push(row),
            }
        }
    }

    pub(crate) fn hash(&mut self) {
        let points = Points::new(self.rows.as_flattened(), 3).unwrap();
        self.certificate().points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    }

    /// The topology as another crate counts it.
    pub(crate) fn topology(&mut self) {
        let answer = &mut self.solution.answer;
        let found = topology(&TriangleMesh::new(&self.rows, &answer.triangles).unwrap());
        let component = |one: &taut_mesh::Component| SurfaceComponent {
            first_triangle: one.first_triangle,
            vertices: one.vertices as u64,
            edges: one.edges as u64,
            triangles: one.triangles as u64,
            boundary_loops: one.boundary_loops as u64,
            orientable: one.orientable,
            genus: one.genus,
        };
        answer.topology = SurfaceTopology {
            vertices: found.vertices as u64,
            edges: found.edges as u64,
            boundary_edges: found.boundary_edges as u64,
            boundary_loops: found.boundary_loops.len() as u64,
            non_manifold_edges: found.non_manifold_edges as u64,
            non_manifold_vertices: found.non_manifold_vertices as u64,
            inconsistent_edges: found.inconsistent_edges as u64,
            euler_characteristic: found.euler_characteristic,
            genus: found.genus,
            components: found.components.iter().map(component).collect(),
        };
    }

    /// Where the vertices are.
    pub(crate) fn places(&self) -> Vec<Point> {
        let moved = &self.solution.answer.vertices;
        if moved.is_empty() { self.rows.clone() } else { moved.clone() }
    }

    pub(crate) fn answer(&mut self) -> &mut Surface {
        &mut self.solution.answer
    }

    pub(crate) fn certificate(&mut self) -> &mut SurfaceCertificate {
        &mut self.solution.certificate
    }

    pub(crate) fn closed(mut self) -> Self {
        self.certificate().mode = SurfaceMode::Closed;
        self
    }

    pub(crate) fn check(&self) -> Result<SurfaceVerdict, Violation> {
        match self.solution.check(&Points::new(self.rows.as_flattened(), 3).unwrap()) {
            Ok(verdict) => Ok(verdict),
            Err(CheckError::Rejected(violation)) => Err(violation),
            Err(error) => panic!("{error}"),
        }
    }

    /// Returns what is wrong with it, which must be a matter of surfaces.
    pub(crate) fn violation(&self) -> SurfaceViolation {
        match self.check() {
            Err(Violation::Surface(violation)) => violation,
            other => panic!("{other:?}"),
        }
    }

    /// The same with all coordinates multiplied.
    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        self.rows.iter_mut().flatten().for_each(|x| *x *= factor);
        self.hash();
        self
    }
}

pub(crate) fn tetrahedron() -> Case {
    let rows = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut case = Case::of(rows, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).closed();
    case.certificate().apexes = vec![Apex::Hull, Apex::Row(2), Apex::Hull, Apex::Gabriel];
    case
}

/// Corners at (x, y, z) for the bits of the row; every four on a face lie on a circle, all eight on a sphere.
pub(crate) fn cube() -> Case {
    let rows = (0..8).map(|k| [f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1)]);
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut case = Case::of(rows.collect(), halved(&quads)).closed();
    case.certificate().apexes = (0..12u32)
        .map(|k| match k % 3 {
            0 => Apex::Hull,
            1 => Apex::Gabriel,
            // The corner opposite the first one is on no face with it.
            _ => Apex::Row(7 - halved(&quads)[k as usize][0]),
        })
        .collect();
    case
}

fn halved(quads: &[[u32; 4]]) -> Vec<[u32; 3]> {
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

/// A ring of `around` circles of `across` points each.
pub(crate) fn torus(around: u32, across: u32) -> Case {
    let angle = |k: u32, n: u32| std::f64::consts::TAU * f64::from(k) / f64::from(n);
    let mut rows = vec![];
    for i in 0..around {
        for j in 0..across {
            let (u, v) = (angle(i, around), angle(j, across));
            let far = 3.0 + v.cos();
            rows.push([far * u.cos(), far * u.sin(), v.sin()]);
        }
    }
    let row = |i: u32, j: u32| i % around * across + j % across;
    let quads: Vec<[u32; 4]> = (0..around)
        .flat_map(|i| (0..across).map(move |j| (i, j)))
        .map(|(i, j)| [row(i, j), row(i + 1, j), row(i + 1, j + 1), row(i, j + 1)])
        .collect();
    // Which half of a trapezium on a circle is Delaunay is a matter of roundings.
    let mut case = Case::of(rows, halved(&quads)).closed();
    case.certificate().apexes = vec![];
    case
}

/// A band of `count` pieces, turned over once where it closes if `twisted`.
pub(crate) fn band(count: u32, twisted: bool) -> Case {
    let mut rows = vec![];
    for k in 0..count {
        let u = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let v = if twisted { u / 2.0 } else { 0.0 };
        for w in [-0.4, 0.4] {
            let far = 2.0 + w * v.cos();
            rows.push([far * u.cos(), far * u.sin(), w * v.sin()]);
        }
    }
    let row = |k: u32, w: u32| match (k < count, twisted) {
        (true, _) => 2 * k + w,
        (false, true) => 1 - w,
        (false, false) => w,
    };
    let quads: Vec<[u32; 4]> =
        (0..count).map(|k| [row(k, 0), row(k + 1, 0), row(k + 1, 1), row(k, 1)]).collect();
    let mut case = Case::of(rows, halved(&quads));
    if !twisted {
        // As of the torus.
        case.certificate().apexes = vec![];
    }
    case
}

/// A sphere of 8·4ⁿ triangles.
pub(crate) fn sphere(center: Point, radius: f64, n: u32) -> Case {
    let mut rows: Vec<Point> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..n {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let [p, q] = [a, b].map(|row| rows[row as usize]);
                let sum = [0, 1, 2].map(|k| p[k] + q[k]);
                let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                rows.push(sum.map(|x| x / length));
                rows.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    for row in &mut rows {
        *row = [0, 1, 2].map(|k| center[k] + radius * row[k]);
    }
    Case::of(rows, triangles).closed()
}

/// Two surfaces as one.
pub(crate) fn both(one: &Case, other: &Case) -> Case {
    let shift = one.rows.len() as u32;
    let rows = one.rows.iter().chain(&other.rows).copied().collect();
    let moved = other.solution.answer.triangles.iter().map(|t| t.map(|row| row + shift));
    let triangles = one.solution.answer.triangles.iter().copied().chain(moved).collect();
    let mut case = Case::of(rows, triangles);
    case.certificate().mode = one.solution.certificate.mode;
    case
}

/// The same surface seen from its other side.
pub(crate) fn reversed(mut case: Case) -> Case {
    case.answer().triangles.iter_mut().for_each(|t| t.swap(1, 2));
    case.topology();
    case
}
