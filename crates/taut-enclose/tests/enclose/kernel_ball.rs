//! Balls in the feature space of a kernel: closed forms, the plain ball, certificates on many families, and refusals.

use taut_certify::{CheckError, Kernel, KernelBall, Solution, Stop, Violation};
use taut_enclose::{BallOptions, Error, KernelBallMethod, KernelBallOptions, ball, kernel_ball};
use taut_points::{Distribution, PointSource, Points, generate};

use crate::common::families::Random;
use crate::test_length::long_or;

fn gaussian(gamma: f64) -> KernelBallOptions<'static> {
    KernelBallOptions { kernel: Kernel::Gaussian { gamma }, ..Default::default() }
}

fn normal(n: u64, dim: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Normal, n as usize, dim, seed).unwrap()
}

/// Solves and has the checker prove the gap that was asked for.
fn proved(values: &[f64], dim: usize, options: &KernelBallOptions<'_>) -> Solution<KernelBall> {
    let points = Points::new(values, dim).unwrap();
    let found = kernel_ball(&points, options).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|error| panic!("{error} {options:?}"));
    // K(x, x) of a polynomial kernel can be so much larger than the ball that rounding leaves a larger gap.
    let is_limited =
        matches!(options.kernel, Kernel::Polynomial { .. }) && found.trace.stop == Stop::Rounding;
    if options.method == KernelBallMethod::WorkingSet && !(is_limited && verdict.upper < 1e-6) {
        assert!(verdict.gap <= options.epsilon, "{verdict:?} {options:?} {:?}", found.trace);
    }
    assert!(verdict.lower <= verdict.upper);
    found
}

#[test]
fn corners_of_a_simplex_have_the_radius_of_the_formula() {
    for k in 1..12usize {
        let mut values = vec![0.0; k * k];
        (0..k).for_each(|i| values[i * k + i] = 1.5);
        for gamma in [1e-6, 0.3, 2.0, 500.0] {
            let found = proved(&values, k, &gaussian(gamma));
            let rho = 2.0 * -(-gamma * 4.5f64).exp_m1();
            let expected = rho / 2.0 * (1.0 - 1.0 / k as f64);
            let off = (found.answer.squared_radius - expected).abs();
            assert!(off <= 1e-6 * expected, "{k} {gamma} {off:e}");
            assert!(k == 1 || found.answer.support.len() == k);
        }
    }
}

#[test]
fn the_linear_kernel_gives_the_plain_ball() {
    for (n, dim) in [(1, 3), (2, 1), (50, 2), (3000, 3), (500, 40)] {
        let values = normal(n, dim, 7);
        let options =
            KernelBallOptions { kernel: Kernel::Linear, epsilon: 1e-9, ..Default::default() };
        let found = proved(&values, dim, &options);
        let points = Points::new(&values, dim).unwrap();
        let plain = ball(&points, &BallOptions::default()).unwrap().answer.radius;
        let off = (found.answer.squared_radius.sqrt() - plain).abs();
        assert!(off <= 1e-9 * plain, "{n} {dim} {off:e}");
    }
}

#[test]
fn all_families_are_proved_hard_and_soft() {
    let mut random = Random(3);
    for (n, dim) in
        [(2, 1), (3, 2), (17, 2), (300, 5), (long_or(4000, 1100), 3), (long_or(20_000, 5100), 10)]
    {
        let mut clustered = normal(n, dim, 1);
        clustered.iter_mut().for_each(|x| *x = (*x * 0.7).round() + 1e-3 * *x);
        let mut lattice = normal(n, dim, 2);
        lattice.iter_mut().for_each(|x| *x = (*x * 2.0).round());
        for values in [normal(n, dim, 5), clustered, lattice] {
            let gamma = 10f64.powf(-3.0 + 3.0 * random.unit());
            for kernel in [
                Kernel::Gaussian { gamma },
                Kernel::Polynomial { gamma: 0.1, offset: 1.0, degree: 3 },
                Kernel::Linear,
            ] {
                for nu in [None, Some(0.02), Some(0.3), Some(1.0)] {
                    let is_gaussian = matches!(kernel, Kernel::Gaussian { .. });
                    if n > 5000 && !(is_gaussian && nu <= Some(0.02)) || n > 1000 && nu > Some(0.1)
                    {
                        continue;
                    }
                    let options = KernelBallOptions { kernel, nu, ..Default::default() };
                    let found = proved(&values, dim, &options);
                    let points = Points::new(&values, dim).unwrap();
                    let outside = found.check(&points).unwrap().outside as f64;
                    let count = n as f64;
                    if let Some(nu) = nu {
                        assert!(outside <= nu * count * (1.0 + 1e-9), "{outside} {nu} {n}");
                        assert!(found.answer.support.len() as f64 >= (nu * count).floor());
                    } else {
                        assert_eq!(outside, 0.0);
                    }
                }
            }
        }
    }
}

