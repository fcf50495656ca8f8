//! Reference code for the memory hierarchy: its answers, its misses and what its instrumentation costs.

mod algorithms;
mod any_bytes;
mod factors;
mod io_bounds;
mod no_probe;
mod simulate;
mod threads;
