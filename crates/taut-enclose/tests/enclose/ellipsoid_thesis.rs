//! The methods of the literature: they promise what they keep, and their counts stay within the theory.

use ellipsoids::{by, exact, normal, solve};
use taut_certify::Stop;
use taut_enclose::EllipsoidMethod::{self, *};
use taut_enclose::EllipsoidOptions;

use crate::ellipsoids;

#[test]
fn names_read_back() {
    for method in EllipsoidMethod::ALL {
        assert_eq!(method.name().parse::<EllipsoidMethod>().unwrap(), method);
    }
    assert!("khachiyan".parse::<EllipsoidMethod>().is_err());
}

#[test]
fn all_methods_reach_a_coarse_gap() {
    for (n, dim) in [(300, 2), (1000, 5), (9, 8)] {
        let values = normal(n, dim, 17);
        let best = exact("newton", &values, dim, 1e-12).answer.log_volume;
        for method in [Newton, ThesisKhachiyan, ThesisCoreSet, AwaySteps] {
            let name = format!("{method} on {n} × {dim}");
            let found = solve(&name, &values, dim, &by(method, 1e-2));
            assert_eq!(found.trace.stop, Stop::Converged, "{name}");
            assert_eq!(found.trace.method, method.name());
            let beyond = found.answer.log_volume - best;
            assert!((-1e-12..=1e-2).contains(&beyond), "{name}: {beyond:e} beyond the optimum");
        }
    }
}

/// Of few points a checker lets the sum of multipliers be off by little, and each step rounds it.
#[test]
fn many_steps_leave_a_sum_of_one() {
    let values = [1.0, 2.0, 3.0, 4.0, 2.0, 1.0, 5.0, 1.0];
    for method in [ThesisKhachiyan, ThesisCoreSet] {
        let found = solve(&format!("{method}"), &values, 2, &by(method, 1e-3));
        assert_eq!(found.trace.stop, Stop::Converged, "{method}");
        assert!(found.trace.iterations > 100, "{method}: {}", found.trace.iterations);
    }
}

/// Theorem 3.4.3 with the constants of its proof; and Khachiyan's core-set is the whole set.
#[test]
fn iterations_and_core_sets_stay_within_their_bounds() {
    for dim in [2, 4, 8] {
        for epsilon in [0.5, 0.1, 0.02] {
            let values = normal(2000, dim, 3);
            let name = format!("dimension {dim}, gap {epsilon}");
            let found = solve(&name, &values, dim, &by(ThesisCoreSet, epsilon));
            let counters = &found.trace.counters;
            assert!(found.trace.iterations <= counters["iteration-bound"], "{name}");
            assert!(found.trace.core_set <= counters["core-set-bound"], "{name}");
            // A core-set: its own ellipsoid is that of all, but for the gap.
            let rows: Vec<f64> = (found.certificate.support.iter())
                .flat_map(|&i| values[i as usize * dim..(i as usize + 1) * dim].to_vec())
                .collect();
            let alone = exact(&name, &rows, dim, 1e-12).answer.log_volume;
            assert!(found.answer.log_volume - alone <= epsilon, "{name}");
            let khachiyan = solve(&name, &values, dim, &by(ThesisKhachiyan, epsilon));
            assert!(khachiyan.trace.iterations <= khachiyan.trace.counters["iteration-bound"]);
            assert_eq!(khachiyan.trace.core_set, 2000);
        }
    }
}

/// Lemma 3.3.1: at most 2d points, and a volume at most d²ᵈ times too small.
#[test]
fn the_initial_approximation_keeps_its_lemma() {
    for dim in 2..=9 {
        for seed in 0..4 {
            let values: Vec<f64> = normal(3000, dim, 40).iter().map(|v| v * v * v).collect();
            let options = EllipsoidOptions { seed, ..by(ThesisInitial, 1e-9) };
            let found = solve("initial", &values, dim, &options);
            assert!(found.trace.core_set <= 2 * dim as u64);
            assert_eq!((found.trace.stop, found.trace.passes), (Stop::PassBudget, dim as u64 + 1));
            let rows: Vec<f64> = (found.certificate.support.iter())
                .flat_map(|&i| values[i as usize * dim..(i as usize + 1) * dim].to_vec())
                .collect();
            let small = exact("of X₀", &rows, dim, 1e-12).answer.log_volume;
            let best = exact("of all", &values, dim, 1e-12).answer.log_volume;
            let d = dim as f64;
            assert!(best - small <= 2.0 * d * d.ln(), "dimension {dim}: {}", best - small);
        }
    }
}

/// What steps away are for: a small gap, and no point with weight that does not need it.
#[test]
fn steps_away_reach_a_small_gap() {
    let values = normal(1000, 4, 5);
    let found = solve("away", &values, 4, &by(AwaySteps, 1e-7));
    assert_eq!(found.trace.stop, Stop::Converged);
    assert!(found.trace.counters["away-steps"] > 0);
    let support = exact("newton", &values, 4, 1e-12).certificate.support;
    assert_eq!(found.certificate.support, support);
}

#[test]
fn a_budget_of_passes_is_kept() {
    let values = normal(5000, 6, 5);
    for method in EllipsoidMethod::ALL {
        for max_passes in [7, 8, 20] {
            let options = EllipsoidOptions { max_passes, ..by(method, 1e-11) };
            let found = solve("budget", &values, 6, &options);
            let used = found.trace.passes;
            // One more where the proof has to measure what no pass has listed.
            assert!(used <= max_passes + 1, "{method}: {used} of {max_passes}");
            if found.trace.stop == Stop::Converged {
                assert!(found.certificate.gap <= 1e-11);
            }
        }
    }
    let found = solve("two", &values, 6, &EllipsoidOptions { max_passes: 2, ..by(Newton, 1e-11) });
    assert_eq!(found.trace.stop, Stop::PassBudget);
    assert!(found.certificate.gap > 1e-11 && found.certificate.gap < 1.0);
}

#[test]
fn small_and_flat_sets_are_solved_by_all_methods() {
    for method in EllipsoidMethod::ALL {
        let one = solve("one point", &[1.0, 2.0], 2, &by(method, 1e-3));
        assert_eq!(one.answer.rank(), 0);
        let line: Vec<f64> =
            (0..30).flat_map(|k| [f64::from(k), 2.0 * f64::from(k), 1.0]).collect();
        let line = solve("a line", &line, 3, &by(method, 1e-3));
        assert_eq!(line.answer.rank(), 1);
        let simplex = solve("a triangle", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0], 2, &by(method, 1e-3));
        assert!(simplex.certificate.gap < 1e-12, "{method}");
    }
}
