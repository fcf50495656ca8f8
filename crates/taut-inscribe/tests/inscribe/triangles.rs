//! Largest triangles: closed forms, laws, holes, and brute force.

use super::common::{Random, Ring, comb, is_inside, regular, star_shaped, tour};
use super::rings::{rows, square};
use taut_certify::{InscribedTriangle, Solution, Stop, TriangleVerdict};
use taut_inscribe::{Error, TriangleOptions, inscribed_triangle};
use taut_points::Points;

use crate::test_length::long_or;

/// Proved relative gap of most tests.
const EPSILON: f64 = 1e-4;

pub(super) fn solve(rings: &[Ring], epsilon: f64) -> Result<Solution<InscribedTriangle>, Error> {
    solve_with(rings, epsilon, TriangleOptions::default().max_cells)
}

pub(super) fn solve_with(
    rings: &[Ring],
    epsilon: f64,
    max_cells: u64,
) -> Result<Solution<InscribedTriangle>, Error> {
    let options = TriangleOptions { epsilon, max_cells, ..Default::default() };
    inscribed_triangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

pub(super) fn verified(found: &Solution<InscribedTriangle>, rings: &[Ring]) -> TriangleVerdict {
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap());
    verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer))
}

/// The largest triangle, verified with the gap asked for.
pub(super) fn proved(rings: &[Ring]) -> Solution<InscribedTriangle> {
    let found = solve(rings, EPSILON).unwrap();
    let verdict = verified(&found, rings);
    assert_eq!(found.trace.stop, Stop::Converged, "{rings:?}");
    assert!(verdict.gap <= EPSILON * (1.0 + 1e-8), "{verdict:?}");
    assert!(verdict.lower <= found.answer.area && found.answer.area <= verdict.upper);
    found
}

/// Whether an area is the largest one, within the gap; mapped vertices are rounded to 2⁻⁵³ of coordinates of 1000 at most, in
/// polygons of a width of 1e-3 at least.
fn is_near(area: f64, expected: f64) -> bool {
    area <= expected * (1.0 + 1e-9) && area >= expected * (1.0 - 1.1 * EPSILON)
}

fn assert_area(rings: &[Ring], expected: f64) {
    let found = proved(rings);
    assert!(is_near(found.answer.area, expected), "{} instead of {expected}", found.answer.area);
}

fn mapped(ring: &[[f64; 2]], [[a, b], [c, d]]: [[f64; 2]; 2], shift: [f64; 2]) -> Ring {
    let map = |p: &[f64; 2]| [a * p[0] + b * p[1] + shift[0], c * p[0] + d * p[1] + shift[1]];
    ring.iter().map(map).collect()
}

/// The largest of the triangles of vertices: the best one in a convex polygon.
fn largest_of_vertices(ring: &[[f64; 2]]) -> f64 {
    let mut best = 0.0f64;
    for (i, p) in ring.iter().enumerate() {
        for (j, q) in ring.iter().enumerate().skip(i + 1) {
            for r in &ring[j + 1..] {
                let doubled = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
                best = best.max(0.5 * doubled.abs());
            }
        }
    }
    best
}

#[test]
fn parallelograms_triangles_and_regular_polygons_have_the_areas_of_closed_forms() {
    let unit = [[1.0, 0.0], [0.0, 1.0]];
    let maps =
        [unit, [[3.0, 1.0], [0.5, 0.75]], [[1.0, 900.0], [0.0, 1.0]], [[0.0, -2.0], [1e-3, 0.25]]];
    for map in maps.into_iter().skip(long_or(0, 1)).step_by(long_or(1, 2)) {
        let determinant: f64 = map[0][0] * map[1][1] - map[0][1] * map[1][0];
        for &shift in long_or(&[[-7.0, 1000.0], [0.0, 0.0]][..], &[[-7.0, 1000.0]]) {
            let of = |ring: &[[f64; 2]]| vec![mapped(ring, map, shift)];
            assert_area(&of(&square(0.0, 0.0, 1.0)), 0.5 * determinant.abs());
            let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
            assert_area(&of(&triangle), 0.5 * determinant.abs());
            // Equilateral, with the circumradius 1.
            for size in [6, 9, 12] {
                assert_area(&of(&regular(size)), 0.75 * 3f64.sqrt() * determinant.abs());
            }
            for size in [5, 7, 10] {
                let ring = regular(size);
                assert_area(&of(&ring), largest_of_vertices(&ring) * determinant.abs());
            }
        }
    }
    // Corners are those of the polygon, to the last bit.
    let found = proved(&[square(0.0, 0.0, 1.0)]);
    assert_eq!(found.answer.area, 0.5);
    let mut corners = proved(&[vec![[0.0, 0.0], [3.0, 1.0], [1.0, 4.0]]]).answer.corners;
    corners.sort_by(|p, q| p[0].total_cmp(&q[0]));
    assert_eq!(corners, [[0.0, 0.0], [1.0, 4.0], [3.0, 1.0]]);
}

