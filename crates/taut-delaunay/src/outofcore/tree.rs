//! The tree of cells that points are distributed to, and the boxes that tell where points lie.
//!
//! *Problem.* Cut the plane or space so that each cell has about as many points, from a small sample alone; and tell
//! cheaply, later, whether a sphere may hold a point of any other cell.
//! *Idea.* A kd-tree: each node is cut across the longest side of its sample's box, at the median. All leaves of the
//! [`Router`] have the same depth, so that a point finds its cell without a branch. When the points have been
//! distributed, the smallest boxes around those of each cell, united upward, are the [`Tree`].
//! *Guarantee.* A point x goes right if x ≥ t and left otherwise, so equal points meet in one cell. A box is tight: it
//! holds the points of its cell and nothing is claimed of the rest.
//! *Trap.* Where most of a sample is equal, the median would cut nothing off. The cut is then made at the next larger
//! value, so that heaps of equal points end in cells of their own.
//! *Reference.* Bentley, Commun. ACM 18(9), 1975.

use crate::geometry::Bounds;
use crate::sites::Scale;

/// Levels of cells below a bucket: they cut the box of a bucket into 64, as thin fronts need finer boxes than buckets.
/// (Measured on uniform points of the plane, 10⁶ in 16 buckets: fronts 1.9 % of the points with 6 levels.)
pub const FINE_LEVELS: u32 = 6;

/// Most levels of a router, so that cells can be numbered with 32 bits by far.
pub const LEVELS_MAX: u32 = 24;

/// One cut: points whose coordinate along `axis` is at least `threshold` go right.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    threshold: f64,
    axis: u32,
}

/// A kd-tree of cuts of equal depth, from a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Router<const D: usize> {
    /// The cuts of a perfect binary tree, from 1: those below k are at 2k and 2k + 1.
    cuts: Vec<Cut>,
    levels: u32,
}

impl<const D: usize> Router<D> {
    /// Cuts 2^`levels` cells (at most [`LEVELS_MAX`] levels), each with about as many points of the sample. O(n log n).
    pub fn new(mut sample: Vec<[f64; D]>, levels: u32) -> Self {
        let levels = levels.min(LEVELS_MAX);
        let everything = Cut { threshold: f64::INFINITY, axis: 0 };
        let mut cuts = vec![everything; 1 << levels];
        let mut open = vec![(1usize, sample.as_mut_slice())];
        while let Some((node, points)) = open.pop() {
            if node >= cuts.len() {
                continue;
            }
            let Some(cut) = median_cut(points) else { continue };
            cuts[node] = cut;
            let axis = cut.axis as usize;
            let (left, right) = partition(points, |p| p[axis] < cut.threshold);
            open.push((2 * node, left));
            open.push((2 * node + 1, right));
        }
        Self { cuts, levels }
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        1 << self.levels
    }

    /// The cell of a point, from 0. A comparison a level.
    #[inline(always)]
    pub fn cell(&self, p: [f64; D]) -> usize {
        let mut node = 1;
        for _ in 0..self.levels {
            let cut = self.cuts[node];
            node = 2 * node + usize::from(p[cut.axis as usize % D] >= cut.threshold);
        }
        node - self.cells()
    }

    /// Writes the [`cell`](Self::cell) of each point to its place in `cells`.
    ///
    /// Several points descend side by side: each level of one waits for the level before (10⁷ points of the plane in 4096
    /// cells: a fourth of the time of one by one).
    pub(crate) fn find_cells(&self, points: &[[f64; D]], cells: &mut [u32]) {
        const ABREAST: usize = 8;
        let (blocks, rest) = points.as_chunks::<ABREAST>();
        let (cells_of_blocks, cells_of_rest) = cells.as_chunks_mut::<ABREAST>();
        for (block, cells) in blocks.iter().zip(cells_of_blocks) {
            let mut nodes = [1usize; ABREAST];
            for _ in 0..self.levels {
                for (node, p) in nodes.iter_mut().zip(block) {
                    let cut = self.cuts[*node];
                    *node = 2 * *node + usize::from(p[cut.axis as usize % D] >= cut.threshold);
                }
            }
            for (cell, node) in cells.iter_mut().zip(nodes) {
                *cell = (node - self.cells()) as u32;
            }
        }
        for (cell, &p) in cells_of_rest.iter_mut().zip(rest) {
            *cell = self.cell(p) as u32;
        }
    }
}

/// The cut of points in two parts as equal as can be, neither of them empty; `None` if all points are equal.
fn median_cut<const D: usize>(points: &mut [[f64; D]]) -> Option<Cut> {
    let bounds = Bounds::of(points.iter().copied());
    let side = |i: usize| bounds.high[i] - bounds.low[i];
    let axis = (0..D).reduce(|best, i| if side(i) > side(best) { i } else { best })?;
    if points.is_empty() || bounds.low[axis] == bounds.high[axis] {
        return None;
    }
    let middle = points.len() / 2;
    let (_, median, _) = points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
    let mut threshold = median[axis];
    if threshold == bounds.low[axis] {
        let above = points.iter().map(|p| p[axis]).filter(|&x| x > threshold);
        threshold = above.fold(f64::INFINITY, f64::min);
    }
    Some(Cut { threshold, axis: axis as u32 })
}

