//! Closed forms, laws, and meshes of any size and none.

use super::*;
use crate::shapes::*;
use crate::test_length::long_or;

fn compare(reference: &Shape, result: &Shape) -> SurfaceQuality {
    compare_surfaces(&reference.view(), &result.view(), &SurfaceOptions::default())
}

fn few(reference: &Shape, result: &Shape, samples: usize) -> SurfaceQuality {
    compare_surfaces(&reference.view(), &result.view(), &SurfaceOptions { samples, seed: 1 })
}

/// The mean of N independent samples of something from [0, most] is off by most/2/√N at the most, as deviations go; five of these.
/// One sample from each part of the area is never worse.
fn sampled(most: f64) -> f64 {
    2.5 * most / 200_000f64.sqrt()
}

fn near(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} is not {b}");
}

#[test]
fn parallel_squares_are_as_far_apart_as_they_are() {
    let quality = compare(&square(8), &square(5).moved([0.0, 0.0, 0.25]));
    near(quality.diagonal, 2f64.sqrt(), 1e-15);
    for side in [quality.reference_to_result, quality.result_to_reference] {
        near(side.hausdorff, 0.25, 1e-15);
        // 200 000 sums up to 50 000 in blocks: a relative error of 2048 + 98 roundings at the most.
        near(side.mean, 0.25, 0.25 * 2146.0 * f64::EPSILON);
        near(side.hausdorff_relative, 0.25 / 2f64.sqrt(), 1e-15);
        near(side.mean_relative, 0.25 / 2f64.sqrt(), 1e-12);
        near(side.normal_consistency.unwrap(), 1.0, 1e-12);
        assert_eq!(side.samples, 200_000);
    }
    assert_eq!(quality.reference_to_result.vertices, 81);
    assert_eq!(quality.result_to_reference.vertices, 36);
    near(quality.normal_consistency.unwrap(), 1.0, 1e-12);
}

/// Of a unit square the strip that sticks out by d is, in the mean, d/2 away, and all of the square d²/2.
#[test]
fn squares_moved_in_their_plane_have_closed_forms() {
    let d = 0.3;
    let quality = compare(&square(4), &square(4).moved([d, 0.0, 0.0]));
    for side in [quality.reference_to_result, quality.result_to_reference] {
        near(side.hausdorff, d, 1e-15);
        near(side.mean, d * d / 2.0, sampled(d));
    }
    near(quality.mean(), d * d / 2.0, sampled(d));
}

/// A square turned by an angle about its side: x is sin·x away from the other, whichever is asked.
#[test]
fn a_tilted_square_has_closed_forms() {
    let (sin, cos) = 0.4f64.sin_cos();
    let mut tilted = square(6);
    tilted.map(|[x, y, _]| [cos * x, y, sin * x]);
    let quality = compare(&square(3), &tilted);
    for side in [quality.reference_to_result, quality.result_to_reference] {
        near(side.hausdorff, sin, 1e-15);
        near(side.mean, sin / 2.0, sampled(sin));
        near(side.normal_consistency.unwrap(), cos, 1e-12);
    }
}

#[test]
fn distances_have_a_direction() {
    let mut half = square(4);
    half.map(|[x, y, z]| [0.5 * x, y, z]);
    let quality = compare(&square(4), &half);
    near(quality.reference_to_result.hausdorff, 0.5, 1e-15);
    near(quality.reference_to_result.mean, 0.125, sampled(0.5));
    assert!(quality.result_to_reference.hausdorff < 1e-15);
    assert_eq!(quality.hausdorff(), quality.reference_to_result.hausdorff);
}

/// A vertex pulled out is seen without any sample, and from one side.
#[test]
fn a_spike_is_seen_by_its_vertex() {
    let flat = square(10);
    let mut spiked = flat.clone();
    spiked.vertices[60][2] = 7.0;
    let quality = few(&flat, &spiked, 0);
    assert_eq!(
        (quality.result_to_reference.hausdorff, quality.result_to_reference.samples),
        (7.0, 0)
    );
    near(quality.result_to_reference.mean, 7.0 / 121.0, 1e-15);
    assert!(quality.reference_to_result.hausdorff < 0.11);
    assert_eq!(quality.normal_consistency, None);
}

