//! The outputs of a subcommand: files that appear whole, pictures, numbers as people read them.

pub(crate) mod files;
pub(crate) mod meshes;
pub(crate) mod parts;
pub(crate) mod picture;
pub(crate) mod writing;

pub(crate) use taut_report::numbers;
