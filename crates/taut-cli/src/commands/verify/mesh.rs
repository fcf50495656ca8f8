//! Meshes of files, which have no certificate: each is judged for what it is.
//!
//! *Idea.* Simplices that fill the hull of the points are judged as their Delaunay triangulation, which is the only one. Triangles in
//! space are judged as a surface: what a certificate would claim is calculated from the triangles and the points, and the checker of
//! surfaces proves or refuses it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::certify::{
    Answer, Surface, SurfaceVerdict, SurfaceViolation, Triangulation, TriangulationVerdict,
    Violation, check_simplices,
};
use taut::points::{Blocks, Scratch};
use taut::reconstruct::given_surface;
use taut::{Monitor, Solution};
use taut_io::{Content, Format, Mesh, open_mesh};

use super::{judge, shown, verdict};
use crate::input::reading::{Opened, Reading};
use crate::output::numbers::short;
use crate::reports::triangulation::claims_of_triangulation;
use crate::reports::{Claims, Summary};
use crate::watch::Watch;

/// Fields of the report on a surface that tell what its method thinks of it.
pub(crate) const FIELDS_OF_METHOD: [&str; 3] = ["topology", "certified", "method"];

/// Tests whether the name of a file is that of a mesh.
pub(crate) fn is_mesh(path: &Path) -> bool {
    let format = Format::of_path(path).0;
    // A list of points with normals is no mesh.
    format.is_some_and(|format| {
        format != Format::Xyz
            && (format.holds(Content::Triangulation) || format.holds(Content::Surface))
    })
}

/// A mesh of a file, and the points that its vertices are.
pub(crate) struct MeshOnPoints {
    mesh: Mesh,
    name: String,
    pub(crate) points: Opened,
}

/// The findings about a mesh.
pub(crate) enum Judged {
    /// The Delaunay triangulation of the points.
    Triangulation(TriangulationVerdict),
    /// Triangles in space.
    Surface(Box<Solution<Surface>>, SurfaceVerdict),
}

impl MeshOnPoints {
    /// Opens a mesh and its points, which are its vertices if no file is named.
    pub(crate) fn open(
        path: &Path,
        points: Option<&PathBuf>,
        reading: &Reading,
    ) -> anyhow::Result<Self> {
        let name = shown(path);
        let of_triangulation = Format::of_path_for(path, Content::Triangulation);
        let mesh = match of_triangulation.map(|_| open_mesh(path, Content::Triangulation, None)) {
            Some(Ok(mesh)) => mesh,
            // Other programs write polygons.
            Some(Err(taut_io::Error::Unsupported { .. }))
                if Format::of_path_for(path, Content::Surface).is_some() =>
            {
                open_mesh(path, Content::Surface, None)?
            }
            None => open_mesh(path, Content::Surface, None)?,
            Some(Err(error)) => return Err(error.into()),
        };
        if mesh.simplices.is_empty() {
            bail!("{name} holds no triangle: a mesh is judged, and points alone are none");
        }
        let points = match points {
            Some(points) => reading.open(points)?,
            None if Format::of_path_for(path, Content::Points).is_some()
                && !mesh.vertices.is_empty() =>
            {
                reading.open(path)?
            }
            None => bail!("{name}: name the file of its points as well"),
        };
        Ok(MeshOnPoints { mesh, name, points })
    }

    /// Returns what the mesh is, or what is wrong with it.
    pub(crate) fn judge(&self, watch: &Watch) -> anyhow::Result<Result<Judged, String>> {
        let rows = match self.rows()? {
            Ok(rows) => rows,
            Err(problem) => return Ok(Err(problem)),
        };
        let (source, width) = (self.points.source(), self.mesh.width);
        let explain = |violation: Violation| self.points.explain_violation(&violation, &self.name);
        let of_rows = |&id: &u32| rows.as_ref().map_or(id, |rows| rows[id as usize]);
        let simplices: Vec<u32> = self.mesh.simplices.iter().map(of_rows).collect();
        let check = |monitor: &Monitor<'_>| check_simplices(source, &simplices, width, monitor);
        let as_triangulation = verdict(watch.during("checking", check), &self.points)?;
        let refused = match as_triangulation {
            Ok(verdict) => return Ok(Ok(Judged::Triangulation(verdict))),
            Err(violation) => violation,
        };
        if width != 3 || source.dim() != 3 {
            return Ok(Err(explain(refused)));
        }
        if let Some(&row) = simplices.iter().find(|&&row| u64::from(row) >= source.len()) {
            let points = source.len();
            return Ok(Err(format!(
                "{}: a triangle names point {row}, counted from 0, but there are {points}",
                self.name
            )));
        }
        let prepare =
            |monitor: &Monitor<'_>| given_surface(source, simplices.as_chunks().0, monitor);
        let mut found =
            watch.during("preparing", prepare).map_err(|error| self.points.explain(error))?;
        let judged = match judge(&found, &self.points, watch)? {
            // It is claimed first, as it costs least where it is so.
            Err(Violation::Surface(SurfaceViolation::NotOutward { .. })) => {
                found.certificate.outward = false;
                judge(&found, &self.points, watch)?
            }
            judged => judged,
        };
        Ok(judged.map(|verdict| Judged::Surface(Box::new(found), verdict)).map_err(explain))
    }

