//! Largest ellipses: closed forms, laws, holes, and brute force.

use std::f64::consts::{PI, TAU};

use super::common::{Random, Ring, clearance, comb, is_inside, regular, star_shaped, tour};
use super::rings::{rows, square};
use taut_certify::{EllipseVerdict, InscribedEllipse, Solution, Stop};
use taut_inscribe::{EllipseOptions, Error, inscribed_ellipse};
use taut_points::Points;

/// Proved relative gap of most tests.
const EPSILON: f64 = 1e-6;

pub(super) fn solve(rings: &[Ring], epsilon: f64) -> Result<Solution<InscribedEllipse>, Error> {
    let options = EllipseOptions { epsilon, ..Default::default() };
    inscribed_ellipse(&Points::new(&rows(rings), 3).unwrap(), &options)
}

pub(super) fn verified(found: &Solution<InscribedEllipse>, rings: &[Ring]) -> EllipseVerdict {
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap());
    verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer))
}

/// The largest ellipse, verified with the gap asked for.
pub(super) fn proved(rings: &[Ring]) -> Solution<InscribedEllipse> {
    let found = solve(rings, EPSILON).unwrap();
    let verdict = verified(&found, rings);
    assert_eq!(found.trace.stop, Stop::Converged, "{rings:?}");
    assert!(verdict.gap <= EPSILON * (1.0 + 1e-8), "{verdict:?}");
    assert!(verdict.lower <= found.answer.area && found.answer.area <= verdict.upper);
    found
}

/// Whether an area is the largest one, within the gap.
fn is_near(area: f64, expected: f64) -> bool {
    area <= expected * (1.0 + 1e-12) && area >= expected * (1.0 - 1.1 * EPSILON)
}

fn assert_area(rings: &[Ring], expected: f64) {
    let found = proved(rings);
    assert!(is_near(found.answer.area, expected), "{} instead of {expected}", found.answer.area);
}

fn mapped(ring: &[[f64; 2]], [[a, b], [c, d]]: [[f64; 2]; 2], shift: [f64; 2]) -> Ring {
    let map = |p: &[f64; 2]| [a * p[0] + b * p[1] + shift[0], c * p[0] + d * p[1] + shift[1]];
    ring.iter().map(map).collect()
}

#[test]
fn parallelograms_triangles_and_regular_polygons_have_the_image_of_their_incircle() {
    let unit = [[1.0, 0.0], [0.0, 1.0]];
    for map in
        [unit, [[3.0, 1.0], [0.5, 0.75]], [[1.0, 900.0], [0.0, 1.0]], [[0.0, -2.0], [1e-3, 0.25]]]
    {
        let determinant: f64 = map[0][0] * map[1][1] - map[0][1] * map[1][0];
        for shift in [[0.0, 0.0], [-7.0, 1000.0]] {
            let of = |ring: &[[f64; 2]]| vec![mapped(ring, map, shift)];
            assert_area(&of(&square(0.0, 0.0, 1.0)), 0.25 * PI * determinant.abs());
            // The inellipse of Steiner.
            let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
            assert_area(&of(&triangle), 0.5 * PI / 27f64.sqrt() * determinant.abs());
            for size in [5, 6, 7, 12] {
                let radius = (PI / size as f64).cos();
                assert_area(&of(&regular(size)), PI * radius * radius * determinant.abs());
            }
        }
    }
}

#[test]
fn a_polygon_around_an_ellipse_gives_it_back() {
    // Tangents of the circle at 1000 points, mapped.
    let outer: Ring = regular(1000).iter().map(|p| p.map(|x| x / (PI / 1000.0).cos())).collect();
    let rings = [mapped(&outer, [[2.0, 1.0], [0.0, 0.5]], [3.0, 4.0])];
    let found = proved(&rings);
    assert!((found.answer.area / PI - 1.0).abs() <= 1e-5, "{}", found.answer.area);
    let [x, y] = found.answer.center;
    assert!((x - 3.0).abs() < 1e-2 && (y - 4.0).abs() < 1e-2);
}

