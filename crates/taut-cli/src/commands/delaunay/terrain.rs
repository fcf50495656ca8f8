//! Contour lines and rasters of heights over a triangulation of the plane.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::delaunay::Error;
use taut::delaunay::outofcore::Mosaic;
use taut::delaunay::terrain::{
    ContourOptions, Heights, Interpolation, Levels, RasterFrame, RasterOptions, Stroke, Terrain,
    contours, raster,
};
use taut_io::{AtomicFile, LineFile, RasterFile, RasterHeader, check_raster};

use super::exports::{Exports, Relay};
use crate::input::choice::choice;
use crate::input::heights::HeightColumn;
use crate::input::reading::Opened;
use crate::output::numbers::{count, counted, exact};
use crate::reports::Field;
use crate::watch::Watch;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Terrain")]
pub(super) struct TerrainOptions {
    /// The column that is a height, by name or by number from 0 among those that are read; the two others are triangulated
    #[arg(long, value_name = "COLUMN")]
    height: Option<String>,
    /// Write the lines of equal height as GeoJSON; higher ground is to their left
    #[arg(long, value_name = "FILE", requires = "height")]
    contours: Option<PathBuf>,
    /// Have lines at all multiples of a height
    #[arg(long, value_name = "H", requires = "contours")]
    interval: Option<f64>,
    /// Have lines at these heights, such as 100,150.5
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        requires = "contours",
        conflicts_with = "interval",
        allow_hyphen_values = true
    )]
    levels: Option<Vec<f64>>,
    /// Write the heights at the centers of square cells, rows from the north: .npy with NaN outside the hull, or ESRI .asc; may be
    /// given again for the other
    #[arg(long, value_name = "FILE", requires = "height", requires = "cell")]
    grid: Vec<PathBuf>,
    /// The side of a cell; cells begin at its multiples
    #[arg(long, value_name = "LENGTH", requires = "grid")]
    cell: Option<f64>,
    /// How heights of the grid are interpolated
    #[arg(long, value_name = "HOW", default_value = Interpolation::default().name(), value_parser = choice::<Interpolation>())]
    interpolation: Interpolation,
}

impl TerrainOptions {
    pub(super) fn height(&self) -> Option<&str> {
        self.height.as_deref()
    }

    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.contours.iter().chain(&self.grid)
    }

    /// Refuses names of files and options that do not go together.
    pub(super) fn check(&self) -> anyhow::Result<()> {
        if let Some(path) = &self.contours {
            if self.interval.is_none() && self.levels.is_none() {
                bail!("--contours needs the heights of lines: --interval H or --levels LIST");
            }
            super::refuse_other_geojson(path, "contour lines")?;
        }
        self.grid.iter().try_for_each(|path| Ok(check_raster(path)?))
    }

    /// Prepares what was asked for.
    pub(super) fn export(
        &self,
        mosaic: &Mosaic<2>,
        points: &Opened,
        memory: Option<u64>,
        scratch: Option<&Path>,
        watch: &Watch,
    ) -> anyhow::Result<Exports> {
        let mut exports = Exports::default();
        let Some(heights) = points.heights() else { return Ok(exports) };
        let terrain =
            Terrain { mosaic, heights: Heights::Column(&*heights.points, heights.column) };
        if let Some(path) = &self.contours {
            let (file, field) = self.lines(path, terrain, heights, scratch, points, watch)?;
            exports.add(file, field);
        }
        if !self.grid.is_empty() {
            let (files, field) = self.rasters(terrain, heights, memory, scratch, points, watch)?;
            exports.fields.push(field);
            exports.files.extend(files);
        }
        Ok(exports)
    }

    fn lines(
        &self,
        path: &Path,
        terrain: Terrain<'_>,
        heights: &HeightColumn,
        scratch: Option<&Path>,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(AtomicFile, Field)> {
        let levels = match (&self.levels, self.interval) {
            (Some(levels), _) => Levels::of(levels.clone()),
            (None, interval) => Levels::every(interval.unwrap_or(1.0), heights.range),
        };
        let levels = levels.map_err(|error| points.explain(error))?;
        let shown = path.display().to_string();
        let mut file = LineFile::create(path, &shown)?;
        let mut relay = Relay::default();
        let lines = watch.during("contours", |monitor| {
            let options =
                ContourOptions { scratch: scratch.map(Path::to_owned), monitor: *monitor };
            contours(terrain, &levels, &options, &mut |stroke| {
                relay.pass(match stroke {
                    Stroke::Begin(height) => file.begin(height),
                    Stroke::To(at) => file.to(at),
                    Stroke::End => file.end(),
                })
            })
        });
        let lines = relay.explain(lines, |error| explain(points, error))?;
        let field = Field::new("contours", counted(lines, "line"))
            .remark(format!("at {}", counted(levels.heights().len() as u64, "height")));
        Ok((file.finish()?, field))
    }

    fn rasters(
        &self,
        terrain: Terrain<'_>,
        heights: &HeightColumn,
        memory: Option<u64>,
        scratch: Option<&Path>,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Vec<AtomicFile>, Field)> {
        let explained = |error| explain(points, error);
        let Some([low, high]) = terrain.mosaic.extent().map_err(explained)? else {
            bail!("{}: there are no points for a grid", points.name());
        };
        let cell = self.cell.unwrap_or(1.0);
        let frame = RasterFrame::around(low, high, cell).map_err(explained)?;
        let (west, south) = (frame.west as f64 * cell, frame.south as f64 * cell);
        let header = RasterHeader {
            columns: frame.columns,
            rows: frame.rows,
            west,
            south,
            cell,
            no_value: below(heights.range[0]),
        };
        let mut file = RasterFile::new(header, memory.unwrap_or(u64::MAX), scratch)?;
        let mut relay = Relay::default();
        let mut put = |row, column, values: &[f64]| relay.pass(file.put(row, column, values));
        let answered = watch.during("grid", |monitor| {
            let options = RasterOptions { interpolation: self.interpolation, monitor: *monitor };
            raster(terrain, &frame, &options, &mut put)
        });
        relay.explain(answered, explained)?;
        let files = watch.during("writing", |monitor| {
            let mut files = vec![];
            for path in &self.grid {
                files.push(file.file(path, monitor)?);
            }
            Ok::<_, taut_io::Error>(files)
        })?;
        let north = (frame.south + frame.rows as i64) as f64 * cell;
        let field = Field::new(
            "grid",
            format!("{} × {} cells of {}", count(frame.columns), count(frame.rows), exact(cell)),
        )
        .remark(format!(
            "the corner in the north-west is ({}, {})",
            exact(west),
            exact(north)
        ));
        Ok((files, field))
    }
}

/// A value that stands for no height: −9999, or as many nines as are below all heights.
fn below(least: f64) -> f64 {
    let mut value = -9999.0;
    while value >= least && value > -1e300 {
        value = value * 10.0 - 9.0;
    }
    value
}

fn explain(points: &Opened, error: Error) -> anyhow::Error {
    match error {
        Error::Input(_) => points.explain(error),
        other => anyhow!("{other}"),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_height_is_the_sign_of_no_height() {
        for (least, expected) in
            [(0.0, -9999.0), (-9998.5, -9999.0), (-9999.0, -99999.0), (-1e7, -99_999_999.0)]
        {
            assert_eq!(super::below(least), expected);
        }
    }
}