#[test]
fn a_soft_ball_of_less_than_one_point_is_the_hard_one() {
    let values = normal(400, 3, 9);
    let hard = proved(&values, 3, &gaussian(0.2)).answer;
    let soft =
        proved(&values, 3, &KernelBallOptions { nu: Some(1.0 / 400.0), ..gaussian(0.2) }).answer;
    assert!((hard.squared_radius - soft.squared_radius).abs() <= 3e-6 * hard.squared_radius);
}

#[test]
fn a_precomputed_kernel_gives_what_its_formula_gives() {
    let (values, n) = (normal(120, 4, 11), 120);
    let points = Points::new(&values, 4).unwrap();
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let square: f64 =
                points.row(i).iter().zip(points.row(j)).map(|(a, b)| (a - b) * (a - b)).sum();
            matrix[i * n + j] = (-0.25 * square).exp();
        }
    }
    for nu in [None, Some(0.1)] {
        let direct = proved(&values, 4, &KernelBallOptions { nu, ..gaussian(0.25) }).answer;
        let options = KernelBallOptions { kernel: Kernel::Precomputed, nu, ..Default::default() };
        let given = proved(&matrix, n, &options).answer;
        assert!(
            (direct.squared_radius - given.squared_radius).abs() < 2e-6 * direct.squared_radius
        );
    }
    let options = KernelBallOptions { kernel: Kernel::Precomputed, ..Default::default() };
    let found = kernel_ball(&Points::new(&matrix, n).unwrap(), &options).unwrap();
    matrix[7 * n + found.answer.support[1] as usize] += 1e-12;
    let source = Points::new(&matrix, n).unwrap();
    let message = kernel_ball(&source, &options).unwrap().check(&source).unwrap_err().to_string();
    assert!(message.starts_with("entry (7, "), "{message}");
}

#[test]
fn turned_scaled_and_repeated_points_have_the_same_ball() {
    let (values, dim) = (normal(900, 2, 13), 2);
    let base = proved(&values, dim, &gaussian(0.5)).answer.squared_radius;
    let same = |values: &[f64], gamma: f64, what: &str| {
        let found = proved(values, dim, &gaussian(gamma)).answer.squared_radius;
        assert!((found - base).abs() <= 2e-6 * base, "{what}: {found} {base}");
    };
    let turned: Vec<f64> =
        values.chunks(2).flat_map(|p| [0.6 * p[0] - 0.8 * p[1], 0.8 * p[0] + 0.6 * p[1]]).collect();
    same(&turned, 0.5, "turned");
    let scaled: Vec<f64> = values.iter().map(|x| 1e100 * x).collect();
    same(&scaled, 0.5e-200, "scaled");
    let shifted: Vec<f64> = values.iter().map(|x| x + 1024.0).collect();
    same(&shifted, 0.5, "shifted");
    let mut twice = values.clone();
    twice.extend(values.chunks(2).rev().flatten());
    same(&twice, 0.5, "repeated");
}

/// A mean of points is rounded in units of the last place of their coordinates, which here is more than the room that the checker leaves.
#[test]
fn a_circle_far_from_the_origin_is_proved() {
    for &(x, y) in long_or(&[(1e10, -3e9), (5e5, 5e6)][..], &[(1e10, -3e9)]) {
        let circle: Vec<f64> = (0..long_or(2000, 60))
            .flat_map(|i| {
                let (sin, cos) = (i as f64 * 0.618).sin_cos();
                [x + cos, y + sin]
            })
            .collect();
        let kernels = [
            Kernel::Linear,
            Kernel::Gaussian { gamma: 1e-9 },
            Kernel::Gaussian { gamma: 0.5 },
            Kernel::Gaussian { gamma: 40.0 },
        ];
        for kernel in kernels.into_iter().step_by(long_or(1, 2)) {
            for nu in [None, Some(0.05)] {
                proved(&circle, 2, &KernelBallOptions { kernel, nu, ..Default::default() });
            }
        }
    }
}

#[test]
fn points_of_which_all_but_one_are_the_same_have_a_ball_of_two() {
    for n in [1025, 2000] {
        let mut values = vec![3.5; 2 * n];
        values[2 * n - 1] = 4.0;
        for kernel in [Kernel::Linear, Kernel::Gaussian { gamma: 2.0 }] {
            for nu in [None, Some(0.5 / n as f64)] {
                let options = KernelBallOptions { kernel, nu, ..Default::default() };
                let found = proved(&values, 2, &options);
                let rho = if kernel == Kernel::Linear { 0.25 } else { -2.0 * (-0.5f64).exp_m1() };
                assert!((found.answer.squared_radius / rho - 0.25).abs() < 1e-6, "{found:?}");
            }
        }
    }
}

