//! The largest triangle among random points that see each other: the method of the thesis.
//!
//! *Problem.* Among s uniform random points in the polygon, find the triangle of the largest area whose inside is inside.
//! *Idea.* Two points see each other if no edge meets the segment between them. In a polygon without holes three points that see each
//! other span a triangle inside; with holes, none of these may be in the triangle either.
//! *Guarantee.* None for one run: the thesis shows a constant factor with some probability if the largest triangle has at least a share
//! ε of the area and s grows with (1/ε²)·log(1/ε). The bound of the branch and bound says how good the answer is.
//! *Cost.* O(s²) visibility tests and O(s³) triples, by words of 64 points.
//! *Reference.* Thesis, section 8.3. Its expected deficit falls as 1/√m only, for m points in the largest triangle.

use taut_points::{Cancelled, Monitor};
use taut_predicates::plane::orient;

use super::gauge::{Triangle, cross, doubled_area, minus};
use super::method::TriangleThesisOptions;
use super::report::{self, Reported, Target};
use crate::groups::{Extent, Groups};
use crate::levels::Levels;
use crate::random::Random;
use crate::simple::meet;
use crate::uniform::Uniform;

/// Random points drawn for each one wanted: rounding may put one outside.
const DRAWS_PER_POINT: u64 = 4;

/// Bound of the rounding errors of the test of boxes, coordinates being below 4 in size.
const BOX_ERROR: f64 = 64.0 * f64::EPSILON;

/// What the method found.
pub(super) struct Sampled {
    pub(super) reported: Option<Reported>,
    /// Pairs of points that see each other.
    pub(super) visible_pairs: u64,
}

/// Finds the largest triangle among random points.
pub(super) fn largest(
    target: &Target<'_>,
    options: &TriangleThesisOptions,
    monitor: &Monitor<'_>,
) -> Result<Sampled, Cancelled> {
    let edges = &target.frame.edges;
    let levels = Levels::of(edges, target.frame.extent[1]);
    let uniform = Uniform::of(edges, &levels);
    let mut random = Random::new(options.seed);
    let draws =
        (0..DRAWS_PER_POINT * options.sample_count).filter_map(|_| uniform.point(&mut random));
    let inner = draws.filter(|&p| levels.is_inside(edges, p));
    let points: Vec<[f64; 2]> = inner.take(options.sample_count as usize).collect();
    // Of each point the later ones that it sees, a bit for each.
    let words = points.len().div_ceil(64);
    let mut sees = vec![vec![0u64; words]; points.len()];
    let mut visible_pairs = 0;
    for (i, &p) in points.iter().enumerate() {
        monitor.check()?;
        for (j, &q) in points.iter().enumerate().skip(i + 1) {
            if is_visible(p, q, &target.groups) {
                sees[i][j / 64] |= 1 << (j % 64);
                visible_pairs += 1;
            }
        }
    }
    let heads = heads(target);
    let (mut best, mut most): (Option<Triangle>, f64) = (None, 0.0);
    for (i, &p) in points.iter().enumerate() {
        monitor.check()?;
        for j in bits(sees[i].iter().copied()) {
            let common = sees[i].iter().zip(&sees[j]).map(|(one, other)| one & other);
            for k in bits(common) {
                let mut triangle = [p, points[j], points[k]];
                if doubled_area(&triangle) < 0.0 {
                    triangle.swap(1, 2);
                }
                let doubled = doubled_area(&triangle);
                if doubled > most && !heads.iter().any(|&head| holds(&triangle, head)) {
                    (best, most) = (Some(triangle), doubled);
                }
            }
        }
    }
    let reported = best.and_then(|best| report::rounded(&best, target));
    Ok(Sampled { reported, visible_pairs })
}

/// The numbers of the bits that are set, ascending.
fn bits(words: impl Iterator<Item = u64>) -> impl Iterator<Item = usize> {
    words.enumerate().flat_map(|(word, mut bits)| {
        std::iter::from_fn(move || {
            let bit = (bits != 0).then(|| bits.trailing_zeros() as usize)?;
            bits &= bits - 1;
            Some(64 * word + bit)
        })
    })
}

/// A vertex of each ring where there are several, in the frame.
fn heads(target: &Target<'_>) -> Vec<[f64; 2]> {
    let edges = target.edges;
    // A ring ends at its first vertex, which no other ring has.
    let begins = |&i: &usize| i == 0 || edges[i - 1][1] != edges[i][0];
    let heads: Vec<usize> = (0..edges.len()).filter(begins).collect();
    match heads.len() {
        1 => vec![],
        _ => heads.into_iter().map(|i| target.frame.edges[i][0]).collect(),
    }
}

/// Whether a point is in a triangle, by exact signs.
fn holds(&[p, q, r]: &Triangle, w: [f64; 2]) -> bool {
    [[p, q], [q, r], [r, p]].iter().all(|&[p, q]| orient(p, q, w).is_positive())
}

/// Whether no edge meets the segment between two points.
fn is_visible(p: [f64; 2], q: [f64; 2], edges: &Groups) -> bool {
    let way = minus(q, p);
    let may_meet = |&Extent { center, half }: &Extent| {
        let is_apart = |k: usize| {
            let (low, high) = (center[k] - half[k] - BOX_ERROR, center[k] + half[k] + BOX_ERROR);
            p[k].max(q[k]) < low || p[k].min(q[k]) > high
        };
        let reach = way[0].abs() * half[1] + way[1].abs() * half[0];
        !is_apart(0) && !is_apart(1) && cross(way, minus(center, p)).abs() <= reach + BOX_ERROR
    };
    !edges.any(may_meet, |edge| meet([p, q], edge))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_listed_in_order() {
        let found: Vec<usize> = bits([1 << 63 | 5, 0, 1].into_iter()).collect();
        assert_eq!(found, [0, 2, 63, 128]);
    }
}
