//! More than a thousand damaged answers and certificates of ellipsoids, each of which must be refused.

use std::collections::BTreeMap;

use common::ellipsoids::{
    Case, certify_but, cube, dot, embedded, hash, log_unit_ball, orthonormal, simplex, solved,
    transposed_product, uniform,
};
use common::numbers;
use taut_certify::{CheckError, Ellipsoid, EllipsoidCertificate, Hull, Items, Solution, Trace};

use crate::common;

/// Sound cases of every kind.
fn sound() -> Vec<Case> {
    let mut cases = vec![uniform("cube", &cube(3), 3), uniform("simplex", &simplex(4), 4)];
    for (dim, n) in [(1, 6), (2, 12), (3, 15), (5, 24)] {
        cases.push(solved(&format!("random {dim}"), &numbers(n * dim, dim as u64 + 40), dim));
    }
    let far: Vec<f64> = numbers(30, 9).iter().map(|v| v + 3e7).collect();
    let (support, u) = common::ellipsoids::solve(&numbers(30, 9), 3);
    cases.push(certify_but("far", &far, 3, &support, &u, &[]));
    let narrow: Vec<f64> =
        numbers(36, 10).iter().enumerate().map(|(i, v)| v * [1e-5, 1.0, 1e5][i % 3]).collect();
    cases.push(solved("narrow", &narrow, 3));
    cases.push(embedded(&solved("flat", &numbers(24, 11), 2), &orthonormal(&numbers(8, 12), 2, 4)));
    cases.push(shapes(Items::Ellipsoids));
    cases.push(shapes(Items::Balls));
    cases
}

/// Six bodies of radius ¼ around ±eⱼ, and one within; the ball of radius 1.25 about the origin.
fn shapes(items: Items) -> Case {
    let dim = 3;
    let unit = |i: usize| -> Vec<f64> {
        (0..dim).map(|j| if i / 2 == j { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 }).collect()
    };
    let shape = match items {
        Items::Balls => vec![0.25],
        _ => vec![0.0625, 0.0, 0.0625, 0.0, 0.0, 0.0625],
    };
    let directions: Vec<Vec<f64>> = (0..2 * dim).map(unit).collect();
    let values: Vec<f64> = directions
        .iter()
        .cloned()
        .chain([vec![0.1; 3]])
        .flat_map(|c| [c, shape.clone()].concat())
        .collect();
    let factor: Vec<Vec<f64>> =
        (0..dim).map(|j| (0..dim).map(|k| if j == k { 0.8 } else { 0.0 }).collect()).collect();
    let columns = items.columns(dim);
    let solution = Solution {
        answer: Ellipsoid {
            center: vec![0.0; dim],
            center_tail: vec![],
            matrix: transposed_product(&factor, dim),
            factor,
            hull: None,
            log_volume: log_unit_ball(dim) + 3.0 * 1.25f64.ln(),
        },
        certificate: EllipsoidCertificate {
            items,
            support: (0..6).collect(),
            multipliers: vec![1.0 / 6.0; 6],
            directions,
            left_out: vec![],
            gap: 0.0,
            points_hash: hash(&values, columns),
        },
        trace: Trace::default(),
    };
    Case { name: format!("{items:?}"), values, columns, solution }
}

/// Collects damaged copies.
struct Damage {
    sound: Case,
    damaged: Vec<Case>,
}

impl Damage {
    fn add(&mut self, what: String, change: impl FnOnce(&mut Case)) {
        let mut case = self.sound.clone();
        case.name = format!("{}: {what}", case.name);
        change(&mut case);
        // Two numbers that were equal may have been exchanged; a change that is none proves nothing.
        let same = case.solution == self.sound.solution && case.values == self.sound.values;
        if !same {
            self.damaged.push(case);
        }
    }

    fn answer(&mut self, what: String, change: impl FnOnce(&mut Ellipsoid)) {
        self.add(what, |case| change(&mut case.solution.answer));
    }

    fn certificate(&mut self, what: String, change: impl FnOnce(&mut EllipsoidCertificate)) {
        self.add(what, |case| change(&mut case.solution.certificate));
    }
}

