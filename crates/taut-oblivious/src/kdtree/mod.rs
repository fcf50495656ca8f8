//! Nearest points by a kd-tree whose nodes and buckets are laid out for the memory hierarchy.
//!
//! | you want | call |
//! |---|---|
//! | the nearest point to a place | [`KdTree::nearest`] |
//! | the nearest points to many places | [`KdTree::nearest_all`], which goes through them along a Hilbert curve |
//! | the k nearest | [`KdTree::nearest_k`]; [`KdTree::nearest_k_by`] where the order of equal distances matters |
//!
//! The nearest point is that of the smallest squared distance ((x² + y²) + z²) as calculated in `f64`, and of several the
//! one of the lowest row. Where squares would overflow or lose digits, which needs a coordinate beyond 2⁵⁰⁰ ≈ 3·10¹⁵⁰ or
//! below 2⁻⁴⁰⁰ ≈ 4·10⁻¹²¹ and not zero, differences are scaled first: the answer is as right there, and takes some ten times
//! as long. The squared distance that comes with it may then be infinite or zero where the distance is not.
//!
//! Not for: other dimensions than two and three; points that come and go; distances other than Euclidean.

mod build;
mod query;
#[cfg(test)]
mod tests;
mod wide;

pub use query::Nearest;

use crate::Error;
use crate::layout::TreeOrder;
use crate::pages::Pages;

/// A bucket has this many points: four vectors of 8 coordinates for each axis.
const BUCKET_SIZE: usize = 32;
/// Marks a child that is a bucket.
const IS_BUCKET: u32 = 1 << 31;

/// Where the axis is kept within the number of the left child: buckets and nodes are fewer than 2²⁸.
const AXIS_SHIFT: u32 = 29;

/// A cut between the points of a node: those on the left have coordinates of at most `split`, on the right of at least.
///
/// Kept as two words, so that a line holds four nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    split: f64,
    /// The child of smaller coordinates, and the axis.
    left: u32,
    /// The child of larger coordinates.
    right: u32,
}

impl Node {
    fn new(split: f64, axis: usize, left: u32, right: u32) -> Self {
        Self { split, left: left | (axis as u32) << AXIS_SHIFT, right }
    }

    fn words(self) -> [u64; 2] {
        [self.split.to_bits(), u64::from(self.left) | u64::from(self.right) << 32]
    }

    #[inline(always)]
    fn of_words([split, children]: [u64; 2]) -> Self {
        let (left, right) = (children as u32, (children >> 32) as u32);
        Self { split: f64::from_bits(split), left, right }
    }

    #[inline(always)]
    fn left(self) -> u32 {
        self.left & !(3 << AXIS_SHIFT)
    }

    #[inline(always)]
    fn axis(self) -> usize {
        (self.left >> AXIS_SHIFT & 3) as usize
    }
}

/// A kd-tree of points of the plane or of space; `D` is 2 or 3, or the program does not compile.
///
/// The points are copied: 8·D + 4 bytes each, and a node for 32 of them.
///
/// ```
/// use taut_oblivious::kdtree::KdTree;
/// let tree = KdTree::new(&[[0.0, 0.0], [2.0, 0.0], [2.0, 0.0], [1.0, 5.0]])?;
/// let found = tree.nearest([1.5, 0.0]).expect("there are points");
/// assert_eq!((found.row, found.distance2), (1, 0.25));      // of equal distances the lowest row
/// let rows: Vec<u32> = tree.nearest_k([0.0, 0.0], 3).iter().map(|found| found.row).collect();
/// assert_eq!(rows, [0, 1, 2]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub struct KdTree<const D: usize> {
    /// [`Node::words`] of all nodes.
    nodes: Pages<[u64; 2]>,
    /// Node or bucket at which searches start.
    root: u32,
    /// Of each bucket the first coordinates of its points, then the second, …; infinite where there is no point.
    coordinates: Pages<f64>,
    /// Of each bucket the rows of its points; the largest number where there is no point.
    rows: Pages<u32>,
    len: usize,
    /// True if all coordinates are [`wide::is_plain`].
    plain: bool,
}

impl<const D: usize> KdTree<D> {
    /// Builds the tree, its nodes in van Emde Boas order. O(n log n), on the current rayon pool; the tree is the same for
    /// any number of threads.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for a coordinate that is NaN or infinite; [`Error::Option`] for 2³² points or
    /// more.
    pub fn new(points: &[[f64; D]]) -> Result<Self, Error> {
        Self::with_order(points, TreeOrder::VanEmdeBoas)
    }

    /// The same with the nodes in another order, which changes no answer.
    ///
    /// # Errors
    /// As [`KdTree::new`], and those of [`permute`](crate::layout::permute) for the order.
    pub fn with_order(points: &[[f64; D]], order: TreeOrder) -> Result<Self, Error> {
        build::build(points, order)
    }

    /// Points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns true if there is no point.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}