#[test]
fn holes_and_parts_move_the_optimum() {
    // In a frame of width 1 around a square hole: a quarter of a corridor of 1 by 4, or more where it bends.
    let outer = square(0.0, 0.0, 4.0);
    let found = proved(&[outer.clone(), square(1.0, 1.0, 2.0)]);
    assert!(is_near(found.answer.area, PI), "{}", found.answer.area);
    // A point-like hole in the middle of a square leaves a rectangle: half of it is best.
    let (low, side) = (2.0 - 5e-10, 1e-9);
    let found = proved(&[outer.clone(), square(low, low, side)]);
    assert!(found.answer.area > 2.0 * PI * (1.0 - EPSILON) && found.answer.area < 3.0 * PI);
    let without = proved(&[outer]).answer.area;
    assert!(is_near(without, 4.0 * PI));
    // Two parts: the larger one counts.
    let parts = [
        square(0.0, 0.0, 1.0),
        mapped(&square(0.0, 0.0, 1.0), [[3.0, 0.0], [0.0, 0.5]], [5.0, 5.0]),
    ];
    let found = proved(&parts);
    assert!(is_near(found.answer.area, 0.25 * PI * 1.5) && found.answer.center[0] > 5.0);
    // An island in a hole.
    let nested = [square(0.0, 0.0, 8.0), square(0.5, 0.5, 7.0), square(1.0, 1.0, 6.0)];
    assert_area(&nested, 9.0 * PI);
}

#[test]
fn turned_scaled_shifted_and_reversed_polygons_have_the_same_area() {
    let mut lists = vec![(star_shaped(3, 12), 1), (tour(4, 14), 2)];
    lists.push((comb(3, 1.5), 3));
    for (ring, seed) in lists {
        let base = proved(std::slice::from_ref(&ring)).answer.area;
        let check = |ring: Ring, factor: f64| {
            let area = proved(&[ring]).answer.area / factor;
            // Both are within the gap of the optimum.
            assert!((area / base - 1.0).abs() <= 1.1 * EPSILON, "{seed}: {area} and {base}");
        };
        check(mapped(&ring, [[0.6, -0.8], [0.8, 0.6]], [0.0, 0.0]), 1.0);
        check(mapped(&ring, [[1024.0, 0.0], [0.0, 0.125]], [0.0, 0.0]), 128.0);
        check(mapped(&ring, [[1e100, 0.0], [0.0, 1e100]], [0.0, 0.0]), 1e200);
        check(mapped(&ring, [[1e-100, 0.0], [0.0, 1e-100]], [0.0, 0.0]), 1e-200);
        check(mapped(&ring, [[1.0, 0.0], [0.0, 1.0]], [4096.0, -1000.0]), 1.0);
        check(ring.iter().rev().copied().collect(), 1.0);
        let mut turned = ring.clone();
        turned.rotate_left(5);
        check(turned, 1.0);
    }
}

#[test]
fn no_ellipse_of_a_random_search_is_larger() {
    for seed in 0..12 {
        let ring = if seed % 2 == 0 { star_shaped(seed, 9) } else { tour(seed, 11) };
        let found = proved(std::slice::from_ref(&ring));
        let upper = verified(&found, std::slice::from_ref(&ring)).upper;
        let mut random = Random(seed);
        let mut best = 0.0f64;
        for _ in 0..60 {
            // A random ellipse, and the larger ones among random changes of it that get smaller.
            let start = ring.iter().fold([0.0; 2], |sum, p| {
                let weight = random.unit() / ring.len() as f64;
                [sum[0] + weight * p[0], sum[1] + weight * p[1]]
            });
            let mut here = [start[0], start[1], 0.0, 1.0];
            let mut area = area_of(here, &ring);
            let mut step = 0.5;
            for _ in 0..400 {
                let signed = |random: &mut Random| step * (2.0 * random.unit() - 1.0);
                let next = [
                    here[0] + signed(&mut random),
                    here[1] + signed(&mut random),
                    here[2] + signed(&mut random),
                    here[3] * signed(&mut random).exp(),
                ];
                let other = area_of(next, &ring);
                if other > area {
                    (here, area) = (next, other);
                } else {
                    step = (step * 0.97).max(1e-4);
                }
            }
            best = best.max(area);
        }
        assert!(best <= upper, "{seed}: {best} above {upper}");
        assert!(best >= 0.9 * upper, "{seed}: the search found {best} only, below {upper}");
    }
}