/// Numbers that no field may hold.
const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn damage_to_numbers(all: &mut Damage) {
    let answer = all.sound.solution.answer.clone();
    let (dim, rank) = (answer.dim(), answer.rank());
    for j in 0..dim {
        // As far as the ellipsoid reaches along the axis, by what the points say.
        let column = all.sound.values.iter().skip(j).step_by(all.sound.columns);
        let width = column.map(|v| (v - answer.center[j]).abs()).fold(0.0, f64::max);
        for part in [1e-4, -1e-4, 0.1, -0.1, 1.0, 1e9] {
            all.answer(format!("center {j} moved by {part}"), |a| a.center[j] += part * width);
        }
        for value in NO_NUMBERS {
            all.answer(format!("center {j} is {value}"), |a| a.center[j] = value);
        }
        all.answer(format!("center {j} negated"), |a| a.center[j] = -2.0 * a.center[j] - width);
        all.answer(format!("tail {j}"), |a| {
            a.center_tail = vec![0.0; dim];
            a.center_tail[j] = width;
        });
        for k in 0..dim {
            let size = (answer.matrix[j][j] * answer.matrix[k][k]).sqrt();
            for part in [1e-9, -1e-9, 1e-3, -1e-3, 1.0] {
                all.answer(format!("matrix {j} {k} off by {part}"), |a| {
                    a.matrix[j][k] += part * size;
                    a.matrix[k][j] = a.matrix[j][k];
                });
            }
            if j != k {
                all.answer(format!("matrix {j} {k} not symmetric"), |a| {
                    a.matrix[j][k] = (a.matrix[j][k] + 1e-15 * size).next_up();
                });
            }
            for value in NO_NUMBERS {
                all.answer(format!("matrix {j} {k} is {value}"), |a| a.matrix[j][k] = value);
            }
        }
    }
    for a in 0..rank {
        let size = dot(&answer.factor[a], &answer.factor[a]).sqrt();
        for k in 0..dim {
            for part in [1e-8, -1e-8, 1e-3, -1e-3, 1.0] {
                all.answer(format!("factor {a} {k} off by {part}"), |e| {
                    e.factor[a][k] += part * (size + e.factor[a][k].abs());
                });
            }
            for value in NO_NUMBERS {
                all.answer(format!("factor {a} {k} is {value}"), |e| e.factor[a][k] = value);
            }
        }
        all.answer(format!("factor {a} zero"), |e| e.factor[a].fill(0.0));
        // A factor that is wrong, with matrix and log-volume to match.
        for part in [1e-4, -1e-4, 0.3, -0.3] {
            all.answer(format!("axis {a} stretched by {part}"), |e| {
                e.factor[a].iter_mut().for_each(|f| *f *= 1.0 + part);
                e.matrix = transposed_product(&e.factor, dim);
                e.log_volume -= part.ln_1p();
            });
        }
    }
    for part in [1e-6, -1e-6, 1e-2, -1e-2] {
        all.answer(format!("scaled by {part}"), |e| {
            e.factor.iter_mut().flatten().for_each(|f| *f *= 1.0 + part);
            e.matrix = transposed_product(&e.factor, dim);
            e.log_volume -= rank as f64 * f64::ln_1p(part);
        });
    }
    for off in [1e-9, -1e-9, 1e-3, -1e-3, 1.0, f64::NAN, f64::INFINITY] {
        all.answer(format!("log-volume off by {off}"), |e| {
            e.log_volume += off * (1.0 + e.log_volume.abs())
        });
    }
}

