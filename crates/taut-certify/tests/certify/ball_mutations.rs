//! Damaged certificates: every one must be refused.

use std::collections::BTreeMap;

use common::{Case, brute_force, certify, normalized, numbers};
use taut_certify::{CheckError, Items, Violation};
use taut_points::PointsHash;

use crate::common;

/// Valid solutions of many kinds, all with the gap that is true.
fn valid() -> Vec<Case> {
    let mut all = vec![];
    let mut smallest = |name, values: &[f64], dim, tail| {
        let (support, lambda) = brute_force(values, dim).unwrap();
        all.push(certify(name, values, dim, Items::Points, &support, &lambda, tail));
    };
    smallest("two points", &[1.0, 2.0, 4.0, 6.0], 2, false);
    smallest("triangle", &[0.0, 0.0, 1.0, 0.1, 0.3, 0.9, 0.4, 0.4], 2, false);
    smallest("triangle with a tail", &[0.0, 0.0, 1.0, 0.1, 0.3, 0.9, 0.4, 0.4], 2, true);
    smallest("eight in space", &numbers(24, 1), 3, false);
    smallest("eight more in space", &numbers(24, 2), 3, true);
    smallest("small", &numbers(24, 3).iter().map(|v| v * 1e-9).collect::<Vec<_>>(), 3, false);
    let far: Vec<f64> = numbers(16, 4).iter().map(|v| v + 1e5).collect();
    smallest("far away", &far, 2, true);
    let simplex: Vec<f64> = (0..36).map(|i| if i / 6 == i % 6 { 1.0 } else { 0.0 }).collect();
    let lambda = normalized(&[1.0; 6]);
    all.push(certify("simplex", &simplex, 6, Items::Points, &[0, 1, 2, 3, 4, 5], &lambda, false));
    let lambda = normalized(&[5.0, 1.0, 2.0, 4.0]);
    all.push(certify("weak", &numbers(90, 6), 3, Items::Points, &[1, 4, 5, 29], &lambda, false));
    let mut balls = numbers(80, 9);
    balls.iter_mut().skip(3).step_by(4).for_each(|r| *r = 0.2 * r.abs());
    all.push(certify("weak for balls", &balls, 4, Items::Balls, &[0, 3, 9, 11], &lambda, false));
    let two = [0.0, 0.0, 1.0, 3.0, 4.0, 2.0, 1.0, 2.0, 0.5];
    all.push(certify("two balls", &two, 3, Items::Balls, &[0, 1], &[0.4, 0.6], true));
    all
}

/// Takes copies of a valid case and changes them.
struct Damage<'a> {
    case: &'a Case,
    made: Vec<(String, Case)>,
}

impl Damage<'_> {
    fn to(&mut self, kind: &str, change: impl FnOnce(&mut Case)) {
        let mut case = self.case.clone();
        change(&mut case);
        assert_ne!(format!("{case:?}"), format!("{:?}", self.case), "{kind}: nothing was changed");
        self.made.push((kind.into(), case));
    }
}

fn damaged(case: &Case) -> Vec<(String, Case)> {
    let mut damage = Damage { case, made: vec![] };
    numbers_of_the_answer(&mut damage);
    multipliers(&mut damage);
    support(&mut damage);
    lengths(&mut damage);
    input(&mut damage);
    damage.made
}

