//! Damaged answers and certificates: every one must be refused.

use std::collections::BTreeMap;

use common::centers::{Best, Case, Task, best, everything, log, members};
use common::numbers;
use taut_certify::{CheckError, HeldOut, Items, LowerBound, Placement};
use taut_points::PointsHash;

use crate::common;
use crate::test_length::long_or;

/// A valid case, and what is needed to know which damage is one.
struct Known {
    case: Case,
    radii: Vec<f64>,
    k: usize,
    z: usize,
}

impl Known {
    /// Returns true if no k balls of a radius less than `bound` hold these rows but z.
    fn is_bound(&self, core: &[u64], k: usize, z: usize, bound: f64) -> bool {
        let rows = core.iter().fold(0, |all, &row| all | 1 << row);
        best(&self.radii, rows, k, z).radius >= bound
    }
}

/// A core-set of which no row can be spared.
fn lean(radii: &[f64], task: &Task, (k, z): (usize, usize), bound: f64) -> Vec<u64> {
    let mut core = everything(task);
    for row in (0..task.len() as u64).rev() {
        let rest: Vec<u64> = core.iter().copied().filter(|&other| other != row).collect();
        let rows = rest.iter().fold(0, |all, &row| all | 1 << row);
        if best(radii, rows, k, z).radius >= bound {
            core = rest;
        }
    }
    core
}

fn valid() -> Vec<Known> {
    let mut all = vec![];
    let mut add = |name: &str, task: Task, k: usize, z: usize| {
        let radii = task.radii();
        let found = best(&radii, (1 << task.len()) - 1, k, z);
        // The oracle for balls and weights knows ten digits.
        let is_points = task.items == Items::Points && !task.weights;
        let exactness = if is_points { 1e-12 } else { 1e-9 };
        for (kind, slack, below) in [("tight", 1.0, exactness), ("loose", 1.3, 1e-4)] {
            let lower = found.radius * (1.0 - below);
            let core = lean(&radii, &task, (k, z), found.radius * (1.0 - below / 2.0));
            let make = |kind: &str, found: &Best, proof: LowerBound| {
                let name = format!("{name}, {kind}, {proof:?}");
                let proof = (core.clone(), proof);
                Case::of(&name, &task, found, (k, z), (slack, lower), proof)
            };
            let items = log(&radii, &core, k, z, lower).unwrap();
            let case = make(kind, &found, LowerBound::Branches { items });
            all.push(Known { case, radii: radii.clone(), k, z });
            if core.len() == k + z + 1 {
                let pair = |i: usize, j: usize| radii[1 << core[i] | 1 << core[j]] >= lower;
                if (0..core.len()).all(|i| (0..i).all(|j| pair(i, j))) {
                    let case = make(kind, &found, LowerBound::Separated);
                    all.push(Known { case, radii: radii.clone(), k, z });
                }
            }
        }
    };
    let triangle = [0.0, 0.0, 4.0, 0.0, 1.0, 3.0, 2.0, 1.0];
    add("triangle", Task::points(&triangle, 2), 1, 0);
    let square = [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 2.0, 1.0, 1.1];
    add("square", Task::points(&square, 2), 3, 0);
    add("line", Task::points(&[0.0, 1.0, 2.0, 7.0, 8.0, 20.0, 21.0, 50.0], 1), 3, 1);
    for seed in 1..5 {
        let k = 1 + seed as usize % 3;
        add("plane", Task::points(&numbers(18, seed), 2), k, 0);
        add("plane, some left out", Task::points(&numbers(18, 10 + seed), 2), k, 1);
        add("space", Task::points(&numbers(27, seed), 3), k, seed as usize % 2);
    }
    let rows =
        |values: &[f64], dim| Task { placement: Placement::Rows, ..Task::points(values, dim) };
    add("rows", rows(&numbers(18, 21), 2), 3, 0);
    add("rows, some left out", rows(&numbers(24, 22), 3), 2, 2);
    let mut values = numbers(18, 31);
    values.iter_mut().skip(1).step_by(2).for_each(|v| *v = 0.1 + 0.3 * v.abs());
    let balls = Task { items: Items::Balls, ..Task::points(&values, 2) };
    add("balls", balls, 2, 1);
    let weights = Task { weights: true, ..Task::points(&values, 2) };
    add("weights", weights, 3, 0);
    all
}

/// Takes copies of a valid case and changes them.
struct Damage<'a> {
    known: &'a Known,
    made: Vec<(String, Case)>,
}

