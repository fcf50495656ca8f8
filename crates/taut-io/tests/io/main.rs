//! Files in and out, as a user of the crate meets them.

#![allow(missing_docs)]

mod test_length;

mod bad_input;
mod columns;
mod corpus;
mod create;
mod damaged;
#[cfg(feature = "xz")]
mod data;
mod filter;
mod folders;
mod gaps;
mod geojson;
mod labels;
mod las;
mod mesh;
#[cfg(feature = "arrow")]
mod parquet;
mod parsers;
mod polylines;
mod round_trip;
mod shape;
mod svg;
mod text;
mod wkt;

use std::path::Path;

use taut_io::{Error, Input, ReadOptions, open, open_bytes};
use taut_points::{Monitor, PointsHash, gather, hash_points};

/// Reads text as a file of the given name.
fn text(name: &str, text: &str) -> Result<Input, Error> {
    text_with(name, text, &ReadOptions::default())
}

fn text_with(name: &str, text: &str, options: &ReadOptions) -> Result<Input, Error> {
    open_bytes(text.as_bytes().to_vec(), name, options)
}

/// All coordinates, row after row.
fn values(input: &Input) -> Vec<f64> {
    gather(&*input.source, &(0..input.source.len()).collect::<Vec<_>>()).unwrap()
}

fn hash(input: &Input) -> PointsHash {
    hash_points(&*input.source, &Monitor::silent()).unwrap()
}

/// The message of an error, which must not be missing.
fn message(read: Result<Input, Error>) -> String {
    read.expect_err("this should not have been read").to_string()
}

/// Returns true if this build has the compression that a name ends with.
fn unpacks(name: &str) -> bool {
    let needs = |extension: &str, built: bool| built || !name.ends_with(extension);
    needs(".xz", cfg!(feature = "xz")) && needs(".zst", cfg!(feature = "zstd"))
}

fn open_default(path: &Path) -> Result<Input, Error> {
    open(path, &ReadOptions::default())
}
