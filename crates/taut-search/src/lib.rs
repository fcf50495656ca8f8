//! Queries of points and of balls by a tree of boxes and balls.
//!
//! | you want | call | promise | cost, n points in ℝᵈ |
//! |---|---|---|---|
//! | nearest, within a radius, along a ray, farthest, pairs, diameter | [`SphereSearch`] | as by a search through all rows | O(n log n) to build, about O(log n) a query in few dimensions |
//!
//! Points are those in memory or any [`PointSource`](taut_points::PointSource), which is read into memory; each query takes one struct
//! of options, where a [`Monitor`](taut_points::Monitor) can watch the work and stop it.
//!
//! ```
//! use taut_search::{QueryOptions, SphereSearch, SphereSearchOptions};
//!
//! let towns = taut_points::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 5.0], 2)?;    // n × d, row-major
//! let search = SphereSearch::new(&towns, &SphereSearchOptions::default())?;
//! let widest = search.diameter(0.0, &QueryOptions::default())?;
//! assert_eq!(widest.rows, [0, 2]);                                               // of equal distances the lowest rows
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Not for: distances other than Euclidean.
#![forbid(unsafe_code)]

// What this crate shows is not generic, so that all loops are compiled with its options, and not with those of the crate that calls them.

mod error;
mod sphere_search;

pub use error::Error;
pub use sphere_search::{
    Diameter, Neighbor, QueryOptions, RowPair, SphereSearch, SphereSearchOptions,
};
