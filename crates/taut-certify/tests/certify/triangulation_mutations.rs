//! Damaged triangulations and certificates: every one must be refused, also when the rest was made to fit.

use crate::test_length::long_or;
use std::collections::BTreeSet;

use mesh::{Case, Dice, brute_force, certify, hull_of, rows, set, solved};
use taut_certify::{CheckError, MeshViolation, Triangulation, Violation, check_simplices};
use taut_points::Monitor;

use crate::mesh;

fn valid() -> Vec<Case> {
    let mut dice = Dice(11);
    let grid = |side: i32, d: usize| -> Vec<f64> {
        let cell = |i: i32| (0..d as u32).map(move |k| f64::from(i / side.pow(k) % side));
        (0..side.pow(d as u32)).flat_map(cell).collect()
    };
    let tiny: Vec<f64> = grid(3, 2).iter().map(|x| (x - 1.0) * 2f64.powi(-996)).collect();
    let huge: Vec<f64> = grid(2, 3).iter().map(|x| (x - 1.0) * 2f64.powi(996)).collect();
    let mut twice = grid(3, 2);
    twice.extend([1.0, 1.0, 0.0, 2.0, 1.0, 1.0]);
    vec![
        solved("3 × 3", &grid(3, 2), 2),
        solved("3 × 3 at 2⁻⁹⁹⁶", &tiny, 2),
        solved("3 × 3 with duplicates", &twice, 2),
        solved("cube", &grid(2, 3), 3),
        solved("cube at 2⁹⁹⁶", &huge, 3),
        solved("nine in the plane", &dice.numbers(18), 2),
        solved("eight in space", &dice.numbers(24), 3),
        solved("eight in space, on a grid", &dice.grid(24, 4), 3),
        solved("on a line", &[0., 0., 3., 3., 1., 1., 2., 2., 1., 1.], 2),
        solved(
            "on a plane",
            &[0., 0., 1., 1., 0., 1., 0., 1., 1., 1., 1., 1., 2., 0., 1., 0., 2., 1.],
            3,
        ),
        solved("one point", &[4., 4., 4., 4.], 2),
    ]
}

/// Takes copies of a valid case and changes them.
struct Damage<'a> {
    case: &'a Case,
    made: Vec<(&'static str, Case)>,
}

impl Damage<'_> {
    fn to(&mut self, kind: &'static str, change: impl FnOnce(&mut Case)) {
        let mut case = self.case.clone();
        change(&mut case);
        assert_ne!(case.solution, self.case.solution, "{kind}: nothing was changed");
        self.made.push((kind, case));
    }

    /// The change alone, and the change with neighbors, counts and fingerprint that fit it.
    fn in_both_ways(&mut self, kind: &'static str, change: impl Fn(&mut Triangulation)) {
        self.to(kind, |case| change(&mut case.solution.answer));
        self.to(kind, |case| {
            change(&mut case.solution.answer);
            *case = case.consistent();
        });
    }
}

fn damaged(case: &Case) -> Vec<(&'static str, Case)> {
    let mut damage = Damage { case, made: vec![] };
    simplices(&mut damage);
    flips(&mut damage);
    hull(&mut damage);
    duplicates(&mut damage);
    certificate(&mut damage);
    damage.made
}

