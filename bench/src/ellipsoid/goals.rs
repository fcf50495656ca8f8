//! What goals of ellipsoids ask for.

use super::*;

/// Rounding in what is minimized, below which two answers are equally good.
pub(super) const OBJECTIVE_ROUNDING: f64 = 1e-11;

pub(super) const OUTSIDE: Quantity =
    Quantity::new("log-volume outside the known bracket", Unit::Power);
/// By the clock, least over least.
pub(super) const FASTER: Quantity = Quantity::new("time of the peer over ours", Unit::Times);
pub(super) const OBJECTIVE: Quantity =
    Quantity::new("what is minimized, less what the peer reached", Unit::Power);
pub(super) const OTHER_FLAGS: Quantity =
    Quantity::new("sets with other flagged rows than published", Unit::Plain);
pub(super) const OTHER_THAN_PEER: Quantity =
    Quantity::new("sets with other rows weighed out than the peer's, for the same h", Unit::Plain);
/// Of radius or volume.
pub(super) const DIFFERS: Quantity = Quantity::new("relative difference to the peer", Unit::Power);
