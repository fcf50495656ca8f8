//! Against all partitions of few items: each kind of proof confirms the optimum, and nothing above it.

use common::centers::{Best, Case, Task, best, everything, log, members};
use common::numbers;
use proptest::prelude::*;
use taut_certify::{CentersViolation, Items, LowerBound, Placement, Violation};

use crate::common;
use crate::test_length::long_or;

/// Checks what is claimed of one task, for all k and z up to 2.
fn all_proofs(name: &str, task: &Task, exactness: f64) {
    let radii = task.radii();
    let all = (1u32 << task.len()) - 1;
    for k in 1..=task.len().min(4) {
        for z in 0..=2usize.min(task.len()) {
            let found = best(&radii, all, k, z);
            let name = format!("{name}, k = {k}, z = {z}");
            if found.radius <= 0.0 {
                let proof = (vec![], LowerBound::Separated);
                let case = Case::of(&name, task, &found, (k, z), (1.0, 0.0), proof);
                let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}\n{case:?}"));
                assert_eq!((verdict.lower, verdict.upper, verdict.gap), (0.0, 0.0, 0.0));
                continue;
            }
            let least = found.radius * (1.0 - exactness);
            branches(&name, task, &radii, &found, (k, z), least);
            apart(&name, task, &radii, &found, (k, z), exactness);
        }
    }
}

fn branches(
    name: &str,
    task: &Task,
    radii: &[f64],
    found: &Best,
    (k, z): (usize, usize),
    least: f64,
) {
    let core = everything(task);
    let items = log(radii, &core, k, z, least).expect("the optimum has a proof");
    let make = |lower: f64, items: &[u32]| {
        let proof = (core.clone(), LowerBound::Branches { items: items.to_vec() });
        Case::of(name, task, found, (k, z), (2.0, lower), proof)
    };
    let case = make(least, &items);
    let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}\n{case:?}"));
    assert_eq!((verdict.branches, verdict.lower), (items.len() as u64, least));
    // No log proves more than is true.
    make(found.radius * (1.0 + 1e-6), &items).violation();
    for length in 0..items.len() {
        make(least, &items[..length]).violation();
    }
    let longer: Vec<u32> = items.iter().copied().chain([0]).collect();
    make(least, &longer).violation();
}

/// The best that k + z + 1 items prove two by two.
fn apart(
    name: &str,
    task: &Task,
    radii: &[f64],
    found: &Best,
    (k, z): (usize, usize),
    exactness: f64,
) {
    let count = (k + z + 1) as u32;
    let nearest = |group: u32| {
        let pairs = members(group).flat_map(|i| members(group).map(move |j| (i, j)));
        let pairs = pairs.filter(|(i, j)| i < j);
        pairs.map(|(i, j)| radii[1 << i | 1 << j]).fold(f64::INFINITY, f64::min)
    };
    let groups = (0..1u32 << task.len()).filter(|group| group.count_ones() == count);
    let Some(group) = groups.max_by(|&a, &b| nearest(a).total_cmp(&nearest(b))) else { return };
    let bound = nearest(group);
    if bound <= 0.0 {
        return;
    }
    let core: Vec<u64> = members(group).map(|i| i as u64).collect();
    let make = |lower: f64, core: &[u64]| {
        let proof = (core.to_vec(), LowerBound::Separated);
        Case::of(name, task, found, (k, z), (2.0, lower), proof)
    };
    let case = make(bound * (1.0 - exactness), &core);
    let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}\n{case:?}"));
    assert_eq!(verdict.branches, 0);
    let violation = make(bound * (1.0 + 1e-6), &core).violation();
    assert!(matches!(violation, Violation::Centers(CentersViolation::NotApart { .. })), "{name}");
    let violation = make(bound * (1.0 - exactness), &core[1..]).violation();
    assert!(matches!(violation, Violation::Centers(CentersViolation::TooFew { .. })), "{name}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: long_or(24, 10), failure_persistence: None, ..ProptestConfig::default() })]

    /// Small integers bring ties, duplicates and lines.
    #[test]
    fn points_in_the_plane(values in prop::collection::vec(-6i32..7, 2..17)) {
        let values: Vec<f64> = values[..values.len() / 2 * 2].iter().map(|&v| v.into()).collect();
        all_proofs("plane", &Task::points(&values, 2), 1e-12);
    }

    #[test]
    fn points_in_space(values in prop::collection::vec(-3i32..4, 6..22)) {
        let values: Vec<f64> = values[..values.len() / 3 * 3].iter().map(|&v| v.into()).collect();
        all_proofs("space", &Task::points(&values, 3), 1e-12);
    }

    #[test]
    fn points_on_a_line_and_in_five_dimensions(values in prop::collection::vec(-9i32..10, 30..31)) {
        let values: Vec<f64> = values.iter().map(|&v| v.into()).collect();
        all_proofs("line", &Task::points(&values[..8], 1), 1e-12);
        all_proofs("five dimensions", &Task::points(&values, 5), 1e-12);
    }

    /// Ties at the bound itself are decided exactly.
    #[test]
    fn centers_among_the_rows(values in prop::collection::vec(-6i32..7, 2..17), weights in prop::collection::vec(1i32..4, 8)) {
        let values: Vec<f64> = values[..values.len() / 2 * 2].iter().map(|&v| v.into()).collect();
        let rows = Task { placement: Placement::Rows, ..Task::points(&values, 2) };
        all_proofs("rows", &rows, 1e-15);
        let weighted = rows.values.chunks(2).zip(&weights).flat_map(|(row, &w)| [row[0], row[1], w.into()]);
        let weighted = Task { values: weighted.collect(), columns: 3, weights: true, ..rows };
        all_proofs("weighted rows", &weighted, 1e-14);
    }

    #[test]
    fn balls_and_weights_on_a_line(places in prop::collection::vec((-9i32..10, 1i32..5), 2..8)) {
        let values: Vec<f64> = places.iter().flat_map(|&(x, r)| [x.into(), r.into()]).collect();
        let balls = Task { items: Items::Balls, ..Task::points(&values, 2) };
        all_proofs("balls", &balls, 1e-9);
        let weights = Task { weights: true, ..Task::points(&values, 2) };
        all_proofs("weights", &weights, 1e-9);
    }
}

