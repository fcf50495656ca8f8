//! Large convex polygons in polygons: closed forms, laws, holes, an independent search, and mutations of the certificate.

use super::common::{Ring, comb, is_inside, regular, star_shaped, tour};
use super::rings::{rows, square};
use taut_certify::{
    CheckError, ConvexPolygon, ConvexVerdict, ConvexViolation, Solution, Violation,
};
use taut_inscribe::{ConvexOptions, Error, inscribed_polygon};
use taut_points::Points;

use crate::test_length::long_or;

/// Edges of convex polygons may reach this far out of the ring, in the search to compare with.
const REACH_SLACK: f64 = 1e-9;

fn solve_with(
    rings: &[Ring],
    options: &ConvexOptions<'_>,
) -> Result<Solution<ConvexPolygon>, Error> {
    inscribed_polygon(&Points::new(&rows(rings), 3).unwrap(), options)
}

fn check(found: &Solution<ConvexPolygon>, rings: &[Ring]) -> Result<ConvexVerdict, CheckError> {
    found.check(&Points::new(&rows(rings), 3).unwrap())
}

/// The polygon found with the default options, verified.
fn proved(rings: &[Ring]) -> (Solution<ConvexPolygon>, ConvexVerdict) {
    let found = solve_with(rings, &ConvexOptions::default()).unwrap();
    let verdict = check(&found, rings);
    let verdict = verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer));
    assert!(verdict.lower <= found.answer.area * (1.0 + 1e-12), "{verdict:?}");
    assert!(verdict.gap < 0.671, "{verdict:?}");
    (found, verdict)
}

fn assert_area(rings: &[Ring], expected: f64) {
    let area = proved(rings).0.answer.area;
    assert!((area / expected - 1.0).abs() <= 1e-8, "{area} instead of {expected}: {rings:?}");
}

/// Twice the area of the triangle abc, counterclockwise.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn area(ring: &[[f64; 2]]) -> f64 {
    ring[1..].windows(2).map(|pair| 0.5 * turn(ring[0], pair[0], pair[1])).sum()
}

#[test]
fn a_convex_polygon_is_its_own_largest_part() {
    for size in [3, 4, 5, 12, long_or(100, 40)] {
        let ring = regular(size);
        let (found, verdict) = proved(std::slice::from_ref(&ring));
        assert!((found.answer.area / area(&ring) - 1.0).abs() <= 1e-9, "{size}");
        assert!(verdict.gap <= 2e-9, "the hull is the bound: {verdict:?}");
    }
}

#[test]
fn closed_forms_are_found() {
    // Every line through the inner corner leaves as much of an L as half of it.
    let l = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    assert_area(&[l], 2.0);
    // A corridor beside the hole; a hole that is moved leaves a wider one.
    assert_area(&[square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)], 4.0);
    assert_area(&[square(0.0, 0.0, 4.0), square(2.0, 1.0, 1.5)], 8.0);
    // The bar of a comb, and a single tooth that is longer.
    assert_area(&[comb(5, 1.5)], 9.0);
    assert_area(&[comb(3, 20.0)], 21.0);
    // Of two parts, the larger one.
    assert_area(&[square(0.0, 0.0, 1.0), square(5.0, 0.0, 3.0)], 9.0);
}

#[test]
fn images_have_the_image_of_the_answer() {
    let ring = star_shaped(3, 12);
    let before = proved(std::slice::from_ref(&ring)).0.answer.area;
    for [[a, b], [c, d]] in
        [[[0.0, 1.0], [-1.0, 0.0]], [[1e9, 0.0], [0.0, 1e-9]], [[-3.0, 0.0], [0.0, 1.0]]]
    {
        let map = |p: &[f64; 2]| [a * p[0] + b * p[1], c * p[0] + d * p[1]];
        let image: Ring = ring.iter().map(map).collect();
        let factor: f64 = a * d - b * c;
        let after = proved(&[image]).0.answer.area / factor.abs();
        // Starts and random rounds differ.
        assert!((after / before - 1.0).abs() <= 1e-2, "{after} and {before}");
    }
    for scale in [1e-140, 1e140] {
        let image: Ring = ring.iter().map(|p| p.map(|x| x * scale)).collect();
        let after = proved(&[image]).0.answer.area / scale / scale;
        assert!((after / before - 1.0).abs() <= 1e-9, "{after} and {before}");
    }
    let shifted: Ring = ring.iter().map(|p| [p[0] + 1e6, p[1] - 1e6]).collect();
    let after = proved(&[shifted]).0.answer.area;
    assert!((after / before - 1.0).abs() <= 1e-5, "{after} and {before}");
}