fn numbers_of_the_answer(damage: &mut Damage<'_>) {
    let Case { solution, .. } = damage.case;
    let (radius, gap) = (solution.answer.radius, solution.certificate.gap);
    for (kind, value) in [
        ("radius 1e-9 larger", radius * (1.0 + 1e-9)),
        ("radius 1e-9 smaller", radius * (1.0 - 1e-9)),
        ("radius one ulp smaller", radius.next_down()),
        ("radius twice as large", radius * 2.0),
        ("radius 0", 0.0),
        ("radius negative", -radius),
        ("radius not a number", f64::NAN),
        ("radius infinite", f64::INFINITY),
    ] {
        damage.to(kind, |case| case.solution.answer.radius = value);
    }
    for j in 0..solution.answer.center.len() {
        for sign in [-1.0, 1.0] {
            for step in [1e-9, 1e-7, 1e-4, 1.0] {
                let moved = solution.answer.center[j] + sign * step * radius;
                if solution.answer.center_tail.is_empty() {
                    damage.to("center moved", |case| case.solution.answer.center[j] = moved);
                } else {
                    damage.to("tail moved", |case| {
                        case.solution.answer.center_tail[j] += sign * step * radius;
                    });
                }
            }
        }
        if !solution.answer.center_tail.is_empty() {
            // Beside a radius that is not small, an ulp is what writing the tail down may cost.
            let next = solution.answer.center[j].next_up();
            if next - solution.answer.center[j] > 1e-12 * radius {
                damage.to("center moved by an ulp", |case| {
                    case.solution.answer.center[j] = next;
                });
            }
            damage.to("tail not finite", |case| case.solution.answer.center_tail[j] = f64::NAN);
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            damage.to("center not finite", |case| case.solution.answer.center[j] = value);
        }
    }
    for value in [f64::NAN, f64::INFINITY, -1e-300, -1.0] {
        damage.to("gap no gap", |case| case.solution.certificate.gap = value);
    }
    if gap > 1e-9 {
        for factor in [0.0, 0.5, 1.0 - 1e-8] {
            damage.to("gap lowered", |case| case.solution.certificate.gap *= factor);
        }
    }
    for bit in 0..64 {
        damage.to("bit of the hash", |case| case.solution.certificate.points_hash.0 ^= 1 << bit);
    }
    damage.to("hash of nothing", |case| case.solution.certificate.points_hash = PointsHash(0));
}

fn multipliers(damage: &mut Damage<'_>) {
    let lambda = damage.case.solution.certificate.multipliers.clone();
    for k in 0..lambda.len() {
        for value in [
            lambda[k] * (1.0 + 1e-9),
            lambda[k] * (1.0 - 1e-9),
            lambda[k] * 1.1,
            -lambda[k],
            0.0,
            -0.0,
            1.0 + lambda[k],
            f64::NAN,
            f64::INFINITY,
            f64::from_bits(1),
        ] {
            damage.to("multiplier changed", |case| {
                case.solution.certificate.multipliers[k] = value;
            });
        }
        damage.to("multiplier dropped", |case| {
            case.solution.certificate.multipliers.remove(k);
        });
        damage.to("support point dropped", |case| {
            case.solution.certificate.multipliers.remove(k);
            case.solution.certificate.support.remove(k);
        });
        for l in 0..k {
            if (lambda[k] - lambda[l]).abs() > 1e-9 {
                damage.to("multipliers swapped", |case| {
                    case.solution.certificate.multipliers.swap(k, l);
                });
            }
            // The sum stays, the combination does not.
            damage.to("weight shifted", |case| {
                let shifted = 1e-8 * lambda[k].min(lambda[l]);
                case.solution.certificate.multipliers[k] += shifted;
                case.solution.certificate.multipliers[l] -= shifted;
            });
        }
    }
}

fn support(damage: &mut Damage<'_>) {
    let n = damage.case.values.len() / damage.case.columns;
    let support = damage.case.solution.certificate.support.clone();
    for k in 0..support.len() {
        for other in (0..n as u64 + 2).chain([u64::MAX]).filter(|&other| other != support[k]) {
            damage.to("index changed", |case| case.solution.certificate.support[k] = other);
        }
        for l in 0..k {
            damage.to("indices swapped", |case| case.solution.certificate.support.swap(k, l));
            damage.to("index duplicated", |case| {
                case.solution.certificate.support[k] = support[l];
            });
        }
        damage.to("support entry twice", |case| {
            case.solution.certificate.support.insert(k, support[k]);
            case.solution.certificate.multipliers.insert(k, 0.0);
        });
        damage.to("support entry halved", |case| {
            let half = case.solution.certificate.multipliers[k] / 2.0;
            case.solution.certificate.multipliers[k] = half;
            case.solution.certificate.support.insert(k, support[k]);
            case.solution.certificate.multipliers.insert(k, half);
        });
    }
}

