//! Ellipsoids around points, balls and ellipsoids.

use taut::enclose::EllipsoidMethod;
use taut::{EllipsoidOptions, Items, Monitor, ellipsoid_of_items};

use super::{Case, Input, Solved, ball, cases, clouds, document, hand};

/// Returns the cases of the minimum-volume enclosing ellipsoid.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(1, 5), (2, 12), (3, 10), (5, 10)] {
        found.extend(around(clouds::points(dim, count), dim, Items::Points));
    }
    for dim in 2..=3 {
        found.extend(around(ball::balls(dim), dim, Items::Balls));
        let shapes = ball::ellipsoids(dim);
        let single: Vec<Input> = shapes.iter().map(Input::single).collect();
        found.extend(around(shapes, dim, Items::Ellipsoids));
        found.extend(around(single, dim, Items::Ellipsoids));
    }
    found
}

fn around(inputs: Vec<Input>, dim: usize, items: Items) -> Vec<Case> {
    let mut found = cases(inputs, |input| solve(input, items));
    let word = match items {
        Items::Points => "points",
        Items::Balls => "balls",
        Items::Ellipsoids => "ellipsoids",
    };
    for case in &mut found {
        case.foreign.extend(hand::flat_ellipsoids(&case.input, dim, word));
    }
    found
}

fn solve(input: &Input, items: Items) -> Vec<Solved> {
    let base = EllipsoidOptions::default();
    let ways = [
        ("exact", EllipsoidOptions { epsilon: 0.0, ..base.clone() }),
        ("1e-3", EllipsoidOptions { epsilon: 1e-3, ..base.clone() }),
        (
            "few passes",
            EllipsoidOptions {
                method: EllipsoidMethod::ThesisKhachiyan,
                epsilon: 0.5,
                ..base.clone()
            },
        ),
        ("initial", EllipsoidOptions { method: EllipsoidMethod::ThesisInitial, ..base.clone() }),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let monitor = Monitor::silent();
            let found = input.with(|source| ellipsoid_of_items(source, items, &options, &monitor));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
