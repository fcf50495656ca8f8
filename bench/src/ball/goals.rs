//! What goals of the minimum enclosing ball ask for.

use super::*;

pub(super) const BUDGET_STOPS: Quantity = Quantity::new("runs that a budget stopped", Unit::Plain);
/// Of the median time.
pub(super) const READS: Quantity =
    Quantity::new("plain reads of the same memory in the time taken", Unit::Times);
pub(super) const FASTER: Quantity =
    Quantity::new("time of the fastest peer over ours", Unit::Times);
pub(super) const SHARE: Quantity = Quantity::new("our time over that of each peer", Unit::Times);
/// Each peer gave the ball we proved, or what is wrong with its own is shown.
pub(super) const UNEXPLAINED: Quantity =
    Quantity::new("answers outside our certified bracket and not shown to be wrong", Unit::Plain);
pub(super) const OF_CAT: Quantity =
    Quantity::new("speed of each pass over that of cat", Unit::Times);

/// Whether a budget stopped a run, as a goal asks for it.
pub(super) fn stops(stop: Stop) -> (f64, String) {
    (f64::from(u8::from(stop != Stop::Converged)), format!("{stop:?}").to_lowercase())
}
