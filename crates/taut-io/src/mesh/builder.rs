//! A mesh as far as it was read: every reader hands its vertices and simplices to this one, which checks them.

use std::io::BufRead;

use super::Mesh;
use super::colors::Colors;
use crate::limits;
use crate::number::{self, NumberError, UNDERFLOW};
use crate::words::Lines;
use crate::{Content, Error, FilePlace, Format};

/// Most triangles of a surface, so that the number of a corner fits into 32 bits: the same as of a mesh in memory.
const TRIANGLES_MAX: usize = (u32::MAX / 3) as usize;

/// Bytes of a vertex and of an id.
const VERTEX_BYTES: u64 = size_of::<[f64; 3]>() as u64;
const ID_BYTES: u64 = size_of::<u32>() as u64;

pub(crate) struct MeshBuilder<'a> {
    pub(super) path: &'a str,
    format: Format,
    content: Content,
    /// Most bytes of vertices and simplices; all where none.
    memory: Option<u64>,
    /// The id of the first vertex in this format.
    pub(super) first: i64,
    pub(super) vertices: Vec<[f64; 3]>,
    width: usize,
    simplices: Vec<u32>,
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) colors: Colors,
}

impl<'a> MeshBuilder<'a> {
    pub(super) fn new(
        path: &'a str,
        format: Format,
        content: Content,
        memory: Option<u64>,
    ) -> Self {
        MeshBuilder {
            path,
            format,
            content,
            memory,
            first: 0,
            vertices: Vec::new(),
            width: 3,
            simplices: Vec::new(),
            normals: Vec::new(),
            colors: Colors::default(),
        }
    }

    /// The file as shown to people.
    pub(crate) fn path(&self) -> &str {
        self.path
    }

    /// Most bytes of a line of text.
    pub(crate) fn longest_line(&self) -> usize {
        limits::longest_line(self.memory)
    }

    pub(crate) fn damaged(&self, place: FilePlace, problem: impl Into<String>) -> Error {
        let (path, format) = (self.path.to_owned(), self.format);
        Error::Damaged { path, format, place, problem: problem.into() }
    }

    /// Returns true if simplices of any one dimension are wanted, rather than a surface.
    pub(super) fn is_triangulation(&self) -> bool {
        self.content == Content::Triangulation
    }

    /// Lines after the first `number`. The last one may lack its end, as editors leave it, except in a triangulation, whose ids
    /// must not be cut short.
    pub(super) fn lines(&self, stream: Box<dyn BufRead>, number: u64) -> Lines {
        Lines::new(stream, number, !self.is_triangulation())
    }

    /// Number of simplices so far.
    pub(super) fn len(&self) -> u64 {
        (self.simplices.len() / self.width) as u64
    }

    pub(super) fn vertex(&mut self, place: FilePlace, at: [f64; 3]) -> Result<(), Error> {
        let at = self.finite(place, "coordinate", at)?;
        if self.vertices.len() >= u32::MAX as usize {
            return Err(self.damaged(place, "there are more vertices than ids of 32 bits"));
        }
        self.vertices.push(at);
        self.check_memory()
    }

    pub(super) fn normal(&mut self, place: FilePlace, normal: [f64; 3]) -> Result<(), Error> {
        let normal = self.finite(place, "normal", normal)?;
        self.normals.push(normal);
        Ok(())
    }

    /// Adds red, green and blue; `fraction` says that they were written so that 1 is full.
    pub(super) fn color(
        &mut self,
        place: FilePlace,
        color: [f64; 3],
        fraction: bool,
    ) -> Result<(), Error> {
        self.colors.push(color, fraction).map_err(|value| {
            let problem =
                format!("a color is {value:?}, which is neither in [0, 1] nor in [0, 255]");
            self.damaged(place, problem)
        })
    }

    /// Adds a polygon whose corners are among the first `known` vertices: to a surface the fan of triangles around its first
    /// corner, to a triangulation a triangle.
    pub(super) fn polygon(
        &mut self,
        place: FilePlace,
        corners: &[i64],
        known: u64,
    ) -> Result<(), Error> {
        if self.is_triangulation() {
            return self.simplex(place, corners, 3, known);
        }
        if corners.len() < 3 {
            let problem = format!("a face has {} vertices, not at least 3", corners.len());
            return Err(self.damaged(place, problem));
        }
        self.check_corners(place, corners, known)?;
        if self.simplices.len() / 3 + corners.len() - 2 > TRIANGLES_MAX {
            let problem = format!("there are more than {TRIANGLES_MAX} triangles");
            return Err(self.damaged(place, problem));
        }
        let id = |corner: usize| corners[corner] as u32;
        self.simplices.extend((2..corners.len()).flat_map(|k| [id(0), id(k - 1), id(k)]));
        self.check_memory()
    }

