//! Open sets: thresholds, soft balls, probabilities, warnings.

use taut_recognize::classify::{
    Cells, Method, Preset, PresetOptions, Rule, Scaling, TrainOptions, Width, train,
};

use super::support::{Set, preset};

#[test]
fn svdd_leaves_at_most_the_share_outside_and_rejects_what_is_far() {
    let set = Set::normal(1, 200, 3, 0.0, 30);
    for nu in [0.01, 0.1, 0.3] {
        let given = PresetOptions { nu: Some(nu), ..Default::default() };
        let options = TrainOptions {
            candidates: Preset::Svdd.candidates(&given).unwrap(),
            ..Default::default()
        };
        let model = train(set.labeled(), &options).unwrap();
        assert_eq!(model.threshold(), Some(0.0));
        let found = model.predict(set.points()).unwrap();
        // A point of the border is off by ε.
        let outside = found.iter().filter(|p| p.scores[0] < -1e-5).count();
        assert!(outside as f64 <= nu * 200.0, "{outside}");
        let far = taut_points::Points::new(&[9.0, 9.0, 9.0], 3).unwrap();
        assert_eq!(model.predict(far).unwrap()[0].class, None);
        let center = taut_points::Points::new(&[0.0, 0.0, 0.0], 3).unwrap();
        assert_eq!(model.predict(center).unwrap()[0].class, Some(0));
    }
}

#[test]
fn a_threshold_rejects_about_its_share_and_all_that_is_unknown() {
    let both = Set::normal(16, 40, 4, 8.0, 31);
    let known = |from: usize, to: usize| {
        let places: Vec<usize> = (from..to).filter(|&i| both.labels[i] < 12).collect();
        let mut set = both.subset(&places);
        set.classes.truncate(12);
        set
    };
    let (set, test) = (known(0, 320), known(320, 640));
    let unknown = both.subset(&(0..640).filter(|&i| both.labels[i] >= 12).collect::<Vec<_>>());
    for name in [Preset::Plda, Preset::Mahalanobis, Preset::ThesisVerifier, Preset::WhitenedBall] {
        let options = TrainOptions { reject: Some(0.05), ..preset(name) };
        let model = train(set.labeled(), &options).unwrap();
        let rejected = |set: &Set| {
            let found = model.predict(set.points()).unwrap();
            found.iter().filter(|p| p.class.is_none()).count() as f64 / found.len() as f64
        };
        // 240 points: a share of 0.05 has a standard deviation of 0.014 here, and as much from the training; five of both.
        assert!(rejected(&test) < 0.05 + 5.0 * 0.02, "{name}: {}", rejected(&test));
        assert!(rejected(&unknown) > 0.8, "{name}: {}", rejected(&unknown));
    }
}

#[test]
fn fitted_probabilities_are_frequencies() {
    let set = Set::normal(2, 400, 2, 0.0, 32);
    // Two classes a standard deviation apart in one coordinate.
    let shift = |mut set: Set| {
        let rows = set.values.chunks_exact_mut(2).zip(&set.labels);
        rows.for_each(|(row, &label)| row[0] += 1.5 * f64::from(label));
        set
    };
    let (set, test) = (shift(set), shift(Set::normal(2, 2000, 2, 0.0, 33)));
    let options = TrainOptions { calibrate: true, ..preset(Preset::Mahalanobis) };
    let model = train(set.labeled(), &options).unwrap();
    let found = model.predict(test.points()).unwrap();
    for low in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let near: Vec<(f64, f64)> = found
            .iter()
            .zip(&test.labels)
            .map(|(p, &label)| (p.probabilities.as_ref().unwrap()[1], f64::from(label)))
            .filter(|pair| (pair.0 - low).abs() < 0.1)
            .collect();
        let mean =
            |of: fn(&(f64, f64)) -> f64| near.iter().map(of).sum::<f64>() / near.len() as f64;
        let (said, seen) = (mean(|pair| pair.0), mean(|pair| pair.1));
        // Some 500 points in each part: five standard deviations are 0.11.
        assert!(
            near.len() > 200 && (said - seen).abs() < 0.11,
            "{low}: {said} {seen} {}",
            near.len()
        );
    }
}

#[test]
fn a_degenerate_width_is_warned_of() {
    let set = Set::normal(2, 40, 30, 1.0, 34);
    let with = |width, scaling| {
        let rule = Rule::Ball { width, cells: Cells::Voronoi, nu: None, steps: None };
        set.train(Method { scaling, whitening: false, rule }).warnings()
    };
    // The printed width of the thesis: with features from 0 to 100 every point is alone.
    let warned = with(Width::Theta { theta: 125.0 }, Scaling::Percent);
    assert!(
        warned.len() == 1 && warned[0].contains("so narrow that each point is alone"),
        "{warned:?}"
    );
    assert!(with(Width::Gamma { gamma: 1e-9 }, Scaling::ZScore)[0].contains("so wide"));
    assert!(with(Width::Auto, Scaling::ZScore).is_empty());
}
