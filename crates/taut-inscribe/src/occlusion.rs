//! How much of a mesh bodies inside it hide: the share of lines through the mesh that also meet a body.
//!
//! *Problem.* Of all lines that meet a mesh, by the measure that no motion changes, which share also meets one of some bodies?
//! *Idea.* A view is a random direction with parallel lines through the points of a square grid, which a random shift moves. The
//! triangles of the mesh, and those of the bodies, are drawn on the grid: a line meets a triangle if its point is in the shadow.
//! *Guarantee.* None but the standard error: this is an estimate. Directions are uniform and all grids have one distance, so that
//! the expected numbers of lines are proportional to their measure (Cauchy–Crofton). The result is the same for every number of
//! threads.
//! *Trap.* Lines of one view are alike: the standard error counts views, not lines.
//! *Reference.* Santaló, Integral Geometry and Geometric Probability, 1976, chapter 12, for the measure; Cochran, Sampling
//! Techniques, 1977, section 6.4, for the error of a ratio.

use taut_certify::InscribedBodies;
use taut_points::parallel::IntoParallel;
use taut_points::{InputError, Monitor, PointSource, map_blocks};

use crate::Error;
use crate::bodies::check_dim;
use crate::random::Random;

/// Numbers of lines that can be asked for: fewer say nothing, more take hours.
const LINES: std::ops::RangeInclusive<u64> = 1_000..=1_000_000_000;

/// Views are the square root of the lines divided by this, so that a view of a million lines has 4,000.
const LINES_ROOT_PER_VIEW: f64 = 4.0;

/// The seeds of views differ by multiples of this odd number, which is not the step of the generator: its sequences do not meet
/// early (Steele and Vigna, Computationally easy, spectrally good multipliers, 2022).
const VIEW_STEP: u64 = 0xd134_2543_de82_ef95;

/// How to estimate an occlusion. Write `OcclusionOptions { lines: 1 << 16, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct OcclusionOptions<'a> {
    /// About how many lines are drawn, those that miss the mesh among them, from 1,000 to 10⁹. Default 2²⁰.
    pub lines: u64,
    /// Where the random choices begin. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for OcclusionOptions<'_> {
    fn default() -> Self {
        OcclusionOptions { lines: 1 << 20, seed: 0, monitor: Monitor::silent() }
    }
}

/// An estimate of how much of a mesh bodies hide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occlusion {
    /// The lines that met the mesh.
    pub lines: u64,
    /// Those that also met a body.
    pub hidden: u64,
    /// The share of the former, from 0 to 1; 0 where no line met the mesh.
    pub share: f64,
    /// The standard error of the share.
    pub standard_error: f64,
    /// Directions in which lines were drawn.
    pub views: u64,
    /// The least share of a view: how much of the silhouette bodies hide from the worst of these directions.
    pub least_view: f64,
}