#[test]
fn kernels_so_wide_that_all_points_nearly_coincide_lose_no_digits() {
    for gamma in [1e-12, 1e-100, 1e-200] {
        let values = normal(600, 3, 15);
        let found = proved(&values, 3, &gaussian(gamma)).answer.squared_radius / gamma;
        let points = Points::new(&values, 3).unwrap();
        let plain = ball(&points, &BallOptions::default()).unwrap().answer.radius;
        // 1 − exp(−γs) is γs, and ρ twice that.
        assert!((found / (2.0 * plain * plain) - 1.0).abs() < 1e-6, "{gamma:e} {found} {plain}");
    }
}

#[test]
fn the_thesis_method_comes_near_and_says_how_near() {
    let values = normal(500, 4, 17);
    let best = proved(&values, 4, &gaussian(0.1)).answer.squared_radius;
    let mut last = f64::INFINITY;
    for steps in [3, 30, 300] {
        let options =
            KernelBallOptions { method: KernelBallMethod::Thesis, steps, ..gaussian(0.1) };
        let found = proved(&values, 4, &options);
        assert!(found.answer.squared_radius >= best * (1.0 - 1e-6));
        assert!(found.certificate.gap < last, "{steps}");
        last = found.certificate.gap;
    }
    assert!(last < 0.02, "{last}");
}

#[test]
fn answers_do_not_depend_on_threads_or_on_single_precision_of_whole_numbers() {
    let mut values = normal(long_or(30_000, 8000), 3, 19);
    values.iter_mut().for_each(|x| *x = (*x * 64.0).round());
    let narrow: Vec<f32> = values.iter().map(|&x| x as f32).collect();
    let points = Points::new(&values, 3).unwrap();
    let singles = Points::new(&narrow, 3).unwrap();
    for nu in [None, Some(0.01)] {
        let of = |threads, source: &dyn PointSource| {
            let options = KernelBallOptions { threads: Some(threads), nu, ..gaussian(1e-4) };
            kernel_ball(source, &options).unwrap()
        };
        let one = of(1, &points);
        assert_eq!(one, of(2, &points));
        assert_eq!(one, of(8, &points));
        assert_eq!(one.answer, of(2, &singles).answer);
    }
}

#[test]
fn damaged_answers_are_refused() {
    let values = normal(200, 2, 21);
    let points = Points::new(&values, 2).unwrap();
    for nu in [None, Some(0.1)] {
        let good = kernel_ball(&points, &KernelBallOptions { nu, ..gaussian(0.3) }).unwrap();
        let refused = |what: &str, edit: &dyn Fn(&mut Solution<KernelBall>)| {
            let mut bad = good.clone();
            edit(&mut bad);
            assert!(matches!(bad.check(&points), Err(CheckError::Rejected(_))), "{what} {nu:?}");
        };
        refused("no gap", &|s| s.certificate.gap = 0.0);
        refused("gap NaN", &|s| s.certificate.gap = f64::NAN);
        refused("gap infinite", &|s| s.certificate.gap = f64::INFINITY);
        refused("small radius", &|s| s.answer.squared_radius *= 0.99);
        refused("large radius", &|s| s.answer.squared_radius *= 1.01);
        refused("radius NaN", &|s| s.answer.squared_radius = f64::NAN);
        refused("multiplier", &|s| s.answer.multipliers[0] *= 1.0 + 1e-9);
        refused("multiplier 0", &|s| s.answer.multipliers[0] = 0.0);
        refused("multiplier NaN", &|s| s.answer.multipliers[0] = f64::NAN);
        refused("swapped", &|s| s.answer.support.swap(0, 1));
        refused("another row", &|s| s.answer.support[0] ^= 1);
        refused("row beyond", &|s| *s.answer.support.last_mut().unwrap() = 200);
        refused("no support", &|s| {
            s.answer.support.clear();
            s.answer.multipliers.clear();
        });
        refused("kernel", &|s| s.answer.kernel = Kernel::Gaussian { gamma: 0.31 });
        refused("kernel NaN", &|s| s.answer.kernel = Kernel::Gaussian { gamma: f64::NAN });
        refused("precomputed", &|s| s.answer.kernel = Kernel::Precomputed);
        refused("nu", &|s| s.answer.nu = Some(0.9));
        refused("nu above 1", &|s| s.answer.nu = Some(1.5));
        refused("hash", &|s| s.certificate.points_hash.0 ^= 1);
    }
}

