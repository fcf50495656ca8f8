//! The checker of centres, in arithmetic of its own.
//!
//! *Problem.* Given rows, at most k centres, a radius R, rows left out, a core-set X and a bound L, prove L ≤ R* ≤ R, where R*
//! is the least radius of k equal balls, with their centres anywhere or at rows, that hold all rows but so many.
//! *Upper bound.* Each row that counts is at most R from a centre, decided exactly: [`enclosure`].
//! *Lower bound.* No k balls of a radius less than L hold all of X but so many of its rows. Balls that held all rows but z
//! would; so R* ≥ L. Three proofs: rows that are apart two by two and more than k + z ([`apart`]); a search of the checker's
//! own ([`search`]), for points in the plane and in space and for centres among the rows followed by a second one of
//! another kind ([`cover`]), over all sets that one ball can hold; and the branches of the solver's search, gone through
//! again ([`replay`]). What a ball can hold is decided with bounds on all that is rounded ([`free`]), or exactly, where
//! centres are rows ([`rows`]).
//! *Order.* Structure and the gap between the bounds, one pass (finite rows, hash, balls, assignment), then the
//! lower bound, from the rows of the core-set as that pass read them. Centres among the rows may take one pass more, which
//! hashes all rows again.
//! *Tolerances.* The balls have none. The gap claimed may differ from that of the two bounds as quotients differ by
//! rounding. An assignment may name any of centres that are equally near but for rounding.

mod core;
mod cover;
mod distance;
mod enclosure;
mod free;
mod halves;
mod item;
mod meter;
mod replay;
mod room;
mod rows;
mod search;
mod structure;

use taut_points::{Monitor, PointSource};

use self::core::{Core, Pairs};
use self::enclosure::Enclosure;
use self::free::Free;
use self::item::Kind;
use self::meter::{Meter, Stop};
use self::room::Room;
use self::rows::Places;
use self::search::Outcome;
use super::{Centers, CentersCertificate, CentersVerdict, CentersViolation, LowerBound, Placement};
use crate::CheckError;
use crate::hashed_pass::KeptRows;

