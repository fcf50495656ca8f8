//! Figures of curves through points.
//!
//! *Idea.* Points below, the band of noise and the curves over them; what is said to be an outlier is marked, and so is every end.
//! Where a band is too narrow to see, a window around a part of the longest curve is drawn as well, as wide as makes it visible.
//! *Guarantee.* No picture has more than [`DrawOptions::max_points`] points besides the outliers; the others are counted in the caption.
//! Of a chain with more vertices than pixels some are left out, none by more than a part of a pixel.
//! *Trap.* The border of a band is drawn at the noise told, beside a polyline: where the curve bends more sharply than the band is wide
//! it folds, so corners are cut off at twice the distance.

mod band;
mod window;

use taut_certify::{Curve, Solution};
use taut_points::{PointSource, gather};

use self::window::Window;
use crate::item_pass::spread;
use crate::marks::{agree, all_finite, all_there, dot_size, drawn_of};
use crate::number::{count, counted, digits};
use crate::{DrawOptions, Error, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone};

/// The marks of outliers are this many times as large as those of the other points.
const OUTLIER_SCALE: f64 = 1.6;
/// At most one outlier is drawn for this many points drawn.
const POINTS_PER_OUTLIER: usize = 4;

/// Pictures of curves and their points: all of it, and a window in which the band of noise can be seen, where it is narrow.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the curves were found for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn curve_figures(
    solution: &Solution<Curve>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let answer = &solution.answer;
    agree("number of coordinates", 2, source.dim())?;
    all_there("number of points", &answer.outliers, source.len())?;
    let vertices = answer.curves.iter().flat_map(|curve| curve.vertices.as_flattened());
    all_finite(vertices.map(|v| ("a coordinate of a vertex", v)))?;
    all_finite([("the noise", &answer.noise)])?;
    let picture = Picture { answer, source, options };
    let mut figures = vec![picture.whole()?];
    if let Some(window) = picture.window() {
        figures.push(picture.part(&window)?);
    }
    Ok(figures.into_iter().map(Figure::Plane).collect())
}

/// The data that all pictures of the same curves share.
struct Picture<'a> {
    answer: &'a Curve,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
}

/// Points with their rows.
type Marks = Vec<(u64, [f64; 2])>;

