//! Curves through samples of the plane.

mod answer;
mod boxes;
mod chains;
mod clean;
mod cloud;
mod evidence;
mod fit;
mod index;
mod options;
mod thesis;
mod tour;

use taut_certify::{Curve, Solution};
use taut_points::{InputError, Monitor, PointSource, Points, Scalar, on_threads, shown_number};

use crate::Error;
use answer::{Outcome, finish};
use cloud::Cloud;

pub use options::{CurveMethod, CurveOptions, Ends};

/// The curves that points of the plane were sampled from, with what is known about them.
///
/// # Errors
/// [`Error::Input`].
pub fn curve<T: Scalar>(
    points: &Points<'_, T>,
    options: &CurveOptions,
) -> Result<Solution<Curve>, Error> {
    curve_of_source(points, options, &Monitor::silent())
}

/// The same for points of any source, with a monitor. They are held in memory while it works.
///
/// # Errors
/// As [`curve`], [`Error::Input`] when the points cannot be read, and [`Error::Input`].
pub fn curve_of_source(
    source: &dyn PointSource,
    options: &CurveOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let wrong = |name, value: f64, expected| {
        Error::Input(InputError::Option { name, value: shown_number(value), expected })
    };
    if !(options.rho >= 1.0 && options.rho.is_finite()) {
        return Err(wrong("rho", options.rho, "a number of at least 1"));
    }
    if !(options.omega > 0.0 && options.omega.is_finite()) {
        return Err(wrong("omega", options.omega, "a number above 0"));
    }
    if let Some(feature) = options.feature.filter(|&f| !(f > 0.0 && f.is_finite())) {
        return Err(wrong("feature", feature, "a number above 0"));
    }
    on_threads(options.threads, || {
        let cloud = Cloud::read(source, monitor)?;
        let finish = |outcome| finish(&cloud, outcome, options, source, monitor);
        match options.method {
            CurveMethod::Auto => auto(&cloud, options, finish, monitor),
            _ => finish(solve(&cloud, options, monitor)?),
        }
    })
}

/// The curves by the method chosen; without one, by that for corners.
fn solve(cloud: &Cloud, options: &CurveOptions, monitor: &Monitor<'_>) -> Result<Outcome, Error> {
    Ok(match options.method {
        CurveMethod::Crust
        | CurveMethod::OneStepCrust
        | CurveMethod::NnCrust
        | CurveMethod::ConservativeCrust
        | CurveMethod::HnnCrust => clean::solve(cloud, options.method, options.ends, monitor)?,
        CurveMethod::Corners | CurveMethod::Auto => {
            clean::solve(cloud, CurveMethod::Corners, options.ends, monitor)?
        }
        CurveMethod::Thesis => thesis::thesis(cloud, options, monitor)?,
        CurveMethod::ThesisCrude => thesis::thesis_crude(cloud, options, monitor)?,
        CurveMethod::Tour => tour::tour(cloud, options, monitor)?,
        CurveMethod::Fit => fit::fit(cloud, options.ends, monitor)?,
    })
}

/// A fit where points are noisy, else vertices that are points: by NN-Crust where samples are so dense that it can be certified, which
/// it is however uneven they are; else a fit where that can be certified; else as corners ask for.
fn auto(
    cloud: &Cloud,
    options: &CurveOptions,
    finish: impl Fn(Outcome) -> Result<Solution<Curve>, Error>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let fitted = match fit::fit_unless_vertices(cloud, options.ends, monitor)? {
        Some((outcome, true)) => return finish(outcome),
        Some((outcome, false)) => Some(outcome),
        None => None,
    };
    let dense = finish(clean::solve(cloud, CurveMethod::NnCrust, options.ends, monitor)?)?;
    if dense.certificate.certified {
        return Ok(dense);
    }
    drop(dense);
    if let Some(outcome) = fitted {
        let fitted = finish(outcome)?;
        if fitted.certificate.certified {
            return Ok(fitted);
        }
    }
    finish(solve(cloud, options, monitor)?)
}
