//! The figure of convex bodies in a triangle mesh.
//!
//! *Guarantee.* All facets of all bodies are drawn. The mesh is translucent around them; of a large mesh a sample of its corners is
//! drawn instead, and the caption says so.

use taut_certify::{InscribedBodies, Solution};
use taut_points::{PointSource, gather};

use crate::marks::{agree, all_there, dot_size};
use crate::number::{count, counted, short};
use crate::{
    DrawOptions, Error, Figure, Layer3, LineStyle, Mesh3, Point3, Scene3, Shading, Shape3,
    Surface3, Tone,
};

/// Triangles of a mesh that is drawn with all its triangles, at most: each is a polygon of the picture.
const MESH_TRIANGLES_MAX: u64 = 6000;

/// The picture of convex bodies inside the mesh whose triangles are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has not rows of 9 numbers, [`Error::NonFinite`], [`Error::Option`], [`Error::Read`].
pub fn bodies_figures(
    solution: &Solution<InscribedBodies>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    agree("number of coordinates", 9, source.dim())?;
    let answer = &solution.answer;
    let triangles = counted(source.len(), "triangle");
    let bodies = match answer.bodies.len() as u64 {
        1 => "1 body".to_owned(),
        more => format!("{} bodies", count(more)),
    };
    let (mesh, note) = mesh(source, options)?;
    let volume: f64 = answer.bodies.iter().map(|body| body.volume).sum();
    let closed_by = match &answer.caps[..] {
        [] => String::new(),
        caps => format!(" Holes of the mesh are closed by {}.", counted(caps.len() as u64, "cap")),
    };
    let caption = format!(
        "{bodies}{}; their volumes add up to {}.{closed_by}{note}",
        if answer.disjoint { " that are disjoint" } else { "" },
        short(volume, 6)
    );
    let layer = |name: &str, tone, shape| Layer3 {
        name: name.to_owned(),
        tone,
        line_style: LineStyle::Solid,
        shape,
    };
    let mut layers = vec![
        layer("bodies", Tone::Answer, Shape3::Surface(facets(answer)?)),
        layer("mesh", Tone::Point, mesh),
    ];
    if !answer.caps.is_empty() {
        layers.push(layer("caps", Tone::Second, Shape3::Mesh(caps(answer, source)?)));
    }
    let title = format!("Convex bodies in a mesh of {triangles}");
    Ok(vec![Figure::Space(Scene3::space(title, caption, layers, options))])
}

/// The facets of all bodies as triangles.
fn facets(answer: &InscribedBodies) -> Result<Surface3, Error> {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for polygon in answer.bodies.iter().flat_map(|body| answer.polygons(body)) {
        let first = vertices.len() as u32;
        let corners = polygon.len() as u32;
        triangles.extend((2..corners).map(|k| [first, first + k - 1, first + k]));
        vertices.extend(polygon);
    }
    match vertices.as_flattened().iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(Error::NonFinite { what: "a corner of a body".to_owned(), value }),
        None => Ok(Surface3 { vertices, triangles, back: Tone::Answer, shading: Shading::Flat }),
    }
}

/// The triangles that close holes of the mesh.
fn caps(answer: &InscribedBodies, source: &dyn PointSource) -> Result<Mesh3, Error> {
    let corners = answer.caps.as_flattened();
    all_there("corner of a cap", corners, source.len().saturating_mul(3))?;
    let mut rows: Vec<u64> = corners.iter().map(|corner| corner / 3).collect();
    rows.sort_unstable();
    rows.dedup();
    let values = gather(source, &rows)?;
    let places = values.as_chunks::<3>().0;
    let place = |&corner: &u64| {
        let row = rows.partition_point(|&row| row < corner / 3);
        places[3 * row + (corner % 3) as usize]
    };
    let vertices: Vec<[f64; 3]> = corners.iter().map(place).collect();
    if let Some(&value) = vertices.as_flattened().iter().find(|x| !x.is_finite()) {
        return Err(Error::NonFinite { what: "a corner of a cap".to_owned(), value });
    }
    let triangles = (0..answer.caps.len()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Ok(Mesh3 { vertices, triangles })
}

/// The mesh, or a sample of its corners, and what to say about the latter.
fn mesh(source: &dyn PointSource, options: &DrawOptions) -> Result<(Shape3, String), Error> {
    let is_whole = source.len() <= MESH_TRIANGLES_MAX;
    let shown = if is_whole { source.len() } else { source.len().min(options.max_points as u64) };
    let row = |k: u64| (u128::from(k) * u128::from(source.len()) / u128::from(shown.max(1))) as u64;
    let rows: Vec<u64> = (0..shown).map(row).collect();
    let values = gather(source, &rows)?;
    if let Some(at) = values.iter().position(|x| !x.is_finite()) {
        let what = format!("coordinate {} of triangle {}", at % 9, rows[at / 9]);
        return Err(Error::NonFinite { what, value: values[at] });
    }
    let corners = values.as_chunks::<3>().0;
    if is_whole {
        let triangles = (0..rows.len()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Mesh3 { vertices: corners.to_vec(), triangles };
        return Ok((Shape3::Mesh(mesh), String::new()));
    }
    let size = dot_size(rows.len());
    let point = |(at, &row): (&[f64; 3], &u64)| Point3 {
        id: Some(row),
        at: *at,
        size,
        label: "corner of a triangle".to_owned(),
    };
    let points = corners.iter().step_by(3).zip(&rows).map(point).collect();
    let note = format!(" Of the mesh one corner of {} triangles is drawn.", count(shown));
    Ok((Shape3::Points(points), note))
}
