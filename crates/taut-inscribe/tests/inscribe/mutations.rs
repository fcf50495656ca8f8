//! Changed answers and certificates: what is not true any more must be rejected.

use super::common::{Ring, comb, proved, solve, star_shaped, tour};
use taut_certify::{AnySolution, CheckError, Fault, InscribedCircle, Solution, Violation};
use taut_points::{Points, PointsHash, hash_points};

type Solved = Solution<InscribedCircle>;

fn rings() -> [Ring; 3] {
    [star_shaped(11, 20), tour(12, 24), comb(4, 0.7)]
}

fn violation(found: &Solved, ring: &[[f64; 2]]) -> Option<Violation> {
    match found.check(&Points::new(ring.as_flattened(), 2).unwrap()) {
        Ok(_) => None,
        Err(CheckError::Rejected(violation)) => Some(violation),
        Err(error) => panic!("{error}"),
    }
}

fn assert_rejected(ring: &[[f64; 2]], words: &str, change: impl Fn(&mut Solved)) {
    let mut found = solve(ring).unwrap();
    change(&mut found);
    let said = violation(&found, ring).map(|violation| violation.to_string());
    assert!(said.as_ref().is_some_and(|said| said.contains(words)), "{words}: {said:?}");
}

/// Numbers that no field may have.
const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn wrong_centers_are_rejected() {
    for ring in rings() {
        for bad in NO_NUMBERS {
            assert_rejected(&ring, "of the center is", |found| found.answer.center[1] = bad);
        }
        for far in [f64::MAX, -f64::MAX, 1e300, 10.0] {
            assert_rejected(&ring, "not inside", |found| found.answer.center[0] = far);
        }
        assert_rejected(&ring, "not inside", |found| found.answer.center = [1e-320, -9.0]);
        for step in [1e-3, -1e-3, 1e-9, -1e-9] {
            let radius = proved(&ring).0.answer.radius;
            assert_rejected(&ring, "less than the radius", |found| {
                found.answer.center[0] += step * radius;
                found.answer.center[1] += 0.7 * step * radius;
                found.answer.radius = radius * (1.0 + 1e-12);
            });
        }
    }
}

#[test]
fn wrong_radii_are_rejected() {
    for ring in rings() {
        for bad in NO_NUMBERS.into_iter().chain([0.0, -0.0, -1.0]) {
            assert_rejected(&ring, "the radius is", |found| found.answer.radius = bad);
        }
        for factor in [1.0 + 1e-13, 1.0 + 1e-9, 2.0, 1e300] {
            assert_rejected(&ring, "less than the radius", |found| found.answer.radius *= factor);
        }
        for factor in [1.0 - 1e-8, 0.5, 1e-300] {
            // By the edges that it no longer touches, or by the gap.
            assert_rejected(&ring, "", |found| found.answer.radius *= factor);
        }
        // A circle too small for its scale to be told from 0.
        let mut found = solve(&ring).unwrap();
        found.answer.radius = f64::from_bits(1);
        assert!(violation(&found, &ring).is_some());
    }
}

#[test]
fn wrong_gaps_are_rejected() {
    for ring in rings() {
        for bad in NO_NUMBERS.into_iter().chain([-1e-9, -f64::MIN_POSITIVE]) {
            assert_rejected(&ring, "the gap is", |found| found.certificate.gap = bad);
        }
        let (found, verdict) = proved(&ring);
        if verdict.gap > 1e-14 {
            let claimed = 0.5 * found.certificate.gap;
            assert_rejected(&ring, "a gap of", |found| found.certificate.gap = claimed);
        }
    }
}

#[test]
fn wrong_touching_edges_are_rejected() {
    for ring in rings() {
        let count = ring.len() as u64;
        let words = "of the touching edges";
        assert_rejected(&ring, words, |found| found.certificate.touching.clear());
        assert_rejected(&ring, words, |found| found.certificate.touching.push(count));
        assert_rejected(&ring, words, |found| found.certificate.touching.push(u64::MAX));
        assert_rejected(&ring, words, |found| found.certificate.touching.reverse());
        assert_rejected(&ring, words, |found| {
            let first = found.certificate.touching[0];
            found.certificate.touching.insert(0, first);
        });
        assert_rejected(&ring, words, |found| {
            let touching = &mut found.certificate.touching;
            let free = (0..count).find(|row| !touching.contains(row)).unwrap();
            touching.push(free);
            touching.sort_unstable();
        });
    }
}

#[test]
fn every_changed_letter_of_the_tree_is_rejected() {
    for ring in rings() {
        let found = solve(&ring).unwrap();
        let tree = &found.certificate.tree;
        let with = |tree: String| {
            let mut changed = found.clone();
            changed.certificate.tree = tree;
            changed
        };
        for (place, letter) in tree.char_indices() {
            let (before, after) = (&tree[..place], &tree[place + 1..]);
            for other in ["x", "y", "o", "b", "s", "é", ""] {
                let is_split = |letter: &str| ["x", "y"].contains(&letter);
                let letter = letter.to_string();
                // Split along the other axis a cell may still be proved.
                if other != letter && !(is_split(other) && is_split(&letter)) {
                    let changed = with(format!("{before}{other}{after}"));
                    assert!(violation(&changed, &ring).is_some(), "{letter} at {place} to {other}");
                }
            }
            let changed = with(format!("{before}{letter}{letter}{after}"));
            assert!(violation(&changed, &ring).is_some(), "{letter} at {place} doubled");
        }
        assert!(violation(&with(String::new()), &ring).is_some());
        // A subdivision that never ends is refused where cells have no middle.
        assert!(violation(&with("xy".repeat(50_000)), &ring).is_some());
    }
}

