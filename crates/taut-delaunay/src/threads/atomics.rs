//! The atomic numbers that threads share, so that the models of `models/` can put theirs in the place.

pub(crate) use std::hint::spin_loop;
pub(crate) use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, fence};