#[test]
fn areas_are_those_of_a_search_over_corners_or_larger() {
    let (count, mut worst, mut larger) = (long_or(100, 24), f64::INFINITY, 0);
    for seed in 0..count {
        let size = 6 + (seed as usize) % 15;
        let ring = if seed % 2 == 0 { tour(seed, size) } else { star_shaped(seed, size) };
        let found = proved(std::slice::from_ref(&ring)).0.answer.area;
        let expected = largest_over_candidates(&ring);
        worst = worst.min(found / expected);
        larger += usize::from(found >= expected * (1.0 - 1e-9));
    }
    println!("worst ratio {worst:.4}, at least as large in {larger} of {count}");
    assert!(worst >= 0.98, "{worst}");
}

/// The largest convex polygon whose corners are vertices of the ring, points on its edges, or points where lines through two of
/// its reflex vertices meet it: dynamic programming over chains from each lowest corner.
fn largest_over_candidates(ring: &[[f64; 2]]) -> f64 {
    let n = ring.len();
    let mut ring = ring.to_vec();
    let signed: f64 = (0..n).map(|i| turn([0.0; 2], ring[i], ring[(i + 1) % n])).sum();
    if signed < 0.0 {
        ring.reverse();
    }
    let edge = |i: usize| [ring[i], ring[(i + 1) % n]];
    let mut points = ring.clone();
    for i in 0..n {
        let [a, b] = edge(i);
        for share in [0.25, 0.5, 0.75] {
            points.push([0, 1].map(|k| a[k] + share * (b[k] - a[k])));
        }
    }
    let is_reflex = |&i: &usize| turn(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]) < 0.0;
    let reflex: Vec<[f64; 2]> = (0..n).filter(is_reflex).map(|i| ring[i]).collect();
    for (i, &p) in reflex.iter().enumerate() {
        for &q in &reflex[i + 1..] {
            for [a, b] in (0..n).map(edge) {
                let (here, there) = (turn(p, q, a), turn(p, q, b));
                if here * there < 0.0 {
                    let share = here / (here - there);
                    let at = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                    if sees(&ring, p, at) {
                        points.push(at);
                    }
                }
            }
        }
    }
    points.sort_by(|p, q| p[1].total_cmp(&q[1]).then(p[0].total_cmp(&q[0])));
    points.dedup();
    let m = points.len();
    let mut visible = vec![false; m * m];
    for i in 0..m {
        for j in i + 1..m {
            let is_visible = sees(&ring, points[i], points[j]);
            (visible[i * m + j], visible[j * m + i]) = (is_visible, is_visible);
        }
    }
    (0..m).map(|lowest| largest_from(lowest, &points, &visible)).fold(0.0, f64::max)
}

