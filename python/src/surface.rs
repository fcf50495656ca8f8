//! `taut.surface`, behind its Python signature.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::reconstruct::thesis::{AlphaFilter, Extent, Priority, ThesisOptions};
use taut::{
    Denoise, Items, Positions, SurfaceMethod, SurfaceMode, SurfaceOptions, surface_of_source,
};

use crate::choice::choice;
use crate::found::{Found, solve};
use crate::items::raise;
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
    let methods = SurfaceMethod::ALL.map(|method| (method.name(), method));
    let method = choice("method", method, methods)?;
    let priority = choice("priority", priority, Priority::NAMES)?;
    let usual = ThesisOptions::default();
    let is_filtered = matches!(method, SurfaceMethod::Thesis | SurfaceMethod::Hull);
    let thesis = ThesisOptions {
        epsilon,
        alpha: alpha.filter(|_| is_filtered).map_or(AlphaFilter::None, AlphaFilter::Circumradius),
        sliver_angle: sliver_angle.unwrap_or(usual.sliver_angle),
        forbidden_angle: forbidden_angle.unwrap_or(usual.forbidden_angle),
        priority,
        extent: if restarts { Extent::Restarts } else { Extent::Front },
        ..usual
    };
    let noise = Denoise {
        neighbors: whole("neighbors", neighbors, "from 4 to 1000")?,
        iterations: whole("iterations", iterations, "from 0 to 100")?,
        positions: if original { Positions::Original } else { Positions::Projected },
    };
    let of_denoise = [
        ("neighbors", noise.neighbors != Denoise::default().neighbors),
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
    for (name, is_given) in given {
        let methods = SurfaceOptions::methods_of(name);
        if is_given && !methods.contains(&method) {
            let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
            let (names, method) = (names.join(" and "), method.name());
            let message = format!("option `{name}` is of method {names}, not of {method}");
            return Err(PyValueError::new_err(message));
        }
    }
    let options = SurfaceOptions {
        method,
        mode: if open { SurfaceMode::Open } else { SurfaceMode::Closed },
        alpha: alpha.filter(|_| method == SurfaceMethod::Alpha),
        thesis,
        denoise: denoise.then_some(noise),
        threads: whole("threads", threads, "1 to 1024, or None")?,
    };
    solve(
        py,
        rows,
        |source, monitor| surface_of_source(source, &options, monitor),
        |error, columns| raise(error, Items::Points, columns),
    )
}
