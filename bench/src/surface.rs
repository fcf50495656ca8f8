//! Surfaces: topology, distances, times and memory of reconstructions beside CGAL's.

mod accuracy;
mod checking;
mod components;
mod distances;
mod found;
mod judged;
mod million;
mod models;
mod noise;
pub(crate) mod one;
mod open;
mod others;
mod samples;
mod solids;
mod speed;
mod table_one;
pub(crate) mod thesis_surface;
mod timed;
mod topology;

use anyhow::Result;

use crate::cases::{Choice, Draws, Run, Section};
use crate::context::Context;

/// Sections and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    draws: Draws,
    /// Rounds where times are taken; the least of them counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Threads of taut where the total time is taken; extraction has one.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 300)]
    limit: u64,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "topology",
        about: "Default options on seven closed meshes, whole and thinned at random, on blob5 and on the bunny: parts, handles, loops.",
        run: Run::Drawn(3, topology::run),
    },
    Section {
        name: "accuracy",
        about: "Distances from the reference to the result, over those of CGAL's advancing front.",
        run: Run::Drawn(1, accuracy::run),
    },
    Section {
        name: "open",
        about: "Open mode: the bunny, a random hemisphere, two random sheets five spacings apart, a Möbius band.",
        run: Run::Drawn(3, open::run),
    },
    Section {
        name: "speed",
        about: "Total time, and extraction alone on one thread, beside CGAL's advancing front by turns.",
        run: Run::Drawn(1, speed::run),
    },
    Section {
        name: "components",
        about: "300 ellipsoids beside CGAL, and 1000 of 100 points beside one of 100 000.",
        run: Run::Drawn(1, components::run),
    },
    Section {
        name: "million",
        about: "A million random points of dc: topology, time and bytes per point at the peak.",
        run: Run::Drawn(1, million::run),
    },
    Section {
        name: "noise",
        about: "The bunny with noise of a thousandth of its diagonal, with the pre-pass, beside CGAL's interpolation.",
        run: Run::Drawn(1, noise::run),
    },
    Section {
        name: "check",
        about: "Checking beside solving: four meshes, solids with flat faces at random, a million points of a smooth body.",
        run: Run::Drawn(1, checking::run),
    },
    Section {
        name: "others",
        about: "Ball pivoting and Poisson reconstruction of Open3D and pymeshlab, beside taut and CGAL on the bunny and dc.",
        run: Run::Drawn(1, others::run),
    },
    Section {
        name: "thesis",
        about: "Table 1 of the thesis beside the method of the thesis and the default, on the data that exists and on stand-ins.",
        run: Run::Drawn(1, table_one::run),
    },
];

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(sections) = arguments.choice.of(SECTIONS, "surface")? else { return Ok(()) };
    arguments.draws.check()?;
    let Arguments { runs, threads, limit, .. } = arguments;
    let quick = arguments.choice.quick;
    let mut context = Context::begin(*runs, quick, &[*threads], [*limit, *limit], None)?;
    context
        .run_sections(sections, arguments.choice.json.as_ref(), |usual| arguments.draws.of(usual))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        assert!(crate::cases::are_unique(SECTIONS));
    }
}
