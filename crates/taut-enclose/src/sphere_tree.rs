//! A tree of balls around ever fewer points, from repeated 2-centers.
//!
//! *Problem.* For queries such as "what may this ray meet": balls that hold all points, halves of them, and so on, each as small
//! as it can be.
//! *Idea.* The points of a node are parted into two sets whose larger ball is small ([`split`]); each node has the smallest
//! ball of its points, which is found for itself and not from those of its children.
//! *Guarantee.* Every point is in the ball of every node on the way to it, as exactly as [`ball()`] puts it there; no child is
//! larger than its parent, but for the gap that is granted to balls. The same tree for any number of threads.
//! *Trap.* The depth is not logarithmic: points at 1, ½, ¼, … are taken off one by one. It is a loop over levels, not a recursion.
//! *Reference.* The use of 2-centers that the thesis names (section 2.4); the split goes back to Omohundro, Five Balltree
//! Construction Algorithms, ICSI TR-89-063, 1989.

mod split;

use taut_certify::Ball;
use taut_points::parallel::ParallelSlice;
use taut_points::{
    InputError, Monitor, OrderBy, PointSource, Points, ReadError, Rows, Scalar, Scratch, on_threads,
};

use crate::frame::frame_pass;
use crate::{BallOptions, Error, ball};

/// Options to build the tree. Write `SphereTreeOptions { leaf_size: 1, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereTreeOptions<'a> {
    /// Most points of a leaf, unless they are all equal. At least 1, default 8.
    pub leaf_size: usize,
    /// Wanted relative gap of the ball of each node, R ≤ (1 + ε)·R*. Range [0, 1), default 1e-9.
    pub epsilon: f64,
    /// Threads, 1 to 1024; `None` for those of the surrounding pool. The tree does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for SphereTreeOptions<'_> {
    fn default() -> Self {
        SphereTreeOptions { leaf_size: 8, epsilon: 1e-9, threads: None, monitor: Monitor::silent() }
    }
}

/// A ball and the points in it.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereNode {
    /// The smallest ball around the points of the node.
    pub ball: Ball,
    /// Its points are `order[range]` of the tree.
    pub range: std::ops::Range<usize>,
    /// The two nodes that share its points; `None` for a leaf.
    pub children: Option<[usize; 2]>,
}

/// Balls within balls.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereTree {
    /// Row numbers: those of each node side by side.
    pub order: Vec<u64>,
    /// The nodes, the root first, each before its children, level by level.
    pub nodes: Vec<SphereNode>,
}

impl SphereTree {
    /// The rows of a node.
    ///
    /// # Panics
    /// When there is no such node.
    pub fn rows(&self, node: usize) -> &[u64] {
        &self.order[self.nodes[node].range.clone()]
    }

    /// The most nodes on a way from the root to a leaf.
    pub fn depth(&self) -> usize {
        let mut depth = vec![1; self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate() {
            for child in node.children.into_iter().flatten() {
                depth[child] = depth[i] + 1;
            }
        }
        depth.into_iter().max().unwrap_or(0)
    }
}

/// The tree of balls around the points of a source, which are read into memory.
///
/// Points that are all equal are one leaf, however many.
///
/// *Cost.* Some thirty passes over the points of each node, O(nd) for each level of the tree; there are O(log n) of them
/// unless points pile up (22 for 100,000 normal points in space). Memory: a copy of the points.
///
/// ```
/// use taut_enclose::{SphereTreeOptions, sphere_tree};
///
/// let points = taut_points::Points::new(&[0.0, 9.0, 1.0, 8.0], 1)?;
/// let tree = sphere_tree(&points, &SphereTreeOptions { leaf_size: 2, ..Default::default() })?;
/// assert_eq!(tree.nodes[0].ball.radius, 4.5);
/// let [left, right] = tree.nodes[0].children.unwrap();
/// assert_eq!((tree.rows(left), tree.rows(right)), (&[0, 2][..], &[1, 3][..]));
/// assert_eq!((tree.nodes[left].ball.radius, tree.nodes[right].ball.center[0]), (0.5, 8.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Overflow`]; [`Error::Input`], also when the source fails or the monitor, asked at each node,
/// stops the work.
pub fn sphere_tree(
    source: &dyn PointSource,
    options: &SphereTreeOptions<'_>,
) -> Result<SphereTree, Error> {
    options.check(source)?;
    let mut scratch = Scratch::new();
    on_threads(options.threads, || match source.read(0..source.len(), &mut scratch)? {
        Rows::F32(points) => build(&points, options),
        Rows::F64(points) => build(&points, options),
    })
}

impl SphereTreeOptions<'_> {
    /// Refuses wrong options, and points that are no numbers.
    fn check(&self, source: &dyn PointSource) -> Result<(), Error> {
        if self.leaf_size == 0 {
            let (name, value) = ("leaf_size", "0".into());
            return Err(Error::Input(InputError::Option { name, value, expected: "at least 1" }));
        }
        // The name of a row in errors: the balls know rows by their place in a node.
        frame_pass(source, &self.monitor).map(|_| ())
    }
}

