//! Rows as points, balls and ellipsoids {m + v : vvᵀ ⪯ N}, and how far they reach in the frame of an ellipsoid.
//!
//! *Shapes.* A ball has N = r²I, an ellipsoid N = S where S − eD is positive definite, for the diagonal D of S and
//! e = 64(d + 4)²·2⁻¹⁰⁰; else N = S + 2τD for the least τ of 2⁻⁵⁶, 2⁻⁵⁵, … with S + (τ − e)D positive definite.
//! *Reach.* With g = F(m − c) and A = FNFᵀ, each μ with μI − A positive definite proves |F(x − c)|² ≤ μ·(1 + gᵀ(μI − A)⁻¹g)
//! for all points x of the body (S-lemma); the least of these is the maximum. For each t, w = At/√(tᵀAt) is the image of a
//! point of the body less that of m, and |g + w|² a lower bound on the maximum.

use taut::Items;

use super::interval::Interval;
use super::linear::{
    Factor, Matrix, Vector, Way, congruent, difference, dot, exact, image, squared_length,
};

/// One row.
#[derive(Clone)]
pub(super) struct Body {
    pub(super) center: Vector,
    /// `None` for a point.
    pub(super) shape: Option<Shape>,
}

/// N.
#[derive(Clone)]
pub(super) struct Shape {
    matrix: Matrix,
}

impl Shape {
    pub(super) fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// `None` for a matrix that is far from semidefinite.
    fn of(matrix: Matrix) -> Option<Self> {
        let wide: Vec<usize> = (0..matrix.len()).filter(|&j| matrix[j][j].is_positive()).collect();
        let part: Matrix =
            wide.iter().map(|&j| wide.iter().map(|&k| matrix[j][k].clone()).collect()).collect();
        let with = |tau: &Interval| {
            let mut raised = part.clone();
            for (j, row) in raised.iter_mut().enumerate() {
                row[j] = row[j].plus(&row[j].times(tau));
            }
            Factor::of(&raised, Way::Proved).is_some()
        };
        let n = wide.len() as i64;
        let e = Interval::integer(64 * (n + 4) * (n + 4)).scaled(-100);
        if with(&Interval::zero().minus(&e)) {
            return Some(Shape { matrix });
        }
        let mut tau = Interval::integer(1).scaled(-56);
        let mut doublings = 0;
        while !with(&tau.minus(&e)) {
            tau = tau.scaled(1);
            doublings += 1;
            if doublings > 56 {
                return None;
            }
        }
        let mut raised = matrix;
        for (j, row) in raised.iter_mut().enumerate() {
            row[j] = row[j].plus(&row[j].times(&tau.scaled(1)));
        }
        Some(Shape { matrix: raised })
    }
}

impl Body {
    pub(super) fn of(items: Items, dim: usize, row: &[f64]) -> Option<Self> {
        let center = exact(&row[..dim])?;
        let rest = exact(&row[dim..])?;
        if row[dim..].iter().all(|&v| v == 0.0) {
            return Some(Body { center, shape: None });
        }
        let matrix = match items {
            Items::Points => return None,
            Items::Balls => {
                let square = rest[0].square();
                let entry = |j, k| if j == k { square.clone() } else { Interval::zero() };
                (0..dim).map(|j| (0..dim).map(|k| entry(j, k)).collect()).collect()
            }
            Items::Ellipsoids => {
                let at = |j: usize, k: usize| rest[j * (j + 1) / 2 + k].clone();
                (0..dim).map(|j| (0..dim).map(|k| at(j.max(k), j.min(k))).collect()).collect()
            }
        };
        Some(Body { center, shape: Some(Shape::of(matrix)?) })
    }

    /// The image under a linear map.
    pub(super) fn mapped(&self, by: &[Vector]) -> Self {
        Body {
            center: image(by, &self.center),
            shape: self.shape.as_ref().map(|shape| Shape { matrix: congruent(by, &shape.matrix) }),
        }
    }