#[test]
fn balls_and_weights_in_the_plane() {
    for seed in 0..long_or(4, 1) {
        let mut values = numbers(18, seed);
        values.iter_mut().skip(2).step_by(3).for_each(|v| *v = 0.1 + 0.3 * v.abs());
        let balls = Task { items: Items::Balls, ..Task::points(&values, 3) };
        all_proofs("balls", &balls, 1e-8);
        let weights = Task { weights: true, ..Task::points(&values, 3) };
        all_proofs("weights", &weights, 1e-8);
    }
}

#[test]
fn nine_random_points_at_every_scale() {
    for (seed, scale) in [(1, 1.0), (2, 2f64.powi(-700)), (3, 2f64.powi(700)), (4, 1e-30)] {
        let values: Vec<f64> = numbers(18, seed).iter().map(|v| v * scale).collect();
        // The oracle squares in plain arithmetic: it is asked at scale 1.
        let unit = Task::points(&numbers(18, seed), 2);
        if scale == 1.0 {
            all_proofs("nine", &unit, 1e-12);
            continue;
        }
        let radii = unit.radii();
        for k in 1..4 {
            let found = best(&radii, (1 << 9) - 1, k, 1);
            let lower = found.radius * (1.0 - 1e-12);
            let core = everything(&unit);
            let items = log(&radii, &core, k, 1, lower).unwrap();
            let proof = (core, LowerBound::Branches { items });
            let mut case = Case::of("scaled", &unit, &found, (k, 1), (1.0, lower), proof);
            case.task.values = values.clone();
            let points = taut_points::Points::new(&values, 2).unwrap();
            let answer = &mut case.solution.answer;
            answer.radius = (answer.radius * (1.0 + 1e-14)) * scale;
            answer.lower_bound *= scale;
            answer.centers.iter_mut().flatten().for_each(|c| *c *= scale);
            case.solution.certificate.gap += 1e-13;
            case.solution.certificate.points_hash =
                taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
            case.check().unwrap_or_else(|e| panic!("{scale:e}, k = {k}: {e}"));
            case.solution.answer.radius *= 2.0;
            case.solution.certificate.gap = 1.1;
            case.solution.answer.lower_bound *= 1.0 + 1e-6;
            case.violation();
        }
    }
}
