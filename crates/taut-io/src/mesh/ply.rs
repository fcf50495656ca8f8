//! Simplices in Stanford PLY: a header of text that declares elements, then their values in binary.
//!
//! Triangles are elements `face`, as everywhere; edges are elements `edge` with two ids, tetrahedra elements `tetra` with
//! a list of four, and single points elements `point` with a list of one.

use super::reading::Building;
use super::writing::Job;
use crate::cursor::Cursor;
use crate::error::Refuse;
use crate::ply::{self, Element, Encoding, printable};
use crate::write::Out;
use crate::{Error, MeshPlace};

/// The element of simplices of so many vertices.
const ELEMENTS: [&str; 4] = ["point", "edge", "face", "tetra"];

pub(super) fn write(job: &Job<'_>, out: &mut Out<'_>) -> Result<(), Error> {
    // Few programs read unsigned ids, so they are unsigned only where they must be.
    let id = if job.vertices() <= i32::MAX as u64 { "int" } else { "uint" };
    let ids = match job.width {
        2 => format!("property {id} vertex1\nproperty {id} vertex2\n"),
        _ => format!("property list uchar {id} vertex_indices\n"),
    };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Vertices are the points in their order, from 0.\n\
         element vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element {} {}\n{ids}end_header\n",
        job.vertices(),
        ELEMENTS[job.width - 1],
        job.len(),
    );
    out.put(header.as_bytes())?;
    job.each_vertex(out, |at, bytes| at.iter().for_each(|x| bytes.extend(x.to_le_bytes())))?;
    let length = (job.width != 2).then_some(job.width as u8);
    job.each_simplex(out, |ids, bytes| {
        bytes.extend(length);
        ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
    })
}

pub(super) fn read(mesh: &mut Building<'_>, cursor: &mut Cursor<'_>) -> Result<(), Error> {
    let header = ply::header(mesh, cursor)?;
    if header.encoding != Encoding::LittleEndian {
        return Err(mesh.kind(header.at, format!("the format is `{}`", header.encoding.word())));
    }
    for element in header.elements {
        match ELEMENTS.iter().find(|&&known| known == element.name) {
            _ if element.name == "vertex" => read_vertices(mesh, cursor, &element)?,
            Some(known) => read_simplices(mesh, cursor, &element, known)?,
            None if element.count == 0 => {}
            None => {
                let problem = format!("there are elements `{}`", printable(&element.name));
                return Err(mesh.kind(MeshPlace::File, problem));
            }
        }
    }
    match cursor.rest(1)?.is_empty() {
        true => Ok(()),
        false => Err(mesh.damaged(MeshPlace::File, "it goes on after its last element")),
    }
}

fn read_vertices(
    mesh: &mut Building<'_>,
    cursor: &mut Cursor<'_>,
    element: &Element,
) -> Result<(), Error> {
    for axis in ["x", "y", "z"] {
        if !element.properties.iter().any(|p| p.name == axis && p.length.is_none()) {
            let problem = format!("its vertices have no property `{axis}`");
            return Err(mesh.damaged(MeshPlace::File, problem));
        }
    }
    for number in 0..element.count {
        let place = MeshPlace::Element("vertex", number);
        let mut at = [0.0; 3];
        for property in &element.properties {
            match (property.length, ["x", "y", "z"].iter().position(|axis| property.name == *axis))
            {
                (None, Some(axis)) => at[axis] = cursor.real(property.kind, mesh, place)?,
                _ => ply::skip(mesh, cursor, property, place)?,
            }
        }
        mesh.vertex(place, at)?;
    }
    Ok(())
}

fn read_simplices(
    mesh: &mut Building<'_>,
    cursor: &mut Cursor<'_>,
    element: &Element,
    name: &'static str,
) -> Result<(), Error> {
    let width = ELEMENTS.iter().position(|&known| known == name).map_or(0, |place| place + 1);
    let mut ids = Vec::with_capacity(width);
    for number in 0..element.count {
        let place = MeshPlace::Element(name, number);
        ids.clear();
        for property in &element.properties {
            match (property.length, property.name.as_str()) {
                (Some(length), "vertex_indices" | "vertex_index") => {
                    let count = cursor.whole(length, mesh, place)?;
                    if count != width as i64 {
                        return Err(mesh.kind(place, format!("it has {count} vertices")));
                    }
                    for _ in 0..count {
                        ids.push(cursor.whole(property.kind, mesh, place)?);
                    }
                }
                (None, "vertex1" | "vertex2") => {
                    ids.push(cursor.whole(property.kind, mesh, place)?);
                }
                _ => ply::skip(mesh, cursor, property, place)?,
            }
        }
        if ids.len() != width {
            let found = ids.len();
            return Err(mesh.damaged(place, format!("it names {found} vertices, not {width}")));
        }
        mesh.simplex(place, &ids)?;
    }
    Ok(())
}