/// Each refinement of a sphere quarters the height of the chords.
#[test]
fn spheres_converge_as_the_square_of_their_edges() {
    let finest = sphere(6);
    let samples = long_or(20_000, 5000);
    let found: Vec<SurfaceQuality> = (1..4).map(|k| few(&finest, &sphere(k), samples)).collect();
    for pair in found.windows(2) {
        for of in [SurfaceQuality::hausdorff, SurfaceQuality::mean] {
            let ratio = of(&pair[0]) / of(&pair[1]);
            assert!((3.0..5.0).contains(&ratio), "{ratio}");
        }
        assert!(pair[0].normal_consistency < pair[1].normal_consistency);
    }
    assert!(found[2].normal_consistency > Some(0.99));
    near(found[0].diagonal, 12f64.sqrt(), 1e-14);
    // All vertices of a coarse sphere are those of the fine one.
    assert_eq!((found[0].edges.both, found[0].triangles.both), (0, 0));
    let shells = few(&finest, &sphere(6).scaled(1.25), samples);
    // The chords of the larger sphere are 1.25·(1 − cos) deep, with edges of at most 0.03.
    near(shells.mean(), 0.25, 1e-3);
    near(shells.hausdorff(), 0.25, 1e-3);
}

#[test]
fn a_mesh_is_next_to_itself_whatever_its_names() {
    let ring = torus(30, 20);
    let quality = compare(&ring, &ring.shuffled(3));
    assert!(quality.hausdorff() < 1e-14 && quality.normal_consistency > Some(0.9999));
    assert_eq!(quality.edges, Shared { reference: 1800, result: 1800, both: 1800 });
    assert_eq!((quality.triangles.of_reference(), quality.triangles.of_result()), (1.0, 1.0));
}

/// Samples ride on their triangles, so that all distances stay when both meshes are turned and moved.
#[test]
fn turning_and_moving_both_changes_nothing() {
    let (mut one, mut other) = (sphere(3), torus(14, 9).scaled(0.5));
    let before = few(&one, &other, 2000);
    let (s, c) = 1.1f64.sin_cos();
    for shape in [&mut one, &mut other] {
        shape.map(|[x, y, z]| [c * x - s * y, s * x + c * y, z]);
        shape.map(|[x, y, z]| [x + 5.0, c * y - s * z - 3.0, s * y + c * z + 1.0]);
    }
    let after = few(&one, &other, 2000);
    for (a, b) in [
        (before.reference_to_result, after.reference_to_result),
        (before.result_to_reference, after.result_to_reference),
    ] {
        near(a.hausdorff, b.hausdorff, 1e-13);
        near(a.mean, b.mean, 1e-13);
        // From outside, the nearest place is an edge for many samples: of its two triangles roundings choose one, and normals differ.
        near(a.normal_consistency.unwrap(), b.normal_consistency.unwrap(), 1e-2);
    }
}

#[test]
fn common_edges_and_triangles_are_counted_by_place() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let one = Shape::new(&corners, &[[0, 1, 2], [0, 2, 3]]);
    // The other diagonal, other numbers, −0 for 0, a copy, and a triangle that is a point.
    let names =
        [[-0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, -0.0, 0.0], [1.0, 0.0, -0.0], [0.0, 1.0, -0.0]];
    let other = Shape::new(&names, &[[2, 3, 0], [1, 0, 3], [3, 4, 1], [0, 4, 1], [1, 1, 2]]);
    let quality = few(&one, &other, 10);
    assert_eq!(quality.edges, Shared { reference: 5, result: 5, both: 4 });
    assert_eq!(quality.triangles, Shared { reference: 2, result: 2, both: 0 });
    let part = few(&one, &Shape::new(&corners, &[[2, 0, 1]]), 10);
    assert_eq!(part.edges, Shared { reference: 5, result: 3, both: 3 });
    assert_eq!((part.triangles.of_reference(), part.triangles.of_result()), (0.5, 1.0));
}

