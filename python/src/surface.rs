//! `taut.surface`, behind its Python signature.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::SurfaceMethod as Kind;
use taut::reconstruct::thesis::{AlphaFilter, Extent, Priority, ThesisOptions};
use taut::reconstruct::{Denoise, HullOptions, Positions, SurfaceMode};
use taut::{SurfaceMethod, SurfaceOptions};

use crate::choice::{check_method_options, choice};
use crate::found::{Found, solve_points};
use crate::numbers::whole;

/// The surface through the rows of an array.
#[pyfunction]
pub(crate) fn surface(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    method: &str,
    open: bool,
    denoise: bool,
    neighbors: &Bound<'_, PyAny>,
    iterations: &Bound<'_, PyAny>,
    original: bool,
    alpha: Option<f64>,
    epsilon: f64,
    sliver_angle: Option<f64>,
    forbidden_angle: Option<f64>,
    priority: &str,
    restarts: bool,
    threads: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let method: Kind = choice("method", method)?;
    let priority: Priority = choice("priority", priority)?;
    let usual = ThesisOptions::default();
    let noise = Denoise {
        neighbors: whole("neighbors", neighbors, "from 4 to 1000, or None")?,
        iterations: whole("iterations", iterations, "from 0 to 100")?,
        positions: if original { Positions::Original } else { Positions::Projected },
    };
    let of_denoise = [
        ("neighbors", noise.neighbors.is_some()),
        ("iterations", noise.iterations != Denoise::default().iterations),
        ("original", original),
    ];
    if let Some((name, _)) = of_denoise.iter().find(|(_, is_given)| *is_given && !denoise) {
        return Err(PyValueError::new_err(format!("option `{name}` is of denoise=True")));
    }
    let given = [
        ("open", open),
        ("alpha", alpha.is_some()),
        ("epsilon", epsilon != usual.epsilon),
        ("sliver_angle", sliver_angle.is_some()),
        ("forbidden_angle", forbidden_angle.is_some()),
        ("priority", priority != usual.priority),
        ("restarts", restarts),
    ];
    check_method_options(method.name(), &given, |option, method| {
        SurfaceOptions::methods_of(option).contains(method)
    })?;
    let filter = alpha.map_or(AlphaFilter::None, AlphaFilter::Circumradius);
    let method = match method {
        Kind::Tree if open => SurfaceMethod::Tree(SurfaceMode::Open),
        Kind::Tree => SurfaceMethod::Tree(SurfaceMode::Closed),
        Kind::Alpha => SurfaceMethod::Alpha(alpha),
        Kind::Hull => {
            SurfaceMethod::Hull(HullOptions { epsilon, alpha: filter, ..HullOptions::default() })
        }
        Kind::Thesis => SurfaceMethod::Thesis(ThesisOptions {
            epsilon,
            alpha: filter,
            sliver_angle: sliver_angle.unwrap_or(usual.sliver_angle),
            forbidden_angle: forbidden_angle.unwrap_or(usual.forbidden_angle),
            priority,
            extent: if restarts { Extent::Restarts } else { Extent::Front },
            ..usual
        }),
    };
    let options = SurfaceOptions {
        method,
        denoise: denoise.then_some(noise),
        threads: whole("threads", threads, "1 to 1024, or None")?,
        ..SurfaceOptions::default()
    };
    solve_points(py, rows, |source, monitor| {
        taut::surface(source, &SurfaceOptions { monitor: *monitor, ..options.clone() })
    })
}
