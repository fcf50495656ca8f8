//! Laws that centers obey, inputs at the edges, and the optima of real places.

use centers::judge;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::{Centers, Items, LowerBound, Placement, Solution, Stop};
use taut_enclose::{CentersMethod, CentersOptions, Error, StreamingOptions, centers};
use taut_points::{Distribution, InputError, Points, generate};

use crate::centers;
use crate::test_length::long_or;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(51), failure_persistence: None, ..Config::default() }
}

/// An answer that both judges accept: the one of these tests, and the checker.
fn found(values: &[f64], dim: usize, k: usize, options: &CentersOptions<'_>) -> Solution<Centers> {
    let found = checked(values, dim, k, options);
    if let Err(why) = judge(values, dim, k, options, &found) {
        panic!("{why}: k = {k}, {options:?}");
    }
    found
}

/// An answer that the checker accepts.
fn checked(
    values: &[f64],
    dim: usize,
    k: usize,
    options: &CentersOptions<'_>,
) -> Solution<Centers> {
    let points = Points::new(values, dim).unwrap();
    let found = centers(&points, k, options).unwrap();
    is_confirmed(&found, &points);
    found
}

/// Fails unless the checker proves what the answer claims.
fn is_confirmed(found: &Solution<Centers>, points: &Points<'_, f64>) {
    let verdict = found.check(points).unwrap_or_else(|why| panic!("{why}\n{found:?}"));
    let Centers { radius, lower_bound, .. } = found.answer;
    assert_eq!((verdict.upper, verdict.lower), (radius, lower_bound));
}

fn fine() -> CentersOptions<'static> {
    CentersOptions { epsilon: 1e-9, ..Default::default() }
}

fn cloud() -> impl Strategy<Value = (Vec<f64>, usize)> {
    (1usize..=5, 1usize..=60, 0u64..1000).prop_map(|(dim, n, seed)| {
        (generate(Distribution::Normal, n, dim, seed).expect("the parameters are in range"), dim)
    })
}

