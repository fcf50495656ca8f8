//! Random splits of people with few samples each.

use taut_recognize::Error;
use taut_recognize::classify::{
    Classifier, Labeled, Method, Preset, PresetOptions, Scaling, Score, TrainOptions, train,
    train_with_background,
};
use taut_recognize::evaluate::{Attempt, Contender, ProtocolOptions, run_protocol};

/// Numbers in [−1, 1) of the generator SplitMix64.
fn draws(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Four features of people: one that tells them apart, one with noise common to a scan, and two that follow that noise.
fn samples(people: u32, scans: u32, noise: f64) -> Vec<(u32, Vec<f64>)> {
    let mut draw = draws(7);
    let mut all = vec![];
    for person in 0..people {
        // Evenly spaced, so that nobody is like another by chance; in two orders.
        let own = [0.7 * f64::from(person), 0.7 * f64::from(5 * person % people)];
        for _ in 0..scans {
            let common = 1.5 * draw();
            let features = [
                own[0] + noise * draw(),
                own[1] + common,
                common + noise * draw(),
                common * 2.0 + noise * draw(),
            ];
            all.push((person, features.to_vec()));
        }
    }
    all
}

fn attempts(samples: &[(u32, Vec<f64>)]) -> Vec<Attempt<'_>> {
    samples.iter().map(|(person, own)| Attempt { person: *person, features: Some(own) }).collect()
}

fn method(preset: Preset) -> Method {
    preset.candidates(&PresetOptions::default()).unwrap()[0]
}

fn contender(name: &str, columns: &[usize], preset: Preset) -> Contender {
    let (name, columns) = (name.to_owned(), columns.to_vec());
    Contender { name, columns, method: method(preset), verifier: None }
}

const TEST_PROTOCOL: ProtocolOptions<'static> = ProtocolOptions {
    training: vec![],
    splits: 6,
    folds: 3,
    far_max: 0.01,
    confidence: 0.95,
    replicates: 100,
    seed: 3,
    monitor: taut_points::Monitor::silent(),
};

fn short(training: &[usize]) -> ProtocolOptions<'static> {
    ProtocolOptions { training: training.to_vec(), ..TEST_PROTOCOL }
}

#[test]
fn people_who_differ_are_told_apart_and_equal_ones_by_chance() {
    let far = samples(12, 6, 0.001);
    let contenders =
        [contender("pooled", &[0], Preset::Mahalanobis), contender("box", &[0], Preset::Box)];
    let found = run_protocol(&attempts(&far), &contenders, &short(&[2, 3])).unwrap();
    assert_eq!((found.attempts, found.fta, found.rows.len()), (72, 0.0, 4));
    for row in &found.rows {
        for rates in [&row.seen, &row.unseen] {
            assert_eq!(rates.probes, 6 * 12 * (6 - row.training as u64));
            assert_eq!((rates.errors, rates.equal_error_rate, rates.at.fnmr), (0, 0.0, 0.0));
            // Without an error the interval is that of the different samples, and there is a warning.
            let expected = -(0.025f64.ln() / rates.samples as f64).exp_m1();
            assert!((rates.interval.high - expected).abs() < 1e-9 && rates.interval.low == 0.0);
            assert!(rates.warning.is_some() && rates.samples_wrong == 0);
        }
        let open = row.open.unwrap();
        assert!(open.fnir <= 0.2 && open.fpir <= 0.01, "{open:?}");
    }
    // The samples of all people have one distribution: one of 12 guesses is right.
    let mut same = samples(12, 6, 1.0);
    let mut draw = draws(1);
    same.iter_mut().for_each(|(_, own)| own.iter_mut().for_each(|x| *x = draw()));
    let found = run_protocol(&attempts(&same), &contenders[..1], &short(&[3])).unwrap();
    let rates = &found.rows[0].seen;
    assert!((0.8..=1.0).contains(&rates.error_rate()), "{}", rates.error_rate());
    assert!(rates.interval.low <= rates.error_rate() && rates.error_rate() <= rates.interval.high);
    assert!((0.35..=0.65).contains(&rates.equal_error_rate), "{}", rates.equal_error_rate);
    assert!(4 * rates.samples_wrong > 3 * rates.samples);
}

