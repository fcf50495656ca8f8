//! Surfaces that end: one set of constants for scans, random sheets and what has one side only.

use super::*;

/// This many vertices of the bunny's mesh are used by no triangle.
const UNREFERENCED_VERTICES: usize = 1113;

/// The table of the section.
struct Rows<'a> {
    context: &'a Context,
    table: Table,
}

impl Rows<'_> {
    fn push(&mut self, input: &str, who: &str, judged: Judged, one_sided: Option<bool>) {
        let head = json!({ "input": input, "program": who, "one side": one_sided });
        self.table.push(joined([head, judged.cells()]));
    }

    /// What taut finds; CGAL's surface stands beside it.
    fn add(&mut self, input: &str, points: &[Point]) -> Result<(Solution<Surface>, Judged)> {
        let threads = Some(self.context.last_threads());
        let options = SurfaceOptions {
            method: SurfaceMethod::Tree(SurfaceMode::Open),
            threads,
            ..SurfaceOptions::default()
        };
        let (found, _) = ours(points, &options)?;
        let judged = Judged::of(points, &found.answer.triangles)?;
        self.push(input, "taut", judged, Some(looks_one_sided(&found)));
        match theirs(self.context, FRONT, points)? {
            Ok(found) => self.push(input, FRONT, Judged::of(points, &found.triangles)?, None),
            Err(why) => {
                self.table.push(json!({ "input": input, "program": FRONT, "why": why }));
            }
        }
        Ok((found, judged))
    }
}

/// The bunny, where its mesh is there.
fn judge_bunny(rows: &mut Rows<'_>, out: &mut Outcome) -> Result<()> {
    let Some(shape) = BUNNY.read()? else { return Ok(()) };
    let (found, judged) = rows.add("bunny", &shape.vertices)?;
    let distances = Distances::of(&shape, &shape.vertices, &found.answer.triangles)?;
    let unused = &found.answer.unused;
    let named = unused.outliers.len() + unused.interior.len() + unused.unreferenced.len();
    let what = "bunny: largest distance of the result from the reference, of the diagonal,";
    out.at_most(what, distances.invented.hausdorff, [0.02, 0.013], Unit::Percent);
    out.must("bunny: 2 to 8 loops", judged.loops, (2..=8).contains(&judged.loops));
    out.aim("bunny: 4 to 6 loops", judged.loops, (4..=6).contains(&judged.loops));
    let shown = format!(
        "{named} of {} (the mesh itself leaves out {UNREFERENCED_VERTICES})",
        judged.unused
    );
    out.must("bunny: each point without a triangle is named", shown, named == judged.unused);
    out.keep("bunny", distances.cells());
    Ok(())
}

/// The bunny, then sheets of random points.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let columns = format!("input | program | {} | one side | why", Judged::COLUMNS);
    let mut rows = Rows { context, table: Table::new(&columns) };
    judge_bunny(&mut rows, out)?;
    for seed in context.seeds.clone() {
        for (name, goal, points, components) in [
            (
                "hemisphere",
                "one component, no handle, one loop",
                hemisphere(context.count(20_000), seed)?,
                1,
            ),
            (
                "two sheets",
                "two components, two loops",
                sheets(context.count(5_000), 5.0, seed)?,
                2,
            ),
        ] {
            let name = format!("{name}, seed {seed}");
            let (_, judged) = rows.add(&name, &points)?;
            let is_met = (judged.components, judged.genus, judged.loops)
                == (components, Some(0), components);
            out.must(format!("{name}: {goal}"), judged.shape(), is_met);
        }
        for (what, turns) in [("Möbius band", 0.5), ("band with a whole turn", 1.0)] {
            let name = format!("{what}, seed {seed}");
            let (found, _) = rows.add(&name, &band(4_000, turns, seed)?)?;
            let (is_told, should) = (looks_one_sided(&found), turns < 1.0);
            let word = |is: bool| if is { "said" } else { "not said" };
            let goal = format!("{name}: {} to have one side", word(should));
            out.must(goal, word(is_told), is_told == should);
        }
    }
    out.table("", rows.table);
    Ok(())
}
