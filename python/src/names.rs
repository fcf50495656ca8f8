//! The words that options know, for tests to compare with the literals of the Python signatures.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use taut::certify::{OrderCurve, SurfaceMethod};
use taut::delaunay::InsertionOrder;
use taut::inscribe::{BodiesMethod, EllipseMethod, Objective, ThesisSeeds, TriangleMethod};
use taut::oblivious::external::KeyKind;
use taut::points::{Choice, Distribution};
use taut::reconstruct::thesis::Priority;
use taut::{BallMethod, CentersMethod, CurveMethod, EllipsoidMethod, RobustMethod};

/// For each function and option that is a word, the words.
#[pyfunction]
pub(crate) fn names() -> BTreeMap<&'static str, Vec<&'static str>> {
    fn of<T: Choice>() -> Vec<&'static str> {
        T::CHOICES.iter().map(|(name, ..)| *name).collect()
    }
    fn listed<T>(names: impl IntoIterator<Item = (&'static str, T)>) -> Vec<&'static str> {
        names.into_iter().map(|(name, _)| name).collect()
    }
    BTreeMap::from([
        ("ball.method", of::<BallMethod>()),
        ("centers.method", of::<CentersMethod>()),
        ("curve.method", of::<CurveMethod>()),
        ("delaunay.order", of::<InsertionOrder>()),
        ("ellipsoid.method", of::<EllipsoidMethod>()),
        ("inscribed_ellipse.method", of::<EllipseMethod>()),
        ("inscribed_triangle.method", of::<TriangleMethod>()),
        ("generate.distribution", listed(Distribution::NAMES)),
        ("inscribed_dops.method", of::<BodiesMethod>()),
        ("inscribed_dops.objective", of::<Objective>()),
        ("inscribed_dops.seeds", of::<ThesisSeeds>()),
        ("robust_ellipsoid.method", of::<RobustMethod>()),
        ("sort_file.kind", listed(KeyKind::NAMES)),
        ("spatial_order.curve", of::<OrderCurve>()),
        ("surface.method", of::<SurfaceMethod>()),
        ("surface.priority", of::<Priority>()),
    ])
}
