//! Points inside from which ascents start, and directions in which the polygon is narrow.

use crate::polygon::Segment;

use super::cell::Width;

/// Lines along each axis on which middles of the polygon are starts.
const LINES: usize = 16;

/// Directions tried, evenly over half a turn.
const DIRECTIONS: usize = 256;

/// Rounds that refine the narrowest direction, each of which cuts the step to a quarter.
const ROUNDS: usize = 8;

/// The middles of the parts of horizontal and vertical lines that are inside.
pub(super) fn centers(edges: &[Segment], extent: [f64; 2]) -> Vec<[f64; 2]> {
    let mut found = vec![];
    for axis in 0..2 {
        let other = 1 - axis;
        for line in 0..LINES {
            let level = extent[axis] * (line as f64 + 0.5) / LINES as f64;
            let crossing = |[a, b]: &Segment| {
                let crosses = (a[axis] <= level) != (b[axis] <= level);
                let share = (level - a[axis]) / (b[axis] - a[axis]);
                crosses.then(|| a[other] + share * (b[other] - a[other]))
            };
            let mut crossings: Vec<f64> = edges.iter().filter_map(crossing).collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let mut center = [level; 2];
                center[other] = 0.5 * (pair[0] + pair[1]);
                found.push(center);
            }
        }
    }
    found
}

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
