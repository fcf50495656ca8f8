//! The tree merge against the triangulation in memory: equal simplices, neighbors, hulls, duplicates and fingerprints, with
//! nodes that are kept in memory as bytes.

mod buckets;
mod canonical;
mod checked;
mod contract;
mod folders;
mod lookups;
mod mosaics;
mod properties;
pub(super) mod sets;

use std::path::Path;

/// Writes a folder with many small tiles.
pub(crate) fn write_folder<const D: usize>(points: &[[f64; D]], levels: u32, folder: &Path)
where
    super::Dim<D>: super::Dimension<D>,
{
    let cut = buckets::Cut { levels, merge_above: 60, threads: 2, stride: 1 };
    folders::Forgery::new(points, buckets::tiles(points, cut).0).write(folder);
}

/// Sets of points of the plane that are hard, with their names.
pub(crate) fn plane_sets() -> Vec<(&'static str, Vec<[f64; 2]>)> {
    sets::plane()
}
