//! Changed triangles and certificates: what is not true any more must be rejected.

use super::common::{Ring, star_shaped, tour};
use super::rings::{rows, square};
use super::triangles::{solve, verified};
use taut_certify::{AnySolution, CheckError, Fault, InscribedTriangle, Solution, Violation};
use taut_points::{Monitor, Points, hash_points};

use crate::test_length::long_or;

type Found = Solution<InscribedTriangle>;

/// Polygons, and largest triangles in them.
fn solved() -> Vec<(Vec<Ring>, Found)> {
    let polygons = [
        vec![star_shaped(11, 12)],
        vec![tour(12, 14)],
        vec![square(0.0, 0.0, 4.0), square(1.0, 1.25, 1.5)],
    ];
    let solved = polygons.into_iter().map(|rings| {
        let found = solve(&rings, 1e-2).unwrap();
        verified(&found, &rings);
        (rings, found)
    });
    solved.collect()
}

fn violation(found: &Found, rings: &[Ring]) -> Option<Violation> {
    match found.check(&Points::new(&rows(rings), 3).unwrap()) {
        Ok(_) => None,
        Err(CheckError::Rejected(violation)) => Some(violation),
        Err(error) => panic!("{error}"),
    }
}

fn assert_rejected(base: &Found, rings: &[Ring], words: &str, change: impl Fn(&mut Found)) {
    let mut found = base.clone();
    change(&mut found);
    let said = violation(&found, rings).map(|violation| violation.to_string());
    assert!(said.as_ref().is_some_and(|said| said.contains(words)), "{words}: {said:?}");
}

/// Numbers that no field may have.
const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn wrong_triangles_are_rejected() {
    for (rings, found) in solved() {
        let rejected = |words: &str, change: &dyn Fn(&mut Found)| {
            assert_rejected(&found, &rings, words, change);
        };
        for bad in NO_NUMBERS {
            rejected("of corner 1 is", &|found| found.answer.corners[1][0] = bad);
            rejected("the area is", &|found| found.answer.area = bad);
            rejected("the gap is", &|found| found.certificate.gap = bad);
            rejected("out of its range", &|found| found.certificate.skew = bad);
            rejected("out of its range", &|found| found.certificate.root[0][1] = bad);
        }
        for far in [f64::MAX, -f64::MAX, 1e300, 50.0] {
            rejected("", &|found| found.answer.corners[0][0] = far);
        }
        for factor in [-1.0, 0.0, 0.9, 1.0 + 1e-12, 2.0, 1e300] {
            rejected("the area is", &|found| found.answer.area *= factor);
        }
        let scaled = |found: &mut Found, factor: f64| {
            let corners = found.answer.corners;
            let mean = [0, 1].map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0);
            let image = |p: [f64; 2]| [0, 1].map(|k| mean[k] + factor * (p[k] - mean[k]));
            found.answer.corners = corners.map(image);
            found.answer.area *= factor * factor;
        };
        for factor in [1.0 + 1e-9, 1.1, 1e3] {
            rejected("enters the triangle", &|found| scaled(found, factor));
        }
        for factor in [0.99, 0.5, 1e-3] {
            // By the edges that it no longer touches, by the gap, or by the area, which is rounded.
            rejected("", &|found| scaled(found, factor));
        }
        rejected("counterclockwise", &|found| found.answer.corners.swap(0, 1));
        rejected("counterclockwise", &|found| found.answer.corners[1] = found.answer.corners[2]);
        let size = found.answer.area.sqrt();
        for step in [1e-3, -1e-3, 1e-6, -1e-6] {
            rejected("enters the triangle", &|found| {
                for corner in &mut found.answer.corners {
                    corner[0] += step * size;
                    corner[1] += 0.7 * step * size;
                }
            });
        }
        rejected("a gap of", &|found| found.certificate.gap *= 0.5);
        rejected("a gap of", &|found| found.certificate.gap = 0.0);
        let count = rows(&rings).len() as u64 / 3;
        let words = "of the touching edges";
        rejected(words, &|found| found.certificate.touching.clear());
        rejected(words, &|found| found.certificate.touching.push(count));
        rejected(words, &|found| found.certificate.touching.reverse());
        rejected(words, &|found| {
            let touching = &mut found.certificate.touching;
            let free = (0..count).find(|row| !touching.contains(row)).unwrap();
            touching.push(free);
            touching.sort_unstable();
        });
        let range = "out of its range";
        for skew in [4.5, -1e300] {
            rejected(range, &|found| found.certificate.skew = skew);
        }
        rejected(range, &|found| found.certificate.root[0][0] = 0.0);
        rejected(range, &|found| found.certificate.root[1][1] -= 0.1);
        rejected(range, &|found| found.certificate.root[1][0] = 3.5);
        rejected(range, &|found| found.certificate.root.swap(0, 1));
        // Other cells than those of the tree.
        rejected("", &|found| found.certificate.skew = 0.5);
    }
}

