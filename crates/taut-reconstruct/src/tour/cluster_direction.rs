//! Directions of ascent that move clusters as a whole.
//!
//! *Problem.* Sites in clusters far from each other: the potentials of a cluster have to move together, and steps that follow degrees
//! alone carry what one bridge tells through the cluster a few sites a step.
//! *Idea.* Between the length d at which single linkage forms a cluster S and the length D at which it joins it to another one, a
//! zone of width up to D − d fits around S. With one coordinate for each cluster, in units of that width, the slope is the sum of the
//! degrees less 2 over S, and the direction of steepest ascent is π += Σ (D − d)²·slope over all S of a site. Sites
//! alone are clusters with d = 0.
//! *Guarantee.* Any such direction is one of ascent, in another metric; two passes over a binary tree, O(n). It is 0 only where all
//! degrees are 2, as each site has a coordinate of its own, which is of a least width where rounding leaves none.
//! *Trap.* Widths are of very different size: without the squares a bridge would move as slowly as the closest two sites allow.
//! *Reference.* Jünger and Pulleyblank, Geometric duality and combinatorial optimization, 1993, for zones and "moats" around clusters.

use taut_points::OrderBy;

use super::candidates::Candidates;
use super::tree::LeastTree;
use super::union::Union;

/// The least width around a site, of an extent between 1 and 2.
const WIDTH_MIN: f64 = 1e-30;

/// The clusters of single linkage.
pub(super) struct ClusterDirection {
    /// The two parts of cluster n + k.
    parts: Vec<[u32; 2]>,
    /// Squared widths, of sites and then of clusters; the cluster of all sites has none.
    squares: Vec<f64>,
    slopes: Vec<f64>,
}

impl ClusterDirection {
    pub(super) fn of(candidates: &Candidates, n: usize) -> Self {
        let mut edges = Vec::with_capacity(n);
        let zero = vec![0.0; n];
        LeastTree::new(candidates, n, None)
            .find(&zero, |a, b| edges.push((candidates.length(a, b), a, b)));
        edges.order_by(&|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut union = Union::of(n);
        let mut cluster: Vec<u32> = (0..n as u32).collect();
        let mut formed = vec![0.0; n];
        let mut squares = vec![0.0; n];
        let mut parts = Vec::with_capacity(n);
        for (length, a, b) in edges {
            let both = [a, b].map(|v| cluster[union.root(v) as usize]);
            for part in both {
                let width = length - formed[part as usize];
                let least = if (part as usize) < n { WIDTH_MIN } else { 0.0 };
                squares[part as usize] = (width * width).max(least * least);
            }
            union.join(a, b);
            cluster[union.root(a) as usize] = (n + parts.len()) as u32;
            parts.push(both);
            formed.push(length);
            squares.push(0.0);
        }
        let slopes = vec![0.0; squares.len()];
        Self { parts, squares, slopes }
    }

    /// The direction, and how steep it is.
    pub(super) fn direct(&mut self, degrees: &[i32], direction: &mut [f64]) -> f64 {
        let Self { parts, squares, slopes } = self;
        let n = degrees.len();
        for (slope, &degree) in slopes.iter_mut().zip(degrees) {
            *slope = f64::from(degree);
        }
        for (k, part) in parts.iter().enumerate() {
            let [a, b] = part.map(|p| slopes[p as usize]);
            slopes[n + k] = a + b;
        }
        let mut steep = 0.0;
        for (slope, square) in slopes.iter_mut().zip(squares.iter()) {
            steep += square * *slope * *slope;
            *slope *= square;
        }
        for (k, part) in parts.iter().enumerate().rev() {
            let above = slopes[n + k];
            part.iter().for_each(|&p| slopes[p as usize] += above);
        }
        direction.copy_from_slice(&slopes[..n]);
        steep
    }
}