/// All that is relative stays, bit by bit, when both meshes are scaled by a power of two.
#[test]
fn coordinates_of_any_size_are_measured() {
    let (reference, result) = (sphere(3), torus(12, 10).scaled(0.4));
    let plain = few(&reference, &result, 3000);
    for power in [-1000, -500, -1, 3, 500, 1000] {
        let factor = 2f64.powi(power);
        let scaled = few(&reference.clone().scaled(factor), &result.clone().scaled(factor), 3000);
        let (a, b) = (plain.reference_to_result, scaled.reference_to_result);
        assert_eq!(
            (a.hausdorff_relative, a.mean_relative),
            (b.hausdorff_relative, b.mean_relative)
        );
        assert_eq!((factor * a.hausdorff, factor * a.mean), (b.hausdorff, b.mean));
        assert_eq!(plain.normal_consistency, scaled.normal_consistency);
        assert_eq!(factor * plain.diagonal, scaled.diagonal);
    }
    for factor in [1e-150, 1e150, 1e-305, 1e305] {
        let scaled = few(&reference.clone().scaled(factor), &result.clone().scaled(factor), 3000);
        near(
            scaled.result_to_reference.mean_relative,
            plain.result_to_reference.mean_relative,
            1e-9,
        );
        near(scaled.result_to_reference.mean / factor, plain.result_to_reference.mean, 1e-9);
    }
    let far = few(&reference, &result.scaled(1e200), 100);
    assert!(far.hausdorff() > 1e200 && far.hausdorff().is_finite());
    let end = [[f64::MAX; 3], [-f64::MAX; 3], [f64::MAX, 0.0, 0.0]];
    let end = few(&Shape::new(&end, &[[0, 1, 2]]), &tetrahedron(), 100);
    assert!(end.diagonal == f64::INFINITY && end.reference_to_result.hausdorff_relative < 1.0);
}

#[test]
fn nothing_is_far_from_something() {
    let (nothing, something) = (Shape::new(&[[5.0; 3]], &[]), tetrahedron());
    let lost = few(&something, &nothing, 100);
    let infinite = f64::INFINITY;
    assert_eq!(
        (lost.reference_to_result.hausdorff, lost.reference_to_result.mean),
        (infinite, infinite)
    );
    assert_eq!(lost.reference_to_result.hausdorff_relative, infinite);
    assert_eq!(lost.result_to_reference, SurfaceDistance::default());
    assert_eq!((lost.edges.of_reference(), lost.edges.of_result()), (0.0, 1.0));
    let invented = few(&nothing, &something, 100);
    assert_eq!((invented.result_to_reference.mean_relative, invented.diagonal), (infinite, 0.0));
    let none = few(&nothing, &nothing, 100);
    assert_eq!((none.hausdorff(), none.mean(), none.normal_consistency), (0.0, 0.0, None));
}

#[test]
fn what_has_no_area_is_measured_at_its_vertices() {
    let segment = Shape::new(&[[0.0, 0.0, 1.0], [0.5, 0.0, 1.0], [2.0, 0.0, 1.0]], &[[0, 1, 2]]);
    let point = Shape::new(&[[9.0; 3], [1.0, 0.0, -1.0]], &[[1, 1, 1]]);
    let quality = few(&segment, &point, 100);
    assert_eq!((quality.reference_to_result.samples, quality.reference_to_result.vertices), (0, 3));
    assert_eq!(quality.reference_to_result.hausdorff, 5f64.sqrt());
    near(quality.reference_to_result.mean, (2.0 * 5f64.sqrt() + 4.25f64.sqrt()) / 3.0, 1e-15);
    assert_eq!(
        (quality.result_to_reference.hausdorff, quality.result_to_reference.vertices),
        (2.0, 1)
    );
    assert_eq!(quality.normal_consistency, None);
    assert_eq!(few(&point, &point, 100).reference_to_result.hausdorff_relative, 0.0);
    // Beside triangles with area they count as what they are.
    let both = few(&square(2).and(&segment), &square(2), 1000);
    near(both.reference_to_result.hausdorff, 2f64.sqrt(), 1e-15);
    assert_eq!(both.reference_to_result.samples, 1000);
}

#[test]
fn the_seed_counts_and_threads_do_not() {
    let (reference, result) = (sphere(4), torus(40, 30));
    let samples = long_or(20_000, 6000);
    let of = |seed| {
        let options = SurfaceOptions { samples, seed };
        compare_surfaces(&reference.view(), &result.view(), &options)
    };
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
    let one = pool(1).install(|| of(1));
    for threads in [2, 8] {
        assert_eq!(format!("{:?}", pool(threads).install(|| of(1))), format!("{one:?}"));
    }
    let other = of(2);
    assert_ne!(other.reference_to_result.mean, one.reference_to_result.mean);
    // Distances below 3, five deviations of either mean.
    near(other.mean(), one.mean(), 2.0 * 5.0 * 1.5 / (samples as f64).sqrt());
}
