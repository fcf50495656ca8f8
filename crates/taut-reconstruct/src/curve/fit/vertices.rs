//! Whether points are the vertices of their curves, told before any curve is known.
//!
//! *Problem.* Samples without noise need no fit, which takes longer on them than all the rest: it looks for bands where there are none.
//! *Idea.* Where points are off a parabola through a few of them by next to nothing beside their spacing, they are vertices. Where they
//! are off it by about their spacing, they are a blob within a band, whose residuals grow as the square root of the number of points;
//! if they grow faster it is the curve itself that is rugged, such as a coastline. Between the two only a fit can tell.
//! *Guarantee.* What most of [`PLACES_MAX`] places say, or of half as many at least where there are more points; O(log n) beside the index. Points
//! that are fewer than those of four long windows are not judged, as a fit is soon done.

use super::local::Window;
use super::parameters::{
    LONG_WINDOW_POINTS, PLACES_MAX, ROUGH_OFFSET_MIN, RUGGED_GROWTH_MIN, SHORT_WINDOW_POINTS,
    VERTEX_OFFSET_MAX,
};
use crate::curve::index::Index;

type Point = [f64; 2];

/// Whether most points are vertices.
pub(super) fn are_vertices(points: &[Point], index: &Index<'_>) -> bool {
    // So few are cheap to fit, and a long window is not much of their curve.
    if points.len() < 4 * LONG_WINDOW_POINTS {
        return false;
    }
    let (mut window, mut near) = (Window::default(), Vec::new());
    let (mut looked_at, mut smooth, mut rough, mut growths) = (0, 0, 0, Vec::new());
    for &at in points.iter().step_by(points.len().div_ceil(PLACES_MAX)) {
        near.clear();
        let mut deviation_of = |count: usize| {
            index.nearest(at, count, &mut near);
            let found = window.fit(at, near.iter().map(|&(_, i)| points[i as usize]))?;
            let radius = near.last()?.0.sqrt();
            Some((found.variance.sqrt(), 2.0 * radius / (count - 1) as f64))
        };
        if let (Some((short, spacing)), Some((long, _))) =
            (deviation_of(SHORT_WINDOW_POINTS), deviation_of(LONG_WINDOW_POINTS))
        {
            let share = short / spacing;
            looked_at += 1;
            rough += usize::from(share > ROUGH_OFFSET_MIN);
            // Where points are vertices, it is the bend of the curve that grows.
            if share < VERTEX_OFFSET_MAX {
                smooth += 1;
            } else {
                growths.push(long / short);
            }
        }
    }
    let is_most = |places: usize| 2 * places > looked_at;
    growths.sort_unstable_by(f64::total_cmp);
    is_most(smooth)
        || is_most(rough) && growths.get(growths.len() / 2).is_some_and(|&g| g > RUGGED_GROWTH_MIN)
}

#[cfg(test)]
mod tests {
    use taut_oblivious::hilbert_order;
    use taut_points::generate::curves::{CurveNoise, TestCurve, epsilon_sample, sample_curve};

    use super::*;

    fn judged(values: &[f64]) -> bool {
        let points: &[Point] = values.as_chunks().0;
        let order = hilbert_order(points.len(), |i| points[i]);
        let points: Vec<Point> = order.iter().map(|&i| points[i as usize]).collect();
        are_vertices(&points, &Index::new(&points))
    }

    #[test]
    fn samples_are_vertices_and_noise_is_not() {
        for name in ["circle", "flower5", "bumpy", "gear20", "multi4"] {
            let truth = TestCurve::named(name).expect("a known name").build_with(3000);
            assert!(judged(&epsilon_sample(&truth, 0.03, 1).points), "{name}");
            for per in [9.0, 20.0, 100.0, 1000.0] {
                let n = ((per * truth.length_over_feature) as usize).clamp(200, 50_000);
                for outliers in [0.0, 0.2] {
                    let noise = CurveNoise { delta: 0.05, outliers, ..CurveNoise::default() };
                    let noisy = sample_curve(&truth, n, &noise, 1).points;
                    assert!(!judged(&noisy), "{name} {per} {outliers}");
                }
            }
        }
    }

    #[test]
    fn few_points_and_one_place_are_not_judged() {
        assert!(!judged(&[]));
        assert!(!judged(&[1.0, 2.0]));
        assert!(!judged(&[3.0; 600]));
    }
}
