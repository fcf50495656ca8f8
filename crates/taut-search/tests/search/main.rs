//! The tests of `taut-search` from outside, in one program.

mod queries;
mod sizes;
