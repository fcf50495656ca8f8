//! `taut inscribe bodies`: convex bodies inside a triangle mesh; and what all searches for such bodies share.

mod exports;

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use taut::certify::InscribedBodies;
use taut::inscribe::{
    BodiesOptions, BodyShape, Error, Objective, Occlusion, OcclusionOptions, inscribed_bodies,
    occlusion,
};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::obstacles::Obstacles;
use crate::input::reading::{Opened, Reading};
use crate::output::writing::Outputs;
use crate::pipeline::{Find, Input, Output};
use crate::reports::{self, Field};
use crate::watch::Watch;

/// The most bodies where a part to cover or to hide decides how many there are.
const COUNT_MAX: usize = 1000;

/// Find large convex bodies inside a triangle mesh, with facets in any directions.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each edge of the mesh must belong to an even number of triangles; if not, the message names one, and --close-holes \
closes the mesh by triangles that the answer names. Inside is decided by the even-odd rule, however triangles are \
turned. That each body lies inside is proved. How much of the inside the bodies cover is an estimate, and nothing is \
claimed about how much such bodies can cover. To check an answer with --obstacles, or draw it, give verify and draw the \
same.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut inscribe bodies horse.off --count 10 -o bodies.json --draw bodies.html &&
         taut verify bodies.json horse.off
         taut inscribe bodies bunny.off --close-holes --coverage 0.9 --facets 26 -o bodies.glb
         taut inscribe bodies room.stl --obstacles scan.xyz --at 0.5,0,1,2.5,0,1 -o region.json
         taut inscribe bodies scan.xyz --count 20 --parts free")]
pub(super) struct Bodies {
    /// Most facets of a body, from 8 to 256; more facets cover more
    #[arg(long, value_name = "F", default_value_t = 256)]
    facets: usize,
    #[command(flatten)]
    search: Search,
}

/// What a search for bodies in a mesh needs, whatever their facets.
#[derive(Debug, clap::Args)]
pub(super) struct Search {
    /// The mesh: .off, .obj, .ply or .stl, or points with 9 coordinates, the corners of a triangle in each row; or points with 3, among
    /// which the bodies are to be, in their bounding box
    #[arg(value_name = "MESH")]
    path: PathBuf,
    #[command(flatten)]
    obstacles: Obstacles,
    /// What the search counts: the part of the inside that bodies cover, or the lines through the mesh that they hide
    #[arg(long, value_name = "NAME", default_value = Objective::default().name(), value_parser = choice::<Objective>())]
    objective: Objective,
    /// Most bodies to find, from 1 to 1000; by default 1, or 1000 with --coverage or --hidden, or as many as there are points with --at
    #[arg(short = 'n', long, value_name = "N")]
    count: Option<usize>,
    /// Find bodies that do not overlap
    #[arg(long)]
    disjoint: bool,
    /// A point that a body has to contain, or a segment by the six numbers of its ends; the first body contains the first one, and
    /// so on
    #[arg(long, value_name = "X,Y,Z", value_parser = segment, allow_hyphen_values = true)]
    at: Vec<[[f64; 3]; 2]>,
    /// Stop once this part of the inside is covered, above 0 and at most 1, by the points that the search counts
    #[arg(long, value_name = "PART", allow_hyphen_values = true)]
    coverage: Option<f64>,
    /// Of --objective occlusion, stop once this part of the lines through the mesh is hidden, above 0 and at most 1, by the lines
    /// that the search counts
    #[arg(long, value_name = "PART", allow_hyphen_values = true)]
    hidden: Option<f64>,
    /// Merge bodies, so that there are fewer, as long as at most this part of what they cover or hide is lost, from 0 to below 1
    #[arg(long, value_name = "PART", allow_hyphen_values = true)]
    merge_within: Option<f64>,
    /// Close the holes of a mesh that is not closed by triangles, which the answer names
    #[arg(long)]
    close_holes: bool,
    /// How many facets one search may place, move, or try to move, at least 1; more of these events cover more [default: 200000]
    #[arg(long, value_name = "N")]
    events: Option<u64>,
    /// Where the random choices begin
    #[arg(long, value_name = "S", default_value_t = BodiesOptions::default().seed)]
    seed: u64,
    /// Estimate how much of the mesh the bodies hide, by about this many random lines, from 1000 to 10⁹
    #[arg(long, value_name = "LINES")]
    occlusion: Option<u64>,
    #[command(flatten)]
    exports: exports::Exports,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

/// The points that bodies have to contain, and where some are segments the other ends of all.
#[derive(Debug, Default)]
pub(super) struct Seeds {
    at: Vec<[f64; 3]>,
    ends: Vec<[f64; 3]>,
}

/// Reads three numbers between commas, a point, or six, the ends of a segment.
fn segment(text: &str) -> Result<[[f64; 3]; 2], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) => Ok([[x, y, z]; 2]),
        Ok(&[x, y, z, u, v, w]) => Ok([[x, y, z], [u, v, w]]),
        _ => Err("expected three numbers between commas, as 0.5,-1,2, or six".to_owned()),
    }
}

