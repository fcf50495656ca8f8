//! Figures of a Delaunay triangulation.
//!
//! *Idea.* In the plane every edge is drawn, the hull bold, and then the Voronoi diagram over it. A picture has room for
//! some thousands of edges that an eye can tell apart; of more points a window around their middle is drawn as well,
//! with its own edges and cells as they are: a triangulation of a sample would be another one. In space the hull is a
//! surface to turn, and of few points all edges show within.
//! *Guarantee.* In the plane no picture has more than [`DrawOptions::max_points`] points; the others are counted in the
//! caption. A window shows of equal points one. Voronoi vertices are rounded: they are drawn, not returned.
//! *Trap.* Points of a window bring all their edges, three each on average, but one that is joined to all others brings as
//! many. Where the view ends, edges are cut, so that one long edge does not shrink the rest to a dot.

mod clip;
mod edges;
mod plane;
mod space;
mod voronoi;
mod window;

use taut_certify::{Solution, Triangulation};
use taut_points::{Blocks, PointSource, Scratch};

use crate::item_pass::spread;
use crate::number::{count, counted};
use crate::{DrawOptions, Error, Figure};

/// Pictures of a triangulation and its points. In the plane: the triangulation; of many points a window of it as well; and
/// the Voronoi diagram, if the certificate names neighbors. In space: the hull with what can be shown within.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the triangulation was made for, [`Error::NonFinite`],
/// [`Error::Option`], [`Error::Read`].
pub fn delaunay_figures(
    solution: &Solution<Triangulation>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    check(&solution.answer, source)?;
    let places = places(source)?;
    let picture = Picture { solution, options, places };
    Ok(match solution.answer.dimension {
        2 => picture.in_plane().into_iter().map(Figure::Plane).collect(),
        _ => vec![Figure::Space(picture.in_space())],
    })
}

/// Checks what the answer and its points must agree in before anything is drawn.
fn check(answer: &Triangulation, source: &dyn PointSource) -> Result<(), Error> {
    let mismatch = |what, expected: u64, found: u64| Err(Error::Mismatch { what, expected, found });
    let dim = source.dim() as u64;
    if u64::from(answer.dimension) != dim {
        return mismatch("number of coordinates", answer.dimension.into(), dim);
    }
    if !(2..=3).contains(&dim) {
        return mismatch("number of coordinates", 2, dim);
    }
    let width = answer.hull_dimension.map_or(0, u64::from);
    if width > dim {
        return mismatch("dimension of the hull", width, dim);
    }
    let duplicates = answer.duplicates.iter().flatten();
    let largest = answer.simplices.iter().chain(&answer.hull).chain(duplicates).max();
    match largest {
        Some(&id) if u64::from(id) >= source.len() => {
            mismatch("number of points", u64::from(id) + 1, source.len())
        }
        _ => Ok(()),
    }
}

/// All points; those of the plane at the height 0.
fn places(source: &dyn PointSource) -> Result<Vec<[f64; 3]>, Error> {
    let dim = source.dim();
    let mut places = Vec::new();
    let mut scratch = Scratch::new();
    let blocks = Blocks::of(source);
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        let rows = source.read(range, &mut scratch)?;
        for i in 0..rows.len() {
            let mut at = [0.0; 3];
            rows.copy_row(i, &mut at[..dim]);
            if let Some(column) = at.iter().position(|x| !x.is_finite()) {
                let what = format!("coordinate {column} of point {}", first + i as u64);
                return Err(Error::NonFinite { what, value: at[column] });
            }
            places.push(at);
        }
    }
    Ok(places)
}

/// The data that all pictures of one triangulation share.
struct Picture<'a> {
    solution: &'a Solution<Triangulation>,
    options: &'a DrawOptions,
    places: Vec<[f64; 3]>,
}

impl Picture<'_> {
    fn answer(&self) -> &Triangulation {
        &self.solution.answer
    }

    fn title(&self) -> String {
        let place = if self.answer().dimension == 2 { "the plane" } else { "space" };
        let points = counted(self.places.len() as u64, "point");
        format!("Delaunay triangulation of {points} in {place}")
    }

    /// Returns how many there are of what, in sentences.
    fn counts(&self) -> String {
        let answer = self.answer();
        let simplices = answer.len() as u64;
        let hull = |width: usize| (answer.hull.len() / width) as u64;
        let mut words = match (answer.hull_dimension, answer.dimension) {
            (None, _) => "There are no points.".to_owned(),
            (Some(0), _) => "All points are equal.".to_owned(),
            (Some(1), _) => {
                format!("All points are on a line, {} from end to end.", counted(simplices, "edge"))
            }
            (Some(2), dimension) => format!(
                "{}{}, {} on the hull.",
                if dimension == 3 { "All points are on a plane: " } else { "" },
                counted(simplices, "triangle"),
                counted(hull(2), "edge")
            ),
            _ => format!(
                "{}, {} on the hull.",
                match simplices {
                    1 => "1 tetrahedron".to_owned(),
                    more => format!("{} tetrahedra", count(more)),
                },
                counted(hull(3), "triangle")
            ),
        };
        match answer.duplicates.len() as u64 {
            0 => {}
            1 => words += " One point equals an earlier one.",
            more => words += &format!(" {} points equal an earlier one.", count(more)),
        }
        words
    }

    /// The points to draw, ascending: all of them, or an even sample whatever their order.
    fn sample(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = (0..self.places.len() as u32).collect();
        let most = self.options.max_points;
        if ids.len() > most {
            ids.select_nth_unstable_by_key(most - 1, |&id| spread(id.into()));
            ids.truncate(most);
            ids.sort_unstable();
        }
        ids
    }

    /// The words for a sample.
    fn sampled(&self, drawn: usize) -> String {
        match drawn == self.places.len() {
            true => String::new(),
            false => {
                format!(" {} points are drawn, an even sample.", count(drawn as u64))
            }
        }
    }
}

/// Radius of the disc of a point among so many, pixels: edges lead the eye, so they are small.
fn dot_size(points: usize) -> f64 {
    match points {
        0..=100 => 3.4,
        101..=500 => 2.2,
        501..=2000 => 1.5,
        2001..=5000 => 1.1,
        _ => 0.8,
    }
}
