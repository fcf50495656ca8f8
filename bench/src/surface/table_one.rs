//! Table 1 of the thesis, its times beside ours, and the two inputs that it names as hard.

use std::f64::consts::PI;
use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_certify::SurfaceMethod;
use taut_reconstruct::SurfaceOptions;

use super::found::ours;
use super::judged::Judged;
use super::models::{BUNNY, cactus};
use super::samples::{Point, fist, pear, rings, saddles, spiral, wedge};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::{seconds, times};
use crate::table::Table;

/// A row of the table: its name, its points, and the seconds that it took then.
pub(super) const TABLE: [(&str, usize, f64); 11] = [
    ("Hands", 54_698, 58.0),
    ("Bunny", 35_947, 35.0),
    ("Lyria", 29_970, 45.0),
    ("Fist", 16_384, 30.0),
    ("Torso", 12_947, 392.0),
    ("Head", 12_770, 35.0),
    ("Hyper", 8_525, 20.0),
    ("Cat", 7_340, 12.0),
    ("Cactus", 3_337, 25.0),
    ("Pear", 891, 3.0),
    ("Epcot", 770, 1.0),
];

/// The points of a row, or what stands for them, with a word about it; `None` where there is neither.
pub(super) fn input(
    name: &str,
    count: usize,
    seed: u64,
) -> Result<Option<(Vec<Point>, &'static str)>> {
    Ok(match name {
        "Bunny" => BUNNY.read()?.map(|shape| (shape.vertices, "the same scan")),
        "Cactus" => cactus()?.map(|points| (points, "another version")),
        "Fist" => Some((fist(count / 4), "four fingers apart")),
        "Torso" => Some((rings(count), "rings of 64 points")),
        "Hyper" => Some((saddles(count, seed)?, "two saddles")),
        "Cat" => Some((wedge(PI / 6.0, 52), "a wedge of π/6")),
        "Pear" => Some((pear(count), "a pear by a formula")),
        "Epcot" => Some((spiral(count), "a sphere")),
        _ => None,
    })
}

/// The answer of a method, judged, and its least time in all rounds.
fn tried(context: &Context, method: SurfaceMethod, points: &[Point]) -> Result<(Judged, f64)> {
    let options =
        SurfaceOptions { method: method.into(), threads: Some(1), ..SurfaceOptions::default() };
    let (mut judged, mut least) = (None, f64::INFINITY);
    for _ in 0..context.runs {
        let (found, seconds) = ours(points, &options)?;
        judged.get_or_insert(Judged::of(points, &found.answer.triangles)?);
        least = least.min(seconds);
    }
    Ok((judged.ok_or_else(|| anyhow::anyhow!("no round"))?, least))
}

/// The table, then the wedges and rings.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let head = [
        "row",
        "then",
        "input",
        "points",
        "method",
        "time",
        "components",
        "genus",
        "loops",
        "unused",
    ];
    let mut table = Table::new(&head);
    let mut report = vec![];
    let mut trial = |row: &str, then: &str, what: &str, points: &[Point], method| -> Result<_> {
        let (judged, time) = tried(context, method, points)?;
        let [components, genus, loops, .., unused] = judged.cells();
        let head = [row, then, what, &points.len().to_string(), method.name(), &seconds(time)];
        table.push([&head.map(str::to_owned)[..], &[components, genus, loops, unused]].concat());
        report.push(json!({
            "row": row, "then": then, "input": what, "points": points.len(), "method": method.name(),
            "seconds": time, "judged": judged,
        }));
        Ok((judged, time / points.len() as f64))
    };
    let methods = [SurfaceMethod::Thesis, SurfaceMethod::Tree];
    let (mut bunny, mut torso, mut cat, mut missing) = ([None; 2], [None; 2], [None; 2], vec![]);
    for (name, count, then) in TABLE {
        let Some((points, what)) = input(name, count, seeds.start)? else {
            missing.push(name);
            continue;
        };
        for (method, which) in methods.into_iter().zip(0..) {
            let found = trial(name, &format!("{then:.0} s"), what, &points, method)?;
            match name {
                "Bunny" => bunny[which] = Some(found.1),
                "Torso" => torso[which] = Some(found.1),
                "Cat" => cat[which] = Some(found.0),
                _ => {}
            }
        }
    }
    let sharp = wedge(PI / 9.0, 52);
    let sharper = trial("–", "–", "a wedge of π/9", &sharp, SurfaceMethod::Tree)?.0;
    println!("One thread, the least of {} rounds\n\n{table}", context.runs);
    println!("without data and stand-in: {}\n", missing.join(", "));

    let mut goals = Goals::default();
    let exact = |judged: Option<Judged>| judged.map(|judged| judged.is_exact(1, 0));
    let word = |is: Option<bool>| {
        is.map_or("not measured", |is| if is { "exact" } else { "not exact" }).to_owned()
    };
    let goal = "thesis: the wedge of π/6 is not exact, as the thesis says".to_owned();
    goals.must(goal, word(exact(cat[0])), exact(cat[0]).map(|is| !is));
    goals.must("default: the wedge of π/6 exact".into(), word(exact(cat[1])), exact(cat[1]));
    let is_sharper = exact(Some(sharper));
    goals.must("default: the wedge of π/9 exact".into(), word(is_sharper), is_sharper);
    for (method, which) in methods.into_iter().zip(0..) {
        let ratio = torso[which].zip(bunny[which]).map(|(torso, bunny)| torso / bunny);
        let what = format!("{}: rings per point over bunny", method.name());
        goals.at_most(&what, ratio, (5.0, None), times);
    }
    Ok(json!({ "rows": report, "missing": missing, "goals": goals.json() }))
}
