//! How an algorithm comes to its answer, step by step, for teaching.
//!
//! Each step is calculated by the solvers that answer in one go: the ball of a core-set is that of `taut::ball`, the triangulation of
//! the first points that of `taut::delaunay`. What is shown is therefore what the library does, on fewer points where there are many.

mod ball;
mod branches;
mod centers;
mod delaunay;
mod frame;
mod surface;

use serde_json::{Value, json};
use taut::points::Scratch;
use taut_draw::{Figure, Style, Theme, to_svg};

use crate::input::Opened;
use crate::options::Options;
use crate::tools::Tool;

/// The steps of an algorithm.
pub(crate) trait Trace: std::fmt::Debug {
    fn count(&self) -> usize;

    /// Says what happens in step `step`, from 0.
    fn words(&self, step: usize) -> Result<Value, String>;

    /// Shows it.
    fn figure(&self, step: usize) -> Result<Figure, String>;
}

/// Most points that a step reads, so that it takes no longer than a blink.
const POINTS_MAX: u64 = 200_000;

/// Returns the steps of a tool on points.
pub(crate) fn of(tool: Tool, points: &Opened, options: &Options) -> Result<Box<dyn Trace>, String> {
    match tool {
        Tool::Ball => Ok(Box::new(ball::Rounds::new(points)?)),
        Tool::Delaunay => Ok(Box::new(delaunay::Insertions::new(points)?)),
        Tool::Centers => Ok(Box::new(centers::Search::new(points, options)?)),
        Tool::Surface => Ok(Box::new(surface::Labeling::new(points, options)?)),
        other => Err(format!("there are no steps of {} to show", other.name())),
    }
}

/// Draws a step, so many pixels wide.
pub(crate) fn svg(mut figure: Figure, dark: bool, width: f64) -> String {
    let width = width.clamp(320.0, 1600.0);
    let size = (width, width * PICTURE_HEIGHT);
    match &mut figure {
        Figure::Plane(scene) => (scene.width, scene.height) = size,
        Figure::Space(scene) => (scene.width, scene.height) = size,
        _ => {}
    }
    let theme = if dark { Theme::Dark } else { Theme::Light };
    to_svg(&figure, &Style { theme })
}

/// Height of a picture beside its width.
const PICTURE_HEIGHT: f64 = 0.78;

/// The words about a step.
fn said(title: String, text: String) -> Value {
    json!({ "title": title, "text": text })
}

/// Coordinates in memory, and the first two of them for pictures.
#[derive(Debug)]
struct Table {
    values: Vec<f64>,
    dim: usize,
    names: Vec<String>,
}

impl Table {
    /// Reads the first `most` points.
    fn of(points: &Opened, most: u64) -> Result<Self, String> {
        let source = points.source();
        let (rows, dim) = (source.len().min(most), source.dim());
        let mut scratch = Scratch::new();
        let read = source.read(0..rows, &mut scratch).map_err(|error| error.to_string())?;
        read.check_finite(0).map_err(|error| points.explain(error))?;
        let mut values = vec![0.0; read.len() * dim];
        for (i, row) in values.chunks_exact_mut(dim).enumerate() {
            read.copy_row(i, row);
        }
        Ok(Table { values, dim, names: points.columns(2) })
    }

    fn len(&self) -> usize {
        self.values.len() / self.dim
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.dim..][..self.dim]
    }

    /// The place of a row in a picture: its first two coordinates.
    fn place(&self, row: usize) -> [f64; 2] {
        place(self.row(row))
    }

    /// Returns the row farthest from a place, the first of several, and how far it is.
    fn farthest(&self, from: &[f64]) -> (usize, f64) {
        let far = |row: usize| distance(self.row(row), from);
        (0..self.len())
            .map(|row| (row, far(row)))
            .fold((0, -1.0), |best, next| if next.1 > best.1 { next } else { best })
    }

    /// The values of some rows.
    fn gathered(&self, rows: &[usize]) -> Vec<f64> {
        rows.iter().flat_map(|&row| self.row(row)).copied().collect()
    }
}

/// The first two coordinates of a place; a missing second one is 0.
fn place(at: &[f64]) -> [f64; 2] {
    [at[0], at.get(1).copied().unwrap_or(0.0)]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The smallest ball around some rows, as exact as rounding allows: center and radius.
fn ball_of(table: &Table, rows: &[usize]) -> Result<(Vec<f64>, f64), String> {
    let values = table.gathered(rows);
    let points = taut::Points::new(&values, table.dim).map_err(|error| error.to_string())?;
    let options = taut::BallOptions { epsilon: 0.0, ..Default::default() };
    let found = taut::ball(&points, &options).map_err(|error| error.to_string())?;
    Ok((found.answer.center, found.answer.radius))
}
