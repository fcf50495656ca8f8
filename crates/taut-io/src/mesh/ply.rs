//! Stanford PLY: a header of text that declares elements, then their values in binary.
//!
//! Triangles are elements `face`, as everywhere; edges are elements `edge` with two ids, tetrahedra elements `tetra` with
//! a list of four, and single points elements `point` with a list of one.

use super::cursor::{Cursor, Kind};
use super::reading::Building;
use super::writing::Job;
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

/// A property as the header declares it.
struct Property {
    name: String,
    kind: Kind,
    /// How the length is stored, where it is a list.
    length: Option<Kind>,
}

/// An element as the header declares it.
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

pub(super) fn read(mesh: &mut Building<'_>, cursor: &mut Cursor<'_>) -> Result<(), Error> {
    for element in header(mesh, cursor)? {
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

fn header(mesh: &Building<'_>, cursor: &mut Cursor<'_>) -> Result<Vec<Element>, Error> {
    let mut elements: Vec<Element> = Vec::new();
    let mut binary = false;
    for number in 1.. {
        let at = MeshPlace::Line(number);
        let line = cursor.line()?.ok_or_else(|| mesh.damaged(at, "the header does not end"))?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err(mesh.damaged(at, "the first line is not `ply`")),
            ["format", "binary_little_endian", "1.0"] => binary = true,
            ["format", other, ..] => {
                return Err(mesh.kind(at, format!("the format is `{}`", printable(other))));
            }
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => {
                let count = count
                    .parse()
                    .map_err(|_| mesh.damaged(at, "the count of an element is no whole number"))?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref property @ ..] => {
                let element = elements
                    .last_mut()
                    .ok_or_else(|| mesh.damaged(at, "a property stands before any element"))?;
                let found = match *property {
                    ["list", length, each, name] => kind(length)
                        .zip(kind(each))
                        .map(|(l, k)| Property { name: name.to_owned(), kind: k, length: Some(l) }),
                    [each, name] => kind(each).map(|k| Property {
                        name: name.to_owned(),
                        kind: k,
                        length: None,
                    }),
                    _ => None,
                };
                let found =
                    found.ok_or_else(|| mesh.damaged(at, "a property is of no known type"))?;
                element.properties.push(found);
            }
            ["end_header"] => break,
            _ => return Err(mesh.damaged(at, "it is no line of a header")),
        }
    }
    if !binary {
        return Err(mesh.damaged(MeshPlace::File, "the header names no format"));
    }
    match elements.iter().find(|element| element.count > 0 && element.properties.is_empty()) {
        Some(element) => {
            let problem = format!("elements `{}` have no properties", printable(&element.name));
            Err(mesh.damaged(MeshPlace::File, problem))
        }
        None => Ok(elements),
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
                _ => skip(mesh, cursor, property, place)?,
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
                _ => skip(mesh, cursor, property, place)?,
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

fn skip(
    mesh: &Building<'_>,
    cursor: &mut Cursor<'_>,
    property: &Property,
    place: MeshPlace,
) -> Result<(), Error> {
    let count = match property.length {
        None => 1,
        Some(length) => u64::try_from(cursor.whole(length, mesh, place)?)
            .map_err(|_| mesh.damaged(place, "a list has a negative length"))?,
    };
    cursor.skip(count.saturating_mul(property.kind.size() as u64), mesh, place)
}

/// The types of values, under either of their two names.
fn kind(name: &str) -> Option<Kind> {
    Some(match name {
        "char" | "int8" => Kind::I8,
        "uchar" | "uint8" => Kind::U8,
        "short" | "int16" => Kind::I16,
        "ushort" | "uint16" => Kind::U16,
        "int" | "int32" => Kind::I32,
        "uint" | "uint32" => Kind::U32,
        "float" | "float32" => Kind::F32,
        "double" | "float64" => Kind::F64,
        _ => return None,
    })
}

/// A word of the file as messages show it.
fn printable(word: &str) -> String {
    word.chars().take(40).flat_map(char::escape_default).collect()
}
