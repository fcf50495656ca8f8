//! The figures of a ball of a kernel: in the plane its border among the points, elsewhere the squared distances of the points.
//!
//! *Idea.* The border is the set of all x with |φ(x) − c|² = R². On a grid over the picture it is followed from cell to cell, with
//! linear interpolation along the sides.
//! *Guarantee.* The border is that of the answer to within a cell of the grid. Of many points a sample is drawn, and the caption says so.

use taut_certify::{Kernel, KernelBall, KernelCenter, Solution};
use taut_points::{PointSource, gather};

use crate::marks::{agree, all_finite, all_there, dot_size};
use crate::number::{count, counted, exact};
use crate::{
    Aspect, Axis, Bar, DrawOptions, Error, Figure, Layer2, Level, LineStyle, Plot, Point2, Scene2,
    Shape2, Tone,
};

/// Cells of the grid along each side.
const CELLS: usize = 160;
/// The margin around the points, as a part of their extent.
const MARGIN: f64 = 0.15;
/// Bars of the histogram.
const BARS: usize = 40;
/// The radius of the disc of a point of the support, in pixels.
const SUPPORT_SIZE: f64 = 3.5;

/// The picture of a ball of a kernel and its points.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ball was made for, [`Error::NonFinite`], [`Error::Option`], [`Error::Read`].
pub fn kernel_ball_figures(
    solution: &Solution<KernelBall>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let ball = &solution.answer;
    agree("number of multipliers", ball.support.len(), ball.multipliers.len())?;
    all_there("number of points", &ball.support, source.len())?;
    let numbers = ball.multipliers.iter().map(|l| ("a multiplier", l));
    all_finite(numbers.chain([("the squared radius", &ball.squared_radius)]))?;
    let dim = source.dim();
    let support = finite_rows(source, &ball.support)?;
    let Some(center) = KernelCenter::of(ball, &support, dim) else {
        return Err(Error::Mismatch {
            what: "number of columns",
            expected: source.len(),
            found: dim as u64,
        });
    };
    let shown = source.len().min(options.max_points as u64);
    let row = |k: u64| (u128::from(k) * u128::from(source.len()) / u128::from(shown.max(1))) as u64;
    let ids: Vec<u64> = (0..shown).map(row).collect();
    let picture = Picture {
        solution,
        source,
        options,
        center,
        support: &support,
        rows: finite_rows(source, &ids)?,
        ids,
    };
    let is_plane = dim == 2 && ball.kernel != Kernel::Precomputed;
    Ok(vec![if is_plane { picture.plane() } else { picture.distances() }])
}

/// Rows by number, all of them finite.
fn finite_rows(source: &dyn PointSource, ids: &[u64]) -> Result<Vec<f64>, Error> {
    let values = gather(source, ids)?;
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(values),
        Some(at) => {
            let what =
                format!("coordinate {} of point {}", at % source.dim(), ids[at / source.dim()]);
            Err(Error::NonFinite { what, value: values[at] })
        }
    }
}

struct Picture<'a> {
    solution: &'a Solution<KernelBall>,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
    center: KernelCenter<'a>,
    support: &'a [f64],
    rows: Vec<f64>,
    ids: Vec<u64>,
}

