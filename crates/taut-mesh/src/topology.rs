//! The topology of a mesh: its parts, its borders, its handles, and what keeps it from being a surface.
//!
//! *Problem.* Given triangles on numbered vertices, count edges, borders, components and handles, and name what is not a
//! manifold. Coordinates play no part but in the lengths of loops.
//! *Idea.* Sides of triangles sorted by their two vertices are edges. Triangles that share an edge are joined to components;
//! joined with a sign, they tell whether the component has two sides; corners that share an edge at a vertex are joined to
//! fans, and a vertex of a surface has one fan.
//! *Guarantee.* Every count is exact and independent of the order of triangles; O(n log n).
//! *Trap.* The formula for the genus holds for surfaces only: where a component is none, it is not evaluated.

use crate::TriangleMesh;
use crate::grouped::Grouped;
use crate::mesh::repeats;
use crate::union_find::UnionFind;

/// A mesh as a surface, without its coordinates.
///
/// Triangles that name a vertex twice are counted as [`degenerate_triangles`](Self::degenerate_triangles) and left out of
/// all else. The others are the *triangles*. A triangle given twice counts twice, everywhere.
///
/// - An *edge* is a pair of vertices that are two corners of a triangle. It is a *boundary* edge if it is so for one triangle,
///   *non-manifold* if for more than two.
/// - The *link* of a vertex is the graph on its neighbors that has an edge for the opposite side of each triangle at the
///   vertex. A vertex of a surface has one path or one cycle for a link (one of two edges where a triangle is given twice); all
///   others are *non-manifold*, among them the ends of each non-manifold edge.
/// - A *component* is a largest set of triangles that one can walk through over edges. Two components can share vertices.
/// - A *boundary loop* is a largest set of boundary edges that one can walk through over vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// Vertices of triangles.
    pub vertices: usize,
    /// All other vertices.
    pub unreferenced_vertices: usize,
    /// Distinct edges.
    pub edges: usize,
    /// Triangles with three different vertices.
    pub triangles: usize,
    /// Triangles that name a vertex twice.
    pub degenerate_triangles: usize,
    /// Triangles whose three vertices are, in whatever order, those of one before them.
    pub duplicate_triangles: usize,
    /// Edges of one triangle.
    pub boundary_edges: usize,
    /// Edges of more than two triangles.
    pub non_manifold_edges: usize,
    /// Edges of exactly two triangles, which both run along it in the same direction.
    pub inconsistent_edges: usize,
    /// Vertices whose link is not one path or one cycle.
    pub non_manifold_vertices: usize,
    /// The boundary, by the least vertex of each loop.
    pub boundary_loops: Vec<BoundaryLoop>,
    /// The components, by the first triangle of each.
    pub components: Vec<Component>,
    /// Vertices − edges + triangles, of the mesh as a whole.
    pub euler_characteristic: i64,
    /// Handles of all components together; `None` if one of them is not a surface with two sides.
    pub genus: Option<u64>,
}

/// Boundary edges that hang together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryLoop {
    /// Its least vertex.
    pub first_vertex: u32,
    /// Number of its edges.
    pub edges: usize,
    /// Sum of the lengths of its edges, in the unit of the coordinates.
    pub length: f64,
    /// True if it is one cycle: each of its vertices is on two of its edges. So it is on all surfaces.
    pub simple: bool,
}

/// Triangles that hang together by edges, seen on their own: what another component does to a common vertex does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Component {
    /// Its first triangle.
    pub first_triangle: u32,
    /// Its vertices.
    pub vertices: usize,
    /// Its edges.
    pub edges: usize,
    /// Its triangles.
    pub triangles: usize,
    /// Its edges of one triangle.
    pub boundary_edges: usize,
    /// Its boundary loops.
    pub boundary_loops: usize,
    /// χ = vertices − edges + triangles.
    pub euler_characteristic: i64,
    /// True if it is a surface: no edge has more than two triangles, and each link is one path or one cycle.
    pub manifold: bool,
    /// True if no edge has one triangle only.
    pub closed: bool,
    /// True if all triangles can be turned such that the two of an edge run along it in opposite directions; edges of more
    /// than two triangles ask for nothing.
    pub orientable: bool,
    /// True if they are so turned as given.
    pub oriented: bool,
    /// With ℓ boundary loops, the number of handles g = (2 − ℓ − χ)/2 if orientable, that of cross-caps 2 − ℓ − χ if not (1
    /// for a Möbius band, 2 for a Klein bottle); `None` if it is not a surface.
    pub genus: Option<u64>,
}

