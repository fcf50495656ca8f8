//! Planes around a center that keep all triangles out.
//!
//! *Idea.* Triangles and obstacles come by their distance from the center in some metric, as Iris does (Deits and Tedrake,
//! Computing large convex regions of obstacle-free space, WAFR 2014). One that no plane keeps out yet gets the plane through its
//! nearest point that touches the ball of the metric there. The tree leaves out what a plane keeps out as a whole.
//! *Guarantee.* Normals and offsets are whole numbers, and all products are exact in `f64`: each triangle is behind one plane.
//! *Trap.* The triangles of a curved surface would each get a plane of its own: a plane moves inward a little where that
//! replaces another one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::super::pack::Segment;
use super::super::polytope::Sides;
use super::super::segment;
use super::super::tree::{Parts, Tree};
use super::super::vectors::{cross, dot, minus, nearest};
use super::metric::Metric;

/// Entries of a normal, at most: a normal is turned by at most about 2⁻¹⁴, and products with coordinates have 39 bits.
const NORMAL_MAX: f64 = 8191.0;

/// Two axes, one of which is not nearly parallel to a direction.
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];

/// The part of its first distance from the center by which a plane may move inward to replace other planes.
const INWARD_PART: f64 = 1.0 / 256.0;

/// The part of its distance from the center by which a plane moves inward at once, at most, where no more planes are allowed.
const FORCED_PART_MAX: f64 = 0.95;

/// A segment that a body has to contain, with each plane at least so many units times the sum |uᵢ|₁ of its normal away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kept {
    pub(super) ends: [[f64; 3]; 2],
    pub(super) margin: f64,
}

/// A convex body that may not be entered.
pub(super) struct Obstacle {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[[f64; 3]; 3]>,
}

/// What may not be entered.
pub(super) struct Blocks<'a> {
    pub(super) tree: &'a Tree,
    pub(super) obstacles: &'a [Obstacle],
}

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Item {
    /// A node, with the number of planes that do not keep it out.
    Node(u32, u16),
    Triangle(u32),
    Obstacle(u32),
}

/// A distance and an item in one number, so that a heap compares them fast: the nearest comes first, of equally near ones the
/// first. Distances are not negative, and their bits have their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(Reverse<u128>);

impl Entry {
    fn new(distance: f64, item: Item) -> Self {
        let (kind, number, tried) = match item {
            Item::Node(at, tried) => (0, at, tried),
            Item::Triangle(t) => (1, t, 0),
            Item::Obstacle(at) => (2, at, 0),
        };
        let item = (kind << 48) | (u64::from(number) << 16) | u64::from(tried);
        Entry(Reverse((u128::from(distance.to_bits()) << 64) | u128::from(item)))
    }

    fn item(self) -> Item {
        let bits = self.0.0 as u64;
        let number = (bits >> 16) as u32;
        match bits >> 48 {
            0 => Item::Node(number, bits as u16),
            1 => Item::Triangle(number),
            _ => Item::Obstacle(number),
        }
    }
}

/// Returns at most `most` planes around the center that no triangle and no obstacle enters, and how often a plane was placed or
/// moved; `None` where there are no such planes, or they would cut off the segment to be kept.
pub(super) fn around(
    blocks: &Blocks<'_>,
    metric: &Metric,
    kept: Option<Kept>,
    most: usize,
) -> (Option<Sides>, u64) {
    let (sides, first) = (Sides::default(), vec![]);
    let mut planes = Planes { sides, first, last: 0, events: 0, metric, kept, most };
    let found = place(blocks, &mut planes);
    (found.map(|()| planes.sides), planes.events)
}

