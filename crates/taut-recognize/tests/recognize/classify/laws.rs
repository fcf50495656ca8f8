//! Laws that hold for any data.

use taut_points::Points;
use taut_recognize::classify::{
    Cells, Classifier, Covariance, Method, Preset, Rule, Scaling, Score, TrainOptions, Width, train,
};

use super::support::{Draws, Set, names, preset};

fn ball(width: Width, cells: Cells) -> Method {
    let rule = Rule::Ball { width, cells, nu: None, steps: None };
    Method { scaling: Scaling::None, whitening: false, rule }
}

#[test]
fn balls_of_one_point_each_are_the_nearest_neighbor() {
    let mut draws = Draws(5);
    let set = Set {
        values: (0..60).map(|_| 40.0 * draws.unit()).collect(),
        dim: 3,
        labels: (0..20).collect(),
        classes: names(20),
    };
    // Of the last width all kernel values but few vanish in double precision.
    for gamma in [1e-3, 1.0, 100.0] {
        for cells in [Cells::Voronoi, Cells::Power] {
            let model = set.train(ball(Width::Gamma { gamma }, cells));
            for _ in 0..200 {
                let x: Vec<f64> = (0..3).map(|_| 60.0 * draws.unit() - 10.0).collect();
                let square = |i: usize| -> f64 {
                    set.points().row(i).iter().zip(&x).map(|(a, b)| (a - b) * (a - b)).sum()
                };
                let nearest = (0..20).min_by(|&i, &j| square(i).total_cmp(&square(j))).unwrap();
                assert_eq!(model.best(&x).0, nearest, "γ = {gamma}, {cells}");
            }
        }
    }
}

#[test]
fn power_and_voronoi_agree_where_radii_are_equal() {
    let mut draws = Draws(6);
    // Integers, so that the second class is the first one shifted without rounding.
    let first: Vec<f64> = (0..24).map(|_| (draws.next() % 9) as f64).collect();
    let second = first.chunks_exact(2).flat_map(|p| [p[0] + 6.0, p[1] - 2.0]);
    let set = Set {
        values: first.iter().copied().chain(second).collect(),
        dim: 2,
        labels: (0..24).map(|i| i / 12).collect(),
        classes: names(2),
    };
    let width = Width::Gamma { gamma: 0.05 };
    let (power, voronoi) =
        (set.train(ball(width, Cells::Power)), set.train(ball(width, Cells::Voronoi)));
    for _ in 0..500 {
        let x = [16.0 * draws.unit(), 12.0 * draws.unit() - 2.0];
        assert_eq!(power.best(&x).0, voronoi.best(&x).0);
    }
}

