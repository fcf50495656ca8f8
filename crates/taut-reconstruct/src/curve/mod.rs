//! Curves through samples of the plane.

mod answer;
mod boxes;
mod chains;
mod clean;
mod cloud;
mod fit;
mod index;
mod nearest;
mod options;
mod thesis;
mod tour;

use taut_certify::{Curve, Solution};
use taut_points::{Monitor, PointSource, on_threads};

use crate::Error;
use answer::{Outcome, finish};
use cloud::Cloud;

pub use options::{CurveMethod, CurveOptions, CurveThesisOptions, Ends};

/// The curves that points of the plane were sampled from, with what is known about them. They are held in memory.
///
/// # Errors
/// [`Error::Input`], also when the points cannot be read or the monitor stops the work.
pub fn curve(
    source: &dyn PointSource,
    options: &CurveOptions<'_>,
) -> Result<Solution<Curve>, Error> {
    if let CurveMethod::Thesis(thesis) | CurveMethod::ThesisCrude(thesis) = options.method {
        thesis.check()?;
    }
    let monitor = &options.monitor;
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
fn solve(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    Ok(match options.method {
        CurveMethod::Crust
        | CurveMethod::OneStepCrust
        | CurveMethod::NnCrust
        | CurveMethod::ConservativeCrust
        | CurveMethod::HnnCrust => clean::solve(cloud, options.method, options.ends, monitor)?,
        CurveMethod::Corners | CurveMethod::Auto => {
            clean::solve(cloud, CurveMethod::Corners, options.ends, monitor)?
        }
        CurveMethod::Thesis(how) => thesis::thesis(cloud, &how, options, monitor)?,
        CurveMethod::ThesisCrude(how) => thesis::thesis_crude(cloud, &how, options, monitor)?,
        CurveMethod::Tour => tour::tour(cloud, options, monitor)?,
        CurveMethod::Fit => fit::fit(cloud, options.ends, monitor)?,
    })
}

/// A fit where points are noisy, else vertices that are points: by NN-Crust where samples are so dense that it can be certified, which
/// it is however uneven they are; else a fit where that can be certified; else as corners ask for.
fn auto(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
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
