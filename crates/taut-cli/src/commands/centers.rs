//! `taut centers`: k equal balls around all points except z, as small as can be.

use anyhow::bail;
use taut::certify::Centers;
use taut::certify::Placement;
use taut::{CentersMethod, CentersOptions, Monitor, Solution, centers};

use taut_io::{Column, Table};

use crate::commands::ball::items;
use crate::commands::elbow::{self, Range};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Points, Reading};
use crate::input::units::UnitOptions;
use crate::output::tables::{self, TableFiles, Tables};
use crate::pipeline::{self, Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find k centers such that the farthest point is as near to one of them as can be, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The search takes time exponential in k: seconds for ten centers in the plane, and for twenty a --max-nodes or a larger \
--epsilon is wise. farthest-first takes any number of centers, and stream files larger than memory.
With -o the extension chooses: .json has answer and certificate, .csv, .npy, .parquet and the like the centers alone. In tables \
rows count from 0.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of nodes, of the search or of its proof, or where rounding
        hides the gap that was asked for; the gap reached is reported
Example: taut centers points.csv -k 5 -o centers.json --draw centers.svg &&
         taut verify centers.json points.csv
         taut centers points.csv --elbow 1..10 --draw elbow.svg
         taut centers corners.csv -k 3 --group house
         taut centers ellipses.csv -k 3 --ellipsoids")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Most centers, at least 1
    #[arg(short, long = "k", value_name = "K", required_unless_present = "elbow")]
    k: Option<usize>,
    /// Instead of one k all of a range, both ends included: a table of radius and lower bound by k; -o writes it as CSV,
    /// or as its extension says, --draw plots it
    #[arg(
        long, value_name = "K1..K2", value_parser = elbow::range,
        conflicts_with_all = ["k", "assignment", "files"]
    )]
    elbow: Option<Range>,
    /// Proved relative gap to reach, in [0, 1): radius ≤ (1 + ε) · least; 0 is exact to rounding
    #[arg(long, value_name = "REAL", default_value = "0.01", allow_negative_numbers = true)]
    epsilon: f64,
    /// The way to find them; all end in the same kind of certificate
    #[arg(
        long, value_name = "NAME", default_value = CentersMethod::default().name(), value_parser = choice::<CentersMethod>()
    )]
    method: CentersMethod,
    /// Centers are points of the input, not anywhere in space
    #[arg(long)]
    discrete: bool,
    /// Most points that may be left out
    #[arg(long, value_name = "Z", default_value_t = 0)]
    outliers: u64,
    /// The last column holds weights w > 0: a point counts with w times its distance
    #[arg(long, conflicts_with = "balls")]
    weights: bool,
    /// Rows are balls: the coordinates of a center, then the radius; each is to lie in one of the k
    #[arg(long)]
    balls: bool,
    /// Rows are ellipsoids {m + v : vvᵀ ⪯ S}: the coordinates of the center m, then the lower triangle of the shape
    /// matrix S, row by row; each is to lie in one of the k
    #[arg(long, conflicts_with_all = ["balls", "weights", "group", "discrete"])]
    ellipsoids: bool,
    /// The column, by name or number from 0, that holds a number for the group of each row: one ball is to hold all rows of a group,
    /// such as the vertices of a polytope. --outliers then counts groups
    #[arg(long, value_name = "COLUMN")]
    group: Option<String>,
    /// Most nodes of the search, then the best centers so far are given with their gap
    #[arg(long, value_name = "N", default_value_t = CentersOptions::default().max_nodes)]
    max_nodes: u64,
    /// Say for each point in the JSON which center is next to it
    #[arg(long)]
    assignment: bool,
    #[command(flatten)]
    tables: TableFiles,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    units: UnitOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = Centers;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.check_method()?;
        self.units.check(&self.rows_are_more())?;
        match self.elbow {
            Some(_) => self.output().refuse_pictures_as_json(),
            None => self.output().refuse_but_tables(&self.points.path),
        }
    }

    fn open(&self, _: &Watch) -> anyhow::Result<Opened> {
        let opened = self.reading.open(&self.points.path)?;
        match self.rows_are_more().iter().any(|(_, is)| *is) {
            true => Ok(opened),
            false => self.units.apply(opened),
        }
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Centers>, ())> {
        let k = self.k.expect("one of -k and --elbow is required");
        let options = self.options_for(points)?;
        let solve = |monitor: &Monitor<'_>| {
            centers(points.source(), k, &CentersOptions { monitor: *monitor, ..options })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn table_files(&self) -> Option<(&TableFiles, &'static [&'static str])> {
        Some((&self.tables, &["centers", "assignment", "outliers", "core-set"]))
    }

    fn tables(&self, found: &Solution<Centers>, points: &Opened) -> Tables {
        tables_of(found, points)
    }

    fn outcome(&self, found: &Solution<Centers>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.epsilon)
    }
}

