//! Changed ellipses and certificates: what is not true any more must be rejected.

use super::common::{Ring, star_shaped, tour};
use super::ellipses::{proved, solve, verified};
use super::rings::{rows, square};
use taut_certify::{AnySolution, CheckError, Fault, InscribedEllipse, Solution, Violation};
use taut_points::{Monitor, Points, hash_points};

use crate::test_length::long_or;

type Found = Solution<InscribedEllipse>;

fn polygons() -> [Vec<Ring>; 3] {
    [
        vec![star_shaped(11, 14)],
        vec![tour(12, 16)],
        vec![square(0.0, 0.0, 4.0), square(1.0, 1.25, 1.5)],
    ]
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
fn wrong_ellipses_are_rejected() {
    for rings in polygons() {
        let found = proved(&rings);
        let rejected = |words: &str, change: &dyn Fn(&mut Found)| {
            assert_rejected(&found, &rings, words, change);
        };
        for bad in NO_NUMBERS {
            rejected("of the center is", &|found| found.answer.center[1] = bad);
            rejected("of the axes is", &|found| found.answer.axes[1][0] = bad);
            rejected("the area is", &|found| found.answer.area = bad);
            rejected("the gap is", &|found| found.certificate.gap = bad);
        }
        for far in [f64::MAX, -f64::MAX, 1e300, 50.0] {
            rejected("not inside", &|found| found.answer.center[0] = far);
        }
        for factor in [-1.0, 0.0, 0.9, 1.0 + 1e-12, 2.0, 1e300] {
            rejected("the area is", &|found| found.answer.area *= factor);
        }
        for factor in [1.0 + 1e-9, 1.1, 1e3] {
            rejected("enters the ellipse", &|found| {
                found.answer.axes.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
                found.answer.area *= factor * factor;
            });
        }
        for factor in [1.0 - 1e-5, 0.5, 1e-3] {
            // By the edges that it no longer touches, or by the gap.
            rejected("", &|found| {
                found.answer.axes.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
                found.answer.area *= factor * factor;
            });
        }
        rejected("span no area", &|found| found.answer.axes[0] = [0.0; 2]);
        rejected("span no area", &|found| found.answer.axes = [[0.0, 1.0], [1.0, 0.0]]);
        rejected("", &|found| found.answer.axes[0] = [f64::MAX; 2]);
        rejected("", &|found| found.answer.axes.swap(0, 1));
        let size = found.answer.area.sqrt();
        for step in [1e-3, -1e-3, 1e-6, -1e-6] {
            rejected("enters the ellipse", &|found| {
                found.answer.center[0] += step * size;
                found.answer.center[1] += 0.7 * step * size;
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
        rejected(range, &|found| found.certificate.root[0] = 2000);
        rejected(range, &|found| found.certificate.root[1] = i32::MIN);
        rejected(range, &|found| found.certificate.root.swap(1, 2));
        rejected(range, &|found| found.certificate.directions = vec![[1.0, 0.0]; 17]);
        for direction in [[f64::NAN, 1.0], [0.1, 0.1], [0.0, 0.0], [2.0, 0.0]] {
            rejected(range, &|found| found.certificate.directions.push(direction));
        }
        // A smaller root proves less.
        rejected("", &|found| found.certificate.root[2] -= 1);
        rejected("", &|found| found.certificate.root[1] += 1);
    }
}

#[test]
fn changed_letters_of_the_tree_are_rejected_or_true() {
    for rings in polygons() {
        let found = solve(&rings, 1e-2).unwrap();
        let tree = &found.certificate.tree;
        let with = |tree: String| {
            let mut changed = found.clone();
            changed.certificate.tree = tree;
            violation(&changed, &rings)
        };
        let best = solve(&rings, 1e-5).unwrap().answer.area;
        for (place, letter) in tree.char_indices().step_by(tree.len().div_ceil(long_or(300, 30))) {
            let (before, after) = (&tree[..place], &tree[place + 1..]);
            let letter = letter.to_string();
            for other in ["s", "t", "x", "y", "f", "n", "o", "b", "z", "é", ""] {
                if other == letter {
                    continue;
                }
                // Split along another axis, or for another reason, a cell may still be proved, and a cell may not need its frame: what
                // is accepted must be true.
                let mut changed = found.clone();
                changed.certificate.tree = format!("{before}{other}{after}");
                match changed.check(&Points::new(&rows(&rings), 3).unwrap()) {
                    Ok(verdict) => assert!(verdict.upper >= best * (1.0 - 1e-14)),
                    Err(CheckError::Rejected(_)) => {}
                    Err(error) => panic!("{error}"),
                }
                let is_split = |letter: &str| "stxy".contains(letter) && !letter.is_empty();
                if is_split(other) != is_split(&letter) && letter != "f"
                    || "zé".contains(other) && !other.is_empty()
                {
                    assert!(
                        violation(&changed, &rings).is_some(),
                        "{letter} at {place} to {other}"
                    );
                }
            }
            let said = with(format!("{before}{letter}{letter}{after}"));
            assert!(said.is_some(), "{letter} at {place} doubled");
        }
        assert!(with(String::new()).is_some());
        assert!(with(format!("{tree}n")).is_some());
        // A subdivision that never ends is refused where cells have no middle.
        assert!(with("st".repeat(50_000)).is_some());
        assert!(with(format!("f{}", "xy".repeat(50_000))).is_some());
    }
}

#[test]
fn changed_leaves_prove_no_more_than_is_true() {
    for rings in polygons() {
        let found = solve(&rings, 1e-2).unwrap();
        let best = proved(&rings).answer.area;
        let count = rows(&rings).len() as u64 / 3;
        let still_true =
            |changed: &Found| match changed.check(&Points::new(&rows(&rings), 3).unwrap()) {
                Ok(verdict) => assert!(verdict.upper >= best * (1.0 - 1e-14)),
                Err(CheckError::Rejected(_)) => {}
                Err(error) => panic!("{error}"),
            };
        let leaves = found.certificate.leaves.len();
        for place in (0..leaves).step_by(leaves.div_ceil(long_or(60, 15))) {
            let with = |leaf: Option<Vec<u64>>| {
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
                Some(vec![u64::MAX]),
                Some(vec![0, 0]),
                Some(vec![0, 1, 1]),
                Some(vec![0, 1, 1, 0]),
                Some(vec![0, 1 << 53, 1, 1]),
                Some(vec![0, u64::MAX, 1, u64::MAX]),
                Some(vec![0; 70]),
            ] {
                assert!(violation(&with(bad.clone()), &rings).is_some(), "{place}: {bad:?}");
            }
            for other in 0..count {
                still_true(&with(Some(vec![other])));
            }
            let leaf = &found.certificate.leaves[place];
            for entry in 0..leaf.len() {
                for change in [1, u64::MAX] {
                    let mut other = leaf.clone();
                    other[entry] = other[entry].wrapping_add(change);
                    still_true(&with(Some(other)));
                }
            }
        }
        // Without its widths the tree proves less, but nothing false.
        let mut changed = found.clone();
        changed.certificate.directions.clear();
        still_true(&changed);
    }
}

#[test]
fn other_polygons_are_rejected() {
    for rings in polygons() {
        let found = proved(&rings);
        let mut moved = rings.clone();
        moved[0][3][0] += 1e-9;
        let said = violation(&found, &moved).unwrap();
        assert!(matches!(said, Violation::Hash { .. }) && said.fault(9) == Fault::Points, "{said}");
        // A vertex comes into the ellipse, a hole goes, a hole appears: with the right hash.
        let center = found.answer.center;
        let mut entered = rings.clone();
        entered[0][0] = center;
        let tiny = square(center[0] - 1e-9, center[1], 1e-9);
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
    let [.., holed] = polygons();
    let found = proved(&holed);
    let filled = &holed[..1];
    let values = rows(filled);
    let points = Points::new(&values, 3).unwrap();
    let mut forged = found.clone();
    forged.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    assert!(violation(&forged, filled).is_some());
    assert!(verified(&proved(filled), filled).upper > found.answer.area * 1.5);
}

#[test]
fn an_edge_in_the_ellipse_is_reported_by_its_row() {
    let rings = [square(0.0, 0.0, 2.0)];
    let mut found = proved(&rings);
    found.answer.center[0] = 1.5;
    let said = violation(&found, &rings).unwrap();
    assert_eq!(said.fault(4), Fault::Row(1), "{said}");
}

#[test]
fn fields_of_the_json_are_all_needed() {
    let text = proved(&polygons()[2]).to_json();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    for part in ["answer", "certificate"] {
        for field in document[part].as_object().unwrap().keys() {
            let mut changed = document.clone();
            drop(changed[part].as_object_mut().unwrap().remove(field));
            assert!(AnySolution::from_json(&changed.to_string()).is_err(), "{part}.{field}");
        }
    }
    assert!(AnySolution::from_json(&text).is_ok());
}

#[test]
fn contacts_are_decided_exactly() {
    let rings = [square(-1.0, -1.0, 2.0)];
    let mut exact = proved(&rings);
    let area = std::f64::consts::PI;
    exact.answer = InscribedEllipse { center: [0.0; 2], axes: [[1.0, 0.0], [0.0, 1.0]], area };
    assert_eq!(violation(&exact, &rings), None);
    // The least changes make an edge enter.
    let enters = |change: &dyn Fn(&mut Found)| {
        assert_rejected(&exact, &rings, "enters the ellipse", change);
    };
    enters(&|found| found.answer.axes[0][0] = 1.0f64.next_up());
    enters(&|found| found.answer.axes[1][1] = 1.0f64.next_up());
    enters(&|found| found.answer.center[0] = f64::MIN_POSITIVE);
    enters(&|found| found.answer.center[1] = -1e-200);
    enters(&|found| found.answer.axes[0][1] = 1e-160);
}
