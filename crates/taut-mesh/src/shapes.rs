//! Meshes that the tests know by heart.

use std::f64::consts::TAU;

use crate::TriangleMesh;

/// A mesh that owns its parts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub(crate) fn new(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        Self { vertices: vertices.to_vec(), triangles: triangles.to_vec() }
    }

    pub(crate) fn view(&self) -> TriangleMesh<'_> {
        TriangleMesh::new(&self.vertices, &self.triangles).expect("a mesh")
    }

    /// Both beside each other.
    pub(crate) fn and(mut self, other: &Shape) -> Self {
        let shift = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|index| index + shift)));
        self
    }

    pub(crate) fn moved(mut self, by: [f64; 3]) -> Self {
        self.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]);
        self
    }

    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        self.map(|p| p.map(|x| factor * x));
        self
    }

    pub(crate) fn map(&mut self, change: impl Fn([f64; 3]) -> [f64; 3]) {
        self.vertices.iter_mut().for_each(|p| *p = change(*p));
    }

    /// The same triangles in another order, begun at another corner, on vertices with other numbers.
    pub(crate) fn shuffled(&self, seed: u64) -> Self {
        let mut state = seed;
        let mut below = move |n: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % n
        };
        let mut name: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for i in (1..name.len()).rev() {
            name.swap(i, below(i + 1));
        }
        let mut vertices = self.vertices.clone();
        for (&new, &old) in name.iter().zip(&self.vertices) {
            vertices[new as usize] = old;
        }
        let mut triangles: Vec<[u32; 3]> =
            self.triangles.iter().map(|t| t.map(|index| name[index as usize])).collect();
        for i in (1..triangles.len()).rev() {
            triangles.swap(i, below(i + 1));
        }
        triangles.iter_mut().for_each(|t| t.rotate_left(below(3)));
        Self { vertices, triangles }
    }
}

/// A grid of m × n squares, each two triangles, rolled up: `at` gives the vertex of column i ≤ m and row j ≤ n as its place in
/// a grid of `size`, where equal places are one vertex.
fn grid(
    [m, n]: [usize; 2],
    size: [usize; 2],
    at: impl Fn(usize, usize) -> [usize; 2],
    place: impl Fn(f64, f64) -> [f64; 3],
) -> Shape {
    let index = |i, j| {
        let [i, j] = at(i, j);
        (i * size[1] + j) as u32
    };
    let mut shape = Shape::default();
    for i in 0..size[0] {
        for j in 0..size[1] {
            shape.vertices.push(place(i as f64 / m as f64, j as f64 / n as f64));
        }
    }
    for i in 0..m {
        for j in 0..n {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            shape.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    shape
}

/// The unit square at height 0, of n × n squares.
pub(crate) fn square(n: usize) -> Shape {
    grid([n, n], [n + 1, n + 1], |i, j| [i, j], |u, v| [u, v, 0.0])
}

pub(crate) fn tetrahedron() -> Shape {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Shape::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

pub(crate) fn cube() -> Shape {
    let corner = |k: u32| [f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)];
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Shape {
        vertices: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    }
}

/// A ring of radius 2, as thick as 1 to either side.
pub(crate) fn torus(m: usize, n: usize) -> Shape {
    grid(
        [m, n],
        [m, n],
        |i, j| [i % m, j % n],
        |u, v| {
            let ((s, c), (t, r)) = ((TAU * u).sin_cos(), (TAU * v).sin_cos());
            [(2.0 + r) * c, (2.0 + r) * s, t]
        },
    )
}

/// A band of m × n squares with half a twist.
pub(crate) fn moebius(m: usize, n: usize) -> Shape {
    grid(
        [m, n],
        [m, n + 1],
        |i, j| if i == m { [0, n - j] } else { [i, j] },
        |u, v| {
            let ((s, c), (t, r)) = ((TAU * u).sin_cos(), (TAU * u / 2.0).sin_cos());
            let across = v - 0.5;
            [(2.0 + across * r) * c, (2.0 + across * r) * s, across * t]
        },
    )
}

/// A tube whose end is glued to its beginning the other way round; it runs through itself.
pub(crate) fn klein(m: usize, n: usize) -> Shape {
    let mut shape = torus(m, n);
    let whole = grid(
        [m, n],
        [m, n],
        |i, j| if i == m { [0, (n - j) % n] } else { [i, j % n] },
        |_, _| [0.0; 3],
    );
    shape.triangles = whole.triangles;
    shape
}

/// A sphere of radius 1: an octahedron whose sides were divided into four, `times` times.
pub(crate) fn sphere(times: usize) -> Shape {
    let mut shape = Shape::new(
        &[
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ],
        &[[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    );
    for _ in 0..times {
        let mut middles = std::collections::BTreeMap::new();
        let mut triangles = Vec::new();
        let vertices = &mut shape.vertices;
        for &[a, b, c] in &shape.triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[a, b]| {
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let (p, q) = (vertices[a as usize], vertices[b as usize]);
                    let sum = [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
                    let norm = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                    vertices.push(sum.map(|x| x / norm));
                    vertices.len() as u32 - 1
                })
            });
            triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        shape.triangles = triangles;
    }
    shape
}

/// A flat ring of n squares between radius 1 and 2.
pub(crate) fn annulus(n: usize) -> Shape {
    grid(
        [n, 1],
        [n, 2],
        |i, j| [i % n, j],
        |u, v| {
            let (s, c) = (TAU * u).sin_cos();
            [(1.0 + v) * c, (1.0 + v) * s, 0.0]
        },
    )
}
