//! Surfaces whose parts and handles are known: all points used, nothing crossed.

use judge::{assert_exact, closed, found};
use points::{Point, chances, circle, cube, sphere, tube};
use taut_points::Points;
use taut_reconstruct::{SurfaceMethod, SurfaceMode, SurfaceOptions, looks_one_sided, surface};

use std::f64::consts::{PI, TAU};

use crate::surface_any::judge;
use crate::surface_any::points;

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

/// Cells whose spheres are centered beyond one of their facets say that they are of the outside.
#[test]
fn tetrahedra_of_any_shape_and_few_points_at_will() {
    let mut chance = chances(11);
    for count in [4, 4, 4, 4, 4, 4, 4, 4, 5, 6, 8, 12, 20] {
        let points: Vec<Point> = (0..count).map(|_| [chance(), chance(), chance()]).collect();
        let found = closed(&points);
        assert!(found.is_closed() && found.topology.genus == Some(0), "{points:?}");
        assert!(count > 4 || found.triangles.len() == 4, "{points:?}");
    }
}

/// The star of the center holds all cells, and changes of it are not worth their time.
#[test]
fn the_center_of_a_sphere_is_inside() {
    let mut points = sphere(2_000, [0.0; 3], 1.0, 21);
    points.push([0.0; 3]);
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    let found = surface(&view, &SurfaceOptions::default()).expect("space is spanned");
    assert_eq!(found.answer.unused.interior, [2_000]);
    assert!(found.check(&view).expect("true").certified);
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

/// Turned, or with points off by a little, the squares of their sides are flat cells between other spheres.
#[test]
fn sharp_wedges_turned_and_shaken() {
    let mut chance = chances(12);
    for (angle, steps) in [(PI / 6.0, 20), (PI / 9.0, 33), (PI / 12.0, 20)] {
        for off in [0.0, 1e-12, 1e-9, 1e-6, 1e-3] {
            let shaken = wedge(angle, steps).into_iter().map(|p| {
                let [x, y, z] = p.map(|x| x + off / steps as f64 * (2.0 * chance() - 1.0));
                // By 1 about the axis of z, then by 2 about that of x.
                let ((s, c), (t, d)) = (1f64.sin_cos(), 2f64.sin_cos());
                let (x, y) = (c * x - s * y, s * x + c * y);
                [x, d * y - t * z, t * y + d * z]
            });
            assert_exact(&closed(&shaken.collect::<Vec<_>>()), 1, 0);
        }
    }
}

/// A body that is wide, narrow and wide again, of rings of 64 points without its ends.
#[test]
fn a_torso_of_rings() {
    let count = 12_947;
    let high = f64::from((count + 63) / 64);
    let place = |i: i32| {
        let (ring, at) = (f64::from(i / 64), f64::from(i % 64));
        let along = TAU * ring / high;
        let radius = 40.0 + 12.0 * along.cos() + 5.0 * (3.0 * along).sin();
        let (sin, cos) = (TAU * at / 64.0).sin_cos();
        [radius * cos, radius * sin, 3.9 * ring]
    };
    assert_exact(&closed(&(0..count).map(place).collect::<Vec<_>>()), 1, 0);
}

#[test]
fn rings_on_common_circles() {
    assert_exact(&closed(&rings(20, 64)), 1, 0);
}

#[test]
fn many_spheres() {
    let mut points = Vec::new();
    let count = crate::test_length::long_or(1000, 300);
    for k in 0..count {
        let center = [k % 10, k / 10 % 10, k / 100].map(|x| 4.0 * x as f64);
        points.extend(sphere(100, center, 1.0, 100 + k as u64));
    }
    assert_exact(&closed(&points), count, 0);
}

#[test]
fn soup_meets_itself_nowhere() {
    let mut chance = chances(5);
    let soup: Vec<_> = (0..3_000).map(|_| [chance(), chance(), chance()]).collect();
    for mode in [SurfaceMode::Closed, SurfaceMode::Open] {
        let found = found(
            &soup,
            &SurfaceOptions { method: SurfaceMethod::Tree(mode), ..Default::default() },
        );
        assert!(mode == SurfaceMode::Open || found.topology.is_closed());
    }
}

#[test]
fn a_half_sphere_has_one_loop() {
    let mut half = sphere(8_000, [0.0; 3], 1.0, 7);
    half.retain(|p| p[2] > 0.0);
    let found = found(
        &half,
        &SurfaceOptions { method: SurfaceMethod::Tree(SurfaceMode::Open), ..Default::default() },
    );
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
    let found = found(
        &sheets,
        &SurfaceOptions { method: SurfaceMethod::Tree(SurfaceMode::Open), ..Default::default() },
    );
    let t = &found.topology;
    assert_eq!((t.components.len(), t.boundary_loops.len(), t.genus), (2, 2, Some(0)));
}

#[test]
fn a_band_with_one_side_has_one_loop() {
    for (count, seed) in [(300, 1), (1_000, 2), (4_000, 9), (4_000, 10)] {
        let found = found(&band(count, 0.5, seed), &open());
        assert!(looks_one_sided(&found.solution));
        let [part] = found.solution.answer.topology.components[..] else { panic!("one part") };
        assert!(!part.orientable);
        assert_eq!((part.boundary_loops, part.genus), (1, Some(1)), "{count} points, seed {seed}");
        assert!(found.topology.is_manifold() && found.is_through_all());
        assert_eq!(found.topology.euler_characteristic, 0);
    }
}

#[test]
fn a_band_with_two_sides_keeps_them() {
    for seed in [9, 10] {
        let found = found(&band(4_000, 1.0, seed), &open());
        assert!(!looks_one_sided(&found.solution));
        let t = &found.topology;
        assert_eq!((t.components.len(), t.boundary_loops.len(), t.genus), (1, 2, Some(0)));
    }
}

/// Neither the order of the rows nor the unit decides where the two labelings meet.
#[test]
fn a_band_with_one_side_is_a_function_of_its_points() {
    let points = band(1_000, 0.5, 3);
    let last = points.len() as u32 - 1;
    let triangles = |points: &[Point], row: &dyn Fn(u32) -> u32| {
        let mut all = found(points, &open()).triangles;
        for triangle in &mut all {
            *triangle = triangle.map(row);
            triangle.sort_unstable();
        }
        all.sort_unstable();
        all
    };
    let plain = triangles(&points, &|row| row);
    let turned: Vec<Point> = points.iter().rev().copied().collect();
    assert_eq!(triangles(&turned, &|row| last - row), plain);
    let scaled: Vec<Point> = points.iter().map(|point| point.map(|x| x / 1024.0)).collect();
    assert_eq!(triangles(&scaled, &|row| row), plain);
}

/// Where the surface may have boundaries.
fn open() -> SurfaceOptions<'static> {
    SurfaceOptions { method: SurfaceMethod::Tree(SurfaceMode::Open), ..Default::default() }
}

