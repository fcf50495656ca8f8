//! Three to five points of the plane, none of which can be spared, and their smallest ellipse.
//!
//! *Three.* With l₁, l₂, l₃ positive inside the triangle, one for each side, and barycentric coordinates lᵢ/Σl, Steiner's
//! ellipse is l₁l₂ + l₂l₃ + l₃l₁ ≥ 0.
//! *Four.* Through the corners of a convex quadrangle go the conics C₁ + tC₂ = 0, C₁ and C₂ the products of opposite
//! sides; those of t in an open interval are ellipses. Their squared area is in proportion to D₃²/D₂³, D₂ and D₃ being
//! the discriminant and the determinant, polynomials in t; so the least area is where g = 2D₃′D₂ − 3D₃D₂′ is 0. It is
//! enclosed between two neighboring `f64` by exact signs. What lies in the ellipses of both lies in that of every t
//! between; for what does not, the conic through the point has the t = −C₁/C₂, and the sign of g there decides.
//! *Five.* One conic goes through them.

use std::cmp::Ordering;

use super::conic::{Ellipse, Equation, Grid};
use crate::arithmetic::{Integer, Ring, parts};

type Point = [f64; 2];

/// Points that all lie on the border of their smallest ellipse, and are all needed for it.
pub(super) struct Basis {
    grid: Grid,
    shape: Shape,
}

enum Shape {
    /// The ellipse has an equation in whole numbers.
    Known(Box<Ellipse>),
    /// It lies between two that have.
    Between(Box<Pencil>),
}

impl Basis {
    /// `None` if points can be spared, or lie on no ellipse.
    pub(super) fn of(points: &[Point]) -> Option<Basis> {
        match points.len() {
            3 => Basis::steiner(points),
            4 => {
                let needed = |i: usize| {
                    let (point, others) = without(points, i);
                    Basis::steiner(&others).is_some_and(|basis| basis.side(point).is_gt())
                };
                let order = convex_order(points)?;
                (0..4).all(needed).then(|| Basis::pencil(&order))?
            }
            5 => {
                let needed = |i: usize| {
                    let (point, others) = without(points, i);
                    Basis::of_four(&others).is_some_and(|basis| basis.side(point).is_gt())
                };
                if !(0..5).all(needed) {
                    return None;
                }
                let grid = Grid::of(points);
                let ellipse = Ellipse::of(Equation::through(&grid), &grid)?;
                Some(Basis { grid, shape: Shape::Known(Box::new(ellipse)) })
            }
            _ => None,
        }
    }

    fn of_four(points: &[Point]) -> Option<Basis> {
        let three = (0..4).find_map(|i| {
            let (point, others) = without(points, i);
            Basis::steiner(&others).filter(|basis| basis.side(point).is_le())
        });
        three.or_else(|| Basis::of(points))
    }

    fn steiner(points: &[Point]) -> Option<Basis> {
        let grid = Grid::of(points);
        let [first, second, third] = [grid.line(1, 2), grid.line(2, 0), grid.line(0, 1)];
        let products = first.times(&second).plus(&third.times(&first)).plus(&second.times(&third));
        let ellipse = Ellipse::of(products, &grid)?;
        Some(Basis { grid, shape: Shape::Known(Box::new(ellipse)) })
    }

    fn pencil(order: &[Point]) -> Option<Basis> {
        let grid = Grid::of(order);
        let pencil = Pencil::of(&grid)?;
        Some(Basis { grid, shape: Shape::Between(Box::new(pencil)) })
    }

    /// Less inside the ellipse, equal on its border.
    pub(super) fn side(&self, point: Point) -> Ordering {
        match &self.shape {
            Shape::Known(ellipse) => ellipse.side(&self.grid, point),
            Shape::Between(pencil) => pencil.side(&self.grid, point),
        }
    }

    /// The same, if `f64` can tell.
    pub(super) fn quick_side(&self, point: Point) -> Option<Ordering> {
        match &self.shape {
            Shape::Known(ellipse) => ellipse.quick_side(&self.grid, point),
            Shape::Between(pencil) => {
                let [low, high] = &pencil.ends;
                let side = low.quick_side(&self.grid, point)?;
                (high.quick_side(&self.grid, point)? == side).then_some(side)
            }
        }
    }
}

fn without(points: &[Point], i: usize) -> (Point, Vec<Point>) {
    let mut others = points.to_vec();
    (others.remove(i), others)
}

/// The corners of a strictly convex quadrangle, counter-clockwise.
fn convex_order(points: &[Point]) -> Option<Vec<Point>> {
    let orders =
        [[0, 1, 2, 3], [0, 1, 3, 2], [0, 2, 1, 3], [0, 3, 2, 1], [0, 2, 3, 1], [0, 3, 1, 2]];
    let grid = Grid::of(points);
    let turns_left = |order: &[usize; 4]| {
        (0..4).all(|k| {
            let [i, j, l] = [order[k], order[(k + 1) % 4], order[(k + 2) % 4]];
            grid.line(i, j).at(&grid.points[l]).sign().is_gt()
        })
    };
    let order = orders.into_iter().find(turns_left)?;
    Some(order.map(|i| points[i]).to_vec())
}

