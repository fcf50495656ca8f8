//! Distances between sites, in units in which none over- or underflows.

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
        let exponent =
            if span(1.0).is_finite() { exponent_of(span(1.0)) } else { exponent_of(span(0.5)) + 1 };
        let power = |e: i32| [2f64.powi(e / 2), 2f64.powi(e - e / 2)];
        let [a, b] = power(-exponent);
        let at = sites.iter().map(|p| p.map(|x| x * a * b)).collect();
        Self { at, steps: power(exponent) }
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

/// The exponent of the highest bit of a number of at least 0; of 0 that of 1.
fn exponent_of(x: f64) -> i32 {
    let exponent = (x.to_bits() >> 52) as i32;
    match x {
        0.0 => 0,
        _ if exponent > 0 => exponent - 1023,
        _ => -1011 - x.to_bits().leading_zeros() as i32,
    }
}
