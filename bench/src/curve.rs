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

use std::collections::HashMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use taut_certify::{Curve, Solution};
use taut_mesh::{EdgeScore, Polyline, Quality, compare, crossings, edge_score};
use taut_points::generate::curves::{
    CurveNoise, TestCurve, TruthCurves, epsilon_sample, sample_curve,
};
use taut_reconstruct::{CurveMethod, CurveOptions, CurveThesisOptions, curve};

use crate::delaunay::program::{CGAL, Program};
use crate::prelude::*;
use drawn::{CURVES, NOISE, Trials, few, found_edges, found_lines, solve, true_lines, truth};

/// All sections; draws are those of each input.
pub(crate) const AREA: Area<Run> = Area {
    name: "curve",
    sections: &[
        runs("theorem", theorem::run)
            .about(
                "The algorithm of the thesis where its theorem holds: δ = 1/144, ρ = 4, n = 800 L.",
            )
            .draws(100),
        runs("slopes", slopes::run)
            .about(
                "Default method, δ = 0.05: how the error falls with n, and what it is at n = 10⁴.",
            )
            .draws(5),
        runs("homeomorphism", homeomorphism::run)
            .about(
                "Default method, δ = 0.05, n = 1000 L: how often the curve is right, without \
                 and with outliers.",
            )
            .draws(100),
        runs("table", fitconnect::run)
            .about("n = 2000, δ = 0.05, beside published figures of FitConnect on the same law.")
            .draws(5),
        runs("speed", speed::run).about(
            "A million noisy points; a million clean ones beside CGAL's Delaunay \
                 triangulation of them; growth to ten million.",
        ),
        runs("memory", memory::run).about("Bytes per point above the input, at the peak."),
        runs("sampling", sampling::run)
            .about(
                "Random smooth curves at the sampling ratio that each method is guaranteed \
                 for: exactly the true edges.",
            )
            .draws(1000),
        runs("tours", tours::run).about(
            "Tours through samples of curves and through uniform points, beside \
                 Concorde's Lin-Kernighan and LKH.",
        ),
        runs("coastlines", outlines::coastlines)
            .about("The coastlines of Natural Earth, 404 609 vertices of 4062 rings, shuffled."),
        runs("glyphs", outlines::glyphs)
            .about("Outlines of 214 glyphs of DejaVu Serif, sampled at an eighth of a stem."),
        runs("certificates", certificates::run)
            .about(
                "Random trials, dense, sparse, noisy and doctored: none may be certified wrongly.",
            )
            .draws(10_000),
        runs("noise-peers", transport::run)
            .about("n = 2000, δ = 0.05, beside CGAL's reconstruction by optimal transport."),
    ],
    runs: 3,
    threads: &[1, 2],
    limit: 120,
    peer_budget: 120,
};
