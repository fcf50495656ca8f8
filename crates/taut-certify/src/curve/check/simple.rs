//! Whether edges meet that must not.

use taut_points::{Cancelled, Monitor, ReadError};

use super::edges::Edges;
use super::signs::{is_on, meet};
use super::tree::Area;

/// Two edges that meet though they are no neighbors, or neighbors that have more in common than their vertex.
pub(super) fn crossing(
    edges: &Edges,
    monitor: &Monitor<'_>,
) -> Result<Option<[usize; 2]>, ReadError> {
    let (mut found, mut steps) = (None, 0u32);
    edges.tree.pairs(|one, other| -> Result<bool, Cancelled> {
        steps = steps.wrapping_add(1);
        if steps.is_multiple_of(1 << 16) {
            monitor.check()?;
        }
        let segment = |edge: usize| edges.ends[edge].map(|end| edges.exact[end]);
        let ([a, b], [c, d]) = (segment(one), segment(other));
        // The tree knows scaled coordinates, which may have lost bits.
        if Area::of(&[a, b]).meets(&Area::of(&[c, d])) {
            let ([a_id, b_id], [c_id, d_id]) = (edges.ends[one], edges.ends[other]);
            let is_wrong = match () {
                () if b_id == c_id => is_on(a, b, d) || is_on(c, d, a),
                () if a_id == d_id => is_on(a, b, c) || is_on(c, d, b),
                () => meet(a, b, c, d),
            };
            if is_wrong {
                found = Some([one, other]);
            }
        }
        Ok(found.is_some())
    })?;
    Ok(found)
}
