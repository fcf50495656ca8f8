//! The replay of the log of a branch and bound search.
//!
//! *Idea.* Each branch gives an item to each group in turn, to a new one if there may be more, and to those left out. A
//! case whose group no ball holds is refuted there and then; of every other the log says how it goes on.
//! *Guarantee.* All cases are gone through, or the log is refused. No recursion: the depth is what the log makes it.
//! *Cost.* For each branch, a test for each group, and the item added to each group that takes it. An item that the deepest
//! center of its group has room for leaves nothing to be kept, another the center and the multipliers before it: a number
//! for each coordinate and two for each multiplier, of which there are at most d + 1. [`UNDO_BYTES_MAX`] bytes are granted.

use super::super::CentersViolation;
use super::core::{clear, is_set, set};
use super::meter::Meter;
use super::oracle::Oracle;
use crate::{CheckError, Violation};

/// Most items of a core-set whose branches are followed: their pairs take 32 MiB.
pub(super) const ITEMS: usize = 1 << 14;

/// At most this many bytes are kept to undo the cases that are gone through.
pub(super) const UNDO_BYTES_MAX: u64 = 1 << 29;

/// One branch whose cases are gone through.
struct Branch<U> {
    item: usize,
    /// The case to be looked at next: a group by its number, then a new one, then those left out.
    next: usize,
    /// The way to undo the case that is being gone through.
    undo: Undo<U>,
}

enum Undo<U> {
    Nothing,
    /// This group got the item.
    Grown(usize, U),
    Opened,
    LeftOut,
}

/// The log of a search for k balls that may leave some items out.
pub(super) struct Log<'a> {
    pub(super) k: usize,
    pub(super) outliers: u64,
    /// The item of each branch, in preorder.
    pub(super) items: &'a [u32],
    /// At most this many bytes are kept to undo cases.
    pub(super) undo_bytes: u64,
}

impl Log<'_> {
    /// Goes through all cases.
    pub(super) fn replay<R: Oracle>(
        &self,
        oracle: &mut R,
        meter: &mut Meter<'_>,
    ) -> Result<(), CheckError> {
        let Log { k, outliers, items: log, undo_bytes: most } = *self;
        let mut groups: Vec<R::Group> = vec![];
        let mut given = vec![0; oracle.len().div_ceil(64)];
        let mut left = outliers;
        let mut entries = log.iter().copied().enumerate();
        let mut open = vec![taken(&mut entries, &mut given, oracle.len(), log)?];
        let mut undo_bytes = 0;
        while let Some(branch) = open.last_mut() {
            meter.spend(16)?;
            match std::mem::replace(&mut branch.undo, Undo::Nothing) {
                Undo::Nothing => {}
                Undo::Grown(number, undo) => {
                    undo_bytes -= R::undo_bytes(&undo) as u64;
                    oracle.undo(&mut groups[number], undo);
                }
                Undo::Opened => drop(groups.pop()),
                Undo::LeftOut => left += 1,
            }
            let (case, item) = (branch.next, branch.item);
            branch.next += 1;
            let goes_on = if case < groups.len() {
                oracle.grow(&mut groups[case], item, meter)?.map(|undo| {
                    undo_bytes += R::undo_bytes(&undo) as u64;
                    Undo::Grown(case, undo)
                })
            } else if case == groups.len() && groups.len() < k {
                oracle.open(item).map(|group| {
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
                if undo_bytes > most {
                    return Err(CentersViolation::Kept { branches: open.len(), most }.into());
                }
                let entry = taken(&mut entries, &mut given, oracle.len(), log)?;
                open.push(entry);
            }
        }
        match entries.next() {
            Some((used, _)) => {
                Err(CentersViolation::LogGoesOn { used, branches: log.len() }.into())
            }
            None => Ok(()),
        }
    }
}

/// The next branch of the log.
fn taken<U>(
    entries: &mut impl Iterator<Item = (usize, u32)>,
    given: &mut [u64],
    items: usize,
    log: &[u32],
) -> Result<Branch<U>, Violation> {
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

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::core::{Core, Pairs};
    use super::super::free::Free;
    use super::super::item::Kind;
    use super::*;

    /// Points that go out from the origin, each a little farther, so that the ball of a group changes with each; the log
    /// puts them all into one.
    fn refusal(most: u64) -> CentersViolation {
        let (rows, dim) = (ROWS, DIM);
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31) - 0.5
        };
        let values: Vec<f64> = (0..rows)
            .flat_map(|row| {
                let place: Vec<f64> = (0..dim).map(|_| next()).collect();
                let length = place.iter().map(|x| x * x).sum::<f64>().sqrt();
                let radius = 1.0 + row as f64 / rows as f64;
                place.into_iter().map(move |x| x / length * radius)
            })
            .collect();
        let mut meter = Meter::of(&Monitor::silent());
        let core = Core::of(&values, dim, Kind::Points, 1e3);
        let pairs = Pairs::of(&core, &mut meter).unwrap();
        let log: Vec<u32> = (0..rows as u32).collect();
        let log = Log { k: 2, outliers: 0, items: &log, undo_bytes: most };
        match log.replay(&mut Free::of(&core, &pairs), &mut meter) {
            Err(CheckError::Rejected(Violation::Centers(violation))) => violation,
            other => panic!("{other:?}"),
        }
    }

    const ROWS: usize = 600;
    const DIM: usize = 20;

    /// Copies of the group at each branch would take 29 MB here, and grow by the square of the rows.
    #[test]
    fn what_is_kept_grows_by_a_fit_for_each_branch() {
        let fit = 8 * DIM + 16 * (DIM + 1);
        let at_most = refusal((ROWS * fit) as u64);
        assert_eq!(at_most, CentersViolation::LogEnds { branches: ROWS });
        let few = 100 * fit as u64;
        match refusal(few) {
            CentersViolation::Kept { branches, most } => {
                assert_eq!(most, few);
                assert!((100..ROWS).contains(&branches), "{branches}");
            }
            other => panic!("{other:?}"),
        }
    }

    /// The largest core-set in forty dimensions stays below what is granted.
    #[test]
    fn all_branches_there_can_be_are_granted() {
        assert!((ITEMS * (8 * 40 + 16 * 41)) as u64 <= UNDO_BYTES_MAX);
    }
}
