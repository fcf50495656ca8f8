//! A tree of triangles that stores, for each direction, the least height of the triangles below each node.

use std::ops::Range;
use std::sync::Arc;

use taut_points::OrderBy;

use super::clip::{self, Scratch, TOUCH};
use super::directions::{Directions, Offsets, opposite};
use super::scene::{Insides, MESH, WALL};
use super::segment;
use super::vectors::{dot, minus, nearest};

/// Triangles of a leaf, at most. With the cost of a clipped triangle at about ten times that of a node, 2 to 8 differ little.
const LEAF_TRIANGLES_MAX: usize = 4;

/// Nodes for which the stack of an event has room from the start: a tree of 2³² triangles has at most as many at once.
const STACK_NODES: usize = 32;

/// A node: its triangles are `first..end` in the order of the tree. An inner node has its lower child next to it.
struct Node {
    first: u32,
    end: u32,
    /// The second child; 0 for a leaf.
    other: u32,
}

/// The lower and the upper corner of the bounding box of the triangles of a node.
type Bounds = [[i32; 3]; 2];

/// Triangles in an order in which neighbors are near each other.
pub(super) struct Tree {
    pub(super) directions: Arc<Directions>,
    nodes: Arc<Vec<Node>>,
    /// One for each node; apart from the nodes, as events need none.
    bounds: Arc<Vec<Bounds>>,
    /// For each node the least uⱼ·x of its triangles, direction by direction.
    node_heights: Vec<i32>,
    /// For each triangle the least uⱼ·x.
    heights: Vec<i32>,
    pub(super) corners: Arc<Vec<[[i32; 3]; 3]>>,
    /// The row of each triangle.
    pub(super) rows: Arc<Vec<u32>>,
    /// The surface of each triangle, by its number in a [`Scene`](super::scene::Scene).
    pub(super) surfaces: Arc<Vec<i32>>,
    /// The box of the triangles of the mesh, without obstacles.
    mesh_bounds: Bounds,
}

/// How far a facet can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Event {
    pub(super) height: i32,
    /// The triangle that stops it there, by its place in the order of the tree, if one does.
    pub(super) stop: Option<u32>,
}

/// The parts of a node.
pub(super) enum Parts {
    Nodes([u32; 2]),
    Triangles(Range<usize>),
}

impl Tree {
    /// Builds the tree of the triangles of a mesh, of which there is at least one.
    #[cfg(test)]
    pub(super) fn new(triangles: &[[[i32; 3]; 3]], directions: &Arc<Directions>) -> Self {
        Tree::of_surfaces(triangles, &vec![MESH; triangles.len()], directions)
    }

