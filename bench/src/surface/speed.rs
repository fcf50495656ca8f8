//! Times on four meshes beside CGAL's advancing front.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};

use super::models::{ANCHOR, BUNNY, DC, HORSE};
use super::timed::Timed;
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// Total and extraction, of each the ratio that must be reached and the one that is hoped for.
pub(super) fn run(context: &Context, _: Range<u64>) -> Result<Value> {
    let models = [BUNNY, DC, ANCHOR, HORSE];
    let mut table = Table::new(&[&["set", "points"][..], &Timed::HEAD, &[""]].concat());
    let mut rows = vec![];
    for model in &models[..if context.quick { 1 } else { models.len() }] {
        let Some(shape) = model.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
        let timed = Timed::by_turns(context, &shape.vertices)?;
        let mut cells = vec![model.name.to_owned(), shape.vertices.len().to_string()];
        cells.extend(timed.cells());
        cells.push(timed.silence.as_ref().map(ToString::to_string).unwrap_or_default());
        table.push(cells);
        rows.push((model.name, timed));
    }
    println!(
        "taut on {} threads, all else on one; the least of {} rounds\n\n{table}",
        context.threads[0], context.runs
    );
    let mut goals = Goals::default();
    for (name, timed) in &rows {
        let bounds = (0.40, Some(0.20));
        goals.at_most(&format!("{name}: total over CGAL's"), timed.total_ratio(), bounds, times);
        let bounds = (0.35, Some(0.15));
        let what = format!("{name}: extraction over CGAL's");
        goals.at_most(&what, timed.extraction_ratio(), bounds, times);
    }
    let rows: Vec<Value> =
        rows.iter().map(|(name, timed)| json!({ "set": name, "timed": timed.json() })).collect();
    Ok(json!({ "sets": rows, "goals": goals.json() }))
}
