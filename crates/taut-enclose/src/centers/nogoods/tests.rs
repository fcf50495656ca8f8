//! Nogoods against brute force, and their logs with the checker, as they are and damaged.

use taut_certify::{Centers, CheckError, Items, LowerBound, Nogood, Solution, Stop};
use taut_points::{Distribution, Monitor, Points, generate};

use super::{End, NogoodSearch, Refutation};
use crate::centers::answer::answer;
use crate::centers::cloud::Cloud;
use crate::centers::item_rows::ItemRows;
use crate::centers::items::{ItemSet, Shape};
use crate::centers::proof::Proof;
use crate::centers::read::Table;
use crate::centers::small_ball::{Ball, Workspace};
use crate::centers::start::start;
use crate::centers::subsearch::Task;
use crate::centers::tree::SearchResult;
use crate::centers::{CentersOptions, finish};

/// Solves by nogoods alone, from a traversal.
fn solved(values: &[f64], k: usize, gap: f64) -> Solution<Centers> {
    let (points, monitor) = (Points::new(values, 2).unwrap(), Monitor::silent());
    let rows = ItemRows::read(&points, Items::Points, false, None, &monitor).unwrap();
    let table = Table::of(rows).unwrap();
    let cloud = Cloud::<[f64; 2]>::new(table.items(), &[]);
    let start = start(&cloud, k, 0, &monitor).unwrap();
    let task = Task { cloud: &cloud, monitor: &monitor, k, z: 0 };
    // The worst centers, so that better ones have to be found.
    let mut search = NogoodSearch::<4>::new(&task, &start.traversal, &start.plain, gap, u64::MAX);
    let End::Refuted(refutation) = search.go_on().unwrap() else { panic!("it did not end") };
    let proof = Proof::by_nogoods(search.best.radius / (1.0 + gap), &refutation);
    let answered = answer(&table, &cloud, &search.best.centers, 0, false).unwrap();
    let found = SearchResult {
        incumbent: search.best,
        proved: vec![],
        refuted: None,
        core_set: search.core_set,
        stop: Stop::Converged,
        nodes: search.nodes,
        restarts: 0,
        scans: search.scans,
        history: vec![],
    };
    let options = CentersOptions { epsilon: 2.0 * gap, ..CentersOptions::default() };
    finish(&table, &cloud, Items::Points, k, &options, found, proof, (0, None), answered).unwrap()
}

