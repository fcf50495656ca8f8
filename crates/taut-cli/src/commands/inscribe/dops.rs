//! `taut inscribe dops`: convex bodies with facets in fixed directions inside a closed triangle mesh.

mod exports;
mod report;

use std::path::PathBuf;

use taut::certify::InscribedBodies;
use taut::inscribe::{DopsOptions, Occlusion, OcclusionOptions, inscribed_dops, occlusion};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Reading};
use crate::output::writing::Outputs;
use crate::pipeline::{Find, Input, Output};
use crate::reports::Field;
use crate::watch::Watch;

/// Find large convex bodies with facets in k directions (k-dops) inside a closed triangle mesh.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each edge of the mesh must belong to an even number of triangles; if not, the message names one. Inside is decided by the
even-odd rule, however triangles are turned. That each body lies inside is proved. How much of the inside the bodies cover is
an estimate, and nothing is claimed about how much such bodies can cover.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut inscribe dops horse.off --count 10 -o bodies.json --draw bodies.html &&
         taut verify bodies.json horse.off
         taut inscribe dops horse.off --count 10 -o bodies.glb --parts collision")]
pub(super) struct Dops {
    /// The mesh: .off, .obj, .ply or .stl, or points with 9 coordinates, the corners of a triangle in each row
    #[arg(value_name = "MESH")]
    path: PathBuf,
    /// Directions of the facets: 6, 14, 18 or 26
    #[arg(short = 'k', long, value_name = "K", default_value_t = DopsOptions::default().directions)]
    directions: usize,
    /// Most bodies to find, from 1 to 1000
    #[arg(short = 'n', long, value_name = "N", default_value_t = DopsOptions::default().count)]
    count: usize,
    /// Find bodies that do not overlap
    #[arg(long)]
    disjoint: bool,
    /// How many facet events one search may compute, at least 1; more events cover more
    #[arg(long, value_name = "N", default_value_t = DopsOptions::default().events)]
    events: u64,
    /// Where the random choices begin
    #[arg(long, value_name = "S", default_value_t = DopsOptions::default().seed)]
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

impl Find for Dops {
    type Answer = InscribedBodies;
    type Extra = Option<Occlusion>;

    fn input(&self) -> Input<'_> {
        Input { path: &self.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.exports.output()
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.exports.check(&self.path)
    }

    fn open(&self) -> anyhow::Result<Opened> {
        self.reading.open_triangles(&self.path)
    }

    fn solve(
        &self,
        mesh: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedBodies>, Option<Occlusion>)> {
        let solve = |monitor: &Monitor<'_>| {
            let options = DopsOptions { monitor: *monitor, ..self.options() };
            inscribed_dops(mesh.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| mesh.explain(error))?;
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

    fn side_fields(&self, hidden: &Option<Occlusion>) -> Vec<Field> {
        hidden.iter().map(report::occlusion).collect()
    }

    fn write(
        &self,
        found: &mut Solution<InscribedBodies>,
        _: &Option<Occlusion>,
        _: &Opened,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        self.exports.write(found, outputs, monitor)
    }

    fn outcome(&self, _found: &Solution<InscribedBodies>) -> Outcome {
        Outcome::Done
    }
}

impl Dops {
    fn options(&self) -> DopsOptions<'static> {
        DopsOptions {
            directions: self.directions,
            count: self.count,
            disjoint: self.disjoint,
            events: self.events,
            seed: self.seed,
            ..DopsOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};
    use taut::inscribe::DopsOptions;

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Dops::augment_args(clap::Command::new("dops"));
        let matches = command.get_matches_from(["dops", "mesh.off"]);
        let found = super::Dops::from_arg_matches(&matches).unwrap();
        assert_eq!(found.options(), DopsOptions::default());
    }
}
