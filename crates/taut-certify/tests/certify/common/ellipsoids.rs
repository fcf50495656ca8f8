//! Certificates of ellipsoids from multipliers, in plain arithmetic, and a slow solver to find multipliers with.
#![allow(dead_code, reason = "each test file uses its part")]

use num_rational::BigRational;
use num_traits::ToPrimitive;
use taut_certify::{
    CheckError, Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Hull, Items, Solution, Trace,
    Violation,
};
use taut_points::{Monitor, Points, hash_points};

/// Rows and a solution for them.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) values: Vec<f64>,
    pub(crate) columns: usize,
    pub(crate) solution: Solution<Ellipsoid>,
}

impl Case {
    pub(crate) fn check(&self) -> Result<EllipsoidVerdict, CheckError> {
        self.solution.check(&Points::new(&self.values, self.columns).unwrap())
    }

    /// The violation found; panics when the case is accepted.
    pub(crate) fn violation(&self) -> Violation {
        match self.check() {
            Err(CheckError::Rejected(violation)) => violation,
            other => panic!("{}: {other:?}", self.name),
        }
    }

    /// Returns what was proved; panics when the case is rejected.
    pub(crate) fn verdict(&self) -> EllipsoidVerdict {
        self.check().unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }
}

use super::exact;

type Rows = Vec<Vec<f64>>;

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn transposed_product(factor: &Rows, dim: usize) -> Rows {
    let entry = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
    (0..dim).map(|j| (0..dim).map(|k| entry(j, k)).collect()).collect()
}

/// L with LLᵀ = the symmetric matrix given.
fn cholesky(matrix: &Rows) -> Rows {
    let n = matrix.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let rest = matrix[i][j] - dot(&l[i][..j], &l[j][..j]);
            l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
        }
    }
    l
}

/// The inverse of a lower triangular matrix.
fn inverse(l: &Rows) -> Rows {
    let n = l.len();
    let mut x = vec![vec![0.0; n]; n];
    for k in 0..n {
        x[k][k] = 1.0 / l[k][k];
        for i in k + 1..n {
            let sum: f64 = (k..i).map(|j| l[i][j] * x[j][k]).sum();
            x[i][k] = -sum / l[i][i];
        }
    }
    x
}

/// F with |F(x − p̄)|² = (x − p̄)ᵀΣ⁻¹(x − p̄), found by whitening three times, so that ill-conditioned sets are no trouble.
fn whitener(points: &Rows, u: &[f64], mean: &[f64]) -> Rows {
    let dim = mean.len();
    let offsets: Rows =
        points.iter().map(|p| p.iter().zip(mean).map(|(x, c)| x - c).collect()).collect();
    let mut factor: Rows = (0..dim)
        .map(|j| {
            let width = offsets.iter().map(|x| x[j].abs()).fold(0.0, f64::max);
            (0..dim).map(|k| if j == k { 1.0 / width } else { 0.0 }).collect()
        })
        .collect();
    for _ in 0..3 {
        let images: Rows =
            offsets.iter().map(|x| factor.iter().map(|f| dot(f, x)).collect()).collect();
        let entry =
            |a: usize, b: usize| images.iter().zip(u).map(|(y, u)| u * y[a] * y[b]).sum::<f64>();
        let covariance: Rows = (0..dim).map(|a| (0..dim).map(|b| entry(a, b)).collect()).collect();
        let step = inverse(&cholesky(&covariance));
        factor = step
            .iter()
            .map(|row| (0..dim).map(|k| (0..dim).map(|j| row[j] * factor[j][k]).sum()).collect())
            .collect();
    }
    factor
}

pub(crate) fn log_unit_ball(dim: usize) -> f64 {
    let first = if dim % 2 == 1 { 2f64.ln() } else { 0.0 };
    let steps = (2..=dim).filter(|k| k % 2 == dim % 2);
    first + steps.map(|k| (std::f64::consts::TAU / k as f64).ln()).sum::<f64>()
}

/// log det of a triangular factor.
fn log_determinant(factor: &Rows) -> f64 {
    factor.iter().enumerate().map(|(j, row)| row[j].abs().ln()).sum()
}

/// |F(x − c)| by fractions, rounded to one `f64`.
fn exact_norm(ellipsoid: &Ellipsoid, row: &[f64]) -> f64 {
    let offset: Vec<BigRational> = (0..row.len())
        .map(|j| {
            let tail = ellipsoid.center_tail.get(j).copied().unwrap_or(0.0);
            exact(row[j]) - exact(ellipsoid.center[j]) - exact(tail)
        })
        .collect();
    let image =
        |f: &Vec<f64>| -> BigRational { f.iter().zip(&offset).map(|(&f, x)| exact(f) * x).sum() };
    let square: BigRational = ellipsoid.factor.iter().map(image).map(|y| &y * &y).sum();
    square.to_f64().unwrap().sqrt()
}