/// Explains why no bodies were found; of a mesh with holes also which option closes them.
fn explain(mesh: &Opened, error: Error) -> anyhow::Error {
    let is_open = matches!(error, Error::Open { .. });
    let explained = mesh.explain(error);
    if is_open { anyhow!("{explained} with --close-holes") } else { explained }
}

impl Search {
    pub(super) fn input(&self) -> Input<'_> {
        Input { path: &self.path, reading: &self.reading, effort: &self.effort }
    }

    pub(super) fn output(&self) -> Output<'_> {
        self.exports.output()
    }

    pub(super) fn check_options(&self) -> anyhow::Result<()> {
        let points = self.at.len();
        if let Some(count) = self.count.filter(|&count| count < points) {
            bail!(
                "option `--count` is {count}: expected at least {points}, as --at names {points} points that a body each has \
                 to contain"
            );
        }
        self.output().refuse_pictures_as_json()?;
        for obstacle in self.obstacles.paths() {
            self.exports.check(obstacle)?;
            self.output().check_files(obstacle, &[])?;
        }
        self.exports.check(&self.path)
    }

    /// The options that searches with a budget of events have alone, and whether they are given.
    pub(super) fn of_events(&self) -> [(&'static str, bool); 4] {
        [
            ("at", !self.at.is_empty()),
            ("events", self.events.is_some()),
            ("hidden", self.hidden.is_some()),
            ("merge-within", self.merge_within.is_some()),
        ]
    }

    pub(super) fn write(
        &self,
        found: &Solution<InscribedBodies>,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        self.exports.write(found, outputs, monitor)
    }

    pub(super) fn side_fields(hidden: &Option<Occlusion>) -> Vec<Field> {
        hidden.iter().map(reports::bodies::occlusion).collect()
    }

    pub(super) fn open(&self) -> anyhow::Result<Opened> {
        self.reading.open_mesh(&self.path, &self.obstacles)
    }

    pub(super) fn solve(
        &self,
        options: BodiesOptions<'_>,
        mesh: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedBodies>, Option<Occlusion>)> {
        let solve = |monitor: &Monitor<'_>| {
            let options = BodiesOptions { monitor: *monitor, ..options };
            inscribed_bodies(mesh.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| explain(mesh, error))?;
        let hide = |monitor: &Monitor<'_>| {
            let of_lines = |lines| {
                let options = OcclusionOptions { lines, seed: self.seed, monitor: *monitor };
                occlusion(mesh.source(), &found.answer, &options)
            };
            self.occlusion.map(of_lines).transpose()
        };
        let hidden = watch.during("drawing lines", hide).map_err(|error| mesh.explain(error))?;
        Ok((found, hidden))
    }

    pub(super) fn seeds(&self) -> Seeds {
        let (at, ends): (Vec<_>, Vec<_>) = self.at.iter().map(|&[from, to]| (from, to)).unzip();
        if at == ends { Seeds { at, ends: vec![] } } else { Seeds { at, ends } }
    }

    pub(super) fn options<'a>(
        &'a self,
        shape: BodyShape<'a>,
        seeds: &'a Seeds,
    ) -> BodiesOptions<'a> {
        let is_open = self.coverage.is_some() || self.hidden.is_some();
        let many = if is_open { COUNT_MAX } else { BodiesOptions::default().count };
        BodiesOptions {
            shape,
            objective: self.objective,
            count: self.count.unwrap_or(many),
            disjoint: self.disjoint,
            at: &seeds.at,
            ends: &seeds.ends,
            coverage: self.coverage,
            hidden: self.hidden,
            merge_within: self.merge_within,
            close_holes: self.close_holes,
            events: self.events.unwrap_or(BodiesOptions::default().events),
            seed: self.seed,
            ..BodiesOptions::default()
        }
    }
}

