//! Dense matrices, row-major: transposition in memory and of files, multiplication, factors.

pub(crate) mod fft;
pub(crate) mod lu;
pub(crate) mod multiply;
pub(crate) mod transpose;
pub(crate) mod transpose_file;
pub(crate) mod view;