    /// Builds the tree of triangles, of which there is at least one, each with the number of its surface.
    pub(super) fn of_surfaces(
        triangles: &[[[i32; 3]; 3]],
        surfaces: &[i32],
        directions: &Arc<Directions>,
    ) -> Self {
        let center = |(row, [a, b, c]): (usize, &[[i32; 3]; 3])| Centered {
            center: [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]],
            row: row as u32,
        };
        let mut order: Vec<Centered> = triangles.iter().enumerate().map(center).collect();
        let mut nodes = vec![];
        split(&mut nodes, &mut order, 0);
        let rows: Vec<u32> = order.iter().map(|item| item.row).collect();
        let corners: Vec<_> = rows.iter().map(|&row| triangles[row as usize]).collect();
        let bounds = bounds_of(&nodes, &corners);
        let mesh = triangles.iter().zip(surfaces).filter(|&(_, &surface)| surface == MESH);
        let mesh_bounds = box_of(mesh.flat_map(|(triangle, _)| triangle).copied());
        let shape = Tree {
            directions: Arc::clone(directions),
            nodes: Arc::new(nodes),
            bounds: Arc::new(bounds),
            node_heights: vec![],
            heights: vec![],
            corners: Arc::new(corners),
            surfaces: Arc::new(rows.iter().map(|&row| surfaces[row as usize]).collect()),
            rows: Arc::new(rows),
            mesh_bounds,
        };
        shape.turned(directions)
    }

    /// Builds the tree of the same triangles for other directions.
    pub(super) fn turned(&self, directions: &Arc<Directions>) -> Self {
        let (nodes, corners) = (&self.nodes, &self.corners);
        let k = directions.len();
        let mut heights = Vec::with_capacity(k * corners.len());
        for &[a, b, c] in corners.iter() {
            let height = |j, p| directions.along(j, p) as i32;
            heights.extend((0..k).map(|j| height(j, a).min(height(j, b)).min(height(j, c))));
        }
        let mut node_heights = vec![i32::MAX; k * nodes.len()];
        // Children come after their parents.
        for at in (0..nodes.len()).rev() {
            let node: &Node = &nodes[at];
            for j in 0..k {
                node_heights[at * k + j] = match node.other {
                    0 => {
                        let triangles = node.first as usize..node.end as usize;
                        triangles.map(|t| heights[t * k + j]).min().unwrap_or(i32::MAX)
                    }
                    other => {
                        node_heights[(at + 1) * k + j].min(node_heights[other as usize * k + j])
                    }
                };
            }
        }
        Tree {
            directions: Arc::clone(directions),
            nodes: Arc::clone(nodes),
            bounds: Arc::clone(&self.bounds),
            node_heights,
            heights,
            corners: Arc::clone(corners),
            rows: Arc::clone(&self.rows),
            surfaces: Arc::clone(&self.surfaces),
            mesh_bounds: self.mesh_bounds,
        }
    }

    /// The parts of a node; the root is node 0.
    pub(super) fn parts(&self, at: u32) -> Parts {
        let node = &self.nodes[at as usize];
        match node.other {
            0 => Parts::Triangles(node.first as usize..node.end as usize),
            other => Parts::Nodes([at + 1, other]),
        }
    }

    /// The center and the half sides of the box of a node.
    pub(super) fn bounds(&self, at: u32) -> [[f64; 3]; 2] {
        center_and_half(self.bounds[at as usize])
    }

    /// The center and the half sides of the box of the mesh, without obstacles.
    pub(super) fn mesh_bounds(&self) -> [[f64; 3]; 2] {
        center_and_half(self.mesh_bounds)
    }

    /// The lower and the upper corner of the box of the mesh, without obstacles.
    pub(super) fn corners_of_mesh_bounds(&self) -> Bounds {
        self.mesh_bounds
    }

    /// The largest uᵢ·x of all triangles.
    pub(super) fn extent(&self, i: usize) -> i32 {
        -self.node_heights[opposite(i)]
    }

    /// Returns how far facet i of an empty body can move outward, at most to `most`: the event.
    ///
    /// `guess` is a triangle that is tried first, for example the one that stopped the facet before; it saves time and does not
    /// change the event.
    pub(super) fn event(&self, i: usize, h: &Offsets, most: i32, guess: Option<u32>) -> Event {
        let k = self.directions.len();
        let mut scratch = Scratch::default();
        let mut found = Event { height: most, stop: None };
        let mut limits = *h;
        limits[i] = most;
        let mut lower = |t: usize, limits: &mut Offsets, found: &mut Event| {
            let heights = &self.heights[t * k..][..k];
            if reaches(heights, limits) {
                let corners = self.corners[t].map(|p| p.map(f64::from));
                let lowest = clip::lowest(&corners, heights, i, h, &self.directions, &mut scratch);
                let height = lowest.map_or(most, |height| (height + TOUCH).floor() as i32);
                if height < found.height {
                    *found = Event { height, stop: Some(t as u32) };
                    limits[i] = height;
                }
            }
        };
        if let Some(t) = guess {
            lower(t as usize, &mut limits, &mut found);
        }
        let reaches_node =
            |at: u32, limits: &Offsets| reaches(&self.node_heights[at as usize * k..][..k], limits);
        let mut stack = Vec::with_capacity(STACK_NODES);
        if reaches_node(0, &limits) {
            stack.push(0u32);
        }
        while found.height > h[i]
            && let Some(at) = stack.pop()
        {
            // Since the node came onto the stack only the limit of facet i has changed.
            let height = |node: u32| self.node_heights[node as usize * k + i];
            if height(at) >= limits[i] {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.other > 0 {
                let (one, two) = (at + 1, node.other);
                let is_nearer = height(one) <= height(two);
                for child in if is_nearer { [two, one] } else { [one, two] } {
                    if reaches_node(child, &limits) {
                        stack.push(child);
                    }
                }
                continue;
            }
            for t in node.first as usize..node.end as usize {
                lower(t, &mut limits, &mut found);
            }
        }
        Event { height: found.height.max(h[i]), ..found }
    }

    /// Calls a function for each triangle that no single facet separates from a body, until it returns false.
    pub(super) fn near(&self, h: &Offsets, mut each: impl FnMut(usize) -> bool) -> bool {
        let k = self.directions.len();
        self.walk(
            |at| reaches(&self.node_heights[at * k..][..k], h),
            |t| !reaches(&self.heights[t * k..][..k], h) || each(t),
        )
    }

    /// Whether a point of the grid is in the mesh and in no solid, by the parity of crossings of a ray upward; `None` for a point on a
    /// triangle.
    pub(super) fn is_inside(&self, p: [i32; 3]) -> Option<bool> {
        let mut insides = Insides::default();
        let is_off = self.column(p, |t| {
            let [a, b, c] = self.corners[t].map(|q| [0, 1, 2].map(|k| i128::from(q[k] - p[k])));
            let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let n = cross(minus(b, a), minus(c, a));
            // The point of the plane above p is at the height n·a / n_z.
            let height = (n[0] * a[0] + n[1] * a[1] + n[2] * a[2]).signum() * n[2].signum();
            if height > 0 {
                insides.cross(self.surfaces[t]);
            }
            height != 0
        });
        is_off.then(|| insides.is_free())
    }

    /// The heights at which the vertical line through a point of the grid crosses surfaces, ascending, and their numbers; without walls.
    pub(super) fn crossings(&self, x: i32, y: i32) -> Vec<(f64, i32)> {
        let mut heights = vec![];
        self.column([x, y, 0], |t| {
            if self.surfaces[t] == WALL {
                return true;
            }
            let [a, b, c] = self.corners[t]
                .map(|q| [f64::from(q[0] - x), f64::from(q[1] - y), f64::from(q[2])]);
            let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let (u, v) = (minus(b, a), minus(c, a));
            let n =
                [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            heights.push((a[2] + (n[0] * a[0] + n[1] * a[1]) / n[2], self.surfaces[t]));
            true
        });
        heights.order_by(&|one, other| one.0.total_cmp(&other.0));
        heights
    }

    /// Calls a function for each triangle that the vertical line through (x + ε, y + ε²) crosses, until it returns false.
    fn column(&self, p: [i32; 3], mut each: impl FnMut(usize) -> bool) -> bool {
        self.walk(
            |at| {
                let [low, high] = self.bounds[at];
                low[0] <= p[0] && high[0] >= p[0] && low[1] <= p[1] && high[1] >= p[1]
            },
            |t| {
                let [a, b, c] = &self.corners[t];
                let is_crossed = passes(p, a, b) ^ passes(p, b, c) ^ passes(p, c, a);
                !is_crossed || each(t)
            },
        )
    }

    /// The squared distance from a point to the nearest triangle.
    pub(super) fn squared_distance(&self, p: [i32; 3]) -> f64 {
        let p = p.map(f64::from);
        self.least(
            |bounds| squared_distance_to_box(p, bounds),
            |corners| squared_distance(p, corners),
        )
    }

    /// The distance from a segment to the nearest triangle, within some 10⁻⁶ of its length.
    pub(super) fn clearance(&self, ends: [[i32; 3]; 2]) -> f64 {
        let ends = ends.map(|end| end.map(f64::from));
        let squared = self.least(
            |bounds| segment::least(ends, |p| squared_distance_to_box(p, bounds)).0,
            |corners| segment::least(ends, |p| squared_distance(p, corners)).0,
        );
        squared.sqrt()
    }

    /// The least of a function on triangles, by a lower bound for those in a box.
    fn least(
        &self,
        of_box: impl Fn([[f64; 3]; 2]) -> f64,
        of_triangle: impl Fn(&[[f64; 3]; 3]) -> f64,
    ) -> f64 {
        let of_node = |at: usize| of_box(self.bounds[at].map(|corner| corner.map(f64::from)));
        let mut least = f64::INFINITY;
        let mut stack = vec![(0, of_node(0))];
        while let Some((at, bound)) = stack.pop() {
            let node = &self.nodes[at];
            if bound >= least {
                continue;
            }
            if node.other > 0 {
                let mut children = [at + 1, node.other as usize].map(|at| (at, of_node(at)));
                if children[0].1 <= children[1].1 {
                    children.swap(0, 1);
                }
                stack.extend(children);
                continue;
            }
            for corners in &self.corners[node.first as usize..node.end as usize] {
                least = least.min(of_triangle(&corners.map(|q| q.map(f64::from))));
            }
        }
        least
    }

    /// Visits the leaves below nodes that pass a test, until `each` returns false for a triangle; returns whether it never did.
    fn walk(&self, passes: impl Fn(usize) -> bool, mut each: impl FnMut(usize) -> bool) -> bool {
        let mut stack = vec![0usize];
        while let Some(at) = stack.pop() {
            if !passes(at) {
                continue;
            }
            let node = &self.nodes[at];
            match node.other {
                0 => {
                    for t in node.first as usize..node.end as usize {
                        if !each(t) {
                            return false;
                        }
                    }
                }
                other => stack.extend([other as usize, at + 1]),
            }
        }
        true
    }
}

/// Whether all heights are below their limits: no facet alone keeps the triangles out. Without a branch for each, as most of the
/// comparisons go either way.
pub(super) fn reaches(heights: &[i32], limits: &Offsets) -> bool {
    heights.iter().zip(limits).fold(true, |all, (height, limit)| all & (height < limit))
}

/// A triangle by three times its center, and its row.
#[derive(Clone, Copy)]
struct Centered {
    center: [i32; 3],
    row: u32,
}

/// Splits triangles at the median along the axis in which their centers spread most, and appends the nodes.
fn split(nodes: &mut Vec<Node>, items: &mut [Centered], first: u32) {
    let at = nodes.len();
    let end = first + items.len() as u32;
    nodes.push(Node { first, end, other: 0 });
    if items.len() <= LEAF_TRIANGLES_MAX {
        return;
    }
    let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
    for item in items.iter() {
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(item.center[c]), high[c].max(item.center[c]));
        }
    }
    let spread = |axis: usize| i64::from(high[axis]) - i64::from(low[axis]);
    let axis = (0..3).max_by_key(|&axis| spread(axis)).unwrap_or(0);
    let middle = items.len() / 2;
    // One number for the comparison: by center, then by row.
    let key = |item: &Centered| (i64::from(item.center[axis]) << 32) | i64::from(item.row);
    items.select_nth_unstable_by_key(middle, key);
    let (lower, upper) = items.split_at_mut(middle);
    split(nodes, lower, first);
    nodes[at].other = nodes.len() as u32;
    split(nodes, upper, first + middle as u32);
}

