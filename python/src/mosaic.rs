//! What is computed from a folder of tiles, a tile at a time, behind its Python signatures.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::Monitor;
use taut::delaunay::outofcore::{AlphaPart, Mosaic};
use taut::delaunay::{Error, Polygon, Polyhedron};

use crate::numbers::whole;
use crate::tiles::{SIZE, raise};
use crate::work::interruptible;

/// A folder of tiles that is open, of points of the plane or of space.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct OpenTiles(Open);

enum Open {
    Plane(Mosaic<2>),
    Space(Mosaic<3>),
}

/// Cells: the row of each, its number of faces, the number of corners of each face, and all corners.
#[derive(Default)]
struct Cells {
    rows: Vec<u64>,
    faces: Vec<u64>,
    corners: Vec<u64>,
    places: Vec<f64>,
}

impl Cells {
    fn put<'a, const D: usize>(
        &mut self,
        row: u64,
        faces: impl Iterator<Item = &'a Vec<[f64; D]>>,
    ) -> Result<(), Error> {
        self.rows.push(row);
        let before = self.corners.len();
        for face in faces {
            self.corners.push(face.len() as u64);
            self.places.extend(face.as_flattened());
        }
        self.faces.push((self.corners.len() - before) as u64);
        Ok(())
    }
}

type Numbers<'py> = Bound<'py, PyArray1<u64>>;

#[pymethods]
impl OpenTiles {
    /// Opens a folder of tiles of points of this dimension.
    #[new]
    fn new(
        py: Python<'_>,
        folder: PathBuf,
        dimension: usize,
        memory: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let memory = whole("memory", memory, SIZE)?;
        let opened = interruptible(py, |_| match dimension {
            2 => Mosaic::open(&folder, memory).map(Open::Plane),
            _ => Mosaic::open(&folder, memory).map(Open::Space),
        })?;
        opened.map(Self).map_err(raise)
    }

    /// The numbers of the tiles.
    fn numbers(&self) -> Vec<u32> {
        self.tiles().to_vec()
    }

    /// The least and the largest coordinates; none if there are no sites.
    fn extent(&self, py: Python<'_>) -> PyResult<Option<[Vec<f64>; 2]>> {
        let extent = interruptible(py, |_| match &self.0 {
            Open::Plane(mosaic) => Ok(mosaic.extent()?.map(|corners| corners.map(Vec::from))),
            Open::Space(mosaic) => Ok(mosaic.extent()?.map(|corners| corners.map(Vec::from))),
        })?;
        extent.map_err(raise)
    }

    /// The Voronoi cells of a tile within a box: rows, faces of each, corners of each face, and all corners.
    fn voronoi_cells<'py>(
        &self,
        py: Python<'py>,
        tile: u32,
        low: Vec<f64>,
        high: Vec<f64>,
    ) -> PyResult<(Numbers<'py>, Numbers<'py>, Numbers<'py>, Bound<'py, PyArray1<f64>>)> {
        self.check_tile(tile)?;
        let found = interruptible(py, |monitor| self.cells_of(tile, &low, &high, monitor))?;
        let Cells { rows, faces, corners, places } = found?;
        Ok((
            PyArray1::from_vec(py, rows),
            PyArray1::from_vec(py, faces),
            PyArray1::from_vec(py, corners),
            PyArray1::from_vec(py, places),
        ))
    }

    /// The simplices, boundary facets and singular facets of the alpha complex that belong to a tile, as rows of the input.
    fn alpha_complex<'py>(
        &self,
        py: Python<'py>,
        tile: u32,
        alpha: f64,
    ) -> PyResult<[Numbers<'py>; 3]> {
        self.check_tile(tile)?;
        let found = interruptible(py, |monitor| {
            let mut parts = [vec![], vec![], vec![]];
            let put = &mut |part: AlphaPart<'_>| {
                match part {
                    AlphaPart::Simplex(rows) => parts[0].extend(rows),
                    AlphaPart::Boundary(rows) => parts[1].extend(rows),
                    AlphaPart::Singular(rows) => parts[2].extend(rows),
                }
                Ok(())
            };
            match &self.0 {
                Open::Plane(mosaic) => mosaic.alpha_complex_of(tile, alpha, monitor, put),
                Open::Space(mosaic) => mosaic.alpha_complex_of(tile, alpha, monitor, put),
            }?;
            Ok(parts)
        })?;
        Ok(found.map_err(raise)?.map(|rows| PyArray1::from_vec(py, rows)))
    }
}

impl OpenTiles {
    fn tiles(&self) -> &[u32] {
        match &self.0 {
            Open::Plane(mosaic) => mosaic.tiles(),
            Open::Space(mosaic) => mosaic.tiles(),
        }
    }

    fn check_tile(&self, tile: u32) -> PyResult<()> {
        match self.tiles().binary_search(&tile) {
            Ok(_) => Ok(()),
            Err(_) => Err(PyValueError::new_err(format!("there is no tile {tile}"))),
        }
    }

    fn cells_of(
        &self,
        tile: u32,
        low: &[f64],
        high: &[f64],
        monitor: &Monitor<'_>,
    ) -> PyResult<Cells> {
        let mut cells = Cells::default();
        match &self.0 {
            Open::Plane(mosaic) => {
                let put = &mut |row: u64, cell: &Polygon| {
                    cells.put(row, std::iter::once(&cell.corners).filter(|face| !face.is_empty()))
                };
                mosaic.voronoi_cells_of(tile, [corner(low)?, corner(high)?], monitor, put)
            }
            Open::Space(mosaic) => {
                let put = &mut |row: u64, cell: &Polyhedron| cells.put(row, cell.faces.iter());
                mosaic.voronoi_cells_of(tile, [corner(low)?, corner(high)?], monitor, put)
            }
        }
        .map_err(raise)?;
        Ok(cells)
    }
}

/// A corner of a box.
fn corner<const D: usize>(values: &[f64]) -> PyResult<[f64; D]> {
    let wrong = |_| PyValueError::new_err(format!("a corner of the box has not {D} coordinates"));
    values.try_into().map_err(wrong)
}