/// Random points of a band around the unit circle, two thirds wide, with so many turns: half a turn makes a Möbius band.
fn band(count: usize, turns: f64, seed: u64) -> Vec<Point> {
    let mut chance = chances(seed);
    let point = |_| {
        let (t, w) = (TAU * chance(), (2.0 * chance() - 1.0) / 3.0);
        let (r, z) = (1.0 + w * (turns * t).cos(), w * (turns * t).sin());
        [r * t.cos(), r * t.sin(), z]
    };
    (0..count).map(point).collect()
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

/// Random points of a plate 0.8 mean spacings thick: the labels of the tree alone had two plates with a point unused, and one with a handle.
#[test]
fn plates_thinner_than_the_spacing() {
    let (count, thickness) = (1_500, 0.8);
    let (wide, deep) = (2.0, 1.4);
    let mut high = 0.1;
    for _ in 0..20 {
        let area: f64 = 2.0 * (wide * deep + high * (wide + deep));
        high = thickness * (area / count as f64).sqrt();
    }
    let size = [wide, deep, high];
    for seed in 0..12 {
        let lots: Vec<f64> =
            taut_points::generate(taut_points::Distribution::Uniform, count, 4, seed)
                .expect("valid");
        let sides = [[1, 2, 0], [0, 2, 1], [0, 1, 2]];
        let areas = sides.map(|[i, j, _]| size[i] * size[j]);
        let place = |&[lot, far, u, v]: &[f64; 4]| {
            let mut left = lot * areas.iter().sum::<f64>();
            let side = areas.iter().position(|area| {
                left -= area;
                left < 0.0
            });
            let [i, j, k] = sides[side.unwrap_or(2)];
            let mut point = [0.0; 3];
            point[i] = size[i] * u;
            point[j] = size[j] * v;
            point[k] = if far < 0.5 { 0.0 } else { size[k] };
            point
        };
        let points: Vec<Point> = lots.as_chunks::<4>().0.iter().map(place).collect();
        assert_exact(&closed(&points), 1, 0);
    }
}
