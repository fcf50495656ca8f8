//! Directions in which the polygon is narrow.

use crate::polygon::Segment;

use super::cell::Width;

/// Directions tried, evenly over half a turn.
const DIRECTIONS: usize = 256;

/// Rounds that refine the narrowest direction, each of which cuts the step to a quarter.
const ROUNDS: usize = 8;

/// The width of the polygon in a direction.
pub(super) fn width(edges: &[Segment], direction: [f64; 2]) -> Width {
    let [n1, n2] = direction;
    let at = |edge: &Segment| n1 * edge[0][0] + n2 * edge[0][1];
    let low = edges.iter().map(at).fold(f64::INFINITY, f64::min);
    let high = edges.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
    // With more than what rounding of the coordinates can change.
    let half = 0.5 * (high - low) + 64.0 * f64::EPSILON;
    Width { direction, square: half * half }
}

/// The direction in which the polygon is narrowest, or nearly so, and the one across it.
pub(super) fn narrow_directions(edges: &[Segment]) -> Vec<[f64; 2]> {
    let at = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let larger = cosine.abs().max(sine.abs());
        [cosine / larger, sine / larger]
    };
    // Of a direction of this length the width is that of a unit vector times the length.
    let narrowness = |angle: f64| {
        width(edges, at(angle)).square * angle.cos().abs().max(angle.sin().abs()).powi(2)
    };
    let mut step = std::f64::consts::PI / DIRECTIONS as f64;
    let all = (0..DIRECTIONS).map(|i| (narrowness(i as f64 * step), i as f64 * step));
    let mut best =
        all.fold((f64::INFINITY, 0.0), |best, next| if next.0 < best.0 { next } else { best });
    for _ in 0..ROUNDS {
        step *= 0.25;
        for i in -4..=4 {
            let angle = best.1 + f64::from(i) * step;
            let next = narrowness(angle);
            if next < best.0 {
                best = (next, angle);
            }
        }
    }
    vec![at(best.1), at(best.1 + std::f64::consts::FRAC_PI_2)]
}
