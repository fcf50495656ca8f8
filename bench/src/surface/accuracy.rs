//! How far the reference is from the result, over what it is from CGAL's advancing front.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_reconstruct::SurfaceOptions;

use super::distances::Distances;
use super::found::{Way, ours, theirs};
use super::models::SEVEN;
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// Sets where the peer is far off.
const SHARP_MODELS: [&str; 3] = ["daratech", "fandisk", "mechpart"];

/// Distances on the seven, and their ratios.
pub(super) fn run(context: &Context, _: Range<u64>) -> Result<Value> {
    let options = SurfaceOptions { threads: Some(context.threads[0]), ..Default::default() };
    let mut table = Table::new(&[&["set", "program"][..], &Distances::HEAD, &[""]].concat());
    let (mut report, mut ratios) = (vec![], vec![]);
    for model in &SEVEN[..if context.quick { 2 } else { SEVEN.len() }] {
        let Some(shape) = model.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
        let mut row = |who: &str, distances: Option<Distances>, said: String| {
            let cells = distances.map_or([(); 4].map(|()| String::new()), |found| found.cells());
            table.push([&[model.name.to_owned(), who.to_owned()][..], &cells, &[said]].concat());
            report.push(json!({ "set": model.name, "program": who, "distances": distances }));
        };
        let (found, _) = ours(&shape.vertices, &options)?;
        let taut = Distances::of(&shape, &shape.vertices, &found.answer.triangles)?;
        row("taut", Some(taut), String::new());
        let cgal = match theirs(context, Way::Front, &shape.vertices)? {
            Ok(found) => {
                let cgal = Distances::of(&shape, &shape.vertices, &found.triangles)?;
                row(Way::Front.name(), Some(cgal), String::new());
                Some(cgal)
            }
            Err(silence) => {
                row(Way::Front.name(), None, silence.to_string());
                None
            }
        };
        ratios.push((model.name, taut, cgal));
    }
    println!("{table}");
    let mut goals = Goals::default();
    for (name, taut, cgal) in ratios {
        let bound = if SHARP_MODELS.contains(&name) { 0.7 } else { 1.05 };
        let largest = cgal.map(|cgal| taut.missed.hausdorff / cgal.missed.hausdorff);
        let mean = cgal.map(|cgal| taut.missed.mean / cgal.missed.mean);
        goals.at_most(&format!("{name}: largest over CGAL's"), largest, (bound, None), times);
        goals.at_most(&format!("{name}: mean over CGAL's"), mean, (bound, None), times);
    }
    Ok(json!({ "rows": report, "goals": goals.json() }))
}
