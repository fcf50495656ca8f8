//! Point sets as every other crate of taut sees them: borrowed views, streams of blocks, generators.
//!
//! | you have | you write | cost |
//! |---|---|---|
//! | numbers in memory | [`Points::new`] | nothing is copied |
//! | a decoded file | [`OwnedPoints::new`] | the values are taken, not copied |
//! | a raw file of any size | [`FileSource`] or [`MappedSource`] | one block per thread in memory |
//! | nothing yet | [`generate()`] | n·d draws; point i depends on the seed and i alone |
//!
//! ```
//! use taut_points::{Points, PointSource};
//!
//! let points = Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;   // n × d, row-major
//! assert_eq!((points.len(), points.dim()), (3, 2));
//! assert_eq!(points.row(1), [2.0, 0.0]);
//! # Ok::<(), taut_points::Error>(())
//! ```
//!
//! Everything that reads points in taut is written against [`PointSource`], in fixed [`Blocks`] whose results
//! are put together in block order ([`map_blocks`]), so that no answer depends on the number of threads.
//!
//! Not for: points of differing dimension, sparse points, or coordinates other than `f32` and `f64`.

mod allocator;
mod blocks;
mod choice;
mod display;
mod error;
pub mod generate;
mod hash;
mod helpers;
mod monitor;
mod ordered;
pub mod parallel;
mod parts;
mod points;
mod power_of_two;
mod processor;
mod room;
mod source;
#[cfg(test)]
mod test_length;
mod threads;

pub use allocator::keep_freed_memory;
pub use blocks::{Blocks, map_blocks};
pub use choice::Choice;
pub use display::shown_number;
pub use error::{Error, InputError, ReadError};
pub use generate::{Distribution, GeneratedSource, generate, generate_into};
pub use hash::{BlockHash, HashFormError, PointsHash, hash_block, hash_points};
pub use monitor::{Cancelled, Monitor};
pub use ordered::{OrderBy, bring_to_places};
pub use parts::{
    BlockRuns, ByteReader, ByteWriter, Elsewhere, PartsError, check_kernels, check_part,
};
pub use points::{Points, Rows, Scalar, ScalarKind};
pub use power_of_two::{exponent_of, times_two_to, two_to, two_to_in_steps};
pub use processor::{
    InstructionSet, KERNELS_VARIABLE, instruction_set, vectors, with_narrow_vectors,
};
pub use room::{failure_is_handled, try_reserve_exact};
pub use source::{
    FileSource, MappedSource, OwnedPoints, PickedColumns, PointSource, Scratch, gather, read_at,
    read_exact_at, write_all_at, write_at,
};
pub use threads::{THREADS_MAX, ThreadsError, check_threads, on_threads, thread_pool};
