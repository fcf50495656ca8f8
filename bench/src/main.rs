//! taut beside its peers: the same inputs, one run, every answer checked.
//!
//! `ball` runs the named cases of the minimum enclosing ball, `delaunay` those of Delaunay triangulations, `ellipsoid`
//! those of ellipsoids, `centers` those of k centres, `curve` and `surface` what is shown of curves and surfaces, `oblivious`
//! that of the memory hierarchy; `thesis-ball`, `thesis-ellipsoid`, `thesis-curve` and `thesis-surface` rerun figures and a table
//! of the thesis.
//! The peers are installed by `bench/setup`; one that is missing is named, never skipped in silence.
#![forbid(unsafe_code)]

mod ball;
mod cases;
mod centers;
mod context;
mod curve;
mod delaunay;
mod ellipsoid;
mod goals;
mod input;
mod judge;
mod machine;
mod meter;
mod oblivious;
mod peer;
mod raw;
mod read;
mod report;
mod select;
mod stats;
mod surface;
mod table;
mod thesis;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

/// taut beside its peers on the same inputs, in one run.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    area: Area,
}

#[derive(Subcommand)]
enum Area {
    /// Minimum enclosing balls: times, ratios with spread, and a judgement of every answer.
    Ball(ball::Arguments),
    /// Delaunay triangulations: processor time, memory and the number of simplices, program by program.
    Delaunay(delaunay::Arguments),
    /// Ellipsoids of points and of ellipsoids, and robust ones: times, ratios, and a proof of every answer.
    Ellipsoid(ellipsoid::Arguments),
    /// k centres: times, radii and nodes of proven optima, traversals and streams, with a proof of every answer.
    Centers(centers::Arguments),
    /// Curves: connectivity, errors, times and memory of reconstructions, tours, and what certificates are worth.
    Curve(curve::Arguments),
    /// Surfaces: topology, distances, times and memory of reconstructions beside CGAL's.
    Surface(surface::Arguments),
    /// The memory hierarchy: searching, sorting, transposing, files, sets, trees and more beside peers.
    Oblivious(oblivious::Arguments),
    /// Figures 5 to 15 of the thesis, rerun as CSV and SVG.
    ThesisBall(thesis::Arguments),
    /// Figure 18 of the thesis, core-sets of ellipsoids, rerun as CSV and SVG.
    ThesisEllipsoid(thesis::EllipsoidArguments),
    /// Figures 2, 21 and 22 of the thesis, curves through noisy points, redrawn as SVG.
    ThesisCurve(thesis::CurveArguments),
    /// Table 1 of the thesis, surfaces through points, rerun as CSV with pictures as SVG.
    ThesisSurface(surface::thesis_surface::ThesisArguments),
    /// Solves one raw file and prints seconds per pass and the peak memory of this process.
    #[command(hide = true)]
    SolveFile(ball::file::SolveArguments),
    /// Triangulates one raw file and prints what the build cost.
    #[command(hide = true)]
    OneDelaunay(delaunay::one::OneArguments),
    /// Reconstructs the curves of one raw file and prints what that cost.
    #[command(hide = true)]
    OneCurve(curve::one::OneArguments),
    /// Reconstructs the surface of one raw file and prints what that cost.
    #[command(hide = true)]
    OneSurface(surface::one::OneArguments),
    /// Sorts, transposes or copies one file and prints what that cost.
    #[command(hide = true)]
    OneOblivious(oblivious::one::OneArguments),
    /// Encloses one raw file in an ellipsoid and prints passes and the peak memory of this process.
    #[command(hide = true)]
    SolveEllipsoid(ellipsoid::file::SolveArguments),
    /// Serves the crate miniball as a peer.
    #[command(hide = true)]
    PeerCrate {
        /// The input, with its header of rows and columns.
        input: PathBuf,
        /// Where the centre goes.
        center: PathBuf,
    },
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().area {
        Area::Ball(arguments) => ball::run(&arguments),
        Area::Delaunay(arguments) => delaunay::run(&arguments),
        Area::Ellipsoid(arguments) => ellipsoid::run(&arguments),
        Area::Centers(arguments) => centers::run(&arguments),
        Area::Curve(arguments) => curve::run(&arguments),
        Area::Surface(arguments) => surface::run(&arguments),
        Area::Oblivious(arguments) => oblivious::run(&arguments),
        Area::ThesisBall(arguments) => thesis::run(&arguments),
        Area::ThesisEllipsoid(arguments) => thesis::run_ellipsoid(&arguments),
        Area::ThesisCurve(arguments) => thesis::run_curve(&arguments),
        Area::ThesisSurface(arguments) => surface::thesis_surface::run(&arguments),
        Area::SolveFile(arguments) => ball::file::solve(&arguments),
        Area::SolveEllipsoid(arguments) => ellipsoid::file::solve(&arguments),
        Area::OneDelaunay(arguments) => delaunay::one::run(&arguments),
        Area::OneCurve(arguments) => curve::one::run(&arguments),
        Area::OneSurface(arguments) => surface::one::run(&arguments),
        Area::OneOblivious(arguments) => oblivious::one::run(&arguments),
        Area::PeerCrate { input, center } => peer::serve_crate(&input, &center),
    }
}
