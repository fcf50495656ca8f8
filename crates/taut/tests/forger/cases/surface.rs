//! Surfaces through few points of space.

use taut::{Monitor, SurfaceMethod, SurfaceMode, SurfaceOptions, surface_of_source};

use super::{Case, Input, Solved, cases, clouds, document};
use crate::random::Random;

/// Returns the cases of surfaces.
pub fn all() -> Vec<Case> {
    let mut inputs = samples();
    inputs.extend(clouds::points(3, 9));
    cases(inputs, solve)
}

/// Samples of a sphere, of two of them, of a cube, of a sheet, with rows that are in no triangle.
fn samples() -> Vec<Input> {
    let mut random = Random::new("surfaces", 0);
    let mut sphere = |n: usize, x: f64| -> Vec<f64> {
        (0..n)
            .flat_map(|i| {
                let z = 1.0 - (2 * i + 1) as f64 / n as f64;
                let (t, r) = (2.399_963_229_728_653 * i as f64, (1.0 - z * z).sqrt());
                [x + r * t.cos(), r * t.sin(), z + 1e-3 * random.signed()]
            })
            .collect()
    };
    let one = sphere(26, 0.0);
    let two = [sphere(14, 0.0), sphere(14, 4.0)].concat();
    let cube: Vec<f64> = (0..27)
        .filter(|&i| i != 13)
        .flat_map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from))
        .collect();
    let sheet: Vec<f64> = (0..25)
        .flat_map(|i| {
            let (x, y) = (f64::from(i % 5), f64::from(i / 5));
            [x, y, 0.1 * x * x - 0.07 * x * y]
        })
        .collect();
    vec![
        Input::new("a sphere", one.clone(), 3),
        Input::new("two spheres", two, 3),
        Input::new("a sphere and its middle", [one.clone(), vec![0.0, 0.0, 0.0]].concat(), 3),
        Input::new("a sphere with copies", [one.clone(), one[..6].to_vec()].concat(), 3),
        Input::new("a cube", cube, 3),
        Input::new("a sheet", sheet, 3),
        Input::new("a sphere of 1e-100", one.iter().map(|x| x * 1e-100).collect(), 3),
    ]
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = SurfaceOptions::default();
    let with = |method| SurfaceOptions { method, ..base.clone() };
    let ways = [
        ("tree", base.clone()),
        ("open", SurfaceOptions { mode: SurfaceMode::Open, ..base.clone() }),
        ("thesis", with(SurfaceMethod::Thesis)),
        ("alpha", with(SurfaceMethod::Alpha)),
        ("hull", with(SurfaceMethod::Hull)),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found =
                input.with(|source| surface_of_source(source, &options, &Monitor::silent()));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
