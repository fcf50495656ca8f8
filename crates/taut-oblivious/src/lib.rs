//! Algorithms for the memory hierarchy.
#![forbid(unsafe_code)]