/// The largest convex polygon with a given lowest corner.
fn largest_from(lowest: usize, points: &[[f64; 2]], visible: &[bool]) -> f64 {
    let (m, p) = (points.len(), points[lowest]);
    let mut others: Vec<usize> = (lowest + 1..m).filter(|&i| visible[lowest * m + i]).collect();
    // No point is below the lowest, so that angles are from 0 to π.
    let angle = |i: usize| (points[i][1] - p[1]).atan2(points[i][0] - p[0]);
    others.sort_by(|&i, &j| angle(i).total_cmp(&angle(j)).then(i.cmp(&j)));
    let k = others.len();
    // The largest chain that ends with the side from one point to the next, as the area seen from the lowest corner.
    let mut chain = vec![f64::NEG_INFINITY; k * k];
    let mut most = 0.0f64;
    for j in 0..k {
        for i in 0..j {
            let (a, b) = (points[others[i]], points[others[j]]);
            let piece = 0.5 * turn(p, a, b);
            if piece <= 0.0 || !visible[others[i] * m + others[j]] {
                continue;
            }
            let mut best = 0.0f64;
            for h in 0..i {
                let o = points[others[h]];
                if chain[h * k + i] > best && turn(o, a, b) > 0.0 {
                    best = chain[h * k + i];
                }
            }
            chain[i * k + j] = best + piece;
            most = most.max(best + piece);
        }
    }
    most
}

/// Whether the segment pq stays in the ring, up to the slack.
fn sees(ring: &[[f64; 2]], p: [f64; 2], q: [f64; 2]) -> bool {
    let n = ring.len();
    for i in 0..n {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        let crosses = |one: f64, other: f64| {
            (one > REACH_SLACK && other < -REACH_SLACK)
                || (one < -REACH_SLACK && other > REACH_SLACK)
        };
        if crosses(turn(p, q, a), turn(p, q, b)) && crosses(turn(a, b, p), turn(a, b, q)) {
            return false;
        }
    }
    // Between the places where it touches the ring it is inside or outside.
    let mut touched: Vec<f64> = vec![0.0, 1.0];
    let square = (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2);
    for &a in ring {
        if turn(p, q, a).abs() <= REACH_SLACK {
            touched.push(((a[0] - p[0]) * (q[0] - p[0]) + (a[1] - p[1]) * (q[1] - p[1])) / square);
        }
    }
    touched.retain(|share| (0.0..=1.0).contains(share));
    touched.sort_by(f64::total_cmp);
    touched.windows(2).filter(|pair| pair[1] - pair[0] > 1e-6).all(|pair| {
        let share = 0.5 * (pair[0] + pair[1]);
        let middle = [0, 1].map(|k| p[k] + share * (q[k] - p[k]));
        is_inside(middle, ring) || super::common::clearance(middle, ring) <= REACH_SLACK
    })
}

#[test]
fn answers_are_the_same_for_every_number_of_threads_and_of_each_seed() {
    let rings = [tour(11, 60)];
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let options = ConvexOptions { seed: 5, ..Default::default() };
    let found = solve_with(&rings, &options).unwrap();
    assert_eq!(one.install(|| solve_with(&rings, &options)).unwrap().to_json(), found.to_json());
    let few = ConvexOptions { rounds: 0, starts: 1, ..Default::default() };
    let first = solve_with(&rings, &few).unwrap();
    assert!(first.answer.area <= found.answer.area);
    check(&first, &rings).unwrap();
}

#[test]
fn thin_rectangles_have_proved_answers_or_a_reason() {
    let (mut answers, mut tried) = (0, 0);
    for exponent in (2..15).step_by(long_or(1, 5)) {
        let (factor, angles) = match exponent % 2 {
            0 => (1.0, [0.0f64, 0.576]),
            _ => (0.4, [0.3, std::f64::consts::FRAC_PI_4]),
        };
        let width = factor * 10f64.powi(-exponent);
        for angle in angles {
            tried += 1;
            let (sine, cosine) = angle.sin_cos();
            let at = |x: f64, y: f64| [cosine * x - sine * y, sine * x + cosine * y];
            let ring = vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, width), at(0.0, width)];
            match solve_with(
                std::slice::from_ref(&ring),
                &ConvexOptions { rounds: 4, ..Default::default() },
            ) {
                Ok(found) => {
                    let verdict = check(&found, std::slice::from_ref(&ring));
                    assert!(verdict.is_ok(), "{width:e}, {angle}: {verdict:?}, {ring:?}");
                    answers += 1;
                }
                Err(error) => assert!(
                    matches!(error, Error::TooThin | Error::NotSimple { .. }),
                    "{width:e}, {angle}: {error}"
                ),
            }
        }
    }
    assert!(2 * answers > tried, "{answers} of {tried}");
}

