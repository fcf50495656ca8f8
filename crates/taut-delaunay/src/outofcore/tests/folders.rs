//! Folders of tiles that a forger made: any tiles, all sums, counts, neighbors and links as they should be.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;

use taut_certify::{Fingerprint, SiteHash};
use taut_points::{Monitor, Points, hash_points};

use super::super::bytes::word_sum;
use super::super::front::Link;
use super::super::{NO_NEIGHBOR, OTHER_TILE, Tile, TileLink, tile_name};
use crate::simplex::code;

/// A facet of a tile: place of the tile, simplex, facet.
type Place = (usize, usize, usize);

/// Points and tiles that are said to triangulate them.
#[derive(Clone)]
pub(super) struct Forgery<const D: usize> {
    pub(super) points: Vec<[f64; D]>,
    pub(super) tiles: Vec<Tile<D>>,
    /// Lines of the manifest that are to say something else.
    pub(super) lines: BTreeMap<&'static str, String>,
}

/// The fingerprint of the simplices of a tile.
fn fingerprint<const D: usize>(tile: &Tile<D>) -> Fingerprint {
    let mut sum = Fingerprint::default();
    let hash = |v: u32| SiteHash::of(&tile.coordinates[v as usize]);
    for simplex in tile.simplex_rows() {
        match *simplex {
            [a] => sum.add([a].map(hash)),
            [a, b] => sum.add([a, b].map(hash)),
            [a, b, c] => sum.add([a, b, c].map(hash)),
            [a, b, c, d] => sum.add([a, b, c, d].map(hash)),
            _ => {}
        }
    }
    sum
}

impl<const D: usize> Forgery<D> {
    pub(super) fn new(points: &[[f64; D]], tiles: Vec<Tile<D>>) -> Self {
        Self { points: points.to_vec(), tiles, lines: BTreeMap::new() }
    }

    /// The vertices of a simplex as rows.
    fn rows(tile: &Tile<D>, simplex: usize) -> Vec<u64> {
        let vertices = tile.simplex_rows().nth(simplex).unwrap();
        vertices.iter().map(|&v| tile.rows[v as usize]).collect()
    }

    /// Gives all tiles the neighbors, links and counts that their simplices have.
    pub(super) fn rebuild(&mut self) {
        let mut facets: HashMap<Vec<u64>, Vec<Place>> = HashMap::new();
        for (place, tile) in self.tiles.iter().enumerate() {
            for simplex in 0..tile.simplex_rows().count() {
                let rows = Self::rows(tile, simplex);
                for facet in 0..rows.len() {
                    let mut key = rows.clone();
                    key.remove(facet);
                    key.sort_unstable();
                    facets.entry(key).or_default().push((place, simplex, facet));
                }
            }
        }
        for tile in &mut self.tiles {
            tile.neighbors = vec![NO_NEIGHBOR; tile.simplices.len()];
            tile.links.clear();
        }
        let number = |(place, simplex, facet): Place, tiles: &[Tile<D>]| {
            let link = Link { tile: tiles[place].counts.tile, code: 0 };
            Link { code: code(simplex as u32, facet as u32), ..link }
        };
        for sides in facets.values() {
            let [a, b, ..] = sides[..] else { continue };
            for (side, other) in [(a, b), (b, a)] {
                let tile = &mut self.tiles[side.0];
                let width = tile.counts.vertices_per_simplex as usize;
                let is_same = side.0 == other.0;
                tile.neighbors[side.1 * width + side.2] =
                    if is_same { other.1 as u32 } else { OTHER_TILE };
            }
            if a.0 != b.0 {
                let (early, late) = (a.min(b), a.max(b));
                let link = number(early, &self.tiles);
                let here = number(late, &self.tiles).code;
                self.tiles[late.0].links.push(TileLink { code: here, link });
            }
        }
        self.tiles.iter_mut().for_each(|tile| tile.links.sort_unstable_by_key(|link| link.code));
        self.count();
    }

    /// Gives all tiles the counts that their lists have.
    pub(super) fn count(&mut self) {
        for tile in &mut self.tiles {
            let width = tile.counts.vertices_per_simplex.max(1) as usize;
            tile.counts.sites = tile.rows.len() as u64;
            tile.counts.copies = tile.copies.len() as u64;
            tile.counts.duplicates = tile.duplicates.len() as u64;
            tile.counts.simplices = (tile.simplices.len() / width) as u64;
            tile.counts.links = tile.links.len() as u64;
            let outside = tile.links.iter().filter(|link| link.code == Link::OUTSIDE).count();
            let is_open = |&&n: &&u32| n == NO_NEIGHBOR && width > 1;
            let hull = tile.neighbors.iter().filter(is_open).count();
            tile.counts.hull = (hull + outside) as u64;
            tile.counts.fingerprint = fingerprint(tile);
        }
    }