fn simplices(damage: &mut Damage<'_>) {
    let answer = damage.case.solution.answer.clone();
    let width = answer.vertices_per_simplex();
    let n = damage.case.points().len() as u32;
    let has_hull = width >= 3;
    for (s, simplex) in rows(&answer.simplices, width).into_iter().enumerate() {
        let at = s * width;
        damage.in_both_ways("simplex lost", |answer| {
            answer.simplices.drain(at..at + width);
        });
        if has_hull {
            damage.in_both_ways("simplex lost, and the hull that is left given", |answer| {
                answer.simplices.drain(at..at + width);
                answer.hull = hull_of(&answer.simplices, width);
            });
        }
        damage.in_both_ways("simplex doubled", |answer| answer.simplices.extend(&simplex));
        if width >= 2 {
            damage.in_both_ways("simplex turned over", |answer| answer.simplices.swap(at, at + 1));
        }
        for k in at..at + width {
            for id in (0..n + 2).filter(|&id| id != answer.simplices[k]) {
                if id < n || k == at {
                    damage.to("vertex changed", |case| case.solution.answer.simplices[k] = id);
                }
                if id < n && !simplex.contains(&id) {
                    damage.to("vertex changed, all else fitting", |case| {
                        case.solution.answer.simplices[k] = id;
                        *case = case.consistent();
                    });
                }
            }
        }
    }
    for (k, l) in [(0, 3), (1, 5), (2, 7)] {
        if answer.simplices.len() > l && answer.simplices[k] != answer.simplices[l] {
            damage.in_both_ways("ids swapped", |answer| answer.simplices.swap(k, l));
        }
    }
    for dimension in [None, Some(0), Some(1), Some(2), Some(3), Some(4), Some(255)] {
        if dimension != answer.hull_dimension {
            damage.to("other dimension of the hull", |case| {
                case.solution.answer.hull_dimension = dimension;
            });
        }
    }
    damage.to("other dimension", |case| case.solution.answer.dimension ^= 1);
    damage.to("nothing left", |case| {
        case.solution.answer.simplices.clear();
        case.solution.answer.hull.clear();
        case.solution.certificate.neighbors.clear();
    });
}

/// Two simplices for two others, three for two and two for three, with everything that fits them: the tilings stay
/// tilings, and only the geometry can tell.
fn flips(damage: &mut Damage<'_>) {
    let case = damage.case;
    let answer = &case.solution.answer;
    let width = answer.vertices_per_simplex();
    if width < 3 {
        return;
    }
    let original = set(answer);
    let simplices = rows(&answer.simplices, width);
    let mut seen = BTreeSet::new();
    for (i, first) in simplices.iter().enumerate() {
        for second in &simplices[i + 1..] {
            let mut all: BTreeSet<u32> = first.iter().chain(second).copied().collect();
            if all.len() != width + 1 {
                continue;
            }
            // The two ways to tile the hull of these few points are their own triangulations with the lifts as they
            // are and reversed; the latter is found by trying all complements.
            let points: Vec<u32> = std::mem::take(&mut all).into_iter().collect();
            let inside: Vec<usize> = (0..simplices.len())
                .filter(|&s| simplices[s].iter().all(|id| points.contains(id)))
                .collect();
            let now: BTreeSet<u32> =
                inside.iter().map(|&s| opposite(&simplices[s], &points)).collect();
            let then: Vec<u32> = points.iter().copied().filter(|id| !now.contains(id)).collect();
            if then.is_empty() || !seen.insert(points.clone()) {
                continue;
            }
            let mut flipped: Vec<u32> = (0..simplices.len())
                .filter(|s| !inside.contains(s))
                .flat_map(|s| simplices[s].clone())
                .collect();
            for left_out in then {
                let simplex: Vec<u32> =
                    points.iter().copied().filter(|&id| id != left_out).collect();
                flipped.extend(facing(case, simplex));
            }
            let mut changed = answer.clone();
            changed.simplices = flipped;
            changed.hull = hull_of(&changed.simplices, width);
            assert_ne!(set(&changed), original);
            damage.to("flip", |case| case.solution = certify(&case.values, changed.clone()));
            damage.to("flip, and no neighbors", |case| {
                case.solution = certify(&case.values, changed);
                case.solution.certificate.neighbors.clear();
            });
        }
    }
}

fn opposite(simplex: &[u32], points: &[u32]) -> u32 {
    *points.iter().find(|id| !simplex.contains(id)).expect("one more point than vertices")
}