impl Picture<'_> {
    fn title(&self) -> String {
        let points = counted(self.source.len(), "point");
        format!("{} through {points}", counted(self.answer.curves.len() as u64, "curve"))
    }

    /// Returns how many there are of what, in sentences.
    fn counts(&self) -> String {
        let curves = &self.answer.curves;
        let closed = curves.iter().filter(|curve| curve.closed).count() as u64;
        let open = curves.len() as u64 - closed;
        let vertices: usize = curves.iter().map(|curve| curve.vertices.len()).sum();
        let mut words = match (closed, open) {
            (0, 0) => return "There are no curves.".to_owned(),
            (closed, 0) => counted(closed, "closed curve"),
            (0, open) => counted(open, "open curve"),
            (closed, open) => format!("{} closed and {} open curves", count(closed), count(open)),
        };
        words += &match vertices {
            1 => " with one vertex.".to_owned(),
            more => format!(" with {} vertices.", count(more as u64)),
        };
        if self.answer.noise > 0.0 {
            words +=
                &format!(" Noise of half-width {}, as estimated.", digits(self.answer.noise, 9));
        }
        words
    }

    /// Which rows are drawn: outliers, and an even sample of the others.
    fn rows(&self) -> Result<(Marks, Marks), Error> {
        let most = self.options.max_points;
        let outliers = &self.answer.outliers;
        let is_outlier = |row: &u64| outliers.binary_search(row).is_ok();
        let mut others: Vec<u64> = (0..self.source.len()).filter(|row| !is_outlier(row)).collect();
        let even = |rows: &mut Vec<u64>, most: usize| {
            if rows.len() > most {
                rows.select_nth_unstable_by_key(most - 1, |&row| spread(row));
                rows.truncate(most);
                rows.sort_unstable();
            }
        };
        even(&mut others, most);
        let mut out = outliers.clone();
        even(&mut out, most.div_ceil(POINTS_PER_OUTLIER));
        Ok((self.places(&others)?, self.places(&out)?))
    }

    fn places(&self, rows: &[u64]) -> Result<Marks, Error> {
        let places = gather(self.source, rows)?;
        if let Some(place) = places.iter().position(|x| !x.is_finite()) {
            let what = format!("coordinate {} of point {}", place % 2, rows[place / 2]);
            return Err(Error::NonFinite { what, value: places[place] });
        }
        Ok(rows.iter().copied().zip(places.chunks_exact(2).map(|at| [at[0], at[1]])).collect())
    }

    fn whole(&self) -> Result<Scene2, Error> {
        let (others, outliers) = self.rows()?;
        let mut caption = self.counts();
        let out = outliers.len() as u64;
        caption += &match self.answer.outliers.len() as u64 {
            0 => String::new(),
            1 => " One point is an outlier.".to_owned(),
            all if all == out => format!(" {} points are outliers.", count(all)),
            all => format!(" {} points are outliers, {} of them drawn.", count(all), count(out)),
        };
        let drawn = others.len() as u64 + self.answer.outliers.len() as u64;
        caption += &drawn_of(
            drawn,
            self.source.len(),
            "point",
            "the outliers and an even sample of the others",
        );
        let step = self.extent() / (2.0 * self.options.width);
        let chains: Vec<Chain> = self
            .answer
            .curves
            .iter()
            .map(|curve| Chain { vertices: thinned(&curve.vertices, step), closed: curve.closed })
            .collect();
        Ok(self.scene(self.title(), caption, chains, &others, &outliers))
    }

    fn part(&self, window: &Window) -> Result<Scene2, Error> {
        let inside = |marks: Marks| -> Marks {
            marks.into_iter().filter(|(_, at)| window.holds(*at)).collect()
        };
        let all: Vec<u64> = (0..self.source.len()).collect();
        let (outliers, others): (Marks, Marks) = inside(self.places(&all)?)
            .into_iter()
            .partition(|(row, _)| self.answer.outliers.binary_search(row).is_ok());
        let others: Marks = match others.len().div_ceil(self.options.max_points) {
            0 | 1 => others,
            step => others.into_iter().step_by(step).collect(),
        };
        let mut chains = Vec::new();
        for curve in &self.answer.curves {
            let vertices = window.pieces(&curve.vertices, curve.closed);
            chains.extend(vertices.into_iter().map(|vertices| Chain { vertices, closed: false }));
        }
        let caption = format!(
            "A part of the picture before, {} wide: {} and the band of noise, of half-width {}.",
            digits(window.side(), 3),
            counted((others.len() + outliers.len()) as u64, "point"),
            digits(self.answer.noise, 9)
        );
        let mut scene =
            self.scene(format!("{}: a window", self.title()), caption, chains, &others, &outliers);
        // Cut by the window a chain has ends that are none.
        scene.layers.retain(|layer| layer.name != ENDS);
        Ok(scene)
    }

    fn scene(
        &self,
        title: String,
        caption: String,
        chains: Vec<Chain>,
        others: &Marks,
        outliers: &Marks,
    ) -> Scene2 {
        let dot = dot_size(others.len());
        let discs = |marks: &Marks, size: f64, label: &str| {
            let disc = |&(row, at): &(u64, [f64; 2])| Point2 {
                id: Some(row),
                at,
                size,
                label: label.to_owned(),
            };
            Shape2::Points(marks.iter().map(disc).collect())
        };
        let (closed, open): (Vec<Chain>, Vec<Chain>) =
            chains.into_iter().partition(|chain| chain.closed);
        let mut layers = Vec::new();
        let mut layer = |name: &str, tone: Tone, line_style: LineStyle, shape: Shape2| {
            let some = match &shape {
                Shape2::Points(list) => !list.is_empty(),
                Shape2::Polylines(list) | Shape2::Polygons(list) => !list.is_empty(),
                _ => true,
            };
            if some {
                layers.push(Layer2 { name: name.to_owned(), tone, line_style, shape });
            }
        };
        layer("points", Tone::Point, LineStyle::Solid, discs(others, dot, ""));
        if self.answer.noise > 0.0 {
            let borders =
                |chain: &Chain| band::borders(&chain.vertices, chain.closed, self.answer.noise);
            let loops = closed.iter().flat_map(borders).collect();
            let lines = open.iter().flat_map(borders).collect();
            layer("band of noise", Tone::Bound, LineStyle::Dashed, Shape2::Polygons(loops));
            let name = if closed.is_empty() { "band of noise" } else { "" };
            layer(name, Tone::Bound, LineStyle::Dashed, Shape2::Polylines(lines));
        }
        let ends: Vec<Point2> = open
            .iter()
            .flat_map(|chain| {
                let ends = [chain.vertices.first(), chain.vertices.last()];
                ends.into_iter().flatten().copied().collect::<Vec<_>>()
            })
            .map(|at| Point2 { id: None, at, size: 4.0, label: "end".into() })
            .collect();
        let vertices =
            |chains: Vec<Chain>| chains.into_iter().map(|chain| chain.vertices).collect();
        let (any_closed, any_open) = (!closed.is_empty(), !open.is_empty());
        layer("closed curves", Tone::Answer, LineStyle::Solid, Shape2::Polygons(vertices(closed)));
        let name = if any_closed { "open curves" } else { "curves" };
        layer(name, Tone::Answer, LineStyle::Solid, Shape2::Polylines(vertices(open)));
        if any_open {
            layer(ENDS, Tone::Support, LineStyle::Solid, Shape2::Points(ends));
        }
        layer(
            "outliers",
            Tone::Third,
            LineStyle::Solid,
            discs(outliers, OUTLIER_SCALE * dot, "outlier"),
        );
        Scene2::plane(title, caption, layers, self.options)
    }

    /// The longer side of the box of all curves.
    fn extent(&self) -> f64 {
        let vertices = || self.answer.curves.iter().flat_map(|curve| &curve.vertices);
        (0..2)
            .map(|k| {
                let low = vertices().map(|at| at[k]).fold(f64::INFINITY, f64::min);
                let high = vertices().map(|at| at[k]).fold(f64::NEG_INFINITY, f64::max);
                (high - low).max(0.0)
            })
            .fold(0.0, f64::max)
            .min(f64::MAX)
    }
}

/// The legend's word for the ends of open curves.
const ENDS: &str = "ends";

/// A curve as it is drawn.
struct Chain {
    vertices: Vec<[f64; 2]>,
    closed: bool,
}

/// A chain without the vertices that are nearer than `step` to the one before; the last one stays.
fn thinned(vertices: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (place, &at) in vertices.iter().enumerate() {
        let near = kept.last().is_some_and(|last| (at[0] - last[0]).hypot(at[1] - last[1]) < step);
        if !near || place + 1 == vertices.len() {
            kept.push(at);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::thinned;

    #[test]
    fn thinning_keeps_both_ends() {
        let line: Vec<[f64; 2]> = (0..=100).map(|i| [f64::from(i), 0.0]).collect();
        let few = thinned(&line, 9.5);
        assert_eq!((few[0], few[few.len() - 1], few.len()), ([0.0, 0.0], [100.0, 0.0], 11));
        assert_eq!(thinned(&line, 0.0), line);
        assert!(thinned(&[], 1.0).is_empty());
    }
}