/// The area of the largest ellipse of a center and shape (x, y, s, t): |w|² = t·w₁² + (w₂ + s·w₁)²/t.
fn area_of([x, y, s, t]: [f64; 4], ring: &[[f64; 2]]) -> f64 {
    if !is_inside([x, y], ring) {
        return 0.0;
    }
    let image = |p: &[f64; 2]| {
        let w = [p[0] - x, p[1] - y];
        [t.sqrt() * w[0], (w[1] + s * w[0]) / t.sqrt()]
    };
    let images: Ring = ring.iter().map(image).collect();
    let size = clearance([0.0, 0.0], &images);
    PI * size * size
}

#[test]
fn no_point_of_the_ellipse_is_outside() {
    for seed in 20..26 {
        let ring = tour(seed, 40);
        let InscribedEllipse { center, axes, area } = proved(std::slice::from_ref(&ring)).answer;
        let determinant = axes[0][0] * axes[1][1] - axes[0][1] * axes[1][0];
        assert!((area / (PI * determinant) - 1.0).abs() < 1e-14);
        for i in 0..1000 {
            let (sine, cosine) = (f64::from(i) / 1000.0 * TAU).sin_cos();
            let at =
                [0, 1].map(|k| center[k] + 0.999_999_9 * (axes[k][0] * cosine + axes[k][1] * sine));
            assert!(is_inside(at, &ring), "{seed}: {at:?}");
        }
    }
}

#[test]
fn needles_far_away_and_budgets_end_with_the_gap_that_is_left() {
    for height in [1e-3, 1e-6, 1e-9] {
        let ring = vec![[0.0, 0.0], [1.0, 0.0], [0.5, height]];
        assert_area(&[ring], 0.5 * height * PI / 27f64.sqrt());
        let across = vec![[0.0, 0.0], [1.0, 1.0], [1.0 - height, 1.0 + height], [-height, height]];
        let found = solve(std::slice::from_ref(&across), 1e-3).unwrap();
        assert!(verified(&found, &[across]).gap <= 1.1e-3, "{height:e}");
    }
    let far = 2f64.powi(30);
    let ring = vec![[far, far], [far + 1.0, far], [far + 0.25, far + 0.75]];
    let found = solve(std::slice::from_ref(&ring), EPSILON).unwrap();
    let verdict = verified(&found, std::slice::from_ref(&ring));
    assert!(verdict.gap <= 1e-4 && verdict.upper >= 0.375 * PI / 27f64.sqrt(), "{verdict:?}");
    let star = star_shaped(7, 30);
    let points = rows(std::slice::from_ref(&star));
    for max_cells in [1, 2, 30, 300] {
        let options = EllipseOptions { epsilon: EPSILON, max_cells, ..Default::default() };
        let found = inscribed_ellipse(&Points::new(&points, 3).unwrap(), &options).unwrap();
        let verdict = verified(&found, std::slice::from_ref(&star));
        assert_eq!(found.trace.stop, Stop::NodeBudget, "{max_cells}");
        assert!(verdict.gap > EPSILON && found.certificate.tree.len() as u64 <= max_cells);
    }
    let huge = mapped(&star, [[1e200, 0.0], [0.0, 1e200]], [0.0, 0.0]);
    assert!(matches!(solve(&[huge], EPSILON), Err(Error::Area)));
}

#[test]
fn bad_points_and_options_of_ellipses_are_refused() {
    let of = |options: EllipseOptions<'_>| {
        let points = rows(&[square(0.0, 0.0, 1.0)]);
        inscribed_ellipse(&Points::new(&points, 3).unwrap(), &options).unwrap_err().to_string()
    };
    for epsilon in [0.0, 1.0, f64::NAN] {
        assert!(of(EllipseOptions { epsilon, ..Default::default() }).contains("`epsilon` is"));
    }
    assert!(of(EllipseOptions { max_cells: 0, ..Default::default() }).contains("`max_cells` is 0"));
    let bow = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    assert!(matches!(solve(&[bow], EPSILON), Err(Error::NotSimple { .. })));
}
