//! The subcommands: each is its options, its solver and its outputs.

pub(crate) mod ball;
pub(crate) mod centers;
pub(crate) mod classify;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod curve;
pub(crate) mod delaunay;
pub(crate) mod dop;
pub(crate) mod draw;
mod elbow;
pub(crate) mod ellipsoid;
pub(crate) mod formats;
pub(crate) mod generate;
pub(crate) mod hand;
pub(crate) mod info;
pub(crate) mod inscribe;
pub(crate) mod man;
pub(crate) mod memory;
pub(crate) mod near;
mod radii;
mod robust;
pub(crate) mod stream;
pub(crate) mod surface;
pub(crate) mod tour;
pub(crate) mod verify;
