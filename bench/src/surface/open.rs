//! Surfaces that end: one set of constants for scans, random sheets and what has one side only.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_certify::{Solution, Surface};
use taut_reconstruct::{SurfaceMethod, SurfaceMode, SurfaceOptions, looks_one_sided};

use super::distances::Distances;
use super::found::{Way, ours, theirs};
use super::judged::Judged;
use super::models::BUNNY;
use super::samples::{Point, band, hemisphere, sheets};
use crate::context::Context;
use crate::goals::Goals;
use crate::table::Table;

/// This many vertices of the bunny's mesh are used by no triangle.
const UNREFERENCED_VERTICES: usize = 1113;

/// Columns after the input.
const HEAD: [&str; 9] = [
    "input",
    "program",
    "components",
    "genus",
    "loops",
    "bad edges",
    "bad vertices",
    "unused",
    "one side",
];

/// The table of the section.
struct Rows<'a> {
    context: &'a Context,
    table: Table,
    report: Vec<Value>,
}

impl Rows<'_> {
    fn push(&mut self, input: &str, who: &str, judged: Judged, one_sided: Option<bool>) {
        let said = one_sided.map_or("", |is| if is { "yes" } else { "no" });
        let head = [input.to_owned(), who.to_owned()];
        self.table.push([&head[..], &judged.cells(), &[said.to_owned()]].concat());
        self.report.push(json!({
            "input": input, "program": who, "judged": judged, "one_sided": one_sided,
        }));
    }

    /// What taut finds; CGAL's surface stands beside it.
    fn add(&mut self, input: &str, points: &[Point]) -> Result<(Solution<Surface>, Judged)> {
        let threads = Some(self.context.threads[0]);
        let options = SurfaceOptions {
            method: SurfaceMethod::Tree(SurfaceMode::Open),
            threads,
            ..SurfaceOptions::default()
        };
        let (found, _) = ours(points, &options)?;
        let judged = Judged::of(points, &found.answer.triangles)?;
        self.push(input, "taut", judged, Some(looks_one_sided(&found)));
        let way = Way::Front;
        match theirs(self.context, way, points)? {
            Ok(found) => self.push(input, way.name(), Judged::of(points, &found.triangles)?, None),
            Err(silence) => {
                let mut cells = vec![input.to_owned(), way.name().to_owned(), silence.to_string()];
                cells.resize(HEAD.len(), String::new());
                self.table.push(cells);
            }
        }
        Ok((found, judged))
    }
}

/// What was found of the bunny.
struct Bunny {
    judged: Judged,
    distances: Distances,
    /// Points without a triangle that the answer names.
    named: usize,
}

impl Bunny {
    /// Of its mesh, where that is there.
    fn find(rows: &mut Rows<'_>) -> Result<Option<Self>> {
        let Some(shape) = BUNNY.read()? else { return Ok(None) };
        let (found, judged) = rows.add("bunny", &shape.vertices)?;
        let distances = Distances::of(&shape, &shape.vertices, &found.answer.triangles)?;
        let unused = &found.answer.unused;
        let named = unused.outliers.len() + unused.interior.len() + unused.unreferenced.len();
        Ok(Some(Bunny { judged, distances, named }))
    }

    fn judge(&self, goals: &mut Goals) {
        let Bunny { judged, distances, named } = self;
        let percent = |value: f64| format!("{:.2} %", 100.0 * value);
        let what = "bunny: largest distance of the result from the reference, of the diagonal,";
        goals.at_most(what, Some(distances.invented.hausdorff), (0.02, Some(0.013)), percent);
        let loops = judged.loops.to_string();
        goals.must("bunny: 2 to 8 loops".into(), loops.clone(), (2..=8).contains(&judged.loops));
        goals.aim("bunny: 4 to 6 loops".into(), loops, (4..=6).contains(&judged.loops));
        goals.must(
            "bunny: each point without a triangle is named".into(),
            format!(
                "{named} of {} (the mesh itself leaves out {UNREFERENCED_VERTICES})",
                judged.unused
            ),
            *named == judged.unused,
        );
    }
}

/// The bunny, then sheets of random points.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let scale = if context.quick { 10 } else { 1 };
    let mut rows = Rows { context, table: Table::new(&HEAD), report: vec![] };
    let bunny = Bunny::find(&mut rows)?;
    let mut judgements = vec![];
    for seed in seeds {
        let name = format!("hemisphere, seed {seed}");
        let (_, judged) = rows.add(&name, &hemisphere(20_000 / scale, seed)?)?;
        let shape = |judged: &Judged| (judged.components, judged.genus, judged.loops);
        let shown = |judged: &Judged| judged.cells()[..3].join("/");
        let goal = format!("{name}: one component, no handle, one loop");
        judgements.push((goal, shown(&judged), shape(&judged) == (1, Some(0), 1)));
        let name = format!("two sheets, seed {seed}");
        let (_, judged) = rows.add(&name, &sheets(5_000 / scale, 5.0, seed)?)?;
        let goal = format!("{name}: two components, two loops");
        judgements.push((goal, shown(&judged), shape(&judged) == (2, Some(0), 2)));
        for (what, turns) in [("Möbius band", 0.5), ("band with a whole turn", 1.0)] {
            let name = format!("{what}, seed {seed}");
            let (found, _) = rows.add(&name, &band(4_000, turns, seed)?)?;
            let is_told = looks_one_sided(&found);
            let should = turns < 1.0;
            let goal =
                format!("{name}: {} to have one side", if should { "said" } else { "not said" });
            let said = if is_told { "said" } else { "not said" };
            judgements.push((goal, said.to_owned(), is_told == should));
        }
    }
    println!("{}", rows.table);
    let mut goals = Goals::default();
    if let Some(bunny) = &bunny {
        bunny.judge(&mut goals);
    }
    for (goal, shown, is_met) in judgements {
        goals.must(goal, shown, is_met);
    }
    let bunny = bunny
        .map(|Bunny { distances, named, .. }| json!({ "distances": distances, "named": named }));
    Ok(json!({ "rows": rows.report, "bunny": bunny, "goals": goals.json() }))
}
