//! Models of what the threads of taut-delaunay share: loom runs each in all orders that the memory model allows, with few
//! threads and few vertices. The code is that of the crate, file by file; only its atomic numbers are loom's. Run by
//! `scripts/models`.
#![cfg(loom)]
#![allow(dead_code, missing_docs)]

#[path = "../../crates/taut-delaunay/src/simplex.rs"]
mod simplex;

/// In the place of the memory that the crate has.
mod records {
    use crate::threads::atomics::AtomicU8;

    pub(crate) fn zeros(count: usize) -> Vec<AtomicU8> {
        (0..count).map(|_| AtomicU8::new(0)).collect()
    }
}

mod threads {
    pub(crate) mod atomics {
        pub(crate) use loom::hint::spin_loop;
        pub(crate) use loom::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, fence};
    }
    #[path = "../../../crates/taut-delaunay/src/threads/held.rs"]
    pub(crate) mod held;
    #[path = "../../../crates/taut-delaunay/src/threads/record.rs"]
    mod record;
    #[path = "../../../crates/taut-delaunay/src/threads/runs.rs"]
    mod runs;
    #[path = "../../../crates/taut-delaunay/src/threads/slots.rs"]
    pub(crate) mod slots;

    pub(crate) use record::{Mark, Record, Slot};

    #[cfg(test)]
    mod models;
}
