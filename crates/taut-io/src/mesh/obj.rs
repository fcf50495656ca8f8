//! Wavefront OBJ: `v x y z`, `vn` with a normal, and `f` with corners, each a vertex and perhaps a texture and a normal.
//!
//! A corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or back from the last one if negative. Three values after
//! the coordinates are a color, as most programs write it. Textures, materials, groups, points and lines are passed over;
//! free-form surfaces are refused.
//!
//! *Trap.* Normals belong to corners. They are kept where all corners of a vertex agree; a vertex of no corner takes the
//! normal of its own number, where there are as many normals as vertices, which is how point sets have them.
//! *Trap.* The format says nowhere how much there is. A comment of ours at its top tells the counts, and where it stands
//! they must hold, up to the end of the last line.

use std::io::BufRead;

use super::colors::fraction;
use super::writing::Job;
use super::{MeshBuilder, printable};
use crate::words::{Line, put_number, put_numbers, put_place, put_whole, whole, words};
use crate::write::OutputFile;
use crate::{Error, FilePlace};

/// The keyword of simplices of so many vertices.
const KEYWORDS: [&[u8]; 3] = [b"p", b"l", b"f"];

/// Keywords that say nothing of a surface.
const PASSED_OVER: [&[u8]; 22] = [
    b"vt",
    b"vp",
    b"o",
    b"g",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
];

/// Keywords of free-form curves and surfaces.
const FREE_FORM: [&[u8]; 3] = [b"curv", b"curv2", b"surf"];

/// Normals by the corners that name them.
#[derive(Default)]
struct Normals {
    all: Vec<[f64; 3]>,
    /// The normal of each vertex, as far as corners have named one.
    of_vertex: Vec<Option<u32>>,
    /// True if the corners of a vertex disagree.
    differ: bool,
}

pub(super) fn read(mesh: &mut MeshBuilder<'_>, stream: Box<dyn BufRead>) -> Result<(), Error> {
    mesh.first = 1;
    let mut lines = mesh.lines(stream, 0).joined();
    let mut normals = Normals::default();
    let (mut promised, mut simplices) = (None, 0);
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    while lines.advance(mesh)? {
        let Some(Line { at, words: line, comment }) = lines.current() else { break };
        let mut rest = words(line);
        match rest.next() {
            None => promised = promised.or(counts(comment)),
            Some(b"v") => {
                numbers(mesh, at, rest, &mut values)?;
                read_vertex(mesh, at, &values)?;
            }
            Some(b"vn") => {
                numbers(mesh, at, rest, &mut values)?;
                let &[x, y, z] = &values[..] else {
                    let problem = format!("a normal has {} values, not 3", values.len());
                    return Err(mesh.damaged(at, problem));
                };
                if normals.all.len() >= u32::MAX as usize {
                    return Err(mesh.damaged(at, "there are more normals than ids of 32 bits"));
                }
                normals.all.push(mesh.finite(at, "normal", [x, y, z])?);
            }
            Some(b"p" | b"l") if !mesh.is_triangulation() => simplices += 1,
            Some(keyword @ (b"p" | b"l" | b"f")) => {
                corners.clear();
                for word in rest {
                    corners.push(read_corner(mesh, at, word, &mut normals)?);
                }
                let known = mesh.vertices.len() as u64;
                match keyword {
                    b"p" => mesh.simplex(at, &corners, 1, known)?,
                    b"l" => mesh.simplex(at, &corners, 2, known)?,
                    _ => mesh.polygon(at, &corners, known)?,
                }
                simplices += 1;
            }
            Some(keyword) if PASSED_OVER.contains(&keyword) => {}
            Some(keyword) if FREE_FORM.contains(&keyword) => {
                return Err(mesh.unsupported(at, "it is a free-form curve or surface"));
            }
            Some(keyword) => {
                let keyword = printable(keyword);
                return Err(mesh.damaged(at, format!("`{keyword}` is no keyword of obj files")));
            }
        }
    }
    if let Some((vertices, promised)) = promised {
        mesh.expect("vertices", vertices, mesh.vertices.len() as u64)?;
        mesh.expect("simplices", promised, simplices)?;
        if lines.cut() {
            return Err(mesh.damaged(FilePlace::File, "its last line has no end"));
        }
    }
    mesh.normals = normals.by_vertex(mesh.vertices.len());
    Ok(())
}

fn numbers<'a>(
    mesh: &MeshBuilder<'_>,
    at: FilePlace,
    words: impl Iterator<Item = &'a [u8]>,
    values: &mut Vec<f64>,
) -> Result<(), Error> {
    values.clear();
    for word in words {
        values.push(mesh.number(at, word)?);
    }
    Ok(())
}

