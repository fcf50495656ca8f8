//! Values at the centers of the cells of a grid.
//!
//! *Idea.* Each triangle answers the centers that it holds, row by row of the grid: a row meets a triangle in an interval, which
//! doubles bound and exact signs decide. A tile is done in bands of rows, so that what it answers fits into memory.
//! *Guarantee.* A center gets a value exactly if it lies in the hull. One on an edge has the same value from both sides.
//! *Cost.* O(triangles + centers in boxes of triangles by rows) a tile; a natural-neighbor value takes O(k²) for k neighbors.

use taut_points::parallel::ParallelSlice;
use taut_points::{InputError, Monitor};

use super::Terrain;
use super::linear::{Corner, Plane, Within, on_edge, within};
use super::natural::natural;
use crate::Error;
use crate::outofcore::{Tile, View};

/// Cells of a band: 8 bytes each, and 16 while it is filled.
const BAND_CELLS: u64 = 1 << 20;

/// Triangles of one task.
const TASK: usize = 1 << 12;

/// Cells are numbered from 0 0 by whole numbers up to this, so that their centers are all different.
const CELL_NUMBER_MAX: f64 = (1u64 << 50) as f64;

/// A grid of square cells, whose corners are at multiples of their side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterFrame {
    /// The side of a cell.
    pub cell: f64,
    /// The number of the column farthest west: it begins at x = `west · cell`.
    pub west: i64,
    /// The number of the row farthest south: it begins at y = `south · cell`.
    pub south: i64,
    /// Columns.
    pub columns: u64,
    /// Rows.
    pub rows: u64,
}

impl RasterFrame {
    /// The cells that meet the box between two corners.
    ///
    /// # Errors
    /// [`Error::Input`] if `cell` is not positive and finite, or so small that its multiples cannot be told apart there.
    pub fn around(low: [f64; 2], high: [f64; 2], cell: f64) -> Result<Self, Error> {
        let refused = |expected| {
            Error::Input(InputError::Option { name: "cell", value: cell.to_string(), expected })
        };
        if !(cell > 0.0 && cell.is_finite()) {
            return Err(refused("a length of more than 0"));
        }
        let number = |x: f64| {
            let number = (x / cell).floor();
            let is_known = number.abs() <= CELL_NUMBER_MAX;
            if is_known {
                Ok(number as i64)
            } else {
                Err(refused("more: a coordinate is more than 2^50 cells from 0"))
            }
        };
        let (west, south) = (number(low[0])?, number(low[1])?);
        let columns = (number(high[0])? - west) as u64 + 1;
        let rows = (number(high[1])? - south) as u64 + 1;
        Ok(Self { cell, west, south, columns, rows })
    }

    /// Cells, or `None` if more than can be counted.
    pub fn cells(&self) -> Option<u64> {
        self.columns.checked_mul(self.rows)
    }

    /// The center of the cell in a column from the west and a row from the north, both from 0.
    pub fn center(&self, column: u64, row: u64) -> [f64; 2] {
        [self.x(column as i64), self.y(row as i64)]
    }

    fn x(&self, column: i64) -> f64 {
        ((self.west + column) as f64 + 0.5) * self.cell
    }

    /// The middle of a row from the north.
    fn y(&self, row: i64) -> f64 {
        ((self.south + self.rows as i64 - 1 - row) as f64 + 0.5) * self.cell
    }

    /// The columns whose centers may lie between two numbers, and some more.
    fn columns_within(&self, low: f64, high: f64) -> std::ops::Range<i64> {
        let number = |x: f64| (x / self.cell - 0.5).floor() as i64 - self.west;
        let last = self.columns as i64;
        (number(low) - 1).clamp(0, last)..(number(high) + 2).clamp(0, last)
    }

    /// The rows from the north whose middles may lie between two numbers, and some more.
    fn rows_within(&self, low: f64, high: f64) -> std::ops::Range<i64> {
        let number = |y: f64| (y / self.cell - 0.5).floor() as i64 - self.south;
        let last = self.rows as i64;
        (last - 2 - number(high)).clamp(0, last)..(last + 1 - number(low)).clamp(0, last)
    }
}