#[test]
fn huge_tiny_and_wrong_inputs_are_told() {
    let refused = |values: &[f64], dim: usize, options: &KernelBallOptions<'_>| {
        kernel_ball(&Points::new(values, dim).unwrap(), options).unwrap_err()
    };
    assert!(matches!(refused(&[], 2, &gaussian(1.0)), Error::Empty));
    assert!(matches!(refused(&[1e300, -1e300], 1, &gaussian(1.0)), Error::Overflow));
    assert!(matches!(refused(&[1e-200, -1e-200], 1, &gaussian(1.0)), Error::Overflow));
    assert!(matches!(refused(&[0.0, f64::NAN], 1, &gaussian(1.0)), Error::Input(_)));
    for (options, name) in [
        (gaussian(0.0), "gamma"),
        (gaussian(f64::INFINITY), "gamma"),
        (KernelBallOptions { nu: Some(0.0), ..gaussian(1.0) }, "nu"),
        (KernelBallOptions { epsilon: 0.0, ..gaussian(1.0) }, "epsilon"),
        (KernelBallOptions { max_passes: 0, ..gaussian(1.0) }, "max_passes"),
        (
            KernelBallOptions {
                kernel: Kernel::Polynomial { gamma: 1.0, offset: 0.0, degree: 17 },
                ..Default::default()
            },
            "degree",
        ),
        (KernelBallOptions { kernel: Kernel::Precomputed, ..Default::default() }, "square"),
    ] {
        let error = refused(&[0.0, 1.0, 2.0], 1, &options).to_string();
        assert!(error.contains(name), "{error}");
    }
    for values in [vec![5.0; 12], vec![5.0; 3000], vec![-0.0, 0.0, 0.0, -0.0]] {
        let found = proved(&values, 2, &gaussian(3.0));
        assert_eq!((found.answer.squared_radius, found.certificate.gap), (0.0, 0.0));
    }
}

#[test]
fn a_point_that_moves_is_refused_by_the_hash_and_named_without_it() {
    let mut values = normal(300, 2, 23);
    let found = proved(&values, 2, &gaussian(0.3));
    values[100] = 50.0;
    let points = Points::new(&values, 2).unwrap();
    assert!(matches!(found.check(&points), Err(CheckError::Rejected(Violation::Hash { .. }))));
    let mut other = found;
    other.certificate.points_hash =
        taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
    let message = other.check(&points).unwrap_err().to_string();
    assert!(message.starts_with("point 50 "), "{message}");
}

fn precomputed() -> KernelBallOptions<'static> {
    KernelBallOptions { kernel: Kernel::Precomputed, ..Default::default() }
}

#[test]
fn equal_rows_of_a_precomputed_kernel_have_a_radius_of_0_and_no_gap() {
    let values = [0.3; 9];
    for method in [KernelBallMethod::WorkingSet, KernelBallMethod::Thesis] {
        let found = proved(&values, 3, &KernelBallOptions { method, ..precomputed() });
        assert_eq!((found.answer.squared_radius, found.certificate.gap), (0.0, 0.0));
    }
}

#[test]
fn matrices_that_are_no_scalar_products_are_refused() {
    // Rows 0 and 1 would have the squared distance 1 + 1 − 2·3; the other matrix has negative squared lengths.
    let distance = [1.0, 3.0, 0.0, 3.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    for (values, dim) in [(&distance[..], 3), (&[-1.0, 0.0, 0.0, -1.0], 2)] {
        let points = Points::new(values, dim).unwrap();
        let message = match kernel_ball(&points, &precomputed()) {
            Ok(found) => found.check(&points).unwrap_err().to_string(),
            Err(error) => error.to_string(),
        };
        assert!(message.contains("positive semidefinite"), "{message}");
    }
}

#[test]
fn the_thesis_method_keeps_to_its_budget_of_passes() {
    let values = normal(200, 3, 4);
    let options =
        KernelBallOptions { method: KernelBallMethod::Thesis, max_passes: 20, ..gaussian(0.1) };
    let found = proved(&values, 3, &options);
    assert_eq!((found.trace.passes, found.trace.stop), (20, Stop::PassBudget));
    // The start takes four passes and two steps.
    assert_eq!(found.trace.iterations, 18);
}

#[test]
fn a_kernel_has_its_own_parameters_and_no_others_in_json() {
    let points = Points::new(&[0.0, 1.0, 3.0], 1).unwrap();
    let options = KernelBallOptions { kernel: Kernel::Linear, ..Default::default() };
    let text = kernel_ball(&points, &options).unwrap().to_json();
    let text = serde_json::from_str::<serde_json::Value>(&text).unwrap().to_string();
    assert!(taut_certify::AnySolution::from_json(&text).is_ok());
    for wrong in [
        r#""name":"linear","gamma":1.0"#,
        r#""name":"linear","guess":1.0"#,
        r#""name":"gaussian""#,
        r#""name":"gaussian","gamma":1.0,"degree":2"#,
        r#""name":"sigmoid""#,
    ] {
        let changed = text.replace(r#""name":"linear""#, wrong);
        assert_ne!(changed, text);
        assert!(taut_certify::AnySolution::from_json(&changed).is_err(), "{wrong}");
    }
}
