//! The branches of a search, gone through again.
//!
//! *Idea.* Each branch gives an item to each group in turn, to a new one if there may be more, and to those left out. A
//! case whose group no ball holds is refuted there and then; of every other the log says how it goes on.
//! *Guarantee.* All cases are gone through, or the log is refused. No recursion: the depth is what the log makes it.
//! *Cost.* For each branch, a test for each group, and the item added to each group that takes it.

use taut_points::{Monitor, ReadError};

use super::super::CentersViolation;
use super::core::{clear, is_set, set};
use super::room::Room;
use crate::{CheckError, Violation};

/// Most items of a core-set whose branches are followed: their pairs take 32 MiB.
pub(super) const ITEMS: usize = 1 << 14;

/// One branch whose cases are gone through.
struct Branch<G> {
    item: usize,
    /// The case to be looked at next: a group by its number, then a new one, then those left out.
    next: usize,
    /// How to undo the case that is being gone through.
    undo: Undo<G>,
}

enum Undo<G> {
    Nothing,
    /// A group grew; this is what it was.
    Grown(usize, G),
    Opened,
    LeftOut,
}

/// Goes through all cases.
pub(super) fn replay<R: Room>(
    room: &mut R,
    k: usize,
    outliers: u64,
    log: &[u32],
    monitor: &Monitor<'_>,
) -> Result<(), CheckError> {
    let mut groups: Vec<R::Group> = vec![];
    let mut given = vec![0; room.len().div_ceil(64)];
    let mut left = outliers;
    let mut entries = log.iter().copied().enumerate();
    let mut open = vec![taken(&mut entries, &mut given, room.len(), log)?];
    let mut cases = 0u64;
    while let Some(branch) = open.last_mut() {
        cases += 1;
        if cases.is_multiple_of(1024) {
            monitor.check().map_err(ReadError::from)?;
        }
        match std::mem::replace(&mut branch.undo, Undo::Nothing) {
            Undo::Nothing => {}
            Undo::Grown(number, group) => groups[number] = group,
            Undo::Opened => drop(groups.pop()),
            Undo::LeftOut => left += 1,
        }
        let (case, item) = (branch.next, branch.item);
        branch.next += 1;
        let goes_on = if case < groups.len() {
            room.with(&groups[case], item)
                .map(|grown| Undo::Grown(case, std::mem::replace(&mut groups[case], grown)))
        } else if case == groups.len() && groups.len() < k {
            room.open(item).map(|group| {
                groups.push(group);
                Undo::Opened
            })
        } else if case <= groups.len() + 1 && left > 0 {
            branch.next = groups.len() + 2;
            left -= 1;
            Some(Undo::LeftOut)
        } else {
            clear(&mut given, item);
            open.pop();
            continue;
        };
        if let Some(undo) = goes_on {
            branch.undo = undo;
            let entry = taken(&mut entries, &mut given, room.len(), log)?;
            open.push(entry);
        }
    }
    match entries.next() {
        Some((used, _)) => Err(CentersViolation::LogGoesOn { used, branches: log.len() }.into()),
        None => Ok(()),
    }
}

/// The next branch of the log.
fn taken<G>(
    entries: &mut impl Iterator<Item = (usize, u32)>,
    given: &mut [u64],
    items: usize,
    log: &[u32],
) -> Result<Branch<G>, Violation> {
    let Some((entry, item)) = entries.next() else {
        return Err(CentersViolation::LogEnds { branches: log.len() }.into());
    };
    let refused = |problem| CentersViolation::Branch { entry, item, problem };
    let number = item as usize;
    if number >= items {
        return Err(refused("but there are not so many").into());
    }
    if is_set(given, number) {
        return Err(refused("which was given before").into());
    }
    set(given, number);
    Ok(Branch { item: number, next: 0, undo: Undo::Nothing })
}
