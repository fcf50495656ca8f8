//! A short tour through all points as the curve.

use taut_certify::{CurveComponent, TourBound};
use taut_points::Monitor;

use super::answer::Outcome;
use super::cloud::Cloud;
use super::{CurveMethod, CurveOptions, Ends};
use crate::Error;
use crate::tour;

/// One curve, whose vertices are all sites, and the bound.
pub(super) fn tour(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let mut outcome = Outcome { method: CurveMethod::Tour.name(), ..Outcome::default() };
    if cloud.sites.is_empty() {
        return Ok(outcome);
    }
    let found = tour::tour(&cloud.sites, options.ends == Ends::Open, monitor)?;
    outcome.curves.push(CurveComponent {
        vertices: found.order.iter().map(|&site| cloud.sites[site as usize]).collect(),
        closed: found.closed,
        rows: found.order.iter().map(|&site| cloud.row(site)).collect(),
    });
    outcome.tour = Some(TourBound { potentials: found.potentials, lower: found.lower });
    outcome.counters.extend([
        ("ascent_steps".into(), found.events.steps),
        ("untangled".into(), found.events.untangled),
    ]);
    Ok(outcome)
}
