//! taut beside its peers: the same inputs, one run, every answer checked.
//!
//! Each area is a command with its sections: minimum enclosing balls, Delaunay triangulations, ellipsoids, k centers,
//! curves, surfaces, shapes inside others, balls of kernels and the memory hierarchy; `thesis` reruns the figures and the table of the thesis.
//! The peers are installed by `bench/setup`; one that is missing is named, never skipped in silence.
#![forbid(unsafe_code)]

mod area;
mod ball;
mod centers;
mod context;
mod curve;
mod data;
mod delaunay;
mod ellipsoid;
mod goals;
mod input;
mod inscribe;
mod job;
mod judge;
mod machine;
mod meter;
mod oblivious;
mod outcome;
mod outofcore;
mod peer;
mod prelude;
mod process;
mod raw;
mod read;
mod recognize;
mod report;
mod rounds;
mod stats;
mod surface;
mod table;
mod thesis;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use area::Options;

/// taut beside its peers on the same inputs, in one run.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Minimum enclosing balls: times, ratios with spread, and a judgement of every answer.
    Ball(Options),
    /// Delaunay triangulations: processor time, memory and the number of simplices, program by program.
    Delaunay(delaunay::Arguments),
    /// Delaunay triangulations of more points than memory holds: times, memory, disk, and the method of the thesis.
    Outofcore(outofcore::Arguments),
    /// Ellipsoids of points and of ellipsoids, and robust ones: times, ratios, and a proof of every answer.
    Ellipsoid(Options),
    /// k centers: times, radii and nodes of proven optima, traversals and streams, with a proof of every answer.
    Centers(Options),
    /// Curves: connectivity, errors, times and memory of reconstructions, tours, and what certificates are worth.
    Curve(Options),
    /// Surfaces: topology, distances, times and memory of reconstructions beside CGAL's.
    Surface(Options),
    /// Shapes inside polygons and meshes: times, coverage, proofs, beside shapely, drake, V-HACD and CoACD.
    Inscribe(Options),
    /// Balls in the feature space of a kernel, beside scikit-learn.
    Recognize(Options),
    /// The memory hierarchy: searching, sorting, transposing, files, sets, trees and more beside peers.
    Oblivious(Options),
    /// The figures and the table of the thesis, rerun as CSV and SVG; without names it lists them.
    Thesis(thesis::Arguments),
    /// Does one piece of work and prints what it cost as one line of JSON.
    #[command(hide = true)]
    Job {
        /// The work, as JSON.
        job: String,
    },
    /// Serves the crate miniball as a peer.
    #[command(hide = true)]
    PeerCrate {
        /// The input, with its header of rows and columns.
        input: PathBuf,
        /// Where the center goes.
        center: PathBuf,
    },
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().command {
        Command::Ball(options) => ball::AREA.run_all(&options),
        Command::Delaunay(arguments) => delaunay::run(&arguments),
        Command::Outofcore(arguments) => outofcore::run(&arguments),
        Command::Ellipsoid(options) => ellipsoid::AREA.run_all(&options),
        Command::Centers(options) => centers::AREA.run_all(&options),
        Command::Curve(options) => curve::AREA.run_all(&options),
        Command::Surface(options) => surface::AREA.run_all(&options),
        Command::Inscribe(options) => inscribe::AREA.run_all(&options),
        Command::Recognize(options) => recognize::AREA.run_all(&options),
        Command::Oblivious(options) => oblivious::run(&options),
        Command::Thesis(arguments) => thesis::run(&arguments),
        Command::Job { job } => job::Job::perform(&job),
        Command::PeerCrate { input, center } => peer::serve_crate(&input, &center),
    }
}
