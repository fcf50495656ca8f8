//! Curves: right connectivity, errors, times and memory of reconstructions, tours, and what certificates are worth.

mod certificates;
mod drawn;
mod fitconnect;
mod homeomorphism;
mod memory;
pub(crate) mod one;
mod outlines;
mod sampling;
mod slopes;
mod speed;
mod theorem;
mod tours;
mod transport;

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
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// Inputs of a tenth of their size and a tenth of the draws: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
    /// Numbers of threads taut is run with where times are taken; elsewhere the last of them.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 120)]
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
    run: fn(&Context, std::ops::Range<u64>) -> Result<Value>,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "theorem",
        about: "The algorithm of the thesis where its theorem holds: δ = 1/144, ρ = 4, n = 800 L.",
        seeds: 100,
        run: theorem::run,
    },
    Section {
        name: "slopes",
        about: "Default method, δ = 0.05: how the error falls with n, and what it is at n = 10⁴.",
        seeds: 5,
        run: slopes::run,
    },
    Section {
        name: "homeomorphism",
        about: "Default method, δ = 0.05, n = 1000 L: how often the curve is right, without and with outliers.",
        seeds: 100,
        run: homeomorphism::run,
    },
    Section {
        name: "table",
        about: "n = 2000, δ = 0.05, beside published figures of FitConnect on the same law.",
        seeds: 5,
        run: fitconnect::run,
    },
    Section {
        name: "speed",
        about: "A million noisy points; a million clean ones beside CGAL's Delaunay triangulation of them; growth to ten million.",
        seeds: 1,
        run: speed::run,
    },
    Section {
        name: "memory",
        about: "Bytes per point above the input, at the peak.",
        seeds: 1,
        run: memory::run,
    },
    Section {
        name: "sampling",
        about: "Random smooth curves at the sampling ratio that each method is guaranteed for: exactly the true edges.",
        seeds: 1000,
        run: sampling::run,
    },
    Section {
        name: "tours",
        about: "Tours through samples of curves and through uniform points, beside Concorde's Lin-Kernighan and LKH.",
        seeds: 1,
        run: tours::run,
    },
    Section {
        name: "coastlines",
        about: "The coastlines of Natural Earth, 404 609 vertices of 4062 rings, shuffled.",
        seeds: 1,
        run: outlines::coastlines,
    },
    Section {
        name: "glyphs",
        about: "Outlines of 214 glyphs of DejaVu Serif, sampled at an eighth of a stem.",
        seeds: 1,
        run: outlines::glyphs,
    },
    Section {
        name: "certificates",
        about: "Random trials, dense, sparse, noisy and doctored: none may be certified wrongly.",
        seeds: 10_000,
        run: certificates::run,
    },
    Section {
        name: "noise-peers",
        about: "n = 2000, δ = 0.05, beside CGAL's reconstruction by optimal transport.",
        seeds: 1,
        run: transport::run,
    },
];

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for section in SECTIONS {
            println!("{:<16} {}", section.name, section.about);
        }
        return Ok(());
    }
    let sections = select(SECTIONS, |section| section.name, &arguments.cases, "curve")?;
    ensure!(arguments.seeds != Some(0), "at least one seed");
    let Arguments { runs, quick, threads, limit, .. } = arguments;
    let mut context = Context::begin(*runs, *quick, threads, [*limit, *limit], None)?;
    let head = |section: &'static Section| [section.name, section.about];
    context.run_all(sections, arguments.json.as_ref(), head, |context, section| {
        let usual = if *quick { section.seeds.div_ceil(10) } else { section.seeds };
        let first = arguments.first_seed;
        let seeds = first..first + arguments.seeds.unwrap_or(usual);
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
