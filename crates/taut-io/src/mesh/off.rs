//! Object File Format: `OFF`, the counts, then vertices and faces, a line each.
//!
//! Letters before `OFF` say what a vertex has after its coordinates, in this order: `N` a normal, `C` a color, and
//! first of all letters but last of all values `ST` a place in a texture, which is passed over. Colors of three or four
//! values are read without the letter too, as many programs write them so.
//! *Reference.* Geomview manual, section OFF.

use std::io::BufRead;

use super::writing::Job;
use super::{MeshBuilder, printable};
use crate::words::{Lines, put_ids, put_number, put_numbers, whole, words};
use crate::write::OutputFile;
use crate::{Error, FilePlace};

/// The meaning of the letters before `OFF`.
struct Letters {
    texture: bool,
    color: bool,
    normal: bool,
}

pub(super) fn read(mesh: &mut MeshBuilder<'_>, stream: Box<dyn BufRead>) -> Result<(), Error> {
    let mut lines = mesh.lines(stream, 0);
    let (at, line) = next(&mut lines, mesh, || "its first line".into())?;
    let mut rest = words(line);
    let word = rest.next().unwrap_or_default();
    let letters = letters(mesh, at, word)?;
    // Some programs write the counts on the first line.
    let rest: Vec<&[u8]> = rest.collect();
    if rest == [b"BINARY"] {
        return Err(mesh.unsupported(at, "it is binary"));
    }
    let mut counts: Vec<Option<i64>> = rest.into_iter().map(whole).collect();
    let mut place = at;
    if counts.is_empty() {
        let (at, line) = next(&mut lines, mesh, || "its counts".into())?;
        counts = words(line).map(whole).collect();
        place = at;
    }
    let (vertices, faces) = match counts[..] {
        [Some(vertices @ 0..), Some(faces @ 0..), Some(_)]
        | [Some(vertices @ 0..), Some(faces @ 0..)] => (vertices as u64, faces as u64),
        _ => return Err(mesh.damaged(place, "it does not count vertices, faces and edges")),
    };
    let mut values = Vec::new();
    for vertex in 0..vertices {
        let (at, line) = next(&mut lines, mesh, || format!("vertex {vertex} of {vertices}"))?;
        read_vertex(mesh, &letters, at, line, &mut values)?;
    }
    let mut numbers = Vec::new();
    for face in 0..faces {
        let (at, line) = next(&mut lines, mesh, || format!("face {face} of {faces}"))?;
        numbers.clear();
        numbers.extend(words(line).map_while(whole));
        let Some((&width, rest)) = numbers.split_first() else {
            return Err(mesh.damaged(at, "a face begins with the number of its vertices"));
        };
        // What follows the ids is a color of the face.
        let corners = usize::try_from(width).ok().and_then(|width| rest.get(..width));
        let corners = corners.ok_or_else(|| {
            let problem =
                format!("a face says {width} vertices, but {} numbers follow", rest.len());
            mesh.damaged(at, problem)
        })?;
        match (mesh.is_triangulation(), corners.len()) {
            (true, width @ 1..=3) => mesh.simplex(at, corners, width, vertices)?,
            _ => mesh.polygon(at, corners, vertices)?,
        }
    }
    lines.skip_comments(mesh)?;
    match lines.current() {
        Some(line) => Err(mesh.damaged(line.at, "there is more than the counts say")),
        None => Ok(()),
    }
}

/// The next line that is not only a comment; `what` is missing where there is none.
fn next<'a>(
    lines: &'a mut Lines,
    mesh: &MeshBuilder<'_>,
    what: impl Fn() -> String,
) -> Result<(FilePlace, &'a [u8]), Error> {
    lines.skip_comments(mesh)?;
    match lines.current() {
        Some(line) => Ok((line.at, line.words)),
        None => Err(mesh.damaged(FilePlace::File, format!("it ends before {}", what()))),
    }
}

fn letters(mesh: &MeshBuilder<'_>, at: FilePlace, word: &[u8]) -> Result<Letters, Error> {
    let shown = || printable(word);
    let before = word
        .strip_suffix(b"OFF")
        .ok_or_else(|| mesh.damaged(at, format!("the first word is `{}`, not `OFF`", shown())))?;
    let (texture, before) = match before.strip_prefix(b"ST") {
        Some(before) => (true, before),
        None => (false, before),
    };
    let (color, normal) = match before {
        b"" => (false, false),
        b"C" => (true, false),
        b"N" => (false, true),
        b"CN" | b"NC" => (true, true),
        _ => return Err(mesh.unsupported(at, format!("it begins with `{}`", shown()))),
    };
    Ok(Letters { texture, color, normal })
}

fn read_vertex(
    mesh: &mut MeshBuilder<'_>,
    letters: &Letters,
    at: FilePlace,
    line: &[u8],
    values: &mut Vec<f64>,
) -> Result<(), Error> {
    values.clear();
    let (base, end) = (3 + 3 * usize::from(letters.normal), 2 * usize::from(letters.texture));
    let mut fraction = false;
    for word in words(line) {
        fraction |= values.len() >= base && word.contains(&b'.');
        values.push(mesh.number(at, word)?);
    }
    let color = match values.len().checked_sub(base + end) {
        Some(0) if !letters.color => false,
        Some(3 | 4) => true,
        _ => {
            let problem = format!("a vertex has {} values, which is none of OFF", values.len());
            return Err(mesh.damaged(at, problem));
        }
    };
    mesh.vertex(at, [values[0], values[1], values[2]])?;
    if letters.normal {
        mesh.normal(at, [values[3], values[4], values[5]])?;
    }
    match color {
        true => mesh.color(at, [values[base], values[base + 1], values[base + 2]], fraction),
        false => Ok(()),
    }
}

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (normals, colors) = (job.mesh.normals, job.mesh.colors);
    let word = match (colors, normals) {
        (None, None) => "OFF",
        (Some(_), None) => "COFF",
        (None, Some(_)) => "NOFF",
        (Some(_), Some(_)) => "CNOFF",
    };
    let (vertices, faces) = (job.mesh.vertex_count(), job.mesh.simplex_count());
    out.put(format!("{word}\n{vertices} {faces} 0\n").as_bytes())?;
    job.each_vertex(out, |i, at, bytes| {
        put_numbers(at, b" ", bytes);
        if let Some(normals) = normals {
            bytes.push(b' ');
            put_numbers(normals[i], b" ", bytes);
        }
        // Four values, the last of which says that the color is opaque: some programs want no fewer.
        for value in colors.map(|colors| colors[i]).into_iter().flatten() {
            bytes.push(b' ');
            put_number(value.into(), bytes);
        }
        bytes.extend_from_slice(if colors.is_some() { b" 255\n" } else { b"\n" });
    })?;
    job.each_simplex(out, |ids, bytes| {
        bytes.push(b'0' + ids.len() as u8);
        put_ids(ids, 0, bytes);
    })
}