    /// The point that lies farthest in a direction.
    pub(super) fn touching(&self, direction: &[Interval], way: Way) -> Option<Vector> {
        let Some(shape) = &self.shape else { return Some(self.center.clone()) };
        let along = image(&shape.matrix, direction);
        let length = dot(direction, &along).root()?;
        let steps = along.iter().map(|v| v.over(&length));
        let point = self.center.iter().zip(steps).map(|(m, step)| Some(way.keep(m.plus(&step?))));
        point.collect()
    }
}

/// A body in the frame of an ellipsoid: g and A.
pub(super) struct Framed {
    pub(super) g: Vector,
    shape: Option<Matrix>,
}

impl Framed {
    pub(super) fn of(factor: &[Vector], center: &[Interval], body: &Body) -> Self {
        let g = image(factor, &difference(&body.center, center));
        let shape = body.shape.as_ref().map(|shape| congruent(factor, &shape.matrix));
        Framed { g, shape }
    }

    /// Tests whether the largest |y|² is at most `limit`.
    pub(super) fn is_within(&self, limit: &Interval) -> Option<bool> {
        let square = squared_length(&self.g);
        let Some(shape) = &self.shape else { return square.at_most(limit) };
        let trace = (0..shape.len()).fold(Interval::zero(), |sum, j| sum.plus(&shape[j][j]));
        let simple = square.root()?.plus(&trace.root()?).square();
        if simple.at_most(limit) == Some(true) {
            return Some(true);
        }
        let mu = self.multiplier(shape)?;
        // From near the minimum outwards, as μI − A is singular at it in the hard case.
        for k in [-240, -200, -160, -120, -90, -60] {
            let raised = mu.plus(&mu.scaled(k));
            if let Some(bound) = self.bound(shape, &raised)
                && bound.at_most(limit) == Some(true)
            {
                return Some(true);
            }
        }
        let exceeds = |t: &Vector| {
            self.square_along(shape, t).and_then(|square| square.at_most(limit)) == Some(false)
        };
        let is_out = self.far_directions(shape, &mu)?.iter().any(exceeds);
        if is_out { Some(false) } else { None }
    }

    /// An upper bound on the largest |y|².
    pub(super) fn upper(&self) -> Option<Interval> {
        let Some(shape) = &self.shape else { return Some(squared_length(&self.g)) };
        let mu = self.multiplier(shape)?;
        let bounds = [-240, -200, -160, -120, -90, -60]
            .into_iter()
            .filter_map(|k| self.bound(shape, &mu.plus(&mu.scaled(k))));
        bounds.reduce(|a, b| if b.at_most(&a) == Some(true) { b } else { a })
    }

    /// μ·(1 + gᵀ(μI − A)⁻¹g).
    fn bound(&self, shape: &[Vector], mu: &Interval) -> Option<Interval> {
        let factor = Factor::of(&less(mu, shape), Way::Proved)?;
        let square = factor.quadratic(&self.g)?;
        Some(mu.plus(&mu.times(&square)))
    }

    /// Near the μ of the least bound.
    fn multiplier(&self, shape: &[Vector]) -> Option<Interval> {
        let n = shape.len();
        // λmax lies between the largest diagonal entry and the trace.
        let trace = (0..n).fold(Interval::zero(), |sum, j| sum.plus(&shape[j][j]));
        let wide = trace.root()?.times(&squared_length(&self.g).root()?);
        let mut above = trace.plus(&wide).into_middle();
        above = above.plus(&above.scaled(-20));
        let mut below = Interval::zero();
        let mut mu = above.clone();
        let mut last = i64::MAX;
        for _ in 0..400 {
            let width = above.minus(&below);
            if width.binary_order() < above.binary_order() - 230 {
                break;
            }
            let mut next = None;
            if let Some(factor) = Factor::of(&less(&mu, shape), Way::Plain) {
                let t = factor.solve(&self.g)?;
                let along = image(shape, &t);
                let square = dot(&t, &along).into_middle();
                if !square.is_positive() {
                    // g and A have nothing in common: the maximum is λmax + |g|², near the singular μ.
                    above = mu.clone();
                } else {
                    // Newton's step for 1/√ψ(μ) = 1.
                    let slope = dot(&along, &factor.solve(&t)?);
                    let root = square.root()?;
                    let step = root.minus(&Interval::integer(1)).times(&square).over(&slope)?;
                    let beyond = square.minus(&Interval::integer(1));
                    if beyond.is_positive() {
                        below = mu.clone()
                    } else {
                        above = mu.clone()
                    }
                    let order = step.binary_order() - mu.binary_order();
                    if order < -100 && last < -50 {
                        return Some(mu.plus(&step).into_middle());
                    }
                    last = order;
                    next = Some(mu.plus(&step).into_middle());
                }
            } else {
                below = mu.clone();
            }
            let middle = below.plus(&above).scaled(-1).into_middle();
            let is_between =
                |x: &Interval| x.minus(&below).is_positive() && above.minus(x).is_positive();
            mu = next.filter(is_between).unwrap_or(middle);
        }
        Some(above)
    }

