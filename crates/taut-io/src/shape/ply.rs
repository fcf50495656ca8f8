//! Shapes in Stanford PLY: elements `vertex` with `x`, `y`, `z`, and elements `face` with a list of vertices.
//!
//! Normals are `nx`, `ny`, `nz`, colours `red`, `green`, `blue`; all other properties and elements are passed over, but for
//! triangle strips, which hold what is asked for and are refused.
//!
//! *Trap.* Faces may stand before the vertices they name, so corners are compared with the number of vertices that the
//! header promises; that there are as many is known when they have been read.

mod values;

use super::building::Building;
use super::{Encoding, ShapeView};
use crate::cursor::{Cursor, Kind};
use crate::error::Refuse;
use crate::ply::{self, Element};
use crate::words::{put_ids, put_number, put_numbers, put_whole};
use crate::write::Out;
use crate::{Error, MeshPlace};
use values::Values;

/// What the property of a vertex is, by its name.
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

pub(super) fn read(shape: &mut Building<'_>, mut cursor: Cursor<'_>) -> Result<(), Error> {
    let header = ply::header(shape, &mut cursor)?;
    let promised: u64 = vertices_of(&header.elements).map(|element| element.count).sum();
    if vertices_of(&header.elements).count() != 1 {
        return Err(shape.damaged(MeshPlace::File, "it does not declare elements `vertex` once"));
    }
    let mut values = Values::new(cursor, &header);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(shape, &mut values, element)?,
            "face" => read_faces(shape, &mut values, element, promised)?,
            "tristrips" if element.count > 0 => {
                return Err(shape.kind(MeshPlace::File, "there are elements `tristrips`"));
            }
            _ => pass_over(shape, &mut values, element)?,
        }
    }
    values.finish(shape)
}

fn vertices_of(elements: &[Element]) -> impl Iterator<Item = &Element> {
    elements.iter().filter(|element| element.name == "vertex")
}

fn read_vertices(
    shape: &mut Building<'_>,
    values: &mut Values<'_>,
    element: &Element,
) -> Result<(), Error> {
    let has = |name: &str| {
        element.properties.iter().any(|property| property.name == name && property.length.is_none())
    };
    if let Some(axis) = ["x", "y", "z"].into_iter().find(|axis| !has(axis)) {
        let problem = format!("its vertices have no property `{axis}`");
        return Err(shape.damaged(MeshPlace::File, problem));
    }
    let has_normals = ["nx", "ny", "nz"].into_iter().all(has);
    let has_colors = ["red", "green", "blue"].into_iter().all(has);
    let roles: Vec<Role> = element.properties.iter().map(|found| Role::of(&found.name)).collect();
    for number in 0..element.count {
        let place = values.begin(shape, "vertex", number)?;
        let (mut at, mut normal, mut color, mut fraction) = ([0.0; 3], [0.0; 3], [0.0; 3], false);
        for (property, role) in element.properties.iter().zip(&roles) {
            match (property.length, role) {
                (None, Role::Place(axis)) => {
                    at[*axis] = values.real(shape, property.kind, place)?
                }
                (None, Role::Normal(axis)) => {
                    normal[*axis] = values.real(shape, property.kind, place)?;
                }
                (None, Role::Color(channel)) => {
                    color[*channel] = values.real(shape, property.kind, place)?;
                    fraction |= matches!(property.kind, Kind::F32 | Kind::F64);
                }
                _ => values.skip(shape, property, place)?,
            }
        }
        values.end(shape, place)?;
        shape.vertex(place, at)?;
        if has_normals {
            shape.normal(place, normal)?;
        }
        if has_colors {
            shape.color(place, color, fraction)?;
        }
    }
    Ok(())
}

fn read_faces(
    shape: &mut Building<'_>,
    values: &mut Values<'_>,
    element: &Element,
    vertices: u64,
) -> Result<(), Error> {
    let mut corners = Vec::new();
    for number in 0..element.count {
        let place = values.begin(shape, "face", number)?;
        corners.clear();
        for property in &element.properties {
            match (property.length, property.name.as_str()) {
                (Some(length), "vertex_indices" | "vertex_index") => {
                    let count = values.count(shape, length, place)?;
                    for _ in 0..count {
                        corners.push(values.whole(shape, property.kind, place)?);
                    }
                }
                _ => values.skip(shape, property, place)?,
            }
        }
        values.end(shape, place)?;
        shape.polygon(place, &corners, vertices)?;
    }
    Ok(())
}

fn pass_over(
    shape: &Building<'_>,
    values: &mut Values<'_>,
    element: &Element,
) -> Result<(), Error> {
    for number in 0..element.count {
        let place = values.begin(shape, "element", number)?;
        element.properties.iter().try_for_each(|found| values.skip(shape, found, place))?;
        values.end(shape, place)?;
    }
    Ok(())
}

pub(super) fn write(
    shape: &ShapeView<'_>,
    encoding: Encoding,
    out: &mut Out<'_>,
) -> Result<(), Error> {
    let (vertices, triangles) = (shape.mesh.vertices(), shape.mesh.triangles());
    // Few programs read unsigned ids, so they are unsigned only where they must be.
    let id = if vertices.len() <= i32::MAX as usize { "int" } else { "uint" };
    let word = match encoding {
        Encoding::Binary => ply::Encoding::LittleEndian.word(),
        Encoding::Text => ply::Encoding::Ascii.word(),
    };
    let declare = |given: bool, kind: &str, names: [&str; 3]| match given {
        true => names.map(|name| format!("property {kind} {name}\n")).concat(),
        false => String::new(),
    };
    let header = format!(
        "ply\nformat {word} 1.0\nelement vertex {}\n{}{}{}element face {}\n\
         property list uchar {id} vertex_indices\nend_header\n",
        vertices.len(),
        declare(true, "double", ["x", "y", "z"]),
        declare(shape.normals.is_some(), "double", ["nx", "ny", "nz"]),
        declare(shape.colors.is_some(), "uchar", ["red", "green", "blue"]),
        triangles.len(),
    );
    out.put(header.as_bytes())?;
    let text = encoding == Encoding::Text;
    out.each(0..vertices.len(), |i, bytes| {
        let reals = [Some(vertices[i]), shape.normals.map(|normals| normals[i])];
        let color = shape.colors.map(|colors| colors[i]);
        match text {
            true => {
                put_numbers(vertices[i], b" ", bytes);
                let rest = reals[1].into_iter().flatten();
                rest.chain(color.into_iter().flatten().map(f64::from)).for_each(|value| {
                    bytes.push(b' ');
                    put_number(value, bytes);
                });
                bytes.push(b'\n');
            }
            false => {
                let reals = reals.into_iter().flatten().flatten();
                reals.for_each(|value| bytes.extend(value.to_le_bytes()));
                bytes.extend(color.into_iter().flatten());
            }
        }
    })?;
    out.each(triangles, |ids, bytes| match text {
        true => {
            put_whole(3, bytes);
            put_ids(ids, 0, bytes);
        }
        false => {
            bytes.push(3);
            ids.iter().for_each(|id| bytes.extend(id.to_le_bytes()));
        }
    })
}
