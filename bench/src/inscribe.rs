//! Shapes inside polygons and meshes: beside shapely and polylabel in the plane, drake, V-HACD and CoACD in space.

mod bodies;
mod circles;
mod coverage;
mod occluders;
mod searches;
pub(crate) mod shapes;
mod threads;

use taut_certify::{InscribedBodies, Solution};
use taut_inscribe::{BodiesOptions, BodyShape, OcclusionOptions, inscribed_bodies, occlusion};
use taut_inscribe::{CircleOptions, EllipseOptions, inscribed_circle, inscribed_ellipse};

use crate::prelude::*;
use shapes::{COUNTRIES_10M, COUNTRIES_110M, Mesh, Model, countries, model};

/// All sections. Searches have one thread, so that times by the clock are those of one core.
pub(crate) const AREA: Area<Run> = Area {
    name: "inscribe",
    sections: &[
        runs("ellipse", searches::ellipses)
            .about("The largest ellipse in outlines of countries, searched and proved."),
        runs("triangle", searches::triangles)
            .about("The largest triangle in outlines of countries, searched and proved."),
        runs("circle", circles::circles)
            .about("The largest circle in outlines of countries, beside shapely and polylabel."),
        runs("threads", threads::threads)
            .about("Searches of 10⁵ cells for triangles and ellipses by one thread and by two."),
        runs("packing", bodies::packing)
            .about("18-dops, overlapping and disjoint: coverage, time, certificates, occlusion."),
        runs("occlusion", occluders::occlusions)
            .about("Ten bodies of each model: lines hidden by k-dops and free bodies, searched by volume and by lines."),
        runs("peers", bodies::peers).about(
            "A body with free facets beside drake's Iris from its seed; packings beside V-HACD and CoACD, with what lies outside.",
        ),
    ],
    runs: 3,
    threads: &[1],
    limit: 300,
    peer_budget: 300,
};