#[test]
fn bad_input_is_refused() {
    let rings = [square(0.0, 0.0, 1.0)];
    let wrong = [
        ConvexOptions { starts: 0, ..Default::default() },
        ConvexOptions { epsilon: 0.0, ..Default::default() },
        ConvexOptions { epsilon: f64::NAN, ..Default::default() },
    ];
    for options in wrong {
        assert!(matches!(solve_with(&rings, &options), Err(Error::Input(_))));
    }
    let crossed = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let found = solve_with(&[crossed], &ConvexOptions::default());
    assert!(matches!(found, Err(Error::NotSimple { .. })));
    let huge: Ring = rings[0].iter().map(|p| p.map(|x| x * 1e200)).collect();
    assert!(matches!(solve_with(&[huge], &ConvexOptions::default()), Err(Error::Area)));
}

#[test]
fn every_change_of_answer_or_proof_is_refused() {
    let rings =
        [square(0.0, 0.0, 8.0), tour(2, 20).iter().map(|p| p.map(|x| 2.0 + 3.0 * x)).collect()];
    let found = proved(&rings).0;
    let refused = |change: &dyn Fn(&mut Solution<ConvexPolygon>)| {
        let mut changed = found.clone();
        change(&mut changed);
        assert_ne!(changed, found);
        match check(&changed, &rings) {
            Err(CheckError::Rejected(violation)) => violation,
            other => panic!("{other:?}: {:?}", changed.answer),
        }
    };
    let convex = |violation: Violation| match violation {
        Violation::Convex(violation) => violation,
        other => panic!("{other}"),
    };
    let count = found.answer.vertices.len();
    for corner in 0..count {
        // Outward by a share of the way from the opposite corner.
        let out = |f: &mut Solution<ConvexPolygon>| {
            let from = f.answer.vertices[(corner + count / 2) % count];
            let at = &mut f.answer.vertices[corner];
            *at = [0, 1].map(|k| from[k] + 1.01 * (at[k] - from[k]));
        };
        refused(&out);
        refused(&|f| f.answer.vertices[corner][0] = f64::NAN);
        refused(&|f| f.answer.vertices.swap(corner, (corner + 1) % count));
    }
    let kinds = [
        convex(refused(&|f| f.answer.vertices.truncate(2))),
        convex(refused(&|f| f.answer.vertices.extend_from_within(..))),
        convex(refused(&|f| f.answer.vertices.reverse())),
        convex(refused(&|f| f.answer.area *= 1.0 + 1e-9)),
        convex(refused(&|f| f.certificate.inside = f.answer.vertices[0])),
        convex(refused(&|f| f.certificate.gap *= 0.99)),
        convex(refused(&|f| {
            f.answer.vertices = square(4.0, 4.0, 100.0);
            f.certificate.inside = [50.0, 50.0];
        })),
        convex(refused(&|f| {
            f.answer.vertices = square(9.0, 9.0, 1.0);
            f.certificate.inside = [9.5, 9.5];
        })),
    ];
    use ConvexViolation as V;
    assert!(matches!(
        kinds,
        [
            V::TooFewCorners { corners: 2 },
            V::Winding { turns: 2 },
            V::NotConvex { .. },
            V::Area { .. },
            V::WitnessOutside { .. },
            V::Gap { .. },
            V::EdgeInside { .. },
            V::Outside { .. },
        ]
    ));
    refused(&|f| f.certificate.ellipse.area *= 1.01);
    refused(&|f| f.certificate.ellipse_certificate.leaves.truncate(1));
    refused(&|f| f.certificate.ellipse_certificate.gap = 0.0);
    refused(&|f| f.certificate.gap = f64::INFINITY);
    refused(&|f| f.certificate.inside = [f64::NAN, 0.0]);
}