/// The conics C₁ + tC₂ = 0 through four points, and the one of least area.
struct Pencil {
    first: Equation,
    second: Equation,
    /// g, with the sign that makes it negative below the best t.
    slope: Polynomial,
    /// The ellipses of the t on both sides of the best.
    ends: [Ellipse; 2],
}

impl Pencil {
    fn of(grid: &Grid) -> Option<Self> {
        let first = grid.line(0, 1).times(&grid.line(2, 3));
        let second = grid.line(3, 0).times(&grid.line(1, 2));
        let [a, b, c, d, e] =
            [0, 1, 2, 3, 4].map(|i| Polynomial(vec![first.0[i].clone(), second.0[i].clone()]));
        let discriminant = a.times(&c).by(4.0).minus(&b.times(&b));
        let determinant =
            b.times(&d).times(&e).minus(&a.times(&e).times(&e)).minus(&c.times(&d).times(&d));
        let change = discriminant.derivative();
        let slope = determinant
            .derivative()
            .times(&discriminant)
            .by(2.0)
            .minus(&determinant.times(&change).by(3.0));
        // Positive numbers are ordered as their bits are.
        let (mut low, mut high) = (1e-200f64.to_bits(), 1e200f64.to_bits());
        let mut sign = None;
        while low + 1 < high {
            let middle = low + (high - low) / 2;
            let t = f64::from_bits(middle);
            let before = if discriminant.sign(t).is_gt() {
                // D₃ has one sign on all ellipses.
                let sign = *sign.get_or_insert_with(|| determinant.sign(t));
                let rises = if sign.is_lt() { slope.sign(t).reverse() } else { slope.sign(t) };
                match rises {
                    Ordering::Less => true,
                    Ordering::Greater => false,
                    Ordering::Equal => {
                        (low, high) = (middle, middle);
                        break;
                    }
                }
            } else {
                // D₂ is concave: it rises towards the ellipses.
                change.sign(t).is_gt()
            };
            if before { low = middle } else { high = middle }
        }
        let slope = if sign?.is_lt() { slope.by(-1.0) } else { slope };
        let [low, high] = [low, high].map(f64::from_bits);
        let end = |t: f64| {
            let unit = parts(t).1.min(0);
            let [one, t] = [1.0, t].map(|v| Integer::scaled(v, unit));
            Ellipse::of(first.times(&one).plus(&second.times(&t)), grid)
        };
        let ends = [end(low)?, end(high)?];
        let enclosed = slope.sign(low).is_le() && slope.sign(high).is_ge();
        enclosed.then_some(Pencil { first, second, slope, ends })
    }

    fn side(&self, grid: &Grid, point: Point) -> Ordering {
        let [low, high] = [0, 1].map(|i| self.ends[i].side(grid, point));
        if low == high {
            return low;
        }
        // Inside C₁ + tC₂ > 0; with τ = −C₁/C₂ that is (t − τ)C₂ > 0.
        let (first, second) = (self.first.at(grid, point), self.second.at(grid, point));
        let best_is_above = self.slope.sign_at(&Integer::scaled(-1.0, 0).times(&first), &second);
        match second.sign() {
            Ordering::Less => best_is_above.reverse(),
            _ => best_is_above,
        }
    }
}

/// Coefficients, that of t⁰ first.
struct Polynomial(Vec<Integer>);

impl Polynomial {
    fn times(&self, other: &Self) -> Self {
        let mut product = vec![Integer::scaled(0.0, 0); self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] = product[i + j].plus(&a.times(b));
            }
        }
        Polynomial(product)
    }

    /// Of polynomials of the same formal degree.
    fn minus(&self, other: &Self) -> Self {
        debug_assert_eq!(self.0.len(), other.0.len());
        Polynomial(self.0.iter().zip(&other.0).map(|(a, b)| a.minus(b)).collect())
    }

    fn by(&self, factor: f64) -> Self {
        let factor = Integer::scaled(factor, 0);
        Polynomial(self.0.iter().map(|a| a.times(&factor)).collect())
    }

    fn derivative(&self) -> Self {
        let terms = self.0.iter().enumerate().skip(1);
        Polynomial(terms.map(|(k, a)| a.times(&Integer::scaled(k as f64, 0))).collect())
    }

    /// The sign at p/q, q ≠ 0; the number of coefficients is odd, so that q to the degree is positive.
    fn sign_at(&self, p: &Integer, q: &Integer) -> Ordering {
        let mut sum = Integer::scaled(0.0, 0);
        let mut power = Integer::scaled(1.0, 0);
        for a in self.0.iter().rev() {
            // Horner's rule, every term with as many factors p or q.
            sum = sum.times(p).plus(&a.times(&power));
            power = power.times(q);
        }
        sum.sign()
    }

    /// The sign at t > 0.
    fn sign(&self, t: f64) -> Ordering {
        let unit = parts(t).1.min(0);
        self.sign_at(&Integer::scaled(t, unit), &Integer::scaled(1.0, unit))
    }
}
