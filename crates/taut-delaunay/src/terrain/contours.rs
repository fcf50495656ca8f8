//! Lines of equal height on the surface that is linear in each triangle.
//!
//! *Idea.* A vertex at the level itself counts as above it. So a level passes through the interior of edges only, between a
//! vertex above and one below; a triangle holds one segment of a line or none, and lines neither branch nor end within
//! the hull. A plateau at the level has the line around it, a flat triangle none.
//! *Idea.* Lines have higher ground to their left. Each segment enters its triangle across an edge from above to below, as the
//! triangle turns, and leaves across the other.
//! *Guarantee.* A line is closed or goes from the hull to the hull. Its places are a function of edges and level alone, and a
//! closed line begins at the edge with the smallest rows: the lines are the same, bit by bit, for every tiling. Places that
//! follow one another are different; a line of one place (the top of a mountain at the level) is left out.
//! *Trap.* Where a vertex is at the level, lines touch there, or run to it and back along an edge that is at the level.
//! *Cost.* O(triangles + segments) a tile; 4 bytes a triangle and a bit a segment, of which there are at most
//! four million at a time; for each place where a line goes to another tile about 100 bytes, and its part of the line
//! in a file without name.

use std::path::PathBuf;

use taut_points::{InputError, Monitor};
use taut_predicates::plane;

use super::Terrain;
use super::chains::{Chains, Piece};
use crate::Error;
use crate::outofcore::{NO_NEIGHBOR, OTHER_TILE, Tile};

/// Segments whose levels are done together; a single level may have more.
const SEGMENTS_MAX: u64 = 1 << 22;

/// Most levels.
const LEVELS_MAX: usize = 1_000_000;

/// Heights of lines, ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels(Vec<f64>);

impl Levels {
    /// These levels, in any order; equal ones count once.
    ///
    /// # Errors
    /// [`Error::Input`] if one is not finite, or there are more than a million.
    pub fn of(mut levels: Vec<f64>) -> Result<Self, Error> {
        if let Some(wrong) = levels.iter().find(|level| !level.is_finite()) {
            let value = wrong.to_string();
            return Err(
                InputError::Option { name: "levels", value, expected: "finite heights" }.into()
            );
        }
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        match levels.len() {
            count if count > LEVELS_MAX => Err(InputError::Option {
                name: "levels",
                value: format!("{count} levels"),
                expected: "at most 1000000",
            }
            .into()),
            _ => Ok(Self(levels)),
        }
    }

    /// The multiples of `interval` above `low`, up to `high`.
    ///
    /// # Errors
    /// [`Error::Input`] if `interval` is not positive and finite, or if there are more than a million multiples.
    pub fn every(interval: f64, [low, high]: [f64; 2]) -> Result<Self, Error> {
        let refused = |expected| {
            let value = interval.to_string();
            Err(InputError::Option { name: "interval", value, expected }.into())
        };
        if !(interval > 0.0 && interval.is_finite()) {
            return refused("a height of more than 0");
        }
        let (first, last) = ((low / interval).floor(), (high / interval).floor());
        if last - first > LEVELS_MAX as f64 || last.abs().max(first.abs()) > (1u64 << 50) as f64 {
            return refused("more: at most a million levels, and none of more than 2^50 intervals");
        }
        let levels = (first as i64..=last as i64).map(|k| k as f64 * interval);
        Ok(Self(levels.filter(|&level| level > low && level <= high).collect()))
    }

    /// The levels, ascending.
    pub fn heights(&self) -> &[f64] {
        &self.0
    }
}

/// Options for contour lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContourOptions<'a> {
    /// The folder for the parts of lines that go from tile to tile, in a file without name; that of the system by default.
    pub scratch: Option<PathBuf>,
    /// Watches the work, triangle by triangle, and can stop it.
    pub monitor: Monitor<'a>,
}

/// What comes of a line, place by place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stroke {
    /// A line begins, at this height.
    Begin(f64),
    /// It goes on to this place.
    To([f64; 2]),
    /// It ends; where the last place is the first one it is closed.
    End,
}

