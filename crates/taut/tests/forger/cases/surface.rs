//! Surfaces through few points of space.

use serde_json::{Value, json};
use taut::reconstruct::thesis::ThesisOptions;
use taut::reconstruct::{HullOptions, SurfaceMode};
use taut::{SurfaceMethod, SurfaceOptions, surface};

use super::{Case, Input, Solved, cases, clouds, document};

use crate::random::Random;
/// Returns the cases of surfaces.
pub fn all() -> Vec<Case> {
    let mut inputs = samples();
    inputs.extend(clouds::points(3, 9));
    let mut found = cases(inputs, solve);
    for case in &mut found {
        let tight =
            case.own.iter().flat_map(|(way, document)| as_tight(&case.input, way, document));
        case.foreign.extend(tight);
    }
    found
}

/// The document with its surface said to be the alpha shape of a radius that its largest circle just has, or misses by a unit
/// or two in the last place: what rounding cannot tell.
fn as_tight(input: &Input, way: &str, document: &Value) -> Vec<(String, Value)> {
    let Some(mut radius) = largest_circle(input, document).filter(|radius| radius.is_finite())
    else {
        return vec![];
    };
    (0..3).for_each(|_| radius = radius.next_down());
    let mut found = vec![];
    for _ in 0..7 {
        let mut tight = document.clone();
        tight["certificate"]["mode"] = json!({ "alpha": { "radius": radius } });
        found.push((format!("{way}, no circle larger than {radius:e}"), tight));
        radius = radius.next_up();
    }
    found
}

/// The radius of the largest circle through the vertices of a triangle, as `f64` has it.
fn largest_circle(input: &Input, document: &Value) -> Option<f64> {
    let answer = &document["answer"];
    let moved = answer["vertices"].as_array();
    let place = |row: &Value| -> Option<[f64; 3]> {
        let row = row.as_u64()? as usize;
        Some(match moved {
            Some(places) => [0, 1, 2].map(|j| places[row][j].as_f64().unwrap_or(0.0)),
            None => [0, 1, 2].map(|j| input.values[3 * row + j]),
        })
    };
    let length = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
    let circle = |triangle: &Value| -> Option<f64> {
        let [a, b, c] = [place(&triangle[0])?, place(&triangle[1])?, place(&triangle[2])?];
        let edge = |from: [f64; 3], to: [f64; 3]| [0, 1, 2].map(|j| to[j] - from[j]);
        let (u, v, w) = (edge(a, b), edge(a, c), edge(b, c));
        // Unit vectors, as products of the edges themselves may leave the range.
        let (p, q) = (u.map(|x| x / length(u)), v.map(|x| x / length(v)));
        let sine = [0, 1, 2].map(|j| {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            p[k] * q[l] - p[l] * q[k]
        });
        Some(length(w) / length(sine) / 2.0)
    };
    let triangles = answer["triangles"].as_array()?;
    triangles
        .iter()
        .filter_map(circle)
        .fold(None, |most, r| Some(most.map_or(r, |m: f64| m.max(r))))
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
        ("open", with(SurfaceMethod::Tree(SurfaceMode::Open))),
        ("thesis", with(SurfaceMethod::Thesis(ThesisOptions::default()))),
        ("alpha", with(SurfaceMethod::Alpha(None))),
        ("hull", with(SurfaceMethod::Hull(HullOptions::default()))),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found = input.with(|source| surface(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