impl Topology {
    /// Tests whether the mesh is a surface, with or without a boundary: no vertex, and so no edge, is non-manifold.
    pub fn is_manifold(&self) -> bool {
        self.non_manifold_edges == 0 && self.non_manifold_vertices == 0
    }

    /// Returns true if no edge has one triangle only.
    pub fn is_closed(&self) -> bool {
        self.boundary_edges == 0
    }

    /// Returns true if the two triangles of each edge run along it in opposite directions.
    pub fn is_oriented(&self) -> bool {
        self.inconsistent_edges == 0
    }
}

/// The topology of a mesh. O(n log n), and exact but for the lengths of loops.
///
/// ```
/// use taut_mesh::{TriangleMesh, topology};
/// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let sides = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let whole = topology(&TriangleMesh::new(&corners, &sides)?);
/// assert!(whole.is_manifold() && whole.is_closed() && whole.is_oriented());
/// assert_eq!((whole.edges, whole.euler_characteristic, whole.genus), (6, 2, Some(0)));
/// let opened = topology(&TriangleMesh::new(&corners, &sides[1..])?);
/// assert_eq!(opened.boundary_loops.len(), 1);
/// # Ok::<(), taut_mesh::Error>(())
/// ```
pub fn topology(mesh: &TriangleMesh<'_>) -> Topology {
    let at_vertices = Grouped::of(mesh.vertices().len(), || corners(mesh));
    let is_round = round(mesh, &at_vertices);
    let is_whole = 3 * mesh.triangles().len() == at_vertices.all.len();
    if is_whole && at_vertices.groups().all(|(vertex, _)| is_round[vertex]) {
        return closed_surface(mesh);
    }
    let sides = Sides::of(mesh);
    let (mut found, mut sets, one_sided, crowded) = edges(mesh, &sides);

    // Components, numbered by their first triangle.
    let mut number = vec![u32::MAX; mesh.triangles().len()];
    for &triangle in &sides.kept {
        let root = sets.root(triangle);
        if root == triangle {
            number[triangle as usize] = found.components.len() as u32;
            found.components.push(Component::beginning_with(triangle));
        }
        number[triangle as usize] = number[root as usize];
        found.components[number[root as usize] as usize].triangles += 1;
    }
    let of = |triangle: u32| number[triangle as usize] as usize;
    for triangle in one_sided {
        found.components[of(triangle)].orientable = false;
    }
    for edge in sides.edges() {
        let part = &mut found.components[of(edge[0].triangle())];
        part.edges += 1;
        match edge {
            [_] => part.boundary_edges += 1,
            [one, other] => part.oriented &= one.rises() != other.rises(),
            _ => part.manifold = false,
        }
    }

    // Corners by vertex and component: each pair of these is a vertex of the component, and should be one fan.
    let mut place_of = vec![0u32; 3 * mesh.triangles().len()];
    let mut place = 0u32;
    let mut at_vertex: Vec<[u32; 3]> = Vec::new();
    for (vertex, corners) in at_vertices.groups() {
        let fans = fans(mesh, corners);
        at_vertex.clear();
        let places = corners.iter().zip(&fans);
        at_vertex.extend(places.map(|(&corner, &fan)| [number[corner as usize / 3], fan, corner]));
        at_vertex.sort_unstable();
        let mut all = 0;
        for at_place in at_vertex.chunk_by(|a, b| a[0] == b[0]) {
            let own = at_place.chunk_by(|a, b| a[1] == b[1]).count();
            let part = &mut found.components[at_place[0][0] as usize];
            part.vertices += 1;
            part.manifold &= own == 1;
            at_place.iter().for_each(|&[_, _, corner]| place_of[corner as usize] = place);
            place += 1;
            all += own;
        }
        found.vertices += 1;
        found.non_manifold_vertices += usize::from(all > 1 || crowded[vertex]);
    }
    found.unreferenced_vertices = mesh.vertices().len() - found.vertices;

    if found.boundary_edges > 0 {
        found.boundary_loops = loops(mesh, &sides);
        loops_of_components(&mut found, &sides, &number, (&place_of, place as usize));
    }

    found.conclude();
    found
}

