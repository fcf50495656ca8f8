//! The checkers' own arithmetic: sums to twice the precision of `f64` with proved bounds, and exact signs.

mod decay;
mod double_double;
mod exact;
mod field;
mod integer;
mod ring;

pub(crate) use decay::{DECAY_ERROR, decay};
pub(crate) use double_double::{Compensated, Known, U, square, two_product, two_sum};
pub(crate) use exact::ExactSum;
pub(crate) use field::{Field, factorize};
pub(crate) use integer::{Integer, parts};
pub(crate) use ring::{DoubleDouble, Residue, Ring};
