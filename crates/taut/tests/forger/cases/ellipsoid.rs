//! Ellipsoids around points, balls and ellipsoids.

use taut::enclose::EllipsoidMethod;
use taut::{EllipsoidOptions, Items, Monitor, ellipsoid};

use super::{Case, Input, Solved, ball, cases, clouds, document, hand, some};
use crate::random::Random;
use crate::test_length::long_or;

/// Returns the cases of the minimum-volume enclosing ellipsoid.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(1, 5), (2, 12), (3, 10), (5, 10)] {
        let mut inputs = some(clouds::points(dim, count), dim);
        inputs.extend([1e-5, 1e-9].map(|width| skew(dim, count, width)));
        found.extend(around(inputs, dim, Items::Points));
    }
    for dim in 2..=3 {
        // The exact optima of shapes in space take half of the time of the attack.
        let step = if dim == 3 { long_or(1, 3) } else { 1 };
        let part = |inputs: Vec<Input>| inputs.into_iter().step_by(step).collect::<Vec<_>>();
        found.extend(around(part(ball::balls(dim)), dim, Items::Balls));
        let shapes = part(ball::ellipsoids(dim));
        let single: Vec<Input> = shapes.iter().map(Input::single).collect();
        found.extend(around(shapes, dim, Items::Ellipsoids));
        found.extend(around(single, dim, Items::Ellipsoids));
    }
    found
}

/// Points beside a line along no axis: in the frame of an ellipsoid around them coordinates cancel, and what they were rounded by
/// counts many times.
fn skew(dim: usize, count: usize, width: f64) -> Input {
    let mut random = Random::new("skew", dim as u64);
    let row = |i: usize| [3.0, -1.0, 0.5, 2.0, 7.0].map(|slope| (i as f64 - 3.3) * slope);
    let rows = (0..count).map(row);
    let values =
        rows.flat_map(|row| row.map(|x| x + width * random.signed()).into_iter().take(dim));
    let values = values.collect();
    Input::new(format!("{width:e} beside a line, d = {dim}"), values, dim)
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
        let leaning = case.own.iter().flat_map(|(way, document)| hand::leaning(way, document));
        case.foreign.extend(leaning);
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
            let found = input.with(|source| {
                ellipsoid(source, &EllipsoidOptions { inputs: items, monitor, ..options.clone() })
            });
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
