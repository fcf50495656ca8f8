//! `taut.ball`, with and without a kernel, and `taut.ball_of_balls`, behind their Python signatures.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::certify::Kernel;
use taut::enclose::{KernelBallMethod, KernelBallOptions};
use taut::{BallMethod, BallOptions};

use crate::found::{Found, solve, solve_points};
use crate::items::{items_of_name, raise};
use crate::numbers::whole;

/// The smallest ball around the rows of an array; `items` says what they are.
#[pyfunction]
pub(crate) fn ball(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    items: &str,
    epsilon: f64,
    method: &str,
    batch: &Bound<'_, PyAny>,
    delta: Option<f64>,
    max_passes: &Bound<'_, PyAny>,
    threads: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
) -> PyResult<Found> {
    let items = items_of_name(items)?;
    let method = method.parse::<BallMethod>().map_err(|error| raise(error, items, 0))?;
    let passes = "at least 3, and 4 for the methods of the thesis";
    let options = BallOptions {
        inputs: items,
        epsilon,
        method,
        batch: whole("batch", batch, "at least 1, or None")?,
        delta,
        max_passes: whole("max_passes", max_passes, passes)?,
        threads: whole("threads", threads, "1 to 1024, or None")?,
        seed: whole("seed", seed, "0 to 2**64 - 1")?,
        ..BallOptions::default()
    };
    solve(
        py,
        rows,
        |source, monitor| taut::ball(source, &BallOptions { monitor: *monitor, ..options }),
        |error, columns| raise(error, items, columns),
    )
}

/// The smallest ball in the feature space of a kernel; `parameters` are γ, the offset and the degree.
#[pyfunction]
pub(crate) fn kernel_ball(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    kernel: &str,
    parameters: (f64, f64, u32),
    nu: Option<f64>,
    epsilon: f64,
    steps: Option<u64>,
    limits: (u64, Option<usize>, u64),
) -> PyResult<Found> {
    let (gamma, offset, degree) = parameters;
    let kernel = match kernel {
        "gaussian" => Kernel::Gaussian { gamma },
        "polynomial" => Kernel::Polynomial { gamma, offset, degree },
        "linear" => Kernel::Linear,
        "precomputed" => Kernel::Precomputed,
        _ => {
            let expected = "gaussian, polynomial, linear or precomputed";
            let message = format!("option `kernel` is {kernel}: expected {expected}");
            return Err(PyValueError::new_err(message));
        }
    };
    let method =
        if steps.is_some() { KernelBallMethod::Thesis } else { KernelBallMethod::default() };
    let (max_passes, threads, seed) = limits;
    let base = KernelBallOptions {
        kernel,
        nu,
        epsilon,
        method,
        max_passes,
        threads,
        seed,
        ..Default::default()
    };
    let options = KernelBallOptions { steps: steps.unwrap_or(base.steps), ..base };
    solve_points(py, rows, |source, monitor| {
        taut::enclose::kernel_ball(source, &KernelBallOptions { monitor: *monitor, ..options })
    })
}
