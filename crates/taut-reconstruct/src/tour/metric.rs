//! Distances between sites, in units in which none over- or underflows.

use taut_points::{exponent_of, two_to_in_steps};

/// Sites scaled by a power of two to an extent between 1 and 2, and one node more, at distance 0 from all of them: through it a
/// closed tour of the nodes is a path of the sites.
pub(super) struct Metric {
    at: Vec<[f64; 2]>,
    /// The power of two that leads back, in two steps, as 2^±2000 is no double.
    steps: [f64; 2],
}

impl Metric {
    pub(super) fn of(sites: &[[f64; 2]]) -> Self {
        let mut ends = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for p in sites {
            for k in 0..2 {
                ends[0][k] = ends[0][k].min(p[k]);
                ends[1][k] = ends[1][k].max(p[k]);
            }
        }
        let span = |factor: f64| {
            (0..2).map(|k| ends[1][k] * factor - ends[0][k] * factor).fold(0.0, f64::max)
        };
        // The difference of two large numbers may be none; that of their halves is.
        let exponent = match span(1.0) {
            0.0 => 0,
            span if span.is_finite() => exponent_of(span),
            _ => exponent_of(span(0.5)) + 1,
        };
        let [a, b] = two_to_in_steps(-exponent);
        let at = sites.iter().map(|p| p.map(|x| x * a * b)).collect();
        Self { at, steps: two_to_in_steps(exponent) }
    }

    /// Returns how many sites there are; the number of the node at distance 0 from all.
    #[inline(always)]
    pub(super) fn sites(&self) -> usize {
        self.at.len()
    }

    /// The distance of two sites.
    #[inline(always)]
    pub(super) fn distance(&self, i: u32, j: u32) -> f64 {
        let (p, q) = (self.at[i as usize], self.at[j as usize]);
        let (dx, dy) = (p[0] - q[0], p[1] - q[1]);
        (dx * dx + dy * dy).sqrt()
    }

    /// The distance of two nodes.
    #[inline(always)]
    pub(super) fn between(&self, i: u32, j: u32) -> f64 {
        let most = i.max(j) as usize;
        if most >= self.at.len() { 0.0 } else { self.distance(i, j) }
    }

    /// A length in the units of the sites; the largest finite number where it is beyond.
    pub(super) fn back(&self, length: f64) -> f64 {
        (length * self.steps[0] * self.steps[1]).clamp(f64::MIN, f64::MAX)
    }

    /// The length of the cycle of all nodes in this order.
    pub(super) fn length(&self, order: &[u32]) -> f64 {
        let steps = order.iter().zip(order.iter().cycle().skip(1));
        steps.map(|(&i, &j)| self.between(i, j)).sum()
    }
}
