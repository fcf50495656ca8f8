//! Documents made by hand, of answers that no solver gives: flat ellipsoids around rows that may be anything.

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
