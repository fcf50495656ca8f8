//! Stanford PLY: elements `vertex` with `x`, `y`, `z`, and elements `face` with a list of vertices.
//!
//! Normals are `nx`, `ny`, `nz`, colors `red`, `green`, `blue`; all other properties are passed over. A triangulation has
//! elements `edge` with two ids, `face` with a list of three, `tetra` with a list of four, or `point` with a list of one, and no
//! others. Of a surface all other elements are passed over, except triangle strips, which hold what is asked for and are refused.
//!
//! *Trap.* Faces may stand before the vertices they name, so corners are compared with the number of vertices that the
//! header promises; that there are as many is known when they have been read.

mod header;
mod values;

use super::writing::{Encoding, Job};
use super::{MeshBuilder, MeshView, Vertices, printable};
use crate::cursor::{Cursor, Kind};
use crate::words::{put_number, put_numbers, put_whole};
use crate::write::OutputFile;
use crate::{Error, FilePlace};
use header::Element;
use values::Values;

/// The element of simplices of so many vertices.
const ELEMENTS: [&str; 4] = ["point", "edge", "face", "tetra"];

/// The role of the property of a vertex, by its name.
#[derive(Clone, Copy)]
enum Role {
    Place(usize),
    Normal(usize),
    Color(usize),
    Other,
}

impl Role {
    fn of(name: &str) -> Role {
        let among = |names: [&str; 3]| names.iter().position(|&known| known == name);
        None.or(among(["x", "y", "z"]).map(Role::Place))
            .or(among(["nx", "ny", "nz"]).map(Role::Normal))
            .or(among(["red", "green", "blue"]).map(Role::Color))
            .unwrap_or(Role::Other)
    }
}

pub(super) fn read(mesh: &mut MeshBuilder<'_>, mut cursor: Cursor<'_>) -> Result<(), Error> {
    let header = header::read(mesh, &mut cursor)?;
    let promised: u64 = vertices_of(&header.elements).map(|element| element.count).sum();
    if vertices_of(&header.elements).count() != 1 {
        return Err(mesh.damaged(FilePlace::File, "it does not declare elements `vertex` once"));
    }
    let mut values = Values::new(mesh, cursor, &header);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(mesh, &mut values, element)?,
            name => match ELEMENTS.iter().position(|known| *known == name) {
                Some(2) => read_simplices(mesh, &mut values, element, 3, promised)?,
                Some(place) if mesh.is_triangulation() => {
                    read_simplices(mesh, &mut values, element, place + 1, promised)?;
                }
                _ if element.count > 0 && (mesh.is_triangulation() || name == "tristrips") => {
                    let problem = format!("there are elements `{}`", printable(name.as_bytes()));
                    return Err(mesh.unsupported(FilePlace::File, problem));
                }
                _ => pass_over(mesh, &mut values, element)?,
            },
        }
    }
    values.finish(mesh)
}

fn vertices_of(elements: &[Element]) -> impl Iterator<Item = &Element> {
    elements.iter().filter(|element| element.name == "vertex")
}

fn read_vertices(
    mesh: &mut MeshBuilder<'_>,
    values: &mut Values<'_>,
    element: &Element,
) -> Result<(), Error> {
    let has = |name: &str| {
        element.properties.iter().any(|property| property.name == name && property.length.is_none())
    };
    if let Some(axis) = ["x", "y", "z"].into_iter().find(|axis| !has(axis)) {
        let problem = format!("its vertices have no property `{axis}`");
        return Err(mesh.damaged(FilePlace::File, problem));
    }
    let has_normals = ["nx", "ny", "nz"].into_iter().all(has);
    let has_colors = ["red", "green", "blue"].into_iter().all(has);
    let roles: Vec<Role> = element.properties.iter().map(|found| Role::of(&found.name)).collect();
    for number in 0..element.count {
        let place = values.begin(mesh, "vertex", number)?;
        let (mut at, mut normal, mut color, mut fraction) = ([0.0; 3], [0.0; 3], [0.0; 3], false);
        for (property, role) in element.properties.iter().zip(&roles) {
            match (property.length, role) {
                (None, Role::Place(axis)) => at[*axis] = values.real(mesh, property.kind, place)?,
                (None, Role::Normal(axis)) => {
                    normal[*axis] = values.real(mesh, property.kind, place)?;
                }
                (None, Role::Color(channel)) => {
                    color[*channel] = values.real(mesh, property.kind, place)?;
                    fraction |= matches!(property.kind, Kind::F32 | Kind::F64);
                }
                _ => values.skip(mesh, property, place)?,
            }
        }
        values.end(mesh, place)?;
        mesh.vertex(place, at)?;
        if has_normals {
            mesh.normal(place, normal)?;
        }
        if has_colors {
            mesh.color(place, color, fraction)?;
        }
    }
    Ok(())
}