/// The topology of a mesh without degenerate triangles all of whose vertices are round: it is closed, a surface, and turned alike, so
/// that counts alone are wanted. Two triangles on the same vertices are a component of their own.
fn closed_surface(mesh: &TriangleMesh<'_>) -> Topology {
    let all = mesh.triangles();
    let mut sets = UnionFind::new(mesh.vertices().len());
    for &[a, b, c] in all {
        sets.join(a, b, false);
        sets.join(b, c, false);
    }
    let mut found =
        Topology { triangles: all.len(), edges: all.len() * 3 / 2, ..Topology::default() };
    // Of each least vertex the number of its component.
    let mut number = vec![u32::MAX; mesh.vertices().len()];
    for (t, triangle) in (0u32..).zip(all) {
        let own = &mut number[sets.root(triangle[0]) as usize];
        if *own == u32::MAX {
            *own = found.components.len() as u32;
            found.components.push(Component::beginning_with(t));
        }
        found.components[*own as usize].triangles += 1;
    }
    for vertex in 0..mesh.vertices().len() as u32 {
        if let Some(part) = found.components.get_mut(number[sets.root(vertex) as usize] as usize) {
            part.vertices += 1;
        }
    }
    for part in &mut found.components {
        part.edges = part.triangles * 3 / 2;
        found.vertices += part.vertices;
        found.duplicate_triangles += usize::from(part.triangles == 2);
    }
    found.unreferenced_vertices = mesh.vertices().len() - found.vertices;
    found.conclude();
    found
}

impl Topology {
    /// Draws the conclusions from the counts.
    fn conclude(&mut self) {
        self.components.iter_mut().for_each(Component::conclude);
        self.euler_characteristic = euler(self.vertices, self.edges, self.triangles);
        let genera = self.components.iter().map(|part| part.genus.filter(|_| part.orientable));
        self.genus = genera.into_iter().try_fold(0, |sum, genus| Some(sum + genus?));
    }
}

impl Component {
    fn beginning_with(first_triangle: u32) -> Self {
        Self {
            first_triangle,
            vertices: 0,
            edges: 0,
            triangles: 0,
            boundary_edges: 0,
            boundary_loops: 0,
            euler_characteristic: 0,
            manifold: true,
            closed: true,
            orientable: true,
            oriented: true,
            genus: None,
        }
    }

    /// Draws the conclusions from the counts.
    fn conclude(&mut self) {
        self.euler_characteristic = euler(self.vertices, self.edges, self.triangles);
        self.closed = self.boundary_edges == 0;
        // On a surface this is a whole number from 0 on, and even if there are two sides.
        let lacking = 2 - self.boundary_loops as i64 - self.euler_characteristic;
        let caps = if self.orientable { lacking / 2 } else { lacking };
        self.genus = self.manifold.then_some(caps.unsigned_abs());
    }
}

fn euler(vertices: usize, edges: usize, triangles: usize) -> i64 {
    vertices as i64 - edges as i64 + triangles as i64
}

/// A side of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// Its vertices, the lower one first.
    ends: [u32; 2],
    /// The corners at the two, each three times the triangle and 0, 1 or 2.
    low: u32,
    high: u32,
}

impl Side {
    fn triangle(&self) -> u32 {
        self.low / 3
    }

    /// Returns true if the triangle runs along it from the lower vertex to the higher one.
    fn rises(&self) -> bool {
        (self.low + 1) % 3 == self.high % 3
    }
}

/// The sides of all triangles with three different vertices, edge by edge.
struct Sides {
    sorted: Vec<Side>,
    /// These triangles in order.
    kept: Vec<u32>,
}

