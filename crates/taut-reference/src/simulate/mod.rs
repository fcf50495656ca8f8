//! Simulated memories: how often an algorithm misses in a cache of any size, counted exactly.
//!
//! *Problem.* The cost of an algorithm in a memory hierarchy is the number of blocks of B bytes that move between a
//! memory of M bytes and the next one. Bounds are stated for it; counters of a processor cannot check them, as they know
//! only that processor's M and B, and few virtual machines show them at all.
//! *Idea.* A simulated memory is a [`Probe`](crate::Probe). Hand it to any algorithm of this crate and read off the
//! misses: of several caches at once ([`Simulator`]), of all memory sizes in one pass ([`StackDistances`]), or of the
//! best possible replacement, for which the future must be known ([`Trace`]).
//! *Guarantee.* Counts are exact and the same on every machine: announced arrays are put into a simulated address space
//! in the order of their announcement, so nothing depends on the allocator.
//! *Trap.* An access outside all announced arrays cannot be placed that way. It is simulated all the same, in pages of its
//! own, and counted: `unannounced` is 0 for a correct algorithm.
//! *Reference.* Frigo, Leiserson, Prokop, Ramachandran, *Cache-oblivious algorithms*, ACM TALG 8(1), 2012 (the model);
//! Mattson, Gecsei, Slutz, Traiger, IBM Systems Journal 9(2), 1970 (stack distances); Belady, ibidem 5(2), 1966.
//!
//! ```
//! use taut_reference::simulate::{CacheShape, Simulator};
//! use taut_oblivious::Probe;
//!
//! let numbers = vec![1u64; 1000];
//! let mut simulator = Simulator::new(&[CacheShape::lru(4096, 64), CacheShape::DTLB])?;
//! simulator.place(&numbers);
//! for i in 0..numbers.len() {
//!     simulator.read(&numbers[i..=i]);
//! }
//! assert_eq!(simulator.counts(0).misses, 125);   // 8000 bytes in blocks of 64
//! assert_eq!(simulator.counts(1).misses, 2);     // and in pages of 4096
//! # Ok::<(), taut_oblivious::Error>(())
//! ```

mod cache;
mod optimal;
mod shape;
mod simulator;
mod space;
mod stack;
mod table;
mod trace;

pub use cache::Counts;
pub use shape::{CacheShape, Replacement};
pub use simulator::Simulator;
pub use stack::StackDistances;
pub use trace::{CurvePoint, RecordedAccess, Trace};