/// Coordinates, then nothing, a weight, a color, or a color and its opacity.
fn read_vertex(mesh: &mut MeshBuilder<'_>, at: FilePlace, values: &[f64]) -> Result<(), Error> {
    match *values {
        [x, y, z] | [x, y, z, _] => mesh.vertex(at, [x, y, z]),
        [x, y, z, r, g, b] | [x, y, z, r, g, b, _] => {
            mesh.vertex(at, [x, y, z])?;
            // Fractions, whatever the numbers look like.
            mesh.color(at, [r, g, b], true)
        }
        _ => {
            let problem = format!("a vertex has {} values, which is none of obj", values.len());
            Err(mesh.damaged(at, problem))
        }
    }
}

/// The vertex of a corner, from 0; its normal is noted.
fn read_corner(
    mesh: &MeshBuilder<'_>,
    at: FilePlace,
    word: &[u8],
    normals: &mut Normals,
) -> Result<i64, Error> {
    let no_corner = || {
        let word = printable(word);
        mesh.damaged(at, format!("`{word}` is no corner of a face"))
    };
    let mut parts = word.split(|&byte| byte == b'/');
    let vertex = parts.next().and_then(whole).ok_or_else(no_corner)?;
    let vertex = from_zero(vertex, mesh.vertices.len());
    parts.next();
    if let Some(part) = parts.next() {
        let id = whole(part).ok_or_else(no_corner)?;
        let known = normals.all.len();
        let normal = usize::try_from(from_zero(id, known)).ok().filter(|&normal| normal < known);
        let Some(normal) = normal else {
            return Err(mesh.damaged(at, format!("it names normal {id}, but there are {known}")));
        };
        if let Some(vertex) = usize::try_from(vertex).ok().filter(|&v| v < mesh.vertices.len()) {
            normals.note(vertex, normal as u32);
        }
    }
    match parts.next() {
        None => Ok(vertex),
        Some(_) => Err(no_corner()),
    }
}

/// A number counted from 1, or back from the last of `known`, as one from 0; it may be none of them.
fn from_zero(id: i64, known: usize) -> i64 {
    if id < 0 { id.saturating_add(known as i64) } else { id - 1 }
}

impl Normals {
    /// A corner at `vertex` has this normal.
    fn note(&mut self, vertex: usize, normal: u32) {
        if self.of_vertex.len() <= vertex {
            self.of_vertex.resize(vertex + 1, None);
        }
        let first = *self.of_vertex[vertex].get_or_insert(normal);
        self.differ |= self.all[first as usize] != self.all[normal as usize];
    }

    /// The normal of each of `n` vertices; none of all where one has none or several.
    fn by_vertex(mut self, n: usize) -> Vec<[f64; 3]> {
        if self.differ || self.all.is_empty() {
            return Vec::new();
        }
        if self.of_vertex.is_empty() && self.all.len() == n {
            return self.all;
        }
        self.of_vertex.resize(n, None);
        let same_number = self.all.len() == n;
        let found = self.of_vertex.iter().enumerate().map(|(vertex, normal)| match normal {
            Some(normal) => Some(self.all[*normal as usize]),
            None => self.all.get(vertex).copied().filter(|_| same_number),
        });
        found.collect::<Option<Vec<_>>>().unwrap_or_default()
    }
}

/// Returns what our comment promises: vertices and simplices.
fn counts(comment: &[u8]) -> Option<(u64, u64)> {
    let text = std::str::from_utf8(comment).ok()?;
    let (vertices, simplices) = text.strip_prefix("# ")?.split_once(" vertices, ")?;
    Some((vertices.parse().ok()?, simplices.strip_suffix(" simplices")?.parse().ok()?))
}

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (normals, colors) = (job.mesh.normals, job.mesh.colors);
    let (vertices, simplices) = (job.mesh.vertex_count(), job.mesh.simplex_count());
    out.put(format!("# {vertices} vertices, {simplices} simplices\n").as_bytes())?;
    job.each_vertex(out, |i, at, bytes| {
        bytes.extend_from_slice(b"v ");
        put_numbers(at, b" ", bytes);
        for byte in colors.map(|colors| colors[i]).into_iter().flatten() {
            bytes.push(b' ');
            put_number(fraction(byte), bytes);
        }
        bytes.push(b'\n');
    })?;
    out.each(normals.unwrap_or_default(), |&normal, bytes| {
        bytes.extend_from_slice(b"vn ");
        put_place(normal, bytes);
    })?;
    job.each_simplex(out, |ids, bytes| {
        bytes.extend_from_slice(KEYWORDS[ids.len() - 1]);
        for &id in ids {
            bytes.push(b' ');
            put_whole(u64::from(id) + 1, bytes);
            if normals.is_some() {
                bytes.extend_from_slice(b"//");
                put_whole(u64::from(id) + 1, bytes);
            }
        }
        bytes.push(b'\n');
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn only_our_comment_promises() {
        assert_eq!(super::counts(b"# 5 vertices, 4 simplices"), Some((5, 4)));
        for other in ["#", "# 5 vertices", "# x vertices, 4 simplices", "#5 vertices, 4 simplices"]
        {
            assert_eq!(super::counts(other.as_bytes()), None, "{other}");
        }
    }
}
