//! Ordered sets and maps in one array with gaps: the packed-memory array.
//!
//! | you want | call | cost |
//! |---|---|---|
//! | the keys of a range | [`PackedSet::range`], [`PackedSet::runs`] | a search, then the speed of memory |
//! | many keys put in | [`PackedSet::insert_batch`] | a sweep |
//! | one key put in, or taken out | [`PackedSet::insert`], [`PackedSet::remove`] | O(log² n) moves on average |
//! | the same with values | [`PackedMap`] | |
//! | proof that all bounds hold | [`PackedSet::check`] | O(n) |
//!
//! Not for: values that are not `Copy`; keys without a place in memory of their own (strings).

mod batch;
mod check;
mod density;
mod map;
mod range;
mod separators;
mod set;
mod spread;
#[cfg(test)]
mod tests;

pub use check::{Density, Violation};
pub use map::PackedMap;
pub use range::{Iter, Runs};
pub use set::{KeyRuns, Keys, PackedSet};