/// Estimates the share of lines through a mesh that also meet one of the bodies inside it.
///
/// Rows are triangles, as for [`inscribed_bodies`](crate::inscribed_bodies()). O(v·n) for n triangles and v views.
///
/// # Errors
/// [`Error::Input`] for rows that are no triangles or not finite, for options out of range, and for what reading says.
pub fn occlusion(
    triangles: &dyn PointSource,
    answer: &InscribedBodies,
    options: &OcclusionOptions<'_>,
) -> Result<Occlusion, Error> {
    if !LINES.contains(&options.lines) {
        let (value, expected) = (options.lines.to_string(), "from 1000 to 1000000000");
        return Err(InputError::Option { name: "occlusion", value, expected }.into());
    }
    let mesh = rows(triangles, &options.monitor)?;
    let mut bodies = vec![];
    for body in &answer.bodies {
        let (vertices, facets) = answer.mesh(body);
        bodies.extend(facets.iter().map(|ids| ids.map(|id| vertices[id as usize])));
    }
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    // Points beside the mesh, rows with equal corners, meet no line.
    for corner in mesh.iter().filter(|[a, b, c]| a != b || b != c).flatten() {
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(corner[c]), high[c].max(corner[c]));
        }
    }
    let center = [0, 1, 2].map(|c| low[c] / 2.0 + high[c] / 2.0);
    let half = [0, 1, 2].map(|c| high[c] / 2.0 - low[c] / 2.0);
    let radius = half[0].hypot(half[1]).hypot(half[2]);
    let root = (options.lines as f64).sqrt();
    let views = (root / LINES_ROOT_PER_VIEW).ceil();
    let side = (options.lines as f64 / views).sqrt().ceil() as usize;
    let of_view = |view: u64| {
        options.monitor.check()?;
        let mut random = Random::new(options.seed ^ (view + 1).wrapping_mul(VIEW_STEP));
        let frame = Frame::random(center, radius, side, &mut random);
        let (mesh, bodies) = (frame.shadow(&mesh), frame.shadow(&bodies));
        let hidden = mesh.iter().zip(&bodies).filter(|(mesh, body)| **mesh && **body).count();
        Ok([mesh.iter().filter(|is_met| **is_met).count() as u64, hidden as u64])
    };
    let counts: Result<Vec<[u64; 2]>, taut_points::Cancelled> =
        (0..views as u64).into_par_iter().map(of_view).collect();
    Ok(summary(&counts?))
}

/// The estimate from the lines of each view that met the mesh, and those that met a body too.
fn summary(views: &[[u64; 2]]) -> Occlusion {
    let sum = |k: usize| views.iter().map(|counts| counts[k]).sum::<u64>();
    let (lines, hidden) = (sum(0), sum(1));
    let share = if lines > 0 { hidden as f64 / lines as f64 } else { 0.0 };
    let n = views.len() as f64;
    let residual = |counts: &[u64; 2]| (counts[1] as f64 - share * counts[0] as f64).powi(2);
    let variance = views.iter().map(residual).sum::<f64>() * n / (n - 1.0).max(1.0);
    let standard_error = if lines > 0 { variance.sqrt() / lines as f64 } else { 0.0 };
    let of_view = |&[all, some]: &[u64; 2]| if all > 0 { some as f64 / all as f64 } else { 1.0 };
    let least_view = views.iter().map(of_view).fold(1.0, f64::min);
    Occlusion { lines, hidden, share, standard_error, views: views.len() as u64, least_view }
}

/// The triangles of the mesh, without obstacles.
fn rows(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<Vec<[[f64; 3]; 3]>, Error> {
    check_dim(source)?;
    let blocks = map_blocks(source, monitor, |first, rows| {
        rows.check_finite(first)?;
        let (mut row, mut triangles) = ([0.0; 10], vec![]);
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row[..source.dim()]);
            let [a, b, c, d, e, f, g, h, i, surface] = row;
            if surface == 0.0 {
                triangles.push([[a, b, c], [d, e, f], [g, h, i]]);
            }
        }
        Ok::<_, Error>(triangles)
    })?;
    Ok(blocks.concat())
}

