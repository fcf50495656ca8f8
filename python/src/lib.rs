//! The Python package of taut: thin bindings.
//!
//! What a user calls is in `taut/*.py` with its documentation; here is what Python cannot do: view an array as
//! points without a copy (`rows`), work with the interpreter released and still hear Ctrl-C (`work`), and hold
//! a solution (`solution`). No geometry is calculated in this crate.
#![forbid(unsafe_code)]

mod ball;
mod centers;
mod curve;
mod delaunay;
mod ellipsoid;
mod farthest_first;
mod files;
mod generate;
mod inscribed;
mod items;
mod numbers;
mod order;
mod robust;
mod rows;
mod solution;
mod sphere_tree;
mod surface;
mod triangulation;
mod work;

use pyo3::prelude::*;

/// The compiled part of `taut`; import `taut` instead.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::ball::ball;
    #[pymodule_export]
    use crate::centers::{Centers, CentersCertificate, CentersVerdict, centers};
    #[pymodule_export]
    use crate::curve::{Curve, CurveCertificate, CurveComponent, CurveVerdict, curve};
    #[pymodule_export]
    use crate::delaunay::delaunay;
    #[pymodule_export]
    use crate::ellipsoid::{
        Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Hull, ellipsoid, ellipsoids,
    };
    #[pymodule_export]
    use crate::farthest_first::{FarthestFirst, farthest_first};
    #[pymodule_export]
    use crate::files::{FileSolution, FileVerdict, sample, sort_file, transpose_file};
    #[pymodule_export]
    use crate::generate::generate;
    #[pymodule_export]
    use crate::inscribed::{
        InscribedCertificate, InscribedEllipsoid, InscribedVerdict, inscribed_ellipsoid,
    };
    #[pymodule_export]
    use crate::order::{Order, OrderCertificate, OrderVerdict, spatial_order};
    #[pymodule_export]
    use crate::robust::{RobustCertificate, RobustEllipsoid, RobustVerdict, robust_ellipsoid};
    #[pymodule_export]
    use crate::solution::{Ball, BallCertificate, PassBounds, Solution, Trace, Verdict, Violation};
    #[pymodule_export]
    use crate::sphere_tree::{SphereTree, sphere_tree};
    #[pymodule_export]
    use crate::surface::{Surface, SurfaceCertificate, SurfaceComponent, SurfaceVerdict, surface};
    #[pymodule_export]
    use crate::triangulation::{Triangulation, TriangulationCertificate, TriangulationVerdict};

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
