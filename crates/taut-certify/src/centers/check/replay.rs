//! The replay of the log of a branch and bound search.
//!
//! *Idea.* Each branch gives an item to each cluster in turn, to a new one if there may be more, and to those left out. A
//! case whose cluster no ball holds is refuted there and then; of every other the log says how it goes on. Items of one group go
//! where the first of them is: those after it have one case.
//! A node can also be refuted by the items left out above it, where the log says by which cluster ([`Oracle::is_held_out`]).
//! *Guarantee.* All cases are gone through, or the log is refused. No recursion: the depth is what the log makes it.
//! *Cost.* For each branch, a test for each cluster, and the item added to each cluster that takes it. An item that the deepest
//! center of its cluster has room for leaves nothing to be kept, another the center and the multipliers before it: a number
//! for each coordinate and two for each multiplier, of which there are at most d + 1. [`UNDO_BYTES_MAX`] bytes are granted.

use super::super::{CentersViolation, HeldOut};
use super::core::{clear, is_set, set};
use super::meter::Meter;
use super::oracle::Oracle;
use crate::{CheckError, Violation};

/// Most items of a core-set whose branches are followed: their pairs take 32 MiB.
pub(super) const ITEMS: usize = 1 << 14;

/// At most this many bytes are kept to undo the cases that are gone through.
pub(super) const UNDO_BYTES_MAX: u64 = 1 << 29;

/// A case beyond all.
const PAST_ALL: usize = usize::MAX;

/// One branch whose cases are gone through.
struct Branch<U> {
    item: usize,
    /// The case to be looked at next: a cluster by its number, then a new one, then those left out.
    next: usize,
    /// The only case, where an item of the same group was given before: its cluster.
    only: Option<usize>,
    /// The way to undo the case that is being gone through.
    undo: Undo<U>,
}

enum Undo<U> {
    Nothing,
    /// This cluster got the item.
    Grown(usize, U),
    Opened,
    LeftOut,
}

/// Where the first given item of a group is.
#[derive(Clone, Copy)]
enum Home {
    Nowhere,
    Cluster(usize),
    LeftOut,
}

