//! The manifest: what the folder holds, as lines of text.
//!
//! *Lines.* `key value`, in a fixed order; the last is `sum` with the sum of all bytes before it. The tree of cells depends
//! on `levels`, `leaf_points` and `merge_above` and on the points alone, so a resumed run takes these from here, whatever
//! memory it is allowed. `state` is `begun` or `complete`; what follows after `merge_above` is there when it is complete.

use std::fmt::Write;
use std::path::Path;

use taut_certify::Fingerprint;
use taut_points::PointsHash;

use super::folder::{failed, write_bytes};
use super::plan::DiskPlan;
use crate::Error;
use crate::outofcore::bytes::word_sum;
use crate::outofcore::driver::Totals;

/// The name of the file.
pub(super) const NAME: &str = "manifest.txt";

/// The first line.
const FORMAT: &str = "format taut-tiled-delaunay 1";

/// What identifies the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Begun {
    pub(super) dimension: u64,
    pub(super) points: u64,
    pub(super) row_bytes: u32,
    pub(super) levels: u32,
    pub(super) leaf_points: u64,
    pub(super) merge_above: u64,
}

impl Begun {
    /// The work that a plan begins.
    pub(super) fn new(dimension: usize, points: u64, plan: &DiskPlan) -> Self {
        let DiskPlan { row_bytes, levels, leaf_points, merge_above, .. } = *plan;
        Self { dimension: dimension as u64, points, row_bytes, levels, leaf_points, merge_above }
    }
}

/// What a complete folder holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Complete {
    pub(super) points_hash: PointsHash,
    pub(super) totals: Totals,
    /// Each tile with its bytes.
    pub(super) tiles: Vec<(u32, u64)>,
}

/// The manifest of a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Manifest {
    pub(super) begun: Begun,
    pub(super) complete: Option<Complete>,
}

impl Manifest {
    pub(super) fn write(&self, path: &Path) -> Result<(), Error> {
        write_bytes(path, self.to_text().as_bytes())
    }

    fn to_text(&self) -> String {
        let Begun { dimension, points, row_bytes, levels, leaf_points, merge_above } = self.begun;
        let state = if self.complete.is_some() { "complete" } else { "begun" };
        let mut text = format!(
            "{FORMAT}\nstate {state}\ndimension {dimension}\npoints {points}\nrow_bytes {row_bytes}\n\
             levels {levels}\nleaf_points {leaf_points}\nmerge_above {merge_above}\n"
        );
        if let Some(Complete { points_hash, totals, tiles }) = &self.complete {
            let Totals { sites, duplicates, simplices, hull, fingerprint, .. } = totals;
            let Totals { vertices_per_simplex, front_sites, merged_sites, root_sites, .. } = totals;
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "points_hash {points_hash}\nvertices_per_simplex {vertices_per_simplex}\n\
                 sites {sites}\nduplicates {duplicates}\nsimplices {simplices}\nhull {hull}\n\
                 fingerprint {fingerprint}\nfront_sites {front_sites}\n\
                 merged_sites {merged_sites}\nroot_sites {root_sites}\ntiles {}\n",
                tiles.len()
            );
            for (tile, bytes) in tiles {
                let _ = writeln!(text, "tile {tile} {bytes}");
            }
        }
        let sum = word_sum(text.as_bytes());
        let _ = writeln!(text, "sum {sum:016x}");
        text
    }

    /// The manifest in a file; `None` if there is no such file.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, Error> {
        match std::fs::read_to_string(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            read => {
                let text = read.map_err(failed(path))?;
                let damaged = || Error::DamagedFolder { path: path.display().to_string() };
                Self::parse(&text).map(Some).ok_or_else(damaged)
            }
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let (body, last) = text.strip_suffix('\n')?.rsplit_once('\n')?;
        let body = &text[..body.len() + 1];
        if last != format!("sum {:016x}", word_sum(body.as_bytes())) {
            return None;
        }
        let mut lines = body.lines();
        let mut value = |key: &str| lines.next()?.strip_prefix(key)?.strip_prefix(' ');
        if format!("format {}", value("format")?) != FORMAT {
            return None;
        }
        let is_complete = match value("state")? {
            "begun" => false,
            "complete" => true,
            _ => return None,
        };
        let begun = Begun {
            dimension: value("dimension")?.parse().ok()?,
            points: value("points")?.parse().ok()?,
            row_bytes: value("row_bytes")?.parse().ok()?,
            levels: value("levels")?.parse().ok()?,
            leaf_points: value("leaf_points")?.parse().ok()?,
            merge_above: value("merge_above")?.parse().ok()?,
        };
        if !is_complete {
            return Some(Self { begun, complete: None });
        }
        let points_hash = value("points_hash")?.parse().ok()?;
        let mut totals = Totals {
            vertices_per_simplex: value("vertices_per_simplex")?.parse().ok()?,
            sites: value("sites")?.parse().ok()?,
            duplicates: value("duplicates")?.parse().ok()?,
            simplices: value("simplices")?.parse().ok()?,
            hull: value("hull")?.parse().ok()?,
            fingerprint: value("fingerprint")?.parse::<Fingerprint>().ok()?,
            front_sites: value("front_sites")?.parse().ok()?,
            merged_sites: value("merged_sites")?.parse().ok()?,
            root_sites: value("root_sites")?.parse().ok()?,
            tiles: 0,
        };
        totals.tiles = value("tiles")?.parse().ok()?;
        let mut tile = || {
            let (tile, bytes) = value("tile")?.split_once(' ')?;
            Some((tile.parse().ok()?, bytes.parse().ok()?))
        };
        let tiles = (0..totals.tiles).map(|_| tile()).collect::<Option<_>>()?;
        Some(Self { begun, complete: Some(Complete { points_hash, totals, tiles }) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manifests_come_back_and_every_changed_byte_is_seen() {
        let plan = DiskPlan::new(1_000_000, 2, 256 << 20, 2).unwrap();
        let begun = Begun::new(2, 1_000_000, &plan);
        let totals = Totals { sites: 5, tiles: 2, ..Totals::default() };
        let tiles = vec![(0, 100), (7, 2000)];
        let complete = Complete { points_hash: PointsHash(77), totals, tiles };
        for manifest in
            [Manifest { begun, complete: None }, Manifest { begun, complete: Some(complete) }]
        {
            let text = manifest.to_text();
            assert_eq!(Manifest::parse(&text), Some(manifest));
            for at in 0..text.len() {
                let mut bytes = text.clone().into_bytes();
                bytes[at] ^= 1;
                let other = String::from_utf8(bytes).unwrap();
                assert_eq!(Manifest::parse(&other), None, "byte {at}");
            }
        }
        assert_eq!(Manifest::parse(""), None);
    }
}
