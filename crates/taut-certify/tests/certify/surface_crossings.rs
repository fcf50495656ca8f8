//! Triangles that meet, with balls claimed or not: what empty balls prove against brute force in exact arithmetic, and forged surfaces.

use proptest::collection::vec;
use proptest::prelude::*;
use surface::{Case, Point, cube, oracle};
use taut_certify::{Apex, SurfaceDoubt, SurfaceViolation, Violation};

use crate::surface;

/// A matrix of whole numbers that turns and reflects, times three: planes stay planes and spheres spheres, exactly.
fn tilted([x, y, z]: Point) -> Point {
    [x + 2.0 * y + 2.0 * z, 2.0 * x + y - 2.0 * z, 2.0 * x - 2.0 * y + z]
}

/// Places with many of them on common planes, circles and spheres; all different.
fn places() -> impl Strategy<Value = Vec<Point>> {
    let small = || (-2i32..3).prop_map(f64::from);
    let grid = [small(), small(), small()];
    let plane = (small(), small()).prop_map(|(x, y)| [x, y, 0.0]);
    // On the circle of radius 5, and on the sphere of radius 3.
    let circle = (0usize..12).prop_map(|k| {
        let [x, y] = [[3.0, 4.0], [4.0, 3.0], [5.0, 0.0]][k % 3];
        match k / 3 {
            0 => [x, y, 0.0],
            1 => [-y, x, 0.0],
            2 => [-x, -y, 0.0],
            _ => [y, -x, 0.0],
        }
    });
    let sphere = (0usize..3, 0usize..8, any::<bool>()).prop_map(|(turn, signs, is_axis)| {
        let at = if is_axis { [3.0, 0.0, 0.0] } else { [1.0, 2.0, 2.0] };
        let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
        [0, 1, 2].map(|k| sign(k) * at[(k + turn) % 3])
    });
    let all = prop_oneof![vec(grid, 4..9), vec(plane, 4..9), vec(circle, 4..9), vec(sphere, 4..9),];
    // Some of them an ulp off, on a grid of its own or tilted.
    (all, any::<bool>(), vec(0u32..24, 0..3)).prop_map(|(all, is_tilted, moved)| {
        let mut places: Vec<Point> = vec![];
        for (k, place) in all.into_iter().enumerate() {
            let mut place = if is_tilted { tilted(place) } else { place };
            for axis in 0..3 {
                if moved.contains(&(3 * k as u32 + axis)) {
                    place[axis as usize] = place[axis as usize].next_up();
                }
            }
            if !places.contains(&place) {
                places.push(place);
            }
        }
        places
    })
}

/// Some triangles of the places that have an empty ball, each with one.
fn with_balls(places: &[Point], numbers: &[usize]) -> (Vec<[u32; 3]>, Vec<Apex>) {
    let (mut triangles, mut apexes): (Vec<[u32; 3]>, Vec<Apex>) = (vec![], vec![]);
    let sites: Vec<u32> = (0..places.len() as u32).collect();
    for four in numbers.as_chunks::<4>().0 {
        let [a, b, c] = [0, 1, 2].map(|k| (four[k] % places.len()) as u32);
        let is_new = triangles.iter().all(|t| ![a, b, c].iter().all(|row| t.contains(row)));
        if a == b || b == c || c == a || !is_new {
            continue;
        }
        // Which one is asked first is a matter of chance.
        let mut all: Vec<Apex> = sites.iter().map(|&row| Apex::Row(row)).collect();
        all.extend([Apex::Gabriel, Apex::Hull]);
        let first = four[3] % all.len();
        all.rotate_left(first);
        let is_ball = |&apex: &Apex| oracle::is_empty(places, &sites, [a, b, c], apex);
        if let Some(apex) = all.into_iter().find(is_ball) {
            triangles.push([a, b, c]);
            apexes.push(apex);
        }
    }
    (triangles, apexes)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 300, ..ProptestConfig::default() })]

    /// Triangles with empty balls are embedded just where exact arithmetic says so, whatever lies on their spheres.
    #[test]
    fn triangles_with_empty_balls_meet_where_exact_arithmetic_says_so(
        places in places(), numbers in vec(0usize..1000, 8..40),
    ) {
        prop_assume!(places.len() > 2);
        let (triangles, apexes) = with_balls(&places, &numbers);
        prop_assume!(!triangles.is_empty());
        let is_embedded = oracle::is_embedded(&places, &triangles);
        let mut case = Case::of(places, triangles);
        case.certificate().apexes = apexes;
        let topology = &case.solution.answer.topology;
        let outward = is_embedded && topology.is_manifold() && topology.is_oriented();
        for claimed in [is_embedded, !is_embedded] {
            (case.certificate().embedded, case.certificate().outward) = (claimed, outward);
            match case.check() {
                Ok(verdict) => {
                    prop_assert_eq!(verdict.is_embedded, is_embedded);
                    prop_assert!(claimed == is_embedded && verdict.is_delaunay);
                }
                // A small closed surface may face inwards.
                Err(Violation::Surface(SurfaceViolation::NotOutward { .. })) => {
                    prop_assert!(outward && claimed == is_embedded);
                }
                Err(Violation::Surface(
                    SurfaceViolation::NotEmbedded { .. } | SurfaceViolation::Embedded
                )) => prop_assert!(claimed != is_embedded),
                Err(other) => prop_assert!(false, "{other}"),
            }
        }
    }
}