#[test]
fn an_exact_ball_is_wholly_inside_itself_and_weights_are_on_the_simplex() {
    let set = Set::normal(3, 30, 4, 2.0, 7);
    for (nu, width) in [(None, 0.02), (None, 0.5), (Some(0.2), 0.1), (Some(0.5), 0.02)] {
        let rule = Rule::Ball {
            width: Width::Gamma { gamma: width },
            cells: Cells::Power,
            nu,
            steps: None,
        };
        let model = set.train(Method { rule, ..Method::default() });
        let json: serde_json::Value = serde_json::from_str(&model.to_json()).unwrap();
        let balls = json["model"]["learned"]["fitted"]["balls"]["balls"].as_array().unwrap();
        for ball in balls {
            let multipliers: Vec<f64> = ball["multipliers"]
                .as_array()
                .unwrap()
                .iter()
                .map(|l| l.as_f64().unwrap())
                .collect();
            assert!(multipliers.iter().all(|&l| l > 0.0));
            assert!((multipliers.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let (spread, radius) =
                (ball["spread"].as_f64().unwrap(), ball["squared_radius"].as_f64().unwrap());
            match nu {
                // The dual value is at most the primal one, by ε.
                None => assert!(spread <= radius && radius <= spread * (1.0 + 1e-6) + 1e-12),
                Some(nu) => {
                    assert!(multipliers.iter().all(|&l| l <= 1.0 / (nu * 30.0) + 1e-12));
                    assert!(multipliers.len() as f64 >= nu * 30.0);
                }
            }
        }
        let mut out = [Score::default(); 3];
        let mut outside = [0; 3];
        for (x, &label) in set.points().rows().zip(&set.labels) {
            model.scores(x, &mut out);
            // Rounding of the border, and what ε leaves open of it.
            outside[label as usize] += i32::from(out[label as usize].value < -4e-6);
        }
        assert!(outside.iter().all(|&count| f64::from(count) <= nu.unwrap_or(0.0) * 30.0));
    }
}

#[test]
fn order_and_copies_of_points_do_not_matter() {
    let set = Set::normal(3, 20, 3, 1.5, 8);
    let count = set.labels.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&i| (i * 37) % count);
    let turned = set.subset(&order);
    let doubled = set.subset(&(0..2 * count).map(|i| i % count).collect::<Vec<_>>());
    let test = Set::normal(3, 30, 3, 1.5, 9);
    let whole = |method: Method, epsilon| TrainOptions {
        candidates: vec![method],
        epsilon,
        ..Default::default()
    };
    let balls = Method {
        scaling: Scaling::Percent,
        ..ball(Width::ThetaSquared { theta: 60.0 }, Cells::Power)
    };
    let methods = [
        // |c − c*|² ≤ ε·R*², so that squared distances, of lengths up to 2, differ by at most 2·2·2·√ε; values of R² by ε.
        (balls, 1e-12, 8e-6, true),
        (Method { rule: Rule::NearestBox, ..Method::default() }, 1e-6, 1e-12, true),
        // Machines see the cost of a point twice; covariances have other degrees of freedom.
        (
            Method {
                rule: Rule::Svm { width: Width::Gamma { gamma: 0.3 }, cost: 2.0 },
                ..Method::default()
            },
            1e-10,
            1e-4,
            false,
        ),
        (
            Method {
                rule: Rule::Mahalanobis { covariance: Covariance::Thesis },
                ..Method::default()
            },
            1e-6,
            1e-9,
            false,
        ),
        (Method { rule: Rule::Plda, ..Method::default() }, 1e-6, 1e-9, false),
        (Method { whitening: true, ..ball(Width::Auto, Cells::Voronoi) }, 1e-12, 8e-6, false),
    ];
    for (method, epsilon, tolerance, copies) in methods {
        let base =
            train(set.labeled(), &whole(method, epsilon)).unwrap().predict(test.points()).unwrap();
        for other in [Some(&turned), copies.then_some(&doubled)].into_iter().flatten() {
            let model = train(other.labeled(), &whole(method, epsilon)).unwrap();
            for (x, y) in base.iter().zip(model.predict(test.points()).unwrap()) {
                for (a, b) in x.scores.iter().zip(&y.scores) {
                    assert!((a - b).abs() <= tolerance * (1.0 + a.abs()), "{method:?}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn predictions_depend_on_no_other_test_point() {
    let set = Set::normal(2, 40, 3, 1.0, 10);
    let test = Set::normal(2, 25, 3, 1.0, 11);
    let order: Vec<usize> = (0..50).map(|i| (i * 17) % 50).collect();
    for name in
        [Preset::Best, Preset::Committee, Preset::WhitenedBall, Preset::Plda, Preset::Thesis]
    {
        let model = train(set.labeled(), &preset(name)).unwrap();
        let all = model.predict(test.points()).unwrap();
        let turned = model.predict(test.subset(&order).points()).unwrap();
        for (k, &i) in order.iter().enumerate() {
            assert_eq!(turned[k], all[i]);
            let alone = Points::new(test.points().row(i), 3).unwrap();
            assert_eq!(model.predict(alone).unwrap()[0], all[i]);
        }
    }
}

#[test]
fn models_are_the_same_for_any_number_of_threads() {
    let set = Set::normal(3, 25, 4, 1.0, 12);
    for name in [Preset::Committee, Preset::Svdd, Preset::Plda, Preset::Thesis] {
        let of = |threads| {
            let mut options = preset(name);
            (options.threads, options.reject) = (Some(threads), Some(0.1));
            options.calibrate = true;
            train(set.labeled(), &options).unwrap().to_json()
        };
        let one = of(1);
        assert!(one == of(2) && one == of(8), "{name}");
    }
}

#[test]
fn each_method_learns_easy_classes() {
    let set = Set::normal(4, 20, 5, 6.0, 13);
    let test = {
        // The same centers come first from the same seed.
        let both = Set::normal(4, 40, 5, 6.0, 13);
        both.subset(&(80..160).collect::<Vec<_>>())
    };
    for name in Preset::ALL {
        let model = train(set.labeled(), &preset(name)).unwrap();
        let found = model.predict(test.points()).unwrap();
        for (found, &label) in found.iter().zip(&test.labels) {
            let best = found.scores.iter().copied().fold(f64::MIN, f64::max);
            assert_eq!(found.scores[label as usize], best, "{name}");
            assert!(name == Preset::Svdd || found.class == Some(label));
        }
    }
}
