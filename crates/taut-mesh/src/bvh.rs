//! A tree of boxes over triangles: which triangles may meet, and which is next to a point.
//!
//! *Problem.* Of n triangles, list the pairs whose boxes, with sides along the axes, have a point in common.
//! *Idea.* Halve the triangles at the median of the centers of their boxes along the axis in which these spread most, until
//! few are left; each part knows the box around it. The first triangle of a pair goes down the tree with its own box and
//! turns back where boxes are apart or all triangles come before it.
//! *Guarantee.* No pair is missed or listed twice. The depth is at most 32, building takes O(n log n), and the tree depends
//! on the coordinates and the order of the triangles alone.
//! *Trap.* Medians of equal centers fall where they may: ties go by number, so that they always fall the same way.
//! *Reference.* Ericson, Real-Time Collision Detection, 2005, chapter 6: trees of boxes built from the top.

mod nearest;

pub(crate) use nearest::normal;

/// A leaf has at most this many triangles. Of 2, 4, 8 and 16, 8 is the fastest, by 1 to 7 %, for the pairs and for the
/// nearest triangles of tori of 200 000 triangles.
const LEAF_SIZE: usize = 8;

/// A box with sides along the axes, its faces included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
}

impl Bounds {
    /// Around nothing.
    pub(crate) const NONE: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    /// The smallest around all these points.
    pub(crate) fn around<'p>(points: impl IntoIterator<Item = &'p [f64; 3]>) -> Self {
        points.into_iter().fold(Self::NONE, |b, &p| b.with(Self { low: p, high: p }))
    }

    fn with(self, other: Self) -> Self {
        let (mut low, mut high) = (self.low, self.high);
        for k in 0..3 {
            low[k] = low[k].min(other.low[k]);
            high[k] = high[k].max(other.high[k]);
        }
        Self { low, high }
    }

    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    /// The length of its diagonal, if it is around something.
    pub(crate) fn diagonal(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|k| self.high[k] - self.low[k]);
        f64::hypot(x, y).hypot(z)
    }

    /// Its center; halves are added, as a sum could be too large.
    fn center(&self) -> [f64; 3] {
        std::array::from_fn(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }
}

/// A part of the triangles. Its first half is the next node, if it is no leaf.
struct Node {
    bounds: Bounds,
    /// Its places in the order of the tree.
    begin: u32,
    end: u32,
    /// The node of its second half; 0 for a leaf.
    second: u32,
}

pub(crate) struct Bvh {
    nodes: Vec<Node>,
    /// The number of the triangle at each place.
    numbers: Vec<u32>,
    corners: Vec<[[f64; 3]; 3]>,
    bounds: Vec<Bounds>,
}

impl Bvh {
    /// The tree over triangles, each with a number of its own. At most 2³² of them.
    pub(crate) fn new(triangles: &[(u32, [[f64; 3]; 3])]) -> Self {
        let mut items: Vec<Item> = (0..)
            .zip(triangles)
            .map(|(slot, (number, corners))| {
                let bounds = Bounds::around(corners);
                Item { bounds, center: bounds.center(), number: *number, slot }
            })
            .collect();
        let mut nodes = Vec::new();
        if !items.is_empty() {
            divide(&mut items, 0, &mut nodes);
        }
        Self {
            nodes,
            numbers: items.iter().map(|item| item.number).collect(),
            corners: items.iter().map(|item| triangles[item.slot as usize].1).collect(),
            bounds: items.iter().map(|item| item.bounds).collect(),
        }
    }

    /// Number of triangles, and of places.
    pub(crate) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// The number and the corners of the triangle at a place.
    pub(crate) fn at(&self, place: usize) -> (u32, &[[f64; 3]; 3]) {
        (self.numbers[place], &self.corners[place])
    }

    /// Visits all places after this one whose boxes meet its box.
    pub(crate) fn meeting_after(&self, place: usize, mut visit: impl FnMut(usize)) {
        let own = self.bounds[place];
        let mut open = Stack::of(0u32);
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if node.end as usize <= place + 1 || !node.bounds.meets(&own) {
                continue;
            }
            if node.second == 0 {
                let begin = (node.begin as usize).max(place + 1);
                (begin..node.end as usize)
                    .filter(|&k| self.bounds[k].meets(&own))
                    .for_each(&mut visit);
            } else {
                open.push(node.second);
                open.push(at + 1);
            }
        }
    }
}

