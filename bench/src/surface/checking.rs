//! What it costs to check a surface, beside what it cost to find it: processor time, on as many threads.

use super::*;

/// Solves and checks by turns; of processor seconds the least of all rounds counts.
fn add(
    context: &Context,
    out: &mut Outcome,
    table: &mut Table,
    input: &str,
    points: &[Point],
    runs: usize,
) -> Result<()> {
    let pool = context.pool()?;
    let threads = Some(context.last_threads());
    let options = SurfaceOptions { threads, ..SurfaceOptions::default() };
    let view = Points::new(points.as_flattened(), 3)?;
    let (mut solve, mut check, mut last) = (f64::INFINITY, f64::INFINITY, None);
    for _ in 0..runs {
        let meter = Meter::start();
        let found = surface(&view, &options)?;
        solve = solve.min(meter.stop().cpu);
        let meter = Meter::start();
        let verdict = pool.install(|| found.check(&view));
        check = check.min(meter.stop().cpu);
        let verdict = verdict.with_context(|| input.to_owned())?;
        last = Some((found.answer.triangles.len(), verdict.certified));
    }
    let (triangles, certified) = last.context("no round")?;
    table.push(json!({
        "input": input, "points": points.len(), "triangles": triangles, "certified": certified,
        "solve": solve, "check": check, "ratio": check / solve,
    }));
    out.at_most(format!("{input}: check over solve"), check / solve, [1.0, 0.5], Unit::Times);
    Ok(())
}

/// Meshes, solids with flat faces in three places and two sizes, a million points of a smooth body.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (seed, runs) = (context.seeds.start, context.runs);
    let mut table =
        Table::new("input | points | triangles | certified | solve:s | check:s | ratio:x");
    for model in [BUNNY, DC, ANCHOR, HORSE] {
        let Some(shape) = model.read()? else { continue };
        add(context, out, &mut table, model.name, &shape.vertices, runs)?;
    }
    for (solid, name) in Solid::ALL {
        for (place, position) in Place::ALL {
            for count in [20_000, 80_000].map(|count| context.count(count)) {
                let points = solid.points(place, count, seed)?;
                let input = format!("{name}, {position}, {count}");
                add(context, out, &mut table, &input, &points, runs)?;
            }
        }
    }
    // One round is enough: it is the size that is tried.
    let points = handles(context.count(1_000_000), seed)?;
    let input = format!("three handles, {}", points.len());
    add(context, out, &mut table, &input, &points, 1)?;
    let threads = context.last_threads();
    out.table(&format!("processor time on {threads} threads, the least of {runs} rounds"), table);
    Ok(())
}
