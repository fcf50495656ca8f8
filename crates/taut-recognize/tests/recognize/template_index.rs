//! The index of templates finds what comparing with all templates finds.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use taut_recognize::Error;
use taut_recognize::template::{Index, Nearest, Template};

/// The answer by definition.
fn nearest_of_all(templates: &[Template], probe: &[f64], limit: f64) -> Option<Nearest> {
    let mut best: Option<Nearest> = None;
    for (place, template) in templates.iter().enumerate() {
        let distance = template.distance(probe).unwrap();
        if distance <= limit && best.is_none_or(|best| distance < best.distance) {
            best = Some(Nearest { place, distance });
        }
    }
    best
}

/// Compares without a limit, and with limits around the least distance.
fn check(templates: &[Template], probe: &[f64], name: &str) {
    let index = Index::new(templates).unwrap();
    assert_eq!(index.len(), templates.len());
    let expected = nearest_of_all(templates, probe, f64::INFINITY);
    assert_eq!(index.nearest(probe, f64::INFINITY).unwrap(), expected, "{name}");
    let Some(Nearest { distance, .. }) = expected else { return };
    for limit in [-1.0, 0.0, distance.next_down(), distance, distance.next_up(), 2.0 * distance] {
        let expected = nearest_of_all(templates, probe, limit);
        assert_eq!(index.nearest(probe, limit).unwrap(), expected, "{name}: limit {limit}");
    }
}

fn template(mean: Vec<f32>, scans: u32) -> Template {
    Template::from_parts(mean, scans).unwrap()
}

#[test]
fn any_numbers_of_templates_and_coordinates() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for count in [1, 2, 63, 64, 65, 300, 4000] {
        for dim in [1, 2, 3, 4, 5, 30, 61] {
            // Coordinates of different spread, as the leading ones of hands have more.
            let mut point = || -> Vec<f32> {
                (0..dim).map(|j| random.random_range(-1.0..1.0) * 30.0 / (j + 1) as f32).collect()
            };
            let means: Vec<Vec<f32>> = (0..count).map(|_| point()).collect();
            let templates: Vec<Template> =
                (1u32..).zip(&means).map(|(i, mean)| template(mean.clone(), 1 + i % 6)).collect();
            for trial in 0..6 {
                let probe: Vec<f64> = match trial {
                    // One of them, near one of them, anywhere, and beyond the box.
                    0 | 1 => means[count / 2].iter().map(|&x| f64::from(x)).collect(),
                    2 => means[count - 1].iter().map(|&x| f64::from(x) + 0.3).collect(),
                    3 => vec![1e3; dim],
                    4 => vec![-1e200; dim],
                    _ => point().into_iter().map(f64::from).collect(),
                };
                check(&templates, &probe, &format!("{count} × {dim}, trial {trial}"));
            }
        }
    }
}

#[test]
fn the_first_of_equal_ones_is_found() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    // A coarse grid: many copies, and many different points at one distance.
    let templates: Vec<Template> = (0..3000)
        .map(|_| template((0..3).map(|_| random.random_range(-2i8..=2).into()).collect(), 3))
        .collect();
    for trial in 0..60 {
        let probe: Vec<f64> =
            (0..3).map(|_| f64::from(random.random_range(-3i8..=3)) / 2.0).collect();
        check(&templates, &probe, &format!("trial {trial}"));
    }
    let same: Vec<Template> = (0..200).map(|_| template(vec![5.0, -5.0], 2)).collect();
    check(&same, &[5.0, -5.0], "copies of the probe");
    check(&same, &[4.0, 4.0], "copies");
    assert_eq!(
        Index::new(&same).unwrap().nearest(&[0.0, 0.0], 1e9).unwrap().map(|found| found.place),
        Some(0)
    );
}

#[test]
fn numbers_of_scans_decide_between_near_ones() {
    // The farther mean of fewer scans is nearer: its variance is larger.
    let templates = [template(vec![10.0], 100), template(vec![11.0], 1)];
    check(&templates, &[0.0], "weights");
    let found = Index::new(&templates).unwrap().nearest(&[0.0], f64::INFINITY).unwrap().unwrap();
    assert_eq!((found.place, found.distance), (1, 60.5));
}

#[test]
fn extreme_numbers_are_compared_by_their_distances() {
    for size in [f32::MIN_POSITIVE, 1e-30, 1e30, f32::MAX] {
        let templates: Vec<Template> =
            (0..130u8).map(|i| template(vec![size / 7.0 * f32::from(i % 7), size], 1)).collect();
        for probe in [[0.0, 0.0], [f64::from(size), f64::from(size)], [1e308, -1e308]] {
            check(&templates, &probe, &format!("{size:e} {probe:?}"));
        }
    }
    // One template far from all others stretches the box.
    let mut templates: Vec<Template> =
        (0..500u16).map(|i| template(vec![f32::from(i) * 1e-3, 1.0], 4)).collect();
    templates.push(template(vec![1e20, 1.0], 4));
    for probe in [[0.1234, 1.0], [0.4, 2.0], [1e20, 1.0]] {
        check(&templates, &probe, &format!("outlier, {probe:?}"));
    }
}

#[test]
fn what_is_no_number_is_refused() {
    let index = Index::new(&[template(vec![1.0, 2.0], 1)]).unwrap();
    for probe in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(matches!(index.nearest(&probe, 1.0), Err(Error::Input(_))));
    }
    assert!(matches!(index.nearest(&[0.0, 0.0], f64::NAN), Err(Error::Input(_))));
    let refused = index.nearest(&[0.0], 1.0);
    assert!(matches!(refused, Err(Error::Dimension { found: 1, expected: 2 })));
    for bad in [f32::NAN, f32::INFINITY] {
        assert!(matches!(Template::from_parts(vec![bad], 1), Err(Error::Overflow)));
        assert!(matches!(Index::from_parts(vec![bad], vec![1], 1), Err(Error::Overflow)));
    }
    assert!(
        Template::from_parts(vec![1.0], 0).is_err() && Template::from_parts(vec![], 1).is_err()
    );
    assert!(Index::from_parts(vec![1.0], vec![0], 1).is_err());
    assert!(Index::from_parts(vec![1.0, 2.0, 3.0], vec![1], 2).is_err());
    let mixed = [template(vec![1.0], 1), template(vec![1.0, 2.0], 1)];
    assert!(matches!(Index::new(&mixed), Err(Error::Dimension { found: 2, expected: 1 })));
    let none = Index::new(&[]).unwrap();
    assert!(none.is_empty() && none.nearest(&[1.0], 1.0).unwrap().is_none());
}
