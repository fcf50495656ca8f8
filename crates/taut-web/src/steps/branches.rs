//! The branches of the proof of a k-center bound, gone through one case at a time.
//!
//! *Idea.* The certificate lists which item is branched on at each node, in preorder. Each branch gives its item to each ball in turn,
//! then to a new one. A case ends where no ball smaller than the bound holds the items of a ball; where no case is left, no k balls
//! smaller than the bound hold all items.

use super::{Table, ball_of};

/// Relative difference to the bound up to which a ball counts as not smaller: both are rounded.
const BOUND_SLACK: f64 = 1e-9;

/// Most cases kept; the rest of a longer proof is not shown.
pub(super) const CASES_MAX: usize = 1500;

/// One case: an item is given to a ball.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    /// The rows of each ball, the one given last among them.
    pub(super) balls: Vec<Vec<usize>>,
    /// The ball that got a row, and that row.
    pub(super) ball: usize,
    pub(super) row: usize,
    /// The radius of the smallest ball around the rows of that ball.
    pub(super) radius: f64,
    /// True if that is not below the bound.
    pub(super) is_refuted: bool,
}

/// A branch whose cases are gone through.
struct Branch {
    row: usize,
    next: usize,
    /// The ball that has the row in the case that is gone through.
    given: Option<usize>,
}

/// Returns the cases of a proof that no `k` balls of a radius below `bound` hold the rows `core_set`; `items` is the log.
/// Returns `None` where the log does not fit, as the checker compares with other roundings than this.
pub(super) fn cases(
    table: &Table,
    core_set: &[usize],
    items: &[u32],
    k: usize,
    bound: f64,
) -> Result<Option<Vec<Case>>, String> {
    let mut log = items.iter().map(|&item| core_set.get(item as usize).copied());
    let mut take = || log.next().flatten().map(|row| Branch { row, next: 0, given: None });
    let (mut cases, mut balls): (Vec<Case>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
    let Some(first) = take() else { return Ok(None) };
    let mut open = vec![first];
    while let Some(branch) = open.last_mut() {
        if let Some(ball) = branch.given.take() {
            balls[ball].pop();
            balls.retain(|ball| !ball.is_empty());
        }
        let ball = branch.next;
        branch.next += 1;
        if ball > balls.len() || ball == k {
            open.pop();
            continue;
        }
        if ball == balls.len() {
            balls.push(Vec::new());
        }
        balls[ball].push(branch.row);
        branch.given = Some(ball);
        let (_, radius) = ball_of(table, &balls[ball])?;
        let is_refuted = balls[ball].len() > 1 && radius >= bound * (1.0 - BOUND_SLACK);
        cases.push(Case { balls: balls.clone(), ball, row: branch.row, radius, is_refuted });
        if cases.len() == CASES_MAX {
            return Ok(Some(cases));
        }
        if !is_refuted {
            let Some(branch) = take() else { return Ok(None) };
            open.push(branch);
        }
    }
    Ok(log.next().is_none().then_some(cases))
}