impl Sides {
    fn of(mesh: &TriangleMesh<'_>) -> Self {
        let all = mesh.triangles();
        let kept: Vec<u32> = (0..all.len() as u32).filter(|&t| !repeats(all[t as usize])).collect();
        let sides = || {
            kept.iter().flat_map(|&t| {
                let triangle = all[t as usize];
                (0..3).map(move |k| {
                    let next = (k + 1) % 3;
                    let (from, to) = (triangle[k], triangle[next]);
                    let (k, next) = (3 * t + k as u32, 3 * t + next as u32);
                    let (low, high) = if from < to { (k, next) } else { (next, k) };
                    (from.min(to), Side { ends: [from.min(to), from.max(to)], low, high })
                })
            })
        };
        let mut grouped = Grouped::of(mesh.vertices().len(), sides);
        grouped.groups_mut(|sides| sides.sort_unstable());
        Self { sorted: grouped.all, kept }
    }

    fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.sorted.chunk_by(|a, b| a.ends == b.ends)
    }
}

/// The corners of all triangles with three different vertices, with these.
fn corners(mesh: &TriangleMesh<'_>) -> impl Iterator<Item = (u32, u32)> {
    let kept = (0u32..).zip(mesh.triangles()).filter(|(_, triangle)| !repeats(**triangle));
    kept.flat_map(|(t, triangle)| (0..3).map(move |k| (triangle[k], 3 * t + k as u32)))
}

/// By vertex, whether its triangles are one closed fan that runs round in one direction, as within a surface: then they are of one
/// component, and its edges have two triangles each.
fn round(mesh: &TriangleMesh<'_>, at_vertices: &Grouped<u32>) -> Vec<bool> {
    let mut is_round = vec![false; mesh.vertices().len()];
    let mut link = Vec::new();
    for (vertex, corners) in at_vertices.groups() {
        link.clear();
        link.extend(corners.iter().map(|&corner| opposite(mesh, corner)));
        is_round[vertex] = is_cycle(&link);
    }
    is_round
}

/// The side opposite a corner, as the triangle runs along it.
fn opposite(mesh: &TriangleMesh<'_>, corner: u32) -> [u32; 2] {
    let triangle = mesh.triangles()[corner as usize / 3];
    let k = corner as usize % 3;
    [triangle[(k + 1) % 3], triangle[(k + 2) % 3]]
}

/// Tests whether a walk along the sides of a link comes back by all of them. A longer link than most have is not looked at.
fn is_cycle(link: &[[u32; 2]]) -> bool {
    const LINEAR_SEARCH_MAX: usize = 24;
    if link.len() > LINEAR_SEARCH_MAX {
        return false;
    }
    let [first, mut at] = link[0];
    let mut length = 1;
    while at != first && length <= link.len() {
        let Some(next) = link.iter().find(|side| side[0] == at) else { return false };
        at = next[1];
        length += 1;
    }
    // Where a vertex is passed twice, the walk takes the same way out again and misses the other.
    length == link.len()
}

/// For each corner at a vertex its fan: the first of the corners that hang together with it by edges.
fn fans(mesh: &TriangleMesh<'_>, corners: &[u32]) -> Vec<u32> {
    let mut ends: Vec<(u32, u32)> = Vec::with_capacity(2 * corners.len());
    for (place, &corner) in (0..).zip(corners) {
        ends.extend(opposite(mesh, corner).map(|end| (end, place)));
    }
    ends.sort_unstable();
    let mut sets = UnionFind::new(corners.len());
    for pair in ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        sets.join(pair[0].1, pair[1].1, false);
    }
    (0..corners.len() as u32).map(|place| sets.root(place)).collect()
}

/// Counts the loops of each component over its own vertices, which are places of corners.
fn loops_of_components(
    found: &mut Topology,
    sides: &Sides,
    number: &[u32],
    (place_of, places): (&[u32], usize),
) {
    let mut loop_of = UnionFind::new(places);
    let bare = |edge: &&[Side]| edge.len() == 1;
    for edge in sides.edges().filter(bare) {
        let (one, other) = (place_of[edge[0].low as usize], place_of[edge[0].high as usize]);
        loop_of.join(one, other, false);
    }
    let mut seen = vec![false; places];
    for edge in sides.edges().filter(bare) {
        let root = loop_of.root(place_of[edge[0].low as usize]);
        let new = !std::mem::replace(&mut seen[root as usize], true);
        let component = number[edge[0].triangle() as usize];
        found.components[component as usize].boundary_loops += usize::from(new);
    }
}

