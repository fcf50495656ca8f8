//! Bounding boxes of runs of consecutive edges, in a tree.
//!
//! *Idea.* Edges that follow each other along a ring lie near each other. Boxes around runs of them, and around runs of those,
//! make a tree in the order of the rings, without sorting.
//! *Cost.* O(n) to build, with one box for three edges. A query visits the runs whose boxes it meets.
//! *Trap.* A ring that runs to and fro across the plane has boxes that all overlap; whoever needs a bound counts visits.

use std::ops::Range;

use crate::polygon::Segment;

/// Edges of a run at the lowest level.
const RUN_EDGES: usize = 4;

/// Runs of one level in a run of the next.
const RUN_CHILDREN: usize = 4;

/// The smallest and the largest coordinates.
pub(crate) type Bounds = [[f64; 2]; 2];

/// The boxes of all levels; the last level has one.
#[derive(Clone, Debug)]
pub(crate) struct Runs {
    levels: Vec<Vec<Bounds>>,
    edges: usize,
}

/// A run, by its level and its place there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Run {
    level: usize,
    place: usize,
}

impl Runs {
    /// Builds the boxes of at least one edge.
    pub(crate) fn of(edges: &[Segment]) -> Self {
        let of_edges = |run: &[Segment]| enclosing(run.iter().map(|&edge| bounds(edge)));
        let mut levels = vec![edges.chunks(RUN_EDGES).map(of_edges).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|level| level.len() > 1) {
            let of_runs = |run: &[Bounds]| enclosing(run.iter().copied());
            levels.push(below.chunks(RUN_CHILDREN).map(of_runs).collect());
        }
        Runs { levels, edges: edges.len() }
    }

    /// The boxes after a map that keeps the order of coordinates.
    pub(crate) fn mapped(&self, map: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let level = |boxes: &Vec<Bounds>| boxes.iter().map(|ends| ends.map(&map)).collect();
        Runs { levels: self.levels.iter().map(level).collect(), edges: self.edges }
    }

    /// The run of all edges.
    pub(crate) fn whole(&self) -> Run {
        Run { level: self.levels.len() - 1, place: 0 }
    }

    /// The number of runs at the lowest level.
    pub(crate) fn lowest(&self) -> usize {
        self.levels[0].len()
    }

    pub(crate) fn bounds(&self, run: Run) -> Bounds {
        self.levels[run.level][run.place]
    }

    /// The runs of the level below in a run; none at the lowest level.
    pub(crate) fn children(&self, run: Run) -> impl Iterator<Item = Run> + use<> {
        let (level, places) = match run.level {
            0 => (0, 0..0),
            level => {
                let first = RUN_CHILDREN * run.place;
                let below = self.levels[level - 1].len();
                (level - 1, first..below.min(first + RUN_CHILDREN))
            }
        };
        places.map(move |place| Run { level, place })
    }

    /// The edges of a run.
    pub(crate) fn edges(&self, run: Run) -> Range<usize> {
        let length = RUN_EDGES * RUN_CHILDREN.pow(run.level as u32);
        length * run.place..self.edges.min(length * (run.place + 1))
    }

    /// Calls `visit` for the edges of each lowest run that lies, with all runs around it, in wanted boxes, until it returns false.
    ///
    /// Returns false if `visit` did.
    pub(crate) fn visit(
        &self,
        is_wanted: &impl Fn(&Bounds) -> bool,
        visit: &mut impl FnMut(Range<usize>) -> bool,
    ) -> bool {
        self.visit_within(self.whole(), is_wanted, visit)
    }

    fn visit_within(
        &self,
        run: Run,
        is_wanted: &impl Fn(&Bounds) -> bool,
        visit: &mut impl FnMut(Range<usize>) -> bool,
    ) -> bool {
        if !is_wanted(&self.levels[run.level][run.place]) {
            return true;
        }
        if run.level == 0 {
            return visit(self.edges(run));
        }
        self.children(run).all(|child| self.visit_within(child, is_wanted, visit))
    }

