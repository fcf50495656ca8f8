//! A second search, of another kind: k sets cannot cover the core-set, out of all sets that one ball can hold.
//!
//! *Where.* Points without weights, in the plane for k ≤ 10 and in space for k ≤ 6, and centres among the rows for k ≤ 10;
//! for core-sets of at most 200 items and places at rows that have at most [`SETS_MAX`] different sets of them. It is cut short
//! after [`sets::NODES_MAX`] nodes and after [`STEPS_MAX`] steps; then it has nothing to say.
//! *Agreement.* The sets are cut out by balls a little larger than those that they stand for, so a cover of the items may be
//! found where there is none. Only when each of its sets is held by one ball of a radius less than the bound, as far as
//! the arithmetic of the first search tells, do the searches contradict each other, and the certificate is refused.
//! *Up to what.* For free centres, what is confirmed is the bound less 4e-9 of it: see [`candidates`].

mod candidates;
mod sets;

use taut_points::Monitor;

use self::sets::{Covering, ITEMS, Set};
use super::super::{CentersCertificate, CentersViolation};
use super::core::{Core, Pairs};
use super::free::Free;
use super::item::Kind;
use super::meter::{Meter, Stop};
use super::room::Room;
use super::rows::Places;
use crate::CheckError;

/// A check takes at most this many steps, each about a word of a set: a few seconds.
const STEPS_MAX: u64 = 1 << 33;

/// At most this many sets are made for places at rows.
const SETS_MAX: usize = 1 << 22;

/// The nodes of the search over sets that balls with any centres hold, where one was made and came to an end.
pub(super) fn of_balls(
    core: &Core,
    kind: Kind,
    pairs: &Pairs,
    certificate: &CentersCertificate,
    monitor: &Monitor<'_>,
) -> Result<Option<u64>, CheckError> {
    let most = match (kind, core.dim) {
        (Kind::Points, 2) => 10,
        (Kind::Points, 3) => 6,
        _ => return Ok(None),
    };
    if certificate.k > most || core.len() > ITEMS {
        return Ok(None);
    }
    let mut meter = Meter::of(monitor, STEPS_MAX);
    silently(|| {
        let sets = match core.dim {
            2 => candidates::in_the_plane(core, &mut meter)?,
            _ => candidates::in_space(core, &mut meter)?,
        };
        confirmed(sets, &mut Free::of(core, pairs), certificate, &mut meter)
    })
}

/// The nodes of the search over sets that balls with centres at rows hold, where one was made and came to an end.
pub(super) fn of_places(
    places: &Places,
    certificate: &CentersCertificate,
    monitor: &Monitor<'_>,
) -> Result<Option<u64>, CheckError> {
    if certificate.k > 10 || Room::len(&places) > ITEMS || places.sets.len() > SETS_MAX {
        return Ok(None);
    }
    let sets = places.sets.iter().map(|set| Set::of_words(set)).collect();
    let mut meter = Meter::of(monitor, STEPS_MAX);
    silently(|| confirmed(sets, &mut &*places, certificate, &mut meter))
}

/// What a search found that may have nothing to say.
fn silently(search: impl FnOnce() -> Result<Found, Stop>) -> Result<Option<u64>, CheckError> {
    match search() {
        Ok(Found::NoCover(nodes)) => Ok(Some(nodes)),
        Ok(Found::Cover) => Err(CentersViolation::Covered.into()),
        Ok(Found::Nothing) | Err(Stop::Spent(_)) => Ok(None),
        Err(stop) => Err(stop.into()),
    }
}

/// How a second search ended.
enum Found {
    /// No sets cover the items, after so many nodes.
    NoCover(u64),
    /// Some do, and for each of them there is a ball, as far as rounding tells.
    Cover,
    Nothing,
}

fn confirmed<R: Room>(
    sets: Vec<Set>,
    room: &mut R,
    certificate: &CentersCertificate,
    meter: &mut Meter<'_>,
) -> Result<Found, Stop> {
    let mut covering = Covering::of(sets, room.len(), meter)?;
    let found = covering.search(certificate.k as usize, certificate.outliers as usize, meter)?;
    Ok(match found {
        None => Found::Nothing,
        Some(None) => Found::NoCover(covering.nodes),
        Some(Some(cover)) => {
            for set in &cover {
                if !room.fit(set.items(), meter)? {
                    return Ok(Found::Nothing);
                }
            }
            Found::Cover
        }
    })
}