/// A node whose ball is still to be found.
struct Open<'a, T> {
    values: &'a mut [T],
    order: &'a mut [u64],
    /// Where its points begin in the order of the tree.
    start: usize,
}

fn build<T: Scalar>(
    points: &Points<'_, T>,
    options: &SphereTreeOptions<'_>,
) -> Result<SphereTree, Error> {
    let dim = points.dim();
    let mut values = points.values().to_vec();
    let mut order: Vec<u64> = (0..points.len() as u64).collect();
    let mut nodes: Vec<SphereNode> = vec![];
    let mut level = vec![Open { values: &mut values, order: &mut order, start: 0 }];
    while !level.is_empty() {
        let done = level
            .par_iter_mut()
            .map(|open| {
                options.monitor.check().map_err(ReadError::from)?;
                open.enclose_and_part(dim, options)
            })
            .collect::<Vec<_>>();
        let (first, mut next) = (nodes.len() + level.len(), vec![]);
        for (open, done) in level.into_iter().zip(done) {
            let (ball, left) = done?;
            let range = open.start..open.start + open.order.len();
            let children = left.map(|left| {
                let (a, b) = open.values.split_at_mut(left * dim);
                let (c, d) = open.order.split_at_mut(left);
                next.push(Open { values: a, order: c, start: open.start });
                next.push(Open { values: b, order: d, start: open.start + left });
                [first + next.len() - 2, first + next.len() - 1]
            });
            nodes.push(SphereNode { ball, range, children });
        }
        level = next;
    }
    Ok(SphereTree { order, nodes })
}

impl<T: Scalar> Open<'_, T> {
    /// The ball of the node; and unless it is a leaf, its points in two parts side by side, and how many are in the first.
    fn enclose_and_part(
        &mut self,
        dim: usize,
        options: &SphereTreeOptions<'_>,
    ) -> Result<(Ball, Option<usize>), Error> {
        let points = Points::new(self.values, dim).expect("a node has whole rows");
        let enclosing = BallOptions { epsilon: options.epsilon, ..BallOptions::default() };
        let found = ball(&points, &enclosing)?.answer;
        let is_leaf = points.len() <= options.leaf_size || found.radius == 0.0;
        let sides = if is_leaf { None } else { split::two_centers(&points, &found)? };
        let left = sides.map(|sides| self.part(dim, &sides));
        Ok((found, left))
    }

    /// Puts the points of the first side (true) before those of the second, each in their order.
    fn part(&mut self, dim: usize, sides: &[bool]) -> usize {
        let mut order: Vec<usize> = (0..sides.len()).collect();
        order.order_by_key(|&i| !sides[i]);
        let values: Vec<T> =
            order.iter().flat_map(|&i| &self.values[i * dim..(i + 1) * dim]).copied().collect();
        let rows: Vec<u64> = order.iter().map(|&i| self.order[i]).collect();
        self.values.copy_from_slice(&values);
        self.order.copy_from_slice(&rows);
        sides.iter().filter(|&&side| side).count()
    }
}