/// Moves the points that `is_left` holds of to the front; returns both parts.
fn partition<const D: usize>(
    points: &mut [[f64; D]],
    is_left: impl Fn(&[f64; D]) -> bool,
) -> (&mut [[f64; D]], &mut [[f64; D]]) {
    let mut kept = 0;
    for i in 0..points.len() {
        if is_left(&points[i]) {
            points.swap(kept, i);
            kept += 1;
        }
    }
    points.split_at_mut(kept)
}

/// The points that came to a cell: how many, and the smallest box around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellBox<const D: usize> {
    pub(crate) bounds: Bounds<D>,
    /// Points, equal ones included.
    pub count: u64,
}

impl<const D: usize> CellBox<D> {
    /// No points.
    pub const EMPTY: Self = Self { bounds: Bounds::EMPTY, count: 0 };

    /// Adds a point.
    #[inline(always)]
    pub fn add(&mut self, p: [f64; D]) {
        self.count += 1;
        for i in 0..D {
            self.bounds.low[i] = if p[i] < self.bounds.low[i] { p[i] } else { self.bounds.low[i] };
            self.bounds.high[i] =
                if p[i] > self.bounds.high[i] { p[i] } else { self.bounds.high[i] };
        }
    }

    /// Adds all points of another cell.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.bounds = self.bounds.union(&other.bounds);
    }

    /// The smallest and the largest coordinates; infinite and in wrong order if there is no point.
    pub fn corners(&self) -> [[f64; D]; 2] {
        [self.bounds.low, self.bounds.high]
    }

    /// The cell with these corners.
    pub(crate) fn of([low, high]: [[f64; D]; 2], count: u64) -> Self {
        Self { bounds: Bounds { low, high }, count }
    }
}

/// What [`Tree`] knows of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node<const D: usize> {
    cell: CellBox<D>,
    /// The two cells that it is cut into.
    children: Option<[u32; 2]>,
}

/// Cells, cells of cells, and the boxes of all; node 0 is the whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree<const D: usize> {
    nodes: Vec<Node<D>>,
}

impl<const D: usize> Tree<D> {
    /// The tree over the cells of a router, to which the points have come.
    pub fn new(cells: &[CellBox<D>]) -> Self {
        let empty = Node { cell: CellBox::EMPTY, children: None };
        let mut tree = Self { nodes: vec![empty] };
        tree.grow(0, cells);
        tree
    }

    /// Puts the cells of a router below a node that has none, whose points they are. Returns the nodes of these cells,
    /// in the order of their numbers.
    ///
    /// There must be 2ᵏ cells for a k ≥ 0.
    pub fn grow(&mut self, node: u32, cells: &[CellBox<D>]) -> Vec<u32> {
        debug_assert!(cells.len().is_power_of_two(), "a router has 2ᵏ cells");
        let mut level = vec![node];
        let mut all = vec![node];
        while level.len() < cells.len() {
            let mut below = Vec::with_capacity(2 * level.len());
            for &parent in &level {
                let children = [0, 1].map(|k| self.nodes.len() as u32 + k);
                let empty = Node { cell: CellBox::EMPTY, children: None };
                self.nodes.extend([empty; 2]);
                self.nodes[parent as usize].children = Some(children);
                below.extend(children);
            }
            all.extend_from_slice(&below);
            level = below;
        }
        for (&leaf, cell) in level.iter().zip(cells) {
            self.nodes[leaf as usize].cell = *cell;
        }
        // Children come after their parents.
        for &parent in all.iter().rev() {
            if let Some([left, right]) = self.nodes[parent as usize].children {
                let mut cell = self.nodes[left as usize].cell;
                cell.merge(&self.nodes[right as usize].cell);
                self.nodes[parent as usize].cell = cell;
            }
        }
        level
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns false: there is always the whole.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The two cells that a node is cut into.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn children(&self, node: u32) -> Option<[u32; 2]> {
        self.nodes[node as usize].children
    }

    /// The points of a node.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn cell(&self, node: u32) -> &CellBox<D> {
        &self.nodes[node as usize].cell
    }

    /// The tree of nodes that are given one by one; `None` if children do not come after their parents, or not there.
    pub(crate) fn of_nodes(nodes: Vec<(CellBox<D>, Option<[u32; 2]>)>) -> Option<Self> {
        let count = nodes.len();
        let is_sound = |(node, &(_, children)): (usize, &(_, Option<[u32; 2]>))| {
            children.is_none_or(|c| c.iter().all(|&k| (node + 1..count).contains(&(k as usize))))
        };
        let sound = count > 0 && nodes.iter().enumerate().all(is_sound);
        let nodes = nodes.into_iter().map(|(cell, children)| Node { cell, children }).collect();
        sound.then_some(Self { nodes })
    }