impl Find for Bodies {
    type Answer = InscribedBodies;
    type Extra = Option<Occlusion>;

    fn input(&self) -> Input<'_> {
        self.search.input()
    }

    fn output(&self) -> Output<'_> {
        self.search.output()
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.search.check_options()
    }

    fn open(&self, _: &Watch) -> anyhow::Result<Opened> {
        self.search.open()
    }

    fn solve(
        &self,
        mesh: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedBodies>, Option<Occlusion>)> {
        let (shape, seeds) = (BodyShape::Free(self.facets), self.search.seeds());
        self.search.solve(self.search.options(shape, &seeds), mesh, watch)
    }

    fn side_fields(&self, hidden: &Option<Occlusion>) -> Vec<Field> {
        Search::side_fields(hidden)
    }

    fn write(
        &self,
        found: &mut Solution<InscribedBodies>,
        _: &Option<Occlusion>,
        _: &Opened,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        self.search.write(found, outputs, monitor)
    }

    fn outcome(&self, _found: &Solution<InscribedBodies>) -> Outcome {
        Outcome::Done
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};
    use taut::inscribe::{BodiesOptions, BodyShape, Objective};

    fn options(line: &str) -> super::Bodies {
        let command = super::Bodies::augment_args(clap::Command::new("bodies"));
        let matches = command.get_matches_from(line.split_whitespace());
        super::Bodies::from_arg_matches(&matches).unwrap()
    }

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let found = options("bodies mesh.off");
        let (shape, none) = (BodyShape::Free(found.facets), super::Seeds::default());
        assert_eq!(found.search.options(shape, &none), BodiesOptions::default());
        let found = options("bodies mesh.off --objective occlusion");
        assert_eq!(found.search.options(shape, &none).objective, Objective::Occlusion);
        let found = options("bodies mesh.off --coverage 0.5 --at=1,-2,.5 --at -1e3,0,0");
        let seeds = found.search.seeds();
        let found = found.search.options(shape, &seeds);
        assert_eq!((found.count, found.coverage), (1000, Some(0.5)));
        assert_eq!(found.at, [[1.0, -2.0, 0.5], [-1e3, 0.0, 0.0]]);
        assert!(found.ends.is_empty());
        let found = options("bodies mesh.off --objective occlusion --hidden 0.5 --merge-within 0");
        let found = found.search.options(shape, &none);
        assert_eq!((found.count, found.hidden, found.merge_within), (1000, Some(0.5), Some(0.0)));
        let seeds = options("bodies mesh.off --at 1,2,3 --at=-1,2,3,4,5,-6").search.seeds();
        assert_eq!(seeds.at, [[1.0, 2.0, 3.0], [-1.0, 2.0, 3.0]]);
        assert_eq!(seeds.ends, [[1.0, 2.0, 3.0], [4.0, 5.0, -6.0]]);
    }

    #[test]
    fn a_point_has_three_numbers_and_a_segment_six() {
        for wrong in ["", "1,2", "1,2,3,4", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,x", "1 2 3"] {
            assert!(super::segment(wrong).is_err(), "{wrong}");
        }
        assert_eq!(super::segment("1, 2, 3"), Ok([[1.0, 2.0, 3.0]; 2]));
    }
}
