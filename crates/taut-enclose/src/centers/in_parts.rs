//! Centers to any gap of points that lie elsewhere: the search goes over a core-set, to which passes add what its centers leave out.
//!
//! *Idea.* The core-set begins with the first points of a farthest-first traversal. It is solved here, where the solver is; one pass
//! lists the rows that are farthest from its centers. Those beyond the wanted radius join it, some of them that are apart from each
//! other, until there are none.
//! *Guarantee.* No k balls of a radius below the lower bound hold the core-set, so none hold all points. The radius is measured over
//! all of them. Each round adds a point, so rounds end.
//! *Reference.* Bădoiu, Har-Peled, Indyk, STOC 2002, for core-sets of k centers.

use std::collections::BTreeSet;

use taut_certify::{Centers, Solution, Stop};
use taut_points::{Elsewhere, Monitor, PointSource, gather};

use super::{CentersOptions, GAP_MIN};
use crate::farthest_first::{Shortlist, farthest_first_in_parts};
use crate::passes::ask_farthest;
use crate::{CoreSetSummary, Error, FarthestFirstOptions};

/// Points of the traversal that the core-set begins with, for each center.
const STARTS_OF_CENTER: usize = 4;
/// Rows that a pass lists.
const ROWS_LISTED: usize = 512;
/// Most rows that join the core-set in one round, for each center: more would cost the search more than they save passes.
const ROWS_ADDED: usize = 2;
/// The part of the wanted gap that the search over the core-set may leave, and that all points together may.
const GAP_OF_SEARCH: f64 = 0.5;
const GAP_OF_ALL: f64 = 0.75;

pub(super) fn solve(
    source: &dyn PointSource,
    elsewhere: &dyn Elsewhere,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let (dim, epsilon) = (source.dim(), options.epsilon.max(4.0 * GAP_MIN));
    let starts = k.saturating_mul(STARTS_OF_CENTER) as u64;
    let traversal = FarthestFirstOptions { monitor: *monitor, ..Default::default() };
    let (order, frame) = farthest_first_in_parts(source, elsewhere, starts, &traversal)?;
    let mut rows: BTreeSet<u64> = order.order.iter().copied().chain(order.next).collect();
    let (mut passes, mut rounds) = (order.trace.passes, 0);
    let search = CentersOptions { epsilon: GAP_OF_SEARCH * epsilon, threads: None, ..*options };
    loop {
        let ids: Vec<u64> = rows.iter().copied().collect();
        let values = gather(source, &ids)?;
        let core_set = CoreSetSummary::of_rows(dim, ids, values, source.len());
        let mut found = super::centers(&core_set.points()?, k, &search)?;
        let mut centers = found.answer.centers.clone();
        centers.iter_mut().for_each(|center| frame.bring_in(center));
        (passes, rounds) = (passes + 1, rounds + 1);
        monitor.pass(passes, source.len());
        let far = ask_farthest(elsewhere, source, &frame, &centers, ROWS_LISTED)?;
        let is_all = far.len() as u64 == source.len();
        let mut list = Shortlist::of(far, is_all, |ids| frame.gather(source, ids))?;
        let before = rows.len();
        while rows.len() < before + k.saturating_mul(ROWS_ADDED)
            && let Some((far, place)) = list.farthest_listed(dim)
            && frame.bring_out(far.reach2.sqrt())?
                > (1.0 + GAP_OF_ALL * epsilon) * found.answer.lower_bound
            && rows.insert(far.id)
        {
            let place = place.to_vec();
            list.compare(&place);
        }
        let is_spent = matches!(found.trace.stop, Stop::NodeBudget | Stop::ProofBudget);
        if rows.len() == before || is_spent {
            found.trace.passes = passes;
            found.trace.counters.insert("rounds".to_owned(), rounds);
            return core_set.lift(found, source, monitor);
        }
    }
}