/// The tables of an answer: an assignment is there if it was asked for.
fn tables_of(found: &Solution<Centers>, points: &Opened) -> Tables {
    let answer = &found.answer;
    let numbers = (0..answer.centers.len() as u64).collect();
    let centers = Table::new().with("center", Column::Whole(numbers));
    let centers = match answer.rows.is_empty() {
        true => centers,
        false => {
            let row = |&row: &u64| points.row(row) - 1;
            centers.with("row", Column::Whole(answer.rows.iter().map(row).collect()))
        }
    };
    let mut all = vec![
        ("centers", tables::with_places(centers, points, &answer.centers)),
        ("outliers", tables::rows(points, &answer.outliers)),
        ("core-set", tables::rows(points, &found.certificate.core_set)),
    ];
    if !answer.assignment.is_empty() {
        let every: Vec<u64> = (0..answer.assignment.len() as u64).collect();
        let center = answer.assignment.iter().map(|&center| center.into()).collect();
        all.push((
            "assignment",
            tables::rows(points, &every).with("center", Column::Whole(center)),
        ));
    }
    all
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.elbow {
            Some(range) => {
                self.check_options()?;
                let open = |watch: &Watch| self.open(watch);
                let options = |points: &Opened| self.options_for(points);
                elbow::run(range, &open, &options, self.input(), self.output())
            }
            None => pipeline::run(self),
        }
    }

    /// The options with the column of groups, which only the file can tell.
    fn options_for(&self, points: &Opened) -> anyhow::Result<CentersOptions<'static>> {
        let column = |name: &String| points.column("--group", name);
        Ok(CentersOptions { group: self.group.as_ref().map(column).transpose()?, ..self.options() })
    }

    fn options(&self) -> CentersOptions<'static> {
        CentersOptions {
            inputs: items(self.balls, self.ellipsoids),
            epsilon: self.epsilon,
            method: self.method,
            placement: if self.discrete { Placement::Rows } else { Placement::Free },
            outliers: self.outliers,
            weights: self.weights,
            max_nodes: self.max_nodes,
            assignment: self.assignment || self.tables.has("assignment"),
            // The threads are those of the pool, which reading and checking use as well.
            ..CentersOptions::default()
        }
    }

    /// The options by which a row is more than a point.
    fn rows_are_more(&self) -> [(&'static str, bool); 4] {
        [
            ("--balls", self.balls),
            ("--ellipsoids", self.ellipsoids),
            ("--weights", self.weights),
            ("--group", self.group.is_some()),
        ]
    }

    /// Returns what some methods do not do, in the words of the command line.
    fn check_method(&self) -> anyhow::Result<()> {
        let asked = [
            ("--discrete", self.discrete),
            ("--balls", self.balls),
            ("--ellipsoids", self.ellipsoids),
            ("--weights", self.weights),
            ("--outliers", self.outliers > 0),
            ("--assignment", self.assignment || self.tables.has("assignment")),
            ("--group", self.group.is_some()),
        ];
        let (names, knows) = match self.method {
            CentersMethod::Thesis => (
                &["--discrete", "--ellipsoids", "--weights", "--outliers", "--group"][..],
                "free centers of points and balls",
            ),
            CentersMethod::Stream(_) => (
                &["--balls", "--ellipsoids", "--weights", "--outliers", "--assignment", "--group"]
                    [..],
                "centers of points alone, which it does not look at again",
            ),
            CentersMethod::FarthestFirst => (&["--ellipsoids"][..], "points and balls"),
            _ => return Ok(()),
        };
        match asked.into_iter().find(|(name, is_asked)| *is_asked && names.contains(name)) {
            Some((name, _)) => bail!(
                "{name} has no meaning with --method {}, which knows {knows}: leave out one of the two",
                self.method
            ),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("centers"));
        let matches = command.get_matches_from(["centers", "points.csv", "-k", "3"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::CentersOptions::default());
        assert_eq!(args.k, Some(3));
    }
}
