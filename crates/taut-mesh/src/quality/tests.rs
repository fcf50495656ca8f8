//! Closed forms, brute force, and curves doctored in every way that [`Quality`] has to notice.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::edge_score;

fn closed(vertices: &[[f64; 2]]) -> Polyline<'_> {
    Polyline { vertices, closed: true }
}

fn open(vertices: &[[f64; 2]]) -> Polyline<'_> {
    Polyline { vertices, closed: false }
}

/// A regular polygon of n vertices.
fn circle(n: usize, radius: f64, center: [f64; 2]) -> Vec<[f64; 2]> {
    let at = |k: usize| (TAU * k as f64 / n as f64).sin_cos();
    (0..n).map(at).map(|(sin, cos)| [center[0] + radius * cos, center[1] + radius * sin]).collect()
}

#[test]
fn concentric_circles_are_as_far_apart_as_their_radii() {
    let (truth, found) = (circle(4000, 1.0, [0.0; 2]), circle(2000, 1.25, [0.0; 2]));
    let quality = compare(&[closed(&truth)], &[closed(&found)]);
    for distance in [
        quality.vertex_rms,
        quality.vertex_max,
        quality.hausdorff,
        quality.hausdorff_found_to_truth,
        quality.hausdorff_truth_to_found,
    ] {
        assert!((distance - 0.25).abs() < 1e-5, "{quality:?}");
    }
    assert!(quality.topology_right(), "{quality:?}");
    assert_eq!((quality.loops_found, quality.loops_truth), (1, 1));
}

#[test]
fn vertices_on_the_curve_still_leave_the_height_of_the_arcs() {
    let (truth, found) = (circle(20_000, 1.0, [3.0, -2.0]), circle(12, 1.0, [3.0, -2.0]));
    let quality = compare(&[closed(&truth)], &[closed(&found)]);
    let height = 1.0 - (TAU / 24.0).cos();
    assert!(quality.vertex_max < 1e-7);
    assert!((quality.hausdorff_found_to_truth - height).abs() < 1e-6, "{quality:?}");
    assert!((quality.hausdorff_truth_to_found - height).abs() < 1e-6, "{quality:?}");
    assert!(quality.topology_right());
}

#[test]
fn one_sided_distances_differ_where_a_part_is_missing() {
    let truth: Vec<[f64; 2]> = (0..=100).map(|k| [f64::from(k), 0.0]).collect();
    let found: Vec<[f64; 2]> = (20..=95).map(|k| [f64::from(k), 1.0]).collect();
    let quality = compare(&[open(&truth)], &[open(&found)]);
    assert!((quality.hausdorff_found_to_truth - 1.0).abs() < 1e-12);
    assert!((quality.hausdorff_truth_to_found - 401f64.sqrt()).abs() < 1e-12);
    assert!(quality.topology_right());
}

#[test]
fn doctored_curves_are_noticed() {
    let truth = circle(4000, 1.0, [0.0; 2]);
    let good = circle(200, 1.0, [0.0; 2]);
    let judge = |found: &[Polyline<'_>]| compare(&[closed(&truth)], found);
    assert!(judge(&[closed(&good)]).topology_right());
    let reversed: Vec<_> = good.iter().rev().copied().collect();
    assert!(judge(&[closed(&reversed)]).topology_right());

    // An end where there is none, nothing, and the same twice.
    assert!(!judge(&[open(&good)]).homeomorphic);
    assert!(!judge(&[]).homeomorphic);
    let twice = judge(&[closed(&good), closed(&good)]);
    assert!(!twice.homeomorphic && twice.crossings > 0);

    // A shortcut across: connectivity of the vertices is right, the distance is not.
    let shortcut = judge(&[closed(&good[..120])]);
    assert!(shortcut.hausdorff_truth_to_found > 0.7, "{shortcut:?}");
    assert!(shortcut.hausdorff_found_to_truth > 0.6, "{shortcut:?}");

    // A zigzag: two vertices exchanged.
    let mut zigzag = good.clone();
    zigzag.swap(50, 53);
    let zigzag = judge(&[closed(&zigzag)]);
    assert!(!zigzag.homeomorphic && zigzag.vertex_max < 1e-6);

    // Around twice: no step goes back, and edges lie on each other; a little off, they cross.
    let double: Vec<_> = good.iter().chain(&good).copied().collect();
    let double = judge(&[closed(&double)]);
    assert!(!double.homeomorphic && double.crossings >= 200, "{double:?}");
    let spiral: Vec<_> = circle(400, 1.0, [0.0; 2])
        .iter()
        .enumerate()
        .map(|(k, _)| {
            let (sin, cos) = (TAU * k as f64 / 200.0).sin_cos();
            let radius = 1.0 + 1e-4 * k as f64;
            [radius * cos, radius * sin]
        })
        .collect();
    let spiral = judge(&[closed(&spiral)]);
    assert!(!spiral.homeomorphic && spiral.crossings > 0, "{spiral:?}");

    // A loop in the curve, small enough for places to run on.
    let mut crossing = good.clone();
    crossing[10] = [good[10][0] * 1.03, good[10][1] * 1.03];
    assert_eq!(judge(&[closed(&crossing)]).crossings, 0);
    let (a, b) = (good[10], good[11]);
    crossing.splice(
        10..12,
        [
            a,
            [1.02 * b[0], 1.02 * b[1]],
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])],
            [1.02 * a[0], 1.02 * a[1]],
            b,
        ],
    );
    assert!(judge(&[closed(&crossing)]).crossings > 0);
}

