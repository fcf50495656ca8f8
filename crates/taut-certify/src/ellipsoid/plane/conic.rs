//! Conics through points of the plane, as equations in whole numbers.

use std::cmp::Ordering;

use crate::arithmetic::{Integer, Ring, U, parts};

/// Points as whole multiples of 2^unit, relative to the first of them.
pub(super) struct Grid {
    pub(super) origin: [f64; 2],
    pub(super) unit: i32,
    pub(super) points: Vec<[Integer; 2]>,
    /// The largest coordinate of a difference, in absolute value.
    extent: f64,
}

impl Grid {
    pub(super) fn of(points: &[[f64; 2]]) -> Self {
        let origin = points[0];
        let unit = points.iter().flatten().map(|&v| lowest(v)).min().unwrap_or(0);
        let extent = points
            .iter()
            .fold(0.0f64, |m, p| m.max((p[0] - origin[0]).abs()).max((p[1] - origin[1]).abs()));
        let points = points.iter().map(|&p| difference(p, origin, unit)).collect();
        Grid { origin, unit, points, extent }
    }

    /// The line through points i and j: positive to its left.
    pub(super) fn line(&self, i: usize, j: usize) -> Line {
        let ([px, py], [qx, qy]) = (&self.points[i], &self.points[j]);
        Line([py.minus(qy), qx.minus(px), px.times(qy).minus(&py.times(qx))])
    }
}

/// The exponent below which a number has no bit; that of 1 for 0, which has none at all.
fn lowest(value: f64) -> i32 {
    if value == 0.0 { 0 } else { parts(value).1 }
}

/// (p − q)/2^unit.
fn difference(p: [f64; 2], q: [f64; 2], unit: i32) -> [Integer; 2] {
    let whole = |v: f64| Integer::scaled(v, unit);
    [whole(p[0]).minus(&whole(q[0])), whole(p[1]).minus(&whole(q[1]))]
}

/// AX + BY + C.
pub(super) struct Line([Integer; 3]);

impl Line {
    pub(super) fn at(&self, [x, y]: &[Integer; 2]) -> Integer {
        let Line([a, b, c]) = self;
        a.times(x).plus(&b.times(y)).plus(c)
    }

    /// The product of two lines that meet in the origin, or of which one goes through it: no constant is left.
    pub(super) fn times(&self, other: &Line) -> Equation {
        let (Line([a, b, c]), Line([p, q, r])) = (self, other);
        Equation([
            a.times(p),
            a.times(q).plus(&b.times(p)),
            b.times(q),
            a.times(r).plus(&c.times(p)),
            b.times(r).plus(&c.times(q)),
        ])
    }
}

/// aX² + bXY + cY² + dX + eY, which is 0 in the origin of its grid.
#[derive(Clone)]
pub(super) struct Equation(pub(super) [Integer; 5]);

impl Equation {
    pub(super) fn plus(&self, other: &Equation) -> Equation {
        Equation(std::array::from_fn(|i| self.0[i].plus(&other.0[i])))
    }

    pub(super) fn times(&self, factor: &Integer) -> Equation {
        Equation(std::array::from_fn(|i| self.0[i].times(factor)))
    }

    /// The conic through the points of a grid, of which there are five: minors of their monomials.
    pub(super) fn through(grid: &Grid) -> Equation {
        let rows: Vec<[Integer; 5]> = grid.points[1..]
            .iter()
            .map(|[x, y]| [x.times(x), x.times(y), y.times(y), x.clone(), y.clone()])
            .collect();
        let zero = Integer::scaled(0.0, 0);
        Equation(std::array::from_fn(|skip| {
            let columns: Vec<usize> = (0..5).filter(|&c| c != skip).collect();
            let minor = determinant(&rows, &columns);
            if skip % 2 == 0 { minor } else { zero.minus(&minor) }
        }))
    }

    /// The value times a positive number, at a point given in the coordinates of the input.
    pub(super) fn at(&self, grid: &Grid, point: [f64; 2]) -> Integer {
        let unit = grid.unit.min(lowest(point[0])).min(lowest(point[1]));
        let [x, y] = difference(point, grid.origin, unit);
        let finer = Integer::scaled(1.0, unit - grid.unit);
        let [a, b, c, d, e] = &self.0;
        let linear = d.times(&x).plus(&e.times(&y)).times(&finer);
        a.times(&x).plus(&b.times(&y)).times(&x).plus(&c.times(&y).times(&y)).plus(&linear)
    }
}