/// The simplex, turned round if it faces the wrong way as far as f64 can tell.
fn facing(case: &Case, mut simplex: Vec<u32>) -> Vec<u32> {
    let largest = case.values.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let d = simplex.len() - 1;
    let row = |id: u32| -> Vec<f64> {
        case.points().row(id as usize).iter().map(|x| x / largest).collect()
    };
    let edge = |k: usize| -> Vec<f64> {
        row(simplex[k]).iter().zip(row(simplex[0])).map(|(a, b)| a - b).collect()
    };
    let (a, b) = (edge(1), edge(2));
    let volume = match d {
        2 => a[0] * b[1] - a[1] * b[0],
        _ => {
            let c = edge(3);
            c[0] * (a[1] * b[2] - a[2] * b[1])
                + c[1] * (a[2] * b[0] - a[0] * b[2])
                + c[2] * (a[0] * b[1] - a[1] * b[0])
        }
    };
    if volume < 0.0 {
        simplex.swap(0, 1);
    }
    simplex
}

fn hull(damage: &mut Damage<'_>) {
    let hull = damage.case.solution.answer.hull.clone();
    let width = damage.case.solution.answer.vertices_per_simplex().saturating_sub(1);
    let n = damage.case.points().len() as u32;
    for (f, facet) in rows(&hull, width).into_iter().enumerate() {
        let at = f * width;
        damage.in_both_ways("hull facet lost", |answer| {
            answer.hull.drain(at..at + width);
        });
        damage.in_both_ways("hull facet doubled", |answer| answer.hull.extend(&facet));
        if width >= 2 {
            damage.in_both_ways("hull facet turned over", |answer| answer.hull.swap(at, at + 1));
        }
        for k in at..at + width {
            for id in (0..n + 1).filter(|&id| id != hull[k]) {
                damage.to("hull facet of another point", |case| case.solution.answer.hull[k] = id);
            }
        }
    }
    damage.to("half a hull facet", |case| case.solution.answer.hull.push(0));
}

fn duplicates(damage: &mut Damage<'_>) {
    let n = damage.case.points().len() as u32;
    let list = damage.case.solution.answer.duplicates.clone();
    for k in 0..list.len() {
        damage.in_both_ways("duplicate lost", |answer| {
            answer.duplicates.remove(k);
        });
        damage.in_both_ways("duplicate twice", |answer| answer.duplicates.insert(k, list[k]));
        damage.in_both_ways("duplicate reversed", |answer| answer.duplicates[k].reverse());
        for id in 0..n + 1 {
            for place in [0, 1] {
                if id != list[k][place] {
                    damage.to("duplicate of another", |case| {
                        case.solution.answer.duplicates[k][place] = id;
                    });
                }
            }
        }
    }
    for row in 0..n {
        for first in 0..n {
            if !list.contains(&[row, first]) {
                damage.to("duplicate added", |case| {
                    case.solution.answer.duplicates.push([row, first]);
                    case.solution.answer.duplicates.sort_unstable();
                });
            }
        }
    }
    if list.len() > 1 {
        damage.to("duplicates in another order", |case| case.solution.answer.duplicates.reverse());
    }
}

fn certificate(damage: &mut Damage<'_>) {
    let case = damage.case;
    let count = case.solution.answer.len() as u32;
    for k in 0..case.solution.certificate.neighbors.len() {
        for other in (0..count + 1).chain([u32::MAX - 1, u32::MAX]) {
            if other != case.solution.certificate.neighbors[k] {
                damage
                    .to("neighbor changed", |case| case.solution.certificate.neighbors[k] = other);
            }
        }
    }
    damage.to("a neighbor too many", |case| case.solution.certificate.neighbors.push(0));
    for bit in 0..128 {
        damage.to("bit of the fingerprint", |case| {
            case.solution.certificate.fingerprint.0 ^= 1 << bit
        });
    }
    for bit in 0..64 {
        damage.to("bit of the hash", |case| case.solution.certificate.points_hash.0 ^= 1 << bit);
    }
    damage.to("sites miscounted", |case| case.solution.certificate.counts.sites += 1);
    damage.to("simplices miscounted", |case| case.solution.certificate.counts.simplices += 1);
    damage.to("hull miscounted", |case| case.solution.certificate.counts.hull ^= 1);
}

