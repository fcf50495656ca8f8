//! Transposition of dense row-major matrices, in memory and of files.

pub(crate) mod transpose;
pub(crate) mod transpose_file;
