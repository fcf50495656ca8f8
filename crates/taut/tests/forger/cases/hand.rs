//! Documents made by hand, of answers that no solver gives: flat ellipsoids around rows that may be anything, and such as lean.

use serde_json::{Value, json};

use super::Input;

/// Returns ellipsoids of dimension 0 and of dimension 1 along each axis, about one place, with hulls at several distances; the
/// factor of some leans out of the hull.
pub fn flat_ellipsoids(input: &Input, dim: usize, items: &str) -> Vec<(String, Value)> {
    let rows: Vec<&[f64]> = input.values.chunks_exact(input.columns).collect();
    let zeros = vec![0.0; dim];
    let multipliers = vec![1.0 / rows.len() as f64; rows.len()];
    let support: Vec<usize> = (0..rows.len()).collect();
    let directions: Vec<&[f64]> = if items == "points" { vec![] } else { vec![&zeros; rows.len()] };
    let mut found = vec![];
    for axis in [None].into_iter().chain((0..dim).map(Some)) {
        for (center, lean) in [(&zeros[..], 0.0), (&rows[0][..dim], 0.0), (&zeros[..], 0.5)] {
            let reach = axis.map_or(1.0, |axis| {
                let reaches = rows.iter().map(|row| (row[axis] - center[axis]).abs());
                reaches.fold(0.0f64, f64::max).min(f64::MAX)
            });
            let (factor, basis, log_volume) = match axis {
                None => (vec![], vec![], 0.0),
                Some(_) if reach == 0.0 => continue,
                Some(axis) => {
                    let along = |length: f64, lean: f64| {
                        let rest = lean * length;
                        let entry = |j| if j == axis { length } else { rest };
                        (0..dim).map(entry).collect::<Vec<f64>>()
                    };
                    let volume = (2.0 * reach).ln().min(709.0);
                    (vec![along(1.0 / reach, lean)], vec![along(1.0, 0.0)], volume)
                }
            };
            let square = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
            let matrix: Vec<Vec<f64>> =
                (0..dim).map(|j| (0..dim).map(|k| square(j, k).min(f64::MAX)).collect()).collect();
            for distance in [0.0, 1.0, f64::MAX] {
                let document = json!({
                    "schema": 1, "kind": "ellipsoid",
                    "answer": {
                        "center": center, "matrix": matrix, "factor": factor, "log_volume": log_volume,
                        "hull": { "basis": basis, "distance": distance },
                    },
                    "certificate": {
                        "items": items, "support": support, "multipliers": multipliers, "directions": directions,
                        "gap": 10.0, "points_hash": input.hash(),
                    },
                    "trace": {
                        "method": "by hand", "stop": "converged", "passes": 1, "iterations": 1, "core_set": 1,
                        "history": [],
                    },
                });
                found.push((format!("by hand along {axis:?}, {distance:e} off"), document));
            }
        }
    }
    found
}

/// Returns a flat ellipsoid with a factor that leans out of the hull, by a lot and by a little: the images of places in the hull
/// stay, and so does all that is said of them.
pub fn leaning(way: &str, document: &Value) -> Vec<(String, Value)> {
    let table = |rows: &Value| -> Option<Vec<Vec<f64>>> {
        let row = |row: &Value| row.as_array()?.iter().map(Value::as_f64).collect();
        rows.as_array()?.iter().map(row).collect()
    };
    let answer = &document["answer"];
    let (Some(factor), Some(basis)) = (table(&answer["factor"]), table(&answer["hull"]["basis"]))
    else {
        return vec![];
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let Some(dim) = factor.first().map(Vec::len) else { return vec![] };
    // What the hull leaves of the axis that leans farthest out of it.
    let off = |axis: usize| -> Vec<f64> {
        let mut rest = vec![0.0; dim];
        rest[axis] = 1.0;
        for row in &basis {
            let along = row[axis];
            rest.iter_mut().zip(row).for_each(|(rest, b)| *rest -= along * b);
        }
        rest
    };
    let farthest = |a: &Vec<f64>, b: &Vec<f64>| dot(a, a).total_cmp(&dot(b, b));
    let Some(normal) = (0..dim).map(off).max_by(farthest) else { return vec![] };
    let lean = |by: f64| {
        let mut leaning = factor.clone();
        for row in &mut leaning {
            let size = row.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            row.iter_mut().zip(&normal).for_each(|(f, n)| *f += by * size * n);
        }
        let square = |j: usize, k: usize| leaning.iter().map(|row| row[j] * row[k]).sum::<f64>();
        let matrix: Vec<Vec<f64>> =
            (0..dim).map(|j| (0..dim).map(|k| square(j.min(k), j.max(k))).collect()).collect();
        let is_finite = matrix.iter().flatten().all(|q| q.is_finite());
        let mut found = document.clone();
        found["answer"]["factor"] = json!(leaning);
        found["answer"]["matrix"] = json!(matrix);
        is_finite.then(|| (format!("{way}, leaning by {by:e}"), found))
    };
    [0.5, 1e-9, 1e-12].into_iter().filter_map(lean).collect()
}