#[test]
fn changed_letters_of_the_tree_are_rejected_or_true() {
    for (rings, found) in solved() {
        let tree = &found.certificate.tree;
        let best = solve(&rings, 1e-4).unwrap().answer.area;
        let with = |tree: String| {
            let mut changed = found.clone();
            changed.certificate.tree = tree;
            changed
        };
        for (place, letter) in tree.char_indices().step_by(tree.len().div_ceil(long_or(250, 25))) {
            let (before, after) = (&tree[..place], &tree[place + 1..]);
            for other in ["0", "3", "5", "a", "b", "c", "e", "l", "o", "z", "é", ""] {
                let letter = letter.to_string();
                if other == letter {
                    continue;
                }
                let is_split = |letter: &str| "012345".contains(letter) && !letter.is_empty();
                let changed = with(format!("{before}{other}{after}"));
                let verdict = changed.check(&Points::new(&rows(&rings), 3).unwrap());
                // Split along another axis, or for another reason, a cell may still be proved: what is accepted must be true.
                match verdict {
                    Ok(verdict) => assert!(verdict.upper >= best * (1.0 - 1e-14)),
                    Err(CheckError::Rejected(_)) => {}
                    Err(error) => panic!("{error}"),
                }
                if is_split(other) != is_split(&letter) || ["z", "é", ""].contains(&other) {
                    assert!(
                        violation(&changed, &rings).is_some(),
                        "{letter} at {place} to {other}"
                    );
                }
            }
            let doubled = with(format!("{before}{letter}{letter}{after}"));
            assert!(violation(&doubled, &rings).is_some(), "{letter} at {place} doubled");
        }
        for tree in [String::new(), format!("{tree}a"), "03".repeat(50_000), "0".repeat(5000)] {
            // A subdivision that never ends is refused where boxes have no middle.
            assert!(violation(&with(tree), &rings).is_some());
        }
    }
}

#[test]
fn changed_leaves_prove_no_more_than_is_true() {
    for (rings, found) in solved() {
        let best = solve(&rings, 1e-4).unwrap().answer.area;
        let count = rows(&rings).len() as i64 / 3;
        let still_true =
            |changed: &Found| match changed.check(&Points::new(&rows(&rings), 3).unwrap()) {
                Ok(verdict) => assert!(verdict.upper >= best * (1.0 - 1e-14)),
                Err(CheckError::Rejected(_)) => {}
                Err(error) => panic!("{error}"),
            };
        let leaves = found.certificate.leaves.len();
        for place in (0..leaves).step_by(leaves.div_ceil(long_or(50, 6))) {
            let with = |leaf: Option<Vec<i64>>| {
                let mut changed = found.clone();
                match leaf {
                    Some(leaf) => changed.certificate.leaves[place] = leaf,
                    None => drop(changed.certificate.leaves.remove(place)),
                }
                changed
            };
            for bad in [
                None,
                Some(vec![]),
                Some(vec![count]),
                Some(vec![count, 0]),
                Some(vec![-1, 0]),
                Some(vec![0, -1]),
                Some(vec![0, 65537]),
                Some(vec![61, 3, 0, 0, 1]),
                Some(vec![-1, 3, 0, 0, 1]),
                Some(vec![0, 6, 0, 0, 1]),
                Some(vec![0, -1, 0, 0, 1]),
                Some(vec![0, 0, 0, 0, 1]),
                Some(vec![0, 0, i64::MIN, 0, 1]),
                Some(vec![0, 0, 1, 1 << 31, 1]),
                Some(vec![0, 0, 1, 0, 0]),
                Some(vec![0, 0, 1, 0, i64::MAX]),
                Some(vec![0, 3, count, 0, 1]),
                Some(vec![0, 3, i64::MIN, 0, 1]),
                Some([vec![0], [0, 1, 0, 1].repeat(17)].concat()),
            ] {
                assert!(violation(&with(bad.clone()), &rings).is_some(), "{place}: {bad:?}");
            }
            let leaf = &found.certificate.leaves[place];
            for entry in 0..leaf.len() {
                for change in [1, -1, 5, 1000] {
                    let mut other = leaf.clone();
                    other[entry] = other[entry].wrapping_add(change);
                    still_true(&with(Some(other)));
                }
            }
        }
    }
}

#[test]
fn other_polygons_are_rejected() {
    for (rings, found) in solved() {
        let mut moved = rings.clone();
        moved[0][3][0] += 1e-9;
        let said = violation(&found, &moved).unwrap();
        assert!(matches!(said, Violation::Hash { .. }) && said.fault(9) == Fault::Points, "{said}");
        // A vertex comes into the triangle, a hole appears: with the right hash.
        let [p, q, r] = found.answer.corners;
        let mean = [0, 1].map(|k| (p[k] + q[k] + r[k]) / 3.0);
        let mut entered = rings.clone();
        entered[0][0] = mean;
        let tiny = square(mean[0] - 1e-9, mean[1], 1e-9);
        let appeared = [rings.clone(), vec![tiny]].concat();
        for changed in [entered, appeared] {
            let values = rows(&changed);
            let points = Points::new(&values, 3).unwrap();
            let mut forged = found.clone();
            forged.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
            let said = violation(&forged, &changed);
            assert!(said.is_some(), "{changed:?}");
        }
    }
    // Without the hole a larger triangle is inside, and the cells that it closed are open.
    let (holed, found) = solved().pop().unwrap();
    let filled = &holed[..1];
    let values = rows(filled);
    let points = Points::new(&values, 3).unwrap();
    let mut forged = found.clone();
    forged.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    assert!(violation(&forged, filled).is_some());
}

#[test]
fn an_answer_survives_its_json() {
    let (rings, found) = solved().remove(0);
    let text = found.to_json();
    let AnySolution::Triangle(again) = AnySolution::from_json(&text).unwrap() else {
        panic!("{text}");
    };
    assert_eq!(again, found);
    verified(&again, &rings);
}