/// The ellipsoid of these multipliers over points, all of which it encloses but for rounding; the gap claimed is the one
/// that plain arithmetic finds.
pub(crate) fn certify(
    name: &str,
    values: &[f64],
    dim: usize,
    support: &[u64],
    multipliers: &[f64],
) -> Case {
    certify_but(name, values, dim, support, multipliers, &[])
}

/// The same for all points but some.
pub(crate) fn certify_but(
    name: &str,
    values: &[f64],
    dim: usize,
    support: &[u64],
    multipliers: &[f64],
    left_out: &[u64],
) -> Case {
    let all: Rows = values.chunks(dim).map(<[f64]>::to_vec).collect();
    let points: Rows = support.iter().map(|&i| all[i as usize].clone()).collect();
    let origin = &points[0];
    let mean_offset: Vec<f64> = (0..dim)
        .map(|j| points.iter().zip(multipliers).map(|(p, u)| u * (p[j] - origin[j])).sum())
        .collect();
    let center: Vec<f64> = origin.iter().zip(&mean_offset).map(|(o, m)| o + m).collect();
    let center_tail: Vec<f64> = origin
        .iter()
        .zip(&mean_offset)
        .zip(&center)
        .map(|((o, m), c)| if o.abs() > m.abs() { m - (c - o) } else { o - (c - m) })
        .collect();
    let center_tail = if center_tail.iter().all(|&t| t == 0.0) { vec![] } else { center_tail };
    let mut factor = whitener(&points, multipliers, &center);
    let matrix = transposed_product(&factor, dim);
    let mut ellipsoid = Ellipsoid {
        center,
        center_tail,
        matrix,
        factor: factor.clone(),
        hull: None,
        log_volume: 0.0,
    };
    let inside = |i: usize| !left_out.contains(&(i as u64));
    let norms: Vec<f64> = all.iter().map(|row| ellipsoid.norm(row)).collect();
    let far = (0..all.len()).filter(|&i| inside(i)).map(|i| norms[i]).fold(0.0, f64::max);
    // Only rows that may be the farthest are worth fractions, but in narrow sets rounding hides which is.
    let near_far = (0..all.len()).filter(|&i| inside(i) && norms[i] > far * (1.0 - 1e-6));
    let most =
        near_far.map(|i| exact_norm(&ellipsoid, &all[i])).fold((dim as f64).sqrt(), f64::max);
    factor.iter_mut().flatten().for_each(|f| *f /= most * (1.0 + 1e-15));
    ellipsoid.matrix = transposed_product(&factor, dim);
    ellipsoid.log_volume = log_unit_ball(dim) - log_determinant(&factor);
    ellipsoid.factor = factor;
    let gap = dim as f64 * ((most * most / dim as f64).ln() / 2.0).max(0.0);
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support: support.to_vec(),
        multipliers: multipliers.to_vec(),
        directions: vec![],
        left_out: left_out.to_vec(),
        gap: gap + dim as f64 * 1e-13,
        points_hash: hash(values, dim),
    };
    let solution = Solution { answer: ellipsoid, certificate, trace: Trace::default() };
    Case { name: name.into(), values: values.to_vec(), columns: dim, solution }
}

pub(crate) fn hash(values: &[f64], columns: usize) -> taut_points::PointsHash {
    hash_points(&Points::new(values, columns).unwrap(), &Monitor::silent()).unwrap()
}

/// The same set within a space of higher dimension, turned by an orthonormal basis of `basis.len()` rows.
pub(crate) fn embedded(case: &Case, basis: &Rows) -> Case {
    let dim = basis[0].len();
    let lift = |x: &[f64]| -> Vec<f64> {
        (0..dim).map(|j| x.iter().zip(basis).map(|(x, b)| x * b[j]).sum()).collect()
    };
    let mut lifted = case.clone();
    lifted.name = format!("{} lifted to {dim}", case.name);
    lifted.columns = dim;
    lifted.values = case.values.chunks(case.columns).flat_map(lift).collect();
    let answer = &mut lifted.solution.answer;
    answer.center = lift(&answer.center);
    answer.center_tail = vec![];
    answer.factor = answer.factor.iter().map(|f| lift(f)).collect();
    // Rounding moved the points by some 1e-16 of their distance from the origin.
    answer.factor.iter_mut().flatten().for_each(|f| *f *= 1.0 - 1e-14);
    answer.log_volume += answer.factor.len() as f64 * 1e-14;
    answer.matrix = transposed_product(&answer.factor, dim);
    let most = lifted.values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    answer.hull = Some(Hull { basis: basis.clone(), distance: 4e-16 * dim as f64 * most });
    lifted.solution.certificate.gap += 1e-12;
    lifted.solution.certificate.points_hash = hash(&lifted.values, dim);
    lifted
}

