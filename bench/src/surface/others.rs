//! Ball pivoting and Poisson reconstruction beside taut: what they find, how far it is off, and how long they take.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_reconstruct::SurfaceOptions;

use super::distances::Distances;
use super::found::{Way, ours, theirs};
use super::judged::Judged;
use super::models::{BUNNY, DC};
use crate::context::Context;
use crate::stats::seconds;
use crate::table::Table;

/// Everybody, once, on two meshes.
pub(super) fn run(context: &Context, _: Range<u64>) -> Result<Value> {
    let head =
        ["set", "program", "components", "genus", "loops", "bad edges", "bad vertices", "unused"];
    let mut table = Table::new(&[&head[..], &Distances::HEAD, &["time", ""]].concat());
    let mut report = vec![];
    for model in &[BUNNY, DC][..if context.quick { 1 } else { 2 }] {
        let Some(shape) = model.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
        let points = &shape.vertices;
        let options = SurfaceOptions { threads: Some(1), ..SurfaceOptions::default() };
        let (found, time) = ours(points, &options)?;
        let mut row = |who: &str,
                       places: Option<&[_]>,
                       triangles: &[[u32; 3]],
                       time|
         -> Result<()> {
            let judged = Judged::of(places.unwrap_or(points), triangles)?;
            let distances = Distances::of(&shape, places.unwrap_or(points), triangles)?;
            let mut topology = judged.cells();
            if places.is_some() {
                // Its vertices are none of the points.
                topology[5] = "all".to_owned();
            }
            let head = [model.name.to_owned(), who.to_owned()];
            let tail = [seconds(time), String::new()];
            table.push([&head[..], &topology, &distances.cells(), &tail].concat());
            report.push(json!({
                "set": model.name, "program": who, "judged": judged, "distances": distances, "seconds": time,
                "interpolates": places.is_none(),
            }));
            Ok(())
        };
        row("taut", None, &found.answer.triangles, time)?;
        let mut silent = vec![];
        for way in Way::ALL {
            match theirs(context, way, points)? {
                Ok(found) => {
                    let time = found.first + found.second;
                    row(way.name(), found.places.as_deref(), &found.triangles, time)?;
                }
                Err(silence) => silent.push((way, silence)),
            }
        }
        for (way, silence) in silent {
            let mut cells = vec![model.name.to_owned(), way.name().to_owned()];
            cells.resize(head.len() + Distances::HEAD.len() + 1, String::new());
            cells.push(silence.to_string());
            table.push(cells);
        }
    }
    println!("One thread, once\n\n{table}");
    Ok(json!({ "rows": report }))
}
