//! The bunny with noise: the pre-pass beside an interpolation of the noise.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_reconstruct::{Denoise, SurfaceOptions};

use super::distances::Distances;
use super::found::{Way, ours, theirs};
use super::judged::Judged;
use super::models::BUNNY;
use super::samples::noisy;
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// Standard deviation of each coordinate over the diagonal of the bunny.
const SIGMA: f64 = 1e-3;

/// Means of distances and topology, with and without the pre-pass.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let Some(shape) = BUNNY.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
    let corner = |pick: fn(f64, f64) -> f64, k: usize| {
        shape.vertices.iter().map(|point| point[k]).reduce(pick).unwrap_or(0.0)
    };
    let sides = [0, 1, 2].map(|k| corner(f64::max, k) - corner(f64::min, k));
    let deviation = SIGMA * sides.iter().map(|side| side * side).sum::<f64>().sqrt();
    let head = ["seed", "program", "components", "genus", "loops", "χ"];
    let mut table = Table::new(&[&head[..], &Distances::HEAD, &[""]].concat());
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let mut pairs = vec![];
    for seed in seeds {
        let points = noisy(&shape.vertices, deviation, seed)?;
        let mut row = |who: &str, judged: Judged, distances: Distances| {
            let topology = &judged.cells()[..3];
            let who_and_seed = [seed.to_string(), who.to_owned()];
            let euler = [judged.euler.to_string()];
            let said = [String::new()];
            table.push([&who_and_seed, topology, &euler, &distances.cells(), &said].concat());
            report.push(json!({
                "seed": seed, "program": who, "judged": judged, "distances": distances,
            }));
        };
        let mut taut = |who: &str, denoise: Option<Denoise>| -> Result<(Judged, Distances)> {
            let threads = Some(context.threads[0]);
            let options = SurfaceOptions { denoise, threads, ..Default::default() };
            let (found, _) = ours(&points, &options)?;
            let answer = &found.answer;
            let places = if answer.vertices.is_empty() { &points } else { &answer.vertices };
            let judged = Judged::of(places, &answer.triangles)?;
            let distances = Distances::of(&shape, places, &answer.triangles)?;
            row(who, judged, distances);
            Ok((judged, distances))
        };
        taut("taut, without", None)?;
        let ours = taut("taut, pre-pass", Some(Denoise::default()))?;
        let cgal = match theirs(context, Way::Front, &points)? {
            Ok(found) => {
                let distances = Distances::of(&shape, &points, &found.triangles)?;
                row(Way::Front.name(), Judged::of(&points, &found.triangles)?, distances);
                Some(distances)
            }
            Err(silence) => {
                let mut cells = vec![seed.to_string(), Way::Front.name().to_owned()];
                cells.resize(head.len() + Distances::HEAD.len(), String::new());
                cells.push(silence.to_string());
                table.push(cells);
                None
            }
        };
        pairs.push((seed, ours, cgal));
    }
    println!("{table}");
    for (seed, (judged, taut), cgal) in pairs {
        let missed = cgal.map(|cgal| taut.missed.mean / cgal.missed.mean);
        let invented = cgal.map(|cgal| taut.invented.mean / cgal.invented.mean);
        let bounds = (0.75, Some(0.6));
        let what = format!("seed {seed}: mean from reference to result over CGAL's");
        goals.at_most(&what, missed, bounds, times);
        let what = format!("seed {seed}: mean from result to reference over CGAL's");
        goals.at_most(&what, invented, bounds, times);
        let is_ball = (judged.components, judged.euler, judged.loops) == (1, 2, 0);
        let goal = format!("seed {seed}: one closed component with χ = 2");
        goals.must(
            goal,
            judged.cells()[..3].join("/") + &format!(", χ = {}", judged.euler),
            is_ball,
        );
    }
    Ok(json!({ "sigma": SIGMA, "rows": report, "goals": goals.json() }))
}
