//! Builds a kd-tree: halves the points along their widest extent until a bucket is left.
//!
//! Idea: the points are carried about with their rows, so that each pass reads memory in order. A node over m buckets
//! gives ⌈m/2⌉ full ones to its left child: all buckets are full but the last, and bucket i starts at place i·32.
//! Guarantee: ⌈log₂ m⌉ levels whatever the points; equal coordinates may be on both sides of a split, which searches know.
//! Trap: splitting by value instead of by number never ends where many points share a coordinate.

use super::{BUCKET_SIZE, IS_BUCKET, KdTree, Node, wide};
use crate::Error;
use crate::layout::{NONE, TreeOrder, permute};
use crate::pages::Pages;

/// Points below which a part is not shared among threads.
const ALONE_BELOW: usize = 1 << 14;

/// A point and its row.
type Item<const D: usize> = ([f64; D], u32);

pub(super) fn build<const D: usize>(
    points: &[[f64; D]],
    order: TreeOrder,
) -> Result<KdTree<D>, Error> {
    const { assert!(D == 2 || D == 3, "the plane and space") };
    if u32::try_from(points.len()).is_err() {
        return Err(Error::Option {
            name: "points",
            value: format!("{} points", points.len()),
            expected: "fewer than 2³² points",
        });
    }
    let mut items: Vec<Item<D>> = Vec::with_capacity(points.len());
    let mut plain = true;
    for (row, &point) in (0u32..).zip(points) {
        if let Some(column) = point.iter().position(|x| !x.is_finite()) {
            return Err(Error::NonFinite { row: u64::from(row), column, value: point[column] });
        }
        plain &= wide::is_plain(point);
        items.push((point, row));
    }
    let buckets = points.len().div_ceil(BUCKET_SIZE);
    // The nodes in pre-order: one less than buckets.
    let mut nodes = vec![Node::default(); buckets.saturating_sub(1)];
    split(&mut items, &mut nodes, 0, 0);
    let laid = laid(&nodes, order)?;
    let root = if laid.is_empty() { IS_BUCKET } else { 0 };
    let mut nodes = Pages::zeroed(laid.len());
    for (words, node) in nodes.words_mut().iter_mut().zip(laid) {
        *words = node.words();
    }
    let mut coordinates = Pages::zeroed(buckets * BUCKET_SIZE * D);
    coordinates.words_mut().fill(f64::INFINITY);
    let mut rows = Pages::zeroed(buckets * BUCKET_SIZE);
    rows.words_mut().fill(u32::MAX);
    for (bucket, items) in items.chunks(BUCKET_SIZE).enumerate() {
        let coordinates =
            &mut coordinates.words_mut()[bucket * BUCKET_SIZE * D..][..BUCKET_SIZE * D];
        let rows = &mut rows.words_mut()[bucket * BUCKET_SIZE..][..BUCKET_SIZE];
        for (i, &(point, row)) in items.iter().enumerate() {
            for (axis, &x) in point.iter().enumerate() {
                coordinates[axis * BUCKET_SIZE + i] = x;
            }
            rows[i] = row;
        }
    }
    Ok(KdTree { nodes, root, coordinates, rows, len: points.len(), plain })
}

/// Splits items until buckets are left; `nodes` are those of the subtree in pre-order, the first of which is number
/// `node` of all, and its first bucket number `bucket`.
fn split<const D: usize>(items: &mut [Item<D>], nodes: &mut [Node], node: u32, bucket: u32) {
    let Some((here, below)) = nodes.split_first_mut() else { return };
    let buckets_left = (below.len() + 2).div_ceil(2);
    let middle = buckets_left * BUCKET_SIZE;
    let axis = widest(items);
    let split_at = |a: &Item<D>, b: &Item<D>| a.0[axis].total_cmp(&b.0[axis]);
    let (_, &mut (point, _), _) = items.select_nth_unstable_by(middle, split_at);
    let (left, right) = items.split_at_mut(middle);
    let (nodes_left, nodes_right) = below.split_at_mut(buckets_left - 1);
    let left_child = (node + 1, bucket);
    let right_child = (node + buckets_left as u32, bucket + buckets_left as u32);
    let link = |nodes: &[Node], (node, bucket): (u32, u32)| {
        if nodes.is_empty() { bucket | IS_BUCKET } else { node }
    };
    let (left_link, right_link) = (link(nodes_left, left_child), link(nodes_right, right_child));
    *here = Node::new(point[axis], axis, left_link, right_link);
    let mut lower = || split(left, nodes_left, left_child.0, left_child.1);
    if middle < ALONE_BELOW {
        lower();
        split(right, nodes_right, right_child.0, right_child.1);
    } else {
        taut_points::parallel::join(lower, || {
            split(right, nodes_right, right_child.0, right_child.1)
        });
    }
}

/// The axis along which points extend farthest, the first of several.
fn widest<const D: usize>(items: &[Item<D>]) -> usize {
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for (point, _) in items {
        for axis in 0..D {
            low[axis] = if point[axis] < low[axis] { point[axis] } else { low[axis] };
            high[axis] = if point[axis] > high[axis] { point[axis] } else { high[axis] };
        }
    }
    // Halves, as an extent may overflow.
    let extent = |axis: usize| high[axis] / 2.0 - low[axis] / 2.0;
    (1..D).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best })
}

/// The nodes in their final order.
fn laid(nodes: &[Node], order: TreeOrder) -> Result<Vec<Node>, Error> {
    let inner = |child: u32| if child & IS_BUCKET == 0 { child } else { NONE };
    let left: Vec<u32> = nodes.iter().map(|node| inner(node.left())).collect();
    let right: Vec<u32> = nodes.iter().map(|node| inner(node.right)).collect();
    let laid = permute(&left, &right, order)?;
    let places = laid.left.iter().zip(&laid.right);
    let moved = laid.order.iter().zip(places).map(|(&old, (&left, &right))| {
        let node = nodes[old as usize];
        let link = |new: u32, old: u32| if new == NONE { old } else { new };
        Node::new(node.split, node.axis(), link(left, node.left()), link(right, node.right))
    });
    Ok(moved.collect())
}