    /// Takes the points of a leaf away, in a tree of which no node was grown.
    pub(crate) fn clear(&mut self, leaf: u32) {
        let mut node = leaf as usize;
        self.nodes[node].cell = CellBox::EMPTY;
        while node > 0 {
            // Nodes are numbered level by level.
            node = (node - 1) / 2;
            if let Some([left, right]) = self.nodes[node].children {
                let mut cell = self.nodes[left as usize].cell;
                cell.merge(&self.nodes[right as usize].cell);
                self.nodes[node].cell = cell;
            }
        }
    }

    /// The tree of boxes that hold those of this one multiplied with a power of two, where that loses bits too.
    pub(crate) fn scaled_outward(&self, scale: Scale) -> Self {
        let mut tree = self.scaled(scale);
        let back = scale.inverse();
        for (scaled, given) in tree.nodes.iter_mut().zip(&self.nodes) {
            let (bounds, given) = (&mut scaled.cell.bounds, &given.cell.bounds);
            for i in 0..D {
                if back.apply(bounds.low[i]) != given.low[i] {
                    bounds.low[i] = bounds.low[i].next_down();
                }
                if back.apply(bounds.high[i]) != given.high[i] {
                    bounds.high[i] = bounds.high[i].next_up();
                }
            }
        }
        tree
    }

    /// The same tree of points multiplied with a power of two.
    pub(crate) fn scaled(&self, scale: Scale) -> Self {
        let mut tree = self.clone();
        for node in &mut tree.nodes {
            let bounds = &mut node.cell.bounds;
            bounds.low = bounds.low.map(|x| scale.apply(x));
            bounds.high = bounds.high.map(|x| scale.apply(x));
        }
        tree
    }

    /// Tests whether `may_meet` rules out all boxes with points, except those of `node`.
    pub(crate) fn outside_is_clear(
        &self,
        node: Option<u32>,
        open: &mut Vec<u32>,
        mut may_meet: impl FnMut(&Bounds<D>) -> bool,
    ) -> bool {
        open.clear();
        open.push(0);
        while let Some(other) = open.pop() {
            let Node { cell, children } = &self.nodes[other as usize];
            if Some(other) == node || cell.count == 0 || !may_meet(&cell.bounds) {
                continue;
            }
            match children {
                // The boxes around `node` are of no use, but those beside it are.
                Some(children) => open.extend(children),
                None => return false,
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::numbers;

    #[test]
    fn cells_share_the_points_evenly_and_equal_points_stay_together() {
        let points: Vec<[f64; 2]> = numbers(4096, 3).chunks(2).map(|c| [c[0], c[1]]).collect();
        let router = Router::new(points.clone(), 5);
        let mut found = vec![0; 1003];
        router.find_cells(&points[..1003], &mut found);
        assert!(points.iter().zip(found).all(|(&p, cell)| router.cell(p) == cell as usize));
        let mut cells = vec![CellBox::EMPTY; router.cells()];
        points.iter().for_each(|&p| cells[router.cell(p)].add(p));
        assert!(cells.iter().all(|cell| (62..=66).contains(&cell.count)), "{cells:?}");
        let tree = Tree::new(&cells);
        assert_eq!(tree.cell(0).count, 2048);
        assert_eq!(tree.cell(0).bounds, Bounds::of(points));
    }

    #[test]
    fn a_heap_of_equal_points_gets_a_cell_of_its_own() {
        let mut points = vec![[1.0, 1.0]; 1000];
        points.extend([[0.0, 0.0], [2.0, 2.0], [1.0, 2.0]]);
        let router = Router::new(points.clone(), 6);
        let heap = router.cell([1.0, 1.0]);
        assert!(points[1000..].iter().all(|&p| router.cell(p) != heap));
        let equal = Router::new(vec![[3.0, 4.0]; 10], 4);
        assert_eq!(equal.cell([3.0, 4.0]), equal.cell([1e300, -1e300]));
        assert_eq!(Router::<3>::new(vec![], 3).cells(), 8);
    }

    #[test]
    fn outside_a_node_means_all_boxes_but_its_own() {
        let points: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i), 0.0]).collect();
        let router = Router::new(points.clone(), 4);
        let mut cells = vec![CellBox::EMPTY; router.cells()];
        points.iter().for_each(|&p| cells[router.cell(p)].add(p));
        let tree = Tree::new(&cells);
        let holds = |x: f64| move |b: &Bounds<2>| b.low[0] <= x && x <= b.high[0];
        let [left, right] = tree.children(0).expect("cut");
        let open = &mut Vec::new();
        assert!(tree.outside_is_clear(Some(left), open, holds(3.0)));
        assert!(!tree.outside_is_clear(Some(right), open, holds(3.0)));
        assert!(tree.outside_is_clear(Some(left), open, holds(7.5)));
        assert!(tree.outside_is_clear(Some(0), open, |_| true));
    }
}