impl Damage<'_> {
    fn to(&mut self, kind: &str, change: impl FnOnce(&mut Case)) {
        let mut case = self.known.case.clone();
        change(&mut case);
        assert_ne!(format!("{case:?}"), format!("{:?}", self.known.case), "{kind}: no change");
        self.made.push((kind.into(), case));
    }
}

fn damaged(known: &Known) -> Vec<(String, Case)> {
    let mut damage = Damage { known, made: vec![] };
    bounds(&mut damage);
    centers(&mut damage);
    lists(&mut damage);
    core_set(&mut damage);
    branches(&mut damage);
    input(&mut damage);
    damage.made
}

fn bounds(damage: &mut Damage<'_>) {
    let Known { case, k, z, .. } = damage.known;
    let (answer, gap) = (&case.solution.answer, case.solution.certificate.gap);
    let (radius, lower) = (answer.radius, answer.lower_bound);
    let raised = if gap > 0.1 { 1.0 + 1.1e-4 } else { 1.0 + 1e-8 };
    for (kind, value) in [
        ("bound raised", lower * raised),
        ("bound twice", 2.0 * lower),
        ("bound lowered", lower * (1.0 - 1e-8)),
        ("bound halved", lower / 2.0),
        ("bound none", 0.0),
        ("bound negative", -lower),
        ("bound no number", f64::NAN),
        ("bound infinite", f64::INFINITY),
    ] {
        damage.to(kind, |case| case.solution.answer.lower_bound = value);
    }
    // What the radius is raised by beyond a gap of nearly 0, has to be seen beside the slack of a gap.
    for (kind, value) in [
        ("radius raised", radius * (1.0 + 1e-7)),
        ("radius halved", radius / 2.0),
        ("radius less than the bound", lower * (1.0 - 1e-9)),
        ("radius none", 0.0),
        ("radius negative", -radius),
        ("radius no number", f64::NAN),
        ("radius infinite", f64::INFINITY),
    ] {
        damage.to(kind, |case| case.solution.answer.radius = value);
    }
    for value in [f64::NAN, f64::INFINITY, -1e-300, -1.0, gap * (1.0 - 1e-3) - 1e-14] {
        damage.to("gap", |case| case.solution.certificate.gap = value);
    }
    for other in 0..k + 3 {
        let is_wrong = other < answer.centers.len()
            || (other > *k && !damage.known.is_bound(&core(case), other, *z, lower));
        if is_wrong {
            damage.to("k changed", |case| case.solution.certificate.k = other as u64);
        }
    }
    damage.to("k huge", |case| case.solution.certificate.k = u64::MAX);
    for other in 0..z + 3 {
        let is_wrong = other < answer.outliers.len()
            || (other > *z && !damage.known.is_bound(&core(case), *k, other, lower));
        if is_wrong {
            damage.to("outliers changed", |case| {
                case.solution.certificate.outliers = other as u64;
            });
        }
    }
    damage.to("outliers huge", |case| case.solution.certificate.outliers = u64::MAX);
}

fn core(case: &Case) -> Vec<u64> {
    case.solution.certificate.core_set.clone()
}

/// Returns true if some row that counts is clearly outside.
fn is_outside(case: &Case) -> bool {
    let answer = &case.solution.answer;
    (0..case.task.len()).filter(|&i| !answer.outliers.contains(&(i as u64))).any(|i| {
        let reaches = answer.centers.iter().map(|center| case.task.reach(i, center));
        reaches.fold(f64::INFINITY, f64::min) > answer.radius * (1.0 + 1e-12)
    })
}

