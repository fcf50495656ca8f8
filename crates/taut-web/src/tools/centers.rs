//! k centers.

use serde_json::Value;
use taut::certify::Placement;
use taut::{CentersMethod, CentersOptions, Monitor, centers};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

/// The number of centers where none is given.
pub(crate) const K_DEFAULT: u64 = 4;

pub(super) fn options() -> Vec<Value> {
    vec![
        options::whole("k", K_DEFAULT, 1, "Number of centers"),
        options::number(
            "epsilon",
            CentersOptions::default().epsilon,
            "Proved relative gap to reach, in [0, 1)",
        ),
        options::choice::<CentersMethod>("method", "The way to find them", |_| true),
        options::flag("discrete", "Centers are among the points"),
        options::whole("outliers", 0, 0, "Most points that may be left out"),
    ]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let usual = CentersOptions::default();
    let k = usize::try_from(options.whole("k", K_DEFAULT)?).map_err(|e| e.to_string())?;
    let options = CentersOptions {
        epsilon: options.number("epsilon", usual.epsilon)?,
        method: options.choice("method")?,
        placement: if options.flag("discrete") { Placement::Rows } else { Placement::Free },
        outliers: options.whole("outliers", 0)?,
        monitor: *monitor,
        ..usual
    };
    let found = centers(points.source(), k, &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, super::no_file))
}