fn damage_to_shape(all: &mut Damage) {
    let (dim, rank) = (all.sound.solution.answer.dim(), all.sound.solution.answer.rank());
    all.answer("center short".into(), |a| {
        a.center.pop();
    });
    all.answer("center long".into(), |a| a.center.push(0.0));
    all.answer("tail short".into(), |a| a.center_tail = vec![0.0; dim + 1]);
    all.answer("matrix short".into(), |a| {
        a.matrix.pop();
    });
    all.answer("matrix long".into(), |a| a.matrix.push(vec![0.0; dim]));
    all.answer("factor short".into(), |a| {
        a.factor.pop();
    });
    all.answer("factor long".into(), |a| a.factor.push(vec![0.0; dim]));
    for j in 0..dim {
        all.answer(format!("matrix row {j} short"), |a| {
            a.matrix[j].pop();
        });
        all.answer(format!("matrix row {j} long"), |a| a.matrix[j].push(0.0));
    }
    for a in 0..rank {
        all.answer(format!("factor row {a} short"), |e| {
            e.factor[a].pop();
        });
        all.answer(format!("factor row {a} long"), |e| e.factor[a].push(0.0));
    }
    // The set is said to be flat although it is not, or not as flat as it is.
    let basis = orthonormal(&numbers(dim * dim, 3), dim, dim);
    for smaller in 0..rank {
        all.answer(format!("rank {smaller}"), |e| {
            e.factor.truncate(smaller);
            e.matrix = transposed_product(&e.factor, dim);
            let rows = if smaller == 0 { vec![] } else { basis[..smaller].to_vec() };
            e.hull = Some(Hull { basis: rows, distance: 1e30 });
            e.log_volume = log_unit_ball(smaller);
        });
    }
    all.answer("hull of the wrong rank".into(), |e| {
        e.hull = Some(Hull { basis: basis.clone(), distance: 0.0 });
    });
    let Some(hull) = all.sound.solution.answer.hull.clone() else { return };
    all.answer("no hull".into(), |e| e.hull = None);
    for distance in [-1.0, 1e-3, f64::NAN, f64::INFINITY] {
        all.answer(format!("distance {distance}"), |e| {
            e.hull = Some(Hull { distance, ..hull.clone() });
        });
    }
    for i in 0..rank {
        for j in 0..dim {
            for part in [1e-9, -1e-9, 0.1, f64::NAN] {
                all.answer(format!("basis {i} {j} off by {part}"), |e| {
                    e.hull.as_mut().unwrap().basis[i][j] += part;
                });
            }
        }
        all.answer(format!("basis {i} short"), |e| {
            e.hull.as_mut().unwrap().basis[i].pop();
        });
    }
    all.answer("basis turned".into(), |e| {
        e.hull.as_mut().unwrap().basis = orthonormal(&numbers(dim * dim, 4), rank, dim);
    });
    all.add("a point moved off the hull".into(), |case| {
        case.values[1] += 1e-6;
        case.solution.certificate.points_hash = hash(&case.values, case.columns);
    });
}

fn damage_to_certificate(all: &mut Damage) {
    let certificate = all.sound.solution.certificate.clone();
    let n = (all.sound.values.len() / all.sound.columns) as u64;
    let k = certificate.support.len();
    for i in 0..k {
        all.certificate(format!("support {i} dropped"), |c| {
            c.support.remove(i);
        });
        all.certificate(format!("support {i} beyond"), |c| c.support[i] = n + i as u64);
        all.certificate(format!("support {i} doubled"), |c| {
            c.support.insert(i, c.support[i]);
            c.multipliers[i] /= 2.0;
            c.multipliers.insert(i, c.multipliers[i]);
        });
        for other in (0..n).filter(|row| !certificate.support.contains(row)) {
            all.certificate(format!("support {i} replaced by {other}"), |c| {
                let direction = c.directions.get(i).cloned();
                c.support.remove(i);
                let at = c.support.partition_point(|&row| row < other);
                c.support.insert(at, other);
                let u = c.multipliers.remove(i);
                c.multipliers.insert(at, u);
                if let Some(direction) = direction {
                    c.directions.remove(i);
                    c.directions.insert(at, direction);
                }
            });
        }
        all.certificate(format!("multiplier {i} dropped"), |c| {
            c.multipliers.remove(i);
        });
        for factor in [0.0, -1.0, 0.99, 1.01, 2.0, f64::NAN, f64::INFINITY] {
            all.certificate(format!("multiplier {i} times {factor}"), |c| {
                c.multipliers[i] *= factor
            });
        }
        for j in (0..k).filter(|&j| j != i) {
            all.certificate(format!("weight from {i} to {j}"), |c| {
                let part = c.multipliers[i] / 4.0;
                c.multipliers[i] -= part;
                c.multipliers[j] += part;
            });
        }
        if k > 2 {
            all.certificate(format!("point {i} out of the proof"), |c| {
                c.support.remove(i);
                let rest = 1.0 - c.multipliers.remove(i);
                c.multipliers.iter_mut().for_each(|u| *u /= rest);
                if !c.directions.is_empty() {
                    c.directions.remove(i);
                }
            });
        }
        if let Some(direction) = certificate.directions.get(i).cloned() {
            all.certificate(format!("direction {i} dropped"), |c| {
                c.directions.remove(i);
            });
            all.certificate(format!("direction {i} short"), |c| {
                c.directions[i].pop();
            });
            all.certificate(format!("direction {i} zero"), |c| c.directions[i].fill(0.0));
            all.certificate(format!("direction {i} back"), |c| {
                c.directions[i] = direction.iter().map(|v| -v).collect();
            });
            for j in 0..direction.len() {
                for value in [0.5, -0.5, f64::NAN, f64::INFINITY] {
                    all.certificate(format!("direction {i} turned to {j} by {value}"), |c| {
                        c.directions[i][j] = if direction[j] == 0.0 { value } else { value / 1e3 };
                        c.directions[i][(j + 1) % direction.len()] += 0.25;
                    });
                }
            }
        }
    }
    all.certificate("support empty".into(), |c| c.support.clear());
    all.certificate("no multipliers".into(), |c| c.multipliers.clear());
    all.certificate("support backwards".into(), |c| c.support.reverse());
    all.certificate("a direction too many".into(), |c| c.directions.push(vec![1.0; 3]));
    for gap in [-1e-300, -1.0, f64::NAN, f64::INFINITY] {
        all.certificate(format!("gap {gap}"), |c| c.gap = gap);
    }
    if all.sound.verdict().gap > 1e-12 {
        for factor in [0.0, 0.5] {
            let gap = all.sound.verdict().gap * factor;
            all.certificate(format!("gap {gap:e}"), |c| c.gap = gap);
        }
    }
    for bit in [0, 1, 31, 63] {
        all.certificate(format!("bit {bit} of the hash"), |c| c.points_hash.0 ^= 1 << bit);
    }
    for items in [Items::Points, Items::Balls, Items::Ellipsoids] {
        all.certificate(format!("items {items:?}"), |c| c.items = items);
    }
}