/// By expansion along the first of the rows.
fn determinant(rows: &[[Integer; 5]], columns: &[usize]) -> Integer {
    let (row, rest) = rows.split_first().expect("as many rows as columns");
    if rest.is_empty() {
        return row[columns[0]].clone();
    }
    let mut sum = Integer::scaled(0.0, 0);
    for (k, &column) in columns.iter().enumerate() {
        let others: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
        let term = row[column].times(&determinant(rest, &others));
        sum = if k % 2 == 0 { sum.plus(&term) } else { sum.minus(&term) };
    }
    sum
}

/// An ellipse through the origin of its grid: its equation is negative inside.
pub(super) struct Ellipse {
    pub(super) equation: Equation,
    quick: Option<FloatEquation>,
}

impl Ellipse {
    /// `None` for what is no ellipse.
    pub(super) fn of(equation: Equation, grid: &Grid) -> Option<Self> {
        let [a, b, c, ..] = &equation.0;
        let four = Integer::scaled(4.0, 0);
        if four.times(&a.times(c)).minus(&b.times(b)).sign().is_le() {
            return None;
        }
        let minus = Integer::scaled(-1.0, 0);
        let equation = if a.sign().is_lt() { equation.times(&minus) } else { equation };
        let quick = FloatEquation::of(&equation, grid);
        Some(Ellipse { equation, quick })
    }

    /// Less inside, equal on the border.
    pub(super) fn side(&self, grid: &Grid, point: [f64; 2]) -> Ordering {
        self.equation.at(grid, point).sign()
    }

    /// The same, if `f64` can tell.
    pub(super) fn quick_side(&self, grid: &Grid, point: [f64; 2]) -> Option<Ordering> {
        self.quick.as_ref()?.side(grid.origin, point)
    }
}

/// The equation in `f64`, in coordinates of extent about 1, each coefficient right to 2u.
struct FloatEquation {
    coefficients: [f64; 5],
    scale: f64,
}

impl FloatEquation {
    /// `None` where numbers would leave the range of `f64`.
    fn of(equation: &Equation, grid: &Grid) -> Option<Self> {
        let exponent = parts(grid.extent).1 + 63 - parts(grid.extent).0.leading_zeros() as i32;
        if grid.extent.is_nan() || grid.extent <= 0.0 || exponent.abs() > 900 {
            return None;
        }
        // One step of the grid is 2^−places in the new coordinates.
        let places = i64::from(exponent) - i64::from(grid.unit);
        let sizes: Vec<(f64, i64)> = equation
            .0
            .iter()
            .enumerate()
            .map(|(i, c)| {
                let (mantissa, own) = c.approximately();
                (mantissa, own + if i < 3 { 2 * places } else { places })
            })
            .collect();
        let largest = sizes.iter().filter(|s| s.0 != 0.0).map(|s| s.1).max()?;
        let mut coefficients = [0.0; 5];
        for (coefficient, (mantissa, own)) in coefficients.iter_mut().zip(sizes) {
            let less = i32::try_from(largest - own).unwrap_or(i32::MAX);
            if mantissa != 0.0 && less > 800 {
                return None;
            }
            *coefficient = if mantissa == 0.0 { 0.0 } else { mantissa * 2f64.powi(-less) };
        }
        Some(FloatEquation { coefficients, scale: 2f64.powi(-exponent) })
    }

    fn side(&self, origin: [f64; 2], point: [f64; 2]) -> Option<Ordering> {
        let (x, y) = ((point[0] - origin[0]) * self.scale, (point[1] - origin[1]) * self.scale);
        let [a, b, c, d, e] = self.coefficients;
        let terms = [a * x * x, b * x * y, c * y * y, d * x, e * y];
        let sum: f64 = terms.iter().sum();
        let size: f64 = terms.iter().map(|t| t.abs()).sum();
        // Of each term: 2u its coefficient, 2u differences, 2u products; 4u the sums. What underflows is far less than
        // the smallest normal number.
        let is_sure = sum.abs() > 32.0 * U * size + 1e-280;
        is_sure.then(|| sum.total_cmp(&0.0))
    }
}
