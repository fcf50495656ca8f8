//! Error rates against closed forms and brute force.

#[cfg(feature = "hand")]
mod hands;
mod protocol;

use taut_recognize::Error;
use taut_recognize::evaluate::{
    BootstrapOptions, Confusion, Identification, RateWarning, ScoreSet, TransactionRates,
    bootstrap_over_people, clopper_pearson, person_disjoint_folds, warnings,
};

/// Scores with many ties, by a fixed recipe.
fn scores(count: u32, factor: u32, shift: f64) -> Vec<f64> {
    (0..count).map(|i| f64::from((i * factor) % 23) / 4.0 + shift).collect()
}

#[test]
fn rates_are_counts_at_every_threshold() {
    let (genuine, impostor) = (scores(40, 7, 1.5), scores(90, 5, 0.0));
    let set = ScoreSet::new(genuine.clone(), impostor.clone()).unwrap();
    let det = set.det();
    for point in &det {
        let accepted = impostor.iter().filter(|&&s| s >= point.threshold).count();
        let rejected = genuine.iter().filter(|&&s| s < point.threshold).count();
        assert_eq!(point.fmr, accepted as f64 / 90.0);
        assert_eq!(point.fnmr, rejected as f64 / 40.0);
    }
    assert!(det.windows(2).all(|p| p[0].threshold < p[1].threshold));
    assert!(det.windows(2).all(|p| p[0].fmr >= p[1].fmr && p[0].fnmr <= p[1].fnmr));
    let (first, last) = (det[0], det[det.len() - 1]);
    assert_eq!((first.fmr, first.fnmr, last.fmr, last.fnmr), (1.0, 0.0, 0.0, 1.0));
    let at = set.at_fmr(0.1);
    assert!(at.fmr <= 0.1 && det.iter().all(|p| p.threshold >= at.threshold || p.fmr > 0.1));
    assert_eq!(set.at_fmr(-1.0), last);
}

#[test]
fn the_equal_error_rate_is_where_the_lines_cross() {
    let rate = |genuine: &[f64], impostor: &[f64]| {
        ScoreSet::new(genuine.to_vec(), impostor.to_vec()).unwrap().equal_error_rate()
    };
    assert_eq!(rate(&[2.0, 3.0], &[0.0, 1.0]), 0.0);
    assert_eq!(rate(&[0.0, 1.0], &[2.0, 3.0]), 1.0);
    assert_eq!(rate(&[1.0, 1.0], &[1.0, 1.0]), 0.5);
    // From (FMR, FNMR) = (2/3, 0) to (1/3, 1/2): FMR = 2/3 − t/3 = t/2 at t = 0.8.
    assert!((rate(&[1.0, 3.0], &[0.0, 1.0, 2.0]) - 0.4).abs() < 1e-15);
    // Uniform scores on [1, 3) and [0, 2): both rates are 1/4 at 1.5.
    let steps: Vec<f64> = (0..1000).map(|i| f64::from(i) / 500.0).collect();
    let shifted: Vec<f64> = steps.iter().map(|s| s + 1.0).collect();
    assert!((rate(&shifted, &steps) - 0.25).abs() <= 1e-3);
}

#[test]
fn the_cost_of_ratios_has_its_closed_forms() {
    let cost = |genuine: &[f64], impostor: &[f64]| {
        ScoreSet::new(genuine.to_vec(), impostor.to_vec()).unwrap().cllr()
    };
    assert!((cost(&[0.0; 3], &[0.0; 5]) - 1.0).abs() < 1e-15);
    assert!(cost(&[800.0], &[-800.0]) == 0.0);
    // log2(1 + 1/3) and log2(1 + 1/4), each for half.
    let expected = ((4f64 / 3.0).log2() + 1.25f64.log2()) / 2.0;
    assert!((cost(&[3f64.ln()], &[-(4f64.ln())]) - expected).abs() < 1e-15);
    assert!((cost(&[-1000.0], &[1000.0]) * std::f64::consts::LN_2 - 1000.0).abs() < 1e-9);
}

#[test]
fn missing_and_unordered_scores_are_refused() {
    let refused = ScoreSet::new(vec![], vec![1.0]).unwrap_err();
    assert!(matches!(refused, Error::NoScores { what: "genuine" }));
    let refused = ScoreSet::new(vec![1.0], vec![0.0, f64::NAN]).unwrap_err();
    assert!(matches!(refused, Error::ScoreNan { what: "impostor", index: 1 }));
    assert!(ScoreSet::new(vec![f64::INFINITY], vec![f64::NEG_INFINITY]).is_ok());
}

