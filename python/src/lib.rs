//! The Python package of taut: thin bindings.
//!
//! The functions that a user calls are in `taut/*.py` with its documentation, and so are the classes of answers; here is what Python cannot
//! do: view an array as points without a copy (`rows`), work with the interpreter released and still react to Ctrl-C (`work`),
//! hold a solution (`found`), and hand over its data (`object`). No geometry is calculated in this crate.
#![forbid(unsafe_code)]

mod ball;
mod bodies;
mod body_mesh;
mod centers;
mod choice;
mod classify;
mod curve;
mod delaunay;
mod delaunay_parts;
mod dop;
mod ellipsoid;
mod farthest_first;
mod files;
mod found;
mod generate;
mod inscribed;
mod io;
mod items;
mod mosaic;
mod names;
mod numbers;
mod object;
mod passes;
mod picture;
mod planar;
mod robust;
mod rows;
mod sphere_search;
mod sphere_tree;
mod surface;
mod terrain;
mod tiles;
mod triangulation;
mod work;

use pyo3::prelude::*;

/// The compiled part of `taut`; import `taut` instead.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::ball::{ball, kernel_ball};
    #[pymodule_export]
    use crate::bodies::{box_rows, inscribed_bodies, scene_rows};
    #[pymodule_export]
    use crate::body_mesh::body_mesh;
    #[pymodule_export]
    use crate::centers::centers;
    #[pymodule_export]
    use crate::classify::{Classifier, train_classifier};
    #[pymodule_export]
    use crate::curve::curve;
    #[pymodule_export]
    use crate::delaunay::{delaunay, spatial_order};
    #[pymodule_export]
    use crate::delaunay_parts::{deal_points, merge_extents, triangulate_fronts, triangulate_leaf};
    #[pymodule_export]
    use crate::dop::bounding_dop;
    #[pymodule_export]
    use crate::ellipsoid::{ellipsoid, ellipsoids, norms};
    #[pymodule_export]
    use crate::farthest_first::farthest_first;
    #[pymodule_export]
    use crate::files::{FoundFile, sample, sort_file, transpose_file};
    #[pymodule_export]
    use crate::found::{Found, Violation};
    #[pymodule_export]
    use crate::generate::generate;
    #[pymodule_export]
    use crate::inscribed::inscribed_ellipsoid;
    #[pymodule_export]
    use crate::io::{read_points, write_mesh};
    #[pymodule_export]
    use crate::mosaic::OpenTiles;
    #[pymodule_export]
    use crate::names::names;
    #[pymodule_export]
    use crate::passes::{
        PassSolver, RobustPasses, add_to_stream, check_part, check_parts, merge_partials,
        merge_verdicts, new_stream, query_shape, rows_of_block, run_query,
    };
    #[pymodule_export]
    use crate::planar::{
        inscribed_circle, inscribed_ellipse, inscribed_oriented_rectangle, inscribed_polygon,
        inscribed_rectangle, inscribed_triangle,
    };
    #[pymodule_export]
    use crate::robust::robust_ellipsoid;
    #[pymodule_export]
    use crate::sphere_search::SearchTree;
    #[pymodule_export]
    use crate::sphere_tree::sphere_tree;
    #[pymodule_export]
    use crate::surface::surface;
    #[pymodule_export]
    use crate::terrain::{contours, raster};
    #[pymodule_export]
    use crate::tiles::{check_tiles, delaunay_tiles};
    #[pymodule_export]
    use crate::triangulation::{KeptTriangulation, hull};

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
