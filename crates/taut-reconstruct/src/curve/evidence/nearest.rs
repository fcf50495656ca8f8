//! The edge next to a point: a hierarchy of boxes over the edges of all curves, searched from a good first guess.

use rayon::prelude::*;
use taut_certify::CurveComponent;

/// A box of the lowest level has this many edges, and a box of the next this many boxes.
const FAN_OUT: usize = 4;
/// Edges of one task.
const TASK: usize = 1 << 14;

/// Where a site lies beside the curves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::curve) struct Spot {
    pub(in crate::curve) edge: u32,
    /// The share of the edge before the foot.
    pub(in crate::curve) share: f64,
    /// Distance from the foot.
    pub(in crate::curve) distance: f64,
    /// Whether the site is on the left of the edge.
    pub(in crate::curve) left: bool,
}

/// The edges of all curves, curve after curve.
pub(in crate::curve) struct Segments {
    /// A power of two by which coordinates are multiplied, so that squares stay in range; nearly always 1.
    pub(in crate::curve) scale: f64,
    /// Both ends of each edge, scaled; of a single vertex twice the same.
    pub(super) ends: Vec<[[f64; 2]; 2]>,
    /// For each curve its first edge; one more entry at the end.
    pub(in crate::curve) first: Vec<u32>,
    /// Boxes [x least, y least, x most, y most] by level, the lowest first.
    levels: Vec<Vec<[f64; 4]>>,
}

impl Segments {
    pub(in crate::curve) fn of(curves: &[CurveComponent]) -> Self {
        let vertices = || curves.iter().flat_map(|one| &one.vertices).flatten();
        let largest = vertices().fold(0.0f64, |most, x| most.max(x.abs()));
        let scale = match (1e-100..1e100).contains(&largest) || largest == 0.0 {
            true => 1.0,
            false => 2f64.powi(-(largest.log2() as i32).clamp(-1000, 1000)),
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

    /// Edges there are.
    pub(in crate::curve) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The width and height of the box around all edges.
    pub(in crate::curve) fn reach(&self) -> f64 {
        let top = self.levels.last().and_then(|top| top.first());
        top.map_or(0.0, |area| (area[2] - area[0]) + (area[3] - area[1]))
    }

    /// The edges of a curve.
    pub(super) fn of_curve(&self, curve: usize) -> std::ops::Range<usize> {
        self.first[curve] as usize..self.first[curve + 1] as usize
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
        let left = e[0] * w[1] - e[1] * w[0] >= 0.0;
        let square = off[0] * off[0] + off[1] * off[1];
        (square, Spot { edge: edge as u32, share, distance: 0.0, left })
    }

    /// The spot next to p, scaled, if it is nearer than `most`; `guess` is an edge that may be near.
    pub(in crate::curve) fn next_to(&self, p: [f64; 2], guess: usize, most: f64) -> Option<Spot> {
        let mut best = (most * most, None);
        let see = |edge: usize, best: &mut (f64, Option<Spot>)| {
            let (square, spot) = self.beside(p, edge);
            if square < best.0 {
                *best = (square, Some(spot));
            }
        };
        if guess < self.len() {
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
                (from..(from + FAN_OUT).min(self.len())).for_each(|edge| see(edge, &mut best));
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
        best.1.map(|spot| Spot { distance: best.0.sqrt(), ..spot })
    }

    /// Whether the box of an edge is within a distance of p; parts of the range of edges that are `left_out` do not count.
    pub(super) fn meets(
        &self,
        p: [f64; 2],
        distance: f64,
        left_out: impl Fn(&std::ops::Range<usize>) -> bool,
    ) -> bool {
        let is_far = |area: &[f64; 4]| {
            let x = (area[0] - p[0]).max(p[0] - area[2]).max(0.0);
            let y = (area[1] - p[1]).max(p[1] - area[3]).max(0.0);
            x * x + y * y > distance * distance
        };
        let mut open = vec![(self.levels.len() - 1, 0)];
        while let Some((level, node)) = open.pop() {
            let edges = self.edges_of(level, node);
            if is_far(&self.levels[level][node]) || left_out(&edges) {
                continue;
            }
            if level > 0 {
                let children =
                    node * FAN_OUT..((node + 1) * FAN_OUT).min(self.levels[level - 1].len());
                open.extend(children.map(|child| (level - 1, child)));
                continue;
            }
            for edge in edges {
                let [a, b] = self.ends[edge];
                let area = [a[0].min(b[0]), a[1].min(b[1]), a[0].max(b[0]), a[1].max(b[1])];
                if !left_out(&(edge..edge + 1)) && !is_far(&area) {
                    return true;
                }
            }
        }
        false
    }

    /// The edges below a box.
    fn edges_of(&self, level: usize, node: usize) -> std::ops::Range<usize> {
        let size = FAN_OUT.pow(level as u32 + 1);
        node * size..((node + 1) * size).min(self.len())
    }

    /// Calls `see` for each edge in boxes whose value is below `best`, which `see` lowers. A box comes with the edges in it.
    pub(super) fn search(
        &self,
        best: &mut f64,
        value: impl Fn(&[f64; 4], std::ops::Range<usize>) -> f64,
        mut see: impl FnMut(usize, &mut f64),
    ) {
        let mut open = Vec::with_capacity(64);
        open.push((self.levels.len() - 1, 0, 0.0));
        while let Some((level, node, bound)) = open.pop() {
            if bound >= *best {
                continue;
            }
            if level == 0 {
                self.edges_of(0, node).for_each(|edge| see(edge, best));
                continue;
            }
            let from = node * FAN_OUT;
            let below = &self.levels[level - 1];
            let start = open.len();
            let children = (from..(from + FAN_OUT).min(below.len()))
                .map(|node| (level - 1, node, value(&below[node], self.edges_of(level - 1, node))));
            open.extend(children.filter(|child| child.2 < *best));
            open[start..].sort_unstable_by(|a, b| b.2.total_cmp(&a.2));
        }
    }
}
