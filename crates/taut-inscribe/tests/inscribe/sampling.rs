//! Random simple polygons, against the clearance of a grid of points.
//!
//! The clearance changes by at most |p − q| between p and q. So the best of a grid is at most the largest radius, and at least
//! that less half a diagonal of the grid, if the diagonal is so short that a grid point lies in the circle.

use super::common::{clearance, is_inside, proved, star_shaped, tour};
use crate::test_length::long_or;

/// Grid points along each axis.
const GRID: usize = 160;

fn compare_with_grid(ring: &[[f64; 2]]) {
    let (found, verdict) = proved(ring);
    let radius = found.answer.radius;
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in ring {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let step = [0, 1].map(|k| (high[k] - low[k]) / GRID as f64);
    let reach = 0.5 * step[0].hypot(step[1]);
    let mut best = 0.0f64;
    for i in 0..GRID {
        for j in 0..GRID {
            let p = [low[0] + (i as f64 + 0.5) * step[0], low[1] + (j as f64 + 0.5) * step[1]];
            let here = clearance(p, ring);
            if here > best && is_inside(p, ring) {
                best = here;
            }
        }
    }
    assert!(best <= verdict.upper * (1.0 + 1e-12), "{best} > {}: {ring:?}", verdict.upper);
    assert!(reach >= radius || radius <= best + reach * (1.0 + 1e-9), "{radius}: {ring:?}");
    // The center, by the plain arithmetic of these tests.
    let center = found.answer.center;
    assert!(is_inside(center, ring));
    assert!((clearance(center, ring) - radius).abs() <= 1e-12, "{ring:?}");
}

#[test]
fn star_shaped_polygons_agree_with_a_grid() {
    for seed in 0..30 {
        compare_with_grid(&star_shaped(seed, 5 + seed as usize * 3));
    }
}

#[test]
fn tours_agree_with_a_grid() {
    for seed in 0..30 {
        compare_with_grid(&tour(1000 + seed, 5 + seed as usize * 2));
    }
}

/// Seeds that were not looked at while the solver was written.
#[test]
fn polygons_kept_for_the_end_agree_with_a_grid() {
    for seed in (500..530).step_by(long_or(1, 3)) {
        compare_with_grid(&star_shaped(seed, 4 + (seed as usize - 500) * 3));
        compare_with_grid(&tour(2000 + seed, 4 + (seed as usize - 500) * 2));
    }
}

#[test]
fn many_vertices_take_few_cells() {
    for (seed, size) in [(1, 3000), (2, long_or(20_000, 8000))] {
        let (found, _) = proved(&star_shaped(seed, size));
        let json = found.to_json().len();
        assert!(json < 400_000, "{json} bytes");
        println!("{size} vertices: {} cells, {json} bytes", found.trace.iterations);
    }
    let (found, _) = proved(&tour(3, 600));
    println!("tour of 600: {} cells, {} bytes", found.trace.iterations, found.to_json().len());
}
