//! Closed forms, brute force, and the same bits from a folder of many tiles as from memory.

use std::collections::BTreeMap;

use taut_points::{InputError, Monitor, Points};

use super::{
    ContourOptions, Heights, Interpolation, Levels, RasterFrame, RasterOptions, Stroke, Terrain,
    contours, raster,
};
use crate::numbers::numbers;
use crate::outofcore::Mosaic;
use crate::outofcore::tests::{plane_sets, write_folder};
use crate::test_length::long_or;
use crate::{DelaunayOptions, Error, Location, Plane};

fn build(points: &[[f64; 2]]) -> Plane {
    let points = Points::new(points.as_flattened(), 2).unwrap();
    Plane::build(&points, &DelaunayOptions::default()).unwrap()
}

/// A line: its level and its places.
type Line = (f64, Vec<[f64; 2]>);

fn lines(mosaic: &Mosaic<2>, heights: &[f64], levels: &Levels) -> Vec<Line> {
    let mut lines: Vec<Line> = vec![];
    let mut is_open = false;
    let heights = Heights::Values(heights);
    let count =
        contours(Terrain { mosaic, heights }, levels, &ContourOptions::default(), &mut |stroke| {
            match stroke {
                Stroke::Begin(level) => {
                    assert!(!is_open);
                    is_open = true;
                    lines.push((level, vec![]));
                }
                Stroke::To(place) => lines.last_mut().unwrap().1.push(place),
                Stroke::End => is_open = false,
            }
            Ok(())
        });
    assert_eq!(count.unwrap(), lines.len() as u64);
    assert!(!is_open);
    for (_, line) in &lines {
        assert!(line.len() > 1 && line.windows(2).all(|pair| pair[0] != pair[1]));
    }
    lines.sort_by(|a, b| a.partial_cmp(b).unwrap());
    lines
}

/// The values by row from the north and column.
fn values(
    mosaic: &Mosaic<2>,
    heights: &[f64],
    frame: &RasterFrame,
    interpolation: Interpolation,
) -> BTreeMap<(u64, u64), f64> {
    let options = RasterOptions { interpolation, monitor: Monitor::silent() };
    let mut values = BTreeMap::new();
    let heights = Heights::Values(heights);
    raster(Terrain { mosaic, heights }, frame, &options, &mut |row, column, run| {
        for (column, &value) in (column..).zip(run) {
            if let Some(earlier) = values.insert((row, column), value) {
                assert_eq!(earlier.to_bits(), value.to_bits(), "row {row}, column {column}");
            }
        }
        Ok(())
    })
    .unwrap();
    values
}

fn frame_of(mosaic: &Mosaic<2>, columns: f64) -> Option<RasterFrame> {
    let [low, high] = mosaic.extent().unwrap()?;
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    RasterFrame::around(low, high, side / columns).ok()
}

#[test]
fn folders_of_many_tiles_give_the_bits_of_memory() {
    let mut tested = 0;
    for (name, points) in plane_sets().into_iter().step_by(long_or(1, 3)) {
        let noise = numbers(points.len(), 77);
        let steps: Vec<f64> = noise.iter().map(|z| (z * 4.0).floor()).collect();
        let plane = build(&points);
        let memory = Mosaic::of(&plane);
        for levels in [1, 4] {
            let folder = tempfile::tempdir().unwrap();
            write_folder(&points, levels, folder.path());
            let tiled = Mosaic::open(folder.path(), 1 << 20).unwrap();
            assert_eq!(tiled.extent().unwrap(), memory.extent().unwrap(), "{name}");
            for heights in [&noise, &steps] {
                let chosen = Levels::of(vec![0.25, 1.0, 0.5, 2.0, 2.5, 3.0]).unwrap();
                let expected = lines(&memory, heights, &chosen);
                assert!(lines(&tiled, heights, &chosen) == expected, "{name}");
                for (interpolation, columns) in
                    [(Interpolation::Linear, 23.0), (Interpolation::Natural, 4.0)]
                {
                    // Within a circle of sites each center has all of them as neighbors: once is enough.
                    let is_once = levels == 4 && std::ptr::eq(heights, &noise);
                    if interpolation == Interpolation::Natural && !is_once {
                        continue;
                    }
                    let Some(frame) = frame_of(&memory, columns) else { continue };
                    let expected = values(&memory, heights, &frame, interpolation);
                    let found = values(&tiled, heights, &frame, interpolation);
                    assert!(found == expected, "{name}, {interpolation}");
                    tested += expected.len();
                }
            }
        }
    }
    assert!(tested > long_or(10_000, 3000), "{tested}");
}

