//! The edge next to a point: a hierarchy of boxes over the edges of all curves, searched from a good first guess.

use rayon::prelude::*;
use taut_certify::CurveComponent;
use taut_points::{exponent_of, two_to};

/// A box of the lowest level has this many edges, and a box of the next this many boxes.
const FAN_OUT: usize = 4;
/// Edges of one task.
const TASK: usize = 1 << 14;

/// Where a site lies beside the curves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spot {
    pub(super) edge: u32,
    /// The share of the edge before the foot.
    pub(super) share: f64,
}

/// The edges of all curves, curve after curve.
pub(super) struct Segments {
    /// A power of two by which coordinates are multiplied, so that squares stay in range; nearly always 1.
    pub(super) scale: f64,
    /// Both ends of each edge, scaled; of a single vertex twice the same.
    ends: Vec<[[f64; 2]; 2]>,
    /// For each curve its first edge; one more entry at the end.
    pub(super) first: Vec<u32>,
    /// Boxes [x least, y least, x most, y most] by level, the lowest first.
    levels: Vec<Vec<[f64; 4]>>,
}

impl Segments {
    pub(super) fn of(curves: &[CurveComponent]) -> Self {
        let vertices = || curves.iter().flat_map(|one| &one.vertices).flatten();
        let largest = vertices().fold(0.0f64, |most, x| most.max(x.abs()));
        let scale = match (1e-100..1e100).contains(&largest) || largest == 0.0 {
            true => 1.0,
            false => two_to(-exponent_of(largest).clamp(-1000, 1000)),
        };
        let (mut ends, mut first) = (Vec::new(), vec![0]);
        for one in curves {
            let count = one.vertices.len();
            let to = if one.closed || count == 1 { count } else { count.saturating_sub(1) };
            let at = |k: usize| one.vertices[k % count].map(|x| x * scale);
            ends.par_extend((0..to).into_par_iter().with_min_len(TASK).map(|k| [at(k), at(k + 1)]));
            first.push(ends.len() as u32);
        }
        let join = |boxes: &[[f64; 4]]| {
            boxes.iter().fold(
                [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY],
                |a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])],
            )
        };
        let of_edge = |[a, b]: &[[f64; 2]; 2]| {
            [a[0].min(b[0]), a[1].min(b[1]), a[0].max(b[0]), a[1].max(b[1])]
        };
        let lowest: Vec<[f64; 4]> = ends.par_iter().with_min_len(TASK).map(of_edge).collect();
        let mut levels: Vec<Vec<[f64; 4]>> =
            vec![lowest.par_chunks(FAN_OUT).with_min_len(TASK).map(join).collect()];
        while let Some(below) = levels.last().filter(|below| below.len() > 1) {
            levels.push(below.chunks(FAN_OUT).map(join).collect());
        }
        Self { scale, ends, first, levels }
    }

    /// Where p, scaled, lies beside an edge, and its squared distance.
    fn beside(&self, p: [f64; 2], edge: usize) -> (f64, Spot) {
        let [a, b] = self.ends[edge];
        let (e, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let share = (e[0] * w[0] + e[1] * w[1]) / (e[0] * e[0] + e[1] * e[1]);
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let off = match share {
            1.0 => [p[0] - b[0], p[1] - b[1]],
            _ => [w[0] - share * e[0], w[1] - share * e[1]],
        };
        (off[0] * off[0] + off[1] * off[1], Spot { edge: edge as u32, share })
    }

    /// The spot next to p, scaled; `guess` is an edge that may be near.
    pub(super) fn next_to(&self, p: [f64; 2], guess: usize) -> Option<Spot> {
        let mut best = (f64::INFINITY, None);
        let see = |edge: usize, best: &mut (f64, Option<Spot>)| {
            let (square, spot) = self.beside(p, edge);
            if square < best.0 {
                *best = (square, Some(spot));
            }
        };
        if guess < self.ends.len() {
            see(guess, &mut best);
            // What is as near as the guess is preferred to it when it comes first.
            best.0 = best.0.next_up();
        }
        let distance = |area: &[f64; 4]| {
            let x = (area[0] - p[0]).max(p[0] - area[2]).max(0.0);
            let y = (area[1] - p[1]).max(p[1] - area[3]).max(0.0);
            x * x + y * y
        };
        let mut open = [(0u32, 0u32, 0.0f64); 64];
        let mut count = 1;
        open[0] = (self.levels.len() as u32 - 1, 0, 0.0);
        while count > 0 {
            count -= 1;
            let (level, node, bound) = open[count];
            if bound >= best.0 {
                continue;
            }
            let from = node as usize * FAN_OUT;
            if level == 0 {
                (from..(from + FAN_OUT).min(self.ends.len())).for_each(|edge| see(edge, &mut best));
                continue;
            }
            let below = &self.levels[level as usize - 1];
            let start = count;
            for child in from..(from + FAN_OUT).min(below.len()) {
                let bound = distance(&below[child]);
                if bound < best.0 {
                    // The nearest on top.
                    let mut at = count;
                    while at > start && open[at - 1].2 < bound {
                        open[at] = open[at - 1];
                        at -= 1;
                    }
                    open[at] = (level - 1, child as u32, bound);
                    count += 1;
                }
            }
        }
        best.1
    }
}