/// In one test, as the valid cases take longer than what is done with them.
#[test]
fn every_damage_is_refused_and_flips_as_plain_meshes_too() {
    let (mut made, mut plain) = (0, 0);
    let mut accepted = vec![];
    for case in valid() {
        plain += flips_refused_as_plain_meshes(&case);
        assert!(case.solution.check(&case.points()).is_ok(), "{}", case.name);
        for (kind, changed) in damaged(&case).into_iter().step_by(long_or(1, 15)) {
            made += 1;
            match changed.solution.check(&case.points()) {
                Ok(_) => accepted.push(format!("{}: {kind}: {:?}", case.name, changed.solution)),
                Err(CheckError::Rejected(_)) => {}
                Err(error) => panic!("{}: {kind}: {error}", case.name),
            }
        }
    }
    assert!(accepted.is_empty(), "{} of {made}:\n{}", accepted.len(), accepted.join("\n"));
    assert!(made > long_or(10_000, 650) && plain > long_or(30, 15), "{made}, {plain}");
}

/// A coordinate moved by one ulp changes the hash; with the hash of the moved points, the answer stands exactly if it is
/// that of the moved points too.
#[test]
fn one_ulp_is_judged_by_what_it_changes() {
    let (mut stood, mut fell) = (0, 0);
    let mut dice = Dice(12);
    // Away from 0, beside which an ulp makes fractions of thousands of digits.
    let cases = [
        solved("square and center", &[1., 1., 3., 1., 1., 3., 3., 3., 2., 2.], 2),
        solved("lattice", &[1., 1., 2., 1., 3., 1., 1., 2., 2., 2., 3., 2.], 2),
        solved("in the plane", &dice.numbers(12), 2),
        solved("in space", &dice.numbers(15), 3),
        solved(
            "octahedron",
            &[1., 2., 2., 3., 2., 2., 2., 1., 2., 2., 3., 2., 2., 2., 1., 2., 2., 3.],
            3,
        ),
        solved("on a line", &[1., 1., 3., 3., 2., 2.], 2),
        solved("on a plane", &[1., 1., 1., 2., 1., 1., 1., 2., 1., 2., 2., 1.], 3),
        solved("twice", &[1., 1., 2., 1., 1., 2., 2., 1.], 2),
    ];
    for case in cases {
        for k in (0..case.values.len()).step_by(long_or(1, 2)) {
            for next in [case.values[k].next_up(), case.values[k].next_down()] {
                let mut moved = case.clone();
                moved.values[k] = next;
                match moved.solution.check(&moved.points()) {
                    Err(CheckError::Rejected(Violation::Hash { .. })) => {}
                    other => panic!("{}: {other:?}", case.name),
                }
                let moved = moved.consistent();
                let truth = brute_force(&moved.values, moved.dimension());
                let answer = &moved.solution.answer;
                let holds = set(&truth) == set(answer)
                    && (truth.hull_dimension, &truth.duplicates)
                        == (answer.hull_dimension, &answer.duplicates);
                let found = moved.solution.check(&moved.points());
                assert_eq!(found.is_ok(), holds, "{} at {k}: {found:?}", case.name);
                if holds { stood += 1 } else { fell += 1 }
            }
        }
    }
    assert!(stood.min(fell) > long_or(30, 12), "{stood} stood, {fell} fell");
}