/// The lines of equal height, one after the other. Their number is returned.
///
/// # Errors
/// Those of `draw`, of reading, of the scratch file, and of the monitor; [`Error::Input`] for a height that is not finite.
pub fn contours(
    terrain: Terrain<'_>,
    levels: &Levels,
    options: &ContourOptions<'_>,
    draw: &mut dyn FnMut(Stroke) -> Result<(), Error>,
) -> Result<u64, Error> {
    options.monitor.pass(1, terrain.mosaic.simplices());
    let mut chains = Chains::new(&levels.0, options.scratch.clone(), draw);
    for &number in terrain.mosaic.tiles() {
        options.monitor.check()?;
        let tile = terrain.mosaic.tile(number)?;
        if tile.counts.vertices_per_simplex == 3 {
            let heights = terrain.heights.of(&tile.rows)?;
            TileLines { tile: &tile, heights: &heights, levels: &levels.0 }
                .trace(&mut chains, &options.monitor)?;
        }
        options.monitor.points(tile.counts.simplices);
    }
    chains.finish()
}

/// The lines of one tile.
struct TileLines<'a> {
    tile: &'a Tile<2>,
    heights: &'a [f64],
    levels: &'a [f64],
}

/// For each segment whether it is done, by triangles and their levels.
struct Done {
    /// The first segment of each triangle.
    starts: Vec<u32>,
    bits: Vec<u64>,
}

