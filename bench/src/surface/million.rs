//! A million random points of dc.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};

use super::models::DC;
use super::one;
use super::samples::on_triangles;
use crate::context::Context;
use crate::delaunay::program::Build;
use crate::goals::Goals;
use crate::input::write_raw;
use crate::stats::seconds;
use crate::table::Table;

/// Topology, seconds and bytes. One round is enough: it is the size that is tried.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let n = if context.quick { 100_000 } else { 1_000_000 };
    let Some(shape) = DC.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
    let file = context.temp.path().join("points.f64");
    let head = ["seed", "components", "genus", "loops", "bad", "unused", "time", "B/point", ""];
    let mut table = Table::new(&head);
    let mut builds: Vec<Build> = vec![];
    for seed in seeds {
        write_raw(&file, on_triangles(&shape, n, seed)?.as_flattened())?;
        match one::alone(context.threads[0], &file, context.limit)? {
            Ok(build) => {
                let count = |name: &str| build.counters.get(name).map(ToString::to_string);
                let counts = ["components", "genus", "loops", "bad", "unused"].map(count);
                let mut cells = vec![seed.to_string()];
                cells.extend(counts.map(|count| count.unwrap_or("–".to_owned())));
                cells.push(seconds(build.wall));
                cells.push(bytes(&build).map(|bytes| format!("{bytes:.0}")).unwrap_or_default());
                cells.push(String::new());
                table.push(cells);
                builds.push(build);
            }
            Err(silence) => {
                let mut cells = vec![seed.to_string()];
                cells.resize(head.len() - 1, String::new());
                cells.push(silence.to_string());
                table.push(cells);
            }
        }
    }
    println!("n = {n}, {} threads\n\n{table}", context.threads[0]);
    let mut goals = Goals::default();
    let wanted = [("components", 1), ("genus", DC.genus), ("loops", 0), ("bad", 0)];
    let is_right =
        |build: &Build| wanted.iter().all(|(name, count)| build.counters.get(*name) == Some(count));
    let right = builds.iter().filter(|build| is_right(build)).count();
    let measured = (!builds.is_empty()).then_some(right == builds.len());
    let shown = format!("{right} of {}", builds.len());
    goals.must("one closed surface of genus 8".into(), shown, measured);
    let worst = |of: fn(&Build) -> Option<f64>| builds.iter().filter_map(of).max_by(f64::total_cmp);
    let wall = worst(|build| Some(build.wall));
    goals.at_most("time", wall, (5.0, Some(2.2)), seconds);
    let show = |value| format!("{value:.0}");
    goals.at_most("bytes per point", worst(bytes), (850.0, Some(500.0)), show);
    Ok(json!({ "n": n, "builds": builds, "goals": goals.json() }))
}

/// Bytes per point at the peak.
fn bytes(build: &Build) -> Option<f64> {
    build.peak.map(|peak| peak as f64 / build.points as f64)
}