#[test]
fn transactions_count_failures_to_acquire() {
    let found = TransactionRates::new(0.02, 0.1, 0.05, 0.5).unwrap();
    assert!((found.far - 0.019).abs() < 1e-15 && (found.frr - 0.145).abs() < 1e-15);
    assert!((found.generalized_far - 0.0095).abs() < 1e-15);
    assert!((found.generalized_frr - 0.5725).abs() < 1e-15);
    assert!(
        TransactionRates::new(0.0, 0.0, 1.1, 0.0).unwrap_err().to_string().contains("`fta` is 1.1")
    );
    assert!(TransactionRates::new(f64::NAN, 0.0, 0.0, 0.0).is_err());
}

#[test]
fn the_positive_class_is_named() {
    let classes = ["malignant".to_owned(), "benign".to_owned()];
    let truth = [0, 0, 0, 1, 1, 1, 1];
    let found = [Some(0), Some(1), None, Some(1), Some(1), Some(0), Some(1)];
    let matrix = Confusion::new(&classes, &truth, &found).unwrap();
    assert_eq!(matrix.rows().collect::<Vec<_>>(), [[1, 1, 1], [1, 3, 0]]);
    assert_eq!((matrix.correct(), matrix.total()), (4, 7));
    assert_eq!(matrix.recalls(), [Some(1.0 / 3.0), Some(0.75)]);
    let malignant = matrix.positive("malignant").unwrap();
    assert_eq!((malignant.sensitivity(), malignant.specificity()), (Some(1.0 / 3.0), Some(0.75)));
    assert_eq!((malignant.precision(), malignant.f1()), (Some(0.5), Some(0.4)));
    // A rejected point is not found positive, whichever class that is.
    let benign = matrix.positive("benign").unwrap();
    assert_eq!((benign.sensitivity(), benign.specificity()), (Some(0.75), Some(2.0 / 3.0)));
    assert!(matrix.positive("ill").unwrap_err().to_string().contains("`positive` is ill"));
    let none = Confusion::new(&classes, &[], &[]).unwrap();
    assert_eq!((none.accuracy(), none.positive("benign").unwrap().f1()), (None, None));
    assert!(matches!(
        Confusion::new(&classes, &[0, 1], &[Some(1), Some(2)]),
        Err(Error::Label { row: 1, label: 2, classes: 2 })
    ));
    assert!(Confusion::new(&classes, &[0], &[]).is_err());
}

#[test]
fn identification_counts_ranks_and_names() {
    let scores = [
        0.9, 0.1, 0.2, // person 0, named
        0.3, 0.2, 0.1, // person 1, of rank 2
        0.5, 0.5, 0.5, // person 2: ties count against
        0.6, 0.0, 0.0, // unknown
        0.1, 0.0, 0.0, // unknown
    ];
    let found = Identification::new(3, &scores, &[Some(0), Some(1), Some(2), None, None]).unwrap();
    assert_eq!(found.identified_within(1), Some(1.0 / 3.0));
    assert_eq!(found.identified_within(2), Some(2.0 / 3.0));
    assert_eq!(found.identified_within(3), Some(1.0));
    let rates = found.open_set(0.4);
    assert_eq!(
        (rates.fpir, rates.fnir, rates.misnamed),
        (Some(0.5), Some(2.0 / 3.0), Some(1.0 / 3.0))
    );
    let rates = found.open_set(0.95);
    assert_eq!((rates.fpir, rates.fnir, rates.misnamed), (Some(0.0), Some(1.0), Some(0.0)));
    let closed = Identification::new(3, &scores[..3], &[Some(0)]).unwrap();
    assert_eq!(closed.open_set(0.0).fpir, None);
    assert!(Identification::new(3, &scores[..3], &[Some(3)]).is_err());
    assert!(Identification::new(0, &[], &[]).is_err());
    assert!(Identification::new(2, &scores[..3], &[None]).is_err());
}

