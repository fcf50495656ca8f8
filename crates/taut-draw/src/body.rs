//! The ellipsoid {c + Xy : |y| ≤ 1}, and the items it encloses, as shapes with shadows.
//!
//! *Idea.* X is the inverse of F, within the hull where there is one. The shadow of the ellipsoid on some coordinates
//! is that of their rows of X alone: {c_J + X_J y : |y| ≤ 1}, whose shape matrix is the block J of the inverse of Q.
//! *Scale.* F is divided by its largest entry s and offsets are multiplied by it, so that no square overflows.

use taut_certify::{Ellipsoid, Items};
use taut_points::OrderBy;

use crate::item_pass::Measure;
use crate::project::dot;

/// An ellipsoid, ready to be drawn.
pub(crate) struct Body {
    pub(crate) center: Vec<f64>,
    tail: Vec<f64>,
    /// F/s, by rows.
    factor: Vec<Vec<f64>>,
    /// X·s, by rows: d rows of r numbers.
    axes: Vec<Vec<f64>>,
    scale: f64,
}

impl Body {
    pub(crate) fn of(ellipsoid: &Ellipsoid) -> Self {
        let largest = ellipsoid.factor.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let factor: Vec<Vec<f64>> =
            ellipsoid.factor.iter().map(|row| row.iter().map(|v| v / scale).collect()).collect();
        let dim = ellipsoid.dim();
        let axes = match &ellipsoid.hull {
            None => inverse(&factor),
            Some(hull) => {
                let square: Vec<Vec<f64>> =
                    factor.iter().map(|f| hull.basis.iter().map(|b| dot(f, b)).collect()).collect();
                let within = inverse(&square);
                let rank = hull.basis.len();
                let entry = |j: usize, k: usize| -> f64 {
                    (0..rank).map(|i| hull.basis[i][j] * within[i][k]).sum()
                };
                (0..dim).map(|j| (0..rank).map(|k| entry(j, k)).collect()).collect()
            }
        };
        let center = ellipsoid.center.clone();
        Body { center, tail: ellipsoid.center_tail.clone(), factor, axes, scale }
    }

    /// {c + Xy : |y| ≤ 1} for a square X, by rows.
    pub(crate) fn of_axes(center: &[f64], axes: &[Vec<f64>]) -> Self {
        let largest = axes.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let axes: Vec<Vec<f64>> =
            axes.iter().map(|row| row.iter().map(|v| v * scale).collect()).collect();
        Body { center: center.to_vec(), tail: vec![], factor: inverse(&axes), axes, scale }
    }

    pub(crate) fn rank(&self) -> usize {
        self.factor.len()
    }

    /// Returns how far the ellipsoid reaches from its center along a coordinate.
    pub(crate) fn half_width(&self, j: usize) -> f64 {
        let row: Vec<f64> = self.axes[j].iter().map(|v| v / self.scale).collect();
        length(&row)
    }

    /// The correlation of two coordinates: the cosine of the angle between their rows of X, 0 where one is constant.
    pub(crate) fn correlation(&self, j: usize, k: usize) -> f64 {
        cosine(&self.axes[j], &self.axes[k])
    }

    /// The shadow on two coordinates.
    pub(crate) fn shadow(&self, j: usize, k: usize) -> Shadow {
        self.shadow_of_rows(&self.axes[j], &self.axes[k])
    }

    pub(crate) fn shadow_along(&self, directions: &[Vec<f64>; 2]) -> Shadow {
        let [a, b] = directions.each_ref().map(|direction| -> Vec<f64> {
            let along =
                |k: usize| direction.iter().zip(&self.axes).map(|(u, row)| u * row[k]).sum();
            (0..self.rank()).map(along).collect()
        });
        self.shadow_of_rows(&a, &b)
    }

    fn shadow_of_rows(&self, a: &[f64], b: &[f64]) -> Shadow {
        let correlation = cosine(a, b);
        let [a, b] = [a, b].map(|row| row.iter().map(|v| v / self.scale).collect::<Vec<f64>>());
        let wide = length(&a);
        let slope = if wide > 0.0 { correlation * length(&b) } else { 0.0 };
        let rest: Vec<f64> = b
            .iter()
            .zip(&a)
            .map(|(b, a)| if wide > 0.0 { b - slope * (a / wide) } else { *b })
            .collect();
        Shadow([[wide, 0.0], [slope, length(&rest)]])
    }

