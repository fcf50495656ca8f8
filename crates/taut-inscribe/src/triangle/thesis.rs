//! The largest triangle between random points that see each other: section 8.3 of the thesis.
//!
//! *Idea.* Points are drawn evenly from the polygon. Two of them see each other if no edge meets the segment between them; of all
//! triples that see each other the one with the largest area is the answer. The pairs are rows of bits, and the third point of a
//! pair is in both of its rows.
//! *Guarantee.* The triangle is inside, by exact signs. The thesis argues for a constant factor with some probability, for polygons
//! with a triangle of at least a fixed share of the area.
//! *Departures.* Points are drawn from the bounding box until they are inside, without a triangulation. Three sides that no edge
//! meets do not keep out a hole: its first vertex must be outside as well.
//! *Trap.* The number of points is what counts: the area that is missed falls with the square root of it.

use taut_points::{Cancelled, Monitor};

use super::TriangleThesisOptions;
use super::gauge::{Triangle, doubled_area, turn};
use super::report::{self, Reported, Target};
use crate::levels::Levels;
use crate::random::Random;
use crate::runs::{Runs, bounds, overlap};
use crate::simple::meet;

/// Points drawn from the bounding box for each one wanted, at most.
const DRAWN_PER_SAMPLE_MAX: usize = 1000;

/// Points and what they see.
struct Sample<'a> {
    target: &'a Target<'a>,
    points: Vec<[f64; 2]>,
    /// The first vertex of each ring.
    rings: Vec<[f64; 2]>,
    /// For each point the later ones that it sees, as bits.
    seen: Vec<Vec<u64>>,
}

/// The largest triangle of the sample; `None` if no three of the points see each other.
pub(super) fn sampled(
    target: &Target<'_>,
    levels: &Levels,
    options: &TriangleThesisOptions,
    monitor: &Monitor<'_>,
) -> Result<Option<Reported>, Cancelled> {
    let edges = &target.frame.edges;
    let points = points(target, levels, options);
    let runs = Runs::of(edges);
    let sees = |p: [f64; 2], q: [f64; 2]| {
        let around = bounds([p, q]);
        let is_clear = |edge: usize| !meet([p, q], edges[edge]);
        runs.visit(&|bounds| overlap(bounds, &around), &mut |mut run| run.all(is_clear))
    };
    let mut seen = vec![];
    for (i, &p) in points.iter().enumerate() {
        monitor.check()?;
        let mut row = vec![0u64; points.len().div_ceil(64)];
        for (j, &q) in points.iter().enumerate().skip(i + 1) {
            if sees(p, q) {
                row[j / 64] |= 1 << (j % 64);
            }
        }
        seen.push(row);
    }
    let is_start = |&edge: &usize| edge == 0 || edges[edge - 1][1] != edges[edge][0];
    let rings = (0..edges.len()).filter(is_start).map(|edge| edges[edge][0]).collect();
    Sample { target, points, rings, seen }.largest(monitor)
}

/// Points drawn evenly from the inside; fewer than asked for where that takes too many draws.
fn points(target: &Target<'_>, levels: &Levels, options: &TriangleThesisOptions) -> Vec<[f64; 2]> {
    let mut random = Random::new(options.seed);
    let count = options.sample_count as usize;
    let extent = target.frame.extent;
    let draws = (0..DRAWN_PER_SAMPLE_MAX * count).map(|_| extent.map(|x| x * random.unit()));
    draws.filter(|&p| levels.is_inside(&target.frame.edges, p)).take(count).collect()
}

impl Sample<'_> {
    fn largest(&self, monitor: &Monitor<'_>) -> Result<Option<Reported>, Cancelled> {
        let mut best: Option<Reported> = None;
        let mut most = 0.0;
        for i in 0..self.points.len() {
            monitor.check()?;
            for j in ones(&self.seen[i]) {
                let both: Vec<u64> = self.seen[i]
                    .iter()
                    .zip(&self.seen[j])
                    .map(|(one, other)| one & other)
                    .collect();
                for k in ones(&both) {
                    let triangle = turned_left([i, j, k].map(|place| self.points[place]));
                    let doubled = doubled_area(&triangle);
                    if doubled > most
                        && !self.holds_a_ring(&triangle)
                        && let Some(reported) = report::rounded(&triangle, self.target)
                    {
                        (best, most) = (Some(reported), doubled);
                    }
                }
            }
        }
        Ok(best)
    }

    fn holds_a_ring(&self, [p, q, r]: &Triangle) -> bool {
        let holds =
            |w: [f64; 2]| turn(*p, *q, w) > 0.0 && turn(*q, *r, w) > 0.0 && turn(*r, *p, w) > 0.0;
        self.rings.iter().any(|&w| holds(w))
    }
}

/// The places of the bits that are set, ascending.
fn ones(row: &[u64]) -> impl Iterator<Item = usize> {
    row.iter().enumerate().flat_map(|(word, &bits)| {
        let mut left = bits;
        std::iter::from_fn(move || {
            let bit = (left != 0).then(|| left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(64 * word + bit)
        })
    })
}

/// The triangle with its corners counterclockwise.
fn turned_left([p, q, r]: Triangle) -> Triangle {
    if turn(p, q, r) < 0.0 { [p, r, q] } else { [p, q, r] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bits_are_listed() {
        let places = [0, 3, 63, 64, 130, 191];
        let mut row = [0u64; 3];
        for place in places {
            row[place / 64] |= 1 << (place % 64);
        }
        assert_eq!(ones(&row).collect::<Vec<_>>(), places);
    }
}
