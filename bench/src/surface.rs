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

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Result, ensure};
use serde_json::{Value, json};

use crate::context::Context;
use crate::select::select;

/// Sections and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Sections to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    cases: Vec<String>,
    /// Show the sections and do nothing.
    #[arg(long)]
    list: bool,
    /// Draws of each input [default: those of the section].
    #[arg(long)]
    seeds: Option<u64>,
    /// The first seed.
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// Rounds where times are taken; the least of them counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Inputs of a tenth of their size where they are drawn, and two of the seven meshes: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
    /// Threads of taut where the total time is taken; extraction has one.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 300)]
    limit: u64,
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// A section: a part of what has to be shown.
struct Section {
    name: &'static str,
    about: &'static str,
    /// Draws of each input, unless said otherwise.
    seeds: u64,
    run: fn(&Context, Range<u64>) -> Result<Value>,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "topology",
        about: "Default options on seven closed meshes, whole and thinned at random, on blob5 and on the bunny: parts, handles, loops.",
        seeds: 3,
        run: topology::run,
    },
    Section {
        name: "accuracy",
        about: "Distances from the reference to the result, over those of CGAL's advancing front.",
        seeds: 1,
        run: accuracy::run,
    },
    Section {
        name: "open",
        about: "Open mode: the bunny, a random hemisphere, two random sheets five spacings apart, a Möbius band.",
        seeds: 3,
        run: open::run,
    },
    Section {
        name: "speed",
        about: "Total time, and extraction alone on one thread, beside CGAL's advancing front by turns.",
        seeds: 1,
        run: speed::run,
    },
    Section {
        name: "components",
        about: "300 ellipsoids beside CGAL, and 1000 of 100 points beside one of 100 000.",
        seeds: 1,
        run: components::run,
    },
    Section {
        name: "million",
        about: "A million random points of dc: topology, time and bytes per point at the peak.",
        seeds: 1,
        run: million::run,
    },
    Section {
        name: "noise",
        about: "The bunny with noise of a thousandth of its diagonal, with the pre-pass, beside CGAL's interpolation.",
        seeds: 1,
        run: noise::run,
    },
    Section {
        name: "check",
        about: "Checking beside solving: four meshes, solids with flat faces at random, a million points of a smooth body.",
        seeds: 1,
        run: checking::run,
    },
    Section {
        name: "others",
        about: "Ball pivoting and Poisson reconstruction of Open3D and pymeshlab, beside taut and CGAL on the bunny and dc.",
        seeds: 1,
        run: others::run,
    },
    Section {
        name: "thesis",
        about: "Table 1 of the thesis beside the method of the thesis and the default, on the data that exists and on stand-ins.",
        seeds: 1,
        run: table_one::run,
    },
];

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for section in SECTIONS {
            println!("{:<12} {}", section.name, section.about);
        }
        return Ok(());
    }
    let sections = select(SECTIONS, |section| section.name, &arguments.cases, "surface")?;
    ensure!(arguments.seeds != Some(0), "at least one seed");
    let Arguments { runs, quick, threads, limit, .. } = arguments;
    let mut context = Context::begin(*runs, *quick, &[*threads], [*limit, *limit], None)?;
    let head = |section: &'static Section| [section.name, section.about];
    context.run_all(sections, arguments.json.as_ref(), head, |context, section| {
        let first = arguments.first_seed;
        let seeds = first..first + arguments.seeds.unwrap_or(section.seeds);
        let measured = (section.run)(context, seeds)?;
        context.report.add(json!({ "name": section.name, "measured": measured }));
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        for (at, section) in SECTIONS.iter().enumerate() {
            assert!(SECTIONS[..at].iter().all(|o| o.name != section.name), "{}", section.name);
            assert!(section.seeds > 0);
        }
    }
}
