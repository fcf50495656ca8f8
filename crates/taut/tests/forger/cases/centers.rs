//! Few centers of few rows, which are points, balls or ellipsoids: anywhere or at rows, with outliers, weights and assignments.

use serde_json::{Value, json};
use taut::certify::Placement;
use taut::enclose::StreamingOptions;
use taut::{CentersMethod, CentersOptions, Items, Monitor, centers};

use super::{Case, Input, Solved, ball, cases, clouds, document, some};

use crate::random::Random;
/// Returns the cases of k centers.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(1, 6), (2, 8), (3, 7)] {
        let mut inputs = clouds::points(dim, count);
        inputs.truncate(if dim == 2 { inputs.len() } else { 4 });
        found.extend(cases(some(inputs, dim), |input| solve(input, Items::Points, false, None)));
    }
    found.extend(cases(weighted(), |input| solve(input, Items::Points, true, None)));
    found.extend(cases(balls(), |input| solve(input, Items::Balls, false, None)));
    // The last column, or the first: the others are coordinates, a radius or a weight.
    found.extend(cases(some(grouped(2), 0), |input| solve(input, Items::Points, false, Some(2))));
    found.extend(cases(some(grouped(0), 1), |input| solve(input, Items::Points, false, Some(0))));
    found.extend(cases(some(grouped(2), 1), |input| solve(input, Items::Balls, false, Some(2))));
    found.extend(cases(some(grouped(2), 0), |input| solve(input, Items::Points, true, Some(2))));
    for dim in 1..=3 {
        let inputs = some(ball::ellipsoids(dim), dim);
        found.extend(cases(inputs, |input| solve(input, Items::Ellipsoids, false, None)));
    }
    for case in &mut found {
        let roomy: Vec<_> = case
            .own
            .iter()
            .step_by(2)
            .filter_map(|(way, document)| with_room(way, document))
            .collect();
        case.own.extend(roomy);
    }
    found
}

/// A document that leaves rows out, with leave for two more and with no more than what that leaves true: a list of outliers
/// can be forged without being too long.
fn with_room(way: &str, document: &Value) -> Option<(String, Value)> {
    let most = document["certificate"]["outliers"].as_u64()?;
    let mut roomy = document.clone();
    if document["answer"]["outliers"].is_null() {
        // An empty list is not written down, and would not be forged.
        roomy["answer"]["outliers"] = json!([]);
    }
    roomy["certificate"]["outliers"] = json!(most + 2);
    roomy["certificate"]["gap"] = json!(f64::MAX);
    roomy["answer"]["lower_bound"] = json!(0.0);
    Some((format!("{way}, with leave for two more outliers"), roomy))
}

/// Returns rows of a point and a last number above 0.
fn rows(random: &mut Random, dim: usize, n: usize, last: &dyn Fn(&mut Random) -> f64) -> Vec<f64> {
    (0..n)
        .flat_map(|_| {
            let mut row: Vec<f64> = (0..dim).map(|_| random.signed() * 5.0).collect();
            row.push(last(random));
            row
        })
        .collect()
}

fn weighted() -> Vec<Input> {
    let mut random = Random::new("weighted", 0);
    let plain = rows(&mut random, 2, 7, &|random| 0.5 + 2.0 * random.unit());
    let whole = rows(&mut random, 2, 6, &|random| random.between(1, 4) as f64);
    let wide = rows(&mut random, 1, 6, &|random| 10f64.powi(random.between(-9, 9) as i32));
    vec![
        Input::new("weights", plain, 3),
        Input::new("whole weights", whole, 3),
        Input::new("weights of all sizes", wide, 2),
    ]
}

fn balls() -> Vec<Input> {
    let mut random = Random::new("balls to cover", 0);
    let plain = rows(&mut random, 2, 7, &|random| random.unit());
    let large = rows(&mut random, 2, 6, &|random| 6.0 * random.unit());
    let tiny: Vec<f64> = plain.iter().map(|x| x * 1e-300).collect();
    vec![
        Input::new("balls to cover", plain, 3),
        Input::new("large balls to cover", large, 3),
        Input::new("balls of 1e-300 to cover", tiny, 3),
    ]
}

/// Nine rows of three numbers above 0, of which this one is the group: groups of one to three rows, apart, nested, one as large as the
/// others together, copies of each other, and numbers of all sizes.
fn grouped(column: usize) -> Vec<Input> {
    let mut random = Random::new("groups", column as u64);
    let of = |name: &str, groups: [i32; 9], number: &mut dyn FnMut(i32, usize) -> f64| {
        let rows = (0..9).flat_map(|row| {
            let mut values = vec![number(groups[row], row), number(groups[row], row + 9)];
            values.insert(column, f64::from(groups[row]) - 1.0);
            values
        });
        Input::new(format!("{name}, column {column}"), rows.collect(), 3)
    };
    let places: Vec<f64> = (0..40).map(|_| 0.5 + 9.0 * random.unit()).collect();
    let shakes: Vec<f64> = (0..18).map(|_| random.unit()).collect();
    vec![
        of("groups apart", [0, 0, 0, 1, 1, 1, 2, 2, 3], &mut |group, at| {
            places[group as usize * 2 + at / 9] + shakes[at]
        }),
        of("groups that overlap", [0, 1, 2, 3, 0, 1, 2, 3, 4], &mut |_, at| 0.5 + 5.0 * shakes[at]),
        of("one large group", [0, 1, 2, 0, 1, 2, 0, 3, 4], &mut |group, at| {
            let size = if group == 0 { 9.0 } else { 1.0 };
            1.0 + size * shakes[at] + places[group as usize]
        }),
        of("copies of groups", [0, 0, 1, 1, 2, 2, 3, 3, 4], &mut |group, at| {
            f64::from(1 + group / 2 * 7 + (at % 2) as i32)
        }),
        of("groups of 1e-300", [0, 0, 1, 1, 2, 2, 3, 3, 4], &mut |group, at| {
            (places[group as usize] + shakes[at]) * 1e-300
        }),
    ]
}

fn solve(input: &Input, items: Items, weights: bool, group: Option<usize>) -> Vec<Solved> {
    let base = CentersOptions { epsilon: 1e-9, weights, group, ..Default::default() };
    let rows = CentersOptions { placement: Placement::Rows, ..base };
    let ways = [
        ("two", 2, base),
        ("three", 3, CentersOptions { assignment: true, ..base }),
        ("two, loosely", 2, CentersOptions { epsilon: 0.3, ..base }),
        ("two, without one", 2, CentersOptions { outliers: 1, ..base }),
        ("four, without two", 4, CentersOptions { outliers: 2, ..base }),
        ("two of the rows", 2, rows),
        ("one of the rows, without two", 1, CentersOptions { outliers: 2, ..rows }),
        ("two, one by one", 2, CentersOptions { method: CentersMethod::FarthestFirst, ..base }),
        (
            "two of a stream",
            2,
            CentersOptions { method: CentersMethod::Stream(StreamingOptions::DEFAULT), ..base },
        ),
    ];
    ways.into_iter()
        .map(|(way, k, options)| {
            let monitor = Monitor::silent();
            let found = input.with(|source| {
                centers(source, k, &CentersOptions { inputs: items, monitor, ..options })
            });
            (format!("{way} centers"), found.ok().map(|found| document(&found)))
        })
        .collect()
}