    /// For each vertex its row, where they are not the same; or why a vertex is no point.
    fn rows(&self) -> anyhow::Result<Result<Option<Vec<u32>>, String>> {
        let Some(problem) = other_vertices(&self.mesh, &self.name, &self.points)? else {
            return Ok(Ok(None));
        };
        // A surface may leave out points, and formats without numbers of vertices write them in another order.
        if self.mesh.width != 3 || self.points.source().dim() != 3 {
            return Ok(Err(problem));
        }
        let bits = |place: &[f64; 3]| place.map(|value| (value + 0.0).to_bits());
        let mut row_of = HashMap::new();
        let mut place = [0.0; 3];
        each_row(&self.points, |row, rows, i| {
            rows.copy_row(i, &mut place);
            row_of.entry(bits(&place)).or_insert(row as u32);
            true
        })?;
        let mut is_used = vec![false; self.mesh.vertices.len()];
        self.mesh.simplices.iter().for_each(|&id| is_used[id as usize] = true);
        let mut rows = Vec::with_capacity(self.mesh.vertices.len());
        for (number, vertex) in self.mesh.vertices.iter().enumerate() {
            match row_of.get(&bits(vertex)) {
                Some(&row) => rows.push(row),
                None if !is_used[number] => rows.push(0),
                None => {
                    let [x, y, z] = vertex.map(short);
                    let name = self.points.name();
                    return Ok(Err(format!(
                        "{name} does not belong to {}: vertex {number}, ({x}, {y}, {z}), is none of its points{}",
                        self.name, ROUNDED
                    )));
                }
            }
        }
        Ok(Ok(Some(rows)))
    }
}

/// What a mesh of other vertices than the points may come from.
const ROUNDED: &str = "; stl rounds them to single precision, and --denoise moves them, which the JSON of an answer knows";

impl Judged {
    /// The word for what it is.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Judged::Triangulation(_) => <Triangulation as Answer>::KIND,
            Judged::Surface(..) => <Surface as Answer>::KIND,
        }
    }

    /// The verdict as all languages have it.
    pub(crate) fn to_json(&self) -> serde_json::Result<serde_json::Value> {
        match self {
            Judged::Triangulation(verdict) => serde_json::to_value(verdict),
            Judged::Surface(_, verdict) => serde_json::to_value(verdict),
        }
    }

    /// Returns what was proved, and the first reason not to call it a mesh of a surface, if there is one.
    pub(crate) fn claims(&self, points: &Opened) -> (Claims, Option<String>) {
        let source = points.source();
        match self {
            Judged::Triangulation(verdict) => {
                (claims_of_triangulation(verdict, source.len(), source.dim()), None)
            }
            Judged::Surface(found, verdict) => {
                let mut claims = Summary::claims(&**found, verdict, source);
                claims.fields.retain(|field| !FIELDS_OF_METHOD.contains(&field.name));
                let is_surface = verdict.is_manifold && verdict.is_oriented && verdict.is_embedded;
                let doubt = verdict.doubt.filter(|_| !is_surface);
                (claims, doubt.map(|doubt| format!("{doubt}; all counted from 0")))
            }
        }
    }
}

/// Calls `visit` with each row, its block and its place there, until it returns false.
fn each_row(
    points: &Opened,
    mut visit: impl FnMut(u64, &taut::points::Rows<'_>, usize) -> bool,
) -> anyhow::Result<()> {
    let (blocks, mut scratch) = (Blocks::of(points.source()), Scratch::new());
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        let rows = points.source().read(range, &mut scratch);
        let rows = rows.map_err(|error| points.reading_failed(error))?;
        for i in 0..rows.len() {
            if !visit(first + i as u64, &rows, i) {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Returns how the vertices of a mesh are not the points, if they are not: ids would then mean something else.
fn other_vertices(mesh: &Mesh, file: &str, points: &Opened) -> anyhow::Result<Option<String>> {
    // Parquet holds ids alone.
    let vertices = &mesh.vertices;
    if vertices.is_empty() {
        return Ok(None);
    }
    let (source, name) = (points.source(), points.name());
    let mine = |problem: String| Some(format!("{name} does not belong to {file}: {problem}"));
    if vertices.len() as u64 != source.len() {
        return Ok(mine(format!(
            "there are {} points, but {} vertices",
            source.len(),
            vertices.len()
        )));
    }
    let (dim, mut other) = (source.dim().min(3), None);
    let mut place = vec![0.0; source.dim()];
    each_row(points, |row, rows, i| {
        rows.copy_row(i, &mut place);
        if place[..dim] != vertices[row as usize][..dim] {
            other = mine(format!("vertex {row} is another than point {row}"));
        }
        other.is_none()
    })?;
    Ok(other)
}