/// Whole coefficients and places that doubles hold: no bit is lost, whatever the triangles.
#[test]
fn a_plane_is_reproduced_to_the_last_bit() {
    let steps = numbers(4000, 5);
    let points: Vec<[f64; 2]> =
        steps.chunks_exact(2).map(|p| [p[0], p[1]].map(|x| (x * 65536.0).floor() / 64.0)).collect();
    let height = |[x, y]: [f64; 2]| 3.0 * x - 7.0 * y + 250_000.5;
    let heights: Vec<f64> = points.iter().map(|&p| height(p)).collect();
    let mosaic = Mosaic::of(&build(&points));
    let frame = RasterFrame::around([-10.0; 2], [1050.0; 2], 8.5).unwrap();
    for interpolation in Interpolation::ALL {
        let found = values(&mosaic, &heights, &frame, interpolation);
        assert!(found.len() > 12_000, "{}", found.len());
        for ((row, column), value) in found {
            assert_eq!(value, height(frame.center(column, row)), "{interpolation}");
        }
    }
}

/// The hull and the values, by other code: one question at a time.
#[test]
fn values_are_those_of_single_questions() {
    // With whole numbers some centers are sites, and some lie on edges.
    for (side, cell) in [(1.0, 1.0 / 32.0), (24.0, 2.0)] {
        let steps = numbers(1200, 3);
        let place = |x: f64| if side > 1.0 { (x * side).floor() } else { x };
        let points: Vec<[f64; 2]> =
            steps.chunks_exact(2).map(|p| [p[0], p[1]].map(place)).collect();
        let heights = numbers(points.len(), 9);
        let plane = build(&points);
        let (mosaic, locator) = (Mosaic::of(&plane), plane.locator());
        let first = |p: [f64; 2]| points.iter().position(|&q| q == p).unwrap();
        let frame = RasterFrame::around([-cell; 2], [side + cell; 2], cell).unwrap();
        let linear = values(&mosaic, &heights, &frame, Interpolation::Linear);
        let natural = values(&mosaic, &heights, &frame, Interpolation::Natural);
        assert_eq!(linear.len(), natural.len());
        let mut inside = 0;
        for row in 0..frame.rows {
            for column in 0..frame.columns {
                let q = frame.center(column, row);
                let expected = match locator.locate(q) {
                    Location::Site(site) => {
                        let z = heights[first(plane.site(site))];
                        Some((z, z))
                    }
                    Location::Inside(t) => {
                        let [a, b, c] = plane.vertices(t).map(|v| plane.site(v));
                        let cross = |p: [f64; 2], r: [f64; 2]| {
                            (p[0] - q[0]) * (r[1] - q[1]) - (p[1] - q[1]) * (r[0] - q[0])
                        };
                        let shares = [cross(b, c), cross(c, a), cross(a, b)];
                        let z = [a, b, c].map(|p| heights[first(p)]);
                        let sum: f64 = shares.iter().sum();
                        let mean = (0..3).map(|i| shares[i] / sum * z[i]).sum::<f64>();
                        let is_on_hull = plane.hull().any(|edge| {
                            let [a, b] = edge.map(|v| plane.site(v));
                            cross(a, b) == 0.0
                        });
                        // On the hull a question finds what rounding leaves of endless cells; the limit is linear.
                        let found = locator.interpolate(&heights, q).unwrap();
                        Some((mean, if is_on_hull { mean } else { found }))
                    }
                    _ => None,
                };
                let found = linear.get(&(row, column)).zip(natural.get(&(row, column)));
                assert_eq!(found.is_some(), expected.is_some(), "{q:?}");
                if let (Some((l, n)), Some((e, s))) = (found, expected) {
                    inside += 1;
                    assert!((l - e).abs() < 1e-9, "{q:?}: {l} {e}");
                    assert!((n - s).abs() < 1e-9, "{q:?}: {n} {s}");
                }
            }
        }
        assert!(inside > 100, "{inside}");
    }
}

