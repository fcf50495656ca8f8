//! Table 1 of the thesis, its times beside ours, and the two inputs that it names as hard.

use super::*;
use taut_certify::SurfaceMethod;

/// A row of the table: its name, its points, and the seconds that it took then.
pub(crate) const TABLE: [(&str, usize, f64); 11] = [
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

/// The points of a row, or what stands for them, and a word about it.
pub(crate) type Input = (Vec<Point>, &'static str);

/// The input of a row; `None` where there is none.
pub(crate) fn input(name: &str, count: usize, seed: u64) -> Result<Option<Input>> {
    Ok(match name {
        "Bunny" => BUNNY.read()?.map(|shape| (shape.vertices, "the same scan")),
        "Cactus" => cactus()?.map(|points| (points, "another version")),
        "Fist" => Some((fist(count / 4), "four fingers apart")),
        "Torso" => Some((rings(count), "rings of 64 points")),
        "Hyper" => Some((saddles(count, seed)?, "two saddles")),
        "Cat" => Some((wedge(PI / 6.0, 52), "a wedge of π/6")),
        "Pear" => Some((pear(count), "a pear by a formula")),
        "Epcot" => Some((spiral(count), "a sphere")),
        "Hands" => Some((towers(25), "towers on a sheet with a border")),
        "Lyria" => Some((staircase(20), "stairs with a border")),
        "Head" => Some((cap(count), "three fourths of a sphere")),
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
    Ok((judged.context("no round")?, least))
}

/// The table as it is shown and written.
pub(crate) struct TableOne {
    pub(crate) rows: Vec<Value>,
    missing: Vec<&'static str>,
    /// What was found, with seconds per point, by row and method.
    found: Vec<(&'static str, SurfaceMethod, Judged, f64)>,
}

const METHODS: [SurfaceMethod; 2] = [SurfaceMethod::Thesis, SurfaceMethod::Tree];
/// A row that the thesis does not have.
const SHARPER: &str = "–";

impl TableOne {
    /// Solves all rows by both methods, and a sharper wedge by the default.
    pub(crate) fn run(context: &Context) -> Result<Self> {
        let mut table = TableOne { rows: vec![], missing: vec![], found: vec![] };
        for (name, count, then) in TABLE {
            let Some((points, what)) = input(name, count, context.seeds.start)? else {
                table.missing.push(name);
                continue;
            };
            for method in METHODS {
                table.add(context, [name, &format!("{then:.0} s"), what], &points, method)?;
            }
        }
        let sharp = wedge(PI / 9.0, 52);
        table.add(context, [SHARPER, "–", "a wedge of π/9"], &sharp, SurfaceMethod::Tree)?;
        Ok(table)
    }

    fn add(
        &mut self,
        context: &Context,
        [row, then, what]: [&str; 3],
        points: &[Point],
        method: SurfaceMethod,
    ) -> Result<()> {
        let (judged, time) = tried(context, method, points)?;
        let head = json!({
            "row": row, "thesis": then, "input": what, "points": points.len(), "method": method.name(), "seconds": time,
        });
        self.rows.push(joined([head, judged.cells()]));
        let name = TABLE.iter().map(|(name, ..)| *name).find(|name| *name == row);
        let each = time / points.len() as f64;
        self.found.push((name.unwrap_or(SHARPER), method, judged, each));
        Ok(())
    }

    fn of(&self, row: &str, method: SurfaceMethod) -> Option<(Judged, f64)> {
        let found = self.found.iter().find(|found| (found.0, found.1) == (row, method))?;
        Some((found.2, found.3))
    }
}

/// The table, then the wedges and rings.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let found = TableOne::run(context)?;
    let mut table = Table::new(
        "row | thesis | input | points | method | seconds:s | components | genus | loops | unused",
    );
    found.rows.iter().for_each(|row| table.push(row.clone()));
    out.table(&format!("One thread, the least of {} rounds", context.runs), table);
    if !found.missing.is_empty() {
        println!("without data and stand-in: {}\n", found.missing.join(", "));
    }
    out.keep("missing", json!(found.missing));
    for (row, method, should, goal) in [
        ("Cat", METHODS[0], false, "thesis: the wedge of π/6 is not exact, as the thesis says"),
        ("Cat", METHODS[1], true, "default: the wedge of π/6 exact"),
        (SHARPER, METHODS[1], true, "default: the wedge of π/9 exact"),
    ] {
        let is_exact = found.of(row, method).map(|(judged, _)| judged.is_exact(1, 0));
        let word = is_exact.map_or("not measured", |is| if is { "exact" } else { "not exact" });
        out.must(goal, word, is_exact.map(|is| is == should));
    }
    for method in METHODS {
        let [torso, bunny] = ["Torso", "Bunny"].map(|row| found.of(row, method));
        let ratio = torso.zip(bunny).map(|(torso, bunny)| torso.1 / bunny.1);
        let what = format!("{}: rings per point over bunny", method.name());
        out.at_most(what, ratio, 5.0, Unit::Times);
    }
    Ok(())
}