impl Done {
    /// Marks a segment; whether it was not before.
    fn mark(&mut self, segment: usize) -> bool {
        let (word, bit) = (&mut self.bits[segment / 64], 1u64 << (segment % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }
}

/// A place where a line crosses an edge, and the rows of that edge, the smaller first.
#[derive(Clone, Copy)]
struct Crossing {
    at: [f64; 2],
    edge: [u64; 2],
}

impl TileLines<'_> {
    fn sites(&self, triangle: usize) -> [u32; 3] {
        std::array::from_fn(|i| self.tile.simplices[3 * triangle + i])
    }

    /// The levels that cross a triangle, by their numbers.
    fn crossed(&self, triangle: usize) -> std::ops::Range<usize> {
        let z = self.sites(triangle).map(|v| self.heights[v as usize]);
        let (low, high) = (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]));
        self.levels.partition_point(|&level| level <= low)
            ..self.levels.partition_point(|&level| level <= high)
    }

    fn trace(&self, chains: &mut Chains<'_>, monitor: &Monitor<'_>) -> Result<(), Error> {
        let triangles = self.tile.counts.simplices as usize;
        // How many segments have a level of at most each number.
        let mut counts = vec![0i64; self.levels.len() + 1];
        for t in 0..triangles {
            let crossed = self.crossed(t);
            counts[crossed.start] += 1;
            counts[crossed.end] -= 1;
        }
        let mut begin = 0;
        let mut running = 0i64;
        let mut of_level = counts[..self.levels.len()].iter().map(|&change| {
            running += change;
            running as u64
        });
        while begin < self.levels.len() {
            monitor.check()?;
            let (mut end, mut segments) = (begin, 0);
            for count in of_level.by_ref() {
                segments += count;
                end += 1;
                if segments >= SEGMENTS_MAX {
                    break;
                }
            }
            if segments > 0 {
                self.trace_levels(begin..end, segments, chains)?;
            }
            begin = end;
        }
        Ok(())
    }

    /// The lines of some levels, which have so many segments.
    fn trace_levels(
        &self,
        levels: std::ops::Range<usize>,
        segments: u64,
        chains: &mut Chains<'_>,
    ) -> Result<(), Error> {
        let triangles = self.tile.counts.simplices as usize;
        let within = |t: usize| {
            let crossed = self.crossed(t);
            crossed.start.clamp(levels.start, levels.end)
                ..crossed.end.clamp(levels.start, levels.end)
        };
        let mut next = 0u32;
        let starts = (0..triangles).map(|t| {
            let first = next;
            next += within(t).len() as u32;
            first
        });
        let starts = starts.collect();
        let mut done = Done { starts, bits: vec![0; (segments as usize).div_ceil(64)] };
        // First the lines that come into the tile from outside, then those that are closed in it.
        for only_open in [true, false] {
            for t in 0..triangles {
                for level in within(t) {
                    let segment = done.starts[t] as usize + level - within(t).start;
                    let is_done = done.bits[segment / 64] >> (segment % 64) & 1 == 1;
                    if is_done || (only_open && !self.is_end(self.entry(t, level), t)) {
                        continue;
                    }
                    let piece = self.piece(t, level, &within, &mut done);
                    chains.add(level as u32, &piece)?;
                }
            }
        }
        Ok(())
    }

    fn is_above(&self, site: u32, level: usize) -> bool {
        self.heights[site as usize] >= self.levels[level]
    }

    /// The facet across which a line comes in: as the triangle turns, from above to below.
    fn entry(&self, triangle: usize, level: usize) -> usize {
        let above = self.sites(triangle).map(|v| self.is_above(v, level));
        (0..3).find(|&i| above[(i + 1) % 3] && !above[(i + 2) % 3]).unwrap_or(0)
    }

    /// The facet across which it goes out.
    fn exit(&self, triangle: usize, level: usize) -> usize {
        let above = self.sites(triangle).map(|v| self.is_above(v, level));
        (0..3).find(|&i| !above[(i + 1) % 3] && above[(i + 2) % 3]).unwrap_or(0)
    }

    fn is_end(&self, facet: usize, triangle: usize) -> bool {
        [NO_NEIGHBOR, OTHER_TILE].contains(&self.tile.neighbors[3 * triangle + facet])
    }

    /// A line from a triangle on, to where it leaves the tile, or once around.
    fn piece(
        &self,
        from: usize,
        level: usize,
        within: &impl Fn(usize) -> std::ops::Range<usize>,
        done: &mut Done,
    ) -> Piece {
        let entry = self.entry(from, level);
        let mut line = vec![self.crossing(from, entry, level)];
        let mut t = from;
        let mut to = None;
        while done.mark(done.starts[t] as usize + level - within(t).start) {
            let exit = self.exit(t, level);
            let crossing = self.crossing(t, exit, level);
            line.push(crossing);
            match self.tile.neighbors[3 * t + exit] {
                NO_NEIGHBOR => break,
                OTHER_TILE => {
                    to = Some(crossing.edge);
                    break;
                }
                next => t = next as usize,
            }
        }
        let begins = self.tile.neighbors[3 * from + entry];
        let least = (0..line.len()).min_by_key(|&i| line[i].edge).unwrap_or(0);
        Piece {
            is_closed: !self.is_end(entry, from),
            from: (begins == OTHER_TILE).then_some(line[0].edge),
            to,
            least: (line[least].edge, least),
            places: line.into_iter().map(|crossing| crossing.at).collect(),
        }
    }

    /// The place where a level crosses the edge opposite a vertex.
    fn crossing(&self, triangle: usize, facet: usize, level: usize) -> Crossing {
        let sites = self.sites(triangle);
        let (a, b) = (sites[(facet + 1) % 3] as usize, sites[(facet + 2) % 3] as usize);
        let (p, q) = (self.tile.coordinates[a], self.tile.coordinates[b]);
        let (low, high) = (self.heights[a], self.heights[b]);
        let at = match plane::lexicographic(p, q).is_lt() {
            true => crossing([p, q], [low, high], self.levels[level]),
            false => crossing([q, p], [high, low], self.levels[level]),
        };
        let rows = [self.tile.rows[a], self.tile.rows[b]];
        Crossing { at, edge: [rows[0].min(rows[1]), rows[0].max(rows[1])] }
    }
}

/// The place of a level between two places, one of which is at least as high and the other lower.
pub(super) fn crossing([a, b]: [[f64; 2]; 2], [za, zb]: [f64; 2], level: f64) -> [f64; 2] {
    if za == level {
        return a;
    }
    if zb == level {
        return b;
    }
    let share = match zb - za {
        rise if rise.is_finite() => (level - za) / rise,
        _ => (0.5 * level - 0.5 * za) / (0.5 * zb - 0.5 * za),
    };
    std::array::from_fn(|k| {
        let at = a[k] + share * (b[k] - a[k]);
        let at = if at.is_finite() { at } else { (1.0 - share) * a[k] + share * b[k] };
        at.max(a[k].min(b[k])).min(a[k].max(b[k]))
    })
}
