//! Object File Format: `OFF`, the counts, then vertices and faces a line each.

use std::io::BufRead;

use super::reading::Building;
use super::writing::Job;
use crate::error::Refuse;
use crate::words::{Lines, place, put_ids, put_place, whole, words};
use crate::write::Out;
use crate::{Error, MeshPlace};

pub(super) fn write(job: &Job<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    out.put(format!("OFF\n{} {} 0\n", job.vertices(), job.len()).as_bytes())?;
    job.each_vertex(out, put_place)?;
    let width = b'0' + job.width as u8;
    job.each_simplex(out, |ids, bytes| {
        bytes.push(width);
        put_ids(ids, 0, bytes);
    })
}

/// The next line that is not only a comment; `what` is missing where there is none.
fn next<'a>(
    lines: &'a mut Lines,
    mesh: &Building<'_>,
    what: impl Fn() -> String,
) -> Result<(MeshPlace, &'a [u8]), Error> {
    lines.skip_comments(mesh)?;
    match lines.current() {
        Some(line) => Ok((line.at, line.words)),
        None => Err(mesh.damaged(MeshPlace::File, format!("it ends before {}", what()))),
    }
}

pub(super) fn read(mesh: &mut Building<'_>, stream: Box<dyn BufRead>) -> Result<(), Error> {
    let mut lines = Lines::new(stream);
    let (at, line) = next(&mut lines, mesh, || "its first line".into())?;
    if line != b"OFF" {
        return Err(mesh.damaged(at, "the first line is not `OFF`"));
    }
    let (at, line) = next(&mut lines, mesh, || "its counts".into())?;
    let counts: Option<Vec<u64>> =
        words(line).map(|word| whole(word).and_then(|count| count.try_into().ok())).collect();
    let (vertices, faces) = match counts.as_deref() {
        Some(&[vertices, faces, _] | &[vertices, faces]) => (vertices, faces),
        _ => return Err(mesh.damaged(at, "it does not count vertices, faces and edges")),
    };
    for vertex in 0..vertices {
        let (at, line) = next(&mut lines, mesh, || format!("vertex {vertex} of {vertices}"))?;
        let found = place(mesh, at, words(line))?;
        mesh.vertex(at, found)?;
    }
    let mut numbers = Vec::new();
    for face in 0..faces {
        let (at, line) = next(&mut lines, mesh, || format!("face {face} of {faces}"))?;
        numbers.clear();
        numbers.extend(words(line).map_while(whole));
        let Some((&width, rest)) = numbers.split_first() else {
            return Err(mesh.damaged(at, "a face begins with the number of its vertices"));
        };
        // What follows the ids is a colour.
        let ids = usize::try_from(width).ok().and_then(|width| rest.get(..width));
        let ids = ids.ok_or_else(|| mesh.damaged(at, "a face has fewer ids than it says"))?;
        if !(1..=3).contains(&ids.len()) {
            return Err(mesh.kind(at, format!("a face has {} vertices", ids.len())));
        }
        mesh.simplex(at, ids)?;
    }
    lines.skip_comments(mesh)?;
    match lines.current() {
        Some(line) => Err(mesh.damaged(line.at, "there is more than the counts say")),
        None => Ok(()),
    }
}
