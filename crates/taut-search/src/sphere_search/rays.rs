//! Rows that a ray meets: each with the distance along the ray at which it enters the ball around the row.
//!
//! *Idea.* With m from the origin to a center and the direction u of length 1, t = m·u is the point of the line nearest to the center
//! and |m − tu| its distance; this cancels less than |m|² − t². The balls of eight nodes are tested at once.
//! *Guarantee.* A row is met if the distance as calculated is at most its radius; of equal entries the lowest row is first. Balls
//! of nodes are widened by more than all roundings, so that none is left out that holds a row which is met.
//! *Trap.* Where squares would overflow or vanish, all coordinates are scaled by a power of two, so that the largest is about 1:
//! what is smaller than 10⁻¹⁵⁰ of that has no size.

use std::cmp::Ordering;

use taut_points::{exponent_of, two_to};

use super::batch::{Query, Work};
use super::dim::Dim;
use super::measure::{Measure, is_plain};
use super::nodes::{FANOUT, Lanes, NO_ROW};
use super::{Neighbor, SphereSearch};

/// The rows that each ray meets, or the first of them.
pub(super) struct FindHits {
    /// The radius of a point, or what is added to the radius of a ball.
    pub(super) hit_radius: f64,
    pub(super) first_only: bool,
}

/// A ray in the units of a search.
struct Ray<'a> {
    origin: &'a [f64],
    /// Of length 1.
    direction: Vec<f64>,
    /// The power of two that coordinates are multiplied by.
    scale: f64,
    /// Relative widening of the ball of a node, above all roundings.
    slack: f64,
}

/// The line through a ray nearest to centers: where along the ray, and how far away.
#[derive(Clone, Copy)]
struct Approach<const L: usize> {
    along: [f64; L],
    away: [f64; L],
}

impl<'a> Ray<'a> {
    fn of(tree: &SphereSearch, query: &'a [f64], hit_radius: f64) -> Self {
        let (origin, direction) = query.split_at(tree.dim());
        let sizes = origin.iter().chain([&tree.size, &hit_radius]);
        let size = sizes.fold(0.0, |size: f64, x| size.max(x.abs()));
        let is_plain = tree.is_plain && is_plain(origin);
        let exponent = exponent_of(size).clamp(-1000, 1000);
        let scale = if is_plain { 1.0 } else { two_to(-exponent) };
        let longest = direction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        // Halves, as the quotient of a number that is not normal may be off by as much as it is.
        let half = direction.iter().map(|x| x / longest).collect::<Vec<_>>();
        let norm = half.iter().map(|x| x * x).sum::<f64>().sqrt();
        let direction = half.iter().map(|x| x / norm).collect();
        let slack = (tree.dim() as f64 + 16.0) * 4.0 * f64::EPSILON;
        Ray { origin, direction, scale, slack }
    }

    /// The approach to the centers in columns.
    #[inline(always)]
    fn approach<D: Dim, const L: usize>(&self, dim: D, columns: &[Lanes<L>]) -> Approach<L> {
        let scale = self.scale;
        let mut along = [0.0; L];
        for axis in 0..dim.get() {
            let (origin, u) = (self.origin[axis] * scale, self.direction[axis]);
            for lane in 0..L {
                along[lane] += (columns[axis][lane] * scale - origin) * u;
            }
        }
        let mut squares = [0.0; L];
        for axis in 0..dim.get() {
            let (origin, u) = (self.origin[axis] * scale, self.direction[axis]);
            for lane in 0..L {
                let away = (columns[axis][lane] * scale - origin) - along[lane] * u;
                squares[lane] += away * away;
            }
        }
        let mut away = squares;
        for lane in 0..L {
            away[lane] = squares[lane].sqrt();
        }
        Approach { along, away }
    }
}

impl<const L: usize> Approach<L> {
    /// Where the ray enters and leaves a ball; `None` if it does not meet it.
    #[inline(always)]
    fn within(&self, lane: usize, radius: f64) -> Option<f64> {
        let (along, away) = (self.along[lane], self.away[lane]);
        if away > radius {
            return None;
        }
        let half = ((radius - away) * (radius + away)).sqrt();
        let leaves = along + half >= 0.0;
        leaves.then_some(if along > half { along - half } else { 0.0 })
    }
}

/// A node that the ray may meet, from where on.
#[derive(Clone, Copy)]
pub(super) struct Pending {
    entry: f64,
    level: u32,
    node: u32,
}

impl Work for FindHits {
    type Found = Vec<Neighbor>;
    type Kept<M: Measure> = Vec<Pending>;

    #[inline(always)]
    fn answer<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        Query { values: query, .. }: Query<'_>,
        stack: &mut Vec<Pending>,
    ) -> Vec<Neighbor> {
        let nodes = &tree.nodes;
        let ray = Ray::of(tree, query, self.hit_radius);
        let mut found: Vec<(f64, u32)> = vec![];
        stack.clear();
        stack.push(Pending { entry: 0.0, level: nodes.root_level(), node: 0 });
        while let Some(here) = stack.pop() {
            // Equal entries count, as the row may be lower.
            if self.first_only && found.first().is_some_and(|first| here.entry > first.0) {
                continue;
            }
            if here.level > 0 {
                self.open(tree, dim, &ray, here, stack);
            } else {
                self.offer(tree, dim, &ray, here.node as usize, &mut found);
            }
        }
        found.sort_unstable_by(by_entry_and_row);
        let neighbor = |(entry, row)| Neighbor { row: u64::from(row), distance: entry / ray.scale };
        found.into_iter().map(neighbor).collect()
    }
}

impl FindHits {
    /// Pushes the children of a node that the ray may meet, the first one last.
    #[inline(always)]
    fn open<D: Dim>(
        &self,
        tree: &SphereSearch,
        dim: D,
        ray: &Ray<'_>,
        here: Pending,
        stack: &mut Vec<Pending>,
    ) {
        let (level, group) = (here.level - 1, here.node as usize);
        let below = &tree.nodes.levels[level as usize];
        let approach = ray.approach(dim, below.centers_of(dim, group));
        let first = stack.len();
        for lane in 0..below.width(group) {
            let node = group * FANOUT + lane;
            let row_radius = below.row_radius(node) + self.hit_radius;
            let radius = (below.radii[node] + row_radius) * ray.scale;
            let (along, away) = (approach.along[lane], approach.away[lane]);
            let radius = radius + ray.slack * (radius + along.abs() + away);
            if away <= radius && along + radius >= 0.0 {
                let entry = (along - radius).max(0.0);
                stack.push(Pending { entry, level, node: node as u32 });
            }
        }
        stack[first..].sort_by(|a, b| b.entry.total_cmp(&a.entry));
    }

    #[inline(always)]
    fn offer<D: Dim>(
        &self,
        tree: &SphereSearch,
        dim: D,
        ray: &Ray<'_>,
        block: usize,
        found: &mut Vec<(f64, u32)>,
    ) {
        let columns = tree.nodes.block(dim, block);
        let approach = ray.approach(dim, columns);
        for (lane, &row) in tree.nodes.rows_of(block).iter().enumerate() {
            let radius = (tree.row_radius(block, lane) + self.hit_radius) * ray.scale;
            let Some(entry) = approach.within(lane, radius).filter(|_| row != NO_ROW) else {
                continue;
            };
            match found.first_mut() {
                Some(first) if self.first_only => {
                    if by_entry_and_row(&(entry, row), first) == Ordering::Less {
                        *first = (entry, row);
                    }
                }
                _ => found.push((entry, row)),
            }
        }
    }
}

fn by_entry_and_row(a: &(f64, u32), b: &(f64, u32)) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}
