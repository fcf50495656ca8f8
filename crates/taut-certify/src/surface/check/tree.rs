//! A binary tree of boxes over points or triangles of space.
//!
//! *Idea.* The items are halved at the median of the longest side of the box around their centers, again and again; so all leaves are
//! full but the last, and the nodes need no links: node 1 is the root, the children of node i are 2i and 2i + 1.
//! *Trap.* As the number of leaves is a power of two, up to half of them have no items. Their boxes are empty, and comparisons with the
//! infinite ends of those say nothing: such nodes are passed over before the caller is asked. When they were not, a third of the
//! searches for the balls of a surface visited a third of all nodes, which was 85 % of the time of the whole check.

use taut_points::Cancelled;

/// A leaf has at most this many items.
const LEAF_SIZE: usize = 8;

/// From so many items on, the halves of a node may go to two threads.
const SHARED_MIN: usize = 1 << 13;

/// It is asked whether to go on after this many pairs of nodes.
const PAIRS_BETWEEN_ASKS: u32 = 1 << 16;

/// An axis-parallel box: least and largest coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) least: [f64; 3],
    pub(super) most: [f64; 3],
}

impl Area {
    const EMPTY: Area = Area { least: [f64::INFINITY; 3], most: [f64::NEG_INFINITY; 3] };

    pub(super) fn of(points: &[[f64; 3]]) -> Self {
        let mut area = Area::EMPTY;
        for p in points {
            for k in 0..3 {
                area.least[k] = area.least[k].min(p[k]);
                area.most[k] = area.most[k].max(p[k]);
            }
        }
        area
    }

    fn join(&mut self, other: &Area) {
        for k in 0..3 {
            self.least[k] = self.least[k].min(other.least[k]);
            self.most[k] = self.most[k].max(other.most[k]);
        }
    }

    fn is_empty(&self) -> bool {
        self.least[0] > self.most[0]
    }

    #[inline(always)]
    pub(super) fn meets(&self, other: &Area) -> bool {
        (0..3).all(|k| self.least[k] <= other.most[k] && other.least[k] <= self.most[k])
    }

    pub(super) fn corners(&self) -> [[f64; 3]; 8] {
        let end = |corner: usize, k: usize| [self.least, self.most][corner >> k & 1][k];
        std::array::from_fn(|corner| std::array::from_fn(|k| end(corner, k)))
    }

    /// Its middle, but for roundings; halved first, as coordinates may be as large as numbers get.
    fn center(&self, k: usize) -> f64 {
        0.5 * self.least[k] + 0.5 * self.most[k]
    }
}

pub(super) struct Tree {
    /// Items in the order of the leaves, with their boxes.
    order: Vec<u32>,
    items: Vec<Area>,
    nodes: Vec<Area>,
    /// Leaves, a power of two.
    leaves: usize,
}

impl Tree {
    /// Over items with these boxes, none of which is empty.
    pub(super) fn of(areas: &[Area]) -> Self {
        let leaves = areas.len().div_ceil(LEAF_SIZE).next_power_of_two();
        let mut order: Vec<u32> = (0..areas.len() as u32).collect();
        halve(&mut order, leaves, areas);
        let items: Vec<Area> = order.iter().map(|&item| areas[item as usize]).collect();
        let mut nodes = vec![Area::EMPTY; 2 * leaves];
        for (at, item) in items.iter().enumerate() {
            nodes[leaves + at / LEAF_SIZE].join(item);
        }
        for node in (1..leaves).rev() {
            let other = nodes[2 * node + 1];
            nodes[node] = nodes[2 * node];
            nodes[node].join(&other);
        }
        Tree { order, items, nodes, leaves }
    }

    /// Places in `order` of the items of a leaf.
    fn leaf(&self, node: usize) -> std::ops::Range<usize> {
        let first = (node - self.leaves) * LEAF_SIZE;
        first.min(self.order.len())..(first + LEAF_SIZE).min(self.order.len())
    }

    /// The first item, in the order of the tree, that `wanted` wants, of those for which all boxes around them are `open`.
    pub(super) fn find(
        &self,
        mut open: impl FnMut(&Area) -> bool,
        mut wanted: impl FnMut(u32) -> bool,
    ) -> Option<u32> {
        // One of two children waits on each level. Items have numbers of 32 bits, and so have nodes.
        let (mut waiting, mut count) = ([1u32; u32::BITS as usize], 1);
        while count > 0 {
            count -= 1;
            let node = waiting[count] as usize;
            if self.nodes[node].is_empty() || !open(&self.nodes[node]) {
                continue;
            }
            if node < self.leaves {
                let first = 2 * node as u32;
                (waiting[count], waiting[count + 1]) = (first + 1, first);
                count += 2;
                continue;
            }
            for at in self.leaf(node) {
                if open(&self.items[at]) && wanted(self.order[at]) {
                    return Some(self.order[at]);
                }
            }
        }
        None
    }

