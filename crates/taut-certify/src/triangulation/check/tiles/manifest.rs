//! The manifest of a folder of tiles, read from its definition in docs/delaunay.md.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use taut_points::PointsHash;

use super::super::super::Fingerprint;
use super::sum::Sum;
use super::{TilesError, TilesViolation};

/// The name of the file.
const NAME: &str = "manifest.txt";

/// A manifest has at most this many bytes; of those that are written a line of a tile has 30.
const BYTES_MAX: u64 = 1 << 30;

/// What the manifest says, as far as it is checked.
#[derive(Debug, PartialEq)]
pub(super) struct Manifest {
    pub(super) dimension: u32,
    pub(super) points: u64,
    pub(super) row_bytes: u32,
    pub(super) points_hash: PointsHash,
    pub(super) vertices: u32,
    pub(super) sites: u64,
    pub(super) duplicates: u64,
    pub(super) simplices: u64,
    pub(super) hull: u64,
    pub(super) fingerprint: Fingerprint,
    /// The tiles, ascending, each with the bytes of its file.
    pub(super) tiles: Vec<(u32, u64)>,
}

impl Manifest {
    pub(super) fn read(folder: &Path) -> Result<Self, TilesError> {
        let wrong = |problem: &str| TilesViolation::Manifest { problem: problem.to_owned() };
        let path = folder.join(NAME);
        let failed = |source| TilesError::File { path: path.clone(), source };
        let length = match fs::metadata(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound && folder.is_dir() => {
                return Err(TilesError::NoManifest { folder: folder.to_owned() });
            }
            found => found.map_err(failed)?.len(),
        };
        if length > BYTES_MAX {
            return Err(wrong("is longer than any manifest").into());
        }
        let bytes = fs::read(&path).map_err(failed)?;
        let text = String::from_utf8(bytes).map_err(|_| wrong("is no text"))?;
        Self::parse(&text).map_err(|problem| TilesViolation::Manifest { problem }.into())
    }

    fn parse(text: &str) -> Result<Self, String> {
        let end = text.strip_suffix('\n').and_then(|text| text.rfind('\n')).map(|end| end + 1);
        let end = end.ok_or("ends too early")?;
        let mut sum = Sum::default();
        sum.add(&text.as_bytes()[..end]);
        if text[end..] != format!("sum {:016x}\n", sum.finish()) {
            return Err("is damaged: its sum is wrong".into());
        }
        let mut lines = Lines { rest: text[..end].lines(), number: 0 };
        lines.expect("format", "taut-tiled-delaunay 1")?;
        if lines.value("state")? == "begun" {
            return Err("says that the triangulation is not complete: resume it".into());
        }
        let dimension = lines.number("dimension")?;
        let points = lines.number("points")?;
        let row_bytes = lines.number("row_bytes")?;
        for key in ["levels", "leaf_points", "merge_above"] {
            lines.number::<u64>(key)?;
        }
        let manifest = Manifest {
            dimension,
            points,
            row_bytes,
            points_hash: lines.number("points_hash")?,
            vertices: lines.number("vertices_per_simplex")?,
            sites: lines.number("sites")?,
            duplicates: lines.number("duplicates")?,
            simplices: lines.number("simplices")?,
            hull: lines.number("hull")?,
            fingerprint: lines.number("fingerprint")?,
            tiles: {
                for key in ["front_sites", "merged_sites", "root_sites"] {
                    lines.number::<u64>(key)?;
                }
                lines.tiles()?
            },
        };
        match lines.rest.next() {
            Some(_) => Err(format!("has a line {} that is not expected", lines.number + 1)),
            None if ![4, 8].contains(&manifest.row_bytes) => {
                Err("says that rows have neither 4 nor 8 bytes".into())
            }
            None => Ok(manifest),
        }
    }
}

struct Lines<'a> {
    rest: std::str::Lines<'a>,
    number: usize,
}

impl<'a> Lines<'a> {
    fn value(&mut self, key: &str) -> Result<&'a str, String> {
        self.number += 1;
        let line = self.rest.next().and_then(|line| line.strip_prefix(key)?.strip_prefix(' '));
        line.ok_or_else(|| format!("has no `{key}` in line {}", self.number))
    }

    fn expect(&mut self, key: &str, expected: &str) -> Result<(), String> {
        match self.value(key)? {
            value if value == expected => Ok(()),
            value => Err(format!("has {key} {value}: expected {expected}")),
        }
    }

    fn number<T: std::str::FromStr>(&mut self, key: &str) -> Result<T, String> {
        let value = self.value(key)?;
        value.parse().map_err(|_| format!("has {key} {value} in line {}", self.number))
    }

    fn tiles(&mut self) -> Result<Vec<(u32, u64)>, String> {
        let count: u64 = self.number("tiles")?;
        let mut tiles: Vec<(u32, u64)> = vec![];
        for _ in 0..count {
            let line = self.value("tile")?;
            let parsed = line
                .split_once(' ')
                .and_then(|(tile, bytes)| Some((tile.parse().ok()?, bytes.parse().ok()?)));
            let tile = parsed.ok_or_else(|| format!("has no tile in line {}", self.number))?;
            if tiles.last().is_some_and(|before| before.0 >= tile.0) {
                return Err(format!("lists tiles that do not ascend in line {}", self.number));
            }
            tiles.push(tile);
        }
        Ok(tiles)
    }
}