proptest! {
    #![proptest_config(seeded(long_or(40, 14)))]

    /// More centers are never worse, nor is leaving out more.
    #[test]
    fn the_radius_falls_with_k_and_outliers((values, dim) in cloud()) {
        let n = (values.len() / dim) as u64;
        let mut before = f64::INFINITY;
        for k in 1..=4 {
            let radius = found(&values, dim, k, &fine()).answer.radius;
            prop_assert!(radius <= before * (1.0 + 2e-9), "k = {k}: {radius} after {before}");
            before = radius;
        }
        let mut before = f64::INFINITY;
        for outliers in 0..n.min(3) {
            let options = CentersOptions { outliers, ..fine() };
            let radius = found(&values, dim, 2, &options).answer.radius;
            prop_assert!(radius <= before * (1.0 + 2e-9), "{outliers} outliers: {radius} after {before}");
            before = radius;
        }
    }

    /// Neither turns, scales, orders nor copies change the radius.
    #[test]
    fn turned_scaled_reordered_doubled((values, dim) in cloud(), angle in 0.0f64..6.0, power in -600i32..600, turn in 0usize..60) {
        let plain = found(&values, dim, 3, &fine()).answer.radius;
        let near = |other: f64, what: &str| {
            assert!((other - plain).abs() <= 3e-9 * plain, "{what}: {other} against {plain}");
        };
        let mut turned = values.clone();
        let (sin, cos) = angle.sin_cos();
        for row in turned.chunks_exact_mut(dim) {
            for j in 1..dim {
                (row[j - 1], row[j]) = (cos * row[j - 1] - sin * row[j], sin * row[j - 1] + cos * row[j]);
            }
        }
        near(found(&turned, dim, 3, &fine()).answer.radius, "turned");
        let mut other = values.clone();
        other.rotate_left(turn * dim % values.len());
        near(found(&other, dim, 3, &fine()).answer.radius, "reordered");
        other.extend_from_slice(&values);
        near(found(&other, dim, 3, &fine()).answer.radius, "doubled");
        // Powers of two are exact; the judge's squares would not be.
        let factor = 2f64.powi(power);
        let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
        near(checked(&scaled, dim, 3, &fine()).answer.radius / factor, "scaled");
    }

    /// Single precision is its own widened copy, and threads decide nothing.
    #[test]
    fn media_and_threads((values, dim) in cloud()) {
        let single: Vec<f32> = values.iter().map(|&v| v as f32).collect();
        let double: Vec<f64> = single.iter().map(|&v| v.into()).collect();
        let wanted = found(&double, dim, 3, &fine());
        let of_single = centers(&Points::new(&single, dim).unwrap(), 3, &fine()).unwrap();
        prop_assert_eq!(&of_single, &wanted);
        for threads in [1, 3] {
            let options = CentersOptions { threads: Some(threads), ..fine() };
            let again = centers(&Points::new(&double, dim).unwrap(), 3, &options).unwrap();
            prop_assert_eq!(&again, &wanted);
        }
    }

    /// All methods agree on what they prove of each other.
    #[test]
    fn methods_bound_each_other((values, dim) in cloud(), k in 1usize..4) {
        let best = found(&values, dim, k, &fine()).answer;
        for method in CentersMethod::ALL {
            let options = CentersOptions { method, epsilon: 0.05, ..Default::default() };
            let other = found(&values, dim, k, &options);
            prop_assert!(other.answer.lower_bound <= best.radius);
            prop_assert!(other.answer.radius >= best.lower_bound);
            let gap = match method {
                CentersMethod::FarthestFirst => 1.0,
                CentersMethod::Stream(_) => StreamingOptions::default().factor() - 1.0,
                _ => 0.05,
            };
            prop_assert!(other.certificate.gap <= gap * (1.0 + 1e-9), "{method}: {}", other.certificate.gap);
        }
    }

    /// Copies of weights 1 or radii 0 are points.
    #[test]
    fn plain_weights_and_balls((values, dim) in cloud(), k in 1usize..4) {
        let wanted = found(&values, dim, k, &fine()).answer.radius;
        for (extra, items) in [(1.0, Items::Points), (0.0, Items::Balls), (0.25, Items::Balls)] {
            let rows: Vec<f64> = values
                .chunks_exact(dim)
                .flat_map(|row| row.iter().copied().chain([extra]))
                .collect();
            let options = CentersOptions { weights: items == Items::Points, ..fine() };
            let points = Points::new(&rows, dim + 1).unwrap();
            let other = centers(&points, k, &CentersOptions { inputs: items, ..options }).unwrap();
            judge(&rows, dim + 1, k, &options, &other).unwrap();
            is_confirmed(&other, &points);
            let grown = if items == Items::Balls { extra } else { 0.0 };
            let radius = other.answer.radius - grown;
            prop_assert!((radius - wanted).abs() <= 3e-9 * (wanted + grown), "{radius} against {wanted}");
        }
    }
}

#[test]
fn few_and_equal_items() {
    let same = [3.0, -1.0].repeat(50);
    for k in [1, 2, 49, 50, 51, 1 << 40] {
        let all = found(&same, 2, k, &fine());
        assert_eq!((all.answer.radius, all.answer.lower_bound), (0.0, 0.0), "k = {k}");
        assert_eq!(all.answer.centers, [[3.0, -1.0]]);
        assert_eq!(all.certificate.gap, 0.0);
    }
    let three = [0.0, 0.0, 2.0, 0.0, 9.0, 9.0];
    assert_eq!(found(&three, 2, 3, &fine()).answer.radius, 0.0);
    let two = found(&three, 2, 2, &fine());
    assert_eq!((two.answer.radius, two.trace.stop), (1.0, Stop::Converged));
    assert_eq!(two.certificate.proof, LowerBound::Separated);
    // One more may be left out: it is the far one, or nothing has to be.
    let options = CentersOptions { outliers: 1, ..fine() };
    let one = found(&three, 2, 1, &options);
    assert_eq!((one.answer.radius, &one.answer.outliers[..]), (1.0, &[2][..]));
    assert_eq!(found(&three, 2, 2, &options).answer.radius, 0.0);
    assert_eq!(found(&same, 2, 1, &options).answer.outliers, [0u64; 0]);
}

/// Eleven points at equal distances on a line: k intervals of ⌈11/k⌉ points.
#[test]
fn points_on_a_line() {
    for direction in [[1.0, 0.0], [3.0, 4.0], [1e5, -7.0]] {
        let unit = f64::hypot(direction[0], direction[1]);
        let values: Vec<f64> =
            (0..11).flat_map(|i| direction.map(|x| f64::from(i) * x + 5.0)).collect();
        for k in 1..=11usize {
            let wanted = (11usize.div_ceil(k) - 1) as f64 / 2.0 * unit;
            let radius = found(&values, 2, k, &fine()).answer.radius;
            assert!(
                (radius - wanted).abs() <= 1e-12 * wanted,
                "k = {k}: {radius} against {wanted}"
            );
        }
    }
}