/// Places planes; `None` where this fails.
fn place(blocks: &Blocks<'_>, planes: &mut Planes<'_>) -> Option<()> {
    let (tree, metric) = (blocks.tree, planes.metric);
    let mut heap = BinaryHeap::from([Entry::new(0.0, Item::Node(0, 0))]);
    for (at, obstacle) in blocks.obstacles.iter().enumerate() {
        heap.push(Entry::new(distance(metric, &obstacle.triangles), Item::Obstacle(at as u32)));
    }
    while let Some(entry) = heap.pop() {
        match entry.item() {
            Item::Node(at, tried) => {
                let [center, half] = tree.bounds(at);
                if planes.new_ones_keep_box_out(usize::from(tried), center, half) {
                    continue;
                }
                let tried = planes.first.len() as u16;
                match tree.parts(at) {
                    Parts::Nodes(nodes) => {
                        for node in nodes {
                            let [center, half] = tree.bounds(node);
                            if !planes.keep_box_out(center, half) {
                                let item = Item::Node(node, tried);
                                heap.push(Entry::new(metric.to_box(center, half), item));
                            }
                        }
                    }
                    Parts::Triangles(range) => {
                        for t in range {
                            let corners = tree.corners[t].map(|p| p.map(f64::from));
                            if !planes.keep_out(&corners) {
                                let near = distance(metric, &[corners]);
                                heap.push(Entry::new(near, Item::Triangle(t as u32)));
                            }
                        }
                    }
                }
            }
            Item::Triangle(t) => {
                let corners = tree.corners[t as usize].map(|p| p.map(f64::from));
                if !planes.keep_out(&corners) {
                    planes.add(&[corners], &corners)?;
                }
            }
            Item::Obstacle(at) => {
                let obstacle = &blocks.obstacles[at as usize];
                if !planes.keep_out(&obstacle.vertices) {
                    planes.add(&obstacle.triangles, &obstacle.vertices)?;
                }
            }
        }
    }
    Some(())
}

/// The squared distance from the center to the nearest of some triangles.
fn distance(metric: &Metric, triangles: &[[[f64; 3]; 3]]) -> f64 {
    let near = nearest_of(metric, metric.center, triangles);
    dot(near, near)
}

/// The nearest point of some triangles, mapped, seen from a point.
fn nearest_of(metric: &Metric, from: [f64; 3], triangles: &[[[f64; 3]; 3]]) -> [f64; 3] {
    let points = triangles.iter().map(|t| nearest(t.map(|p| metric.map(minus(p, from)))));
    let nearer = |a: [f64; 3], b: [f64; 3]| if dot(b, b) < dot(a, a) { b } else { a };
    points.reduce(nearer).unwrap_or([f64::INFINITY; 3])
}

/// Planes so far.
struct Planes<'a> {
    sides: Sides,
    /// The first offset of each plane.
    first: Vec<f64>,
    /// The plane that kept something out last: neighbors in the tree are mostly kept out by the same one.
    last: usize,
    /// How often a plane was placed or moved.
    events: u64,
    metric: &'a Metric,
    kept: Option<Kept>,
    most: usize,
}

