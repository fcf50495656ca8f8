//! What convex bodies in a mesh stay clear of besides its triangles: points and surfaces of other files.

use std::path::PathBuf;

use anyhow::anyhow;
use taut::inscribe::{box_rows, point_rows, surface_rows};
use taut::points::{Blocks, OwnedPoints, Scratch};

use crate::input::reading::{Opened, Reading};

/// Numbers of a row that is a point, and of one that is a triangle.
const POINT: usize = 3;
const TRIANGLE: usize = 9;

/// The option for what bodies stay clear of, the same for each subcommand that reads a mesh with bodies.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct Obstacles {
    /// Of bodies in a mesh: points with 3 coordinates, or a surface, that the bodies stay clear of; may be given several times. The
    /// inside of a closed surface is outside of the mesh then
    #[arg(long, value_name = "FILE")]
    obstacles: Vec<PathBuf>,
}

impl Obstacles {
    /// Refuses obstacles where there is no mesh with bodies.
    pub(crate) fn refuse(&self) -> anyhow::Result<()> {
        match self.obstacles.is_empty() {
            true => Ok(()),
            false => Err(anyhow!("--obstacles belongs to bodies in a mesh: leave it out")),
        }
    }

    /// The files, which may not be written over.
    pub(crate) fn paths(&self) -> &[PathBuf] {
        &self.obstacles
    }

    /// The rows of a mesh, then those of the obstacles. Points in place of the mesh come in their bounding box.
    pub(super) fn around(&self, mesh: Opened, reading: &Reading) -> anyhow::Result<Opened> {
        let is_cloud = mesh.source().dim() == POINT;
        if self.obstacles.is_empty() && !is_cloud {
            return Ok(mesh);
        }
        let mut name = mesh.name().to_owned();
        let mut rows = numbers(&mesh)?;
        match mesh.source().dim() {
            POINT => {
                let points = rows.as_chunks::<POINT>().0;
                rows = [box_rows(points), point_rows(points)].concat();
            }
            TRIANGLE => {}
            _ => return Err(wrong_dimension(&mesh)),
        }
        for path in &self.obstacles {
            let obstacle = reading.open_obstacle(path)?;
            let found = numbers(&obstacle)?;
            rows.extend(match obstacle.source().dim() {
                POINT => point_rows(found.as_chunks::<POINT>().0),
                TRIANGLE => surface_rows(&found).map_err(|error| obstacle.explain(error))?,
                _ => return Err(wrong_dimension(&obstacle)),
            });
            name = format!("{name} with {}", obstacle.name());
        }
        let points =
            OwnedPoints::new(rows, TRIANGLE).map_err(|error| anyhow!("{name}: {error}"))?;
        Ok(mesh.with_source(Box::new(points), name))
    }
}

/// All numbers of the rows, which must be finite.
fn numbers(opened: &Opened) -> anyhow::Result<Vec<f64>> {
    let source = opened.source();
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    let (mut all, mut row) = (vec![], vec![0.0; source.dim()]);
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        let rows = source.read(range, &mut scratch).map_err(|e| opened.reading_failed(e))?;
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(opened.not_finite(first + row as u64, column, value));
        }
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row);
            all.extend_from_slice(&row);
        }
    }
    Ok(all)
}

fn wrong_dimension(opened: &Opened) -> anyhow::Error {
    anyhow!(
        "{}: rows have {} numbers: expected 9, the corners of a triangle, or 3 for a point; choose them with --columns",
        opened.name(),
        opened.source().dim()
    )
}
