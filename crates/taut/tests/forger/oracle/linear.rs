//! Small linear algebra over intervals.
//!
//! *Two ways.* [`Way::Proved`] keeps all radii: what it says of signs and sizes is a proof. [`Way::Plain`] drops the radius
//! after each step, as a solver wants whose result is verified afterwards: radii grow where its numbers converge.

use super::interval::Interval;

pub(super) type Vector = Vec<Interval>;
pub(super) type Matrix = Vec<Vector>;

/// States whether radii are kept.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    Proved,
    Plain,
}

impl Way {
    pub(super) fn keep(self, x: Interval) -> Interval {
        match self {
            Way::Proved => x,
            Way::Plain => x.into_middle(),
        }
    }
}

pub(super) fn dot(a: &[Interval], b: &[Interval]) -> Interval {
    a.iter().zip(b).fold(Interval::zero(), |sum, (a, b)| sum.plus(&a.times(b)))
}

pub(super) fn difference(a: &[Interval], b: &[Interval]) -> Vector {
    a.iter().zip(b).map(|(a, b)| a.minus(b)).collect()
}

/// Mx.
pub(super) fn image(matrix: &[Vector], x: &[Interval]) -> Vector {
    matrix.iter().map(|row| dot(row, x)).collect()
}

/// The middle of Mᵀt.
pub(super) fn transposed(matrix: &[Vector], t: &[Interval]) -> Vector {
    let columns = matrix.first().map_or(0, Vec::len);
    let column = |j: usize| {
        matrix.iter().zip(t).fold(Interval::zero(), |s, (row, t)| s.plus(&row[j].times(t)))
    };
    (0..columns).map(|j| column(j).into_middle()).collect()
}

pub(super) fn squared_length(x: &[Interval]) -> Interval {
    x.iter().fold(Interval::zero(), |sum, x| sum.plus(&x.square()))
}

/// M S Mᵀ for a symmetric S.
pub(super) fn congruent(matrix: &[Vector], shape: &[Vector]) -> Matrix {
    let half: Matrix = matrix.iter().map(|row| image(shape, row)).collect();
    half.iter().map(|h| image(matrix, h)).collect()
}

/// MMᵀ.
pub(super) fn gram(matrix: &[Vector]) -> Matrix {
    matrix.iter().map(|row| image(matrix, row)).collect()
}

/// The exact numbers; `None` where one is not finite.
pub(super) fn exact(values: &[f64]) -> Option<Vector> {
    values.iter().map(|&v| Interval::exact(v)).collect()
}

pub(super) fn exact_rows(rows: &[Vec<f64>]) -> Option<Matrix> {
    rows.iter().map(|row| exact(row)).collect()
}

/// A = LDLᵀ with 1 on the diagonal of L, and D > 0.
pub(super) struct Factor {
    lower: Matrix,
    pivots: Vector,
    way: Way,
}

impl Factor {
    /// `None` unless A is positive definite for every choice from its entries.
    pub(super) fn of(matrix: &[Vector], way: Way) -> Option<Self> {
        let (mut lower, mut pivots): (Matrix, Vector) = (vec![], vec![]);
        for (i, entries) in matrix.iter().enumerate() {
            // Row i of LD.
            let mut scaled: Vector = Vec::with_capacity(i);
            for (j, row) in lower.iter().enumerate() {
                scaled.push(way.keep(entries[j].minus(&dot(row, &scaled))));
            }
            let quotients = scaled.iter().zip(&pivots).map(|(s, d)| Some(way.keep(s.over(d)?)));
            let row: Vector = quotients.collect::<Option<_>>()?;
            let pivot = way.keep(entries[i].minus(&dot(&scaled, &row)));
            if !pivot.is_positive() {
                return None;
            }
            lower.push(row);
            pivots.push(pivot);
        }
        Some(Factor { lower, pivots, way })
    }

    pub(super) fn determinant(&self) -> Interval {
        self.pivots.iter().fold(Interval::integer(1), |product, d| product.times(d))
    }