/// The center and the half sides of a box.
fn center_and_half(bounds: Bounds) -> [[f64; 3]; 2] {
    let [low, high] = bounds.map(|corner| corner.map(f64::from));
    let along = |part: fn(f64, f64) -> f64| [0, 1, 2].map(|c| part(low[c], high[c]));
    [along(|low, high| (low + high) / 2.0), along(|low, high| (high - low) / 2.0)]
}

/// The box that holds two boxes.
fn joined([low, high]: Bounds, [other_low, other_high]: Bounds) -> Bounds {
    let along =
        |p: [i32; 3], q: [i32; 3], pick: fn(i32, i32) -> i32| [0, 1, 2].map(|c| pick(p[c], q[c]));
    [along(low, other_low, i32::min), along(high, other_high, i32::max)]
}

/// The box of points; of none that of the origin.
fn box_of(points: impl Iterator<Item = [i32; 3]>) -> Bounds {
    points.map(|p| [p, p]).reduce(joined).unwrap_or([[0; 3]; 2])
}

/// The bounding boxes of the triangles of nodes. Children come after their parents.
fn bounds_of(nodes: &[Node], corners: &[[[i32; 3]; 3]]) -> Vec<Bounds> {
    let mut bounds = vec![[[0; 3]; 2]; nodes.len()];
    for (at, node) in nodes.iter().enumerate().rev() {
        bounds[at] = match node.other {
            0 => {
                let own = &corners[node.first as usize..node.end as usize];
                box_of(own.as_flattened().iter().copied())
            }
            other => joined(bounds[at + 1], bounds[other as usize]),
        };
    }
    bounds
}

