//! The tests of `taut-delaunay` from outside, in one program: linking one for each file would take longer than running them.

mod any_bytes;
mod canonical;
mod golden;
mod query;
mod test_length;
mod wrong_ids;
