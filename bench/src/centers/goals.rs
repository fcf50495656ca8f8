//! What goals of k centers ask for.

use super::*;

/// The radii that cases name are known to so many digits.
pub(super) const KNOWN_RADIUS_TOLERANCE: f64 = 1e-6;
/// Rounding in a factor, which a maximum may meet exactly.
pub(super) const FACTOR_ROUNDING: f64 = 1e-9;

pub(super) const CORE_SET: Quantity = Quantity::new("rows in the certificate", Unit::Plain);
pub(super) const CHECK: Quantity = Quantity::new("time of the check", Unit::Seconds);
pub(super) const DIFFERS: Quantity =
    Quantity::new("relative difference of radii to the peer's", Unit::Power);
/// Whole passes, one for each center, would take this share of the time when nothing but memory bound them.
pub(super) const BANDWIDTH: Quantity =
    Quantity::new("share of the bandwidth bound, a plain read for each center", Unit::Times);
pub(super) const FACTOR: Quantity =
    Quantity::new("radius over lower bound, over the factor stated", Unit::Times);
