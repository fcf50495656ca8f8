//! Parts, handles and loops of closed surfaces, beside what is true and what CGAL finds.

use super::*;

/// Columns of the table.
fn columns() -> String {
    format!("set | points | program | {} | exact | why", Judged::COLUMNS)
}

/// Programs on one set of points.
struct Trial {
    model: Model,
    points: usize,
    ours: Judged,
    theirs: Vec<(Way, Result<Judged, Silence>)>,
}

impl Trial {
    /// Lets taut and CGAL's programs work on points of a model.
    fn of(context: &Context, model: Model, points: &[Point], ways: &[Way]) -> Result<Self> {
        let options =
            SurfaceOptions { threads: Some(context.last_threads()), ..Default::default() };
        let (found, _) = ours(points, &options)?;
        let mut trial = Trial {
            model,
            points: points.len(),
            ours: Judged::of(points, &found.answer.triangles)?,
            theirs: vec![],
        };
        for &way in ways {
            let judged = match theirs(context, way, points)? {
                Ok(found) => Ok(Judged::of(points, &found.triangles)?),
                Err(silence) => Err(silence),
            };
            trial.theirs.push((way, judged));
        }
        Ok(trial)
    }

    fn is_exact(&self, judged: &Judged) -> bool {
        judged.is_exact(self.model.components, self.model.genus)
    }

    /// Whether taut's answer is exact.
    fn is_ours_exact(&self) -> bool {
        self.is_exact(&self.ours)
    }

    /// Whether that of the advancing front is.
    fn is_theirs_exact(&self) -> Option<bool> {
        let (_, judged) = self.theirs.iter().find(|(way, _)| *way == Way::Front)?;
        judged.as_ref().ok().map(|judged| self.is_exact(judged))
    }

    /// A row for the truth and one for each program.
    fn print(&self, table: &mut Table) {
        let mut row = |who: &str, cells: Value| {
            let head = json!({ "set": self.model.name, "points": self.points, "program": who });
            table.push(joined([head, cells]));
        };
        let cells =
            |judged: &Judged| joined([json!({ "exact": self.is_exact(judged) }), judged.cells()]);
        let Model { components, genus, .. } = self.model;
        let truth = json!({
            "components": components, "genus": genus, "loops": 0, "bad edges": 0, "bad vertices": 0, "unused": 0,
        });
        row("truth", truth);
        row("taut", cells(&self.ours));
        for (way, found) in &self.theirs {
            match found {
                Ok(judged) => row(way.name(), cells(judged)),
                Err(silence) => row(way.name(), json!({ "why": silence })),
            }
        }
    }
}

/// How many of some trials are exact, as taut and as the advancing front have it.
fn count(trials: &[Trial]) -> (usize, String) {
    let ours = trials.iter().filter(|trial| trial.is_ours_exact()).count();
    let theirs: Option<Vec<bool>> = trials.iter().map(Trial::is_theirs_exact).collect();
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
    let mut table = Table::new(&columns());
    let mut whole = vec![];
    for (model, points) in &shapes {
        let trial = Trial::of(context, *model, points, &[Way::Front, Way::Scales])?;
        trial.print(&mut table);
        whole.push(trial);
    }
    out.table("", table);
    let (exact, shown) = count(&whole[..all]);
    out.must(format!("exact on {all} of {all}"), shown, exact == all);
    for trial in &whole[all..] {
        let goal = format!("{} exact (components, genus, loops)", trial.model.name);
        out.must(goal, trial.ours.shape(), trial.is_ours_exact());
    }
    for (share, must, aim) in [(0.7, 5, 7), (0.5, 4, 6)] {
        for seed in context.seeds.clone() {
            let name = format!("{:.0} % of the points, seed {seed}", 100.0 * share);
            let mut table = Table::new(&columns());
            let mut trials = vec![];
            for (model, points) in &shapes[..all] {
                let points = thinned(points, share, seed)?;
                let trial = Trial::of(context, *model, &points, &[Way::Front])?;
                trial.print(&mut table);
                trials.push(trial);
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