/// Returns a random direction, uniform on the sphere, and two directions across it and each other, all of length 1.
pub(crate) fn frame(random: &mut Random) -> [[f64; 3]; 3] {
    // A point of the disc is a point of the sphere; square roots are the same on all machines, unlike sines.
    let [x, y, square] = loop {
        let [x, y] = [random.unit(), random.unit()].map(|t| 2.0 * t - 1.0);
        if x * x + y * y < 1.0 {
            break [x, y, x * x + y * y];
        }
    };
    let root = (1.0 - square).sqrt();
    let along = [2.0 * x * root, 2.0 * y * root, 1.0 - 2.0 * square];
    let least = (0..3).min_by(|&a, &b| along[a].abs().total_cmp(&along[b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let one = cross(along, axis);
    let length = (one[0] * one[0] + one[1] * one[1] + one[2] * one[2]).sqrt();
    let one = one.map(|x| x / length);
    [along, one, cross(along, one)]
}

/// A view: a plane across the lines, with the grid of the points at which lines cross it.
struct Frame {
    center: [f64; 3],
    axes: [[f64; 3]; 2],
    /// The place of the first line along each axis, and the distance of lines.
    start: [f64; 2],
    distance: f64,
    /// Lines along each axis.
    side: usize,
}

impl Frame {
    fn random(center: [f64; 3], radius: f64, side: usize, random: &mut Random) -> Self {
        let [_, one, other] = frame(random);
        let distance = 2.0 * radius / side as f64;
        let start = [random.unit(), random.unit()].map(|shift| shift * distance - radius);
        Frame { center, axes: [one, other], start, distance, side }
    }

    /// For each line whether it meets a triangle.
    fn shadow(&self, triangles: &[[[f64; 3]; 3]]) -> Vec<bool> {
        let mut is_met = vec![false; self.side * self.side];
        for corners in triangles {
            // In distances of lines from the first one.
            let places = corners.map(|corner| {
                let off = [0, 1, 2].map(|c| corner[c] - self.center[c]);
                [0, 1].map(|k| {
                    let along: f64 = (0..3).map(|c| off[c] * self.axes[k][c]).sum();
                    (along - self.start[k]) / self.distance
                })
            });
            let heights = places.map(|place| place[1]);
            let low = heights.into_iter().fold(f64::INFINITY, f64::min);
            let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            for row in self.between(low, high) {
                let y = row as f64;
                let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
                for k in 0..3 {
                    let ([ax, ay], [bx, by]) = (places[k], places[(k + 1) % 3]);
                    if (ay > y) != (by > y) {
                        let x = ax + (y - ay) / (by - ay) * (bx - ax);
                        (left, right) = (left.min(x), right.max(x));
                    }
                }
                for column in self.between(left, right) {
                    is_met[row * self.side + column] = true;
                }
            }
        }
        is_met
    }

    /// The lines between two places; none where these are in no order.
    fn between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        // The cast takes what is negative to 0, and what is too large to the largest number.
        low.ceil() as usize..((high.floor() + 1.0) as usize).min(self.side)
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_and_their_errors_are_those_of_the_formulas() {
        let found = summary(&[[100, 50], [200, 140], [100, 90]]);
        assert_eq!((found.lines, found.hidden, found.views), (400, 280, 3));
        assert_eq!((found.share, found.least_view), (0.7, 0.5));
        // Residuals −20, 0 and 20: √(800·3/2)/400.
        assert!((found.standard_error - 1200f64.sqrt() / 400.0).abs() < 1e-15);
        let none = summary(&[[0, 0], [0, 0]]);
        assert_eq!((none.share, none.standard_error, none.least_view), (0.0, 0.0, 1.0));
    }

    #[test]
    fn shadows_are_those_of_the_triangles() {
        let mut random = Random::new(3);
        for _ in 0..40 {
            let frame = Frame::random([1.0, 2.0, 3.0], 2.0, 16, &mut random);
            let corner = |random: &mut Random| {
                [1.0, 2.0, 3.0].map(|center| center + 2.0 * (random.unit() - 0.5))
            };
            let triangle = [corner(&mut random), corner(&mut random), corner(&mut random)];
            let found = frame.shadow(&[triangle]);
            let place = |p: [f64; 3]| {
                [0, 1].map(|k| {
                    (0..3).map(|c| (p[c] - frame.center[c]) * frame.axes[k][c]).sum::<f64>()
                })
            };
            let [a, b, c] = triangle.map(place);
            for (at, is_met) in found.iter().enumerate() {
                let p = [at % 16, at / 16];
                let p = [0, 1].map(|k| frame.start[k] + frame.distance * p[k] as f64);
                let turn = |a: [f64; 2], b: [f64; 2]| {
                    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
                };
                let turns = [turn(a, b), turn(b, c), turn(c, a)];
                let is_in = turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0);
                assert_eq!(*is_met, is_in, "{p:?} in {triangle:?}");
            }
        }
    }
}
