//! The checker of centers, in arithmetic of its own.
//!
//! *Problem.* Given rows, at most k centers, a radius R, rows left out, a core-set X and a bound L, prove L ≤ R* ≤ R, where R*
//! is the least radius of k equal balls, with their centers anywhere or at rows, that hold all rows except z.
//! *Upper bound.* Each row that counts is at most R from a center, decided exactly: [`enclosure`]. Where rows are in groups, one
//! center serves all rows of a group: [`group_enclosure`]. Ellipsoids are compared with balls as they are: [`ellipsoids`].
//! *Lower bound.* No k balls of a radius less than L hold all of X except z of its rows. Balls that held all rows but z
//! would; so R* ≥ L. There are three proofs: a separated set, more than k + z rows no two of which fit in one ball, and the
//! log of a branch and bound search, which is replayed ([`replay`]), or nogoods, each shown by those before it ([`nogoods`]). An [`oracle`] refutes balls: with bounds on all that is
//! rounded where centers are free ([`free`]), exactly where they are rows ([`rows`]).
//! *Order.* Structure and the gap between the bounds, one pass (finite rows, hash, balls, assignment), then the
//! lower bound, from the rows of the core-set as that pass read them. Centers among the rows may take one pass more, which
//! hashes all rows again.
//! *Tolerances.* The balls have none. The gap claimed may differ from that of the two bounds as quotients differ by
//! rounding. An assignment may name any of centers that are equally near but for rounding.

mod avoiding;
mod center_tree;
mod core;
mod distance;
mod ellipsoids;
mod enclosure;
mod free;
mod group_enclosure;
mod item;
mod meter;
mod nogoods;
mod oracle;
pub(crate) mod parts;
mod replay;
mod rows;
mod structure;

use taut_points::{Cancelled, Monitor, PointSource};

use self::core::{Core, Pairs};
use self::ellipsoids::EllipsoidEnclosure;
use self::enclosure::Enclosure;
use self::free::Free;
use self::group_enclosure::GroupEnclosure;
use self::item::Layout;
use self::meter::Meter;
use self::oracle::Oracle;
use self::replay::Log;
use self::rows::Places;
use self::structure::Reading;
use super::{
    Centers, CentersCertificate, CentersVerdict, CentersViolation, HeldOut, LowerBound, Placement,
};
use crate::CheckError;
use crate::hashed_pass::KeptRows;