    /// The first pair of items, the lower number first, that `wanted` wants, of those whose boxes meet.
    pub(super) fn find_pair(
        &self,
        mut go_on: impl FnMut() -> Result<(), Cancelled>,
        mut wanted: impl FnMut(u32, u32) -> bool,
    ) -> Result<Option<[u32; 2]>, Cancelled> {
        let (mut waiting, mut steps) = (vec![(1, 1)], 0u32);
        while let Some((a, b)) = waiting.pop() {
            steps = steps.wrapping_add(1);
            if steps.is_multiple_of(PAIRS_BETWEEN_ASKS) {
                go_on()?;
            }
            if !self.nodes[a].meets(&self.nodes[b]) {
                continue;
            }
            if a < self.leaves {
                // Both are of one level.
                waiting.extend([(2 * a, 2 * b), (2 * a, 2 * b + 1), (2 * a + 1, 2 * b + 1)]);
                if a != b {
                    waiting.push((2 * a + 1, 2 * b));
                }
                continue;
            }
            for one in self.leaf(a) {
                for other in self.leaf(b).filter(|&other| a != b || other > one) {
                    let pair = [one, other].map(|at| self.order[at]);
                    let (least, most) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                    if self.items[one].meets(&self.items[other]) && wanted(least, most) {
                        return Ok(Some([least, most]));
                    }
                }
            }
        }
        Ok(None)
    }
}

/// Sorts items such that each half of the leaves has a half of space.
fn halve(order: &mut [u32], leaves: usize, areas: &[Area]) {
    let half = leaves / 2 * LEAF_SIZE;
    if leaves < 2 {
        return;
    }
    if half < order.len() {
        let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &item in order.iter() {
            for k in 0..3 {
                let center = areas[item as usize].center(k);
                (least[k], most[k]) = (least[k].min(center), most[k].max(center));
            }
        }
        let length = |k: usize| most[k] - least[k];
        let longest = if length(1) > length(0) { 1 } else { 0 };
        let longest = if length(2) > length(longest) { 2 } else { longest };
        order.select_nth_unstable_by(half, |&a, &b| {
            let [at, other] = [a, b].map(|item| areas[item as usize].center(longest));
            at.total_cmp(&other).then(a.cmp(&b))
        });
    }
    let order_len = order.len();
    let (left, right) = order.split_at_mut(half.min(order_len));
    let [mut left, mut right] = [left, right].map(|half| || halve(half, leaves / 2, areas));
    if order_len >= SHARED_MIN {
        taut_points::parallel::join(left, right);
    } else {
        left();
        right();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a plane that is upright, so that some are level with each other.
    fn points(count: u32) -> Vec<Area> {
        let point = |k: u32| [f64::from(k * 7 % 5), f64::from(k * 13 % 11), 2.0];
        (0..count).map(|k| Area::of(&[point(k)])).collect()
    }

    /// A search that opens one box in each level visits few boxes, however few leaves of the last ones have items.
    #[test]
    fn boxes_without_items_are_never_asked_about() {
        for count in [1u32, 9, 65, 129, 1000, 1025] {
            let areas: Vec<Area> =
                (0..count).map(|k| Area::of(&[[f64::from(k), 1.0, 2.0]])).collect();
            let tree = Tree::of(&areas);
            let last = areas[count as usize - 1];
            let mut asked = 0;
            let open = |area: &Area| {
                asked += 1;
                assert!(area.least[0] <= area.most[0]);
                area.meets(&last)
            };
            assert_eq!(tree.find(open, |item| item == count - 1), Some(count - 1));
            assert!(asked <= 2 * count.ilog2() + 2 * LEAF_SIZE as u32, "{asked} of {count}");
        }
    }

    #[test]
    fn every_item_and_every_pair_is_met() {
        for count in [0u32, 1, 7, 8, 9, 16, 17, 63, 200] {
            let areas = points(count);
            let tree = Tree::of(&areas);
            let mut met = vec![];
            assert_eq!(
                tree.find(
                    |_| true,
                    |item| {
                        met.push(item);
                        false
                    }
                ),
                None
            );
            met.sort_unstable();
            assert_eq!(met, (0..count).collect::<Vec<u32>>());
            let (mut met, mut expected) = (vec![], vec![]);
            let none = tree.find_pair(
                || Ok(()),
                |a, b| {
                    met.push([a, b]);
                    false
                },
            );
            assert_eq!(none.unwrap(), None);
            for a in 0..count {
                let near = (a + 1..count).filter(|&b| areas[a as usize].meets(&areas[b as usize]));
                expected.extend(near.map(|b| [a, b]));
            }
            met.sort_unstable();
            assert_eq!(met, expected);
        }
    }
}
