//! Surfaces whose parts and handles are known: all points used, nothing crossed.

#[path = "surface_any/judge.rs"]
mod judge;
#[path = "surface_any/points.rs"]
mod points;

use judge::{assert_exact, closed, found};
use points::{Point, chances, circle, cube, sphere, tube};
use taut_reconstruct::{SurfaceMode, SurfaceOptions, looks_one_sided};

use std::f64::consts::{PI, TAU};

#[test]
fn a_random_sphere() {
    assert_exact(&closed(&sphere(3_000, [0.0; 3], 1.0, 1)), 1, 0);
}

#[test]
fn a_tetrahedron_a_cube_and_an_octahedron() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_exact(&closed(&corners), 1, 0);
    assert_exact(&closed(&cube(1)), 1, 0);
    let octahedron =
        [0, 1, 2].map(|k| [1.0, -1.0].map(|x| [0, 1, 2].map(|i| if i == k { x } else { 0.0 })));
    let found = closed(octahedron.as_flattened());
    assert_exact(&found, 1, 0);
    assert_eq!(found.triangles.len(), 8);
}

#[test]
fn a_torus_and_a_knot() {
    assert_exact(&closed(&tube(circle(false), 0.3, 60, 20)), 1, 1);
    assert_exact(&closed(&tube(trefoil, 0.35, 240, 20)), 1, 1);
}

#[test]
fn rings_that_are_linked() {
    let mut both = tube(circle(false), 0.25, 60, 16);
    both.extend(tube(circle(true), 0.25, 60, 16));
    assert_exact(&closed(&both), 2, 2);
}

#[test]
fn a_sphere_within_a_sphere() {
    let mut both = sphere(2_000, [0.0; 3], 2.0, 2);
    both.extend(sphere(500, [0.0; 3], 1.0, 3));
    let found = closed(&both);
    assert_eq!((found.topology.components.len(), found.topology.genus), (2, Some(0)));
    assert!(found.is_closed() && found.is_through_all());
}

#[test]
fn grids_on_a_cube() {
    for edge in [2, 3, 10] {
        assert_exact(&closed(&cube(edge)), 1, 0);
    }
}

/// Their sides are flat but for roundings, which spheres made of roundings would take for signs.
#[test]
fn sharp_wedges() {
    for angle in [PI / 2.0, PI / 3.0, PI / 6.0, PI / 9.0, PI / 12.0] {
        for steps in [16, 30] {
            assert_exact(&closed(&wedge(angle, steps)), 1, 0);
        }
    }
}

#[test]
fn rings_on_common_circles() {
    assert_exact(&closed(&rings(20, 64)), 1, 0);
}

#[test]
fn a_thousand_spheres() {
    let mut points = Vec::new();
    for k in 0..1000usize {
        let center = [k % 10, k / 10 % 10, k / 100].map(|x| 4.0 * x as f64);
        points.extend(sphere(100, center, 1.0, 100 + k as u64));
    }
    assert_exact(&closed(&points), 1000, 0);
}

#[test]
fn soup_meets_itself_nowhere() {
    let mut chance = chances(5);
    let soup: Vec<_> = (0..3_000).map(|_| [chance(), chance(), chance()]).collect();
    for mode in [SurfaceMode::Closed, SurfaceMode::Open] {
        let found = found(&soup, &SurfaceOptions { mode, ..Default::default() });
        assert!(mode == SurfaceMode::Open || found.topology.is_closed());
    }
}

#[test]
fn a_half_sphere_has_one_loop() {
    let mut half = sphere(8_000, [0.0; 3], 1.0, 7);
    half.retain(|p| p[2] > 0.0);
    let found = found(&half, &SurfaceOptions { mode: SurfaceMode::Open, ..Default::default() });
    let t = &found.topology;
    assert_eq!((t.components.len(), t.boundary_loops.len(), t.genus), (1, 1, Some(0)));
    assert!(found.is_through_all() && found.topology.is_manifold());
}

#[test]
fn parallel_sheets_are_two() {
    let mut chance = chances(8);
    let count = 1_600;
    let gap = 5.0 / f64::from(count).sqrt();
    let sheets: Vec<_> =
        (0..2 * count).map(|k| [chance(), chance(), if k < count { 0.0 } else { gap }]).collect();
    let found = found(&sheets, &SurfaceOptions { mode: SurfaceMode::Open, ..Default::default() });
    let t = &found.topology;
    assert_eq!((t.components.len(), t.boundary_loops.len(), t.genus), (2, 2, Some(0)));
}

#[test]
fn a_band_with_one_side_is_told() {
    let mut chance = chances(9);
    let mut band = |turns: f64| -> Vec<_> {
        let point = |_| {
            let (t, w) = (2.0 * PI * chance(), (2.0 * chance() - 1.0) / 3.0);
            let (r, z) = (1.0 + w * (turns * t).cos(), w * (turns * t).sin());
            [r * t.cos(), r * t.sin(), z]
        };
        (0..4_000).map(point).collect()
    };
    let options = SurfaceOptions { mode: SurfaceMode::Open, ..Default::default() };
    assert!(looks_one_sided(&found(&band(0.5), &options).solution));
    let plain = found(&band(1.0), &options);
    assert!(!looks_one_sided(&plain.solution));
    assert_eq!((plain.topology.components.len(), plain.topology.boundary_loops.len()), (1, 2));
}

/// The trefoil knot.
fn trefoil(t: f64) -> Point {
    [t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -(3.0 * t).sin()]
}

/// A wedge: two squares that meet in an edge at an angle, with the back and the sides that close it.
fn wedge(angle: f64, steps: usize) -> Vec<Point> {
    let half = (angle / 2.0).tan();
    let step = 1.0 / steps as f64;
    let mut points = Vec::new();
    for i in 0..=steps {
        let x = i as f64 * step;
        // How far the sides are apart at x, in steps.
        let high = x * half;
        let layers = ((2.0 * high / step).ceil() as usize).max(1);
        for j in 0..=steps {
            let y = j as f64 * step;
            let is_rim = j == 0 || j == steps || i == steps;
            for k in 0..=layers {
                let is_face = k == 0 || k == layers;
                if (is_face || is_rim) && !(i == 0 && k > 0) {
                    points.push([x, y, high * (2.0 * k as f64 / layers as f64 - 1.0)]);
                }
            }
        }
    }
    points
}

/// A cylinder of rings that are exactly alike, between two disks of rings.
fn rings(count: usize, around: usize) -> Vec<Point> {
    let step = TAU / around as f64;
    let ring = |radius: f64, z: f64, count: usize| {
        (0..count).map(move |k| {
            let t = TAU * k as f64 / count as f64;
            [radius * t.cos(), radius * t.sin(), z]
        })
    };
    let mut points: Vec<Point> =
        (0..count).flat_map(|i| ring(1.0, i as f64 * step, around)).collect();
    let top = (count - 1) as f64 * step;
    for z in [0.0, top] {
        let disks = (around as f64 / TAU) as usize;
        for k in 1..disks {
            let radius = k as f64 / disks as f64;
            points.extend(ring(radius, z, (around as f64 * radius) as usize));
        }
        points.push([0.0, 0.0, z]);
    }
    points
}
