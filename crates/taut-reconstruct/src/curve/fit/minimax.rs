//! The parabola whose largest residual is least.
//!
//! *Problem.* Points (u, v): find a, b, c that minimize w = max |v − a − bu − cu²|.
//! *Idea.* On four points the best parabola misses each by the same E, on alternating sides, and E is a divided difference of the
//! third order (de la Vallée Poussin). Exchange one of the four for the point that is missed most, so that sides still alternate;
//! |E| grows, until no point is missed by more.
//! *Guarantee.* |E| ≤ w* ≤ max |residual|, so the gap is known; a handful of exchanges of O(m).
//! *Trap.* Two points at one u have no divided difference: a point that would join its double is not taken in, and the gap tells.
//! *Reference.* Remez, Comptes Rendus 198 (1934), 2063–2065; Cheney, Introduction to Approximation Theory, chapter 3.

use super::parameters::{EXCHANGES_MAX, GAP_MIN};
type Point = [f64; 2];

/// The best parabola of a window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimax {
    /// a, b, c.
    pub(super) coefficients: [f64; 3],
    /// The largest residual.
    pub(super) width: f64,
    /// No parabola has a smaller one.
    pub(super) lower: f64,
    /// The four points that prove it, by ascending u.
    pub(super) reference: [usize; 4],
}

/// The minimax parabola; none for fewer than four different u.
pub(super) fn minimax(points: &[Point]) -> Option<Minimax> {
    let mut reference = start(points)?;
    let mut best: Option<Minimax> = None;
    for _ in 0..EXCHANGES_MAX {
        let Some((coefficients, error)) = level(points, reference) else { break };
        let [a, b, c] = coefficients;
        let residual = |p: Point| p[1] - (a + p[0] * (b + p[0] * c));
        let (worst, width) = farthest(points, residual);
        let lower = error.abs();
        if best.is_none_or(|best| width < best.width) {
            let lower = best.map_or(lower, |best| best.lower.max(lower));
            best = Some(Minimax { coefficients, width, lower, reference });
        }
        if width <= lower * (1.0 + GAP_MIN) {
            break;
        }
        // Signs at the reference are +E, −E, +E, −E.
        let side = |place: usize| if place.is_multiple_of(2) { error > 0.0 } else { error < 0.0 };
        let above = residual(points[worst]) > 0.0;
        let u = points[worst][0];
        let after = reference.iter().filter(|&&i| points[i][0] < u).count();
        if reference.iter().any(|&i| points[i][0] == u) {
            let Some(same) = reference.iter().position(|&i| points[i][0] == u) else { break };
            if side(same) != above || reference[same] == worst {
                break;
            }
            reference[same] = worst;
            continue;
        }
        match after {
            0 if side(0) == above => reference[0] = worst,
            0 => reference = [worst, reference[0], reference[1], reference[2]],
            4 if side(3) == above => reference[3] = worst,
            4 => reference = [reference[1], reference[2], reference[3], worst],
            after if side(after) == above => reference[after] = worst,
            after => reference[after - 1] = worst,
        }
    }
    best
}

/// The point of the largest residual, and that residual: the largest of each eight first, which are found side by side.
fn farthest(points: &[Point], residual: impl Fn(Point) -> f64) -> (usize, f64) {
    const LANES: usize = 8;
    let (mut block, mut width) = (0, f64::NEG_INFINITY);
    for (number, chunk) in points.chunks(LANES).enumerate() {
        let most = chunk.iter().fold(0.0, |most: f64, &p| most.max(residual(p).abs()));
        if most > width {
            (block, width) = (number, most);
        }
    }
    let first = block * LANES;
    let last = points.len().min(first + LANES);
    let worst = (first..last).find(|&i| residual(points[i]).abs() == width).unwrap_or(first);
    (worst, width)
}

/// Four points spread over the window: next to the places where a Chebyshev polynomial alternates.
fn start(points: &[Point]) -> Option<[usize; 4]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in points {
        (low, high) = (low.min(p[0]), high.max(p[0]));
    }
    let mut reference = [usize::MAX; 4];
    for (k, place) in [0.0, 0.25, 0.75, 1.0].into_iter().enumerate() {
        let wanted = low + place * (high - low);
        let mut nearest = f64::INFINITY;
        for (i, p) in points.iter().enumerate() {
            let apart = (p[0] - wanted).abs();
            if apart < nearest && reference[..k].iter().all(|&j| points[j][0] < p[0]) {
                (nearest, reference[k]) = (apart, i);
            }
        }
        if reference[k] == usize::MAX {
            return None;
        }
    }
    Some(reference)
}

/// The parabola that misses four points by E, −E, E, −E, and E.
fn level(points: &[Point], reference: [usize; 4]) -> Option<([f64; 3], f64)> {
    let p = reference.map(|i| points[i]);
    // Weights of the divided difference: it is 0 for parabolas.
    let mut weights = [1.0; 4];
    for i in 0..4 {
        for j in 0..4 {
            if i != j {
                weights[i] /= p[i][0] - p[j][0];
            }
        }
    }
    let (mut sum, mut size) = (0.0, 0.0);
    for i in 0..4 {
        sum += weights[i] * p[i][1];
        size += weights[i].abs();
    }
    // The weight of the last point is positive, so those of the first are negative, positive, negative.
    let error = -sum / size;
    let value = |i: usize| p[i][1] - if i.is_multiple_of(2) { error } else { -error };
    // Newton's form through the first three.
    let (u0, u1, u2) = (p[0][0], p[1][0], p[2][0]);
    let d01 = (value(1) - value(0)) / (u1 - u0);
    let d12 = (value(2) - value(1)) / (u2 - u1);
    let c = (d12 - d01) / (u2 - u0);
    let b = d01 - c * (u0 + u1);
    let a = value(0) - u0 * (b + c * u0);
    (error.is_finite() && c.is_finite()).then_some(([a, b, c], error))
}