#[test]
fn curves_must_be_found_one_for_one() {
    let curves =
        [circle(1000, 3.0, [0.0; 2]), circle(1000, 1.0, [0.0; 2]), circle(1000, 1.0, [9.0, 0.0])];
    let truth: Vec<_> = curves.iter().map(|curve| closed(curve)).collect();
    let coarse =
        [circle(60, 1.0, [9.0, 0.0]), circle(60, 3.0, [0.0; 2]), circle(60, 1.0, [0.0; 2])];
    let found: Vec<_> = coarse.iter().map(|curve| closed(curve)).collect();
    assert!(compare(&truth, &found).topology_right());
    let missing = compare(&truth, &found[1..]);
    assert!(!missing.homeomorphic && missing.hausdorff_truth_to_found > 5.0);
    assert!(missing.hausdorff_found_to_truth < 0.01);
    assert!(!compare(&truth[1..], &found).homeomorphic);
    assert!(!compare(&truth, &[found[0], found[1], found[1]]).homeomorphic);
    // One that joins two circles.
    let joined: Vec<_> = coarse[1].iter().chain(&coarse[2]).copied().collect();
    assert!(!compare(&truth[..2], &[closed(&joined)]).homeomorphic);
}

#[test]
fn curves_with_ends_are_told_from_closed_ones() {
    let arc: Vec<_> = circle(4000, 1.0, [0.0; 2])[..3000].to_vec();
    let found: Vec<_> = arc.iter().copied().step_by(50).collect();
    assert!(compare(&[open(&arc)], &[open(&found)]).topology_right());
    assert!(!compare(&[open(&arc)], &[closed(&found)]).homeomorphic);
    assert!(!compare(&[open(&arc)], &[open(&found[..20])]).homeomorphic);
    let mut back = found.clone();
    back.extend_from_slice(&found[40..58]);
    assert!(!compare(&[open(&arc)], &[open(&back)]).homeomorphic);
}

#[test]
fn nothing_is_far_from_something() {
    let point = [[1.0, 1.0]];
    assert_eq!(compare(&[], &[]).hausdorff, 0.0);
    assert!(compare(&[], &[]).homeomorphic);
    let lost = compare(&[closed(&point)], &[]);
    assert_eq!(
        (lost.hausdorff_truth_to_found, lost.hausdorff_found_to_truth),
        (f64::INFINITY, 0.0)
    );
    let invented = compare(&[], &[closed(&point)]);
    assert_eq!(invented.hausdorff_found_to_truth, f64::INFINITY);
    assert!(!invented.homeomorphic);
    let same = compare(&[open(&point)], &[open(&[[1.0, 3.0]])]);
    assert_eq!((same.hausdorff, same.vertex_rms), (2.0, 2.0));
    assert_eq!(compare(&[open(&[])], &[open(&[])]).hausdorff, 0.0);
}

#[test]
fn coordinates_of_any_size_are_measured() {
    for scale in [1e-150, 1e-9, 1e9, 1e150] {
        let (truth, found) = (circle(1000, scale, [0.0; 2]), circle(100, scale, [0.0; 2]));
        let quality = compare(&[closed(&truth)], &[closed(&found)]);
        assert!(quality.topology_right() && quality.hausdorff < 1e-3 * scale, "{quality:?}");
        assert!(quality.hausdorff > 1e-4 * scale);
    }
}

/// Distance of p from a segment, written another way: by the derivative's zero, or the nearer end.
fn plain_distance(p: [f64; 2], (a, b): Segment) -> f64 {
    let ends = [a, b].map(|q| (q[0] - p[0]).hypot(q[1] - p[1]));
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if length == 0.0 {
        return ends[0];
    }
    let (ux, uy) = ((b[0] - a[0]) / length, (b[1] - a[1]) / length);
    let along = (p[0] - a[0]) * ux + (p[1] - a[1]) * uy;
    let across = ((p[0] - a[0]) * uy - (p[1] - a[1]) * ux).abs();
    if (0.0..=length).contains(&along) { across } else { ends[0].min(ends[1]) }
}

/// Returns true if two segments of whole numbers meet, by exact rational intersection.
fn plain_meet((a, b): Segment, (c, d): Segment) -> bool {
    let int = |p: [f64; 2]| p.map(|v| v as i64);
    let [a, b, c, d] = [a, b, c, d].map(int);
    let det = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    let within = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        det(p, q, r) == 0 && (0..2).all(|k| (p[k].min(q[k])..=p[k].max(q[k])).contains(&r[k]))
    };
    within(a, b, c)
        || within(a, b, d)
        || within(c, d, a)
        || within(c, d, b)
        || det(a, b, c) * det(a, b, d) < 0 && det(c, d, a) * det(c, d, b) < 0
}