    /// The cut through the center along two coordinates: {v : |F(vⱼeⱼ + vₖeₖ)| ≤ 1}.
    pub(crate) fn cut(&self, j: usize, k: usize) -> Shadow {
        let column = |j: usize| -> Vec<f64> { self.factor.iter().map(|row| row[j]).collect() };
        let (a, b) = (column(j), column(k));
        let (tall, part) = (length(&b), dot(&a, &b));
        let tilt = if tall > 0.0 { part / tall / tall } else { 0.0 };
        let rest: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - tilt * b).collect();
        let wide = 1.0 / length(&rest);
        let size = |v: f64| v / self.scale;
        Shadow([[size(wide), 0.0], [size(-tilt * wide), size(1.0 / tall)]])
    }

    /// X as columns along the axes of the ellipsoid, the longest first; for three dimensions at most.
    pub(crate) fn principal(&self) -> Vec<Vec<f64>> {
        let rank = self.rank();
        let mut columns: Vec<Vec<f64>> =
            (0..rank).map(|k| self.axes.iter().map(|row| row[k] / self.scale).collect()).collect();
        // One-sided Jacobi rotations: columns are turned in pairs until they are orthogonal.
        for _ in 0..SWEEPS_MAX {
            for a in 0..rank {
                for b in a + 1..rank {
                    let (la, lb) = (length(&columns[a]), length(&columns[b]));
                    if la == 0.0 || lb == 0.0 {
                        continue;
                    }
                    let ratio = lb / la;
                    let cosine: f64 =
                        columns[a].iter().zip(&columns[b]).map(|(x, y)| (x / la) * (y / lb)).sum();
                    let angle = 0.5 * (2.0 * cosine * ratio).atan2(1.0 - ratio * ratio);
                    let (sin, cos) = angle.sin_cos();
                    for j in 0..columns[a].len() {
                        let (x, y) = (columns[a][j], columns[b][j]);
                        columns[a][j] = cos * x + sin * y;
                        columns[b][j] = cos * y - sin * x;
                    }
                }
            }
        }
        columns.order_by(&|a, b| length(b).total_cmp(&length(a)));
        columns
    }
}

/// Three columns are orthogonal to rounding after a handful.
const SWEEPS_MAX: usize = 12;

impl Measure for Body {
    fn dim(&self) -> usize {
        self.center.len()
    }

    fn offset(&self, row: &[f64]) -> Vec<f64> {
        let tails = self.tail.iter().copied().chain(std::iter::repeat(0.0));
        let places = row.iter().zip(&self.center).zip(tails);
        places.map(|((x, c), tail)| ((x - c) - tail) * self.scale).collect()
    }

    /// |F(x − c)| at the farthest point of the item; for balls and ellipsoids found by climbing from their center.
    fn part(&self, row: &[f64], items: Items) -> f64 {
        let image =
            |offset: &[f64]| -> Vec<f64> { self.factor.iter().map(|f| dot(f, offset)).collect() };
        let mut image_here = image(&self.offset(row));
        if items == Items::Points {
            return length(&image_here);
        }
        let dim = self.dim();
        let mut best = length(&image_here);
        for _ in 0..CLIMB_STEPS {
            let upwards: Vec<f64> = (0..dim)
                .map(|j| self.factor.iter().zip(&image_here).map(|(f, y)| f[j] * y).sum())
                .collect();
            // From the very center no way leads up: any direction will do to leave it.
            let upwards = if length(&upwards) > 0.0 { upwards } else { vec![1.0; dim] };
            let point = touching(items, dim, row, &upwards);
            image_here = image(&self.offset(&point));
            best = best.max(length(&image_here));
        }
        best
    }
}

/// The climb has this many steps: for a picture, the first few tell all.
const CLIMB_STEPS: usize = 12;

/// How far an item reaches from a place, by climbing from its center, a little beside the straight way so that it does not stay between
/// two ways up.
pub(crate) fn reach_from(items: Items, dim: usize, row: &[f64], place: &[f64]) -> f64 {
    let offset =
        |point: &[f64]| -> Vec<f64> { point.iter().zip(place).map(|(x, c)| x - c).collect() };
    let mut here = offset(&row[..dim]);
    let mut best = length(&here);
    let aside = if best > 0.0 { GAP_BESIDE_BODIES * best } else { 1.0 };
    here.iter_mut().for_each(|x| *x += aside);
    for _ in 0..CLIMB_STEPS {
        here = offset(&touching(items, dim, row, &here));
        best = best.max(length(&here));
    }
    best
}

/// A climb begins this part of the way beside it, along every axis.
const GAP_BESIDE_BODIES: f64 = 1e-2;

