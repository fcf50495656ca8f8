//! Parts, handles and loops of closed surfaces, beside what is true and what CGAL finds.

use super::*;

/// What taut and the advancing front found of one set of points.
struct Trial {
    name: &'static str,
    ours: Judged,
    is_exact: bool,
    /// `None` where the advancing front gave no answer.
    is_theirs_exact: Option<bool>,
}

fn table() -> Table {
    Table::new(&format!("set | points | program | {} | exact | why", Judged::COLUMNS))
}

impl Trial {
    /// Lets taut and CGAL's programs work on points of a model: a row for the truth and one for each program.
    fn of(
        context: &Context,
        table: &mut Table,
        model: &Model,
        points: &[Point],
        ways: &[&str],
    ) -> Result<Self> {
        let &Model { name, components, genus, .. } = model;
        let is_exact = |judged: &Judged| judged.is_exact(components, genus);
        let mut row = |who: &str, cells: Value| {
            let head = json!({ "set": name, "points": points.len(), "program": who });
            table.push(joined([head, cells]));
        };
        let cells =
            |judged: &Judged| joined([json!({ "exact": is_exact(judged) }), judged.cells()]);
        let truth = json!({
            "components": components, "genus": genus, "loops": 0, "bad edges": 0, "bad vertices": 0, "unused": 0,
        });
        row("truth", truth);
        let threads = Some(context.last_threads());
        let (found, _) = ours(points, &SurfaceOptions { threads, ..Default::default() })?;
        let judged = Judged::of(points, &found.answer.triangles)?;
        row("taut", cells(&judged));
        let mut is_theirs_exact = None;
        for way in ways {
            match theirs(context, way, points)? {
                Ok(found) => {
                    let judged = Judged::of(points, &found.triangles)?;
                    row(way, cells(&judged));
                    if *way == FRONT {
                        is_theirs_exact = Some(is_exact(&judged));
                    }
                }
                Err(silence) => row(way, json!({ "why": silence })),
            }
        }
        Ok(Trial { name, ours: judged, is_exact: is_exact(&judged), is_theirs_exact })
    }
}

/// How many of some trials are exact, as taut and as the advancing front have it.
fn count(trials: &[Trial]) -> (usize, String) {
    let ours = trials.iter().filter(|trial| trial.is_exact).count();
    let theirs: Option<Vec<bool>> = trials.iter().map(|trial| trial.is_theirs_exact).collect();
    let theirs = theirs.map_or("not measured".to_owned(), |exact| {
        exact.iter().filter(|exact| **exact).count().to_string()
    });
    (ours, format!("{ours} of {} (advancing front: {theirs})", trials.len()))
}

/// Whole sets, then thinned ones.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let models = &SEVEN[..context.size(SEVEN.len(), 2)];
    let all = models.len();
    let mut shapes = vec![];
    for &model in models.iter().chain(&[BLOB5, BUNNY]) {
        let Some(shape) = model.read()? else { return out.left_out() };
        shapes.push((model, shape.vertices));
    }
    let mut table = self::table();
    let mut whole = vec![];
    for (model, points) in &shapes {
        whole.push(Trial::of(context, &mut table, model, points, &[FRONT, SCALES])?);
    }
    out.table("", table);
    let (exact, shown) = count(&whole[..all]);
    out.must(format!("exact on {all} of {all}"), shown, exact == all);
    for trial in &whole[all..] {
        let goal = format!("{} exact (components, genus, loops)", trial.name);
        out.must(goal, trial.ours.shape(), trial.is_exact);
    }
    for (share, must, aim) in [(0.7, 5, 7), (0.5, 4, 6)] {
        for seed in context.seeds.clone() {
            let name = format!("{:.0} % of the points, seed {seed}", 100.0 * share);
            let mut table = self::table();
            let mut trials = vec![];
            for (model, points) in &shapes[..all] {
                let points = thinned(points, share, seed)?;
                trials.push(Trial::of(context, &mut table, model, &points, &[FRONT])?);
            }
            out.table(&name, table);
            let (exact, shown) = count(&trials);
            let judged = (all == SEVEN.len()).then_some(exact);
            let goal = |least| format!("{name}: exact on {least} of 7");
            out.must(goal(must), shown.clone(), judged.map(|exact| exact >= must));
            out.aim(goal(aim), shown, judged.map(|exact| exact >= aim));
        }
    }
    Ok(())
}
