//! The method where none is chosen: a fit where points are noisy, vertices where they are not, region by region.
//!
//! *Idea.* [`kind`](super::kind) tells points that are plainly vertices. Of the others a fit is made, and kept where what it leaves
//! is noise ([`Fitted`](super::fit::Fitted)). Through vertices the curve is that of NN-Crust where samples are so dense that it
//! can be certified, however uneven they are; else that of HNN-Crust where it leaves no ends, as it does of smooth samples up to ε of 0.47;
//! else that of `corners`, to which the edges of HNN-Crust are more probable than others: where lines are rugged, as coasts are, either of
//! both methods finds edges that the other misses.
//! *Guarantee.* None beyond those of the methods; rates on drawn inputs are in `docs/curve.md`.

use taut_certify::{Curve, Solution};
use taut_mesh::Polyline;
use taut_points::Monitor;

use super::answer::Outcome;
use super::cloud::Cloud;
use super::kind::{Judged, Kind, Regions, are_lattice, regions};
use super::{CurveMethod, CurveOptions, clean, fit};
use crate::Error;

/// Fewest points of a region that is judged for itself: ten runs of residuals. Others count as vertices beside vertices.
const REGION_POINTS_MIN: usize = 240;

/// The curves by the methods that points ask for.
pub(super) fn auto(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
    finish: impl Fn(Outcome) -> Result<Solution<Curve>, Error>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let found = regions(&clean::normalized(&cloud.sites));
    monitor.check()?;
    let fitted = match found.only() {
        Some(Judged { kind: Kind::Vertices, .. }) => None,
        Some(Judged { kind: Kind::Doubtful, mutual_share }) => {
            let fitted = fit::judged(cloud, options.ends, mutual_share, monitor)?;
            fitted.is_noisy.then_some(fitted.outcome)
        }
        None => mixed(cloud, &found, options, monitor)?,
    };
    match fitted {
        Some(outcome) => finish(outcome),
        None => vertices(cloud, options, finish, monitor),
    }
}

/// Curves through vertices.
fn vertices(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
    finish: impl Fn(Outcome) -> Result<Solution<Curve>, Error>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let dense = finish(clean::solve(cloud, CurveMethod::NnCrust, options.ends, monitor)?)?;
    // No method finds curves where there are none, and `corners` takes four times as long not to.
    if dense.certificate.certified || are_lattice(&clean::normalized(&cloud.sites)) {
        return Ok(dense);
    }
    drop(dense);
    finish(through(cloud, options, monitor)?)
}

/// Curves through vertices of samples that are not dense.
fn through(
    cloud: &Cloud,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let half = clean::solve(cloud, CurveMethod::HnnCrust, options.ends, monitor)?;
    let has_ends = half.curves.iter().any(|one| !one.closed) || !half.outliers.is_empty();
    match has_ends {
        true => clean::solve_rugged(cloud, options.ends, monitor),
        false => Ok(half),
    }
}

/// Fits of the regions that are noisy beside curves through the vertices of the others; none where no region is noisy, or where such
/// curves would cross.
///
/// The vertices of all curves count as places here, not as rows, as `noise` and outliers are those of all.
fn mixed(
    cloud: &Cloud,
    regions: &Regions,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Option<Outcome>, Error> {
    let mut members: Vec<Vec<u32>> = vec![vec![]; regions.kinds.len()];
    for (site, &region) in (0u32..).zip(&regions.region) {
        members[region as usize].push(site);
    }
    let (mut all, mut clear) = (Outcome { method: "fit", ..Outcome::default() }, vec![]);
    for (judged, sites) in regions.kinds.iter().zip(&members) {
        let fitted = match judged.kind {
            Kind::Doubtful if sites.len() >= REGION_POINTS_MIN => {
                let subset = cloud.subset(sites);
                let fitted = fit::judged(&subset, options.ends, judged.mutual_share, monitor)?;
                fitted.is_noisy.then_some(fitted.outcome)
            }
            _ => None,
        };
        match fitted {
            Some(outcome) => join(&mut all, outcome.spread(sites, &[])),
            None => clear.extend_from_slice(sites),
        }
    }
    if all.curves.is_empty() {
        return Ok(None);
    }
    if !clear.is_empty() {
        clear.sort_unstable();
        let rest = cloud.subset(&clear);
        let mut found = through(&rest, options, monitor)?;
        found.curves.iter_mut().for_each(|one| one.rows.clear());
        join(&mut all, found.spread(&clear, &[]));
    }
    let lines: Vec<Polyline<'_>> = all
        .curves
        .iter()
        .map(|one| Polyline { vertices: &one.vertices, closed: one.closed })
        .collect();
    Ok((taut_mesh::crossings(&lines) == 0).then_some(all))
}

/// Adds what was found elsewhere; the noise is that of the widest band.
fn join(all: &mut Outcome, found: Outcome) {
    all.curves.extend(found.curves);
    all.outliers.extend(found.outliers);
    all.outliers.sort_unstable();
    all.noise = all.noise.max(found.noise);
    for (name, count) in found.counters {
        *all.counters.entry(name).or_default() += count;
    }
}