#[test]
fn corners_of_convex_polygons_are_vertices() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let size = 3 + (seed as usize % 12);
        let mut angles: Vec<f64> =
            (0..size).map(|_| random.unit() * std::f64::consts::TAU).collect();
        angles.sort_by(f64::total_cmp);
        let stretch = [[1.0 + random.unit(), random.unit()], [0.0, 1.0]];
        let circle: Ring = angles.iter().map(|angle| [angle.cos(), angle.sin()]).collect();
        let ring = mapped(&circle, stretch, [0.0, 0.0]);
        let expected = largest_of_vertices(&ring);
        assert_area(&[ring], expected);
    }
}

#[test]
fn holes_and_parts_move_the_optimum() {
    let outer = square(0.0, 0.0, 4.0);
    // A point-like hole in the middle lies beside the diagonal.
    let found = proved(&[outer.clone(), square(2.0 - 5e-10, 2.0 - 5e-10, 1e-9)]);
    assert!(is_near(found.answer.area, 8.0), "{}", found.answer.area);
    // A bar nearly from side to side leaves two rectangles: half of the larger one is best.
    let bar = vec![[1e-6, 1.5], [4.0 - 1e-6, 1.5], [4.0 - 1e-6, 2.0], [1e-6, 2.0]];
    let found = proved(&[outer.clone(), bar]);
    assert!((4.0 * (1.0 - EPSILON)..4.001).contains(&found.answer.area), "{found:?}");
    assert!(found.answer.corners.iter().all(|p| p[1] >= 1.999), "{:?}", found.answer);
    // A frame of width 1: less than half of what is left without the hole.
    let frame = [outer.clone(), square(1.0, 1.0, 2.0)];
    let with = proved(&frame).answer.area;
    let without = proved(&[outer]).answer.area;
    assert!(is_near(without, 8.0) && with < 4.0 && with > 2.0, "{with}");
    // Two parts: the larger one counts.
    let parts = [
        square(0.0, 0.0, 1.0),
        mapped(&square(0.0, 0.0, 1.0), [[3.0, 0.0], [0.0, 0.5]], [5.0, 5.0]),
    ];
    let found = proved(&parts);
    assert!(is_near(found.answer.area, 0.75) && found.answer.corners[0][0] >= 5.0);
    // An island in a hole.
    let nested = [square(0.0, 0.0, 8.0), square(0.5, 0.5, 7.0), square(1.0, 1.0, 6.0)];
    assert_area(&nested, 18.0);
}

#[test]
fn turned_scaled_shifted_and_reversed_polygons_have_the_same_area() {
    let mut lists = vec![(star_shaped(3, 10), 1), (tour(4, 12), 2)];
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
        check(mapped(&ring, [[1e150, 0.0], [0.0, 1e150]], [0.0, 0.0]), 1e300);
        check(mapped(&ring, [[1e-150, 0.0], [0.0, 1e-150]], [0.0, 0.0]), 1e-300);
        check(mapped(&ring, [[1.0, 0.0], [0.0, 1.0]], [4096.0, -1000.0]), 1.0);
        check(ring.iter().rev().copied().collect(), 1.0);
        let mut turned = ring.clone();
        turned.rotate_left(5);
        check(turned, 1.0);
    }
}

