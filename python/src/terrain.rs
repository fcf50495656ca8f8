//! `taut.contours` and `taut.raster`, behind their Python signatures.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use taut::delaunay::outofcore::Mosaic;
use taut::delaunay::terrain::{
    self, ContourOptions, Heights, Levels, RasterFrame, RasterOptions, Stroke, Terrain,
};
use taut::delaunay::{Error, Plane};
use taut::points::{InputError, Rows as SourceRows, Scratch, try_reserve_exact};
use taut::{DelaunayOptions, Monitor, PointSource};

use crate::choice::choice;
use crate::rows::Rows;
use crate::tiles::raise;
use crate::work::interruptible;

/// The triangulation of x and y: of a folder, or made here.
fn mosaic(
    places: &dyn PointSource,
    folder: Option<&PathBuf>,
    memory: u64,
    monitor: &Monitor<'_>,
) -> Result<Mosaic<2>, Error> {
    if let Some(folder) = folder {
        return Mosaic::open(folder, memory);
    }
    let options = DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() };
    let mut scratch = Scratch::new();
    Ok(Mosaic::of(&match places.read(0..places.len(), &mut scratch)? {
        SourceRows::F32(points) => Plane::build(&points, &options)?,
        SourceRows::F64(points) => Plane::build(&points, &options)?,
    }))
}

/// No value for each cell.
fn no_values(frame: &RasterFrame) -> Result<Vec<f64>, Error> {
    let too_many = || InputError::Option {
        name: "cell",
        value: frame.cell.to_string(),
        expected: "more: memory does not hold so many cells",
    };
    let cells = frame.cells().and_then(|cells| usize::try_from(cells).ok()).ok_or_else(too_many)?;
    let mut values = Vec::new();
    try_reserve_exact(&mut values, cells).map_err(|_| too_many())?;
    values.resize(cells, f64::NAN);
    Ok(values)
}

/// Heights, numbers of places, and all places one behind the other.
type Lines<'py> = (Vec<f64>, Vec<usize>, Bound<'py, PyArray1<f64>>);

/// The lines of equal height: the height and the number of places of each, and all places.
#[pyfunction]
pub(crate) fn contours<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    heights: &Bound<'py, PyAny>,
    levels: Option<Vec<f64>>,
    interval: Option<f64>,
    folder: Option<PathBuf>,
    memory: u64,
) -> PyResult<Lines<'py>> {
    let (rows, heights) = (Rows::borrow(rows)?, Rows::borrow(heights)?);
    let (places, heights) = (rows.source()?, heights.source()?);
    let made = interruptible(py, |monitor| {
        let mosaic = mosaic(&*places, folder.as_ref(), memory, monitor)?;
        let terrain = Terrain { mosaic: &mosaic, heights: Heights::Column(&*heights, 0) };
        let levels = match (levels, interval) {
            (Some(levels), _) => Levels::of(levels)?,
            (None, interval) => {
                let range = terrain.height_range()?.unwrap_or([0.0, 0.0]);
                Levels::every(interval.unwrap_or(1.0), range)?
            }
        };
        let (mut found, mut counts, mut flat) = (vec![], vec![], vec![]);
        let options = ContourOptions { scratch: None, monitor: *monitor };
        terrain::contours(terrain, &levels, &options, &mut |stroke| {
            match stroke {
                Stroke::Begin(height) => {
                    found.push(height);
                    counts.push(0);
                }
                Stroke::To(at) => {
                    flat.extend(at);
                    if let Some(count) = counts.last_mut() {
                        *count += 1;
                    }
                }
                Stroke::End => {}
            }
            Ok(())
        })?;
        Ok::<_, Error>((found, counts, flat))
    })?;
    let (found, counts, flat) = made.map_err(raise)?;
    Ok((found, counts, PyArray1::from_vec(py, flat)))
}

/// The heights at the centers of cells: columns, the western and the northern border, and the values by rows from the north.
#[pyfunction]
pub(crate) fn raster<'py>(
    py: Python<'py>,
    rows: &Bound<'py, PyAny>,
    heights: &Bound<'py, PyAny>,
    cell: f64,
    interpolation: &str,
    folder: Option<PathBuf>,
    memory: u64,
) -> PyResult<(u64, f64, f64, Bound<'py, PyArray1<f64>>)> {
    let interpolation = choice("interpolation", interpolation)?;
    let (rows, heights) = (Rows::borrow(rows)?, Rows::borrow(heights)?);
    let (places, heights) = (rows.source()?, heights.source()?);
    let made = interruptible(py, |monitor| {
        let mosaic = mosaic(&*places, folder.as_ref(), memory, monitor)?;
        let terrain = Terrain { mosaic: &mosaic, heights: Heights::Column(&*heights, 0) };
        let [low, high] = mosaic.extent()?.unwrap_or_default();
        let frame = RasterFrame::around(low, high, cell)?;
        let mut values = no_values(&frame)?;
        let columns = frame.columns;
        let options = RasterOptions { interpolation, monitor: *monitor };
        terrain::raster(terrain, &frame, &options, &mut |row, column, run| {
            let first = (row * columns + column) as usize;
            values[first..first + run.len()].copy_from_slice(run);
            Ok(())
        })?;
        let north = (frame.south + frame.rows as i64) as f64 * cell;
        Ok::<_, Error>((columns, frame.west as f64 * cell, north, values))
    })?;
    let (columns, west, north, values) = made.map_err(raise)?;
    Ok((columns, west, north, PyArray1::from_vec(py, values)))
}