    /// L⁻¹b.
    pub(super) fn forward(&self, b: &[Interval]) -> Vector {
        let mut x: Vector = Vec::with_capacity(b.len());
        for (b, row) in b.iter().zip(&self.lower) {
            x.push(self.way.keep(b.minus(&dot(row, &x))));
        }
        x
    }

    /// D^−½L⁻¹b.
    pub(super) fn whitened(&self, b: &[Interval]) -> Option<Vector> {
        let quotients = self.forward(b).into_iter().zip(&self.pivots);
        quotients.map(|(x, d)| Some(self.way.keep(x.over(&d.root()?)?))).collect()
    }

    /// A⁻¹b.
    pub(super) fn solve(&self, b: &[Interval]) -> Option<Vector> {
        let forward = self.forward(b);
        let mut x: Vector =
            forward.iter().zip(&self.pivots).map(|(x, d)| x.over(d)).collect::<Option<_>>()?;
        for i in (0..x.len()).rev() {
            let value = self.way.keep(x[i].clone());
            for (x, l) in x[..i].iter_mut().zip(&self.lower[i]) {
                *x = x.minus(&l.times(&value));
            }
            x[i] = value;
        }
        Some(x)
    }

    /// bᵀA⁻¹b.
    pub(super) fn quadratic(&self, b: &[Interval]) -> Option<Interval> {
        let mut sum = Interval::zero();
        for (x, d) in self.forward(b).iter().zip(&self.pivots) {
            sum = sum.plus(&x.square().over(d)?);
        }
        Some(sum)
    }
}

/// The solution of AX = B for a square A, by elimination with the largest pivot of each column, and det A; `None` where A
/// may be singular. B is given, and X returned, by rows.
pub(super) fn eliminated(
    matrix: &[Vector],
    right: &[Vector],
    way: Way,
) -> Option<(Matrix, Interval)> {
    let n = matrix.len();
    let mut rows: Vec<(Vector, Vector)> = matrix
        .iter()
        .enumerate()
        .map(|(i, row)| (row.clone(), right.get(i).cloned().unwrap_or_default()))
        .collect();
    let mut determinant = Interval::integer(1);
    for k in 0..n {
        let order = |row: &(Vector, Vector)| match row.0[k].sign() {
            Some(std::cmp::Ordering::Equal) | None => i64::MIN,
            Some(_) => {
                let largest = row.0.iter().map(Interval::binary_order).max().unwrap_or(0);
                row.0[k].binary_order() - largest
            }
        };
        let best = (k..n).max_by_key(|&i| order(&rows[i]))?;
        if best != k {
            rows.swap(k, best);
            determinant = determinant.negative();
        }
        let (done, rest) = rows.split_at_mut(k + 1);
        let (pivot, known) = &done[k];
        determinant = determinant.times(&pivot[k]);
        for (row, values) in rest {
            let factor = way.keep(row[k].over(&pivot[k])?);
            for (x, p) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                *x = way.keep(x.minus(&factor.times(p)));
            }
            for (x, p) in values.iter_mut().zip(known) {
                *x = way.keep(x.minus(&factor.times(p)));
            }
        }
        // A last pivot that may be 0 is found by nobody else.
        rows[k].0[k].sign().filter(|sign| sign.is_ne())?;
    }
    let mut solution: Matrix = vec![vec![]; n];
    for i in (0..n).rev() {
        let (row, values) = &rows[i];
        let mut x = Vec::with_capacity(values.len());
        for (column, value) in values.iter().enumerate() {
            let known = (i + 1..n)
                .fold(value.clone(), |rest, j| rest.minus(&row[j].times(&solution[j][column])));
            x.push(way.keep(known.over(&row[i])?));
        }
        solution[i] = x;
    }
    Some((solution, determinant))
}

pub(super) fn determinant(matrix: &[Vector]) -> Option<Interval> {
    Some(eliminated(matrix, &[], Way::Proved)?.1)
}