fn damage_to_lists_and_rows(all: &mut Damage) {
    let certificate = all.sound.solution.certificate.clone();
    let n = (all.sound.values.len() / all.sound.columns) as u64;
    let columns = all.sound.columns;
    for row in 0..n {
        let inside = !certificate.support.contains(&row);
        let deep = inside
            && all.sound.solution.answer.norm(&all.sound.values[row as usize * columns..]) < 0.999;
        if !inside || deep {
            all.certificate(format!("row {row} left out"), |c| c.left_out.push(row));
        }
        all.add(format!("row {row} changed"), |case| {
            let value = &mut case.values[row as usize * columns];
            *value = value.next_up();
        });
        all.add(format!("row {row} moved out"), |case| {
            case.values[row as usize * columns] += 1e10;
            case.solution.certificate.points_hash = hash(&case.values, columns);
        });
        for value in NO_NUMBERS {
            all.add(format!("row {row} is {value}"), |case| {
                case.values[(row as usize + 1) * columns - 1] = value;
                case.solution.certificate.points_hash = hash(&case.values, columns);
            });
        }
    }
    all.certificate("a row left out that is not there".into(), |c| c.left_out.push(n));
    all.add("a row less".into(), |case| case.values.truncate((n as usize - 1) * columns));
    all.add("a row more".into(), |case| {
        let first = case.values[..columns].to_vec();
        case.values.extend(first);
    });
}

#[test]
fn every_damaged_copy_is_refused() {
    let (mut count, mut accepted, mut kinds) = (0, Vec::new(), BTreeMap::new());
    for sound in sound() {
        let verdict = sound.verdict();
        assert!(verdict.gap < 1e-7, "{}: {verdict:?}", sound.name);
        let mut all = Damage { sound, damaged: vec![] };
        damage_to_numbers(&mut all);
        damage_to_shape(&mut all);
        damage_to_certificate(&mut all);
        damage_to_lists_and_rows(&mut all);
        count += all.damaged.len();
        for case in &all.damaged {
            match case.check() {
                Err(CheckError::Rejected(violation)) => {
                    let kind = format!("{violation:?}");
                    let kind = kind.split([' ', '(']).next().unwrap().to_owned();
                    *kinds.entry(kind).or_insert(0u32) += 1;
                }
                other => accepted.push((case.name.clone(), format!("{other:?}"))),
            }
        }
    }
    assert!(accepted.is_empty(), "{} of {count} accepted: {accepted:#?}", accepted.len());
    assert!(count >= 1000, "only {count} cases");
    // No test stands in for another: each finds damage of its own.
    for kind in [
        "Basis",
        "Dimension",
        "EmptySupport",
        "Hash",
        "LeftOut",
        "Length",
        "LogGap",
        "LogVolume",
        "Matrix",
        "MultiplierSum",
        "NeedlessHull",
        "NonFinite",
        "NotFlat",
        "Number",
        "OffHull",
        "OutsideEllipsoid",
        "Span",
        "Support",
    ] {
        assert!(kinds.contains_key(kind), "{kind} was never found: {kinds:?}");
    }
    println!("{count} refused: {kinds:?}");
}
