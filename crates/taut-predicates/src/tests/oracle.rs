//! Signs in integers without end, by other formulas than those of the predicates.

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use crate::sign::Sign;

/// All numbers as integers in one unit, a power of two.
pub(crate) fn integers(numbers: &[f64]) -> Vec<BigInt> {
    integers_with_unit(numbers).0
}

/// The same, with the exponent of the unit.
pub(crate) fn integers_with_unit(numbers: &[f64]) -> (Vec<BigInt>, i32) {
    let parts: Vec<_> = numbers.iter().map(|&x| parts(x)).collect();
    let unit = parts.iter().filter(|p| p.0 != 0).map(|p| p.1).min().unwrap_or(0);
    let integer =
        |&(m, e): &(i64, i32)| if m == 0 { BigInt::zero() } else { BigInt::from(m) << (e - unit) };
    (parts.iter().map(integer).collect(), unit)
}

/// A number as m·2ᵉ, found by halving and doubling alone.
fn parts(mut x: f64) -> (i64, i32) {
    let mut exponent = 0;
    if x == 0.0 {
        return (0, 0);
    }
    while x.abs() < (1u64 << 53) as f64 && x.abs() < 1e-200 {
        x *= 2f64.powi(512);
        exponent -= 512;
    }
    while x.abs() >= (1u64 << 62) as f64 {
        x /= (1u64 << 10) as f64;
        exponent += 10;
    }
    while x.abs() < (1u64 << 52) as f64 {
        x *= 2.0;
        exponent -= 1;
    }
    // Whole by now, as it has 53 bits at most.
    let mut m = x as i64;
    while m % 2 == 0 {
        m /= 2;
        exponent += 1;
    }
    (m, exponent)
}

pub(crate) fn sign(x: &BigInt) -> Sign {
    if x.is_positive() {
        Sign::Positive
    } else if x.is_negative() {
        Sign::Negative
    } else {
        Sign::Zero
    }
}

/// Laplace, along the first column.
fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    fn expand(rows: &[&[BigInt]]) -> BigInt {
        if rows.len() == 1 {
            return rows[0][0].clone();
        }
        let mut sum = BigInt::zero();
        for (i, row) in rows.iter().enumerate() {
            if row[0].is_zero() {
                continue;
            }
            let rest: Vec<_> =
                rows.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, r)| &r[1..]).collect();
            let term = &row[0] * expand(&rest);
            if i % 2 == 0 { sum += term } else { sum -= term }
        }
        sum
    }
    expand(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// det [1 rows], by taking the first row off the others.
fn determinant_with_ones(rows: &[Vec<BigInt>]) -> BigInt {
    let less = |row: &Vec<BigInt>| row.iter().zip(&rows[0]).map(|(x, y)| x - y).collect();
    determinant(&rows[1..].iter().map(less).collect::<Vec<_>>())
}

/// A point set in one unit.
pub(crate) struct Exactly {
    pub(crate) points: Vec<Vec<BigInt>>,
    /// The exponent of that unit.
    pub(crate) unit: i32,
    pub(crate) dim: usize,
}

impl Exactly {
    pub(crate) fn new<const D: usize>(points: &[[f64; D]]) -> Self {
        let (numbers, unit) = integers_with_unit(points.as_flattened());
        Exactly { points: numbers.chunks(D).map(<[_]>::to_vec).collect(), unit, dim: D }
    }

    fn square(&self, i: usize) -> BigInt {
        self.points[i].iter().map(|x| x * x).sum()
    }

    /// det [p 1] over the first d + 1 points, positive for 0 and the unit vectors.
    pub(crate) fn orient(&self, vertices: &[usize]) -> BigInt {
        let rows: Vec<_> = vertices
            .iter()
            .map(|&i| {
                std::iter::once(BigInt::one()).chain(self.points[i].iter().cloned()).collect()
            })
            .collect();
        determinant(&rows)
    }

    /// det [1 p l] over d + 2 points with lifts l, positive if the last point lies inside.
    fn lifted(&self, lifts: &[BigInt]) -> BigInt {
        let row = |i: usize| self.points[i].iter().chain([&lifts[i]]).cloned().collect();
        // The coefficient of the last lift is the orientation, which is to count negative.
        -determinant_with_ones(&(0..self.dim + 2).map(row).collect::<Vec<_>>())
    }

    /// Of the first d + 1 points as vertices and the next as the query.
    pub(crate) fn in_sphere(&self) -> BigInt {
        self.lifted(&(0..self.dim + 2).map(|i| self.square(i)).collect::<Vec<_>>())
    }

    /// The same with the k-th largest point lifted by 2^(−k·w) units more, with w so large that no sum of later terms
    /// can reach an earlier one.
    pub(crate) fn in_sphere_perturbed(&self) -> Sign {
        let n = self.dim + 2;
        let bits = self.points.iter().flatten().map(BigInt::bits).max().unwrap_or(0);
        let w = (self.dim as u64 + 2) * (bits + 4) + 16;
        let mut order: Vec<_> = (0..n).collect();
        order.sort_by(|&i, &j| self.points[j].cmp(&self.points[i]));
        let scale = (n as u64 + 1) * w;
        let mut lifts: Vec<_> = (0..n).map(|i| self.square(i) << scale).collect();
        for (rank, &i) in order.iter().enumerate() {
            lifts[i] += BigInt::one() << (scale - (rank as u64 + 1) * w);
        }
        sign(&self.lifted(&lifts))
    }

    /// Numerators and denominator of the point at the same distance from all `vertices`, in their affine hull: the
    /// solution of (p − p₀)·C = (|p|² − |p₀|²)/2 for each other vertex p, and n·C = n·p₀ for a triangle of space.
    pub(crate) fn circumcenter(&self, vertices: &[usize]) -> (Vec<BigInt>, BigInt) {
        let first = &self.points[vertices[0]];
        let way = |i: usize| -> Vec<BigInt> {
            self.points[i].iter().zip(first).map(|(x, y)| x - y).collect()
        };
        let mut rows: Vec<Vec<BigInt>> = Vec::new();
        let mut right = Vec::new();
        for &i in &vertices[1..] {
            rows.push(way(i).iter().map(|x| x * 2).collect());
            right.push(self.square(i) - self.square(vertices[0]));
        }
        if rows.len() == 2 && self.dim == 3 {
            let (u, v) = (way(vertices[1]), way(vertices[2]));
            let n = vec![
                &u[1] * &v[2] - &u[2] * &v[1],
                &u[2] * &v[0] - &u[0] * &v[2],
                &u[0] * &v[1] - &u[1] * &v[0],
            ];
            right.push(n.iter().zip(first).map(|(n, p)| n * p).sum());
            rows.push(n);
        }
        let denominator = determinant(&rows);
        let numerators = (0..self.dim)
            .map(|column| {
                let mut replaced = rows.clone();
                for (row, r) in replaced.iter_mut().zip(&right) {
                    row[column] = r.clone();
                }
                determinant(&replaced)
            })
            .collect();
        (numerators, denominator)
    }

    /// |p·denominator − numerators|².
    pub(crate) fn distance2(&self, i: usize, center: &(Vec<BigInt>, BigInt)) -> BigInt {
        let (numerators, denominator) = center;
        let ways = self.points[i].iter().zip(numerators).map(|(p, n)| p * denominator - n);
        ways.map(|w| &w * &w).sum()
    }
}