/// How often the property above sees what it is about.
#[test]
fn triangles_with_empty_balls_do_meet_now_and_then() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let (mut runner, mut meet, mut all) = (TestRunner::deterministic(), 0, 0);
    for _ in 0..crate::test_length::long_or(200, 80) {
        let places = places().new_tree(&mut runner).unwrap().current();
        let numbers = vec(0usize..1000, 40).new_tree(&mut runner).unwrap().current();
        if places.len() < 3 {
            continue;
        }
        let (triangles, _) = with_balls(&places, &numbers);
        all += 1;
        meet += usize::from(!oracle::is_embedded(&places, &triangles));
    }
    assert!(meet > all / 10 && meet < all * 9 / 10, "{meet} of {all}");
}

/// The problem of a pair of triangles, their rows, and the two.
type Pair = (&'static str, Vec<Point>, [[u32; 3]; 2]);

/// Pairs of triangles that share more than their common vertices, of every kind.
fn pairs() -> Vec<Pair> {
    let base = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let apart = [[0, 1, 2], [3, 4, 5]];
    let mut pairs = vec![];
    for (name, other) in [
        ("through each other", [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 0.5]]),
        ("an edge through the face", [[1.0, 1.0, -1.0], [1.0, 2.0, 1.0], [2.0, 9.0, 1.0]]),
        ("a vertex in the face", [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]),
        ("a vertex on an edge", [[2.0, 0.0, 0.0], [2.0, -1.0, 1.0], [3.0, -1.0, 1.0]]),
        ("edge across edge", [[2.0, -1.0, 1.0], [2.0, 1.0, -1.0], [9.0, -9.0, 1.0]]),
        ("overlapping in the plane", [[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [1.0, 5.0, 0.0]]),
        ("within, in the plane", [[0.5, 0.5, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0, 0.0]]),
        ("edge along edge", [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, -1.0, 3.0]]),
        (
            "a vertex on an edge, in the plane",
            [[2.0, 0.0, 0.0], [2.0, -1.0, 0.0], [3.0, -1.0, 0.0]],
        ),
    ] {
        pairs.push((name, [base, other].concat(), apart));
    }
    for (name, other) in [
        ("a common vertex, through the face", [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0]]),
        ("a common vertex, along an edge", [[2.0, 0.0, 0.0], [1.0, -1.0, 2.0]]),
        ("a common vertex, overlapping in the plane", [[3.0, 1.0, 0.0], [1.0, 3.0, 0.0]]),
        ("a common vertex, around in the plane", [[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0]]),
        ("a common vertex, an edge into the face", [[1.0, 1.0, 0.0], [1.0, 1.0, 2.0]]),
    ] {
        pairs.push((name, [&base[..], &other].concat(), [[0, 1, 2], [0, 3, 4]]));
    }
    for (name, other) in [
        ("a common edge, folded over", [1.0, 1.0, 0.0]),
        ("a common edge, folded over beyond", [4.0, 4.0, 0.0]),
        ("a common edge, folded over onto an edge", [0.0, 1.0, 0.0]),
    ] {
        pairs.push((name, [&base[..], &[other]].concat(), [[0, 1, 2], [0, 1, 3]]));
    }
    pairs
}

