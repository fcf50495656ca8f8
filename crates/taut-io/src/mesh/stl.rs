//! Stereolithography: triangles, each with its three corners, as text or in binary.
//!
//! *Idea.* Binary is 80 bytes of anything, the number of triangles as 4 bytes, then 50 bytes for each: a normal and three
//! corners in single precision, and two bytes that mean nothing. Text says `solid` first, and so do some binary files:
//! what holds a byte that no text has among its first ones is binary.
//! *Guarantee.* Corners with equal coordinates are one vertex, and no others: 0 and −0 are equal, nothing else is. Vertices
//! are numbered as they come.
//! *Trap.* Vertices that differ in double precision only are one in a binary file, which can close a gap and flatten a
//! triangle. Vertices that no triangle uses, and normals, which are those of triangles, are not kept.
//! *Reference.* 3D Systems, Stereolithography interface specification, 1989.

use std::collections::HashMap;
use std::io::{BufRead, Read};

use super::normal::unit_normal;
use super::writing::{Encoding, Job};
use super::{MeshBuilder, printable};
use crate::cursor::Cursor;
use crate::words::{put_place, words};
use crate::write::OutputFile;
use crate::{Error, FilePlace};

/// This many bytes are looked at to tell text from binary: the head of a binary file and nine triangles.
const SNIFFED_BYTES: u64 = 84 + 9 * 50;

/// Bytes before the count of triangles.
const HEAD: u64 = 80;

/// Vertices by the bits of their coordinates.
#[derive(Default)]
struct Weld {
    ids: HashMap<[u64; 3], u32>,
}

impl Weld {
    /// The number of the vertex at this place, a new one if there is none.
    fn id(
        &mut self,
        mesh: &mut MeshBuilder<'_>,
        place: FilePlace,
        at: [f64; 3],
    ) -> Result<i64, Error> {
        // Adding 0 turns −0 into 0.
        let bits = at.map(|x| (x + 0.0).to_bits());
        if let Some(&id) = self.ids.get(&bits) {
            return Ok(id.into());
        }
        let id = mesh.vertices.len();
        mesh.vertex(place, at)?;
        self.ids.insert(bits, id as u32);
        Ok(id as i64)
    }
}

pub(super) fn read(
    mesh: &mut MeshBuilder<'_>,
    mut stream: Box<dyn BufRead>,
    path: &str,
) -> Result<(), Error> {
    let mut head = Vec::new();
    (&mut stream)
        .take(SNIFFED_BYTES)
        .read_to_end(&mut head)
        .map_err(|source| Error::reading(path, source))?;
    let text = is_text(&head);
    let whole = Box::new(std::io::Cursor::new(head).chain(stream));
    match text {
        true => read_text(mesh, whole),
        false => read_binary(mesh, Cursor::new(whole, path)),
    }
}

fn is_text(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = head.trim_ascii_start().get(..5).unwrap_or_default();
    let printed = |&byte: &u8| byte >= b' ' || byte.is_ascii_whitespace();
    first.eq_ignore_ascii_case(b"solid") && head.iter().all(printed)
}

fn read_binary(mesh: &mut MeshBuilder<'_>, mut cursor: Cursor<'_>) -> Result<(), Error> {
    cursor.skip(HEAD, mesh, FilePlace::File)?;
    let mut count = [0; 4];
    cursor.fill(&mut count, mesh, FilePlace::File)?;
    let mut weld = Weld::default();
    let mut record = [0; 50];
    for facet in 0..u64::from(u32::from_le_bytes(count)) {
        let place = FilePlace::Element("facet", facet);
        cursor.fill(&mut record, mesh, place)?;
        let mut corners = [0; 3];
        for (corner, bytes) in corners.iter_mut().zip(record[12..48].chunks_exact(12)) {
            let real = |k: usize| {
                let bytes = [bytes[4 * k], bytes[4 * k + 1], bytes[4 * k + 2], bytes[4 * k + 3]];
                f64::from(f32::from_le_bytes(bytes))
            };
            *corner = weld.id(mesh, place, [real(0), real(1), real(2)])?;
        }
        let known = mesh.vertices.len() as u64;
        mesh.polygon(place, &corners, known)?;
    }
    match cursor.rest(1)?.is_empty() {
        true => Ok(()),
        false => {
            let problem = format!("it promises {} facets, but goes on after them", mesh.len());
            Err(mesh.damaged(FilePlace::File, problem))
        }
    }
}