fn signed_area(line: &[[f64; 2]]) -> f64 {
    line.windows(2).map(|p| 0.5 * (p[0][0] * p[1][1] - p[0][1] * p[1][0])).sum()
}

/// Circles of a cone: higher ground is to the left, so that a hole has them clockwise.
#[test]
fn contours_of_a_cone_are_circles() {
    let points: Vec<[f64; 2]> =
        numbers(40_000, 31).chunks_exact(2).map(|p| [2.0 * p[0] - 1.0, 2.0 * p[1] - 1.0]).collect();
    let radius = |p: [f64; 2]| p[0].hypot(p[1]);
    let heights: Vec<f64> = points.iter().map(|&p| radius(p)).collect();
    let upside_down: Vec<f64> = heights.iter().map(|z| -z).collect();
    let mosaic = Mosaic::of(&build(&points));
    let plane = build(&points);
    let longest = plane
        .simplices()
        .flat_map(|t| {
            let [a, b, c] = plane.vertices(t).map(|v| plane.site(v));
            [[a, b], [b, c], [c, a]]
        })
        .filter(|[a, b]| radius(*a).max(radius(*b)) < 0.9)
        .map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1]))
        .fold(0.0, f64::max);
    for level in [0.25, 0.5, 0.75] {
        let down = lines(&mosaic, &heights, &Levels::of(vec![level]).unwrap());
        let up = lines(&mosaic, &upside_down, &Levels::of(vec![-level]).unwrap());
        for (found, side) in [(down, -1.0), (up, 1.0)] {
            let [(at, line)] = &found[..] else { panic!("{} lines", found.len()) };
            assert_eq!(at.abs(), level);
            assert_eq!(line[0], line[line.len() - 1]);
            // The radius is convex along an edge: there the surface is above the cone, by at most the square of the edge
            // over 8 and over the least radius.
            let bound = longest * longest / (8.0 * (level - longest));
            assert!(line.iter().all(|&p| radius(p) <= level + 1e-12 && radius(p) >= level - bound));
            // A segment may cut off a triangle of one edge.
            let area = signed_area(line) * side;
            let circle = std::f64::consts::PI * level * level;
            assert!(area < circle && area > circle - 8.0 * level * longest, "{area} {circle}");
        }
    }
}

/// A hyperbola has two branches, its asymptotes are one line that touches itself, or two, that do not end inside.
#[test]
fn contours_of_a_saddle_go_from_hull_to_hull() {
    let grid: Vec<[f64; 2]> =
        (0..441).map(|i| [f64::from(i % 21 - 10), f64::from(i / 21 - 10)]).collect();
    let heights: Vec<f64> = grid.iter().map(|p| p[0] * p[1]).collect();
    let mosaic = Mosaic::of(&build(&grid));
    for level in [0.5, 7.5, -0.5, -40.25, 0.0] {
        let found = lines(&mosaic, &heights, &Levels::of(vec![level]).unwrap());
        assert_eq!(found.len(), 2, "{level}");
        for (_, line) in &found {
            for end in [line[0], line[line.len() - 1]] {
                assert!(end[0].abs() == 10.0 || end[1].abs() == 10.0, "{level}: {end:?}");
            }
            for p in line.iter().filter(|p| p[0].fract() == 0.0 || p[1].fract() == 0.0) {
                assert!((p[0] * p[1] - level).abs() < 1e-12, "{level}: {p:?}");
            }
            if level == 0.0 {
                // Through vertices only, or across squares whose corner is at the level.
                assert!(line.iter().all(|p| p[0] == 0.0 || p[1] == 0.0), "{line:?}");
            }
        }
    }
}

