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
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// Numbers of threads taut is run with where times are taken; elsewhere the last of them.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 120)]
    limit: u64,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "theorem",
        about: "The algorithm of the thesis where its theorem holds: δ = 1/144, ρ = 4, n = 800 L.",
        run: Run::Drawn(100, theorem::run),
    },
    Section {
        name: "slopes",
        about: "Default method, δ = 0.05: how the error falls with n, and what it is at n = 10⁴.",
        run: Run::Drawn(5, slopes::run),
    },
    Section {
        name: "homeomorphism",
        about: "Default method, δ = 0.05, n = 1000 L: how often the curve is right, without and with outliers.",
        run: Run::Drawn(100, homeomorphism::run),
    },
    Section {
        name: "table",
        about: "n = 2000, δ = 0.05, beside published figures of FitConnect on the same law.",
        run: Run::Drawn(5, fitconnect::run),
    },
    Section {
        name: "speed",
        about: "A million noisy points; a million clean ones beside CGAL's Delaunay triangulation of them; growth to ten million.",
        run: Run::Drawn(1, speed::run),
    },
    Section {
        name: "memory",
        about: "Bytes per point above the input, at the peak.",
        run: Run::Drawn(1, memory::run),
    },
    Section {
        name: "sampling",
        about: "Random smooth curves at the sampling ratio that each method is guaranteed for: exactly the true edges.",
        run: Run::Drawn(1000, sampling::run),
    },
    Section {
        name: "tours",
        about: "Tours through samples of curves and through uniform points, beside Concorde's Lin-Kernighan and LKH.",
        run: Run::Drawn(1, tours::run),
    },
    Section {
        name: "coastlines",
        about: "The coastlines of Natural Earth, 404 609 vertices of 4062 rings, shuffled.",
        run: Run::Drawn(1, outlines::coastlines),
    },
    Section {
        name: "glyphs",
        about: "Outlines of 214 glyphs of DejaVu Serif, sampled at an eighth of a stem.",
        run: Run::Drawn(1, outlines::glyphs),
    },
    Section {
        name: "certificates",
        about: "Random trials, dense, sparse, noisy and doctored: none may be certified wrongly.",
        run: Run::Drawn(10_000, certificates::run),
    },
    Section {
        name: "noise-peers",
        about: "n = 2000, δ = 0.05, beside CGAL's reconstruction by optimal transport.",
        run: Run::Drawn(1, transport::run),
    },
];

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(sections) = arguments.choice.of(SECTIONS, "curve")? else { return Ok(()) };
    arguments.draws.check()?;
    let Arguments { runs, threads, limit, .. } = arguments;
    let quick = arguments.choice.quick;
    let mut context = Context::begin(*runs, quick, threads, [*limit, *limit], None)?;
    context.run_sections(sections, arguments.choice.json.as_ref(), |usual| {
        arguments.draws.of(if quick { usual.div_ceil(10) } else { usual })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        assert!(crate::cases::are_unique(SECTIONS));
    }
}
