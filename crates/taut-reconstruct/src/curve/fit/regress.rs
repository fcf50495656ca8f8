//! Local polynomials along an ordered curve, with windows as long as the curve lets them be.
//!
//! *Problem.* Points lie in a band around a curve, in order. Where is the middle line?
//! *Idea.* In the frame of a place on the curve as known so far, a parabola is fitted to the points of a window, by least squares or, for
//! noise with an edge, by the least largest residual. Windows grow by [`GROWTH`] for as long as what each says of the place
//! agrees with what all shorter ones say, within their errors (Lepski's rule): then curvature does not bend the answer yet.
//! *Guarantee.* Error O(n^(−4/9)) for least squares and O(n^(−4/5)) for the least largest residual, of a smooth curve.
//! *Reference.* Lepski, Theory of Probability and its Applications 35 (1990), 454–466.

use rayon::prelude::*;

use super::local::cholesky;
use super::minimax::{Minimax, minimax};
use super::strand::{Member, Node, Strand, hermite};

type Point = [f64; 2];

/// Growth of windows.
const GROWTH: f64 = 1.25;
/// Fewest points of a window.
const FEWEST: usize = 6;
/// Lepski's factor: how many standard errors two windows may differ by.
fn agree() -> f64 { std::env::var("AGREE").map_or(1.0, |s| s.parse().unwrap()) }
/// Greatest slope against the frame within a window.
const SLOPE: f64 = 0.8;

/// What windows say of one place.
#[derive(Clone, Copy, Debug)]
pub(in crate::curve) struct Estimate {
    /// Offset from the frame's origin, along its normal.
    pub(in crate::curve) offset: f64,
    /// Slope there.
    pub(in crate::curve) slope: f64,
    /// Standard error of the offset.
    pub(in crate::curve) error: f64,
    /// Half the length of the window.
    pub(in crate::curve) half: f64,
    /// Standard deviation of the residuals.
    pub(in crate::curve) deviation: f64,
}

/// Nodes in the middle of the band, `parts` for each edge of the strand.
pub(in crate::curve) fn regress(strand: &Strand, parts: usize, edge: Option<f64>) -> Vec<Node> {
    let noise = smooth(strand);
    let places = strand.edges() * parts + usize::from(!strand.closed);
    (0..places)
        .into_par_iter()
        .map_init(Vec::new, |window, place| {
            let (edge, t) = match place / parts {
                edge if edge < strand.edges() => (edge, (place % parts) as f64 / parts as f64),
                edge => (edge - 1, 1.0),
            };
            let (a, b) = strand.edge(edge);
            let (origin, slope) = hermite(a, b, t);
            let norm = slope[0].hypot(slope[1]);
            let tangent = [slope[0] / norm, slope[1] / norm];
            let arc = strand.arc[edge] + t * (strand.arc[edge + 1] - strand.arc[edge]);
            let start = (1.0 - t) * a.reach + t * b.reach;
            let frame = Frame { origin, tangent };
            let deviation = (1.0 - t) * noise[edge] + t * noise[(edge + 1) % noise.len()];
            match estimate(strand, &frame, arc, start, deviation, edge, window) {
                Some(found) => Node {
                    at: frame.place(found.offset),
                    tangent: frame.direction(found.slope),
                    reach: start,
                    deviation: found.deviation,
                },
                None => Node {
                    at: origin,
                    tangent,
                    reach: start,
                    deviation: (1.0 - t) * a.deviation + t * b.deviation,
                },
            }
        })
        .collect()
}

/// The noise at each node: the median of that of the nodes around it.
fn smooth(strand: &Strand) -> Vec<f64> {
    const AROUND: usize = 7;
    let count = strand.nodes.len();
    (0..count)
        .map(|i| {
            let at = |k: usize| match strand.closed {
                true => (i + count + k - AROUND.min(count)) % count,
                false => (i + k).saturating_sub(AROUND).min(count - 1),
            };
            let mut around: Vec<f64> =
                (0..=2 * AROUND).map(|k| strand.nodes[at(k)].deviation).collect();
            around.sort_unstable_by(f64::total_cmp);
            around[AROUND]
        })
        .collect()
}

/// A place on a curve and the direction it has there.
pub(in crate::curve) struct Frame {
    origin: Point,
    tangent: Point,
}

impl Frame {
    fn local(&self, p: Point) -> Point {
        let (dx, dy) = (p[0] - self.origin[0], p[1] - self.origin[1]);
        let [tx, ty] = self.tangent;
        [dx * tx + dy * ty, dy * tx - dx * ty]
    }

    fn place(&self, offset: f64) -> Point {
        [self.origin[0] - offset * self.tangent[1], self.origin[1] + offset * self.tangent[0]]
    }

    fn direction(&self, slope: f64) -> Point {
        let norm = slope.hypot(1.0);
        let [tx, ty] = self.tangent;
        [(tx - slope * ty) / norm, (ty + slope * tx) / norm]
    }
}

