//! Uniform random points in a polygon.
//!
//! *Idea.* Horizontal lines through all vertices cut the polygon into trapezoids. A slab between two lines is chosen with a probability
//! that is proportional to the area inside, then one of its trapezoids, then one of its two triangles, and a uniform point of that.
//! *Reference.* Thesis, section 8.3, where the triangles are those of any triangulation.
//! *Cost.* The areas take the crossings of n lines with the edges; a point takes the crossings of one line.

use crate::levels::Levels;
use crate::polygon::Segment;
use crate::random::Random;

/// The slabs of a polygon.
pub(crate) struct Uniform<'a> {
    edges: &'a [Segment],
    levels: &'a Levels,
    /// The heights of vertices, ascending.
    heights: Vec<f64>,
    /// The areas inside of all slabs up to each one.
    sums: Vec<f64>,
}

/// Two edges with the inside of the polygon between them, and the width of that at both lines of a slab.
struct Trapezoid {
    left: [f64; 2],
    widths: [f64; 2],
}

impl<'a> Uniform<'a> {
    pub(crate) fn of(edges: &'a [Segment], levels: &'a Levels) -> Self {
        let mut heights: Vec<f64> = edges.iter().map(|edge| edge[0][1]).collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        let mut uniform = Uniform { edges, levels, heights, sums: vec![] };
        let mut sum = 0.0;
        for slab in 0..uniform.heights.len().saturating_sub(1) {
            sum +=
                uniform.trapezoids(slab).iter().map(|part| uniform.area(slab, part)).sum::<f64>();
            uniform.sums.push(sum);
        }
        uniform
    }

    /// The trapezoids of a slab, from left to right.
    fn trapezoids(&self, slab: usize) -> Vec<Trapezoid> {
        let (low, high) = (self.heights[slab], self.heights[slab + 1]);
        let at = |[a, b]: Segment, y: f64| {
            let share = ((y - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0);
            a[0] + share * (b[0] - a[0])
        };
        let middle = 0.5 * low + 0.5 * high;
        let mut crossing: Vec<(f64, Segment)> =
            self.levels.crossing(self.edges, middle).map(|edge| (at(edge, middle), edge)).collect();
        crossing.sort_by(|one, other| one.0.total_cmp(&other.0));
        let trapezoid = |pair: &[(f64, Segment)]| {
            let [left, right] = [pair[0].1, pair[1].1].map(|edge| [at(edge, low), at(edge, high)]);
            Trapezoid { left, widths: [0, 1].map(|k| (right[k] - left[k]).max(0.0)) }
        };
        crossing.chunks_exact(2).map(trapezoid).collect()
    }

    fn area(&self, slab: usize, part: &Trapezoid) -> f64 {
        0.5 * (self.heights[slab + 1] - self.heights[slab]) * (part.widths[0] + part.widths[1])
    }

    /// A random point, which rounding may move over an edge; `None` if the polygon has no area.
    pub(crate) fn point(&self, random: &mut Random) -> Option<[f64; 2]> {
        let total = self.sums.last().copied().filter(|&sum| sum > 0.0)?;
        let lot = total * random.unit();
        let slab = self.sums.partition_point(|&sum| sum <= lot).min(self.sums.len() - 1);
        let parts = self.trapezoids(slab);
        let all: f64 = parts.iter().map(|part| self.area(slab, part)).sum();
        let mut lot = all * random.unit();
        let chosen = parts.iter().position(|part| {
            lot -= self.area(slab, part);
            lot < 0.0
        });
        let part = parts.get(chosen.unwrap_or(parts.len().saturating_sub(1)))?;
        let ([low, high], [left, left_above]) =
            ([self.heights[slab], self.heights[slab + 1]], part.left);
        let [below, above] = part.widths;
        // The triangle with the lower side and the right upper corner, or the one with the upper side and the left lower corner.
        let triangle = match random.unit() * (below + above) < below {
            true => [[left, low], [left + below, low], [left_above + above, high]],
            false => [[left, low], [left_above + above, high], [left_above, high]],
        };
        let (from_first, share) = (random.unit().sqrt(), random.unit());
        let [p, q, r] = triangle;
        Some(
            [0, 1].map(|k| {
                p[k] + from_first * ((1.0 - share) * (q[k] - p[k]) + share * (r[k] - p[k]))
            }),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    #[test]
    fn points_are_spread_by_area() {
        // A frame: an outer square of side 4 and a hole of side 2 in its lower left part.
        let mut loops = Loops::default();
        loops.push(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        loops.push(&[[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [0.5, 2.5]]);
        let levels = Levels::of(&loops.segments, 4.0);
        let uniform = Uniform::of(&loops.segments, &levels);
        assert!((uniform.sums.last().unwrap() - 12.0).abs() < 1e-12);
        let mut random = Random::new(3);
        let (mut right, count) = (0, 4000);
        for _ in 0..count {
            let p = uniform.point(&mut random).unwrap();
            assert!(levels.is_inside(&loops.segments, p), "{p:?}");
            right += usize::from(p[0] >= 2.5);
        }
        // Half of the area is right of x = 2.5; five standard deviations are 5·√(n/4) = 158.
        assert!((right as i64 - count / 2).abs() < 158, "{right} of {count}");
    }
}