#[test]
fn numbers_at_both_ends_of_the_range() {
    let square = [0.0, 0.0, 3.0, 4.0, 100.0, 0.0, 103.0, 4.0];
    for power in [-1060, -1022, -700, -300, 300, 700, 1000] {
        let half = 2f64.powi(power / 2);
        let factor = half * 2f64.powi(power - power / 2);
        let values: Vec<f64> =
            square.iter().map(|v| v * half * 2f64.powi(power - power / 2)).collect();
        let answer = checked(&values, 2, 2, &fine()).answer;
        assert_eq!(answer.radius, 2.5 * factor, "2^{power}");
        // One unit of the last place may be lost, which is much where numbers are subnormal.
        let lower = if power < -1000 { 2.499 } else { 2.499_999_9 };
        assert!(answer.lower_bound >= lower * factor, "2^{power}");
    }
    // So small beside so large that no one scale holds both: refused, where a radius of 0 would be a lie.
    let values = [1e300, 0.0, 3e-300, 4e-300, 0.0, 0.0];
    let points = Points::new(&values, 2).unwrap();
    assert!(matches!(centers(&points, 2, &fine()), Err(Error::Overflow)));
}

#[test]
fn a_budget_of_nodes_leaves_a_proof() {
    let values: Vec<f64> = generate(Distribution::Uniform, 2000, 2, 8).unwrap();
    let mut gaps = vec![];
    for max_nodes in [0, 30, 1000, 100_000] {
        for method in [CentersMethod::Tree, CentersMethod::Thesis] {
            let options = CentersOptions { epsilon: 1e-6, max_nodes, method, ..Default::default() };
            let found = checked(&values, 2, 7, &options);
            assert!(found.trace.iterations <= max_nodes);
            assert!(found.certificate.gap <= 1.0 + 1e-9, "{}", found.certificate.gap);
            let is_done = found.certificate.gap <= 1e-6;
            let wanted = if is_done { Stop::Converged } else { Stop::NodeBudget };
            assert_eq!(found.trace.stop, wanted, "{method} after {max_nodes} nodes");
            if method == CentersMethod::Tree {
                gaps.push(found.certificate.gap);
            }
        }
    }
    assert!(gaps.is_sorted_by(|a, b| a >= b) && gaps[3] <= 1e-6, "{gaps:?}");
}

/// The tree is written down; the judge follows it to its end, and so does the checker.
#[test]
fn logs_are_followed() {
    for (n, z) in [(30, 0), (60, 0), (60, 1)] {
        let values: Vec<f64> = generate(Distribution::Uniform, n, 2, 5).unwrap();
        let options = CentersOptions { outliers: z, ..fine() };
        let found = found(&values, 2, 9, &options);
        let (LowerBound::Branches { items } | LowerBound::Avoiding { items, .. }) =
            &found.certificate.proof
        else {
            panic!("no log for {n} points: {:?}", found.certificate.proof)
        };
        assert!(items.len() > 3, "{} nodes", items.len());
    }
}

/// Corners of a triangle around a point of weight 3, which draws the center to itself.
#[test]
fn a_weight_draws_the_center() {
    let rows = [0.0, 0.0, 3.0, 4.0, 0.0, 1.0];
    let options = CentersOptions { weights: true, ..fine() };
    let points = Points::new(&rows, 3).unwrap();
    let found = centers(&points, 1, &options).unwrap();
    assert!((found.answer.radius - 3.0).abs() <= 1e-12);
    assert!((found.answer.centers[0][0] - 1.0).abs() <= 1e-9);
    judge(&rows, 3, 1, &options, &found).unwrap();
    is_confirmed(&found, &points);
}

