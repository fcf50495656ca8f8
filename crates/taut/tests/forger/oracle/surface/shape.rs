//! Topology by walking: components over edges, links of vertices, loops of boundary edges.

use std::collections::{BTreeMap, BTreeSet};

use taut::certify::SurfaceComponent;
use taut::certify::SurfaceTopology;

/// The topology of the triangles.
pub(super) struct Shape {
    pub(super) topology: SurfaceTopology,
    /// The component of each triangle.
    pub(super) component: Vec<usize>,
    /// States whether each edge of a component has an even number of triangles.
    pub(super) is_closed: Vec<bool>,
    /// For each edge, lower row first, its triangles, and whether each runs from the lower row to the higher.
    pub(super) edges: BTreeMap<[u32; 2], Vec<(usize, bool)>>,
    triangles: Vec<[u32; 3]>,
}

/// Returns how many sets there are of items, those joined that `are_linked`.
fn sets<T>(items: &[T], are_linked: impl Fn(&T, &T) -> bool) -> Vec<usize> {
    let mut set = vec![usize::MAX; items.len()];
    let mut count = 0;
    for start in 0..items.len() {
        if set[start] != usize::MAX {
            continue;
        }
        (set[start], count) = (count, count + 1);
        let mut open = vec![start];
        while let Some(at) = open.pop() {
            for other in 0..items.len() {
                if set[other] == usize::MAX && are_linked(&items[at], &items[other]) {
                    set[other] = set[at];
                    open.push(other);
                }
            }
        }
    }
    set
}

fn count(sets: &[usize]) -> usize {
    sets.iter().max().map_or(0, |most| most + 1)
}

impl Shape {
    pub(super) fn of(triangles: &[[u32; 3]]) -> Self {
        let mut edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
        for (number, [a, b, c]) in triangles.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let key = [*from.min(to), *from.max(to)];
                edges.entry(key).or_default().push((number, from < to));
            }
        }
        let mut shape = Shape {
            topology: SurfaceTopology::default(),
            component: vec![usize::MAX; triangles.len()],
            is_closed: vec![],
            edges,
            triangles: triangles.to_vec(),
        };
        let mut components = vec![];
        for first in 0..triangles.len() {
            if shape.component[first] == usize::MAX {
                let orientable = shape.flood(first, components.len());
                components.push(SurfaceComponent {
                    first_triangle: first as u32,
                    orientable,
                    ..Default::default()
                });
            }
        }
        for (number, one) in components.iter_mut().enumerate() {
            shape.count(number, one);
        }
        shape.conclude(components);
        shape
    }

    fn sides(&self, triangle: usize) -> [[u32; 2]; 3] {
        let [a, b, c] = self.triangles[triangle];
        [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
    }

    /// Marks what hangs together with a triangle by edges, and tells whether it can be oriented.
    fn flood(&mut self, first: usize, number: usize) -> bool {
        let mut turned: BTreeMap<usize, bool> = BTreeMap::from([(first, false)]);
        self.component[first] = number;
        let mut open = vec![first];
        // First everything, then turns over edges of two triangles alone.
        while let Some(at) = open.pop() {
            for side in self.sides(at) {
                for &(other, _) in &self.edges[&side] {
                    if self.component[other] == usize::MAX {
                        self.component[other] = number;
                        open.push(other);
                    }
                }
            }
        }
        let own: Vec<usize> =
            (0..self.component.len()).filter(|&t| self.component[t] == number).collect();
        for &start in &own {
            if start != first && turned.contains_key(&start) {
                continue;
            }
            turned.entry(start).or_insert(false);
            let mut open = vec![start];
            while let Some(at) = open.pop() {
                for side in self.sides(at) {
                    let [one, other] = self.edges[&side][..] else { continue };
                    let next = if one.0 == at { other.0 } else { one.0 };
                    let expected = turned[&at] ^ (one.1 == other.1);
                    match turned.get(&next) {
                        Some(&found) if found != expected => return false,
                        Some(_) => {}
                        None => {
                            turned.insert(next, expected);
                            open.push(next);
                        }
                    }
                }
            }
        }
        true
    }

    /// The triangles of a vertex, in one component or all, and in how many sets they hang together by edges at it.
    pub(super) fn fans(&self, row: u32, component: Option<usize>) -> usize {
        let at: Vec<[u32; 3]> = (self.triangles.iter().zip(&self.component))
            .filter(|(triangle, own)| {
                triangle.contains(&row) && component.is_none_or(|component| **own == component)
            })
            .map(|(triangle, _)| *triangle)
            .collect();
        count(&sets(&at, |one, other| {
            one.iter().any(|corner| *corner != row && other.contains(corner))
        }))
    }

    fn loops(&self, component: Option<usize>) -> usize {
        let bare: Vec<[u32; 2]> = self
            .edges
            .iter()
            .filter(|(_, at)| at.len() == 1)
            .filter(|(_, at)| component.is_none_or(|own| self.component[at[0].0] == own))
            .map(|(edge, _)| *edge)
            .collect();
        count(&sets(&bare, |one, other| one.iter().any(|end| other.contains(end))))
    }

    fn count(&mut self, number: usize, one: &mut SurfaceComponent) {
        let own = |triangle: usize| self.component[triangle] == number;
        let triangles = || (0..self.triangles.len()).filter(|&triangle| own(triangle));
        let vertices: BTreeSet<u32> = triangles().flat_map(|t| self.triangles[t]).collect();
        let edges: Vec<usize> =
            self.edges.values().filter(|at| own(at[0].0)).map(Vec::len).collect();
        one.triangles = triangles().count() as u64;
        one.vertices = vertices.len() as u64;
        one.edges = edges.len() as u64;
        one.boundary_loops = self.loops(Some(number)) as u64;
        let is_manifold = edges.iter().all(|&at| at <= 2)
            && vertices.iter().all(|&row| self.fans(row, Some(number)) == 1);
        let euler = one.vertices as i64 - one.edges as i64 + one.triangles as i64;
        let lacking = 2 - one.boundary_loops as i64 - euler;
        let genus = if one.orientable { lacking / 2 } else { lacking };
        one.genus = is_manifold.then_some(genus.unsigned_abs());
        self.is_closed.push(edges.iter().all(|at| at % 2 == 0));
    }

    fn conclude(&mut self, components: Vec<SurfaceComponent>) {
        let rows: BTreeSet<u32> = self.triangles.iter().flatten().copied().collect();
        let with = |many: &dyn Fn(usize) -> bool| {
            self.edges.values().filter(|at| many(at.len())).count() as u64
        };
        let crowded: BTreeSet<u32> =
            self.edges.iter().filter(|(_, at)| at.len() > 2).flat_map(|(edge, _)| *edge).collect();
        let is_bad = |row: &&u32| crowded.contains(*row) || self.fans(**row, None) > 1;
        let vertices = rows.len() as u64;
        let edges = self.edges.len() as u64;
        let genus = components.iter().map(|one| one.genus.filter(|_| one.orientable)).sum();
        let alike = |at: &&Vec<(usize, bool)>| matches!(at[..], [one, other] if one.1 == other.1);
        self.topology = SurfaceTopology {
            vertices,
            edges,
            boundary_edges: with(&|at| at == 1),
            boundary_loops: self.loops(None) as u64,
            non_manifold_edges: with(&|at| at > 2),
            non_manifold_vertices: rows.iter().filter(is_bad).count() as u64,
            inconsistent_edges: self.edges.values().filter(alike).count() as u64,
            euler_characteristic: vertices as i64 - edges as i64 + self.triangles.len() as i64,
            genus,
            components,
        };
    }
}