impl Planes<'_> {
    /// Whether one plane keeps a box out.
    fn keep_box_out(&mut self, center: [f64; 3], half: [f64; 3]) -> bool {
        self.find(|u, offset| is_beyond(u, offset, center, half))
    }

    /// Whether one of the planes after the first ones keeps a box out.
    fn new_ones_keep_box_out(&self, first: usize, center: [f64; 3], half: [f64; 3]) -> bool {
        let normals = self.sides.normals[first..].iter();
        normals.zip(&self.sides.offsets[first..]).any(|(u, &h)| is_beyond(*u, h, center, half))
    }

    /// Whether one plane keeps the convex hull of some points out.
    fn keep_out(&mut self, points: &[[f64; 3]]) -> bool {
        self.find(|u, offset| points.iter().all(|&p| dot(u, p) >= offset))
    }

    fn find(&mut self, keeps_out: impl Fn([f64; 3], f64) -> bool) -> bool {
        let (normals, offsets) = (&self.sides.normals, &self.sides.offsets);
        if normals.get(self.last).is_some_and(|&u| keeps_out(u, offsets[self.last])) {
            return true;
        }
        let found = (0..normals.len()).find(|&j| keeps_out(normals[j], offsets[j]));
        self.last = found.unwrap_or(self.last);
        found.is_some()
    }

    /// Keeps the hull of some points out that no plane keeps out: moves a plane inward, or adds one.
    fn add(&mut self, triangles: &[[[f64; 3]; 3]], points: &[[f64; 3]]) -> Option<()> {
        self.events += 1;
        let least = |u: [f64; 3]| lowest(u, points);
        let center = self.metric.center;
        let inward = |j: usize| {
            let u = self.sides.normals[j];
            let (low, at) = (least(u), dot(u, center));
            ((self.first[j] - low) / (self.first[j] - at), low, j)
        };
        let allowed = |&(_, low, j): &(f64, f64, usize)| self.keeps(self.sides.normals[j], low);
        let moves = (0..self.first.len()).map(inward).filter(allowed);
        let best = moves.min_by(|a, b| a.0.total_cmp(&b.0));
        let is_full = self.first.len() >= self.most;
        let part_max = if is_full { FORCED_PART_MAX } else { INWARD_PART };
        if let Some((part, low, j)) = best
            && part <= part_max
        {
            self.sides.offsets[j] = low;
            return Some(());
        }
        if is_full {
            return None;
        }
        let plane = |from: [f64; 3]| {
            let u = whole(self.metric.normal(nearest_of(self.metric, from, triangles)))?;
            let low = least(u);
            (low > dot(u, from) && self.keeps(u, low)).then_some((u, low))
        };
        // From the point of the segment that is nearest to the triangles a plane keeps them out, if any does.
        let nearest_kept = || {
            let near = |from: [f64; 3]| {
                let off = nearest_of(self.metric, from, triangles);
                dot(off, off)
            };
            self.kept.map(|kept| segment::least(kept.ends, near).1)
        };
        let (u, low) = plane(center).or_else(|| plane(nearest_kept()?))?;
        match self.sides.normals.iter().position(|v| *v == u) {
            Some(j) => self.sides.offsets[j] = low,
            None => {
                self.last = self.first.len();
                self.sides.normals.push(u);
                self.sides.offsets.push(low);
                self.first.push(low);
            }
        }
        Some(())
    }

    /// Whether a plane leaves the segment to be kept in the body, with its margin.
    fn keeps(&self, u: [f64; 3], offset: f64) -> bool {
        let sum = u[0].abs() + u[1].abs() + u[2].abs();
        self.kept.is_none_or(|kept| {
            kept.ends.iter().all(|&end| dot(u, end) + kept.margin * sum <= offset)
        })
    }
}

/// Whether a plane keeps a box out.
fn is_beyond(u: [f64; 3], offset: f64, center: [f64; 3], half: [f64; 3]) -> bool {
    let reach = u[0].abs() * half[0] + u[1].abs() * half[1] + u[2].abs() * half[2];
    dot(u, center) - reach >= offset
}

/// The least value of a linear function on some points, rounded down to a whole number.
fn lowest(u: [f64; 3], points: &[[f64; 3]]) -> f64 {
    points.iter().map(|&p| dot(u, p)).fold(f64::INFINITY, f64::min).floor()
}

/// A normal of whole numbers without common divisor in nearly the direction given; `None` for no direction.
fn whole(normal: [f64; 3]) -> Option<[f64; 3]> {
    let most = normal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let rounded = normal.map(|x| (x / most * NORMAL_MAX).round() as i64);
    let divisor =
        rounded.iter().fold(0, |divisor, &n| super::super::directions::gcd(divisor, n.abs()));
    Some(rounded.map(|n| (n / divisor) as f64))
}

/// The normals of a box along a segment, each with its opposite; `None` for a point.
pub(super) fn box_normals(ends: Segment) -> Option<Vec<[f64; 3]>> {
    let [from, to] = ends.map(|end| end.map(f64::from));
    let along = minus(to, from);
    let across = cross(along, if along[0].abs() <= along[1].abs() { X } else { Y });
    let directions = [along, across, cross(along, across)];
    let mut normals = vec![];
    for direction in directions {
        let u = whole(direction)?;
        normals.extend([u, u.map(|n| 0.0 - n)]);
    }
    Some(normals)
}
