//! Whether some outliers lie along one arc, as the samples of a curve among them do.
//!
//! *Problem.* The samples of a sparse curve among outliers need not be nearer to each other than outliers are by chance; they are neighbors
//! along a curve.
//! *Idea.* Around some outliers the nearest others are looked at, in windows of several sizes. Circles through the middle one and two
//! drawn others are tried: of the outliers in the window, chance puts as many into the band around the circle as its area says. Given how
//! many there are in the window, those in the band are binomial, wherever outliers are denser than elsewhere; the Chernoff bound says how
//! seldom so many are, and must outweigh the number of circles that are tried.
//! *Guarantee.* Outliers that are independent and, within each window, even are called an arc with a probability below e⁻[`ARC_RARITY`]
//! (union bound). None for curves: what is no arc for as long as chance would fill, or has fewer samples than its band has other outliers, is
//! missed. The result does not depend on the order of the rows. At most [`CENTERS_MAX`] windows of each size are looked at:
//! O(n) for n outliers.
//! *Reference.* Arias-Castro, Donoho and Huo, Adaptive multiscale detection of filamentary structures in a background of uniform random
//! points, Annals of Statistics 34(1), 2006; circles through drawn points: Fischler and Bolles 1981.

use std::f64::consts::PI;

use taut_points::OrderBy;

use super::super::CurveDoubt;

/// Most windows of each size: around so many outliers, evenly chosen in the order of their places.
const CENTERS_MAX: usize = 256;

/// Outliers in a window beside the middle one.
const WINDOWS: [usize; 4] = [16, 32, 64, 128];

/// Circles that are tried in each window.
const CIRCLES: usize = 192;

/// −ln of how seldom chance may put as many outliers into the band of any circle.
const ARC_RARITY: f64 = 3.5;

/// Bands with a larger share of the window tell nothing.
const SHARE_MAX: f64 = 0.5;

/// The circle through the origin: its curvature, and the unit vector to its center.
struct Circle {
    curvature: f64,
    normal: [f64; 2],
}

impl Circle {
    /// The circle through the origin and two places; none where those are one.
    fn through(q: [f64; 2], r: [f64; 2]) -> Option<Self> {
        let (q2, r2) = (q[0] * q[0] + q[1] * q[1], r[0] * r[0] + r[1] * r[1]);
        // The center c has q·c = |q|²/2 and r·c = |r|²/2.
        let det = q[0] * r[1] - q[1] * r[0];
        let scaled = [0.5 * (q2 * r[1] - r2 * q[1]), 0.5 * (r2 * q[0] - q2 * r[0])];
        let norm = scaled[0].hypot(scaled[1]);
        let sign = if det < 0.0 { -1.0 } else { 1.0 };
        let circle = Self { curvature: det.abs() / norm, normal: scaled.map(|x| sign * x / norm) };
        circle.curvature.is_finite().then_some(circle)
    }

    /// How far a place is from the circle.
    fn distance(&self, p: [f64; 2]) -> f64 {
        let square = p[0] * p[0] + p[1] * p[1];
        let off = p[0] * self.normal[0] + p[1] * self.normal[1] - 0.5 * self.curvature * square;
        // |p − c| − ρ without the difference of two large numbers.
        2.0 * off.abs() / (1.0 + (1.0 - 2.0 * self.curvature * off).max(0.0).sqrt())
    }
}

/// The first window in which more outliers than chance puts there lie within `width` of one circle; a share of the room around all outliers is
/// `free` for them.
pub(super) fn arc(outliers: &[(usize, [f64; 2])], free: f64, width: f64) -> Option<CurveDoubt> {
    let range = |k: usize| {
        let ends =
            |(low, high): (f64, f64), p: &(usize, [f64; 2])| (low.min(p.1[k]), high.max(p.1[k]));
        outliers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends)
    };
    let room = [range(0), range(1)];
    let mut order: Vec<&(usize, [f64; 2])> = outliers.iter().collect();
    order.order_by(&|a, b| a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1])));
    let sizes: Vec<usize> = WINDOWS.into_iter().filter(|&size| size < order.len()).collect();
    let step = order.len().div_ceil(CENTERS_MAX).max(1);
    let tried = order.len().div_ceil(step) * sizes.len() * CIRCLES;
    let most = (tried as f64).ln() + ARC_RARITY;
    let mut near: Vec<(f64, [f64; 2])> = Vec::with_capacity(order.len());
    for (row, center) in order.iter().copied().step_by(step) {
        near.clear();
        near.extend(order.iter().map(|(_, p)| {
            let p = [p[0] - center[0], p[1] - center[1]];
            (p[0] * p[0] + p[1] * p[1], p)
        }));
        let by_distance = |a: &(f64, [f64; 2]), b: &(f64, [f64; 2])| {
            a.0.total_cmp(&b.0).then(a.1[0].total_cmp(&b.1[0])).then(a.1[1].total_cmp(&b.1[1]))
        };
        if let Some(&largest) = sizes.last() {
            if largest + 1 < near.len() {
                near.select_nth_unstable_by(largest, by_distance);
                near.truncate(largest + 1);
            }
            near.sort_unstable_by(by_distance);
        }
        for &size in &sizes {
            // The first is the middle itself.
            let window = &near[1..=size];
            let reach = near[size].0.sqrt();
            // What of the disk may hold outliers, at most: beyond the outermost there are none.
            let side =
                |k: usize| (center[k] + reach).min(room[k].1) - (center[k] - reach).max(room[k].0);
            let area = free * (side(0) * side(1)).min(PI * reach * reach);
            // No circle through the middle of a disk of radius R runs more than πR within it.
            let share = 2.0 * width * PI * reach / area;
            if share < SHARE_MAX
                && let Some((found, evidence)) = fullest(window, width, share)
                && evidence > most
            {
                let expected = share * size as f64;
                return Some(CurveDoubt::Arc { row: *row as u64, rows: found, expected });
            }
        }
    }
    None
}

