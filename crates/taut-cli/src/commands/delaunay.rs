//! `taut delaunay`: the Delaunay triangulation of points in the plane or in space.

mod alpha;
mod built;
mod exports;
mod terrain;
mod tiles;
mod voronoi;

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::certify::Triangulation;
use taut::delaunay::InsertionOrder;
use taut::delaunay::outofcore::Mosaic;
use taut::{DelaunayOptions, Monitor, Solution};
use taut_io::{Content, Format, MeshOptions, MeshView, mesh_file};

use self::alpha::Alpha;
use self::built::Built;
use self::exports::Exports;
use self::terrain::TerrainOptions;
use crate::commands::verify::tiles::MEMORY_DEFAULT;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::picture::Picture;
use crate::output::writing::{self, Outputs};
use crate::pipeline::{self, Find, Input, Output};
use crate::reports::Field;
use crate::watch::Watch;

/// Triangulate points in the plane or in space, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Ids are rows of the input, from 0. Of equal points the first stands for all; the others are listed as duplicates. \
Points on a line or on a plane in space are no error: their chain or their triangles are the answer.
Where -o is a folder (one that is there, or a name that ends with /), and where the triangulation would take more than \
--memory, the work is done on the disk within that memory [default for folders: 512M]. A folder gets tiles \
(see docs/delaunay.md); all other files are written from tiles that are removed after. The disk it takes is checked first. \
A run to a folder that was stopped goes on with --resume.
Exit: 0 done · 1 the check failed · 2 bad input or usage, nothing written
Example: taut delaunay points.csv -o mesh.ply --draw mesh.html && taut verify mesh.ply points.csv
         taut delaunay large.npy --memory 1G -o tiles/ && taut verify tiles/ large.npy --memory 1G
         taut delaunay scan.laz --height z --contours lines.geojson --interval 5")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// In which order points are inserted; the answer does not depend on it
    #[arg(long, value_name = "NAME", default_value = InsertionOrder::default().name(), value_parser = choice::<InsertionOrder>())]
    order: InsertionOrder,
    /// Chooses the random orders; the answer does not depend on it
    #[arg(long, value_name = "N", default_value_t = DelaunayOptions::default().seed)]
    seed: u64,
    /// Do without the independent check, which takes about a quarter of the time
    #[arg(long)]
    no_verify: bool,
    /// Go on with a folder of tiles that an earlier run has begun
    #[arg(long)]
    resume: bool,

    /// Write the simplices: .json with the certificate, or a mesh as .ply, .obj, .off, .vtu or .parquet; - is JSON on
    /// standard output; a folder gets tiles
    #[arg(short, long, value_name = "FILE|FOLDER", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Leave the neighbors out of the JSON, which makes it half as large and its check slower
    #[arg(long, help_heading = "Writing")]
    no_neighbors: bool,
    /// Write the facets of the convex hull as a mesh
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    hull: Option<PathBuf>,
    /// Write the Voronoi cells, clipped to the box of the points and a tenth more: GeoJSON in the plane, faces as JSON in
    /// space
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    voronoi: Option<PathBuf>,
    #[command(flatten)]
    alpha: Alpha,
    #[command(flatten)]
    terrain: TerrainOptions,
    /// Draw the triangulation; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,

    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

/// The data for the side outputs of a triangulation.
pub(crate) struct Extra {
    built: Built,
    complex: Option<alpha::Complex>,
    /// Lines and rasters, complete, until they are written.
    exports: RefCell<Exports>,
}

