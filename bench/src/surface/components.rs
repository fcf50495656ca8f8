//! Many bodies at once: linear in their number, and each of them found.

use super::*;

/// taut on one thread on two inputs, by turns.
fn both(context: &Context, points: [&[Point]; 2]) -> Result<[Builds; 2]> {
    let mut all = points.map(|points| (points, Builds::default()));
    by_turns(context.runs, &mut all, |(points, builds)| {
        let file = context.file("points.f64");
        write_raw(&file, points.as_flattened())?;
        builds.keep(one::alone(1, &file, context.limit)?);
        Ok(())
    })?;
    Ok(all.map(|(_, builds)| builds))
}

/// The extraction of 300 beside CGAL's, then 1000 small ones beside a large one.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (few, many) = (context.count(300), context.count(1000));
    let seed = context.seeds.start;
    let points = ellipsoids(few, 100, seed)?;
    let timed = Timed::by_turns(context, &points)?;
    let mut table = Table::new(&format!("bodies | points | {}", Timed::COLUMNS));
    table.push(joined([json!({ "bodies": few, "points": points.len() }), timed.cells()]));
    out.table("", table);
    // As it is called without other word, and then held to one thread, as CGAL's is.
    let [_, on_one, on_all] = timed.ratios();
    for (on, ratio) in
        [(format!("{} threads", context.last_threads()), on_all), ("one thread".to_owned(), on_one)]
    {
        let what = format!("{few} components: CGAL's extraction over taut's on {on}");
        out.at_least(what, ratio.map(|ratio| 1.0 / ratio), [50.0, 100.0], Unit::Times);
    }

    let bodies = [(many, 100), (1, 100 * many)];
    let [small, large] = bodies.map(|(count, each)| ellipsoids(count, each, seed));
    let [apart, whole] = both(context, [&small?, &large?])?;
    let mut table = Table::new(&format!("input | points | {} | one thread:s", Judged::COLUMNS));
    for (what, builds) in [(format!("{many} of 100"), &apart), ("one".to_owned(), &whole)] {
        let Some(build) = builds.builds.first() else { continue };
        let head = json!({
            "input": what, "points": build.points, "one thread": builds.wall(), "builds": builds,
        });
        table.push(joined([head, json!(build.counters)]));
    }
    out.table("", table);
    let found = apart.builds.first().and_then(|build| build.counters.get("components").copied());
    let goal = format!("exactly {many} components of 100 points");
    out.must(goal, json!(found), found.map(|found| found == many as u64));
    let ratio = apart.wall().zip(whole.wall()).map(|(apart, whole)| apart / whole);
    let what = format!("time of {many} components over that of one");
    out.at_most(what, ratio, [1.5, 1.1], Unit::Times);
    Ok(())
}