/// The most outliers of a window in the band of one circle, and the evidence that they are more than chance puts there.
fn fullest(window: &[(f64, [f64; 2])], width: f64, share: f64) -> Option<(usize, f64)> {
    let mut most = 0;
    let mut draw = Draw(0x9e37_79b9_7f4a_7c15);
    for _ in 0..CIRCLES {
        let [q, r] = [window[draw.below(window.len())].1, window[draw.below(window.len())].1];
        if let Some(circle) = Circle::through(q, r) {
            let found = window.iter().filter(|(_, p)| circle.distance(*p) <= width).count();
            most = most.max(found);
        }
    }
    // Two of them are there by choice.
    let (found, all) = (most.checked_sub(2)? as f64, (window.len() - 2) as f64);
    (found > share * all).then(|| (most, binomial(found, all, share)))
}

/// Chernoff's bound: −ln of the probability that at least so many of all have a property that each has with a probability.
fn binomial(found: f64, all: f64, share: f64) -> f64 {
    let term = |count: f64, expected: f64| {
        if count > 0.0 { count * (count / expected).ln() } else { 0.0 }
    };
    term(found, share * all) + term(all - found, (1.0 - share) * all)
}

/// Numbers of a fixed sequence (Knuth's linear congruential generator).
struct Draw(u64);

impl Draw {
    fn below(&mut self, count: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((u128::from(self.0) * count as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn unit(draw: &mut Draw) -> f64 {
        draw.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    /// So many places in a square of side 4, and so many on a circle of radius ½.
    fn places(seed: u64, anywhere: usize, on_circle: usize) -> Vec<(usize, [f64; 2])> {
        let mut draw = Draw(seed);
        let mut all: Vec<[f64; 2]> =
            (0..anywhere).map(|_| [(); 2].map(|()| 4.0 * unit(&mut draw) - 2.0)).collect();
        for _ in 0..on_circle {
            let (turn, r) = (TAU * unit(&mut draw), 0.5 + 0.04 * (unit(&mut draw) - 0.5));
            all.push([r * turn.cos(), r * turn.sin()]);
        }
        all.into_iter().enumerate().collect()
    }

    #[test]
    fn a_circle_passes_through_its_places() {
        let at = |turn: f64| [0.7 * (turn.cos() - 1.0), 0.7 * turn.sin()];
        let circle = Circle::through(at(0.4), at(-1.1)).expect("two places");
        assert!((circle.curvature - 1.0 / 0.7).abs() < 1e-12);
        assert!(circle.distance(at(2.5)) < 1e-12);
        assert!((circle.distance([0.3, 0.0]) - 0.3).abs() < 1e-12);
        let line = Circle::through([1.0, 1.0], [-2.0, -2.0]).expect("two places");
        assert!((line.distance([1.0, 0.0]) - 0.5f64.sqrt()).abs() < 1e-12);
        assert!(Circle::through([1.0, 1.0], [1.0, 1.0]).is_none_or(|c| c.curvature <= 1e-9));
        assert!(Circle::through([0.0; 2], [1.0, 1.0]).is_none());
    }

    #[test]
    fn a_sparse_circle_among_outliers_is_an_arc_and_chance_makes_none() {
        for seed in 0..crate::test_length::long_or(20, 8) {
            assert_eq!(arc(&places(seed, 150, 0), 1.0, 0.02), None, "{seed}");
            let found = arc(&places(seed, 150, 40), 1.0, 0.02);
            assert!(matches!(found, Some(CurveDoubt::Arc { .. })), "{seed}: {found:?}");
        }
        assert_eq!(arc(&places(1, 9, 0), 1.0, 0.02), None);
        assert_eq!(arc(&[], 1.0, 0.02), None);
        assert_eq!(arc(&vec![(0, [1.0, 2.0]); 200], 1.0, 0.02), None);
    }

    /// Of four coins all fall on one side with a probability of 1/16.
    #[test]
    fn chance_is_that_of_coins() {
        assert!((binomial(4.0, 4.0, 0.5) - 16f64.ln()).abs() < 1e-12);
        assert_eq!(binomial(2.0, 4.0, 0.5), 0.0);
    }
}
