//! The words that options know, for tests to compare with the literals of the Python signatures.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use taut::certify::OrderCurve;
use taut::oblivious::external::KeyKind;
use taut::points::generate::Distribution;
use taut::reconstruct::thesis::Priority;
use taut::{
    BallMethod, CentersMethod, CurveMethod, EllipsoidMethod, InsertionOrder, RobustMethod,
    SurfaceMethod,
};

/// For each function and option that is a word, the words.
#[pyfunction]
pub(crate) fn names() -> BTreeMap<&'static str, Vec<&'static str>> {
    fn of<T>(names: impl IntoIterator<Item = (&'static str, T)>) -> Vec<&'static str> {
        names.into_iter().map(|(name, _)| name).collect()
    }
    BTreeMap::from([
        ("ball.method", BallMethod::ALL.map(BallMethod::name).into()),
        ("centers.method", CentersMethod::ALL.map(CentersMethod::name).into()),
        ("curve.method", of(CurveMethod::NAMES)),
        ("delaunay.order", of(InsertionOrder::NAMES)),
        ("ellipsoid.method", EllipsoidMethod::ALL.map(EllipsoidMethod::name).into()),
        ("generate.distribution", of(Distribution::NAMES)),
        ("robust_ellipsoid.method", RobustMethod::ALL.map(RobustMethod::name).into()),
        ("sort_file.kind", of(KeyKind::NAMES)),
        ("spatial_order.curve", of(OrderCurve::NAMES)),
        ("surface.method", SurfaceMethod::ALL.map(SurfaceMethod::name).into()),
        ("surface.priority", of(Priority::NAMES)),
    ])
}
