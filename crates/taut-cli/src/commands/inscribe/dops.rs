//! `taut inscribe dops`: convex bodies with facets in fixed directions inside a triangle mesh.

use taut::certify::InscribedBodies;
use taut::inscribe::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, Occlusion, ThesisSeeds,
};
use taut::{Monitor, Solution};

use super::bodies::{Search, Seeds};
use crate::exit::Outcome;
use crate::input::choice::{check_method_options, choice};
use crate::input::reading::Opened;
use crate::output::writing::Outputs;
use crate::pipeline::{Find, Input, Output};
use crate::reports::Field;
use crate::watch::Watch;

/// Find large convex bodies inside a triangle mesh, with facets in k fixed directions (k-dops).
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each edge of the mesh must belong to an even number of triangles; if not, the message names one, and --close-holes \
closes the mesh by triangles that the answer names. Inside is decided by the even-odd rule, however triangles are \
turned. That each body lies inside is proved. How much of the inside the bodies cover is an estimate, and nothing is \
claimed about how much such bodies can cover. Bodies with facets in any directions cover more: taut inscribe bodies. \
To check an answer with --obstacles, or draw it, give verify and draw the same.
The method thesis finds disjoint bodies without a budget of events; its inside test needs triangles that are turned \
alike.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut inscribe dops horse.off --count 10 -o bodies.json --draw bodies.html &&
         taut verify bodies.json horse.off
         taut inscribe dops horse.off --count 10 -o bodies.glb --parts collision
         taut inscribe dops horse.off --direction 3,4,0 --direction=-4,3,0 --direction 0,0,1")]
pub(super) struct Dops {
    /// Directions of the facets: 6, 14, 18 or 26
    #[arg(short = 'k', long, value_name = "K", default_value_t = 18, conflicts_with = "direction")]
    directions: usize,
    /// A direction of facets of your own, in whole numbers whose absolute values add up to at most 63; give from 3 to 13, each
    /// makes two facets, along it and against it
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    direction: Vec<[i64; 3]>,
    /// The way to find them
    #[arg(long, value_name = "NAME", default_value = BodiesMethod::default().name(), value_parser = choice::<BodiesMethod>())]
    method: BodiesMethod,
    /// Of thesis, where dops start [default: grid]
    #[arg(long, value_name = "NAME", value_parser = choice::<ThesisSeeds>())]
    seeds: Option<ThesisSeeds>,
    /// Of thesis, cells of the grid of seeds along the longest side, from 2 to 256 [default: 32]
    #[arg(long, value_name = "N")]
    cells: Option<usize>,
    /// Of thesis, how many of the nearest vertices vote on whether a point is inside, from 1 to 100 [default: 5]
    #[arg(long, value_name = "N")]
    votes: Option<usize>,
    /// Of thesis, move a dop that has doubled its size away from what it touches, and double again
    #[arg(long)]
    translate: bool,
    /// Of thesis, start a dop around the centers of the largest sphere and its largest neighbor
    #[arg(long)]
    merge: bool,
    #[command(flatten)]
    search: Search,
}

/// Reads three whole numbers between commas.
fn direction(text: &str) -> Result<[i64; 3], String> {
    let numbers: Result<Vec<i64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let found = numbers.ok().and_then(|numbers| <[i64; 3]>::try_from(numbers).ok());
    found.ok_or_else(|| "expected three whole numbers between commas, as 1,-2,0".to_owned())
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
        let given = [
            ("seeds", self.seeds.is_some()),
            ("cells", self.cells.is_some()),
            ("votes", self.votes.is_some()),
            ("translate", self.translate),
            ("merge", self.merge),
        ];
        let of_events = self.search.of_events();
        let given = [&given[..], &of_events[..]].concat();
        check_method_options(self.method.name(), &given, |option, method: &BodiesMethod| {
            let is_of_events = of_events.iter().any(|&(name, _)| name == option);
            matches!(method, BodiesMethod::Thesis(_)) != is_of_events
        })?;
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
        self.search.solve(self.options(&self.search.seeds()), mesh, watch)
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

impl Dops {
    fn options<'a>(&'a self, seeds: &'a Seeds) -> BodiesOptions<'a> {
        let shape = match &self.direction[..] {
            [] => BodyShape::Dop(self.directions),
            given => BodyShape::Directions(given),
        };
        let usual = BodiesThesisOptions::default();
        let method = match self.method {
            BodiesMethod::Thesis(_) => BodiesMethod::Thesis(BodiesThesisOptions {
                seeds: self.seeds.unwrap_or(usual.seeds),
                cells: self.cells.unwrap_or(usual.cells),
                votes: self.votes.unwrap_or(usual.votes),
                translate: self.translate,
                merge: self.merge,
            }),
            other => other,
        };
        BodiesOptions { method, ..self.search.options(shape, seeds) }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};
    use taut::inscribe::{
        BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, ThesisSeeds,
    };

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let found = |line: &str| {
            let command = super::Dops::augment_args(clap::Command::new("dops"));
            let matches = command.get_matches_from(line.split_whitespace());
            super::Dops::from_arg_matches(&matches).unwrap()
        };
        let usual = BodiesOptions { shape: BodyShape::Dop(18), ..Default::default() };
        let none = super::Seeds::default();
        assert_eq!(found("dops mesh.off").options(&none), usual);
        let given = "dops mesh.off --direction 1,-2,0 --direction=-1,0,0 --direction 0,0,7";
        let expected = BodyShape::Directions(&[[1, -2, 0], [-1, 0, 0], [0, 0, 7]]);
        assert_eq!(found(given).options(&none).shape, expected);
        for wrong in ["1,2", "1,2,0.5", "1,2,3,4", ""] {
            assert!(super::direction(wrong).is_err(), "{wrong}");
        }
        let thesis = found("dops mesh.off --method thesis");
        let expected = BodiesMethod::Thesis(BodiesThesisOptions::default());
        assert_eq!(thesis.options(&none), BodiesOptions { method: expected, ..usual.clone() });
        let line =
            "dops mesh.off --method thesis --seeds random --cells 9 --votes 2 --translate --merge";
        let seeds = ThesisSeeds::Random;
        let other = BodiesThesisOptions { seeds, cells: 9, votes: 2, translate: true, merge: true };
        assert_eq!(found(line).options(&none).method, BodiesMethod::Thesis(other));
    }
}