    /// Directions t whose points may be the farthest.
    fn far_directions(&self, shape: &[Vector], mu: &Interval) -> Option<Matrix> {
        let raised = mu.plus(&mu.scaled(-200));
        let factor = Factor::of(&less(&raised, shape), Way::Plain)
            .or_else(|| Factor::of(&less(&mu.plus(&mu.scaled(-100)), shape), Way::Plain))?;
        let t = factor.solve(&self.g)?;
        let mut directions = vec![t.clone()];
        // In the hard case, any multiple of an eigenvector of λmax may be added.
        let n = self.g.len();
        for start in 0..n {
            let mut v: Vector = (0..n).map(|j| Interval::integer(i64::from(j == start))).collect();
            for _ in 0..4 {
                v = factor.solve(&v)?;
                let order = v.iter().map(Interval::binary_order).max().unwrap_or(0);
                v = v.iter().map(|x| x.scaled(-order).into_middle()).collect();
            }
            let along = image(shape, &v);
            let (a, b, c) = (
                dot(&v, &along),
                dot(&t, &along),
                dot(&t, &image(shape, &t)).minus(&Interval::integer(1)),
            );
            let Some(root) = b.square().minus(&a.times(&c)).root() else { continue };
            for root in [root.clone(), root.negative()] {
                if let Some(beta) = root.minus(&b).over(&a) {
                    let beta = beta.into_middle();
                    let sum = t.iter().zip(&v).map(|(t, v)| t.plus(&beta.times(v)).into_middle());
                    directions.push(sum.collect());
                }
            }
        }
        Some(directions)
    }

    /// Directions in the frame whose points may be the farthest: t alone if its point reaches the upper bound given, and
    /// all in the hard case.
    pub(super) fn touching(&self, upper: &Interval) -> Option<Matrix> {
        let Some(shape) = &self.shape else { return Some(vec![self.g.clone()]) };
        let mut directions = self.far_directions(shape, &self.multiplier(shape)?)?;
        let reach = self.square_along(shape, &directions[0]);
        let near = upper.minus(&upper.scaled(-40));
        if reach.is_some_and(|square| near.at_most(&square) == Some(true)) {
            directions.truncate(1);
        }
        Some(directions)
    }

    /// |g + w|² for w = At/√(tᵀAt).
    fn square_along(&self, shape: &[Vector], t: &[Interval]) -> Option<Interval> {
        let along = image(shape, t);
        let length = dot(t, &along).root()?;
        let y: Option<Vector> =
            self.g.iter().zip(&along).map(|(g, w)| Some(g.plus(&w.over(&length)?))).collect();
        Some(squared_length(&y?))
    }
}

/// μI − A.
fn less(mu: &Interval, shape: &[Vector]) -> Matrix {
    let entry = |i: usize, j: usize, x: &Interval| {
        if i == j { mu.minus(x) } else { x.negative() }
    };
    let row =
        |(i, row): (usize, &Vector)| row.iter().enumerate().map(|(j, x)| entry(i, j, x)).collect();
    shape.iter().enumerate().map(row).collect()
}
