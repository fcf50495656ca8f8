//! Surfaces: topology, distances, times and memory of reconstructions beside CGAL's.

mod accuracy;
mod checking;
mod components;
mod distances;
pub(crate) mod found;
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
pub(crate) mod table_one;
mod timed;
mod topology;
mod unseen;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::{Deserialize, Serialize};
use taut_certify::{Solution, Surface};
use taut_io::{Content, Mesh, open_mesh};
use taut_mesh::{TriangleMesh, compare_surfaces};
use taut_reconstruct::{
    Denoise, SurfaceMethod, SurfaceMode, SurfaceOptions, looks_one_sided, surface,
};

use crate::delaunay::program::Program;
use crate::prelude::*;
use distances::Distances;
use found::{FRONT, PEERS, SCALES, ours, theirs};
use judged::Judged;
use models::{ANCHOR, BLOB5, BUNNY, DC, HORSE, Model, SEVEN, cactus};
use samples::{
    Point, band, cap, chances, ellipsoids, fist, hemisphere, noisy, on_triangles, pear, rings,
    saddles, sheets, spiral, staircase, thinned, towers, wedge,
};
use solids::{Place, Solid, handles};
use timed::Timed;

/// All sections; extraction has one thread.
pub(crate) const AREA: Area<Run> = Area {
    name: "surface",
    sections: &[
        runs("topology", topology::run)
            .about(
                "Default options on seven closed meshes, whole and thinned at random, on \
                 blob5 and on the bunny: parts, handles, loops.",
            )
            .draws(3),
        runs("accuracy", accuracy::run).about(
            "Distances from the reference to the result, over those of CGAL's advancing front.",
        ),
        runs("open", open::run)
            .about(
                "Open mode: the bunny, a random hemisphere, two random sheets five spacings \
                 apart, a Möbius band.",
            )
            .draws(3),
        runs("speed", speed::run).about(
            "Total time, and extraction alone on one thread, beside CGAL's advancing \
                 front by turns.",
        ),
        runs("components", components::run)
            .about("300 ellipsoids beside CGAL, and 1000 of 100 points beside one of 100 000."),
        runs("million", million::run).about(
            "A million random points of dc: topology, time and bytes per point at the peak.",
        ),
        runs("noise", noise::run).about(
            "The bunny with noise of a thousandth of its diagonal, with the pre-pass, \
                 beside CGAL's interpolation.",
        ),
        runs("check", checking::run).about(
            "Checking beside solving: four meshes, solids with flat faces at random, a \
                 million points of a smooth body.",
        ),
        runs("others", others::run).about(
            "Ball pivoting and Poisson reconstruction of Open3D and pymeshlab, beside \
                 taut and CGAL on the bunny and dc.",
        ),
        runs("unseen", unseen::small)
            .about(
                "Closed shapes of sixteen classes at 5000 points, sampled in three ways, walls \
                 or gaps 1.2 to 6 spacings thick: exact rates by class, false certificates.",
            )
            .extra(),
        runs("unseen-20k", unseen::middling).about("The same at 20 000 points.").extra(),
        runs("unseen-80k", unseen::large).about("The same at 80 000 points.").extra(),
        runs("unseen-open", unseen::even)
            .about(
                "Pieces of surfaces of fifteen classes, with small holes and larger ones, at 20 000 \
                 points, sampled in three ways: right boundary loops by class.",
            )
            .extra(),
        runs("unseen-scans", unseen::scans)
            .about("The same along lines 3, 5 and 8 times as far apart as points on them.")
            .extra(),
        runs("unseen-noise", unseen::noise)
            .about(
                "Smooth closed shapes of 50 000 points with noise of 0.1 and 0.5 % of the diagonal, \
                 with the pre-pass, beside CGAL's advancing front.",
            )
            .extra(),
        runs("unseen-outliers", unseen::outliers)
            .about("The same shapes with one outlier for a hundred points.")
            .extra(),
        runs("thesis", table_one::run).about(
            "Table 1 of the thesis beside the method of the thesis and the default, on \
                 the data that exists and on stand-ins.",
        ),
    ],
    runs: 5,
    threads: &[2],
    limit: 300,
    peer_budget: 300,
};