/// A vertex at the level counts as above it.
#[test]
fn plateaus_have_a_line_around_and_tops_have_none() {
    let grid: Vec<[f64; 2]> = (0..49).map(|i| [f64::from(i % 7), f64::from(i / 7)]).collect();
    let mosaic = Mosaic::of(&build(&grid));
    let heights = |of: fn(f64, f64) -> f64| grid.iter().map(|p| of(p[0], p[1])).collect::<Vec<_>>();
    let at =
        |heights: &[f64], level: f64| lines(&mosaic, heights, &Levels::of(vec![level]).unwrap());
    // All at the level, and a pit within a plateau.
    assert!(at(&heights(|_, _| 1.0), 1.0).is_empty());
    let pit = heights(|x, y| if (x, y) == (3.0, 3.0) { 0.0 } else { 1.0 });
    let found = at(&pit, 1.0);
    assert_eq!(found.len(), 1);
    assert!(signed_area(&found[0].1) < 0.0);
    // A plateau of 3 × 3 vertices: the line is its border, counter-clockwise.
    let plateau =
        heights(|x, y| if (x - 3.0).abs().max((y - 3.0).abs()) <= 1.0 { 2.0 } else { 0.0 });
    let found = at(&plateau, 2.0);
    assert_eq!(found.len(), 1);
    assert_eq!(signed_area(&found[0].1), 4.0);
    let inner = |p: &[f64; 2]| (p[0] - 3.0).abs().max((p[1] - 3.0).abs()) == 1.0;
    assert!(found[0].1.iter().all(inner), "{found:?}");
    // A top at the level, a ridge of two vertices at it, a valley at it.
    let top = heights(|x, y| 5.0 - (x - 3.0).abs().max((y - 3.0).abs()));
    assert!(at(&top, 5.0).is_empty());
    assert!(at(&top, 5.5).is_empty());
    assert_eq!(at(&top, 4.0).len(), 1);
    let ridge = heights(|x, y| if y == 3.0 && (x == 3.0 || x == 2.0) { 1.0 } else { 0.0 });
    let found = at(&ridge, 1.0);
    assert_eq!(found.len(), 1);
    assert_eq!(signed_area(&found[0].1), 0.0);
    assert!(at(&heights(|x, _| (x - 3.0).abs()), 0.0).is_empty());
}