    fn tile_bytes(tile: &Tile<D>) -> Vec<u8> {
        let counts = &tile.counts;
        let mut bytes = b"TAUTTILE".to_vec();
        let words = |bytes: &mut Vec<u8>, words: &[u32]| {
            words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
        };
        words(&mut bytes, &[1, D as u32]);
        tile.coordinates.as_flattened().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        let width = counts.row_bytes as usize;
        for row in tile.rows.iter().chain(tile.duplicates.as_flattened()) {
            bytes.extend(&row.to_le_bytes()[..width]);
        }
        let vertices = counts.vertices_per_simplex.max(1) as usize;
        let rows = tile.simplices.chunks(vertices).zip(tile.neighbors.chunks(vertices));
        for (simplex, neighbors) in rows {
            words(&mut bytes, simplex);
            words(&mut bytes, neighbors);
        }
        words(&mut bytes, &tile.copies);
        for TileLink { code, link } in &tile.links {
            words(&mut bytes, &[*code, link.tile, link.code]);
        }
        bytes.extend(b"TAUTTILE");
        let head = [1, D as u32, counts.vertices_per_simplex, counts.row_bytes, counts.tile, 0];
        words(&mut bytes, &head);
        let lists = [counts.copies, counts.sites, counts.duplicates, counts.simplices];
        for count in lists.into_iter().chain([counts.links, counts.hull]) {
            bytes.extend(count.to_le_bytes());
        }
        bytes.extend(counts.fingerprint.0.to_le_bytes());
        bytes.extend(word_sum(&bytes).to_le_bytes());
        bytes
    }

    /// Writes the folder, with a manifest for the points and the tiles.
    pub(super) fn write(&self, folder: &Path) {
        let mut sizes = vec![];
        for tile in &self.tiles {
            let bytes = Self::tile_bytes(tile);
            fs::write(folder.join(tile_name(tile.counts.tile)), &bytes).unwrap();
            sizes.push((tile.counts.tile, bytes.len()));
        }
        sizes.sort_unstable();
        let points = Points::new(self.points.as_flattened(), D).unwrap();
        let sum = |of: fn(&Tile<D>) -> u64| self.tiles.iter().map(of).sum::<u64>().to_string();
        let mut fingerprint = Fingerprint::default();
        self.tiles.iter().for_each(|tile| fingerprint.merge(tile.counts.fingerprint));
        let vertices = self.tiles.iter().map(|tile| tile.counts.vertices_per_simplex).max();
        let row_bytes = self.tiles.first().map_or(4, |tile| tile.counts.row_bytes);
        let lines = [
            ("format", "taut-tiled-delaunay 1".to_owned()),
            ("state", "complete".to_owned()),
            ("dimension", D.to_string()),
            ("points", self.points.len().to_string()),
            ("row_bytes", row_bytes.to_string()),
            ("levels", "3".to_owned()),
            ("leaf_points", "9".to_owned()),
            ("merge_above", "1".to_owned()),
            ("points_hash", hash_points(&points, &Monitor::silent()).unwrap().to_string()),
            ("vertices_per_simplex", vertices.unwrap_or(0).to_string()),
            ("sites", sum(|tile| tile.counts.owned())),
            ("duplicates", sum(|tile| tile.counts.duplicates)),
            ("simplices", sum(|tile| tile.counts.simplices)),
            ("hull", sum(|tile| tile.counts.hull)),
            ("fingerprint", fingerprint.to_string()),
            ("front_sites", "0".to_owned()),
            ("merged_sites", "0".to_owned()),
            ("root_sites", "0".to_owned()),
            ("tiles", sizes.len().to_string()),
        ];
        let mut text = String::new();
        for (key, value) in &lines {
            let value = self.lines.get(key).unwrap_or(value);
            text += &format!("{key} {value}\n");
        }
        for (tile, bytes) in sizes {
            text += &format!("tile {tile} {bytes}\n");
        }
        text += &format!("sum {:016x}\n", word_sum(text.as_bytes()));
        fs::write(folder.join("manifest.txt"), text).unwrap();
    }
}