#[test]
fn no_triangle_of_a_random_search_is_larger() {
    for seed in 0..10 {
        let ring = if seed % 2 == 0 { star_shaped(seed, 9) } else { tour(seed, 11) };
        let found = proved(std::slice::from_ref(&ring));
        let upper = verified(&found, std::slice::from_ref(&ring)).upper;
        let mut random = Random(seed);
        let mut best = 0.0f64;
        for _ in 0..80 {
            // A random triangle, and the larger ones among random changes of it that get smaller.
            let mut here = [(); 3].map(|()| ring[(random.unit() * ring.len() as f64) as usize]);
            let (mut area, mut step) = (grown(here, &ring).0, 0.5);
            for _ in 0..400 {
                let next = here.map(|p| p.map(|x| x + step * (2.0 * random.unit() - 1.0)));
                let (other, next) = grown(next, &ring);
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

/// The largest image of a triangle from its centroid that no edge enters, and its area; 0 for one outside.
fn grown(corners: [[f64; 2]; 3], ring: &[[f64; 2]]) -> (f64, [[f64; 2]; 3]) {
    let [p, q, r] = corners;
    let cross = |p: [f64; 2], q: [f64; 2], w: [f64; 2]| {
        (p[0] - w[0]) * (q[1] - w[1]) - (p[1] - w[1]) * (q[0] - w[0])
    };
    let (doubled, mean) = (cross(p, q, r), [0, 1].map(|k| (p[k] + q[k] + r[k]) / 3.0));
    if doubled.is_nan() || doubled <= 1e-9 || !is_inside(mean, ring) {
        return (0.0, corners);
    }
    let mut scale = f64::INFINITY;
    for (i, &a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        let sides = [[p, q], [q, r], [r, p]];
        let at = |w| sides.map(|[p, q]| 1.0 - 3.0 * cross(p, q, w) / doubled);
        let (from, to) = (at(a), at(b));
        let reach = |t: f64| {
            let scales = (0..3).map(|k| from[k] + t * (to[k] - from[k]));
            scales.fold(f64::NEG_INFINITY, f64::max)
        };
        scale = scale.min(reach(0.0)).min(reach(1.0));
        // Between its ends the largest of the three is least where two of them are equal.
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let t = (from[i] - from[j]) / ((from[i] - from[j]) - (to[i] - to[j]));
            if t > 0.0 && t < 1.0 {
                scale = scale.min(reach(t));
            }
        }
    }
    let image = corners.map(|p| [0, 1].map(|k| mean[k] + scale * (p[k] - mean[k])));
    (0.5 * doubled * scale * scale, image)
}

#[test]
fn no_point_of_the_triangle_is_outside() {
    for seed in 20..26 {
        let ring = tour(seed, 30);
        let found = solve(std::slice::from_ref(&ring), 1e-2).unwrap();
        verified(&found, std::slice::from_ref(&ring));
        let InscribedTriangle { corners: [p, q, r], area } = found.answer;
        let doubled = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        assert!((2.0 * area / doubled - 1.0).abs() < 1e-12);
        let mut random = Random(seed);
        for _ in 0..1000 {
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            // A little towards the centroid.
            let (u, v) = [u, v].map(|x| 1e-7 + (1.0 - 3e-7) * x).into();
            let at = [0, 1].map(|k| p[k] + u * (q[k] - p[k]) + v * (r[k] - p[k]));
            assert!(is_inside(at, &ring), "{seed}: {at:?}");
        }
    }
}

#[test]
fn needles_far_away_and_budgets_end_with_the_gap_that_is_left() {
    for height in [1e-3, 1e-6, 1e-9] {
        let ring = vec![[0.0, 0.0], [1.0, 0.0], [0.5, height]];
        assert_area(&[ring], 0.5 * height);
    }
    for height in [1e-3, 1e-6] {
        let across = vec![[0.0, 0.0], [1.0, 1.0], [1.0 - height, 1.0 + height], [-height, height]];
        let found = solve(std::slice::from_ref(&across), 1e-3).unwrap();
        assert!(verified(&found, &[across]).gap <= 1.1e-3, "{height:e}");
        assert!((found.answer.area / height - 1.0).abs() < 1.1e-3, "{height:e}");
    }
    let far = 2f64.powi(30);
    let ring = vec![[far, far], [far + 1.0, far], [far + 0.25, far + 0.75]];
    let found = solve(std::slice::from_ref(&ring), EPSILON).unwrap();
    let verdict = verified(&found, std::slice::from_ref(&ring));
    assert!(verdict.gap <= 1e-4 && verdict.upper >= 0.375, "{verdict:?}");
    let star = star_shaped(7, 30);
    let points = rows(std::slice::from_ref(&star));
    for max_cells in [1, 2, 30, 100] {
        let options = TriangleOptions { epsilon: 1e-9, max_cells, ..Default::default() };
        let found = inscribed_triangle(&Points::new(&points, 3).unwrap(), &options).unwrap();
        let verdict = verified(&found, std::slice::from_ref(&star));
        assert_eq!(found.trace.stop, Stop::NodeBudget, "{max_cells}");
        assert!(verdict.gap > 1e-9 && found.certificate.tree.len() as u64 <= max_cells);
    }
    let huge = mapped(&star, [[1e200, 0.0], [0.0, 1e200]], [0.0, 0.0]);
    assert!(matches!(solve(&[huge], 1e-2), Err(Error::Area)));
}

/// In a strip of few units of the last place the centroid is rounded; the checker and the search have to round it alike.
#[test]
fn strips_of_a_few_last_digits_are_proved_or_refused() {
    let mut answered = 0;
    for units in 1..=12 {
        for shift in 0..4 {
            let high = 1.0 + f64::from(units) * f64::EPSILON;
            let start = 2e-16 * f64::from(units) + f64::from(shift) * 3e-17;
            for ring in [
                vec![[0.0, 0.0], [1.0, 1.0], [1.0, high], [0.0, start]],
                vec![[0.0, 0.0], [1.0, 0.5], [1.0, 0.5 * high], [0.0, start]],
                vec![[0.25, 0.25], [1.0, 1.0], [high, 1.0]],
            ] {
                let rings = [ring];
                match solve_with(&rings, 1e-3, 200) {
                    Ok(found) => {
                        verified(&found, &rings);
                        answered += 1;
                    }
                    Err(error) => assert!(matches!(error, Error::TooThin), "{error}: {rings:?}"),
                }
            }
        }
    }
    println!("{answered} of 144 answered");
    assert!(answered > 20);
}

#[test]
fn repeated_and_collinear_vertices_change_nothing() {
    let plain = square(0.0, 0.0, 1.0);
    let mut rich: Ring = vec![];
    for (i, p) in plain.iter().enumerate() {
        let q = plain[(i + 1) % 4];
        rich.extend([*p, *p, [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]]);
    }
    rich.push(plain[0]);
    assert_eq!(proved(&[rich]).answer.area, 0.5);
    let flat = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    assert!(matches!(solve(&[flat], EPSILON), Err(Error::NotSimple { .. })));
}

#[test]
fn threads_change_no_byte() {
    let ring = tour(9, 40);
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve(std::slice::from_ref(&ring), 1e-2).unwrap().to_json())
    };
    let one = of(1);
    assert!([2, 8].into_iter().all(|threads| of(threads) == one));
}

#[test]
fn bad_points_and_options_of_triangles_are_refused() {
    let of = |options: TriangleOptions<'_>| {
        let points = rows(&[square(0.0, 0.0, 1.0)]);
        inscribed_triangle(&Points::new(&points, 3).unwrap(), &options).unwrap_err().to_string()
    };
    for epsilon in [0.0, 1.0, f64::NAN] {
        assert!(of(TriangleOptions { epsilon, ..Default::default() }).contains("`epsilon` is"));
    }
    assert!(
        of(TriangleOptions { max_cells: 0, ..Default::default() }).contains("`max_cells` is 0")
    );
    let bow = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    assert!(matches!(solve(&[bow], EPSILON), Err(Error::NotSimple { .. })));
}