fn lengths(damage: &mut Damage<'_>) {
    let columns = damage.case.columns;
    damage.to("empty support", |case| {
        case.solution.certificate.support.clear();
        case.solution.certificate.multipliers.clear();
    });
    damage.to("center too long", |case| case.solution.answer.center.push(0.0));
    damage.to("center too short", |case| {
        case.solution.answer.center.pop();
    });
    damage.to("tail of another length", |case| {
        case.solution.answer.center_tail = vec![0.0; case.solution.answer.center.len() + 1];
    });
    damage.to("points for balls", |case| {
        let items = &mut case.solution.certificate.items;
        *items = if *items == Items::Points { Items::Balls } else { Items::Points };
    });
    for other in [1, columns - 1, columns + 1, columns * 2] {
        if other > 0 && other != columns {
            damage.to("dimension changed", |case| {
                case.columns = other;
                case.values.truncate(case.values.len() / other * other);
            });
        }
    }
}

fn input(damage: &mut Damage<'_>) {
    let (count, columns) = (damage.case.values.len(), damage.case.columns);
    for i in 0..count {
        damage.to("input one ulp up", |case| case.values[i] = case.values[i].next_up());
        damage.to("input one ulp down", |case| case.values[i] = case.values[i].next_down());
        damage.to("input not a number", |case| case.values[i] = f64::NAN);
        damage.to("input infinite", |case| case.values[i] = f64::NEG_INFINITY);
    }
    for row in 0..count / columns {
        damage.to("row removed", |case| {
            drop(case.values.drain(row * columns..(row + 1) * columns));
        });
        damage.to("row twice", |case| {
            let copy = case.values[row * columns..(row + 1) * columns].to_vec();
            case.values.extend(copy);
        });
        for other in 0..row {
            damage.to("rows swapped", |case| {
                (0..columns).for_each(|j| case.values.swap(row * columns + j, other * columns + j));
            });
        }
    }
    damage.to("no rows", |case| case.values.clear());
}

#[test]
fn every_damaged_certificate_is_refused() {
    let mut kinds: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    let mut count = 0;
    for case in valid() {
        let verdict = case.check().unwrap_or_else(|error| panic!("{}: {error}", case.name));
        assert!(verdict.lower <= verdict.upper);
        for (kind, damaged) in damaged(&case) {
            count += 1;
            let violation = match damaged.check() {
                Err(CheckError::Rejected(violation)) => format!("{violation:?}"),
                other => panic!("{}, {kind}: {other:?}\n{damaged:?}", case.name),
            };
            let name = violation.split([' ', '{']).next().unwrap_or_default().to_owned();
            *kinds.entry(kind).or_default().entry(name).or_default() += 1;
        }
    }
    println!("{count} damaged certificates of {} kinds, all refused", kinds.len());
    for (kind, found) in &kinds {
        println!("{kind:>24}: {found:?}");
    }
    assert!(count >= 1000);
}

/// The hash is no shield for the rest: with the hash of the damaged input, a moved support point or a point outside is
/// found by what it does.
#[test]
fn damaged_input_with_its_own_hash_is_refused() {
    let mut count = 0;
    for case in valid() {
        let dim = case.solution.answer.center.len();
        for &row in &case.solution.certificate.support {
            for column in 0..dim {
                for step in [-1e-9, 1e-9, -1e-3, 1e-3] {
                    let mut damaged = case.clone();
                    let at = row as usize * case.columns + column;
                    damaged.values[at] += 10.0 * step * case.solution.answer.radius;
                    let points = taut_points::Points::new(&damaged.values, case.columns).unwrap();
                    damaged.solution.certificate.points_hash =
                        taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
                    let violation = damaged.violation();
                    let named =
                        matches!(violation, Violation::Outside { .. } | Violation::Center { .. });
                    assert!(named, "{}: {violation:?}", case.name);
                    count += 1;
                }
            }
        }
    }
    assert!(count > 200, "{count}");
}