/// Between two levels each line is crossed as often as heights say: the number of lines to the left of a place.
#[test]
fn lines_separate_what_is_above_from_what_is_below() {
    let points: Vec<[f64; 2]> = numbers(1000, 61).chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    let heights: Vec<f64> = numbers(500, 62).iter().map(|z| (z * 6.0).floor()).collect();
    let plane = build(&points);
    let mosaic = Mosaic::of(&plane);
    for level in [1.0, 2.5, 5.0] {
        let found = lines(&mosaic, &heights, &Levels::of(vec![level]).unwrap());
        let places: usize = found.iter().map(|(_, line)| line.len()).sum();
        assert!(places > 40, "{places}");
        for (_, line) in &found {
            let is_closed = line[0] == line[line.len() - 1];
            let on_hull = |p: [f64; 2]| {
                plane.hull().any(|edge| {
                    let [a, b] = edge.map(|v| plane.site(v));
                    let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                    cross.abs() < 1e-15
                })
            };
            assert!(is_closed || (on_hull(line[0]) && on_hull(line[line.len() - 1])));
        }
        // Each edge with one end above and one below has one place, and there are no others.
        let mut expected: Vec<[f64; 2]> = vec![];
        for t in plane.simplices() {
            let v = plane.vertices(t);
            for i in 0..3 {
                let (a, b) = (v[i], v[(i + 1) % 3]);
                let [za, zb] = [a, b].map(|v| heights[plane.row(v) as usize]);
                if (za >= level) == (zb >= level) {
                    continue;
                }
                let ([p, q], [z, w]) = if plane.site(a) < plane.site(b) {
                    ([a, b].map(|v| plane.site(v)), [za, zb])
                } else {
                    ([b, a].map(|v| plane.site(v)), [zb, za])
                };
                expected.push(super::contours::crossing([p, q], [z, w], level));
            }
        }
        let sorted = |mut places: Vec<[f64; 2]>| {
            places.sort_by(|a, b| a.partial_cmp(b).unwrap());
            places.dedup();
            places
        };
        // What is drawn lacks the lines of one place: tops at the level.
        let drawn = sorted(found.into_iter().flat_map(|(_, line)| line).collect());
        let expected = sorted(expected);
        assert!(drawn.iter().all(|p| expected.contains(p)));
        let is_top = |p: &&[f64; 2]| points.contains(*p);
        assert!(expected.iter().filter(|p| !drawn.contains(p)).all(|p| is_top(&p)));
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let is_option = |error: Error, option: &str| match error {
        Error::Input(InputError::Option { name, .. }) => assert_eq!(name, option),
        other => panic!("{other}"),
    };
    for cell in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-20] {
        is_option(RasterFrame::around([0.0; 2], [1.0; 2], cell).unwrap_err(), "cell");
    }
    is_option(Levels::of(vec![1.0, f64::NAN]).unwrap_err(), "levels");
    is_option(Levels::of((0..1_000_001).map(f64::from).collect()).unwrap_err(), "levels");
    for interval in [0.0, -1.0, f64::NAN, 1e-9, 1e-30] {
        is_option(Levels::every(interval, [0.0, 10.0]).unwrap_err(), "interval");
    }
    assert_eq!(Levels::every(2.0, [0.0, 6.0]).unwrap().heights(), [2.0, 4.0, 6.0]);
    assert_eq!(Levels::every(2.0, [-3.0, 1.0]).unwrap().heights(), [-2.0, 0.0]);
    assert_eq!(Levels::of(vec![3.0, 1.0, 3.0]).unwrap().heights(), [1.0, 3.0]);
    let mosaic = Mosaic::of(&build(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
    let terrain = Terrain { mosaic: &mosaic, heights: Heights::Values(&[0.0, f64::NAN, 1.0]) };
    let refused = terrain.height_range().unwrap_err();
    assert!(matches!(refused, Error::Input(InputError::NonFinite { row: 1, .. })), "{refused}");
    let empty = tempfile::tempdir().unwrap();
    let refused = Mosaic::<2>::open(empty.path(), 1 << 20).err();
    assert!(matches!(refused, Some(Error::UnfinishedFolder { .. })));
}

/// Heights and places at the ends of the range of doubles.
#[test]
fn extreme_heights_and_scales_stay_finite() {
    for (scale, rise) in [(1.0, 1.5e308), (1e150, 1e150), (1e-150, 1e-150), (1.0, 5e-324)] {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.25]]
            .map(|p| p.map(|x: f64| x * scale));
        let heights = [-rise, rise, rise, -rise, rise];
        let mosaic = Mosaic::of(&build(&points));
        let frame = RasterFrame::around([0.0; 2], [scale; 2], scale / 16.0).unwrap();
        for interpolation in Interpolation::ALL {
            let found = values(&mosaic, &heights, &frame, interpolation);
            assert!(found.len() >= 256 && found.values().all(|z| z.abs() <= rise), "{scale}");
        }
        let found = lines(&mosaic, &heights, &Levels::of(vec![0.0]).unwrap());
        assert!(!found.is_empty());
        assert!(
            found.iter().flat_map(|(_, line)| line).flatten().all(|x| (0.0..=scale).contains(x))
        );
    }
}
