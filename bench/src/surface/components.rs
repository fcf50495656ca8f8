//! Many bodies at once: linear in their number, and each of them found.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};

use super::one;
use super::samples::{Point, ellipsoids};
use super::timed::Timed;
use crate::context::Context;
use crate::delaunay::program::Build;
use crate::goals::Goals;
use crate::input::write_raw;
use crate::stats::{seconds, times};
use crate::table::Table;

/// taut on one thread on two inputs, by turns.
fn both(context: &Context, points: [&[Point]; 2]) -> Result<[Vec<Build>; 2]> {
    let mut builds = [vec![], vec![]];
    for round in 0..context.runs {
        for which in [round % 2, 1 - round % 2] {
            let file = context.temp.path().join("points.f64");
            write_raw(&file, points[which].as_flattened())?;
            builds[which].extend(one::alone(1, &file, context.limit)?.ok());
        }
    }
    Ok(builds)
}

/// The extraction of 300 beside CGAL's, then 1000 small ones beside a large one.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let (few, many) = if context.quick { (30, 100) } else { (300, 1000) };
    let points = ellipsoids(few, 100, seeds.start)?;
    let timed = Timed::by_turns(context, &points)?;
    let mut table = Table::new(&[&["bodies", "points"][..], &Timed::HEAD, &[""]].concat());
    let said = timed.silence.as_ref().map(ToString::to_string).unwrap_or_default();
    let head = vec![few.to_string(), points.len().to_string()];
    table.push([head, timed.cells(), vec![said]].concat());
    println!("{table}");

    let bodies = [(many, 100), (1, 100 * many)];
    let [small, large] = bodies.map(|(count, each)| ellipsoids(count, each, seeds.start));
    let [apart, whole] = both(context, [&small?, &large?])?;
    let mut table = Table::new(&["input", "points", "components", "bad", "unused", "one thread"]);
    let least = |builds: &[Build]| builds.iter().map(|build| build.wall).min_by(f64::total_cmp);
    let count = |build: &Build, name: &str| build.counters.get(name).copied().unwrap_or(0);
    for (what, builds) in [(format!("{many} of 100"), &apart), ("one".to_owned(), &whole)] {
        let Some(build) = builds.first() else { continue };
        let mut cells = vec![what, build.points.to_string()];
        cells.extend(["components", "bad", "unused"].map(|name| count(build, name).to_string()));
        cells.push(least(builds).map(seconds).unwrap_or_default());
        table.push(cells);
    }
    println!("{table}");

    let mut goals = Goals::default();
    // As it is called without other word, and then held to one thread, as CGAL's is.
    let threads = context.threads[0];
    for (on, ratio) in [
        (format!("{threads} threads"), timed.extraction_ratio_on_all()),
        ("one thread".to_owned(), timed.extraction_ratio()),
    ] {
        let factor = ratio.map(|ratio| 1.0 / ratio);
        let shown = factor.map_or("not measured".to_owned(), times);
        for (aim, bound) in [(false, 50.0), (true, 100.0)] {
            let goal = format!(
                "{few} components: CGAL's extraction at least {bound} times as long as taut's on {on}"
            );
            let met = factor.map(|factor| factor >= bound);
            if aim {
                goals.aim(goal, shown.clone(), met);
            } else {
                goals.must(goal, shown.clone(), met);
            }
        }
    }
    let found = apart.first().map(|build| count(build, "components"));
    goals.must(
        format!("exactly {many} components of 100 points"),
        found.map_or("not measured".to_owned(), |found| found.to_string()),
        found.map(|found| found == many as u64),
    );
    let ratio = least(&apart).zip(least(&whole)).map(|(apart, whole)| apart / whole);
    let what = format!("time of {many} components over that of one");
    goals.at_most(&what, ratio, (1.5, Some(1.1)), times);
    Ok(json!({ "few": timed.json(), "many": apart, "one": whole, "goals": goals.json() }))
}