/// Reads polygons where `width` is 3, else simplices of so many vertices.
fn read_simplices(
    mesh: &mut MeshBuilder<'_>,
    values: &mut Values<'_>,
    element: &Element,
    width: usize,
    vertices: u64,
) -> Result<(), Error> {
    let mut ids = Vec::new();
    for number in 0..element.count {
        let place = values.begin(mesh, ELEMENTS[width - 1], number)?;
        ids.clear();
        for property in &element.properties {
            match (property.length, property.name.as_str()) {
                (Some(length), "vertex_indices" | "vertex_index") => {
                    let count = values.count(mesh, length, place)?;
                    for _ in 0..count {
                        ids.push(values.whole(mesh, property.kind, place)?);
                    }
                }
                (None, "vertex1" | "vertex2") if width == 2 => {
                    ids.push(values.whole(mesh, property.kind, place)?);
                }
                _ => values.skip(mesh, property, place)?,
            }
        }
        values.end(mesh, place)?;
        match width {
            3 => mesh.polygon(place, &ids, vertices)?,
            _ => mesh.simplex(place, &ids, width, vertices)?,
        }
    }
    Ok(())
}

fn pass_over(
    mesh: &MeshBuilder<'_>,
    values: &mut Values<'_>,
    element: &Element,
) -> Result<(), Error> {
    for number in 0..element.count {
        let place = values.begin(mesh, "element", number)?;
        element.properties.iter().try_for_each(|found| values.skip(mesh, found, place))?;
        values.end(mesh, place)?;
    }
    Ok(())
}

/// The header, whose last elements are `element`.
fn header_of(mesh: &MeshView<'_>, encoding: Encoding) -> String {
    let (count, element) = (mesh.vertex_count(), ELEMENTS[mesh.width - 1]);
    // Few programs read unsigned ids, so they are unsigned only where they must be.
    let id = if count <= i32::MAX as u64 { "int" } else { "uint" };
    let word = match encoding {
        Encoding::Binary => header::Encoding::LittleEndian.word(),
        Encoding::Text => header::Encoding::Ascii.word(),
    };
    let comment = match mesh.vertices {
        Vertices::Points(_) => "comment Vertices are the points in their order, from 0.\n",
        Vertices::Places(_) => "",
    };
    let declare = |given: bool, kind: &str, names: &[&str]| match given {
        true => names.iter().map(|name| format!("property {kind} {name}\n")).collect(),
        false => String::new(),
    };
    let is_edge = mesh.width == 2;
    format!(
        "ply\nformat {word} 1.0\n{comment}element vertex {count}\n{}{}{}element {element} {}\n{}{}end_header\n",
        declare(true, "double", &["x", "y", "z"]),
        declare(mesh.normals.is_some(), "double", &["nx", "ny", "nz"]),
        declare(mesh.colors.is_some(), "uchar", &["red", "green", "blue"]),
        mesh.simplex_count(),
        declare(is_edge, id, &["vertex1", "vertex2"]),
        declare(!is_edge, &format!("list uchar {id}"), &["vertex_indices"]),
    )
}

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (normals, colors) = (job.mesh.normals, job.mesh.colors);
    out.put(header_of(job.mesh, job.encoding).as_bytes())?;
    let text = job.encoding == Encoding::Text;
    job.each_vertex(out, |i, at, bytes| {
        let normal = normals.map(|normals| normals[i]).into_iter().flatten();
        let color = colors.map(|colors| colors[i]).into_iter().flatten();
        match text {
            true => {
                put_numbers(at, b" ", bytes);
                normal.chain(color.map(f64::from)).for_each(|value| {
                    bytes.push(b' ');
                    put_number(value, bytes);
                });
                bytes.push(b'\n');
            }
            false => {
                at.into_iter().chain(normal).for_each(|value| bytes.extend(value.to_le_bytes()));
                bytes.extend(color);
            }
        }
    })?;
    job.each_simplex(out, |ids, bytes| {
        // An edge has two ids of their own, all others a list.
        let length = (ids.len() != 2).then_some(ids.len() as u8);
        match text {
            true => {
                let values =
                    length.map(u64::from).into_iter().chain(ids.iter().map(|&id| id.into()));
                for (i, value) in values.enumerate() {
                    bytes.extend((i > 0).then_some(b' '));
                    put_whole(value, bytes);
                }
                bytes.push(b'\n');
            }
            false => {
                bytes.extend(length);
                ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
            }
        }
    })
}
