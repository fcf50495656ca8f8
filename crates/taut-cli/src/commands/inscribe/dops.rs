//! `taut inscribe dops`: convex bodies with facets in fixed directions inside a triangle mesh.

use taut::certify::InscribedBodies;
use taut::inscribe::{BodyShape, Occlusion};
use taut::{Monitor, Solution};

use super::bodies::Search;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::writing::Outputs;
use crate::pipeline::{Find, Input, Output};
use crate::reports::Field;
use crate::watch::Watch;

/// Find large convex bodies inside a triangle mesh, with facets in k fixed directions (k-dops).
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each edge of the mesh must belong to an even number of triangles; if not, the message names one, and --close-holes closes the
mesh by triangles that the answer names. Inside is decided by the even-odd rule, however triangles are turned. That each body
lies inside is proved. How much of the inside the bodies cover is an estimate, and nothing is claimed about how much such bodies
can cover. Bodies with facets in any directions cover more: taut inscribe bodies.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut inscribe dops horse.off --count 10 -o bodies.json --draw bodies.html &&
         taut verify bodies.json horse.off
         taut inscribe dops horse.off --count 10 -o bodies.glb --parts collision")]
pub(super) struct Dops {
    /// Directions of the facets: 6, 14, 18 or 26
    #[arg(short = 'k', long, value_name = "K", default_value_t = 18)]
    directions: usize,
    #[command(flatten)]
    search: Search,
}

impl Find for Dops {
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

    fn open(&self) -> anyhow::Result<Opened> {
        self.search.open()
    }

    fn solve(
        &self,
        mesh: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedBodies>, Option<Occlusion>)> {
        self.search.solve(BodyShape::Dop(self.directions), mesh, watch)
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
