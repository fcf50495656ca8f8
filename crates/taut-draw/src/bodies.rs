//! The figure of convex bodies in a triangle mesh.
//!
//! *Guarantee.* All facets of all bodies are drawn. The mesh is translucent around them; of a large mesh a sample of its corners is
//! drawn instead, and the caption says so.

use std::fmt::Write as _;

use taut_certify::{InscribedBodies, Solution};
use taut_points::{Blocks, PointSource, Scratch, gather};

use crate::marks::{agree, all_there, dot_size};
use crate::number::{count, counted, exact};
use crate::{
    DrawOptions, Error, Figure, Layer3, LineStyle, Mesh3, Point3, Scene3, Shading, Shape3,
    Surface3, Tone,
};

/// Triangles of a mesh that is drawn with all its triangles, at most: each is a polygon of the picture.
const MESH_TRIANGLES_MAX: usize = 6000;

/// The picture of convex bodies inside the mesh whose triangles are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has not rows of 9 or 10 numbers, [`Error::NonFinite`], [`Error::Option`], [`Error::Read`].
pub fn bodies_figures(
    solution: &Solution<InscribedBodies>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    if source.dim() != 10 {
        agree("number of coordinates", 9, source.dim())?;
    }
    let answer = &solution.answer;
    let bodies = match answer.bodies.len() as u64 {
        1 => "1 body".to_owned(),
        more => format!("{} bodies", count(more)),
    };
    let Kinds { triangles, obstacles, points } = Kinds::of(source)?;
    let (mesh, note) = mesh(source, &triangles, "mesh", options)?;
    let (surfaces, of_obstacles) = mesh_of_obstacles(source, &obstacles, options)?;
    let volume: f64 = answer.bodies.iter().map(|body| body.volume).sum();
    let closed_by = match &answer.caps[..] {
        [] => String::new(),
        caps => format!(" Holes of the mesh are closed by {}.", counted(caps.len() as u64, "cap")),
    };
    let caption = format!(
        "{bodies}{}; their volumes add up to {}.{closed_by}{note}{of_obstacles}",
        if answer.disjoint { " that are disjoint" } else { "" },
        exact(volume)
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
    if let Some(surfaces) = surfaces {
        layers.push(layer("obstacles", Tone::Second, surfaces));
    }
    if !points.is_empty() {
        let shown = some(&points, points.len().min(options.max_points));
        layers.push(layer(
            "obstacle points",
            Tone::Second,
            dots(source, &shown, "obstacle point")?,
        ));
    }
    if !answer.caps.is_empty() {
        layers.push(layer("caps", Tone::Second, Shape3::Mesh(caps(answer, source)?)));
    }
    let mut title =
        format!("Convex bodies in a mesh of {}", counted(triangles.len() as u64, "triangle"));
    if !obstacles.is_empty() {
        let what = counted(obstacles.len() as u64, "triangle");
        let _ = write!(title, ", clear of obstacles of {what}");
    }
    if !points.is_empty() {
        let _ = write!(title, " and among {}", counted(points.len() as u64, "point"));
    }
    // The columns are those of triangles.
    let options = DrawOptions { columns: Vec::new(), ..options.clone() };
    Ok(vec![Figure::Space(Scene3::space(title, caption, layers, &options))])
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
    let rows_of = values.chunks_exact(source.dim());
    let places: Vec<[f64; 3]> = rows_of.flat_map(|row| row.as_chunks::<3>().0).copied().collect();
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

/// The numbers of the rows that are triangles of the mesh, of those that are triangles of obstacles, and of points: these have three equal
/// corners.
struct Kinds {
    triangles: Vec<u64>,
    obstacles: Vec<u64>,
    points: Vec<u64>,
}

impl Kinds {
    fn of(source: &dyn PointSource) -> Result<Self, Error> {
        let mut kinds = Kinds { triangles: vec![], obstacles: vec![], points: vec![] };
        let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
        let mut row = [0.0; 10];
        for block in 0..blocks.count() {
            let range = blocks.range(block);
            let first = range.start;
            let rows = source.read(range, &mut scratch)?;
            for k in 0..rows.len() {
                rows.copy_row(k, &mut row[..source.dim()]);
                let [corners @ .., surface] = &row;
                let kind = match *corners.as_chunks::<3>().0 {
                    [a, b, c] if a == b && b == c => &mut kinds.points,
                    _ if *surface == 0.0 => &mut kinds.triangles,
                    _ => &mut kinds.obstacles,
                };
                kind.push(first + k as u64);
            }
        }
        Ok(kinds)
    }
}

/// So many of some rows, spread evenly over them.
fn some(rows: &[u64], shown: usize) -> Vec<u64> {
    (0..shown).map(|k| rows[k * rows.len() / shown]).collect()
}

/// The surfaces of obstacles, if there are any, and what to say about a sample of them.
fn mesh_of_obstacles(
    source: &dyn PointSource,
    rows: &[u64],
    options: &DrawOptions,
) -> Result<(Option<Shape3>, String), Error> {
    if rows.is_empty() {
        return Ok((None, String::new()));
    }
    let (shape, note) = mesh(source, rows, "obstacles", options)?;
    Ok((Some(shape), note))
}

/// A mesh, or a sample of its corners, and what to say about the latter.
fn mesh(
    source: &dyn PointSource,
    rows: &[u64],
    what: &str,
    options: &DrawOptions,
) -> Result<(Shape3, String), Error> {
    if rows.len() <= MESH_TRIANGLES_MAX {
        let vertices = corners(source, rows)?;
        let triangles = (0..rows.len()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        return Ok((Shape3::Mesh(Mesh3 { vertices, triangles }), String::new()));
    }
    let shown = rows.len().min(options.max_points);
    let dots = dots(source, &some(rows, shown), "corner of a triangle")?;
    let note = format!(" Of the {what} one corner of {} triangles is drawn.", count(shown as u64));
    Ok((dots, note))
}

/// The corners of some rows.
fn corners(source: &dyn PointSource, rows: &[u64]) -> Result<Vec<[f64; 3]>, Error> {
    let (values, dim) = (gather(source, rows)?, source.dim());
    if let Some(at) = values.iter().position(|x| !x.is_finite()) {
        let what = format!("coordinate {} of triangle {}", at % dim, rows[at / dim]);
        return Err(Error::NonFinite { what, value: values[at] });
    }
    Ok(values.chunks_exact(dim).flat_map(|row| row.as_chunks::<3>().0).copied().collect())
}

/// The first corners of some rows as points.
fn dots(source: &dyn PointSource, rows: &[u64], label: &str) -> Result<Shape3, Error> {
    let size = dot_size(rows.len());
    let point = |(at, &row): (&[f64; 3], &u64)| Point3 {
        id: Some(row),
        at: *at,
        size,
        label: label.to_owned(),
    };
    Ok(Shape3::Points(corners(source, rows)?.iter().step_by(3).zip(rows).map(point).collect()))
}
