//! k centers among the rows: the discrete k-center problem, to a proved gap, down to 0.
//!
//! *Problem.* Of n items in ℝᵈ choose k rows as centers, and up to z items to leave out, such that the largest reach of an
//! item from the nearest center is least: w·|p − c| for points, |m − c| + r for balls.
//! *Idea.* The optimum is one of the n² reaches between rows. Farthest-first traversals bracket it ([`start`]). For a radius
//! between the bounds, each item has the set of rows within it, and a cluster is what such sets have in common; a tree
//! over a few items X either finds that no k clusters hold X, which raises the lower bound to the next reach of X, or
//! centers that hold all ([`search`]). The bracket is halved until it is narrow; then the radius wanted is tried at once.
//! *Guarantee.* For ε = 0 no k rows have a smaller radius, as reaches are evaluated in `f64`. The bound given is lower by a
//! relative 1e-12, which is more than rounding. When the nodes are used up, the best centers and the best bound so far.
//! *Cost.* O(nd) for each item of X and each radius, O(nkd) for each cover that is measured; nodes exponential in k and z.
//! Memory: all rows, and n|X|/8 bytes.
//! *Groups.* A group reaches as far from a row as the farthest of its rows. X has rows of groups, which go where the first of them
//! was put; a group fits into a cluster if each of its rows in X does.
//! *Trap.* "Less than the radius", everywhere: at the optimum itself there is a cover.

mod core_set;
mod proof;
mod search;
mod sites;
mod start;
mod state;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

use taut_certify::{
    Centers, CentersCertificate, Items, LowerBound, PassBounds, Placement, Solution, Stop, Trace,
};
use taut_points::{Monitor, OrderBy};

use self::core_set::CoreSet;
use self::proof::{Proof, prove};
use self::search::{End, Search};
use self::sites::Sites;
use self::start::{Incumbent, start};
use self::state::State;
use crate::Error;
use crate::centers::item_rows::ItemRows;
use crate::centers::{CentersMethod, CentersOptions, PROOF_FACTOR, PROOF_NODES};
use crate::separated_set::claimed;

/// Once the gap is at most this beyond the one wanted, the radius wanted is tried at once.
const NEAR_GAP: f64 = 0.02;
/// The first try at a radius has this many nodes; each next one has twice as many, so that all cost about twice the
/// last.
const FIRST_TRY_NODES: u64 = 200;

/// By how much, relatively, bounds are lowered: many times what a reach can be off by.
fn rounding(sites: &Sites) -> f64 {
    1e-12 + sites.dim() as f64 * 4.0 * f64::EPSILON
}

/// Returns what is proved when no k balls of less than `radius` hold X: less by a little, so that rounding explains no cover.
fn proved(radius: f64, sites: &Sites) -> f64 {
    claimed(radius * (1.0 - rounding(sites)), 1.0)
}

/// At most k rows as centers of all items but `options.outliers` of them.
pub(super) fn solve(
    rows: ItemRows,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let sites = Sites::of(rows);
    let outliers = options.outliers as usize;
    // More centers than rows are of no use.
    let mut bracket = Bracket::new(&sites, k.min(sites.len()), outliers, options, monitor)?;
    if !bracket.incumbent.radius.is_finite() {
        return Err(Error::Overflow);
    }
    bracket.record();
    if options.method == CentersMethod::Tree {
        bracket.close()?;
    }
    let (lower, proof, why) = bracket.proof()?;
    let answer = answer(&sites, &bracket.incumbent, outliers, lower, options)?;
    let gap = match answer.radius {
        radius if radius <= lower => 0.0,
        _ if lower == 0.0 => f64::MAX,
        radius => (radius / lower - 1.0).next_up(),
    };
    let is_reached = options.method == CentersMethod::FarthestFirst
        || gap <= options.epsilon.max(4.0 * rounding(&sites));
    let certificate = CentersCertificate {
        items,
        weights: options.weights,
        group: options.group.map(|column| column as u64),
        placement: Placement::Rows,
        k: k as u64,
        outliers: options.outliers,
        gap,
        core_set: proof.members.iter().map(|&site| sites.row(site)).collect(),
        directions: vec![],
        proof: proof.by,
        points_hash: sites.hash(),
    };
    // The bounds shown on the way, as far as they are proved in the end.
    let bounds = |b: &PassBounds| PassBounds {
        lower: b.lower.min(lower),
        upper: b.upper.max(answer.radius),
        ..*b
    };
    let mut counters = BTreeMap::from([("scans".to_owned(), bracket.scans)]);
    counters.insert("proof_nodes".to_owned(), proof.nodes);
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: match why {
            _ if is_reached => Stop::Converged,
            _ if bracket.is_spent => Stop::NodeBudget,
            why => why.unwrap_or(Stop::Rounding),
        },
        passes: 1,
        iterations: bracket.nodes,
        core_set: bracket.members.len() as u64,
        history: bracket.history.iter().map(bounds).collect(),
        counters,
    };
    Ok(Solution { answer, certificate, trace })
}