/// The least radius of k balls around all points, by all ways to put them in k clusters.
fn least_radius(values: &[f64], k: usize) -> f64 {
    let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
    values.chunks_exact(2).for_each(|place| items.push(place, 0.0));
    let mut work = Workspace::new(2);
    let ways = k.pow(items.len() as u32 - 1);
    let radius = |way: usize| {
        let mut clusters = vec![vec![]; k];
        let mut rest = way;
        for item in 0..items.len() {
            clusters[rest % k].push(item as u32);
            rest /= k;
        }
        let full = clusters.iter().filter(|cluster| !cluster.is_empty());
        full.map(|cluster| Ball::of_all(&items, cluster, &mut work).radius).fold(0.0, f64::max)
    };
    (0..ways).map(radius).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_way_to_put_points_in_clusters_is_better() {
    for seed in 0..60 {
        let (n, k) = (6 + seed as usize % 4, 2 + seed as usize % 2);
        let values: Vec<f64> = generate(Distribution::Uniform, n, 2, seed).unwrap();
        let least = least_radius(&values, k);
        let found = solved(&values, k, 1e-4);
        let verdict = found.check(&Points::new(&values, 2).unwrap()).unwrap();
        assert!(verdict.gap <= 1.001e-4, "{seed}: {}", verdict.gap);
        assert!(found.answer.lower_bound <= least * (1.0 + 1e-12), "{seed}: {least}");
        assert!(found.answer.radius >= least * (1.0 - 1e-12), "{seed}: {least}");
    }
}

#[test]
fn points_on_a_grid_have_many_ties() {
    for side in [4, 7] {
        let values: Vec<f64> =
            (0..side * side).flat_map(|at| [(at % side) as f64, (at / side) as f64]).collect();
        for k in [3, 5] {
            let found = solved(&values, k, 1e-5);
            assert!(found.check(&Points::new(&values, 2).unwrap()).unwrap().gap <= 1.001e-5);
        }
    }
}

fn nogoods(found: &mut Solution<Centers>) -> &mut Vec<Nogood> {
    match &mut found.certificate.proof {
        LowerBound::Nogoods { nogoods } => nogoods,
        other => panic!("{other:?}"),
    }
}

#[test]
fn damaged_logs_are_refused() {
    let values: Vec<f64> = generate(Distribution::Uniform, 200, 2, 9).unwrap();
    let points = Points::new(&values, 2).unwrap();
    let sound = solved(&values, 7, 0.01);
    assert!(sound.check(&points).unwrap().gap <= 0.01001);
    let count = nogoods(&mut sound.clone()).len();
    assert!(count > 50, "{count}");
    let is_refused = |damage: &dyn Fn(&mut Solution<Centers>)| {
        let mut damaged = sound.clone();
        damage(&mut damaged);
        match damaged.check(&points) {
            Ok(_) => false,
            Err(CheckError::Rejected(_)) => true,
            Err(other) => panic!("{other}"),
        }
    };
    // A better bound than there is, more balls, outliers, and a log without its end.
    assert!(is_refused(&|found| {
        found.answer.lower_bound *= 1.0099;
        found.certificate.gap = found.answer.radius / found.answer.lower_bound - 1.0;
    }));
    assert!(is_refused(&|found| found.certificate.k += 1));
    assert!(is_refused(&|found| found.certificate.outliers = 1));
    assert!(is_refused(&|found| nogoods(found).truncate(count - 1)));
    assert!(is_refused(&|found| nogoods(found).clear()));
    let items = sound.certificate.core_set.len() as u32;
    let (mut fewer, mut refused) = (0, 0);
    // Of long logs a part, which is enough.
    for number in (0..count).step_by(1 + count / 60) {
        let nogood = nogoods(&mut sound.clone())[number].clone();
        // Items and nogoods that there are not, and none at all.
        assert!(is_refused(&|found| nogoods(found)[number].items[0] = items));
        assert!(is_refused(&|found| nogoods(found)[number].items.clear()));
        assert!(is_refused(&|found| nogoods(found)[number].misses.push(number as u32)));
        if nogood.misses.is_empty() {
            // An item is not apart from itself.
            assert!(is_refused(&|found| {
                let first = nogood.items[0];
                nogoods(found)[number].items.push(first);
            }));
            continue;
        }
        assert!(is_refused(&|found| nogoods(found)[number].items.push(0)));
        for at in 0..nogood.misses.len() {
            fewer += 1;
            refused += u32::from(is_refused(&|found| {
                nogoods(found)[number].misses.remove(at);
            }));
        }
    }
    // A few are not needed, as others are missed by the same balls.
    assert!(refused * 10 >= fewer * 8 && fewer > 40, "{refused} of {fewer}");
}

/// A checker takes 127 others to show a nogood, however often they are repeated, and refuses 128.
#[test]
fn nogoods_shown_by_too_many_others_are_refused() {
    let values: Vec<f64> = generate(Distribution::Uniform, 200, 2, 9).unwrap();
    let points = Points::new(&values, 2).unwrap();
    let sound = solved(&values, 7, 0.01);
    let shown_by = |count: usize| {
        let mut repeated = sound.clone();
        let misses = &mut nogoods(&mut repeated).last_mut().unwrap().misses;
        assert!(!misses.is_empty());
        *misses = misses.iter().copied().cycle().take(count).collect();
        repeated.check(&points)
    };
    assert!(shown_by(127).unwrap().gap <= 0.01001);
    match shown_by(128) {
        Err(CheckError::Rejected(violation)) => {
            assert!(violation.to_string().contains("too many others"), "{violation}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_log_that_no_checker_takes_is_no_refutation() {
    let of = |count| {
        let nogood = Nogood { items: vec![], misses: vec![] };
        Refutation { core_set: vec![0; 2048], log: vec![nogood; count] }
    };
    assert!(of(1 << 19).is_checkable() && !of((1 << 19) + 1).is_checkable());
}
