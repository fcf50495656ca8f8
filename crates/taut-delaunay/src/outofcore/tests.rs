//! The tree merge against the triangulation in memory: equal simplices, neighbors, hulls, duplicates and fingerprints, with
//! nodes that are kept in memory as bytes.

mod buckets;
mod canonical;
mod checked;
mod contract;
mod folders;
mod properties;
pub(super) mod sets;