/// The bounds, and how they were found.
struct Bracket<'a> {
    sites: &'a Sites,
    k: usize,
    outliers: usize,
    options: &'a CentersOptions<'a>,
    monitor: &'a Monitor<'a>,
    incumbent: Incumbent,
    /// Sites of the items of X, in the order in which they were added.
    members: Vec<usize>,
    /// Radii less than which no k balls hold so many of the first members, ascending.
    refuted: Vec<(f64, usize)>,
    nodes: u64,
    /// True if the nodes ended the search.
    is_spent: bool,
    scans: u64,
    history: Vec<PassBounds>,
}

impl<'a> Bracket<'a> {
    fn new(
        sites: &'a Sites,
        k: usize,
        outliers: usize,
        options: &'a CentersOptions<'a>,
        monitor: &'a Monitor<'a>,
    ) -> Result<Self, Error> {
        let start = start(sites, k, outliers, monitor)?;
        Ok(Bracket {
            sites,
            k,
            outliers,
            options,
            monitor,
            incumbent: start.incumbent,
            refuted: vec![(start.lower, start.members.len())],
            members: start.members,
            nodes: 0,
            is_spent: false,
            scans: 0,
            history: vec![],
        })
    }

    fn lower(&self) -> f64 {
        self.refuted.last().map_or(0.0, |&(radius, _)| radius)
    }

    /// Returns true if the gap is as small as was asked.
    fn is_closed(&self) -> bool {
        let (upper, lower) = (self.incumbent.radius, self.lower());
        // Half of the rounding is for the radius, which is given a little larger.
        let upper_given = upper * (1.0 + 0.5 * rounding(self.sites));
        lower >= upper || upper_given <= (1.0 + self.options.epsilon) * proved(lower, self.sites)
    }

    /// The radius to try next, above the lower bound and at most the upper.
    fn next_radius(&self) -> f64 {
        let (upper, lower, epsilon) = (self.incumbent.radius, self.lower(), self.options.epsilon);
        let rounding = rounding(self.sites);
        let wanted = match epsilon > 4.0 * rounding {
            true => upper / (1.0 + epsilon) * (1.0 + 2.0 * rounding),
            false => upper,
        };
        let middle = lower * (upper / lower).sqrt();
        let is_near = upper <= (1.0 + NEAR_GAP) * (1.0 + epsilon) * lower;
        // Without a lower bound there is no middle.
        let is_between = middle > lower && middle <= wanted;
        if is_near || !is_between { wanted } else { middle }
    }

