//! Reference code for the memory hierarchy: simulated memories, and algorithms of the literature to be measured in them.
//!
//! The command `taut memory simulate`, the benches and the pages in `docs/memory` run this code; nothing in taut computes an
//! answer with it, and its interface may change with every release. What taut stands on is in `taut-oblivious`.
//!
//! | you want | see | shown by tests |
//! |---|---|---|
//! | the misses of an algorithm in a memory of any size | [`simulate`] | counts equal those of brute force |
//! | the algorithms of the thesis as short as their papers have them | [`algorithms`] | misses within the bounds |
//! | how many sorted keys are smaller, by four layouts | [`search`] | blocks read by one search |
//! | an ordered map whose ranges are read like an array | [`packed`] | all densities within bounds |
//! | a priority queue, also larger than memory | [`PriorityQueue`], [`SpillingQueue`] | keys in order, memory within its limit |
//!
//! Prefer a well-kept crate for work: `faer` for products and factors of matrices, `rustfft` for Fourier transforms,
//! `std::collections::BinaryHeap` or `quickheap` for queues of keys.

pub mod algorithms;
pub mod packed;
mod queue;
pub mod search;
pub mod simulate;

pub use queue::{PriorityQueue, SpillingQueue};

use taut_oblivious::machine::{Level, Pages, Store, prefetch};
use taut_oblivious::{Access, Error, Key, NoProbe, Probe, Word, sort_records};
