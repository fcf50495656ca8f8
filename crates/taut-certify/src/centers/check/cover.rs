//! A second search, of another kind: k sets cannot cover the core-set, out of all sets that one ball can hold.
//!
//! *Where.* Points without weights, in the plane for k ≤ 10 and in space for k ≤ 6, and centres among the rows for k ≤ 10;
//! for core-sets of at most 200 items. It is cut short after [`sets::NODES`] nodes; then it has nothing to say.
//! *Agreement.* The sets are cut out by balls a little larger than those that they stand for, so a cover of the items may be
//! found where there is none. Only when each of its sets is held by one ball of a radius less than the bound, as far as
//! the arithmetic of the first search tells, do the searches contradict each other, and the certificate is refused.
//! *Up to what.* For free centres, what is confirmed is the bound less 4e-9 of it: see [`candidates`].

mod candidates;
mod sets;

use taut_points::{Monitor, ReadError};

use self::sets::{Covering, ITEMS, Set};
use super::super::{CentersCertificate, CentersViolation};
use super::core::{Core, Pairs};
use super::free::Free;
use super::item::Kind;
use super::room::Room;
use super::rows::Places;
use crate::CheckError;

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
    let sets = match core.dim {
        2 => candidates::in_the_plane(core),
        _ => candidates::in_space(core, monitor)?,
    };
    confirmed(sets, &mut Free::of(core, pairs), certificate, monitor)
}

/// The nodes of the search over sets that balls with centres at rows hold, where one was made and came to an end.
pub(super) fn of_places(
    places: &Places,
    certificate: &CentersCertificate,
    monitor: &Monitor<'_>,
) -> Result<Option<u64>, CheckError> {
    if certificate.k > 10 || Room::len(&places) > ITEMS {
        return Ok(None);
    }
    let sets = places.sets.iter().map(|set| Set::of_words(set)).collect();
    confirmed(sets, &mut &*places, certificate, monitor)
}

fn confirmed<R: Room>(
    sets: Vec<Set>,
    room: &mut R,
    certificate: &CentersCertificate,
    monitor: &Monitor<'_>,
) -> Result<Option<u64>, CheckError> {
    let mut covering = Covering::of(sets, room.len());
    let found = covering.search(certificate.k as usize, certificate.outliers as usize, monitor);
    let Some(found) = found.map_err(ReadError::from)? else { return Ok(None) };
    let Some(cover) = found else { return Ok(Some(covering.nodes)) };
    let is_held = |set: &Set| {
        let mut items = set.items();
        let first = items.next().and_then(|first| room.open(first));
        items.fold(first, |group, item| group.and_then(|group| room.with(&group, item))).is_some()
    };
    match cover.iter().all(is_held) {
        true => Err(CentersViolation::Covered.into()),
        false => Ok(None),
    }
}
