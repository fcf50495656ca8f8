//! `taut convert`: points and meshes from one format to another.

use std::path::PathBuf;

use anyhow::bail;
use taut::points::{Blocks, Scratch};
use taut_io::{
    Column, Content, Format, Mesh, MeshOptions, Table, mesh_file, open_mesh, write_points,
};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::numbers::{count, counted};
use crate::output::tables::is_table;
use crate::output::writing::{self, Outputs};

/// Convert points or a mesh to another format; options of reading choose columns and rows.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Numbers keep all their bits where the format has room. To a format of meshes (.ply, .obj, .off, .stl, .glb, .gltf, .dxf, .wrl, \
.pov) a mesh is written with its triangles, and points of three coordinates as vertices where the format knows these alone.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut convert scan.laz -o ground.npy --classes 2 --thin 0.5
         taut convert towns.csv -o towns.parquet --missing drop --id town --columns numeric")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Where to write, in the format that the name tells; - is CSV on standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let out = &*self.out;
        writing::check_writable(&[out], &[&self.points.path])?;
        let watch = self.effort.start()?;
        let to = Format::of_path(out).0;
        if let Some(format) =
            to.filter(|format| !format.writes(Content::Points) && format.writes(Content::Surface))
        {
            let mesh = self.mesh()?;
            let view = mesh.view()?;
            let options = MeshOptions { format: Some(format), ..MeshOptions::default() };
            let file =
                watch.during("writing", |monitor| mesh_file(&view, out, &options, monitor))?;
            let mut outputs = Outputs::default();
            outputs.hold(file);
            let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles().len());
            self.finish(
                outputs,
                &[
                    format!("{} vertices", count(vertices as u64)),
                    counted(triangles as u64, "triangle"),
                ],
            )
        } else {
            let opened = self.reading.open(&self.points.path)?;
            let dim = opened.source().dim();
            let words =
                [counted(opened.source().len(), "point"), counted(dim as u64, "coordinate")];
            if opened.labels().is_empty() {
                let names = opened.names(dim);
                watch.during("writing", |monitor| {
                    write_points(opened.source(), &names, out, None, monitor)
                })?;
                return self.finish(Outputs::default(), &words);
            }
            if !is_table(out) || to == Some(Format::Npy) {
                bail!(
                    "{}: rows have names only as .csv, .tsv, .parquet or .arrow: name one of these, or leave out --id",
                    out.display()
                );
            }
            let mut outputs = Outputs::default();
            outputs.add_table(out, &table(&opened)?)?;
            self.finish(outputs, &words)
        }
    }

    fn finish(&self, mut outputs: Outputs, words: &[String]) -> anyhow::Result<Outcome> {
        if !self.effort.quiet && !writing::is_stream(&self.out) {
            outputs.print(&format!("{}: {}\n", self.out.display(), words.join(", ")));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    /// The mesh of the file, or its points as vertices.
    fn mesh(&self) -> anyhow::Result<Mesh> {
        let path = &self.points.path;
        let is_plain = self.reading.is_plain();
        let from = self.reading.format().or(Format::of_path(path).0);
        // A cloud of points is no mesh, so that options choose rows of it; read plainly it keeps normals and colors.
        let is_cloud = from == Some(Format::Xyz) && !is_plain;
        if from.is_some_and(|format| format.reads(Content::Surface)) && !is_cloud {
            let mesh = open_mesh(path, Content::Surface, from)?;
            if is_plain {
                return Ok(mesh);
            }
            if !mesh.triangles().is_empty() {
                bail!(
                    "{}: options of reading choose points, not the triangles of a mesh: leave them out",
                    path.display()
                );
            }
            if writing::is_stream(path) {
                bail!(
                    "options of reading need a second walk over the vertices of a mesh: name a file"
                );
            }
        }
        let opened = self.reading.open(path)?;
        if !opened.labels().is_empty() {
            bail!("{}: vertices have no names: leave out --id", self.out.display());
        }
        if opened.source().dim() != 3 {
            bail!("{}: vertices have 3 coordinates: choose these with --columns", opened.name());
        }
        let mut vertices = vec![];
        each_row(&opened, |row| vertices.push([row[0], row[1], row[2]]))?;
        Ok(Mesh { vertices, ..Mesh::default() })
    }
}

/// The points with their names in the first column, whose name no coordinate has.
fn table(points: &Opened) -> anyhow::Result<Table> {
    let dim = points.source().dim();
    let mut columns = vec![vec![]; dim];
    each_row(points, |row| {
        columns.iter_mut().zip(row).for_each(|(column, &value)| column.push(value));
    })?;
    let names = points.names(dim);
    let mut id = "id".to_owned();
    while names.contains(&id) {
        id.push('_');
    }
    let table = Table::new().with(id, Column::Text(points.labels().to_vec()));
    Ok(columns.into_iter().enumerate().fold(table, |table, (at, column)| {
        let name = names.get(at).cloned().unwrap_or_else(|| format!("x{at}"));
        table.with(name, Column::Real(column))
    }))
}

fn each_row(points: &Opened, mut visit: impl FnMut(&[f64])) -> anyhow::Result<()> {
    let (blocks, mut scratch) = (Blocks::of(points.source()), Scratch::new());
    let mut row = vec![0.0; points.source().dim()];
    for block in 0..blocks.count() {
        let rows = points.source().read(blocks.range(block), &mut scratch);
        let rows = rows.map_err(|error| points.reading_failed(error))?;
        for at in 0..rows.len() {
            rows.copy_row(at, &mut row);
            visit(&row);
        }
    }
    Ok(())
}