fn read_text(mesh: &mut MeshBuilder<'_>, stream: Box<dyn BufRead>) -> Result<(), Error> {
    let mut lines = mesh.lines(stream, 0);
    let mut weld = Weld::default();
    let mut corners: Vec<i64> = Vec::new();
    // The words that the next line may begin with; of a loop, the corners are counted.
    let mut expected: &[&str] = &["solid"];
    while lines.advance(mesh)? {
        let at = lines.place();
        let mut rest = words(lines.bytes());
        let keyword = rest.next().unwrap_or_default();
        let Some(&keyword) =
            expected.iter().find(|known| keyword.eq_ignore_ascii_case(known.as_bytes()))
        else {
            let keyword = printable(keyword);
            let wanted = expected.join("` or `");
            return Err(mesh.damaged(at, format!("it begins with `{keyword}`, not `{wanted}`")));
        };
        expected = match keyword {
            "solid" | "endfacet" => &["facet", "endsolid"],
            "facet" => &["outer"],
            "outer" => &["vertex"],
            "vertex" => {
                let found = read_vertex(mesh, at, rest)?;
                corners.push(weld.id(mesh, at, found)?);
                if corners.len() < 3 { &["vertex"] } else { &["endloop"] }
            }
            "endloop" => {
                let known = mesh.vertices.len() as u64;
                mesh.polygon(at, &corners, known)?;
                corners.clear();
                &["endfacet"]
            }
            // A file may hold several solids.
            _ => &["solid"],
        };
    }
    match expected {
        ["solid"] => Ok(()),
        _ => {
            let problem = format!("it ends where `{}` was expected", expected.join("` or `"));
            Err(mesh.damaged(FilePlace::File, problem))
        }
    }
}

/// Three coordinates; further numbers are passed over.
fn read_vertex<'a>(
    mesh: &MeshBuilder<'_>,
    at: FilePlace,
    words: impl Iterator<Item = &'a [u8]>,
) -> Result<[f64; 3], Error> {
    let (mut found, mut count) = ([0.0; 3], 0);
    for word in words {
        let value = mesh.number(at, word)?;
        if let Some(slot) = found.get_mut(count) {
            *slot = value;
        }
        count += 1;
    }
    match count {
        3.. => Ok(found),
        _ => Err(mesh.damaged(at, "a vertex needs three numbers")),
    }
}

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (vertices, triangles) = (job.mesh.places(), job.mesh.triangles());
    let corners = |ids: &[u32; 3]| ids.map(|id| vertices[id as usize]);
    if job.encoding == Encoding::Text {
        // Without a name, some programs do not take it for text.
        out.put(b"solid shape\n")?;
        out.each(triangles, |ids, bytes| {
            let corners = corners(ids);
            bytes.extend_from_slice(b"facet normal ");
            put_place(unit_normal(corners).unwrap_or_default(), bytes);
            bytes.extend_from_slice(b"outer loop\n");
            for corner in corners {
                bytes.extend_from_slice(b"vertex ");
                put_place(corner, bytes);
            }
            bytes.extend_from_slice(b"endloop\nendfacet\n");
        })?;
        return out.put(b"endsolid shape\n");
    }
    // The head must not begin with `solid`, which would be taken for text.
    let mut head = [b' '; HEAD as usize];
    head[..10].copy_from_slice(b"binary stl");
    out.put(&head)?;
    out.put(&(triangles.len() as u32).to_le_bytes())?;
    out.each(triangles, |ids, bytes| {
        let corners = corners(ids);
        let normal = unit_normal(corners).unwrap_or_default();
        let values = normal.iter().chain(corners.as_flattened());
        values.for_each(|&value| bytes.extend((value as f32).to_le_bytes()));
        bytes.extend([0, 0]);
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_binary_file_may_call_itself_solid() {
        assert!(is_text(b"solid\nfacet normal 0 0 1\n"));
        assert!(is_text(b" \r\n\tSOLID caf\xc3\xa9"));
        assert!(is_text(b"\xef\xbb\xbfsolid\n"));
        assert!(!is_text(b"solid\0\0\0"));
        assert!(!is_text(b"soli"));
        let mut binary = [b' '; 84];
        binary[..5].copy_from_slice(b"solid");
        binary[80..].copy_from_slice(&12_u32.to_le_bytes());
        assert!(!is_text(&binary));
    }
}