/// Whether the edge between two corners, seen from above, passes at the x of the point beyond its y, for the point moved by
/// (ε, ε²).
fn passes(p: [i32; 3], a: &[i32; 3], b: &[i32; 3]) -> bool {
    if (a[0] > p[0]) == (b[0] > p[0]) {
        return false;
    }
    let [a, b] = if a[0] < b[0] { [a, b] } else { [b, a] };
    let minus = |p: i32, q: i32| i64::from(p) - i64::from(q);
    let (dx, dy) = (minus(b[0], a[0]), minus(b[1], a[1]));
    // The height of the edge above the point, times dx; at 0 the point is moved along by ε, then up by ε².
    match dy * minus(p[0], a[0]) - dx * minus(p[1], a[1]) {
        0 => dy > 0,
        above => above > 0,
    }
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The squared distance from a point to a triangle.
pub(super) fn squared_distance(p: [f64; 3], corners: &[[f64; 3]; 3]) -> f64 {
    let off = nearest(corners.map(|corner| minus(corner, p)));
    dot(off, off)
}

/// The squared distance from a point to the box between two corners.
fn squared_distance_to_box(p: [f64; 3], [low, high]: [[f64; 3]; 2]) -> f64 {
    let off = [0, 1, 2].map(|c| (low[c] - p[c]).max(p[c] - high[c]).max(0.0));
    dot(off, off)
}