impl Picture<'_> {
    fn ball(&self) -> &KernelBall {
        &self.solution.answer
    }

    fn title(&self) -> String {
        let points = counted(self.source.len(), "point");
        match self.ball().nu {
            None => format!("Ball of a {} kernel around {points}", self.ball().kernel.name()),
            Some(nu) => format!(
                "Soft ball of a {} kernel, ν = {}, around {points}",
                self.ball().kernel.name(),
                exact(nu)
            ),
        }
    }

    fn caption(&self) -> String {
        let ball = self.ball();
        let gap = self.options.gap_words("relative gap", self.solution.certificate.gap);
        let drawn = match (self.ids.len() as u64) < self.source.len() {
            true => format!(" Of the points {} are drawn.", count(self.ids.len() as u64)),
            false => String::new(),
        };
        let support = counted(ball.support.len() as u64, "point");
        format!(
            "Squared radius {}; {gap}. Its center is made of {support}.{drawn}",
            exact(ball.squared_radius)
        )
    }

    fn plane(&self) -> Figure {
        let points = |rows: &[f64], ids: &[u64], size: f64, label: &str| {
            let point = |(at, &row): (&[f64; 2], &u64)| Point2 {
                id: Some(row),
                at: *at,
                size,
                label: label.to_owned(),
            };
            Shape2::Points(rows.as_chunks::<2>().0.iter().zip(ids).map(point).collect())
        };
        let layer = |name: &str, tone, shape| Layer2 {
            name: name.to_owned(),
            tone,
            line_style: LineStyle::Solid,
            shape,
        };
        let support = points(self.support, &self.ball().support, SUPPORT_SIZE, "support");
        Figure::Plane(Scene2 {
            title: self.title(),
            caption: self.caption(),
            x: self.options.axis(0, 2),
            y: self.options.axis(1, 2),
            aspect: Aspect::Equal,
            layers: vec![
                layer(
                    "points",
                    Tone::Point,
                    points(&self.rows, &self.ids, dot_size(self.ids.len()), "point"),
                ),
                layer("support", Tone::Support, support),
                layer("border", Tone::Answer, Shape2::Polylines(self.border())),
            ],
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// The border, as the segments in which it crosses the cells of a grid.
    fn border(&self) -> Vec<Vec<[f64; 2]>> {
        let along = |c: usize| self.rows.iter().chain(self.support).skip(c).step_by(2).copied();
        let (mut low, mut step) = ([0.0; 2], [0.0; 2]);
        for c in 0..2 {
            let (least, most) = (
                along(c).fold(f64::INFINITY, f64::min),
                along(c).fold(f64::NEG_INFINITY, f64::max),
            );
            let extent = if most > least { most - least } else { 1.0 };
            low[c] = least - MARGIN * extent;
            step[c] = extent * (1.0 + 2.0 * MARGIN) / CELLS as f64;
        }
        let at = |i: usize, j: usize| [low[0] + i as f64 * step[0], low[1] + j as f64 * step[1]];
        let height = |k: usize| {
            let place = at(k % (CELLS + 1), k / (CELLS + 1));
            self.center.squared_distance(&place, 0.0) - self.ball().squared_radius
        };
        let heights: Vec<f64> = (0..(CELLS + 1) * (CELLS + 1)).map(height).collect();
        let mut segments = vec![];
        for j in 0..CELLS {
            for i in 0..CELLS {
                let corner = |di: usize, dj: usize| {
                    (at(i + di, j + dj), heights[(j + dj) * (CELLS + 1) + i + di])
                };
                let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let crossing = |k: usize| {
                    let ((a, above), (b, other)) = (corners[k], corners[(k + 1) % 4]);
                    let t = above / (above - other);
                    ((above < 0.0) != (other < 0.0))
                        .then(|| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])])
                };
                let ends: Vec<[f64; 2]> = (0..4).filter_map(crossing).collect();
                segments.extend(ends.chunks_exact(2).map(<[[f64; 2]]>::to_vec));
            }
        }
        segments
    }

    /// A histogram of the squared distances from the center.
    fn distances(&self) -> Figure {
        let ball = self.ball();
        let dim = self.source.dim();
        let distance = |(row, &id): (&[f64], &u64)| {
            let own = if ball.kernel == Kernel::Precomputed { row[id as usize] } else { 0.0 };
            self.center.squared_distance(row, own).max(0.0)
        };
        let distances: Vec<f64> =
            self.rows.chunks_exact(dim).zip(&self.ids).map(distance).collect();
        let most =
            distances.iter().copied().fold(ball.squared_radius, f64::max).max(f64::MIN_POSITIVE);
        let mut counts = [0u64; BARS];
        for distance in &distances {
            counts[((distance / most * BARS as f64) as usize).min(BARS - 1)] += 1;
        }
        let width = most / BARS as f64;
        let bar = |(k, &height): (usize, &u64)| Bar {
            span: [k as f64 * width, (k + 1) as f64 * width],
            height: height as f64,
            tone: Tone::Point,
        };
        let axes = [Axis::named("squared distance in the feature space"), Axis::named("points")];
        let level = Level::AtX {
            x: ball.squared_radius,
            tone: Tone::Answer,
            label: "squared radius".to_owned(),
        };
        Figure::Plot(Plot {
            bars: counts.iter().enumerate().map(bar).collect(),
            levels: vec![level],
            ..Plot::empty(self.title(), self.caption(), axes, self.options)
        })
    }
}
