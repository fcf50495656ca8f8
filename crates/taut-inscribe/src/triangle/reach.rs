//! How far a triangle can grow until it reaches an edge.

use super::gauge::Gauge;
use crate::groups::{Extent, Groups};

impl Groups {
    /// Calls `visit` with the edges that the triangle of a gauge may reach at a scale; `visit` returns the scale for the others.
    fn within(&self, gauge: &Gauge, mut most: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        let mut pending = vec![self.root()];
        while let Some(group) = pending.pop() {
            let Extent { center, half } = self.extent(group);
            // The boxes of groups without edges are at infinity, which is no number times 0.
            if half[0].is_infinite() || gauge.least_over(center, half) >= most {
                continue;
            }
            match self.children(group) {
                Some([one, other]) => pending.extend([other, one]),
                None => self.range(group).for_each(|edge| most = visit(edge, most)),
            }
        }
    }

    /// The least scale at which the triangle of a gauge reaches an edge, or `most` if that is less.
    pub(super) fn least_scale(&self, gauge: &Gauge, most: f64) -> f64 {
        let mut least = most;
        self.within(gauge, most, |edge, most| {
            least = gauge.scale(self.edge(edge), most);
            least
        });
        least
    }

    /// The edges that the triangle of a gauge reaches below a scale, ascending.
    pub(super) fn reached(&self, gauge: &Gauge, scale: f64) -> Vec<u32> {
        let mut found = vec![];
        self.within(gauge, scale, |edge, most| {
            if gauge.scale(self.edge(edge), most) < most {
                found.push(edge);
            }
            most
        });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Segment;

    #[test]
    fn groups_find_what_all_edges_show() {
        let point = |i: usize| {
            let angle = i as f64 * 0.37;
            [angle.cos() * (1.0 + 0.3 * (3.0 * angle).sin()), angle.sin()]
        };
        for size in [3, 4, 5, 17, 64, 100] {
            let edges: Vec<Segment> = (0..size).map(|i| [point(i), point(i + 1)]).collect();
            let groups = Groups::of(&edges);
            for turn in 0..9 {
                let at = |k: usize| point(turn + 5 * k).map(|x| 0.5 * x);
                let mut triangle = [at(0), at(1), at(2)];
                if super::super::gauge::doubled_area(&triangle) < 0.0 {
                    triangle.swap(0, 1);
                }
                let gauge = Gauge::of(&triangle);
                let scales: Vec<f64> = edges.iter().map(|&edge| gauge.scale(edge, 9.0)).collect();
                let least = scales.iter().copied().fold(9.0, f64::min);
                assert_eq!(groups.least_scale(&gauge, 9.0), least);
                let near = (0..size as u32).filter(|&edge| scales[edge as usize] < 3.0);
                assert_eq!(groups.reached(&gauge, 3.0), near.collect::<Vec<_>>());
            }
        }
    }
}