/// The point of an item that lies farthest in a direction.
pub(crate) fn touching(items: Items, dim: usize, row: &[f64], direction: &[f64]) -> Vec<f64> {
    let center = &row[..dim];
    let long = length(direction);
    let unit: Vec<f64> =
        direction.iter().map(|v| if long > 0.0 { v / long } else { 0.0 }).collect();
    let step: Vec<f64> = match items {
        Items::Points => vec![0.0; dim],
        Items::Balls => unit.iter().map(|v| v * row[dim]).collect(),
        Items::Ellipsoids => {
            let along: Vec<f64> =
                (0..dim).map(|j| (0..dim).map(|k| entry(dim, row, j, k) * unit[k]).sum()).collect();
            let square = dot(&along, &unit);
            let root = square.max(0.0).sqrt();
            along.iter().map(|v| if root > 0.0 { v / root } else { 0.0 }).collect()
        }
    };
    center.iter().zip(step).map(|(c, s)| c + s).collect()
}

/// An entry of the shape matrix of an ellipsoid given by its row.
fn entry(dim: usize, row: &[f64], j: usize, k: usize) -> f64 {
    row[dim + j.max(k) * (j.max(k) + 1) / 2 + j.min(k)]
}

/// An ellipse {L·(cos t, sin t)} about some place, L lower triangular.
#[derive(Clone, Copy)]
pub(crate) struct Shadow(pub(crate) [[f64; 2]; 2]);

impl Shadow {
    /// The shadow on two directions of an ellipsoid given by its row.
    pub(crate) fn of_row(row: &[f64], directions: &[Vec<f64>; 2]) -> Self {
        let dim = directions[0].len();
        let square = |u: &[f64], v: &[f64]| -> f64 {
            let along = |j: usize| (0..dim).map(|k| entry(dim, row, j, k) * v[k]).sum::<f64>();
            (0..dim).map(|j| u[j] * along(j)).sum()
        };
        let [u, v] = directions;
        Shadow::of_squares([square(u, u), square(u, v), square(v, v)])
    }

    /// The shadow of an item on two coordinates; `None` for points.
    pub(crate) fn of_item(
        items: Items,
        dim: usize,
        row: &[f64],
        j: usize,
        k: usize,
    ) -> Option<Self> {
        match items {
            Items::Points => None,
            Items::Balls => Some(Shadow([[row[dim], 0.0], [0.0, row[dim]]])),
            Items::Ellipsoids => {
                let squares = [(j, j), (j, k), (k, k)].map(|(j, k)| entry(dim, row, j, k));
                Some(Shadow::of_squares(squares))
            }
        }
    }

    /// L of LLᵀ, a 2 × 2 matrix given by its entries.
    fn of_squares([first, mixed, second]: [f64; 3]) -> Self {
        let wide = first.max(0.0).sqrt();
        let slope = if wide > 0.0 { mixed / wide } else { 0.0 };
        let rest = (second - slope * slope).max(0.0).sqrt();
        Shadow([[wide, 0.0], [slope, rest]])
    }

    /// The ellipse as a chain of `steps` corners about a center, each axis in its own scale.
    pub(crate) fn chain(&self, center: [f64; 2], part: f64, steps: usize) -> Vec<[f64; 2]> {
        let [[a, _], [b, c]] = self.0;
        let corner = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / steps as f64).sin_cos();
            [center[0] + part * a * cos, center[1] + part * (b * cos + c * sin)]
        };
        (0..steps).map(corner).collect()
    }
}

/// The cosine of the angle between two vectors, 0 where one vanishes.
fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let product = length(a) * length(b);
    if product > 0.0 { dot(a, b) / product } else { 0.0 }
}

/// The length of a vector, whatever its size.
pub(crate) fn length(x: &[f64]) -> f64 {
    let largest = x.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || largest.is_infinite() {
        return largest;
    }
    largest * x.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// The inverse of a square matrix, by elimination with pivots chosen by their size beside the largest entry of their row.
/// Where a pivot is 0 the row stays as it is: the picture of a singular factor is no picture of anything.
fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let mut rows: Vec<Vec<f64>> = matrix
        .iter()
        .enumerate()
        .map(|(i, row)| {
            let size = row.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let size = if size > 0.0 { size } else { 1.0 };
            let unit = (0..n).map(|k| if k == i { 1.0 } else { 0.0 });
            row.iter().copied().chain(unit).map(|v| v / size).collect()
        })
        .collect();
    for k in 0..n {
        let best =
            (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).unwrap_or(k);
        rows.swap(k, best);
        let pivot = rows[k][k];
        if pivot == 0.0 {
            continue;
        }
        rows[k].iter_mut().for_each(|v| *v /= pivot);
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[k];
            if i != k && factor != 0.0 {
                row.iter_mut().zip(&pivot_row).for_each(|(v, p)| *v -= factor * p);
            }
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}