/// The estimate of the longest window that agrees with all shorter ones.
fn estimate(
    strand: &Strand,
    frame: &Frame,
    arc: f64,
    start: f64,
    deviation: f64,
    edge: Option<f64>,
    window: &mut Vec<Point>,
) -> Option<Estimate> {
    let longest = strand.length() / if strand.closed { 6.0 } else { 2.0 };
    let mut half = 0.5 * start;
    let mut best: Option<Estimate> = None;
    let mut agreed = [f64::NEG_INFINITY, f64::INFINITY];
    while half <= longest {
        window.clear();
        let members = Range::around(strand, arc, half);
        window.extend(members.map(|m| frame.local(m.at)));
        half *= GROWTH;
        if window.len() < FEWEST {
            continue;
        }
        let Some((mut found, mut bend)) = least_squares(window, half / GROWTH, deviation) else { continue };
        if found.error > 0.75 * deviation { continue; }
        if found.deviation > deviation * 1.5 && best.is_some() { break; }
        if let Some(edge) = edge {
            window.retain(|p| (p[1] - found.offset - p[0] * (found.slope + p[0] * bend)).abs() < 1.2 * edge * deviation);
            let m = window.len() as f64;
            if m * found.error > 5.5 * deviation * 1.7 {
            if let Some(w) = peeled(window, 1.03 * edge * deviation) {
                found.offset = w.coefficients[0];
                found.slope = w.coefficients[1];
                bend = w.coefficients[2];
                found.error = 5.5 * deviation * 1.7 / m;
            }}
        }
        let interval = [found.offset - agree() * found.error, found.offset + agree() * found.error];
        agreed = [agreed[0].max(interval[0]), agreed[1].min(interval[1])];
        if agreed[0] > agreed[1] && best.is_some() {
            break;
        }
        best = Some(found);
        if found.slope.abs() + 2.0 * bend.abs() * half > SLOPE {
            break;
        }
    }
    best
}

/// The parabola of least squares and its bend c.
fn least_squares(window: &[Point], half: f64, deviation: f64) -> Option<(Estimate, f64)> {
    let mut powers = [0.0; 5];
    let mut moments = [0.0; 3];
    let mut squares = 0.0;
    for &[u, v] in window {
        let u = u / half;
        let u2 = u * u;
        powers[0] += 1.0;
        powers[1] += u;
        powers[2] += u2;
        powers[3] += u2 * u;
        powers[4] += u2 * u2;
        moments[0] += v;
        moments[1] += u * v;
        moments[2] += u2 * v;
        squares += v * v;
    }
    let [s0, s1, s2, s3, s4] = powers;
    let matrix = [[s0, s1, s2], [s1, s2, s3], [s2, s3, s4]];
    let solution = cholesky(matrix, moments)?;
    let inverse = cholesky(matrix, [1.0, 0.0, 0.0])?[0];
    let fitted: f64 = solution.iter().zip(moments).map(|(a, m)| a * m).sum();
    let variance = ((squares - fitted) / (window.len() as f64 - 3.0)).max(0.0);
    let estimate = Estimate {
        offset: solution[0],
        slope: solution[1] / half,
        error: deviation * inverse.sqrt(),
        half,
        deviation: variance.sqrt(),
    };
    Some((estimate, solution[2] / (half * half)))
}

/// The minimax parabola without the points that make it wider than noise is.
fn peeled(window: &mut Vec<Point>, widest: f64) -> Option<Minimax> {
    let mut found = minimax(window)?;
    while found.width > widest && window.len() > FEWEST {
        let mut best: Option<(usize, Minimax)> = None;
        for i in found.reference {
            let last = window.len() - 1;
            window.swap(i, last);
            let Some(point) = window.pop() else { break };
            if let Some(without) = minimax(window)
                && best.is_none_or(|(_, b)| without.width < b.width)
            {
                best = Some((i, without));
            }
            window.push(point);
            window.swap(i, last);
        }
        let (i, _) = best?;
        window.swap_remove(i);
        found = minimax(window)?;
    }
    Some(found)
}

/// The members of a strand within some length of a place along it.
struct Range<'a> {
    members: &'a [Member],
    next: usize,
    left: usize,
}

impl<'a> Range<'a> {
    fn around(strand: &'a Strand, arc: f64, half: f64) -> Self {
        let members = &strand.members[..];
        let before = |arc: f64| members.partition_point(|m| m.arc < arc);
        let (low, high) = (arc - half, arc + half);
        if !strand.closed {
            let (first, last) = (before(low), before(high));
            return Self { members, next: first, left: last - first };
        }
        let whole = strand.length();
        let (first, last) = match (low < 0.0, high > whole) {
            (true, _) => (before(low + whole), before(high) + members.len()),
            (_, true) => (before(low), before(high - whole) + members.len()),
            _ => (before(low), before(high)),
        };
        Self { members, next: first, left: last - first }
    }
}

impl<'a> Iterator for Range<'a> {
    type Item = &'a Member;

    fn next(&mut self) -> Option<&'a Member> {
        self.left = self.left.checked_sub(1)?;
        let member = &self.members[self.next % self.members.len()];
        self.next += 1;
        Some(member)
    }
}