/// Returns what edges say: counts, the triangles by component, triangles of components that cannot be turned right, and which vertices are ends of
/// an edge of more than two triangles.
fn edges(mesh: &TriangleMesh<'_>, sides: &Sides) -> (Topology, UnionFind, Vec<u32>, Vec<bool>) {
    let mut found = Topology {
        triangles: sides.kept.len(),
        degenerate_triangles: mesh.triangles().len() - sides.kept.len(),
        ..Topology::default()
    };
    let mut sets = UnionFind::new(mesh.triangles().len());
    let mut one_sided: Vec<u32> = Vec::new();
    // Triangles at an edge of more than two say nothing about how they are to be turned.
    let mut together: Vec<[u32; 2]> = Vec::new();
    let mut crowded = vec![false; mesh.vertices().len()];
    for edge in sides.edges() {
        found.edges += 1;
        match edge {
            [_] => found.boundary_edges += 1,
            [one, other] => {
                let alike = one.rises() == other.rises();
                found.inconsistent_edges += usize::from(alike);
                if !sets.join(one.triangle(), other.triangle(), alike) {
                    one_sided.push(one.triangle());
                }
            }
            _ => {
                found.non_manifold_edges += 1;
                edge[0].ends.iter().for_each(|&end| crowded[end as usize] = true);
                together
                    .extend(edge.windows(2).map(|pair| [pair[0].triangle(), pair[1].triangle()]));
            }
        }
        if edge.len() > 1 {
            found.duplicate_triangles += duplicates(mesh, edge);
        }
    }
    // From here on only who is with whom counts.
    for [one, other] in together {
        sets.join(one, other, false);
    }
    (found, sets, one_sided, crowded)
}

/// Returns how many of the triangles at an edge have the vertices of one before them, if the edge has the lowest two.
fn duplicates(mesh: &TriangleMesh<'_>, edge: &[Side]) -> usize {
    let [low, high] = edge[0].ends;
    let third = |side: &Side| {
        let [a, b, c] = mesh.triangles()[side.triangle() as usize];
        a ^ b ^ c ^ low ^ high
    };
    if let [one, other] = edge {
        return usize::from(third(one) > high && third(one) == third(other));
    }
    let mut thirds: Vec<u32> = edge.iter().map(third).filter(|&third| third > high).collect();
    let all = thirds.len();
    thirds.sort_unstable();
    thirds.dedup();
    all - thirds.len()
}

/// The boundary loops, by their least vertices.
fn loops(mesh: &TriangleMesh<'_>, sides: &Sides) -> Vec<BoundaryLoop> {
    let bare = || sides.edges().filter(|edge| edge.len() == 1).map(|edge| edge[0].ends);
    let mut sets = UnionFind::new(mesh.vertices().len());
    let mut degree = vec![0u32; mesh.vertices().len()];
    for [a, b] in bare() {
        sets.join(a, b, false);
        degree[a as usize] += 1;
        degree[b as usize] += 1;
    }
    let mut found: Vec<BoundaryLoop> = Vec::new();
    let mut number = vec![0u32; mesh.vertices().len()];
    // The root of a set is its least vertex, and edges come in the order of their lower ends: a loop is met there first.
    for [a, b] in bare() {
        let root = sets.root(a);
        if a == root && found.last().is_none_or(|last| last.first_vertex != root) {
            number[root as usize] = found.len() as u32;
            found.push(BoundaryLoop { first_vertex: root, edges: 0, length: 0.0, simple: true });
        }
        let own = &mut found[number[root as usize] as usize];
        own.edges += 1;
        own.length += distance(mesh.vertices()[a as usize], mesh.vertices()[b as usize]);
        own.simple &= degree[a as usize] == 2 && degree[b as usize] == 2;
    }
    found
}

/// The distance of two points of whatever size.
fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1]).hypot(b[2] - a[2])
}

#[cfg(test)]
mod tests;
