//! Curves through samples of the plane.

mod answer;
mod auto;
mod boxes;
mod chains;
mod clean;
mod cloud;
mod fit;
mod index;
mod kind;
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
        // A tour passes all points, however far.
        let far = match options.method {
            CurveMethod::Tour | CurveMethod::ThesisCrude(_) => Vec::new(),
            _ => cloud.far(),
        };
        if far.is_empty() {
            let finish = |outcome| finish(&cloud, outcome, options, source, monitor);
            return match options.method {
                CurveMethod::Auto => auto::auto(&cloud, options, finish, monitor),
                _ => finish(solve(&cloud, options, monitor)?),
            };
        }
        let others: Vec<u32> =
            (0..cloud.sites.len() as u32).filter(|site| far.binary_search(site).is_err()).collect();
        let near = cloud.subset(&others);
        let finish = |outcome: Outcome| {
            finish(&cloud, outcome.spread(&others, &far), options, source, monitor)
        };
        match options.method {
            CurveMethod::Auto => auto::auto(&near, options, finish, monitor),
            _ => finish(solve(&near, options, monitor)?),
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