#[test]
fn the_covariance_within_people_makes_the_common_noise_harmless() {
    // The second feature of a person is hidden by noise that the third and fourth show.
    let all = samples(8, 8, 0.2);
    let contenders = [
        contender("pooled", &[1, 2, 3], Preset::Mahalanobis),
        contender("box", &[1, 2, 3], Preset::Box),
    ];
    let found = run_protocol(&attempts(&all), &contenders, &short(&[4])).unwrap();
    let [pooled, boxes] = [&found.rows[0], &found.rows[1]];
    let errors = [pooled, boxes].map(|row| [row.seen.errors, row.unseen.errors]);
    println!("{errors:?} of {}", pooled.seen.probes);
    // It is the same for people whom it was not learned from.
    for (pooled, boxes) in errors[0].into_iter().zip(errors[1]) {
        assert!(3 * pooled < 2 * boxes, "{errors:?}");
    }
    assert!(pooled.unseen.equal_error_rate < boxes.unseen.equal_error_rate);
}

#[test]
fn figures_do_not_depend_on_threads_and_splits_are_shared() {
    let all = samples(9, 5, 0.5);
    let contenders = [
        contender("plda", &[0, 1, 2, 3], Preset::Plda),
        Contender {
            verifier: Some(method(Preset::ThesisVerifier)),
            ..contender("ball", &[0, 1, 2, 3], Preset::Thesis)
        },
        contender("plda again", &[0, 1, 2, 3], Preset::Plda),
    ];
    let pool = |threads| taut_points::thread_pool(threads).unwrap();
    let run = |threads| {
        pool(threads).install(|| run_protocol(&attempts(&all), &contenders, &short(&[3])).unwrap())
    };
    let found = run(1);
    assert_eq!(found, run(2));
    assert_eq!(found, run(8));
    assert_eq!(found.rows[0].seen, found.rows[2].seen);
    let other = ProtocolOptions { seed: 4, ..short(&[3]) };
    assert_ne!(found, run_protocol(&attempts(&all), &contenders, &other).unwrap());
}

#[test]
fn failures_are_counted_and_not_left_out() {
    let all = samples(10, 5, 0.01);
    let mut tried = attempts(&all);
    // The first person never gives features, the second twice only.
    tried[..5].iter_mut().for_each(|attempt| attempt.features = None);
    tried[7..10].iter_mut().for_each(|attempt| attempt.features = None);
    let contenders = [contender("pooled", &[0, 1, 2, 3], Preset::Mahalanobis)];
    let found = run_protocol(&tried, &contenders, &short(&[3])).unwrap();
    let row = &found.rows[0];
    assert_eq!((found.fta, row.people), (8.0 / 50.0, 8));
    assert!((row.fte - 0.2).abs() < 1e-15);
    let expected = found.fta + row.seen.at.fnmr * (1.0 - found.fta);
    assert!((row.seen.transaction.frr - expected).abs() < 1e-15);
    assert!((row.seen.transaction.generalized_frr - (0.2 + 0.8 * expected)).abs() < 1e-15);
}

#[test]
fn samples_and_options_that_do_not_fit_are_refused() {
    let all = samples(6, 3, 0.1);
    let tried = attempts(&all);
    let contenders = [contender("box", &[0, 3], Preset::Box)];
    let refused = |options: ProtocolOptions<'_>, name: &str| {
        let error = run_protocol(&tried, &contenders, &options).unwrap_err().to_string();
        assert!(error.contains(&format!("`{name}`")), "{error}");
    };
    refused(short(&[]), "training");
    refused(short(&[0]), "training");
    refused(short(&[3]), "training");
    refused(short(&[4]), "folds");
    refused(ProtocolOptions { folds: 1, ..short(&[2]) }, "folds");
    refused(ProtocolOptions { folds: 4, ..short(&[2]) }, "folds");
    refused(ProtocolOptions { splits: 0, ..short(&[2]) }, "splits");
    refused(ProtocolOptions { far_max: 1.5, ..short(&[2]) }, "far_max");
    refused(ProtocolOptions { confidence: 1.0, ..short(&[2]) }, "confidence");
    refused(ProtocolOptions { replicates: 1, ..short(&[2]) }, "replicates");
    let wrong = [contender("box", &[4], Preset::Box)];
    assert!(run_protocol(&tried, &wrong, &short(&[2])).is_err());
    let mut other = tried.clone();
    other[3].features = Some(&[1.0]);
    assert!(matches!(
        run_protocol(&other, &contenders, &short(&[2])),
        Err(Error::Dimension { found: 1, expected: 4 })
    ));
    other[3].features = Some(&[1.0, f64::NAN, 0.0, 0.0]);
    assert!(run_protocol(&other, &contenders, &short(&[2])).is_err());
    assert!(run_protocol(&[], &contenders, &short(&[2])).is_err());
}