fn centers(damage: &mut Damage<'_>) {
    let case = &damage.known.case;
    let (count, dim) = (case.solution.answer.centers.len(), case.task.dim());
    for center in 0..count {
        for column in 0..dim {
            for step in [-1e6, -1.0, -1e-6, 1e-6, 1.0, 1e6] {
                let mut moved = case.clone();
                moved.solution.answer.centers[center][column] += step;
                if is_outside(&moved) || case.task.placement == Placement::Rows {
                    damage.to("center moved", |case| *case = moved);
                }
            }
            for value in [f64::NAN, f64::INFINITY, f64::MAX] {
                damage.to("center not finite or far", |case| {
                    case.solution.answer.centers[center][column] = value;
                    // Without the far center, some row must be outside or the bound of k is wrong.
                    case.solution.answer.radius *= 1.0 - 1e-9;
                });
            }
        }
        let mut fewer = case.clone();
        fewer.solution.answer.centers.remove(center);
        if is_outside(&fewer) {
            damage.to("center dropped", |case| *case = fewer);
        }
        damage.to("center too long", |case| {
            case.solution.answer.centers[center].push(0.0);
        });
        damage.to("center too short", |case| {
            case.solution.answer.centers[center].pop();
        });
    }
    damage.to("no centers", |case| case.solution.answer.centers.clear());
    damage.to("centers beyond k", |case| {
        let first = case.solution.answer.centers[0].clone();
        case.solution.answer.centers.resize(case.solution.certificate.k as usize + 1, first);
    });
    if case.task.placement == Placement::Rows {
        let n = case.task.len() as u64;
        for center in 0..count {
            let own = case.solution.answer.rows[center];
            for row in (0..n + 2).chain([u64::MAX]).filter(|&row| row != own) {
                damage.to("row of a center", |case| case.solution.answer.rows[center] = row);
            }
        }
        damage.to("rows missing", |case| case.solution.answer.rows.clear());
        damage.to("centers free", |case| case.solution.certificate.placement = Placement::Free);
    } else {
        damage.to("rows of free centers", |case| case.solution.answer.rows = vec![0; count]);
        damage.to("centers at rows", |case| case.solution.certificate.placement = Placement::Rows);
    }
}

fn lists(damage: &mut Damage<'_>) {
    let Known { case, .. } = damage.known;
    let n = case.task.len();
    let outliers = case.solution.answer.outliers.clone();
    for (position, &row) in outliers.iter().enumerate() {
        for other in (0..n as u64 + 1).chain([u64::MAX]).filter(|&other| other != row) {
            let mut changed = case.clone();
            changed.solution.answer.outliers[position] = other;
            if is_outside(&changed) || other >= n as u64 {
                damage.to("row left out changed", |case| *case = changed);
            }
        }
        let mut fewer = case.clone();
        fewer.solution.answer.outliers.remove(position);
        if is_outside(&fewer) {
            damage.to("row left out no more", |case| *case = fewer);
        }
        damage.to("row left out twice", |case| case.solution.answer.outliers.insert(position, row));
    }
    damage.to("too many left out", |case| {
        let count = case.solution.certificate.outliers + 1;
        case.solution.answer.outliers = (0..count).collect();
    });
    if outliers.len() > 1 {
        damage.to("rows left out in no order", |case| case.solution.answer.outliers.reverse());
    }
    let count = case.solution.answer.centers.len();
    for row in 0..n {
        let named = case.solution.answer.assignment[row];
        let reach = |center: usize| case.task.reach(row, &case.solution.answer.centers[center]);
        for other in 0..count {
            if reach(other) > reach(named as usize) * (1.0 + 1e-9) {
                damage.to("assigned to another", |case| {
                    case.solution.answer.assignment[row] = other as u32;
                });
            }
        }
        for other in [count as u32, u32::MAX] {
            damage.to("assigned to none", |case| case.solution.answer.assignment[row] = other);
        }
    }
    damage.to("assignment cut", |case| {
        case.solution.answer.assignment.pop();
    });
    damage.to("assignment long", |case| case.solution.answer.assignment.push(0));
}

fn core_set(damage: &mut Damage<'_>) {
    let Known { case, k, z, .. } = damage.known;
    let (n, rows) = (case.task.len() as u64, core(case));
    let lower = case.solution.answer.lower_bound;
    for position in 0..rows.len() {
        damage.to("core-set entry dropped", |case| {
            case.solution.certificate.core_set.remove(position);
        });
        for other in (0..n + 1).chain([u64::MAX]).filter(|&other| other != rows[position]) {
            let mut changed = rows.clone();
            changed[position] = other;
            let is_twice = rows.contains(&other);
            let is_wrong =
                other >= n || is_twice || !damage.known.is_bound(&changed, *k, *z, lower);
            if is_wrong {
                damage.to("core-set entry changed", |case| {
                    case.solution.certificate.core_set = changed;
                });
            }
        }
    }
    damage.to("core-set empty", |case| case.solution.certificate.core_set.clear());
}

fn branches(damage: &mut Damage<'_>) {
    let Known { case, .. } = damage.known;
    let LowerBound::Branches { items } = &case.solution.certificate.proof else { return };
    let mut with = |kind: &str, items: Vec<u32>| {
        damage.to(kind, |case| {
            case.solution.certificate.proof = LowerBound::Branches { items };
        });
    };
    for length in 0..items.len() {
        with("log cut", items[..length].to_vec());
    }
    let count = case.solution.certificate.core_set.len() as u32;
    for more in 0..=count {
        with("log too long", items.iter().copied().chain([more]).collect());
    }
    for entry in 0..items.len() {
        for other in [count, u32::MAX] {
            let mut changed = items.clone();
            changed[entry] = other;
            with("branch out of range", changed);
        }
        if entry > 0 {
            let mut changed = items.clone();
            changed[entry] = items[0];
            with("branch on what the root gave", changed);
        }
    }
}