/// How heights are interpolated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Linear in each triangle.
    #[default]
    Linear,
    /// Sibson's natural neighbors: smooth but at the points.
    Natural,
}

taut_points::choice! { "interpolation", Interpolation {
    Linear = "linear", "linear in each triangle";
    Natural = "natural", "by natural neighbors, smooth but at the points";
}}

/// Options for a raster.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RasterOptions<'a> {
    /// How heights are interpolated. Default linear.
    pub interpolation: Interpolation,
    /// Watches the work, triangle by triangle, and can stop it.
    pub monitor: Monitor<'a>,
}

/// Values at the centers of the cells of `frame` that lie in the hull.
///
/// `put` gets a row from the north, the first of some columns side by side, and their values. Rows come in no order; a cell may
/// come again from another tile, with the same value. The number of values put is returned.
///
/// # Errors
/// Those of `put`, of reading, and of the monitor; [`Error::Input`] for a height that is not finite.
pub fn raster(
    terrain: Terrain<'_>,
    frame: &RasterFrame,
    options: &RasterOptions<'_>,
    put: &mut PutCells<'_>,
) -> Result<u64, Error> {
    options.monitor.pass(1, terrain.mosaic.simplices());
    let mut answered = 0;
    for &number in terrain.mosaic.tiles() {
        options.monitor.check()?;
        let tile = terrain.mosaic.tile(number)?;
        if tile.counts.vertices_per_simplex == 3 {
            let heights = terrain.heights.of(&tile.rows)?;
            let work = TileRaster { terrain, tile: &tile, heights: &heights, frame, options };
            answered += work.fill(put)?;
        }
        options.monitor.points(tile.counts.simplices);
    }
    Ok(answered)
}

struct TileRaster<'a> {
    terrain: Terrain<'a>,
    tile: &'a Tile<2>,
    heights: &'a [f64],
    frame: &'a RasterFrame,
    options: &'a RasterOptions<'a>,
}

/// Takes values of cells that lie side by side: row, first column, values.
pub type PutCells<'a> = dyn FnMut(u64, u64, &[f64]) -> Result<(), Error> + 'a;

/// A cell by its row and column, and its value.
type Answer = (u64, u64, f64);

