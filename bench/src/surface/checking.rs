//! What it costs to check a surface, beside what it cost to find it: processor time, on as many threads.

use std::ops::Range;

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use taut_points::Points;
use taut_reconstruct::{SurfaceOptions, surface};

use super::models::{ANCHOR, BUNNY, DC, HORSE};
use super::samples::Point;
use super::solids::{Place, Solid, handles};
use crate::context::Context;
use crate::goals::Goals;
use crate::meter::Meter;
use crate::stats::{seconds, times};
use crate::table::Table;

/// What was measured on one input.
struct Checked {
    input: String,
    points: usize,
    triangles: usize,
    certified: bool,
    /// Processor seconds of the solver and of the checker, the least of all rounds.
    solve: f64,
    check: f64,
}

impl Checked {
    /// Solves and checks by turns.
    fn of(context: &Context, input: String, points: &[Point], runs: usize) -> Result<Self> {
        let threads = context.threads[0];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let options = SurfaceOptions { threads: Some(threads), ..SurfaceOptions::default() };
        let view = Points::new(points.as_flattened(), 3)?;
        let (mut solve, mut check) = (f64::INFINITY, f64::INFINITY);
        let (mut triangles, mut certified) = (0, false);
        for _ in 0..runs {
            let meter = Meter::start();
            let found = surface(&view, &options)?;
            solve = solve.min(meter.stop().cpu);
            let meter = Meter::start();
            let verdict = pool.install(|| found.check(&view));
            check = check.min(meter.stop().cpu);
            let verdict = verdict.with_context(|| input.clone())?;
            (triangles, certified) = (found.answer.triangles.len(), verdict.certified);
        }
        Ok(Checked { input, points: points.len(), triangles, certified, solve, check })
    }

    fn ratio(&self) -> f64 {
        self.check / self.solve
    }
}

/// Meshes, solids with flat faces in three places and two sizes, a million points of a smooth body.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let scale = if context.quick { 10 } else { 1 };
    let mut all = vec![];
    for model in [BUNNY, DC, ANCHOR, HORSE] {
        let Some(shape) = model.read()? else { continue };
        all.push(Checked::of(context, model.name.to_owned(), &shape.vertices, context.runs)?);
    }
    for solid in Solid::ALL {
        for place in Place::ALL {
            for count in [20_000 / scale, 80_000 / scale] {
                let points = solid.points(place, count, seeds.start)?;
                let input = format!("{}, {}, {count}", solid.name(), place.name());
                all.push(Checked::of(context, input, &points, context.runs)?);
            }
        }
    }
    // One round is enough: it is the size that is tried.
    let points = handles(1_000_000 / scale, seeds.start)?;
    all.push(Checked::of(context, format!("three handles, {}", points.len()), &points, 1)?);

    let mut table =
        Table::new(&["input", "points", "triangles", "certified", "solve", "check", "ratio"]);
    let mut goals = Goals::default();
    for one in &all {
        table.push(vec![
            one.input.clone(),
            one.points.to_string(),
            one.triangles.to_string(),
            if one.certified { "yes" } else { "NO" }.to_owned(),
            seconds(one.solve),
            seconds(one.check),
            times(one.ratio()),
        ]);
    }
    println!(
        "processor time on {} threads, the least of {} rounds\n\n{table}",
        context.threads[0], context.runs
    );
    for one in &all {
        let what = format!("{}: check over solve", one.input);
        goals.at_most(&what, Some(one.ratio()), (1.0, Some(0.5)), times);
    }
    let rows: Vec<Value> = all
        .iter()
        .map(|one| {
            json!({
                "input": one.input, "points": one.points, "triangles": one.triangles,
                "certified": one.certified, "solve": one.solve, "check": one.check,
            })
        })
        .collect();
    Ok(json!({ "rows": rows, "goals": goals.json() }))
}
