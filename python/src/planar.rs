//! `taut.inscribed_circle` and the other shapes in polygons, behind their Python signatures.

use pyo3::prelude::*;
use taut::CircleOptions;
use taut::inscribe::{
    ConvexOptions, EllipseMethod, EllipseOptions, EllipseThesisOptions, OrientedRectangleOptions,
    RectangleOptions, TriangleMethod, TriangleOptions, TriangleThesisOptions,
};

use crate::choice::{check_method_options, choice};
use crate::found::{Found, solve_points};
use crate::numbers::whole;

/// Functions for shapes that are found by a search within a gap and a number of cells, with no other options.
macro_rules! shapes {
    ($($(#[$about:meta])* $name:ident: $options:ident, $solver:path;)*) => { $(
        $(#[$about])*
        #[pyfunction]
        pub(crate) fn $name(
            py: Python<'_>,
            rows: &Bound<'_, PyAny>,
            epsilon: f64,
            max_cells: &Bound<'_, PyAny>,
        ) -> PyResult<Found> {
            let max_cells = whole("max_cells", max_cells, "at least 1")?;
            solve_points(py, rows, |source, monitor| {
                $solver(source, &$options { epsilon, max_cells, monitor: *monitor })
            })
        }
    )* };
}

shapes! {
    /// The largest circle in the polygon whose rings are the rows of an array.
    inscribed_circle: CircleOptions, taut::inscribed_circle;
    /// The largest rectangle along the axes in the polygon whose rings are the rows of an array.
    inscribed_rectangle: RectangleOptions, taut::inscribe::inscribed_rectangle;
    /// The largest rectangle of any direction in the polygon whose rings are the rows of an array.
    inscribed_oriented_rectangle: OrientedRectangleOptions, taut::inscribe::inscribed_oriented_rectangle;
}

/// The largest ellipse in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_ellipse(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    max_cells: &Bound<'_, PyAny>,
    method: &str,
    sample_count: &Bound<'_, PyAny>,
    fatness: f64,
    angle: f64,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let max_cells = whole("max_cells", max_cells, "at least 1")?;
    let sample_count = whole("sample_count", sample_count, "a number from 12 to 1000")?;
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let thesis = EllipseThesisOptions { sample_count, fatness, angle, seed };
    let usual = EllipseThesisOptions::default();
    let changed = [
        ("sample_count", sample_count != usual.sample_count),
        ("fatness", fatness != usual.fatness),
        ("angle", angle != usual.angle),
        ("seed", seed != usual.seed),
    ];
    let chosen = choice::<EllipseMethod>("method", method)?;
    check_method_options(method, &changed, |_, method: &EllipseMethod| {
        matches!(method, EllipseMethod::Thesis(_) | EllipseMethod::FivePoint(_))
    })?;
    let method = match chosen {
        EllipseMethod::Thesis(_) => EllipseMethod::Thesis(thesis),
        EllipseMethod::FivePoint(_) => EllipseMethod::FivePoint(thesis),
        other => other,
    };
    solve_points(py, rows, |source, monitor| {
        let options = EllipseOptions { method, epsilon, max_cells, monitor: *monitor };
        taut::inscribe::inscribed_ellipse(source, &options)
    })
}

/// The largest triangle in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_triangle(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    max_cells: &Bound<'_, PyAny>,
    method: &str,
    sample_count: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let max_cells = whole("max_cells", max_cells, "at least 1")?;
    let sample_count = whole("sample_count", sample_count, "a number from 3 to 4096")?;
    let seed = whole("seed", seed, "0 to 2**64 - 1")?;
    let thesis = TriangleThesisOptions { sample_count, seed };
    let usual = TriangleThesisOptions::default();
    let changed =
        [("sample_count", sample_count != usual.sample_count), ("seed", seed != usual.seed)];
    let chosen = choice::<TriangleMethod>("method", method)?;
    check_method_options(method, &changed, |_, method: &TriangleMethod| {
        matches!(method, TriangleMethod::Thesis(_))
    })?;
    let method = match chosen {
        TriangleMethod::Thesis(_) => TriangleMethod::Thesis(thesis),
        other => other,
    };
    solve_points(py, rows, |source, monitor| {
        let options = TriangleOptions { method, epsilon, max_cells, monitor: *monitor };
        taut::inscribe::inscribed_triangle(source, &options)
    })
}

/// A large convex polygon in the polygon whose rings are the rows of an array.
#[pyfunction]
pub(crate) fn inscribed_polygon(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    epsilon: f64,
    rounds: &Bound<'_, PyAny>,
    starts: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let rounds = whole("rounds", rounds, "at least 0")?;
    let starts = whole("starts", starts, "at least 1")?;
    let seed = whole("seed", seed, "at least 0")?;
    solve_points(py, rows, |source, monitor| {
        let options = ConvexOptions { rounds, starts, seed, epsilon, monitor: *monitor };
        taut::inscribe::inscribed_polygon(source, &options)
    })
}