#[test]
fn wrong_input_is_named() {
    let points = Points::new(&[0.0, 1.0, 2.0, -3.0], 2).unwrap();
    let option = |options: CentersOptions<'_>, k: usize| match centers(&points, k, &options) {
        Err(Error::Input(InputError::Option { name, .. })) => name,
        other => panic!("{other:?}"),
    };
    let plain = CentersOptions::default();
    assert_eq!(option(plain, 0), "k");
    for epsilon in [-1e-3, 1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(option(CentersOptions { epsilon, ..plain }, 1), "epsilon");
    }
    assert_eq!(option(CentersOptions { threads: Some(0), ..plain }, 1), "threads");
    assert_eq!(option(CentersOptions { outliers: 2, ..plain }, 1), "outliers");
    let thesis = CentersOptions { method: CentersMethod::Thesis, ..plain };
    assert_eq!(option(CentersOptions { outliers: 1, ..thesis }, 1), "outliers");
    assert_eq!(option(CentersOptions { weights: true, ..thesis }, 1), "weights");
    assert_eq!(option(CentersOptions { placement: Placement::Rows, ..thesis }, 1), "placement");

    let stream =
        CentersOptions { method: CentersMethod::Stream(StreamingOptions::DEFAULT), ..plain };
    assert_eq!(option(CentersOptions { outliers: 1, ..stream }, 1), "outliers");
    assert_eq!(option(CentersOptions { weights: true, ..stream }, 1), "weights");
    assert_eq!(option(CentersOptions { assignment: true, ..stream }, 1), "assignment");
    for other in [thesis, stream] {
        assert_eq!(option(CentersOptions { inputs: Items::Ellipsoids, ..other }, 1), "method");
    }
    let of_balls = centers(&points, 1, &CentersOptions { inputs: Items::Balls, ..stream });
    assert!(matches!(of_balls, Err(Error::Input(InputError::Option { name: "method", .. }))));

    let weights = CentersOptions { weights: true, ..plain };
    assert!(matches!(
        centers(&points, 1, &weights),
        Err(Error::NonPositiveWeight { row: 1, value: -3.0 })
    ));
    assert!(matches!(
        centers(&points, 1, &CentersOptions { inputs: Items::Balls, ..plain }),
        Err(Error::NegativeRadius { row: 1, value: -3.0 })
    ));
    let narrow = Points::new(&[1.0, 2.0], 1).unwrap();
    assert!(matches!(centers(&narrow, 1, &weights), Err(Error::NoWeight { columns: 1 })));
    assert!(matches!(
        centers(&narrow, 1, &CentersOptions { inputs: Items::Balls, ..plain }),
        Err(Error::NoRadius { columns: 1 })
    ));
    let none = Points::new(&[0.0; 0], 2).unwrap();
    assert!(matches!(centers(&none, 1, &plain), Err(Error::Empty)));
    let odd = [0.0, 1.0, f64::NAN, 1.0];
    let odd = Points::new(&odd, 2).unwrap();
    assert!(matches!(
        centers(&odd, 1, &plain),
        Err(Error::Input(InputError::NonFinite { row: 1, column: 0, .. }))
    ));
}

/// The optima of 15,112 German cities and 13,509 of the USA, where `TAUT_DATA` names the folder that holds `ball/`.
#[test]
fn cities_have_their_optima() {
    let germany = [
        (2, 9342.60196519),
        (3, 8139.66296907),
        (4, 6573.74826488),
        (5, 5818.46791619),
        (6, 5036.37019102),
        (8, 4306.44830458),
    ];
    let usa = [(3, 132531.6719), (5, 99986.80259875)];
    for (name, wanted) in [("d15112.tsp.xz", &germany[..]), ("usa13509.xy.xz", &usa[..])] {
        let Some(values) = cities(name) else { return };
        for &(k, wanted) in wanted {
            let options = CentersOptions { epsilon: 1e-6, ..Default::default() };
            // The judge of these tests has no speed to speak of.
            let found = match k {
                ..=4 => found(&values, 2, k, &options),
                _ => checked(&values, 2, k, &options),
            };
            let radius = found.answer.radius;
            assert!((radius - wanted).abs() <= 1e-6 * wanted, "{name}, k = {k}: {radius}");
            assert!(found.certificate.gap <= 1e-6);
            assert!(
                found.certificate.core_set.len() <= 200,
                "{}",
                found.certificate.core_set.len()
            );
        }
    }
}

fn cities(name: &str) -> Option<Vec<f64>> {
    let Some(folder) = std::env::var_os("TAUT_DATA").map(std::path::PathBuf::from) else {
        println!("skipped cities_have_their_optima: TAUT_DATA is not set");
        return None;
    };
    let file = std::fs::File::open(folder.join("ball").join(name)).expect("the file is there");
    let text = std::io::read_to_string(liblzma::read::XzDecoder::new(file)).expect("it is xz");
    // The header of a tsp file has words in its lines, and its rows begin with a number of the city.
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() >= 2);
    Some(rows.flat_map(|row| row[row.len() - 2..].to_vec()).collect())
}