#[test]
fn what_classes_share_comes_from_the_background_alone() {
    let all = samples(8, 4, 0.3);
    let names: Vec<String> = (0..8).map(|i| format!("person {i}")).collect();
    let rows = |people: std::ops::Range<u32>| -> (Vec<f64>, Vec<u32>) {
        let chosen = || all.iter().filter(|row| people.contains(&row.0));
        (chosen().flat_map(|row| row.1.clone()).collect(), chosen().map(|row| row.0).collect())
    };
    let (values, labels) = rows(0..8);
    let (fewer, fewer_labels) = rows(0..5);
    let background = (values.clone(), labels.clone(), 8);
    let scores = |model: &taut_recognize::classify::Model| {
        let mut out = vec![Score::default(); Classifier::classes(model)];
        Classifier::scores(model, &[0.5, -1.0, 0.25, 2.0], &mut out);
        out
    };
    for preset in [
        Preset::Box,
        Preset::Thesis,
        Preset::WhitenedBall,
        Preset::Mahalanobis,
        Preset::ThesisVerifier,
        Preset::Plda,
    ] {
        let options = TrainOptions { candidates: vec![method(preset)], ..Default::default() };
        let data = |(values, labels, classes): &(Vec<f64>, Vec<u32>, usize)| {
            let points = taut_points::Points::new(values, 4).unwrap();
            let data = Labeled::new(points, labels, &names[..*classes]).unwrap();
            let background_points = taut_points::Points::new(&background.0, 4).unwrap();
            let shared = Labeled::new(background_points, &background.1, &names).unwrap();
            (train(data, &options).unwrap(), train_with_background(shared, data, &options).unwrap())
        };
        let (alone, same) = data(&background);
        // With itself as the background it is what training gives.
        assert_eq!(alone, same, "{preset}");
        // Fewer people change nothing about the others.
        let (alone, shared) = data(&(fewer.clone(), fewer_labels.clone(), 5));
        assert_eq!(scores(&shared), scores(&same)[..5], "{preset}");
        assert_ne!(scores(&alone), scores(&shared), "{preset}");
        // One sample of each person is enough.
        let single: Vec<f64> = values.chunks_exact(16).flat_map(|own| own[..4].to_vec()).collect();
        let numbers: Vec<u32> = (0..8).collect();
        assert_eq!(found_by_one(&single, &numbers, &names, &background, &options), 8, "{preset}");
    }
    let several = TrainOptions {
        candidates: vec![Method::default(), Method { scaling: Scaling::None, ..Method::default() }],
        ..Default::default()
    };
    let points = taut_points::Points::new(&values, 4).unwrap();
    let data = Labeled::new(points, &labels, &names).unwrap();
    assert!(train_with_background(data, data, &several).is_err());
    let rejecting = TrainOptions { reject: Some(0.1), ..Default::default() };
    assert!(train_with_background(data, data, &rejecting).is_err());
    let plane = taut_points::Points::new(&values, 2).unwrap();
    let twice: Vec<u32> = labels.iter().flat_map(|&label| [label; 2]).collect();
    let other = Labeled::new(plane, &twice, &names).unwrap();
    assert!(matches!(
        train_with_background(other, data, &TrainOptions::default()),
        Err(Error::Dimension { found: 2, expected: 4 })
    ));
}

/// The number of single samples that are assigned to their own person by a model of one sample each.
fn found_by_one(
    values: &[f64],
    labels: &[u32],
    names: &[String],
    (background, background_labels, _): &(Vec<f64>, Vec<u32>, usize),
    options: &TrainOptions<'_>,
) -> usize {
    let points = taut_points::Points::new(values, 4).unwrap();
    let data = Labeled::new(points, labels, names).unwrap();
    let shared = taut_points::Points::new(background, 4).unwrap();
    let shared = Labeled::new(shared, background_labels, names).unwrap();
    let model = train_with_background(shared, data, options).unwrap();
    let found = model.predict(points).unwrap();
    found.iter().zip(labels).filter(|(found, label)| found.class == Some(**label)).count()
}