#[test]
fn changed_leaves_prove_no_more_than_is_true() {
    for ring in rings() {
        let (found, _) = proved(&ring);
        let true_radius = found.answer.radius;
        let still_true =
            |changed: &Solved| match changed.check(&Points::new(ring.as_flattened(), 2).unwrap()) {
                Ok(verdict) => assert!(verdict.upper >= true_radius * (1.0 - 1e-14)),
                Err(CheckError::Rejected(_)) => {}
                Err(error) => panic!("{error}"),
            };
        for place in 0..found.certificate.leaves.len() {
            let with = |leaf: Option<Vec<u64>>| {
                let mut changed = found.clone();
                match leaf {
                    Some(leaf) => changed.certificate.leaves[place] = leaf,
                    None => drop(changed.certificate.leaves.remove(place)),
                }
                changed
            };
            let leaf = &found.certificate.leaves[place];
            for bad in [
                None,
                Some(vec![]),
                Some(vec![ring.len() as u64]),
                Some(vec![u64::MAX]),
                Some(vec![0, 0]),
                Some(vec![0, 1, 1]),
                Some(vec![0, 1, 1, 0]),
                Some(vec![0, 1 << 53, 1, 1]),
                Some(vec![0, u64::MAX, 1, u64::MAX]),
                Some([leaf.as_slice(), &[0]].concat()).filter(|leaf| leaf.len() % 2 == 1),
            ] {
                let is_dropped = bad.is_none();
                if is_dropped || bad.as_ref().is_some_and(|bad| bad.len() != 1 || bad[0] > 0) {
                    let changed = with(bad);
                    let said = violation(&changed, &ring);
                    // One more weight than edges makes an even list longer only when it had weights.
                    assert!(said.is_some(), "leaf {place} of {leaf:?}");
                }
            }
            for other in (place as u64 % 7..ring.len() as u64).step_by(7) {
                still_true(&with(Some(vec![other])));
            }
            for entry in 0..leaf.len() {
                for change in [1, u64::MAX] {
                    let mut other = leaf.clone();
                    other[entry] = other[entry].wrapping_add(change);
                    still_true(&with(Some(other)));
                }
            }
        }
    }
}

#[test]
fn other_points_are_rejected() {
    for ring in rings() {
        let found = solve(&ring).unwrap();
        let mut moved = ring.clone();
        moved[3][0] += 1e-9;
        let said = violation(&found, &moved).unwrap();
        assert!(matches!(said, Violation::Hash { .. }) && said.fault(9) == Fault::Points, "{said}");
        // The answer of another ring, with the right hash: a vertex comes into the circle.
        let center = found.answer.center;
        let mut changed = ring.clone();
        changed[0] = center.map(|x| x + 0.1 * found.answer.radius);
        let mut forged = found.clone();
        let points = Points::new(changed.as_flattened(), 2).unwrap();
        forged.certificate.points_hash =
            hash_points(&points, &taut_points::Monitor::silent()).unwrap();
        assert!(violation(&forged, &changed).is_some());
        for dim in [1, 3] {
            let points = Points::new(&[0.0; 6], dim).unwrap();
            assert!(found.check(&points).is_err());
        }
        let empty: [f64; 0] = [];
        let mut of_nothing = found.clone();
        of_nothing.certificate.points_hash = PointsHash::of_blocks(0, 2, []);
        assert!(of_nothing.check(&Points::new(&empty, 2).unwrap()).is_err());
    }
}

#[test]
fn an_edge_in_the_circle_is_named_by_its_row() {
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let mut found = solve(&square).unwrap();
    found.answer.center[0] = 1.5;
    let said = violation(&found, &square).unwrap();
    assert_eq!(said.fault(4), Fault::Row(1), "{said}");
}

#[test]
fn fields_of_the_json_are_all_needed() {
    let text = solve(&rings()[0]).unwrap().to_json();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    for part in ["answer", "certificate"] {
        for field in document[part].as_object().unwrap().keys() {
            for value in [None, Some(serde_json::json!("x")), Some(serde_json::json!(-1))] {
                let mut changed = document.clone();
                let fields = changed[part].as_object_mut().unwrap();
                let is_tree = field == "tree" && value.as_ref().is_some_and(|v| v.is_string());
                let is_number = ["radius", "gap"].contains(&field.as_str())
                    && value.as_ref().is_some_and(|value| value.is_number());
                match value {
                    None => drop(fields.remove(field)),
                    Some(value) => drop(fields.insert(field.clone(), value)),
                }
                let read = AnySolution::from_json(&changed.to_string());
                // These are read, and refused by the checker.
                assert_eq!(read.is_ok(), is_tree || is_number, "{part}.{field}");
            }
        }
    }
}
