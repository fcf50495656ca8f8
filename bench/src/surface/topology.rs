//! Parts, handles and loops of closed surfaces, beside what is true and what CGAL finds.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_reconstruct::SurfaceOptions;

use super::found::{Way, ours, theirs};
use super::judged::Judged;
use super::models::{BLOB5, BUNNY, Model, SEVEN};
use super::samples::{Point, thinned};
use crate::context::Context;
use crate::goals::Goals;
use crate::peer::Silence;
use crate::table::Table;

/// Columns of the table; those in the middle are [`Judged::cells`].
const HEAD: [&str; 11] = [
    "set",
    "points",
    "program",
    "components",
    "genus",
    "loops",
    "bad edges",
    "bad vertices",
    "unused",
    "exact",
    "",
];

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
        let options = SurfaceOptions { threads: Some(context.threads[0]), ..Default::default() };
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
        let head = [self.model.name.to_owned(), self.points.to_string()];
        let mut row = |who: &str, cells: &[String]| {
            let mut row = [&head[..], &[who.to_owned()], cells].concat();
            row.resize(HEAD.len(), String::new());
            table.push(row);
        };
        let judged = |judged: &Judged| {
            let exact = if self.is_exact(judged) { "yes" } else { "no" };
            [&judged.cells()[..], &[exact.to_owned()]].concat()
        };
        let Model { components, genus, .. } = self.model;
        let none = [(); 4].map(|()| "0".to_owned());
        row("truth", &[&[components.to_string(), genus.to_string()][..], &none].concat());
        row("taut", &judged(&self.ours));
        for (way, found) in &self.theirs {
            match found {
                Ok(found) => row(way.name(), &judged(found)),
                Err(silence) => {
                    row(way.name(), &[vec![String::new(); 7], vec![silence.to_string()]].concat());
                }
            }
        }
    }

    /// For the report.
    fn json(&self) -> Value {
        let theirs = self.theirs.iter().map(|(way, found)| match found {
            Ok(judged) => json!({ "program": way.name(), "judged": judged }),
            Err(silence) => json!({ "program": way.name(), "silence": silence.to_string() }),
        });
        json!({
            "set": self.model.name, "points": self.points, "taut": self.ours, "exact": self.is_ours_exact(),
            "peers": theirs.collect::<Vec<_>>(),
        })
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
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let models = &SEVEN[..if context.quick { 2 } else { SEVEN.len() }];
    let mut shapes = vec![];
    for &model in models.iter().chain(&[BLOB5, BUNNY]) {
        let Some(shape) = model.read()? else { return Ok(json!({ "left_out": "no TAUT_DATA" })) };
        shapes.push((model, shape.vertices));
    }
    let mut table = Table::new(&HEAD);
    let mut whole = vec![];
    for (model, points) in &shapes {
        let trial = Trial::of(context, *model, points, &[Way::Front, Way::Scales])?;
        trial.print(&mut table);
        whole.push(trial);
    }
    println!("{table}");
    let mut draws = vec![];
    for share in [0.7, 0.5] {
        for seed in seeds.clone() {
            let mut table = Table::new(&HEAD);
            let mut trials = vec![];
            for (model, points) in &shapes[..models.len()] {
                let points = thinned(points, share, seed)?;
                let trial = Trial::of(context, *model, &points, &[Way::Front])?;
                trial.print(&mut table);
                trials.push(trial);
            }
            println!("{:.0} % of the points, seed {seed}\n\n{table}", 100.0 * share);
            draws.push((share, seed, trials));
        }
    }

    let mut goals = Goals::default();
    let all = models.len();
    let (exact, shown) = count(&whole[..all]);
    goals.must(format!("exact on {all} of {all}"), shown, exact == all);
    for trial in &whole[all..] {
        let shown = trial.ours.cells()[..3].join("/");
        let goal = format!("{} exact (components, genus, loops)", trial.model.name);
        goals.must(goal, shown, trial.is_ours_exact());
    }
    for (share, seed, trials) in &draws {
        let (must, aim) = if *share > 0.6 { (5, 7) } else { (4, 6) };
        let (exact, shown) = count(trials);
        let goal = |least| format!("{:.0} %, seed {seed}: exact on {least} of 7", 100.0 * share);
        let judged = (all == SEVEN.len()).then_some(exact);
        goals.must(goal(must), shown.clone(), judged.map(|exact| exact >= must));
        goals.aim(goal(aim), shown, judged.map(|exact| exact >= aim));
    }
    let json_of = |trials: &[Trial]| trials.iter().map(Trial::json).collect::<Vec<_>>();
    let draws: Vec<Value> = draws
        .iter()
        .map(|(share, seed, trials)| json!({ "share": share, "seed": seed, "trials": json_of(trials) }))
        .collect();
    Ok(json!({ "whole": json_of(&whole), "thinned": draws, "goals": goals.json() }))
}