    /// The edge with the least value, if that is below the one of `best`, by lower bounds of values in boxes.
    pub(crate) fn least(
        &self,
        best: (u32, f64),
        in_box: &impl Fn(&Bounds) -> f64,
        of_edge: &impl Fn(u32) -> f64,
    ) -> (u32, f64) {
        let mut found = best;
        self.least_within(self.whole(), in_box, of_edge, &mut found);
        found
    }

    fn least_within(
        &self,
        run: Run,
        in_box: &impl Fn(&Bounds) -> f64,
        of_edge: &impl Fn(u32) -> f64,
        best: &mut (u32, f64),
    ) {
        if run.level == 0 {
            for edge in self.edges(run) {
                let value = of_edge(edge as u32);
                if value < best.1 {
                    *best = (edge as u32, value);
                }
            }
            return;
        }
        let mut waiting = [(f64::INFINITY, run); RUN_CHILDREN];
        for (slot, child) in waiting.iter_mut().zip(self.children(run)) {
            *slot = (in_box(&self.bounds(child)), child);
        }
        waiting.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        for (value, child) in waiting {
            if value >= best.1 {
                return;
            }
            self.least_within(child, in_box, of_edge, best);
        }
    }
}

/// The box of an edge.
pub(crate) fn bounds([a, b]: Segment) -> Bounds {
    [[a[0].min(b[0]), a[1].min(b[1])], [a[0].max(b[0]), a[1].max(b[1])]]
}

/// Returns true if two closed boxes meet.
pub(crate) fn overlap([low, high]: &Bounds, [other_low, other_high]: &Bounds) -> bool {
    low[0] <= other_high[0]
        && other_low[0] <= high[0]
        && low[1] <= other_high[1]
        && other_low[1] <= high[1]
}

/// The square of the distance of a point from a box.
pub(crate) fn square_distance([low, high]: &Bounds, p: [f64; 2]) -> f64 {
    let beyond = |k: usize| (low[k] - p[k]).max(p[k] - high[k]).max(0.0);
    let (x, y) = (beyond(0), beyond(1));
    x * x + y * y
}

/// The smallest box around others.
fn enclosing(boxes: impl Iterator<Item = Bounds>) -> Bounds {
    boxes.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], [l, h]| {
        [[low[0].min(l[0]), low[1].min(l[1])], [high[0].max(h[0]), high[1].max(h[1])]]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of edges that wind around a circle with teeth.
    fn ring(count: usize) -> Vec<Segment> {
        let vertex = |i: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
            let radius = if i.is_multiple_of(2) { 1.0 } else { 0.75 };
            [radius * cosine, radius * sine]
        };
        (0..count).map(|i| [vertex(i), vertex((i + 1) % count)]).collect()
    }

    #[test]
    fn every_edge_is_in_one_lowest_run() {
        for count in [3, 8, 9, 32, 33, 257, 1000] {
            let runs = Runs::of(&ring(count));
            let mut seen = vec![];
            assert!(runs.visit(&|_| true, &mut |edges| {
                seen.extend(edges);
                true
            }));
            assert_eq!(seen, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn queries_agree_with_all_edges() {
        let edges = ring(500);
        let runs = Runs::of(&edges);
        let to_start = |edge: u32, p: [f64; 2]| {
            let a = edges[edge as usize][0];
            (a[0] - p[0]).powi(2) + (a[1] - p[1]).powi(2)
        };
        for i in 0..20 {
            let p = [f64::from(i) / 7.0 - 1.5, f64::from(i * i % 13) / 5.0 - 1.2];
            let all = (0..500).map(|edge| to_start(edge, p)).fold(f64::INFINITY, f64::min);
            let (edge, found) =
                runs.least((0, f64::INFINITY), &|bounds| square_distance(bounds, p), &|edge| {
                    to_start(edge, p)
                });
            assert!(found == all && to_start(edge, p) == all, "{p:?}");
            let window = [p, [p[0] + 0.4, p[1] + 0.3]];
            let expected: Vec<usize> =
                (0..500).filter(|&edge| overlap(&bounds(edges[edge]), &window)).collect();
            let mut seen = vec![];
            runs.visit(&|bounds| overlap(bounds, &window), &mut |run| {
                seen.extend(run.filter(|&edge| overlap(&bounds(edges[edge]), &window)));
                true
            });
            assert_eq!(seen, expected);
        }
    }
}
