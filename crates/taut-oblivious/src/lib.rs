//! The algorithms for the memory hierarchy that the solvers and the command of taut stand on.
//!
//! | you want | call | promise | cost |
//! |---|---|---|---|
//! | points in an order where neighbors in space are neighbors in memory | [`hilbert_order()`] | a function of the point set alone, equal points side by side | a few passes of O(n) |
//! | the same in Z-order | [`morton_order()`] | as above | as above, keys at half the cost |
//! | the place of one cell on the curve | [`hilbert_key()`], [`morton_key()`] | consecutive cells of the Hilbert curve share a face | O(bits) |
//! | numbers in order | [`sort()`] | the total order; NaN is no error | O(n log n), eight at a time |
//! | records in order of a number | [`sort_records()`] | stable | a few passes of O(n) |
//! | a file of records in order | [`external::sort_file`] | stable, within a limit on memory, with a certificate | each byte read twice and written twice |
//! | the transpose of a matrix, in memory or in a file | [`transpose()`], [`transpose_in_place()`], [`transpose_file()`] | a permutation of bytes; a file is whole or not there | O(mn), one pass |
//! | some of many, in order | [`sample()`], [`bernoulli()`], [`Sequential`] | all sets equally likely; a function of the seed | O(1) for each |
//! | some of a stream | [`Reservoir`] | all sets equally likely | O(1) an item |
//! | items in random order | [`shuffle()`] | all orders equally likely; a function of the seed | a few passes of O(n) |
//! | the points nearest to a place | [`kdtree`] | the nearest by distances calculated to rounding, also of the largest and smallest coordinates; ties to the lowest row | O(log n), few lines of memory |
//! | a tree in an order for walks from its root | [`layout::permute`] | the same tree | O(n) |
//!
//! ```
//! let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! let order = taut_oblivious::hilbert_order(square.len(), |i| square[i]);
//! for side in order.windows(2) {
//!     let (a, b) = (square[side[0] as usize], square[side[1] as usize]);
//!     assert_eq!((a[0] - b[0]).abs() + (a[1] - b[1]).abs(), 1.0);   // never across the diagonal
//! }
//! ```
//!
//! The algorithms of the thesis that nothing in taut calls, and the simulated memories that count their misses, are reference
//! code in the crate `taut-reference`, which imports this one.
//!
//! Not for: points with coordinates that are not finite (validate first), or 2³² of them or more.

mod deal;
mod error;
mod hilbert;
pub mod kdtree;
mod key;
pub mod layout;
mod level;
mod matrix;
mod morton;
mod order;
mod pages;
mod probe;
mod random;
mod sample;
mod sort;
mod store;
#[cfg(test)]
mod test_length;

/// Queries of the machine by kernels, for algorithms in other crates: instruction sets, large pages, prefetches, and bytes of
/// files by position. It serves the crates of taut and is not stable: any release may change it.
pub mod machine {
    pub use crate::level::{Avx2, Avx512, Level, prefetch};
    pub use crate::pages::Pages;
    pub use crate::store::Store;
}

pub use error::Error;
pub use hilbert::hilbert_key;
pub use key::{Key, Word};
pub use matrix::transpose::in_place::{transpose_in_place, transpose_in_place_instrumented};
pub use matrix::transpose::{transpose, transpose_instrumented};
pub use matrix::transpose_file::check::check_transposed_samples;
pub use matrix::transpose_file::{
    FileMatrix, FileTransposition, TransposeFileOptions, transpose_file, transpose_file_pending,
};
pub use morton::morton_key;
pub use order::{hilbert_order, morton_order};
pub use probe::{Access, NoProbe, Probe};
pub use sample::{Reservoir, Sequential, bernoulli, sample, shuffle, shuffle_instrumented};
pub use sort::{external, sort, sort_instrumented, sort_records, sort_records_instrumented};
pub use store::Pending;