#[test]
fn exact_intervals_have_their_closed_forms_and_cover() {
    for n in [1u64, 10, 100, 1_000_000] {
        let none = clopper_pearson(0, n, 0.95).unwrap();
        let expected = -(0.025f64.ln() / n as f64).exp_m1();
        assert!(none.low == 0.0 && (none.high / expected - 1.0).abs() < 1e-9, "{n}: {none:?}");
        let all = clopper_pearson(n, n, 0.95).unwrap();
        assert!(all.high == 1.0 && (all.low - (1.0 - expected)).abs() < 1e-9);
    }
    // Published values for 7 of 20.
    let found = clopper_pearson(7, 20, 0.95).unwrap();
    assert!(
        (found.low - 0.153909).abs() < 1e-6 && (found.high - 0.592189).abs() < 1e-6,
        "{found:?}"
    );
    // For any rate, the intervals of all outcomes that hold it have at least the probability asked for.
    for rate in [0.03f64, 0.2, 0.5, 0.81] {
        let n = 25u64;
        let mut covered = 0.0;
        for k in 0..=n {
            let found = clopper_pearson(k, n, 0.9).unwrap();
            if found.low <= rate && rate <= found.high {
                let choose: f64 = (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product();
                covered += choose * rate.powi(k as i32) * (1.0 - rate).powi((n - k) as i32);
            }
        }
        assert!(covered >= 0.9, "{rate}: {covered}");
    }
    assert!(clopper_pearson(3, 2, 0.95).is_err() && clopper_pearson(0, 0, 0.95).is_err());
    assert!(clopper_pearson(1, 2, 1.0).is_err());
}

#[test]
fn too_few_trials_are_warned_of() {
    assert_eq!(warnings(0, 300), Some(RateWarning::NoError { trials: 300, rate_max: 0.01 }));
    assert!(warnings(0, 300).unwrap().to_string().contains("up to 0.01 (rule of 3"));
    assert_eq!(warnings(0, 2), Some(RateWarning::NoError { trials: 2, rate_max: 1.0 }));
    assert!(warnings(29, 300).unwrap().to_string().contains("29 errors: 30 are needed"));
    assert_eq!(warnings(30, 300), None);
    assert_eq!(warnings(0, 0), Some(RateWarning::NoTrial));
}

#[test]
fn nobody_is_in_two_folds() {
    let people: Vec<u32> = (0..200).map(|i| (i * i) % 37).collect();
    let folds = person_disjoint_folds(&people, 5, 3);
    for (i, person) in people.iter().enumerate() {
        let same = people.iter().position(|other| other == person).unwrap();
        assert_eq!(folds[i], folds[same]);
    }
    let sizes: Vec<usize> = (0..5).map(|f| folds.iter().filter(|&&g| g == f).count()).collect();
    let most = (0..37).map(|p| people.iter().filter(|&&q| q == p).count()).max().unwrap();
    assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= most, "{sizes:?}");
    assert_eq!(folds, person_disjoint_folds(&people, 5, 3));
    assert_ne!(folds, person_disjoint_folds(&people, 5, 4));
    assert_eq!(person_disjoint_folds(&people, 0, 0), vec![0; 200]);
}

#[test]
fn the_bootstrap_draws_people_and_not_items() {
    // 20 people of 50 equal items each: the mean over people has the spread of 20 draws, not of 1000.
    let people: Vec<u32> = (0..1000).map(|i| i / 50).collect();
    let values: Vec<f64> = people.iter().map(|&p| f64::from(p % 2)).collect();
    let mean = |items: &[usize]| items.iter().map(|&i| values[i]).sum::<f64>() / items.len() as f64;
    let options = BootstrapOptions { replicates: 2000, ..Default::default() };
    let found = bootstrap_over_people(&people, &options, mean).unwrap();
    // The binomial distribution of 20 draws has 2.5 % up to 5 or 6, and 14 or 15.
    assert!((0.25..=0.3).contains(&found.low) && (0.7..=0.75).contains(&found.high), "{found:?}");
    let pool = |threads| taut_points::thread_pool(threads).unwrap();
    for threads in [1, 2, 8] {
        let again = pool(threads).install(|| bootstrap_over_people(&people, &options, mean));
        assert_eq!(again.unwrap(), found);
    }
    let other = BootstrapOptions { replicates: 50, seed: 1, ..options };
    assert!(bootstrap_over_people(&people, &other, mean).is_ok());
    assert!(bootstrap_over_people(&people[..50], &options, mean).is_err());
    assert!(bootstrap_over_people(&people, &options, |_| f64::NAN).is_err());
    let wrong = BootstrapOptions { replicates: 1, ..options };
    assert!(bootstrap_over_people(&people, &wrong, mean).is_err());
}