impl TileRaster<'_> {
    fn fill(&self, put: &mut PutCells<'_>) -> Result<u64, Error> {
        let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for at in self.tile.simplices.iter().map(|&v| self.tile.coordinates[v as usize]) {
            for (k, &x) in at.iter().enumerate() {
                extent[0][k] = extent[0][k].min(x);
                extent[1][k] = extent[1][k].max(x);
            }
        }
        if extent[0][0] > extent[1][0] {
            return Ok(0);
        }
        let columns = self.frame.columns_within(extent[0][0], extent[1][0]);
        let rows = self.frame.rows_within(extent[0][1], extent[1][1]);
        let width = (columns.end - columns.start).max(1);
        let height = (BAND_CELLS as i64 / width).max(1);
        let mut answered = 0;
        let mut north = rows.start;
        while north < rows.end {
            self.options.monitor.check()?;
            let south = (north + height).min(rows.end);
            answered += self.fill_band(north..south, &columns, put)?;
            north = south;
        }
        Ok(answered)
    }

    /// The cells of some rows.
    fn fill_band(
        &self,
        rows: std::ops::Range<i64>,
        columns: &std::ops::Range<i64>,
        put: &mut PutCells<'_>,
    ) -> Result<u64, Error> {
        let tasks = self.tile.simplices.par_chunks(3 * TASK).enumerate();
        let answers: Vec<Vec<Answer>> = tasks
            .map(|(task, triangles)| {
                let mut answers = Vec::new();
                for (i, triangle) in triangles.chunks_exact(3).enumerate() {
                    let number = (task * TASK + i) as u32;
                    self.triangle(number, triangle, &rows, &mut answers)?;
                }
                Ok(answers)
            })
            .collect::<Result<_, Error>>()?;
        let width = (columns.end - columns.start) as usize;
        let mut band = vec![f64::NAN; width * (rows.end - rows.start) as usize];
        for (row, column, value) in answers.into_iter().flatten() {
            let place = (row as i64 - rows.start) as usize * width;
            band[place + (column as i64 - columns.start) as usize] = value;
        }
        let mut answered = 0;
        for (row, values) in (rows.start as u64..).zip(band.chunks_exact(width.max(1))) {
            let mut begin = 0;
            for run in values.chunk_by(|a, b| a.is_nan() == b.is_nan()) {
                if !run[0].is_nan() {
                    put(row, columns.start as u64 + begin, run)?;
                    answered += run.len() as u64;
                }
                begin += run.len() as u64;
            }
        }
        Ok(answered)
    }

    /// The centers in one triangle.
    fn triangle(
        &self,
        number: u32,
        sites: &[u32],
        rows: &std::ops::Range<i64>,
        answers: &mut Vec<Answer>,
    ) -> Result<(), Error> {
        let at: [[f64; 2]; 3] = std::array::from_fn(|i| self.tile.coordinates[sites[i] as usize]);
        let ys = at.map(|p| p[1]);
        let (low, high) = (ys[0].min(ys[1]).min(ys[2]), ys[0].max(ys[1]).max(ys[2]));
        let within_rows = self.frame.rows_within(low, high);
        let (first, end) = (within_rows.start.max(rows.start), within_rows.end.min(rows.end));
        let mut surface = None;
        for row in first..end {
            let y = self.frame.y(row);
            let Some([left, right]) = interval(&at, y) else { continue };
            for column in self.frame.columns_within(left, right) {
                let q = [self.frame.x(column), y];
                if q[0] < left || q[0] > right {
                    continue;
                }
                let Some(within) = within(&at, q) else { continue };
                let corner =
                    |i: usize| Corner { at: at[i], height: self.heights[sites[i] as usize] };
                let value = match (within, self.options.interpolation) {
                    (Within::Corner(i), _) => corner(i).height,
                    (_, Interpolation::Natural) => {
                        let view = View::new(self.terrain.mosaic, self.tile);
                        natural(&view, number, q, &|rows| self.terrain.heights.of(rows))?
                    }
                    (Within::Edge(i), Interpolation::Linear) => {
                        on_edge(corner((i + 1) % 3), corner((i + 2) % 3), q)
                    }
                    (Within::Interior, Interpolation::Linear) => {
                        surface.get_or_insert_with(|| Plane::through([0, 1, 2].map(corner))).at(q)
                    }
                };
                answers.push((row as u64, column as u64, value));
            }
        }
        Ok(())
    }
}

/// An interval that holds all x with (x, y) in the triangle; `None` if there are none.
///
/// A crossing is computed with a relative error of 4 roundings of each coordinate; 8 are allowed.
fn interval(at: &[[f64; 2]; 3], y: f64) -> Option<[f64; 2]> {
    let mut found = [f64::INFINITY, f64::NEG_INFINITY];
    for i in 0..3 {
        let (a, b) = (at[i], at[(i + 1) % 3]);
        if (y < a[1] && y < b[1]) || (y > a[1] && y > b[1]) {
            continue;
        }
        let (least, most) = (a[0].min(b[0]), a[0].max(b[0]));
        let slack = 8.0 * f64::EPSILON * (a[0].abs() + b[0].abs());
        let share = if a[1] == b[1] { f64::NAN } else { (y - a[1]) / (b[1] - a[1]) };
        let x = a[0] + share * (b[0] - a[0]);
        // Along a level edge, and where differences leave the range of doubles, all of the edge counts.
        let [low, high] = if x.is_finite() { [x - slack, x + slack] } else { [least, most] };
        found = [found[0].min(low.max(least)), found[1].max(high.min(most))];
    }
    (found[0] <= found[1]).then_some(found)
}
