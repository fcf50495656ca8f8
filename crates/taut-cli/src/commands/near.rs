//! `taut near`: rows near places, along rays, far away, near each other.

mod table;

use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::Monitor;
use taut::enclose::{QueryOptions, SearchError, SphereSearch, SphereSearchOptions};

use crate::commands::ball::items;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Points, Reading, wrong_option};
use crate::output::writing::{self, Outputs, print_error};
use crate::watch::Watch;
use table::Table;

/// Find the nearest points, those within a distance, along rays, farthest, near each other; and the diameter.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("question").required(true).args(["queries", "rays", "pairs", "diameter"])))]
#[command(after_help = "\
A line of the output is a row found, with its distance; rows and queries are counted from 0 as in their files. Distances are \
calculated in double precision, and of equal ones the lowest row comes first. The distance to a ball is that to its near side, negative inside, \
and with --farthest to its far side; along a ray it is that to where the ray enters.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut near towns.csv --queries homes.csv -k 3 -o nearest.csv
         taut near balls.csv --balls --pairs -o touching.csv
See: docs/sphere-tree.md")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Rows of POINTS, and of the other file of --pairs, are balls: the coordinates of a center, then the radius
    #[arg(long)]
    balls: bool,
    /// Places from which to look: a row of coordinates each
    #[arg(long, value_name = "FILE", help_heading = "Questions")]
    queries: Option<PathBuf>,
    /// How many of the nearest rows to list for each query, nearest first
    #[arg(short, long, value_name = "K", default_value_t = 1, requires = "queries", conflicts_with_all = ["within", "farthest"], help_heading = "Questions")]
    k: usize,
    /// List all rows within this distance of each query instead, nearest first
    #[arg(
        long,
        value_name = "R",
        requires = "queries",
        allow_negative_numbers = true,
        help_heading = "Questions"
    )]
    within: Option<f64>,
    /// List the farthest row from each query instead
    #[arg(long, requires = "queries", conflicts_with = "within", help_heading = "Questions")]
    farthest: bool,
    /// Rays to follow: the coordinates of an origin and a direction in each row; the first row that each meets is listed
    #[arg(long, value_name = "FILE", help_heading = "Questions")]
    rays: Option<PathBuf>,
    /// Radius of a point that a ray meets, or what is added to that of a ball
    #[arg(
        long,
        value_name = "R",
        default_value_t = 0.0,
        requires = "rays",
        allow_negative_numbers = true,
        help_heading = "Questions"
    )]
    hit_radius: f64,
    /// List all rows that each ray meets, in their order along it
    #[arg(long, requires = "rays", help_heading = "Questions")]
    all: bool,
    /// List all pairs within --distance: of two rows of POINTS, or of one of POINTS and one of FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, help_heading = "Questions")]
    pairs: Option<Option<PathBuf>>,
    /// The largest distance of a pair; of balls, 0 lists those that touch
    #[arg(
        long,
        value_name = "D",
        default_value_t = 0.0,
        requires = "pairs",
        allow_negative_numbers = true,
        help_heading = "Questions"
    )]
    distance: f64,
    /// Find the two rows that are farthest apart
    #[arg(long, help_heading = "Questions")]
    diameter: bool,
    /// With --farthest and --diameter: no other is farther than 1 + ε times, which is faster than the exact answer
    #[arg(
        long,
        value_name = "REAL",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "Questions"
    )]
    epsilon: f64,

    /// Where to write the rows: .csv with a header, or .json; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    /// Write JSON instead of CSV
    #[arg(long, help_heading = "Writing")]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let other = self.other();
        let inputs: Vec<&Path> = [Some(&*self.points.path), other].into_iter().flatten().collect();
        if inputs.len() == 2 && inputs.iter().all(|path| writing::is_stream(path)) {
            bail!("only one of two inputs can be standard input: name a file for the other");
        }
        if self.epsilon != 0.0 && !(self.farthest || self.diameter) {
            bail!("--epsilon belongs to --farthest and --diameter: leave it out");
        }
        if self.within.is_some_and(f64::is_nan) {
            return Err(wrong_option("within", "NaN", "a number"));
        }
        writing::check_writable(&[&self.out], &inputs)?;
        let as_json = writing::writes_json(&self.out, self.json, "csv")?;
        let watch = self.effort.start()?;
        let points = self.reading.open(&self.points.path)?;
        let other = other.map(|path| self.reading.open(path)).transpose()?;
        let search = self.tree(&points, &watch)?;
        let table = match &other {
            None => self.ask_alone(&search, &points, &watch)?,
            Some(other) => self.ask(&search, other, &watch)?,
        };
        let files = match &other {
            None => [&points, &points],
            Some(other) if self.pairs.is_some() => [&points, other],
            Some(other) => [other, &points],
        };
        let table = table.of_files(files);
        if !self.effort.quiet {
            for opened in [Some(&points), other.as_ref()].into_iter().flatten() {
                for note in opened.notes() {
                    let remark = note.remark.map(|remark| format!("; {remark}"));
                    let remark = remark.unwrap_or_default();
                    print_error(&format!(
                        "{}: {} {}{remark}",
                        opened.name(),
                        note.name,
                        note.value
                    ));
                }
            }
        }
        let mut outputs = Outputs::default();
        outputs.add(&self.out, table.text(as_json).as_bytes())?;
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    /// The second input.
    fn other(&self) -> Option<&Path> {
        let pairs = self.pairs.as_ref().and_then(Option::as_deref);
        self.queries.as_deref().or(self.rays.as_deref()).or(pairs)
    }

    fn tree(&self, points: &Opened, watch: &Watch) -> anyhow::Result<SphereSearch> {
        let inputs = items(self.balls, false);
        let built = watch.during("building the tree", |monitor| {
            let options = SphereSearchOptions { inputs, monitor: *monitor, threads: None };
            SphereSearch::new(points.source(), &options)
        });
        built.map_err(|error| points.explain(error))
    }

    /// What is asked of one file.
    fn ask_alone(
        &self,
        search: &SphereSearch,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<Table> {
        let ask = |monitor: &Monitor<'_>| -> Result<Table, SearchError> {
            let options = QueryOptions { monitor: *monitor, ..QueryOptions::default() };
            Ok(match self.diameter {
                true => Table::of_diameter(&search.diameter(self.epsilon, &options)?),
                false => Table::of_pairs(&search.pairs(self.distance, &options)?),
            })
        };
        watch.during("searching", ask).map_err(|error| points.explain(error))
    }

    /// What is asked with a second file.
    fn ask(&self, search: &SphereSearch, other: &Opened, watch: &Watch) -> anyhow::Result<Table> {
        if self.pairs.is_some() {
            let second = self.tree(other, watch)?;
            let pairs = watch.during("searching", |monitor| {
                let options = QueryOptions { monitor: *monitor, ..QueryOptions::default() };
                search.pairs_with(&second, self.distance, &options)
            });
            return Ok(Table::of_pairs(&pairs.map_err(|error| other.explain(error))?));
        }
        let ask = |monitor: &Monitor<'_>| -> Result<Table, SearchError> {
            let options = QueryOptions { monitor: *monitor, ..QueryOptions::default() };
            let source = other.source();
            let found = if self.rays.is_some() {
                match self.all {
                    true => search.hits(source, self.hit_radius, &options)?,
                    false => {
                        let found = search.first_hits(source, self.hit_radius, &options)?;
                        found.into_iter().map(Vec::from_iter).collect()
                    }
                }
            } else if let Some(distance) = self.within {
                search.within(source, distance, &options)?
            } else if self.farthest {
                let found = search.farthest(source, self.epsilon, &options)?;
                found.into_iter().map(|found| vec![found]).collect()
            } else {
                search.nearest_k(source, self.k, &options)?
            };
            Ok(Table::of_queries(if self.rays.is_some() { "ray" } else { "query" }, found))
        };
        watch.during("searching", ask).map_err(|error| other.explain(error))
    }
}
