//! The decision map of a classifier in the plane: which class each place belongs to, and how clearly (thesis, figure 55).
//!
//! *Idea.* A grid of discs in the tone of the class; a disc is the larger, the better the place fits its class. Borders between classes
//! are followed from cell to cell of a finer grid.

use taut_points::OrderBy;

use crate::marks::dot_size;
use crate::number::{count, counted};
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone};

/// Discs along the longer side.
const DISCS: usize = 48;
/// Cells of the grid of borders for each disc.
const CELLS_PER_DISC: usize = 4;
/// The margin around the points, as a part of their extent.
const MARGIN: f64 = 0.12;
/// Radii of the discs of the least and of the most certain place, in pixels.
const RADII: [f64; 2] = [0.7, 3.2];
/// Tones of the classes; more classes than tones come round again.
const TONES: [Tone; 7] = [
    Tone::Answer,
    Tone::Support,
    Tone::Bound,
    Tone::Second,
    Tone::Third,
    Tone::Fourth,
    Tone::Point,
];

/// Labeled points in the plane.
#[derive(Clone, Copy, Debug)]
pub struct DecisionPoints<'a> {
    /// The points.
    pub points: &'a [[f64; 2]],
    /// The number of the class of each.
    pub labels: &'a [u32],
    /// The names of the classes.
    pub classes: &'a [String],
}

/// The map of a classifier: `decide` says for a place the class, if it is not rejected, and a score that is the larger, the better the
/// place fits. Sizes of discs follow the rank of a score within its class.
///
/// # Errors
/// [`Error::NonFinite`], [`Error::Mismatch`] for labels that do not belong to the points, and [`Error::Option`].
pub fn decision_figure(
    data: DecisionPoints<'_>,
    decide: &dyn Fn([f64; 2]) -> (Option<u32>, f64),
    options: &DrawOptions,
) -> Result<Figure, Error> {
    options.check()?;
    let DecisionPoints { points, labels, classes } = data;
    crate::marks::agree("number of labels", labels.len(), points.len())?;
    crate::marks::all_finite(points.as_flattened().iter().map(|x| ("a coordinate", x)))?;
    let grid = Grid::around(points);
    let discs = grid.discs(decide);
    let mut layers = vec![];
    for (class, name) in (0..).zip(classes) {
        let tone = TONES[class as usize % TONES.len()];
        layers.push(layer("", tone, Shape2::Points(sized(&discs, class))));
        let own = points.iter().zip(labels).enumerate().filter(|(_, (_, label))| **label == class);
        let point = |(row, (at, _)): (usize, (&[f64; 2], &u32))| Point2 {
            id: Some(row as u64),
            at: *at,
            size: dot_size(points.len()).max(2.5) + 1.5,
            label: name.clone(),
        };
        let step = points.len().div_ceil(options.max_points);
        layers.push(layer(name, tone, Shape2::Points(own.step_by(step).map(point).collect())));
    }
    layers.push(layer("border", Tone::Ink, Shape2::Polylines(grid.borders(decide))));
    let rejected = discs.iter().filter(|disc| disc.1.is_none()).count();
    let rejection = match rejected {
        0 => String::new(),
        _ => format!(
            " {} of {} places are rejected: they have no disc.",
            count(rejected as u64),
            count(discs.len() as u64)
        ),
    };
    Ok(Figure::Plane(Scene2 {
        title: format!("Decision map of {} classes", classes.len()),
        caption: format!(
            "{} and the class of each place of a grid; the larger a disc, the better the place fits its class.{rejection}",
            counted(points.len() as u64, "point")
        ),
        x: options.axis(0, 2),
        y: options.axis(1, 2),
        aspect: Aspect::Free,
        layers,
        width: options.width,
        height: options.height,
    }))
}

fn layer(name: &str, tone: Tone, shape: Shape2) -> Layer2 {
    Layer2 { name: name.to_owned(), tone, line_style: LineStyle::Solid, shape }
}

/// A place, its class and its score.
type Disc = ([f64; 2], Option<u32>, f64);

/// The discs of a class, the larger the higher the rank of the score.
fn sized(discs: &[Disc], class: u32) -> Vec<Point2> {
    let mut own: Vec<&Disc> = discs.iter().filter(|disc| disc.1 == Some(class)).collect();
    own.order_by(&|a, b| a.2.total_cmp(&b.2));
    let last = own.len().saturating_sub(1).max(1) as f64;
    let disc = |(rank, disc): (usize, &&Disc)| Point2 {
        id: None,
        at: disc.0,
        size: RADII[0] + (RADII[1] - RADII[0]) * rank as f64 / last,
        label: String::new(),
    };
    own.iter().enumerate().map(disc).collect()
}

/// The places of a picture.
struct Grid {
    low: [f64; 2],
    extent: [f64; 2],
}

impl Grid {
    fn around(points: &[[f64; 2]]) -> Self {
        let (mut low, mut extent) = ([0.0; 2], [1.0; 2]);
        for c in 0..2 {
            let along = || points.iter().map(|p| p[c]);
            let least = along().fold(f64::INFINITY, f64::min);
            let most = along().fold(f64::NEG_INFINITY, f64::max);
            if least <= most {
                let width = if most > least { most - least } else { 1.0 };
                low[c] = least - MARGIN * width;
                extent[c] = width * (1.0 + 2.0 * MARGIN);
            }
        }
        Grid { low, extent }
    }

    fn at(&self, i: usize, j: usize, cells: usize) -> [f64; 2] {
        let along =
            |k: usize, c: usize| self.low[c] + (k as f64 + 0.5) / cells as f64 * self.extent[c];
        [along(i, 0), along(j, 1)]
    }

    fn discs(&self, decide: &dyn Fn([f64; 2]) -> (Option<u32>, f64)) -> Vec<Disc> {
        let disc = |k: usize| {
            let at = self.at(k % DISCS, k / DISCS, DISCS);
            let (class, score) = decide(at);
            (at, class, score)
        };
        (0..DISCS * DISCS).map(disc).collect()
    }

    /// The sides of cells whose two cells have different classes.
    fn borders(&self, decide: &dyn Fn([f64; 2]) -> (Option<u32>, f64)) -> Vec<Vec<[f64; 2]>> {
        let cells = DISCS * CELLS_PER_DISC;
        let class = |k: usize| decide(self.at(k % cells, k / cells, cells)).0;
        let classes: Vec<Option<u32>> = (0..cells * cells).map(class).collect();
        let half = [0, 1].map(|c| 0.5 * self.extent[c] / cells as f64);
        let mut segments = vec![];
        for j in 0..cells {
            for i in 0..cells {
                let own = classes[j * cells + i];
                let [x, y] = self.at(i, j, cells);
                if i + 1 < cells && classes[j * cells + i + 1] != own {
                    segments.push(vec![[x + half[0], y - half[1]], [x + half[0], y + half[1]]]);
                }
                if j + 1 < cells && classes[(j + 1) * cells + i] != own {
                    segments.push(vec![[x - half[0], y + half[1]], [x + half[0], y + half[1]]]);
                }
            }
        }
        segments
    }
}