    /// Halves the bracket until it is as narrow as was asked, or the nodes are used up.
    fn close(&mut self) -> Result<(), Error> {
        while !self.is_closed() {
            let radius = self.next_radius();
            let core = CoreSet::new(self.sites, radius, &self.members, self.monitor)?;
            let mut core = Arc::new(core);
            let mut patience = FIRST_TRY_NODES;
            let end = loop {
                let mut state = State::new(core, self.k, self.outliers);
                let mut search = Search {
                    state: &mut state,
                    incumbent: &mut self.incumbent,
                    nodes: &mut self.nodes,
                    scans: &mut self.scans,
                    max_nodes: self.options.max_nodes,
                    monitor: self.monitor,
                };
                let end = search.run(patience)?;
                core = state.core;
                match end {
                    End::Grown => patience = patience.saturating_mul(2),
                    end => break end,
                }
            };
            self.members.clone_from(&core.members);
            match end {
                End::Spent => {
                    self.is_spent = true;
                    break;
                }
                End::Refuted => {
                    // X has the same balls up to the next of its reaches.
                    let next = self.members.iter().map(|&item| self.sites.next_reach(item, radius));
                    let next = next.fold(self.incumbent.radius, f64::min).max(radius);
                    self.refuted.push((next, self.members.len()));
                }
                End::StreamingReport | End::Grown => {}
            }
            self.record();
        }
        Ok(())
    }

    fn record(&mut self) {
        let bounds = PassBounds {
            lower: proved(self.lower(), self.sites),
            upper: self.incumbent.radius,
            working_set: self.members.len() as u64,
        };
        self.history.push(bounds);
    }

    /// The best bound that can be written down, its proof, and why no better one.
    fn proof(&self) -> Result<(f64, Proof, Option<Stop>), Error> {
        let mut max_nodes = self.nodes.saturating_mul(PROOF_FACTOR).saturating_add(PROOF_NODES);
        let mut why = None;
        for &(radius, count) in self.refuted.iter().rev() {
            let lower = proved(radius, self.sites);
            if lower == 0.0 || self.incumbent.radius == 0.0 {
                break;
            }
            let members = &self.members[..count];
            // At the very bound that is claimed: a reach between it and the radius is in no ball of the checker's.
            let proof =
                prove(self.sites, members, lower, self.k, self.outliers, max_nodes, self.monitor)?;
            match proof {
                Ok(proof) => return Ok((lower, proof, why)),
                Err(reason) => why = why.or(Some(reason)),
            }
            // All tries together cost no more than two of the first.
            max_nodes /= 2;
        }
        Ok((0.0, Proof { members: vec![], by: LowerBound::Separated, nodes: 0 }, why))
    }
}

/// The centers as they are returned: by row, each once, with a radius that holds as anybody may evaluate it.
fn answer(
    sites: &Sites,
    incumbent: &Incumbent,
    outliers: usize,
    lower_bound: f64,
    options: &CentersOptions<'_>,
) -> Result<Centers, Error> {
    let mut centers = incumbent.centers.clone();
    centers.order_by_key(|&site| sites.row(site));
    centers.dedup();
    let (reaches, nearest) = sites.nearest(&centers);
    let mut is_out = vec![false; sites.len()];
    let mut count = 0;
    for site in (0..sites.len()).filter(|&site| reaches[site] > incumbent.radius) {
        count += usize::from(!is_out[site]);
        sites.linked(site).into_iter().for_each(|linked| is_out[linked] = true);
    }
    debug_assert!(count <= outliers, "the radius leaves out more than may be");
    let mut left_out: Vec<u64> =
        (0..sites.len()).filter(|&site| is_out[site]).map(|site| sites.row(site)).collect();
    left_out.sort_unstable();
    let close = incumbent.radius * (1.0 - rounding(sites));
    // Of distances that have lost digits, each may be the largest.
    let may_be_largest = |&site: &usize| {
        !is_out[site]
            && (reaches[site] >= close || !sites.is_even(site, centers[nearest[site] as usize]))
    };
    let radius = (0..sites.len())
        .filter(may_be_largest)
        .map(|site| sites.reach_up(site, centers[nearest[site] as usize]))
        .fold(0.0, f64::max);
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    let mut assignment = vec![0; if options.assignment { sites.len() } else { 0 }];
    if options.assignment {
        nearest.iter().enumerate().for_each(|(site, &j)| assignment[sites.row(site) as usize] = j);
    }
    Ok(Centers {
        rows: centers.iter().map(|&site| sites.row(site)).collect(),
        centers: centers.iter().map(|&site| sites.position(site).to_vec()).collect(),
        radius,
        lower_bound,
        outliers: left_out,
        assignment,
    })
}
