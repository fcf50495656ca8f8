//! Random samples and random order, as functions of a seed.
//!
//! | you want | call | cost |
//! |---|---|---|
//! | k of the numbers below n, distinct, in order | [`sample`] | O(k) |
//! | the same one by one, without memory | [`Sequential`] | O(k), O(1) room |
//! | each number below n with probability p | [`bernoulli`] | O(pn) |
//! | k of a stream of unknown length | [`Reservoir`] | O(1) an item, O(k log (n/k)) random numbers |
//! | items in random order | [`shuffle`] | O(n log (n/M)) in memory, few misses |
//!
//! The result of each depends on seed and arguments alone, not on the threads. [`sample`], [`bernoulli`] and [`shuffle`]
//! use no function whose rounding differs between machines, and give the same bytes everywhere.
mod divide;
mod random;
mod reservoir;
mod sequential;
mod shuffle;
#[cfg(test)]
mod tests;
mod weights;

pub use divide::{bernoulli, sample};
pub use reservoir::Reservoir;
pub use sequential::Sequential;
pub use shuffle::{shuffle, shuffle_instrumented};