pub(super) fn check(
    answer: &Centers,
    certificate: &CentersCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CentersVerdict, CheckError> {
    let (reading, gap) = structure::check(answer, certificate, source.len(), source.dim())?;
    monitor.pass(1, source.len());
    let (lower, upper) = (answer.lower_bound, answer.radius);
    let branches = match reading {
        Reading::Items(layout) => of_items(answer, certificate, layout, source, monitor)?,
        Reading::Ellipsoids(dim) => of_ellipsoids(answer, certificate, dim, source, monitor)?,
    };
    Ok(CentersVerdict { lower, upper, gap, branches })
}

/// Points and balls; the number of branches.
fn of_items(
    answer: &Centers,
    certificate: &CentersCertificate,
    layout: Layout,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<u64, CheckError> {
    let kept = match layout.group {
        None => Enclosure::of(answer, layout.kind).check(source, certificate, monitor)?,
        Some(_) => GroupEnclosure::of(answer, layout).check(source, certificate, monitor)?,
    };
    conclude(answer, certificate, layout, &kept, source.dim(), Some(source), monitor)
}

/// The proof, once all rows that count are known to be held; the number of branches. Without a source no row is read again.
fn conclude(
    answer: &Centers,
    certificate: &CentersCertificate,
    layout: Layout,
    kept: &KeptRows,
    columns: usize,
    source: Option<&dyn PointSource>,
    monitor: &Monitor<'_>,
) -> Result<u64, CheckError> {
    are_rows(answer, layout, kept)?;
    if answer.lower_bound <= 0.0 {
        return Ok(0);
    }
    let rows = || certificate.core_set.iter().map(|&id| kept.row(id));
    let items: Vec<f64> = rows().flat_map(|row| layout.of_item(row)).collect();
    let of_item = columns - usize::from(layout.group.is_some());
    let mut core = Core::of(&items, of_item, layout.kind, answer.lower_bound);
    if layout.group.is_some() {
        core = core.with_groups(rows().filter_map(|row| layout.group_of(row)).map(f64::to_bits));
    }
    let places = || {
        let source = source.ok_or(CheckError::NoParts { kind: parts::AMONG_ROWS })?;
        monitor.pass(2, source.len());
        Places::of(&core, layout, certificate.points_hash, source, monitor)
    };
    prove(&core, certificate, &places, monitor)
}

/// Ellipsoids, of which the core-set has points; the number of branches.
fn of_ellipsoids(
    answer: &Centers,
    certificate: &CentersCertificate,
    dim: usize,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<u64, CheckError> {
    let kept = EllipsoidEnclosure::of(answer, dim).check(source, certificate, monitor)?;
    if answer.lower_bound <= 0.0 {
        return Ok(0);
    }
    let core = ellipsoids::core(answer, certificate, dim, &kept, monitor)?;
    let places = || {
        let problem = "whose centers are no rows";
        refused(CentersViolation::Ellipsoids { problem })
    };
    prove(&core, certificate, &places, monitor)
}

/// Centers among the rows are the rows they are said to be, to the last bit.
fn are_rows(answer: &Centers, layout: Layout, kept: &KeptRows) -> Result<(), CheckError> {
    for (center, (&row, place)) in answer.rows.iter().zip(&answer.centers).enumerate() {
        if layout.kind.item(&layout.of_item(kept.row(row))).position != place {
            let problem = "which has other coordinates";
            return Err(CentersViolation::Row { center, row, problem }.into());
        }
    }
    Ok(())
}

/// Proves the lower bound; returns the number of branches that were replayed.
fn prove(
    core: &Core,
    certificate: &CentersCertificate,
    places: &dyn Fn() -> Result<Places, CheckError>,
    monitor: &Monitor<'_>,
) -> Result<u64, CheckError> {
    let (rows, groups, outliers) = (core.len(), core.group_count(), certificate.outliers);
    // All groups left out, or a ball for each, prove nothing about balls of any radius above 0.
    if groups as u64 <= outliers {
        return refused(CentersViolation::TooFew { rows: groups, outliers });
    }
    let limited = |proof| match rows > replay::ITEMS {
        true => refused(CentersViolation::CoreSetSize { rows, most: replay::ITEMS, proof }),
        false => Ok(()),
    };
    let mut meter = Meter::of(monitor);
    match &certificate.proof {
        LowerBound::Separated => {
            if groups as u64 <= certificate.k.saturating_add(outliers) {
                return refused(CentersViolation::TooFew { rows: groups, outliers });
            }
            if core.is_grouped() {
                limited("groups apart")?;
                let close = match certificate.placement {
                    Placement::Free => {
                        let pairs = Pairs::of(core, &mut meter)?;
                        close_groups(core, &mut Free::of(core, &pairs), &mut meter)?
                    }
                    Placement::Rows => close_groups(core, &mut &places()?, &mut meter)?,
                };
                return match close.map(|pair| pair.map(|item| certificate.core_set[item])) {
                    Some([first, second]) => refused(CentersViolation::NotApart { first, second }),
                    None => Ok(0),
                };
            }
            let mut close = first_pair(rows, |i, j| core.are_apart(i, j, &mut meter))?;
            if close.is_some() && certificate.placement == Placement::Rows {
                limited("rows apart")?;
                let places = places()?;
                close = first_pair(rows, |i, j| places.are_apart(i, j, &mut meter))?;
            }
            match close {
                Some((i, j)) => {
                    let (first, second) = (certificate.core_set[i], certificate.core_set[j]);
                    refused(CentersViolation::NotApart { first, second })
                }
                None => Ok(0),
            }
        }
        LowerBound::Branches { items } => {
            limited("branches")?;
            replay_log(core, certificate, items, &[], places, &mut meter)
        }
        LowerBound::Avoiding { items, held_out } => {
            limited("branches")?;
            replay_log(core, certificate, items, held_out, places, &mut meter)
        }
        LowerBound::Nogoods { nogoods } => {
            nogoods::check(core, certificate, nogoods, &mut meter)?;
            Ok(nogoods.len() as u64)
        }
    }
}

/// Replays a log; returns the number of its branches.
fn replay_log(
    core: &Core,
    certificate: &CentersCertificate,
    items: &[u32],
    held_out: &[HeldOut],
    places: &dyn Fn() -> Result<Places, CheckError>,
    meter: &mut Meter<'_>,
) -> Result<u64, CheckError> {
    // More balls than fit in memory are as good as any number.
    let k = usize::try_from(certificate.k).unwrap_or(usize::MAX);
    let (groups, undo_bytes) = (core.groups(), replay::UNDO_BYTES_MAX);
    let log = Log { k, outliers: certificate.outliers, items, held_out, groups, undo_bytes };
    match certificate.placement {
        Placement::Free => {
            let pairs = Pairs::of(core, meter)?;
            log.replay(&mut Free::of(core, &pairs), meter)?;
        }
        Placement::Rows => log.replay(&mut &places()?, meter)?,
    }
    Ok(items.len() as u64)
}

/// The first items of the first two groups that are not shown to be apart: no ball of a radius less than the bound holds the
/// items of both.
fn close_groups<R: Oracle>(
    core: &Core,
    oracle: &mut R,
    meter: &mut Meter<'_>,
) -> Result<Option<[usize; 2]>, Cancelled> {
    let mut members = vec![vec![]; core.group_count()];
    for (item, &group) in core.groups().iter().enumerate() {
        members[group].push(item);
    }
    for (at, group) in members.iter().enumerate() {
        for other in &members[..at] {
            if !is_refuted(oracle, other.iter().chain(group).copied(), meter)? {
                return Ok(Some([other[0], group[0]]));
            }
        }
    }
    Ok(None)
}

/// Returns true if no ball of a radius less than the bound holds these items.
fn is_refuted<R: Oracle>(
    oracle: &mut R,
    mut items: impl Iterator<Item = usize>,
    meter: &mut Meter<'_>,
) -> Result<bool, Cancelled> {
    let Some(first) = items.next() else { return Ok(false) };
    let Some(mut cluster) = oracle.open(first) else { return Ok(true) };
    for item in items {
        if oracle.grow(&mut cluster, item, meter)?.is_none() {
            return Ok(true);
        }
    }
    Ok(false)
}

fn refused<T>(violation: CentersViolation) -> Result<T, CheckError> {
    Err(violation.into())
}

/// The first two rows that are not apart.
fn first_pair(
    rows: usize,
    mut are_apart: impl FnMut(usize, usize) -> Result<bool, Cancelled>,
) -> Result<Option<(usize, usize)>, Cancelled> {
    for i in 0..rows {
        for j in 0..i {
            if !are_apart(i, j)? {
                return Ok(Some((j, i)));
            }
        }
    }
    Ok(None)
}