/// What the messages are about.
#[test]
fn violations_are_named() {
    let grid: Vec<f64> = (0..9).flat_map(|i| [f64::from(i / 3), f64::from(i % 3)]).collect();
    let case = solved("3 × 3", &grid, 2);
    let violation = |change: &dyn Fn(&mut Case)| {
        let mut changed = case.clone();
        change(&mut changed);
        match changed.solution.check(&changed.points()) {
            Err(CheckError::Rejected(Violation::Mesh(violation))) => violation,
            other => panic!("{other:?}"),
        }
    };
    let neighbors = case.solution.certificate.neighbors.clone();
    let inner = neighbors.iter().position(|&n| n != u32::MAX).unwrap();
    assert_eq!(
        violation(&|case| case.solution.answer.simplices.swap(3, 4)),
        match neighbors[..3].contains(&1) {
            true => MeshViolation::Neighbor {
                simplex: 0,
                facet: neighbors[..3].iter().position(|&n| n == 1).unwrap(),
                neighbor: 1,
                problem: "that does not name it back across the same facet",
            },
            false => MeshViolation::Orientation { simplex: 1 },
        }
    );
    assert_eq!(
        violation(&|case| case.solution.answer.simplices[4] = 77),
        MeshViolation::Id { list: "simplices", position: 1, id: 77 }
    );
    assert_eq!(
        violation(&|case| case.solution.answer.duplicates.push([8, 3])),
        MeshViolation::Duplicate { position: 0, row: 8, first: 3, problem: "they differ" }
    );
    assert!(matches!(
        violation(&|case| {
            case.solution.answer.hull.drain(..2);
        }),
        MeshViolation::Open { .. }
    ));
    assert!(matches!(
        violation(&|case| case.solution.answer.hull.rotate_left(1)),
        MeshViolation::HullFacet { position: 0 }
    ));
    assert!(matches!(
        violation(&|case| case.solution.certificate.neighbors[inner] = u32::MAX),
        MeshViolation::Neighbor { .. }
            | MeshViolation::Open { .. }
            | MeshViolation::HullOpen { .. }
    ));
    assert_eq!(
        violation(&|case| case.solution.answer.hull_dimension = Some(1)),
        MeshViolation::HullDimension { claimed: Some(1), found: Some(2) }
    );
    let said = violation(&|case| case.solution.certificate.counts.sites = 10).to_string();
    assert_eq!(said, "the certificate counts 10 distinct points, there are 9");
}

/// How many flips of a case there are, all of which are refused without what is certified of them.
fn flips_refused_as_plain_meshes(case: &Case) -> usize {
    let width = case.solution.answer.vertices_per_simplex();
    let mut damage = Damage { case, made: vec![] };
    flips(&mut damage);
    let mut refused = 0;
    for (_, changed) in damage.made.into_iter().step_by(long_or(1, 12)) {
        let simplices = &changed.solution.answer.simplices;
        let found = check_simplices(&changed.points(), simplices, width, &Monitor::silent());
        assert!(found.is_err(), "{}: {:?}", case.name, changed.solution.answer);
        refused += 1;
    }
    refused
}

/// Three tetrahedra around an axis, run through twice over two rows of each point of the ring: every facet has its two
/// sides, all turn the right way, no dent, and each row of the smallest point sees one sheet.
#[test]
fn two_sheets_over_equal_rows_are_refused() {
    let ring = [[8.0, 0.0, 0.0], [-4.0, 7.0, 0.0], [-4.0, -8.0, 0.0]];
    let rows: Vec<[f64; 3]> =
        [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]].into_iter().chain(ring).chain(ring).collect();
    let around = |ids: &[u32]| -> Vec<u32> {
        (0..ids.len())
            .flat_map(|i| {
                let (r, next) = (rows[ids[i] as usize], rows[ids[(i + 1) % ids.len()] as usize]);
                let left = r[0] * next[1] - r[1] * next[0] > 0.0;
                let (a, b) = if left { (0, 1) } else { (1, 0) };
                // The axis points down from row 0 to row 1.
                [b, a, ids[i], ids[(i + 1) % ids.len()]]
            })
            .collect()
    };
    let once = taut_points::Points::new(rows.as_flattened(), 3).unwrap();
    let verdict = check_simplices(&once, &around(&[2, 3, 4]), 4, &Monitor::silent());
    assert!(verdict.is_ok(), "one sheet over these points is right: {verdict:?}");
    let twice = check_simplices(&once, &around(&[2, 3, 4, 5, 6, 7]), 4, &Monitor::silent());
    assert!(
        matches!(
            twice,
            Err(CheckError::Rejected(Violation::Mesh(MeshViolation::HullWinding { .. })))
        ),
        "{twice:?}"
    );
}
