//! What convex bodies in a mesh stay clear of besides its triangles: points and surfaces of other files.

use std::path::PathBuf;

use anyhow::anyhow;
use taut::inscribe::{Scene, box_rows, point_rows};
use taut::points::{Blocks, OwnedPoints, Scratch};

use crate::input::reading::{Opened, Reading};

/// Numbers of a row that is a point, and of one that is a triangle.
const POINT: usize = 3;
const TRIANGLE: usize = 9;

/// Numbers of a row that is a triangle with the number of its surface.
const SURFACE: usize = 10;

/// The option for what bodies stay clear of, the same for each subcommand that reads a mesh with bodies.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct Obstacles {
    /// Points with 3 coordinates, or a surface, that bodies in a mesh do not meet; may be given several times. Closed parts of a surface
    /// are solids, in which no body lies; its other parts are walls
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
        let dim = mesh.source().dim();
        if self.obstacles.is_empty() && matches!(dim, TRIANGLE | SURFACE) {
            return Ok(mesh);
        }
        let (mut rows, mut points) = (numbers(&mesh)?, vec![]);
        match mesh.source().dim() {
            POINT => {
                points = rows;
                rows = box_rows(points.as_chunks::<POINT>().0);
            }
            TRIANGLE => {}
            _ => return Err(wrong_dimension(&mesh)),
        }
        let (mut surfaces, mut names) = (vec![], vec![]);
        for path in &self.obstacles {
            let obstacle = reading.open_obstacle(path)?;
            let found = numbers(&obstacle)?;
            names.push(obstacle.name().to_owned());
            match obstacle.source().dim() {
                POINT => points.extend(found),
                TRIANGLE => surfaces.push((obstacle, found)),
                _ => return Err(wrong_dimension(&obstacle)),
            }
        }
        let name = match &names[..] {
            [] => mesh.name().to_owned(),
            names => format!("{} with {}", mesh.name(), names.join(", ")),
        };
        let points = points.as_chunks::<POINT>().0;
        let (rows, dim) = if surfaces.is_empty() {
            ([rows, point_rows(points)].concat(), TRIANGLE)
        } else {
            let mut scene = Scene::around(&rows).map_err(|error| mesh.explain(error))?;
            for (obstacle, found) in surfaces {
                scene.add_surface(&found).map_err(|error| obstacle.explain(error))?;
            }
            scene.add_points(points);
            (scene.into_rows(), SURFACE)
        };
        let points = OwnedPoints::new(rows, dim).map_err(|error| anyhow!("{name}: {error}"))?;
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
