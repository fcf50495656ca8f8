//! Wavefront OBJ: `v x y z`, then `p`, `l` or `f` with ids from 1.
//!
//! *Trap.* The format says nowhere how much there is, so a file cut at the end of a line would pass for a smaller mesh.
//! A comment of ours at its top tells the counts, and where it stands they must hold.

use std::io::BufRead;

use super::reading::Building;
use super::writing::Job;
use crate::Error;
use crate::error::Refuse;
use crate::words::{Line, Lines, place, put_ids, put_place, whole, words};
use crate::write::Out;

/// The keyword for simplices of so many vertices.
const KEYWORDS: [&str; 3] = ["p", "l", "f"];

pub(super) fn write(job: &Job<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    out.put(format!("# {} vertices, {} simplices\n", job.vertices(), job.len()).as_bytes())?;
    job.each_vertex(out, |at, bytes| {
        bytes.extend_from_slice(b"v ");
        put_place(at, bytes);
    })?;
    let keyword = KEYWORDS[job.width - 1].as_bytes();
    job.each_simplex(out, |ids, bytes| {
        bytes.extend_from_slice(keyword);
        put_ids(ids, 1, bytes);
    })
}

pub(super) fn read(mesh: &mut Building<'_>, stream: Box<dyn BufRead>) -> Result<(), Error> {
    let mut lines = Lines::new(stream);
    let mut promised = None;
    mesh.first = 1;
    let mut ids = Vec::new();
    while lines.advance(mesh)? {
        let Some(Line { at, words: line, comment }) = lines.current() else { break };
        if line.is_empty() {
            promised = promised.or(counts(comment));
            continue;
        }
        let mut rest = words(line);
        let keyword = rest.next().unwrap_or_default();
        match keyword {
            b"v" => {
                let vertex = place(mesh, at, rest)?;
                mesh.vertex(at, vertex)?;
            }
            b"p" | b"l" | b"f" => {
                ids.clear();
                for word in rest {
                    // What follows a slash are texture and normal.
                    let id = whole(word.split(|&b| b == b'/').next().unwrap_or_default());
                    let id = id.ok_or_else(|| mesh.damaged(at, "an id is no whole number"))?;
                    // From 1, or counted back from the last vertex.
                    let back = mesh.vertices.len() as i64;
                    ids.push(if id < 0 { id.saturating_add(back) } else { id.saturating_sub(1) });
                }
                let wanted = KEYWORDS.iter().position(|k| k.as_bytes() == keyword).map(|k| k + 1);
                if wanted != Some(ids.len()) {
                    let (found, keyword) = (ids.len(), String::from_utf8_lossy(keyword));
                    return Err(mesh.kind(at, format!("`{keyword}` has {found} vertices")));
                }
                mesh.simplex(at, &ids)?;
            }
            // Normals, textures, materials and groups are no part of the mesh.
            b"vn" | b"vt" | b"vp" | b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" => {}
            _ => return Err(mesh.damaged(at, "it begins with no keyword of obj files")),
        }
    }
    match promised {
        Some((vertices, simplices)) => {
            mesh.expect("vertices", vertices, mesh.vertices.len() as u64)?;
            mesh.expect("simplices", simplices, mesh.len())
        }
        None => Ok(()),
    }
}

/// What our comment promises: vertices and simplices.
pub(crate) fn counts(comment: &[u8]) -> Option<(u64, u64)> {
    let text = std::str::from_utf8(comment).ok()?;
    let (vertices, simplices) = text.strip_prefix("# ")?.split_once(" vertices, ")?;
    Some((vertices.parse().ok()?, simplices.strip_suffix(" simplices")?.parse().ok()?))
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