struct Item {
    bounds: Bounds,
    center: [f64; 3],
    number: u32,
    slot: u32,
}

/// Puts items, which begin at a place, in the order of the tree, and their nodes after those that are there.
fn divide(items: &mut [Item], begin: u32, nodes: &mut Vec<Node>) {
    let at = nodes.len();
    let bounds = items.iter().fold(Bounds::NONE, |all, item| all.with(item.bounds));
    nodes.push(Node { bounds, begin, end: begin + items.len() as u32, second: 0 });
    if items.len() <= LEAF_SIZE {
        return;
    }
    let centers = Bounds::around(items.iter().map(|item| &item.center));
    let spread = |k: usize| centers.high[k] - centers.low[k];
    let axis = (1..3).fold(0, |best, k| if spread(k) > spread(best) { k } else { best });
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        a.center[axis].total_cmp(&b.center[axis]).then(a.slot.cmp(&b.slot))
    });
    let (first, second) = items.split_at_mut(middle);
    divide(first, begin, nodes);
    nodes[at].second = nodes.len() as u32;
    divide(second, begin + middle as u32, nodes);
}

/// Nodes to be visited. Going down leaves one behind for each level, of which there are 32 at the most.
struct Stack<T> {
    items: [T; 48],
    len: usize,
}

impl<T: Copy> Stack<T> {
    /// With one item on it. Where there are no nodes, nothing asks.
    fn of(item: T) -> Self {
        Self { items: [item; 48], len: 1 }
    }

    fn push(&mut self, item: T) {
        self.items[self.len] = item;
        self.len += 1;
    }

    fn pop(&mut self) -> Option<T> {
        self.len = self.len.checked_sub(1)?;
        Some(self.items[self.len])
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Whole numbers bring boxes that touch, equal centers and flat boxes.
        #[test]
        fn pairs_are_those_of_all_boxes(
            soup in prop::collection::vec(prop::collection::vec(0i8..12, 9), 0..60),
            spread in 0i8..2,
        ) {
            let triangles: Vec<(u32, [[f64; 3]; 3])> = (100..)
                .zip(&soup)
                .map(|(number, values)| {
                    let x = |k: usize| f64::from(values[k] / (4 * spread + 1) + (values[k % 3] * spread));
                    (number, [[x(0), x(1), x(2)], [x(3), x(4), x(5)], [x(6), x(7), x(8)]])
                })
                .collect();
            let tree = Bvh::new(&triangles);
            prop_assert_eq!(tree.len(), triangles.len());
            let mut found = Vec::new();
            for place in 0..tree.len() {
                let (number, corners) = tree.at(place);
                prop_assert_eq!(*corners, triangles[number as usize - 100].1);
                tree.meeting_after(place, |other| {
                    let other = tree.at(other).0;
                    found.push((number.min(other), number.max(other)));
                });
            }
            found.sort_unstable();
            let mut expected = Vec::new();
            for (i, (one, a)) in triangles.iter().enumerate() {
                for (other, b) in &triangles[i + 1..] {
                    let reach = |t: &[[f64; 3]; 3], k: usize| {
                        let mut values = t.map(|p| p[k] as i64);
                        values.sort_unstable();
                        values[0]..=values[2]
                    };
                    if (0..3).all(|k| reach(a, k).any(|x| reach(b, k).contains(&x))) {
                        expected.push((*one, *other));
                    }
                }
            }
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_thousand_copies_do_not_deepen_the_tree() {
        let triangles: Vec<_> = (0..1000).map(|k| (k, [[1.0; 3]; 3])).collect();
        let tree = Bvh::new(&triangles);
        let mut met = 0;
        (0..1000).for_each(|place| tree.meeting_after(place, |_| met += 1));
        assert_eq!(met, 1000 * 999 / 2);
        assert!(tree.nodes.len() < 1000);
    }
}