/// The log of a search for k balls that may leave some items out.
pub(super) struct Log<'a> {
    pub(super) k: usize,
    pub(super) outliers: u64,
    /// The item of each branch, in preorder.
    pub(super) items: &'a [u32],
    /// The nodes that items left out refute, in preorder.
    pub(super) held_out: &'a [HeldOut],
    /// For each item of the core-set the number of its group.
    pub(super) groups: &'a [usize],
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
        let Log { k, outliers, items: log, held_out, groups, undo_bytes: most } = *self;
        let mut clusters: Vec<R::Cluster> = vec![];
        let mut given = vec![0; oracle.len().div_ceil(64)];
        let mut left_out = vec![];
        let mut held_out = held_out.iter().peekable();
        // Groups are numbered from 0, and there are no more than items.
        let mut homes = vec![Home::Nowhere; oracle.len()];
        let mut entries = log.iter().copied().enumerate();
        let first = taken(&mut entries, &mut given, oracle.len(), log)?;
        let mut open = vec![first.to_branch(groups, &homes)?];
        let mut undo_bytes = 0;
        while let Some(branch) = open.last_mut() {
            meter.spend(16)?;
            match std::mem::replace(&mut branch.undo, Undo::Nothing) {
                Undo::Nothing => {}
                Undo::Grown(number, undo) => {
                    undo_bytes -= R::undo_bytes(&undo) as u64;
                    oracle.undo(&mut clusters[number], undo);
                }
                Undo::Opened => drop(clusters.pop()),
                Undo::LeftOut => drop(left_out.pop()),
            }
            let (item, home) = (branch.item, &mut homes[groups[branch.item]]);
            let case = match branch.only {
                None => {
                    *home = Home::Nowhere;
                    branch.next
                }
                Some(only) if branch.next == 0 => only,
                Some(_) => PAST_ALL,
            };
            branch.next += 1;
            let goes_on = if case < clusters.len() {
                oracle.grow(&mut clusters[case], item, meter)?.map(|undo| {
                    undo_bytes += R::undo_bytes(&undo) as u64;
                    Undo::Grown(case, undo)
                })
            } else if case == clusters.len() && clusters.len() < k {
                oracle.open(item).map(|cluster| {
                    clusters.push(cluster);
                    Undo::Opened
                })
            } else if case <= clusters.len() + 1 && (left_out.len() as u64) < outliers {
                branch.next = clusters.len() + 2;
                left_out.push(item);
                Some(Undo::LeftOut)
            } else {
                clear(&mut given, item);
                open.pop();
                continue;
            };
            if let Some(undo) = goes_on {
                if branch.only.is_none() {
                    *home = match undo {
                        Undo::LeftOut => Home::LeftOut,
                        _ => Home::Cluster(case),
                    };
                }
                branch.undo = undo;
                if undo_bytes > most {
                    return Err(CentersViolation::Kept { branches: open.len(), most }.into());
                }
                let used = log.len() - entries.len();
                if let Some(&end) = held_out.next_if(|end| end.at == used as u64) {
                    let refuse = |problem| {
                        let HeldOut { at, cluster } = end;
                        Err(CheckError::from(CentersViolation::HeldOut { at, cluster, problem }))
                    };
                    match clusters.get(end.cluster as usize) {
                        None => return refuse("but there is no such cluster"),
                        Some(cluster) if oracle.is_held_out(cluster, &left_out, meter)? => continue,
                        Some(_) => {
                            return refuse("which is not so or cannot be told from rounding");
                        }
                    }
                }
                let entry = taken(&mut entries, &mut given, oracle.len(), log)?;
                open.push(entry.to_branch(groups, &homes)?);
            }
        }
        if let Some(&HeldOut { at, cluster }) = held_out.next() {
            let problem = "where no node is open";
            return Err(CentersViolation::HeldOut { at, cluster, problem }.into());
        }
        match entries.next() {
            Some((used, _)) => {
                Err(CentersViolation::LogGoesOn { used, branches: log.len() }.into())
            }
            None => Ok(()),
        }
    }
}

/// An item of the log that was not given before.
#[derive(Clone, Copy)]
struct Taken {
    entry: usize,
    item: u32,
}

impl Taken {
    fn to_branch<U>(self, groups: &[usize], homes: &[Home]) -> Result<Branch<U>, Violation> {
        let (Taken { entry, item }, number) = (self, self.item as usize);
        let only = match homes[groups[number]] {
            Home::Nowhere => None,
            Home::Cluster(cluster) => Some(cluster),
            Home::LeftOut => {
                let problem = "whose group is left out";
                return Err(CentersViolation::Branch { entry, item, problem }.into());
            }
        };
        Ok(Branch { item: number, next: 0, only, undo: Undo::Nothing })
    }
}

/// The next entry of the log.
fn taken(
    entries: &mut impl Iterator<Item = (usize, u32)>,
    given: &mut [u64],
    items: usize,
    log: &[u32],
) -> Result<Taken, Violation> {
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
    Ok(Taken { entry, item })
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::core::{Core, Pairs};
    use super::super::free::Free;
    use super::super::item::Kind;
    use super::*;

    /// Points that go out from the origin, each a little farther, so that the ball of a cluster changes with each; the log
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
        let groups: Vec<usize> = (0..rows).collect();
        let (items, held_out, groups) = (&log[..], &[][..], &groups[..]);
        let log = Log { k: 2, outliers: 0, items, held_out, groups, undo_bytes: most };
        match log.replay(&mut Free::of(&core, &pairs), &mut meter) {
            Err(CheckError::Rejected(Violation::Centers(violation))) => violation,
            other => panic!("{other:?}"),
        }
    }

    const ROWS: usize = 600;
    const DIM: usize = 20;

    /// Copies of the cluster at each branch would take 29 MB here, and grow by the square of the rows.
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