fn input(damage: &mut Damage<'_>) {
    let Case { task, .. } = &damage.known.case;
    let (count, columns) = (task.values.len(), task.columns);
    for bit in 0..64 {
        damage.to("bit of the hash", |case| case.solution.certificate.points_hash.0 ^= 1 << bit);
    }
    damage.to("hash of nothing", |case| case.solution.certificate.points_hash = PointsHash(0));
    for i in 0..count {
        damage.to("input one ulp up", |case| case.task.values[i] = case.task.values[i].next_up());
        damage.to("input not a number", |case| case.task.values[i] = f64::NAN);
    }
    damage.to("row removed", |case| drop(case.task.values.drain(..columns)));
    damage.to("no rows", |case| case.task.values.clear());
    damage.to("ellipsoids", |case| case.solution.certificate.items = Items::Ellipsoids);
    damage.to("other items", |case| {
        let items = &mut case.solution.certificate.items;
        *items = if *items == Items::Points { Items::Balls } else { Items::Points };
    });
    damage.to("weights", |case| case.solution.certificate.weights ^= true);
}

#[test]
fn every_damaged_certificate_is_refused() {
    let mut kinds: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    let mut count = 0;
    for known in valid() {
        let Known { case, .. } = &known;
        let verdict = case.check().unwrap_or_else(|e| panic!("{}: {e}\n{case:?}", case.name));
        assert!(verdict.lower <= verdict.upper);
        for (kind, damaged) in damaged(&known) {
            count += 1;
            let violation = match damaged.check() {
                Err(CheckError::Rejected(violation)) => format!("{violation:?}"),
                other => panic!("{}, {kind}: {other:?}\n{damaged:?}", case.name),
            };
            let name = violation.split(['{']).next().unwrap_or_default().trim().to_owned();
            *kinds.entry(kind).or_default().entry(name).or_default() += 1;
        }
    }
    println!("{count} damaged certificates of {} kinds, all refused", kinds.len());
    for (kind, found) in &kinds {
        println!("{kind:>28}: {found:?}");
    }
    assert!(count >= 1000);
}

/// Logs that say of nodes that the items left out refute them.
#[test]
fn logs_of_random_numbers_that_leave_out_prove_nothing_untrue() {
    let task = Task::points(&numbers(18, 78), 2);
    let radii = task.radii();
    let mut state = 9u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        state >> 40
    };
    for round in 0..long_or(20_000, 4000) {
        let (k, z) = (1 + round % 2, 1 + round % 3);
        let found = best(&radii, (1 << 9) - 1, k, z);
        let items: Vec<u32> = (0..next() % 30).map(|_| (next() % 9) as u32).collect();
        let mut at = 0;
        let ends = 0..next() % 30;
        let held_out = ends.map(|_| {
            at += next() % 2;
            HeldOut { at, cluster: (next() % (1 + k as u64)) as u32 }
        });
        let proof = LowerBound::Avoiding { items, held_out: held_out.collect() };
        let lower = found.radius * (1.0 + 1e-5);
        let case =
            Case::of("random log", &task, &found, (k, z), (2.0, lower), (everything(&task), proof));
        assert!(case.check().is_err(), "{case:?}");
    }
}

/// Any log whatever ends, without panic, and proves nothing that is not true.
#[test]
fn logs_of_random_numbers_prove_nothing_untrue() {
    let task = Task::points(&numbers(18, 77), 2);
    let radii = task.radii();
    let mut state = 5u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        state >> 40
    };
    for round in 0..2000 {
        let (k, z) = (1 + round % 3, round % 2);
        let found = best(&radii, (1 << 9) - 1, k, z);
        let factor = if round % 5 == 0 { 0.6 } else { 1.0 + 1e-6 };
        let items: Vec<u32> = (0..next() % 40).map(|_| (next() % 10) as u32).collect();
        let proof = (everything(&task), LowerBound::Branches { items });
        let lower = found.radius * factor;
        let case = Case::of("random log", &task, &found, (k, z), (2.0, lower), proof);
        assert!(case.check().is_err() || factor < 1.0, "{case:?}");
    }
    assert_eq!(members(0b1010).collect::<Vec<_>>(), [1, 3]);
}
