//! Curves and tours through few points of the plane.

use taut::reconstruct::Ends;
use taut::{CurveMethod, CurveOptions, curve};

use super::{Case, Input, Solved, cases, clouds, document};

use crate::random::Random;
/// Returns the cases of curves.
pub fn all() -> Vec<Case> {
    let mut inputs = samples();
    inputs.extend(clouds::points(2, 9));
    cases(inputs, solve)
}

/// Samples of circles, of two of them, of an arc, of a square, with noise and with outliers.
fn samples() -> Vec<Input> {
    let mut random = Random::new("samples", 0);
    let circle = |n: usize, radius: f64, x: f64| -> Vec<f64> {
        (0..n)
            .map(|i| std::f64::consts::TAU * i as f64 / n as f64)
            .flat_map(|t| [x + radius * t.cos(), radius * t.sin()])
            .collect()
    };
    let one = circle(24, 1.0, 0.0);
    let arc = one[..26].to_vec();
    let noisy: Vec<f64> = circle(28, 1.0, 0.0).iter().map(|x| x + 0.02 * random.signed()).collect();
    let square: Vec<f64> = (0..20)
        .flat_map(|i| match (i / 5, f64::from(i % 5)) {
            (0, t) => [t, 0.0],
            (1, t) => [5.0, t],
            (2, t) => [5.0 - t, 5.0],
            (_, t) => [0.0, 5.0 - t],
        })
        .collect();
    vec![
        Input::new("a circle", one.clone(), 2),
        Input::new("two circles", [circle(14, 1.0, 0.0), circle(14, 1.0, 5.0)].concat(), 2),
        Input::new("circles within each other", [one.clone(), circle(12, 0.3, 0.1)].concat(), 2),
        Input::new("an arc", arc, 2),
        Input::new("a noisy circle", noisy, 2),
        Input::new("a square", square, 2),
        Input::new("a circle and outliers", [one.clone(), vec![4.0, 4.0, -3.0, 2.5]].concat(), 2),
        Input::new("a circle of 1e-150", one.iter().map(|x| x * 1e-150).collect(), 2),
    ]
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = CurveOptions::default();
    let with = |method| CurveOptions { method, ..base.clone() };
    let ways = [
        ("auto", base.clone()),
        ("auto with places", CurveOptions { places: true, ..base.clone() }),
        ("fit", with(CurveMethod::Fit)),
        ("crust", with(CurveMethod::Crust)),
        ("hnn-crust", with(CurveMethod::HnnCrust)),
        ("corners", with(CurveMethod::Corners)),
        ("tour", with(CurveMethod::Tour)),
        ("path", CurveOptions { ends: Ends::Open, ..with(CurveMethod::Tour) }),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found = input.with(|source| curve(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