pub(super) fn check(
    answer: &Centers,
    certificate: &CentersCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CentersVerdict, CheckError> {
    let (kind, gap) = structure::check(answer, certificate, source)?;
    monitor.pass(1, source.len());
    let kept = Enclosure::of(answer, kind).check(source, certificate, monitor)?;
    are_rows(answer, kind, &kept)?;
    let (lower, upper) = (answer.lower_bound, answer.radius);
    let mut verdict = CentersVerdict { lower, upper, gap, nodes: 0, cover_nodes: None };
    if lower > 0.0 {
        let rows: Vec<f64> =
            certificate.core_set.iter().flat_map(|&id| kept.row(id)).copied().collect();
        let core = Core::of(&rows, source.dim(), kind, lower);
        (verdict.nodes, verdict.cover_nodes) = prove(&core, kind, certificate, source, monitor)?;
    }
    Ok(verdict)
}

/// Centres among the rows are the rows they are said to be, to the last bit.
fn are_rows(answer: &Centers, kind: Kind, kept: &KeptRows) -> Result<(), CheckError> {
    for (center, (&row, place)) in answer.rows.iter().zip(&answer.centers).enumerate() {
        if kind.item(kept.row(row)).position != place {
            let problem = "which has other coordinates";
            return Err(CentersViolation::Row { center, row, problem }.into());
        }
    }
    Ok(())
}

/// Proves the lower bound; the nodes of both searches.
fn prove(
    core: &Core,
    kind: Kind,
    certificate: &CentersCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(u64, Option<u64>), CheckError> {
    let (rows, outliers) = (core.len(), certificate.outliers);
    // All rows left out, or a ball for each, prove nothing about balls of any radius above 0.
    if rows as u64 <= outliers {
        return refused(CentersViolation::TooFew { rows, outliers });
    }
    let places = || {
        monitor.pass(2, source.len());
        Places::of(core, kind, certificate.points_hash, source, monitor)
    };
    let limited = |most, proof| match rows > most {
        true => refused(CentersViolation::CoreSetSize { rows, most, proof }),
        false => Ok(()),
    };
    match (&certificate.proof, certificate.placement) {
        (LowerBound::Apart, placement) => {
            if rows as u64 <= certificate.k.saturating_add(outliers) {
                return refused(CentersViolation::TooFew { rows, outliers });
            }
            let mut meter = Meter::endless(monitor);
            let close = first_pair(rows, |i, j| core.are_apart(i, j, &mut meter))?;
            let close = match (close, placement) {
                (Some(_), Placement::Rows) => {
                    limited(replay::ITEMS, "rows apart")?;
                    let places = places()?;
                    first_pair(rows, |i, j| places.are_apart(i, j, &mut meter))?
                }
                (close, _) => close,
            };
            match close {
                Some((i, j)) => {
                    let (first, second) = (certificate.core_set[i], certificate.core_set[j]);
                    refused(CentersViolation::NotApart { first, second })
                }
                None => Ok((0, None)),
            }
        }
        (LowerBound::Search, Placement::Free) => {
            limited(search::ITEMS, "search")?;
            let mut meter = Meter::of(monitor, search::STEPS_MAX);
            let pairs = Pairs::of(core, &mut meter)?;
            let nodes = searched(&mut Free::of(core, &pairs), certificate, &mut meter)?;
            Ok((nodes, cover::of_balls(core, kind, &pairs, certificate, monitor)?))
        }
        (LowerBound::Search, Placement::Rows) => {
            limited(search::ITEMS, "search")?;
            let places = places()?;
            let mut meter = Meter::of(monitor, search::STEPS_MAX);
            let nodes = searched(&mut &places, certificate, &mut meter)?;
            Ok((nodes, cover::of_places(&places, certificate, monitor)?))
        }
        (LowerBound::Branches { items }, Placement::Free) => {
            limited(replay::ITEMS, "branches")?;
            let mut meter = Meter::endless(monitor);
            let pairs = Pairs::of(core, &mut meter)?;
            let mut room = Free::of(core, &pairs);
            replay::replay(
                &mut room,
                most(certificate),
                outliers,
                items,
                replay::UNDO_BYTES_MAX,
                &mut meter,
            )?;
            let cover = cover::of_balls(core, kind, &pairs, certificate, monitor)?;
            Ok((items.len() as u64, cover))
        }
        (LowerBound::Branches { items }, Placement::Rows) => {
            limited(replay::ITEMS, "branches")?;
            let places = places()?;
            let (mut room, mut meter) = (&places, Meter::endless(monitor));
            replay::replay(
                &mut room,
                most(certificate),
                outliers,
                items,
                replay::UNDO_BYTES_MAX,
                &mut meter,
            )?;
            Ok((items.len() as u64, cover::of_places(&places, certificate, monitor)?))
        }
    }
}

/// k, as more balls than fit in memory are as good as any number.
fn most(certificate: &CentersCertificate) -> usize {
    usize::try_from(certificate.k).unwrap_or(usize::MAX)
}

fn searched<R: Room>(
    room: &mut R,
    certificate: &CentersCertificate,
    meter: &mut Meter<'_>,
) -> Result<u64, CheckError> {
    match search::search(room, most(certificate), certificate.outliers, meter)? {
        (Outcome::Refuted, nodes) => Ok(nodes),
        (Outcome::Held, _) => Err(CentersViolation::NotProved.into()),
        (Outcome::Undecided, nodes) => Err(CentersViolation::NotConfirmed { nodes }.into()),
    }
}

fn refused<T>(violation: CentersViolation) -> Result<T, CheckError> {
    Err(violation.into())
}

/// The first two rows that are not apart.
fn first_pair(
    rows: usize,
    mut are_apart: impl FnMut(usize, usize) -> Result<bool, Stop>,
) -> Result<Option<(usize, usize)>, Stop> {
    for i in 0..rows {
        for j in 0..i {
            if !are_apart(i, j)? {
                return Ok(Some((j, i)));
            }
        }
    }
    Ok(None)
}