proptest! {
    /// Segments of very different length, and points within and far outside their box.
    #[test]
    fn the_nearest_place_is_that_of_all_segments(
        segments in prop::collection::vec(((-9i32..9, -9i32..9), (-5.0..5.0f64, -5.0..5.0f64), -8i32..1), 1..40),
        points in prop::collection::vec((-40.0..40.0f64, -12.0..12.0f64), 20),
    ) {
        let segments: Vec<Segment> = segments
            .into_iter()
            .map(|((x, y), (dx, dy), power)| {
                let a = [f64::from(x), f64::from(y)];
                let scale = 4f64.powi(power);
                (a, [a[0] + scale * dx, a[1] + scale * dy])
            })
            .collect();
        let grid = Grid::new(&segments).unwrap();
        for (x, y) in points {
            let near = grid.nearest([x, y]);
            let plain = segments.iter().map(|&s| plain_distance([x, y], s)).fold(f64::INFINITY, f64::min);
            prop_assert!((near.distance - plain).abs() <= 1e-9, "{} and not {plain}", near.distance);
        }
    }

    /// Whole numbers bring shared vertices, touching and overlapping edges.
    #[test]
    fn crossings_are_those_of_all_pairs(
        first in prop::collection::vec((0i32..8, 0i32..8), 0..12),
        second in prop::collection::vec((0i32..8, 0i32..8), 0..12),
        closes in prop::bool::ANY,
        turn in prop::bool::ANY,
    ) {
        let points = |list: Vec<(i32, i32)>| -> Vec<[f64; 2]> {
            let mut points: Vec<[f64; 2]> = list
                .into_iter()
                .map(|(x, y)| if turn { [f64::from(x + 2 * y), f64::from(y - x)] } else { [f64::from(x), f64::from(y)] })
                .collect();
            points.dedup();
            if closes && points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            points
        };
        let curves = [points(first), points(second)];
        let mut edges: Vec<(usize, usize, usize, Segment)> = Vec::new();
        for (curve, vertices) in curves.iter().enumerate() {
            let view = Polyline { vertices, closed: closes };
            let count = view.edges().count();
            edges.extend(view.edges().enumerate().map(|(k, edge)| (curve, k, count, edge)));
        }
        let mut expected = 0;
        for (i, &(curve, k, count, e)) in edges.iter().enumerate() {
            for &(other, l, _, f) in &edges[i + 1..] {
                let follows = curve == other && l == k + 1;
                let closing = curve == other && closes && k == 0 && l + 1 == count;
                let fold = |(a, b): Segment, (_, c): Segment| {
                    let (u, v) = ([a[0] - b[0], a[1] - b[1]], [c[0] - b[0], c[1] - b[1]]);
                    u[0] * v[1] == u[1] * v[0] && u[0] * v[0] + u[1] * v[1] > 0.0
                };
                let bad = if follows || closing {
                    follows && fold(e, f) || closing && fold(f, e)
                } else {
                    plain_meet(e, f)
                };
                expected += usize::from(bad);
            }
        }
        let views = curves.each_ref().map(|vertices| Polyline { vertices, closed: closes });
        prop_assert_eq!(crossings(&views), expected);
    }

    /// The three counts are those of the sets.
    #[test]
    fn edge_scores_are_set_differences(
        truth in prop::collection::vec((0u64..6, 0u64..6), 0..20),
        found in prop::collection::vec((0u64..6, 0u64..6), 0..20),
    ) {
        use std::collections::BTreeSet;
        let set = |edges: &[(u64, u64)]| -> BTreeSet<(u64, u64)> {
            edges.iter().map(|&(a, b)| (a.min(b), a.max(b))).collect()
        };
        let (left, right) = (set(&truth), set(&found));
        let pairs = |edges: &[(u64, u64)]| edges.iter().map(|&(a, b)| [a, b]).collect::<Vec<_>>();
        let score = edge_score(&pairs(&truth), &pairs(&found));
        prop_assert_eq!(score.true_found, left.intersection(&right).count());
        prop_assert_eq!(score.false_found, right.difference(&left).count());
        prop_assert_eq!(score.missing, left.difference(&right).count());
        prop_assert_eq!(score.exact(), left == right);
    }
}

#[test]
fn a_quarter_of_a_million_vertices_are_judged() {
    let truth = circle(10_000, 1.0, [0.0; 2]);
    let found: Vec<[f64; 2]> = circle(250_000, 1.0, [0.0; 2])
        .into_iter()
        .enumerate()
        .map(|(k, p)| p.map(|v| v * (1.0 + 1e-3 * (k as f64 * 1e-3).sin())))
        .collect();
    let quality = compare(&[closed(&truth)], &[closed(&found)]);
    assert!(quality.topology_right(), "{quality:?}");
    assert!((quality.vertex_rms - 1e-3 / 2f64.sqrt()).abs() < 1e-5, "{quality:?}");
}
