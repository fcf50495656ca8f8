//! Algorithms for the memory hierarchy, which the rest of taut stands on.
//!
//! | you want | call | promise | cost |
//! |---|---|---|---|
//! | points in an order where neighbours in space are neighbours in memory | [`hilbert_order()`] | a function of the point set alone, equal points side by side | a few passes of O(n) |
//! | the same in Z-order | [`morton_order()`] | as above | as above, keys at half the cost |
//! | the place of one cell on the curve | [`hilbert_key()`], [`morton_key()`] | consecutive cells of the Hilbert curve share a face | O(bits) |
//! | numbers in order | [`sort()`] | the total order; NaN is no error | O(n log n), eight at a time |
//! | records in order of a number | [`sort_records()`] | stable | a few passes of O(n) |
//! | a file of records in order | [`external::sort_file`] | stable, within a limit on memory, with a certificate | each byte read twice and written twice |
//! | some of many, in order | [`sample()`], [`bernoulli()`], [`Sequential`] | all sets equally likely; a function of the seed | O(1) for each |
//! | some of a stream | [`Reservoir`] | all sets equally likely | O(1) an item |
//! | items in random order | [`shuffle()`] | all orders equally likely; a function of the seed | a few passes of O(n) |
//! | the k-th smallest number, the median | [`select()`], [`median()`] | the total order | O(n) |
//! | an array from its end to its beginning | [`reverse()`] | each line read and written once | O(n) |
//! | how many sorted keys are smaller | [`search`] | the same ranks from every layout | a line of memory a factor of 9 |
//! | an ordered set whose ranges are read like an array | [`packed`] | all densities within bounds | O(log² n) moves an insertion, few in a batch |
//! | the points nearest to a place | [`kdtree`] | the nearest by distances calculated to rounding, also of the largest and smallest coordinates; ties to the lowest row | O(log n), few lines of memory |
//! | a tree in an order for walks from its root | [`layout::permute`] | the same tree | O(n) |
//! | a priority queue, also larger than memory | [`PriorityQueue`], [`SpillingQueue`] | keys in order, no entry lost | expected O(log n) |
//! | linked lists in order | [`list_order()`] | every node once, closed lists too | O(n) |
//! | the transpose of a matrix, in memory or in a file | [`transpose()`], [`transpose_in_place()`], [`transpose_file()`] | a permutation of bytes; a file is whole or not there | O(mn), one pass |
//! | a product of matrices | [`multiply()`] | stated errors, the same bits on any processor | O(mnk) |
//! | LU factors | [`lu()`], [`lu_solve()`] | as above; a zero pivot is told | O(mn·min(m, n)) |
//! | a Fourier transform in two passes | [`fft()`] | relative error 10⁻¹⁵·log₂ n | O(n log n) |
//! | how often an algorithm misses in a memory of any size | [`simulate`] | exact, the same on every machine | some 10 ns a touch |
//! | the algorithms of the literature, to measure them | [`reference`](mod@reference) | as in the papers, short, not fast | |
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
//! Not for: points with coordinates that are not finite (validate first), or 2³² of them or more.

mod deal;
mod error;
mod hilbert;
pub mod kdtree;
mod key;
pub mod layout;
mod level;
mod list;
mod matrix;
mod morton;
mod order;
pub mod packed;
mod pages;
mod probe;
mod queue;
mod random;
pub mod reference;
mod sample;
pub mod search;
mod select;
pub mod simulate;
mod sort;
mod store;

pub use error::Error;
pub use hilbert::hilbert_key;
pub use key::{Key, Word};
pub use list::{Lists, NO_NODE, list_order, list_order_probed};
pub use matrix::fft::{Direction, fft, fft_probed};
pub use matrix::lu::{Lu, lu, lu_probed, lu_solve};
pub use matrix::multiply::{MultiplyOptions, multiply, multiply_probed};
pub use matrix::transpose::in_place::{transpose_in_place, transpose_in_place_probed};
pub use matrix::transpose::{transpose, transpose_probed};
pub use matrix::transpose_file::check::{FileCheck, check_transposed_file};
pub use matrix::transpose_file::{
    FileMatrix, FileTransposition, TransposeFileOptions, transpose_file, transpose_file_pending,
};
pub use matrix::view::{MatrixView, MatrixViewMut};
pub use morton::morton_key;
pub use num_complex::Complex64;
pub use order::{hilbert_order, morton_order};
pub use probe::{Access, NoProbe, Probe};
pub use queue::{PriorityQueue, SpillingQueue};
pub use sample::{Reservoir, Sequential, bernoulli, sample, shuffle, shuffle_probed};
pub use select::{median, reverse, reverse_probed, select};
pub use sort::{external, sort, sort_probed, sort_records, sort_records_probed};
pub use store::Pending;