    /// Adds a simplex of `width` vertices, which are among the first `known` ones.
    pub(super) fn simplex(
        &mut self,
        place: FilePlace,
        ids: &[i64],
        width: usize,
        known: u64,
    ) -> Result<(), Error> {
        if ids.len() != width {
            return Err(
                self.unsupported(place, format!("it has {} vertices, not {width}", ids.len()))
            );
        }
        if self.simplices.is_empty() {
            self.width = width;
        }
        if width != self.width {
            let problem = format!("{width} vertices, where the first simplex has {}", self.width);
            return Err(self.unsupported(place, problem));
        }
        self.check_corners(place, ids, known)?;
        self.simplices.extend(ids.iter().map(|&id| id as u32));
        self.check_memory()
    }

    fn check_corners(&self, place: FilePlace, ids: &[i64], known: u64) -> Result<(), Error> {
        let Some(&id) = ids.iter().find(|&&id| id < 0 || id as u64 >= known) else {
            return Ok(());
        };
        let id = id.saturating_add(self.first);
        let problem = match self.format {
            Format::Parquet => format!("it names vertex {id}, which is no id of 32 bits"),
            _ => format!("it names vertex {id}, but there are {known}"),
        };
        Err(self.damaged(place, problem))
    }

    /// Refuses a mesh that outgrows the allowed memory: simplices name any vertex, so all are held.
    fn check_memory(&self) -> Result<(), Error> {
        // Corners of stl are looked up by their coordinates, in a table of at most twice their size.
        let vertex = if self.format == Format::Stl { 3 * VERTEX_BYTES } else { VERTEX_BYTES };
        let normals = self.normals.len() as u64 * VERTEX_BYTES;
        let bytes = self.vertices.len() as u64 * vertex + self.simplices.len() as u64 * ID_BYTES;
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
                Err(self.damaged(FilePlace::File, problem))
            }
        }
    }

    /// The error of a file that is not damaged, but of a kind that is not read.
    pub(super) fn unsupported(&self, place: FilePlace, problem: impl Into<String>) -> Error {
        let remedy = match (self.content, self.format) {
            (_, Format::Vtu) => "as vtu with uncompressed raw appended data",
            (Content::Triangulation, Format::Off) => "as text, with simplices of one dimension",
            (Content::Triangulation, _) => "with simplices of one dimension",
            (_, Format::Xyz) => "as x y z, with three columns of a normal, of a color, or of both",
            (_, Format::Ply) => "with elements `vertex` and `face`",
            _ => "as text, of polygons in space",
        };
        Error::Unsupported { path: self.path.to_owned(), place, problem: problem.into(), remedy }
    }

    /// The mesh. Normals and colors that not each vertex has are left out.
    pub(super) fn finish(self) -> Result<Mesh, Error> {
        let n = self.vertices.len();
        let missing = match self.is_triangulation() {
            true => self.simplices.is_empty().then_some("simplex"),
            false => self.vertices.is_empty().then_some("vertex"),
        };
        if let Some(missing) = missing {
            return Err(Error::EmptyMesh { path: self.path.to_owned(), missing });
        }
        let colors = self.colors.finish();
        Ok(Mesh {
            vertices: self.vertices,
            width: self.width,
            simplices: self.simplices,
            normals: Some(self.normals).filter(|normals| !normals.is_empty() && normals.len() == n),
            colors: Some(colors).filter(|colors| !colors.is_empty() && colors.len() == n),
        })
    }

    pub(super) fn number(&self, place: FilePlace, word: &[u8]) -> Result<f64, Error> {
        number::parse(word).map_err(|misread| {
            let problem = match misread {
                NumberError::Underflow => UNDERFLOW,
                NumberError::NotANumber => "is no number",
            };
            self.damaged(place, format!("`{}` {problem}", printable(word)))
        })
    }

    /// The values, unless one is not finite.
    pub(super) fn finite(
        &self,
        place: FilePlace,
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

/// A word of the file as messages show it.
pub(crate) fn printable(word: &[u8]) -> String {
    String::from_utf8_lossy(word).chars().take(40).flat_map(char::escape_default).collect()
}