/// An orthonormal basis of as many rows as asked for, from vectors by Gram and Schmidt, twice.
pub(crate) fn orthonormal(vectors: &[f64], rows: usize, dim: usize) -> Rows {
    let mut basis: Rows = Vec::new();
    for vector in vectors.chunks(dim).take(rows) {
        let mut vector = vector.to_vec();
        for _ in 0..2 {
            for row in &basis {
                let along = dot(row, &vector);
                vector.iter_mut().zip(row).for_each(|(v, b)| *v -= along * b);
            }
        }
        let length = dot(&vector, &vector).sqrt();
        basis.push(vector.iter().map(|v| v / length).collect());
    }
    basis
}

/// Multipliers of points by steps towards and away from single points (Todd and Yıldırım), to about 1e-9.
pub(crate) fn solve(values: &[f64], dim: usize) -> (Vec<u64>, Vec<f64>) {
    let points: Rows = values.chunks(dim).map(<[f64]>::to_vec).collect();
    let n = points.len();
    let m = (dim + 1) as f64;
    let mut u = vec![1.0 / n as f64; n];
    for _ in 0..200_000 {
        let mean: Vec<f64> =
            (0..dim).map(|j| points.iter().zip(&u).map(|(p, u)| u * p[j]).sum()).collect();
        let factor = whitener(&points, &u, &mean);
        let kappa: Vec<f64> = points
            .iter()
            .map(|p| {
                let x: Vec<f64> = p.iter().zip(&mean).map(|(x, c)| x - c).collect();
                1.0 + factor.iter().map(|f| dot(f, &x).powi(2)).sum::<f64>()
            })
            .collect();
        let far = (0..n).max_by(|&i, &j| kappa[i].total_cmp(&kappa[j])).unwrap();
        let near =
            (0..n).filter(|&i| u[i] > 0.0).min_by(|&i, &j| kappa[i].total_cmp(&kappa[j])).unwrap();
        if kappa[far] - m < 1e-9 && m - kappa[near] < 1e-9 {
            break;
        }
        let i = if kappa[far] - m > m - kappa[near] { far } else { near };
        let step = ((kappa[i] - m) / ((m - 1.0) * kappa[i])).max(-u[i]);
        u[i] += step;
        u.iter_mut().for_each(|u| *u = (*u / (1.0 + step)).max(0.0));
    }
    let support: Vec<usize> = (0..n).filter(|&i| u[i] > 1e-12).collect();
    let sum: f64 = support.iter().map(|&i| u[i]).sum();
    let multipliers = support.iter().map(|&i| u[i] / sum).collect();
    (support.iter().map(|&i| i as u64).collect(), multipliers)
}

/// A set with its best ellipsoid, to a gap of about 1e-8.
pub(crate) fn solved(name: &str, values: &[f64], dim: usize) -> Case {
    let (support, multipliers) = solve(values, dim);
    certify(name, values, dim, &support, &multipliers)
}

/// The corners of the cube [−1, 1]ᵈ.
pub(crate) fn cube(dim: usize) -> Vec<f64> {
    let corner = |c: usize| (0..dim).map(move |j| if c >> j & 1 == 1 { 1.0 } else { -1.0 });
    (0..1usize << dim).flat_map(corner).collect()
}

/// ±eⱼ.
pub(crate) fn cross_polytope(dim: usize) -> Vec<f64> {
    let unit =
        |i: usize| (0..dim).map(move |j| if i / 2 == j { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 });
    (0..2 * dim).flat_map(unit).collect()
}

/// The origin and the unit vectors.
pub(crate) fn simplex(dim: usize) -> Vec<f64> {
    (0..=dim).flat_map(|i| (0..dim).map(move |j| if i == j + 1 { 1.0 } else { 0.0 })).collect()
}

/// A regular polygon of k corners on the unit circle.
pub(crate) fn polygon(k: usize) -> Vec<f64> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / k as f64;
    (0..k).flat_map(|i| [angle(i).cos(), angle(i).sin()]).collect()
}

/// All rows in the support, with equal multipliers.
pub(crate) fn uniform(name: &str, values: &[f64], dim: usize) -> Case {
    let n = values.len() / dim;
    let support: Vec<u64> = (0..n as u64).collect();
    certify(name, values, dim, &support, &vec![1.0 / n as f64; n])
}
