//! The best points to leave out, up to five, against all circles through two and three points.

use circles::{brute_force, one_without};
use taut_certify::{Centers, HeldOut, LowerBound, Solution, Stop};
use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Points, generate};

use crate::circles;

/// The answer for a gap, which the checker confirms.
fn solved(values: &[f64], k: usize, outliers: u64, epsilon: f64) -> Solution<Centers> {
    let points = Points::new(values, 2).unwrap();
    let options = CentersOptions { epsilon, outliers, ..Default::default() };
    let found = centers(&points, k, &options).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|error| panic!("{error}\n{found:?}"));
    assert!(verdict.gap <= epsilon * (1.0 + 1e-9), "k = {k}, {outliers} out: {verdict:?}");
    assert_eq!(found.trace.stop, Stop::Converged);
    found
}

fn pairs(values: &[f64]) -> Vec<[f64; 2]> {
    values.as_chunks().0.to_vec()
}

fn sets(n: usize, seed: u64) -> Vec<(&'static str, Vec<f64>)> {
    let of = |kind| generate::<f64>(kind, n, 2, seed).unwrap();
    let mut grid = of(Distribution::Uniform);
    grid.iter_mut().for_each(|v| *v = (*v * 6.0).round());
    vec![
        ("uniform", of(Distribution::Uniform)),
        ("normal", of(Distribution::Normal)),
        ("clusters", of(Distribution::Clusters { count: 3, spread: 0.05 })),
        ("a grid, with copies", grid),
    ]
}

#[test]
fn forty_points_against_all_circles() {
    for (name, values) in [sets(40, 1), sets(23, 2)].concat() {
        let points = pairs(&values);
        for k in 1..=3 {
            for z in (0..=5).step_by(crate::test_length::long_or(1, 2)) {
                let radius = solved(&values, k, z, 1e-9).answer.radius;
                let wanted = brute_force(&points, k, z as usize);
                assert!(
                    (radius - wanted).abs() <= 2e-9 * wanted,
                    "{name}, k = {k}, {z} out: {radius} against {wanted}"
                );
            }
        }
    }
}

/// Both ways of the comparison agree where both can go.
#[test]
fn the_smallest_circles_are_those_of_all_circles() {
    for (name, values) in sets(30, 3) {
        // Copies leave no point that all smaller circles leave out.
        if name.contains("copies") {
            continue;
        }
        let points = pairs(&values);
        for (z, radius) in one_without(&points, 5).into_iter().enumerate() {
            let wanted = brute_force(&points, 1, z);
            assert!((radius - wanted).abs() <= 1e-9 * wanted, "{name}, {z} out");
        }
    }
}

#[test]
fn two_thousand_points_and_one_circle() {
    for (name, values) in sets(2000, 4).into_iter().take(3) {
        for (z, wanted) in one_without(&pairs(&values), 5).into_iter().enumerate() {
            let radius = solved(&values, 1, z as u64, 1e-9).answer.radius;
            assert!(
                (radius - wanted).abs() <= 2e-9 * wanted,
                "{name}, {z} out: {radius} against {wanted}"
            );
        }
    }
}

/// Beyond brute force the checker has the word: no two circles smaller by 1e-6 hold all points but z.
#[test]
fn two_thousand_points_and_two_circles() {
    for n in [200, 2000] {
        for (name, values) in sets(n, 5) {
            let mut before = f64::INFINITY;
            for z in 0..=5 {
                let found = solved(&values, 2, z, 1e-6);
                assert!(found.answer.radius <= before * (1.0 + 1e-6), "{name}, {z} out");
                before = found.answer.radius;
            }
        }
    }
}

/// Solutions whose logs have nodes that items left out refute, with their points.
fn avoiding() -> Vec<(Vec<f64>, Solution<Centers>)> {
    let sets = [sets(60, 7), sets(300, 8)].concat().into_iter();
    let all = sets.map(|(_, values)| (solved(&values, 3, 4, 1e-6), values));
    let all: Vec<_> = all
        .filter(|(found, _)| matches!(found.certificate.proof, LowerBound::Avoiding { .. }))
        .map(|(found, values)| (values, found))
        .collect();
    assert!(all.len() >= 4, "{} logs", all.len());
    all
}

/// Returns true if the checker confirms an answer.
fn is_confirmed(values: &[f64], found: &Solution<Centers>) -> bool {
    found.check(&Points::new(values, 2).unwrap()).is_ok()
}

/// An independent judge follows the logs, too.
#[test]
fn what_items_left_out_refute_is_judged_again() {
    for (values, found) in avoiding() {
        let options = CentersOptions { outliers: 4, ..Default::default() };
        crate::centers::judge(&values, 2, 3, &options, &found).unwrap();
    }
}

/// A bound above the least radius has no proof, wherever a log says that a cluster holds what is left out.
#[test]
fn forged_logs_prove_no_larger_bound() {
    for (values, found) in avoiding() {
        let LowerBound::Avoiding { items, held_out } = &found.certificate.proof else { continue };
        let mut forged = found.clone();
        // Half a percent more is proved of nothing that was found to a gap of 1e-6.
        let radius = found.answer.radius * 1.005;
        (forged.answer.radius, forged.answer.lower_bound) = (radius, radius);
        forged.certificate.gap = 0.0;
        assert!(!is_confirmed(&values, &forged));
        for at in (1..=items.len()).step_by(items.len().div_ceil(60)) {
            for cluster in 0..3 {
                let mut ends: Vec<HeldOut> =
                    held_out.iter().copied().filter(|end| end.at < at as u64).collect();
                ends.extend([HeldOut { at: at as u64, cluster }; 20]);
                forged.certificate.proof =
                    LowerBound::Avoiding { items: items[..at].to_vec(), held_out: ends };
                assert!(!is_confirmed(&values, &forged), "{at}, {cluster}");
            }
        }
    }
}

/// A log without its ends, with one more, or with clusters that are not there is refused.
#[test]
fn damaged_ends_are_refused() {
    for (values, found) in avoiding() {
        let LowerBound::Avoiding { items, held_out } = &found.certificate.proof else { continue };
        let with = |items: &[u32], held_out: Vec<HeldOut>| {
            let mut damaged = found.clone();
            damaged.certificate.proof = LowerBound::Avoiding { items: items.to_vec(), held_out };
            is_confirmed(&values, &damaged)
        };
        assert!(with(items, held_out.clone()));
        assert!(!with(items, vec![]));
        let end = HeldOut { at: items.len() as u64, cluster: 0 };
        assert!(!with(items, [&held_out[..], &[end, end]].concat()));
        assert!(!with(&items[..items.len() - 1], held_out.clone()));
        for at in (0..held_out.len()).step_by(held_out.len().div_ceil(20)) {
            let mut changed = held_out.clone();
            changed[at].cluster = 3;
            assert!(!with(items, changed));
            let mut changed = held_out.clone();
            changed[at].at = u64::MAX;
            assert!(!with(items, changed));
        }
        let mut damaged = found.clone();
        damaged.certificate.proof = LowerBound::Branches { items: items.clone() };
        assert!(!is_confirmed(&values, &damaged));
    }
}