impl Find for Args {
    type Answer = Triangulation;
    type Extra = Extra;

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        Output {
            no_verify: self.no_verify,
            // A folder is not a file that is written in the end.
            out: self.out.as_deref().filter(|out| !tiles::is_folder(out)),
            json: self.json,
            draw: self.draw.as_deref(),
        }
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.mesh_format()?;
        for path in self.hull.iter().chain(self.alpha.files()) {
            if Format::of_path_for(path, Content::Triangulation).is_none() {
                let (path, content) = (path.display().to_string(), Content::Triangulation);
                return Err(taut_io::Error::UnknownOutput { path, content }.into());
            }
        }
        if let Some(path) = &self.voronoi {
            refuse_other_geojson(path, "Voronoi cells")?;
        }
        self.terrain.check()
    }

    fn side_files(&self) -> Vec<&Path> {
        let files = [&self.hull, &self.voronoi].into_iter().flatten().chain(self.alpha.files());
        let files = files.chain(self.terrain.files());
        files.map(|path| &**path).collect()
    }

    fn open(&self, watch: &Watch) -> anyhow::Result<Opened> {
        self.refuse_within_input()?;
        let is_folder = self.out.as_deref().is_some_and(tiles::is_folder);
        let reading = self.reading.with_height(self.terrain.height());
        let opened = match reading.memory().or(is_folder.then_some(MEMORY_DEFAULT)) {
            Some(memory) => reading.beside_work(memory).open_told(&self.points.path, watch),
            None => reading.open(&self.points.path),
        }?;
        match self.terrain.height() {
            Some(height) => opened.with_height(height),
            None => Ok(opened),
        }
    }

    fn divert(&self, points: &Opened, watch: &Watch) -> anyhow::Result<Option<Outcome>> {
        match self.tiles_place(points)? {
            Some(place) => self.run_tiles(&place, points, watch).map(Some),
            None => Ok(None),
        }
    }

    fn solve(
        &self,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<Triangulation>, Extra)> {
        let source = points.source();
        let built = watch
            .during("solving", |monitor| {
                Built::new(source, &DelaunayOptions { monitor: *monitor, ..self.options() })
            })
            .map_err(|error| points.explain(error))?;
        let found = watch
            .during("ordering", |monitor| built.solution(source, monitor))
            .map_err(|error| points.explain(error))?;
        let built = if self.alpha.radius().is_some() { built.renumbered() } else { built };
        let complex = self.alpha.complex(&built);
        let exports = match &built {
            Built::Plane(plane)
                if points.heights().is_some() && self.terrain.files().count() > 0 =>
            {
                self.terrain.export(&Mosaic::of(plane), points, None, None, watch)?
            }
            _ => Exports::default(),
        };
        Ok((found, Extra { built, complex, exports: exports.into() }))
    }

    fn side_fields(&self, extra: &Extra) -> Vec<Field> {
        let complex = extra.complex.as_ref().map(alpha::Complex::field);
        let exports = std::mem::take(&mut extra.exports.borrow_mut().fields);
        complex.into_iter().chain(exports).collect()
    }

    fn write(
        &self,
        found: &mut Solution<Triangulation>,
        extra: &Extra,
        points: &Opened,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        if self.no_neighbors {
            found.certificate.neighbors = Vec::new();
        }
        let answer = &found.answer;
        let file = |simplices: &[u32], width: usize, path: &Path| {
            let mesh = MeshView::on_points(points.vertices(), simplices, width);
            mesh_file(&mesh, path, &MeshOptions::default(), monitor)
        };
        match (&self.out, self.mesh_format()?) {
            (Some(out), Some(_)) => {
                outputs.hold(file(&answer.simplices, answer.vertices_per_simplex(), out)?);
            }
            (Some(out), None) => outputs.add_json(out, found)?,
            (None, _) => {}
        }
        if let Some(hull) = &self.hull {
            let width = answer.hull_dimension.map_or(0, usize::from);
            if width == 0 {
                bail!("{}: all points are equal, so there is no hull to write", points.name());
            }
            outputs.hold(file(&answer.hull, width, hull)?);
        }
        if let Some(complex) = &extra.complex {
            complex.write(outputs, &self.alpha, points.vertices(), monitor)?;
        }
        std::mem::take(&mut extra.exports.borrow_mut().files)
            .into_iter()
            .for_each(|file| outputs.hold(file));
        match &self.voronoi {
            Some(path) => outputs.add(path, &voronoi::cells(&extra.built, points.source())?),
            None => Ok(()),
        }
    }
}

/// Refuses a name that is not that of GeoJSON.
fn refuse_other_geojson(path: &Path, what: &str) -> anyhow::Result<()> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    let is_known = extension.is_some_and(|name| name == "json" || name == "geojson");
    match writing::is_stream(path) || is_known {
        true => Ok(()),
        false => bail!("{}: {what} are .geojson or .json; name one of these", path.display()),
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        pipeline::run(self)
    }

    /// The format of the mesh that goes to `--out`; none where JSON does.
    fn mesh_format(&self) -> anyhow::Result<Option<Format>> {
        let Some(out) = self.out.as_ref().filter(|out| !tiles::is_folder(out)) else {
            return Ok(None);
        };
        let json = out.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("json"));
        match Format::of_path_for(out, Content::Triangulation) {
            Some(format) => Ok(Some(format)),
            None if json => Ok(None),
            None if Picture::of_path(out).is_ok() => {
                bail!("{}: -o writes JSON or a mesh; draw with --draw {0}", out.display())
            }
            None => {
                let names: Vec<_> = Format::of(Content::Triangulation).map(Format::name).collect();
                bail!(
                    "{}: -o writes .json or a mesh as .{}; name one of these",
                    out.display(),
                    names.join(", .")
                )
            }
        }
    }

    fn options(&self) -> DelaunayOptions<'static> {
        DelaunayOptions {
            threads: None, // those of the pool, which reading and checking use as well
            order: self.order,
            seed: self.seed,
            ..DelaunayOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("delaunay"));
        let matches = command.get_matches_from(["delaunay", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::DelaunayOptions::default());
    }
}