/// No claim of balls, and no other site, hides a pair that meets.
#[test]
fn forged_pairs_are_refused_whatever_balls_are_claimed() {
    for (name, rows, triangles) in pairs() {
        assert!(!oracle::is_embedded(&rows, &triangles), "{name}");
        for is_tilted in [false, true] {
            for scale in [1.0, 0.1, 2f64.powi(-600)] {
                let place = |p: &Point| {
                    let p = if is_tilted { tilted(*p) } else { *p };
                    p.map(|x| x * scale)
                };
                let mut rows: Vec<Point> = rows.iter().map(place).collect();
                if !oracle::is_embedded(&rows, &triangles) {
                    let mut case = Case::of(rows.clone(), triangles.to_vec());
                    let first = case.rows.len() as u32;
                    let rows_of = (0..first).map(Apex::Row);
                    let apexes: Vec<Apex> = rows_of.chain([Apex::Gabriel, Apex::Hull]).collect();
                    case.certificate().apexes = vec![];
                    let crossing = SurfaceDoubt::Crossing { triangles: [0, 1] };
                    let expected = SurfaceViolation::NotEmbedded { doubt: crossing };
                    assert_eq!(case.violation(), expected, "{name}");
                    for one in &apexes {
                        for other in &apexes {
                            case.certificate().apexes = vec![*one, *other];
                            assert_eq!(case.violation(), expected, "{name}: {one:?}, {other:?}");
                        }
                    }
                }
                // With sites all around, those of the pair left out or not.
                rows.extend((0..27).map(|k| {
                    place(
                        &[f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)]
                            .map(|x| 4.0 * x - 3.5),
                    )
                }));
                let mut case = Case::of(rows.clone(), triangles.to_vec());
                let is_listed = case.solution.answer.unused.duplicates.is_empty();
                if is_listed && !oracle::is_embedded(&rows, &triangles) {
                    for apex in [Apex::Gabriel, Apex::Hull, Apex::Row(9)] {
                        case.certificate().apexes = vec![apex; 2];
                        let violation = case.violation();
                        let is_named = matches!(violation, SurfaceViolation::NotEmbedded { .. });
                        assert!(is_named, "{name}: {violation}");
                    }
                }
            }
        }
    }
}

/// Triangles that meet although both have empty balls: their vertices lie on one circle or one sphere.
#[test]
fn ties_that_meet_are_refused() {
    let cube = cube().rows;
    let square: Vec<Point> = cube[..4].to_vec();
    // Rows 0, 1, 3, 2 run around the square.
    for (name, rows, triangles, apex) in [
        (
            "halves of a square by both diagonals",
            &square,
            vec![[0, 1, 3], [0, 1, 2]],
            Apex::Gabriel,
        ),
        ("the same as facets of a hull", &square, vec![[0, 1, 3], [1, 3, 2]], Apex::Hull),
        ("the face of a cube, twice", &cube, vec![[0, 1, 3], [0, 3, 2], [0, 1, 2]], Apex::Gabriel),
        ("across a cube", &cube, vec![[0, 3, 5], [1, 2, 4]], Apex::Row(7)),
        ("a vertex in common, across a cube", &cube, vec![[0, 3, 5], [0, 1, 7]], Apex::Row(2)),
    ] {
        for is_tilted in [false, true] {
            let rows = rows.iter().map(|&p| if is_tilted { tilted(p) } else { p }).collect();
            let mut case = Case::of(rows, triangles.clone());
            case.certificate().apexes = vec![apex; triangles.len()];
            assert!(!oracle::is_embedded(&case.rows, &triangles), "{name}");
            let sites: Vec<u32> = (0..case.rows.len() as u32).collect();
            for &triangle in &triangles {
                assert!(oracle::is_empty(&case.rows, &sites, triangle, apex), "{name}");
            }
            let violation = case.violation();
            assert!(
                matches!(violation, SurfaceViolation::NotEmbedded { .. }),
                "{name}: {violation}"
            );
            (case.certificate().embedded, case.certificate().outward) = (false, false);
            let verdict = case.check().unwrap();
            assert!(verdict.is_delaunay && !verdict.is_embedded && !verdict.certified, "{name}");
        }
    }
}
