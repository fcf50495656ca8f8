//! A shape as far as it was read: every reader hands its vertices and polygons to this one, which checks them.

use super::colors::Colors;
use super::{Shape, ShapeFormat};
use crate::error::Refuse;
use crate::limits;
use crate::number::{self, Misread};
use crate::ply::printable;
use crate::words::underflow;
use crate::{Error, MeshPlace};

/// Most triangles, so that the number of a corner fits into 32 bits: the same as of a mesh.
const TRIANGLES_MAX: usize = (u32::MAX / 3) as usize;

/// Bytes of a vertex and of a triangle.
const VERTEX_BYTES: u64 = size_of::<[f64; 3]>() as u64;
const TRIANGLE: u64 = size_of::<[u32; 3]>() as u64;

pub(super) struct Building<'a> {
    path: &'a str,
    format: ShapeFormat,
    /// Most bytes of vertices and triangles; all where none.
    memory: Option<u64>,
    /// The id of the first vertex in this format.
    pub(super) first: i64,
    pub(super) vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) colors: Colors,
}

impl Refuse for Building<'_> {
    fn path(&self) -> &str {
        self.path
    }

    fn longest_line(&self) -> usize {
        limits::longest_line(self.memory)
    }

    fn damaged(&self, place: MeshPlace, problem: impl Into<String>) -> Error {
        let (path, format) = (self.path.to_owned(), self.format);
        Error::Shape { path, format, place, problem: problem.into() }
    }
}

impl<'a> Building<'a> {
    pub(super) fn new(path: &'a str, format: ShapeFormat, memory: Option<u64>) -> Self {
        Building {
            path,
            format,
            memory,
            first: 0,
            vertices: Vec::new(),
            triangles: Vec::new(),
            normals: Vec::new(),
            colors: Colors::default(),
        }
    }

    /// Number of triangles so far.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Adds a vertex.
    pub(super) fn vertex(&mut self, place: MeshPlace, at: [f64; 3]) -> Result<(), Error> {
        let at = self.finite(place, "coordinate", at)?;
        if self.vertices.len() >= u32::MAX as usize {
            return Err(self.damaged(place, "there are more vertices than ids of 32 bits"));
        }
        self.vertices.push(at);
        self.check_memory()
    }

    /// Adds a normal.
    pub(super) fn normal(&mut self, place: MeshPlace, normal: [f64; 3]) -> Result<(), Error> {
        let normal = self.finite(place, "normal", normal)?;
        self.normals.push(normal);
        Ok(())
    }

    /// Adds red, green and blue; `fraction` says that they were written so that 1 is full.
    pub(super) fn color(
        &mut self,
        place: MeshPlace,
        color: [f64; 3],
        fraction: bool,
    ) -> Result<(), Error> {
        self.colors.push(color, fraction).map_err(|value| {
            let problem =
                format!("a colour is {value:?}, which is neither in [0, 1] nor in [0, 255]");
            self.damaged(place, problem)
        })
    }

    /// Adds the fan of triangles around the first of at least three corners, which are among the first `known` vertices.
    pub(super) fn polygon(
        &mut self,
        place: MeshPlace,
        corners: &[i64],
        known: u64,
    ) -> Result<(), Error> {
        if corners.len() < 3 {
            let problem = format!("a face has {} vertices, not at least 3", corners.len());
            return Err(self.damaged(place, problem));
        }
        if let Some(&id) = corners.iter().find(|&&id| id < 0 || id as u64 >= known) {
            let id = id.saturating_add(self.first);
            return Err(self.damaged(place, format!("it names vertex {id}, but there are {known}")));
        }
        if self.triangles.len() + corners.len() - 2 > TRIANGLES_MAX {
            let problem = format!("there are more than {TRIANGLES_MAX} triangles");
            return Err(self.damaged(place, problem));
        }
        let id = |corner: usize| corners[corner] as u32;
        self.triangles.extend((2..corners.len()).map(|k| [id(0), id(k - 1), id(k)]));
        self.check_memory()
    }

    /// Refuses a shape that outgrows the allowed memory: triangles name any vertex, so all are held.
    fn check_memory(&self) -> Result<(), Error> {
        // Corners of stl are looked up by their coordinates, in a table of at most twice their size.
        let vertex = if self.format == ShapeFormat::Stl { 3 * VERTEX_BYTES } else { VERTEX_BYTES };
        let normals = self.normals.len() as u64 * VERTEX_BYTES;
        let bytes = self.vertices.len() as u64 * vertex + self.triangles.len() as u64 * TRIANGLE;
        limits::check_held(
            self.path,
            "all its vertices and triangles",
            bytes + normals,
            self.memory.map(|memory| memory / 2),
            "allow twice as much memory as these take, or convert it to npy",
        )
    }

    /// Refuses a count that does not hold.
    pub(super) fn expect(&self, what: &str, promised: u64, found: u64) -> Result<(), Error> {
        match promised == found {
            true => Ok(()),
            false => {
                let problem = format!("it promises {promised} {what}, but has {found}");
                Err(self.damaged(MeshPlace::File, problem))
            }
        }
    }

    /// What is no damage, but not read either.
    pub(super) fn kind(&self, place: MeshPlace, problem: impl Into<String>) -> Error {
        let remedy = match self.format {
            ShapeFormat::Xyz => "as x y z, with three columns of a normal, of a colour, or of both",
            ShapeFormat::Ply => "with elements `vertex` and `face`",
            _ => "as text, of polygons in space",
        };
        Error::ShapeKind { path: self.path.to_owned(), place, problem: problem.into(), remedy }
    }

    /// The shape. Normals and colours that not each vertex has are left out.
    pub(super) fn finish(self) -> Result<Shape, Error> {
        let n = self.vertices.len();
        if n == 0 {
            return Err(Error::NoVertices { path: self.path.to_owned() });
        }
        let colors = self.colors.finish();
        Ok(Shape {
            vertices: self.vertices,
            triangles: self.triangles,
            normals: Some(self.normals).filter(|normals| normals.len() == n),
            colors: Some(colors).filter(|colors| colors.len() == n),
        })
    }

    /// A word as a number.
    pub(super) fn number(&self, place: MeshPlace, word: &[u8]) -> Result<f64, Error> {
        number::parse(word).map_err(|misread| match misread {
            Misread::Underflow => underflow(self, place, word),
            Misread::NotANumber => {
                let word = printable(&String::from_utf8_lossy(word));
                self.damaged(place, format!("`{word}` is no number"))
            }
        })
    }

    /// The values, unless one is not finite.
    pub(super) fn finite(
        &self,
        place: MeshPlace,
        what: &str,
        values: [f64; 3],
    ) -> Result<[f64; 3], Error> {
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(axis) => {
                let (axis, value) = (["x", "y", "z"][axis], values[axis]);
                Err(self.damaged(place, format!("{what} {axis} is {value}, and must be finite")))
            }
        }
    }
}
