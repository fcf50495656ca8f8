//! An interior point of a polytope, or the proof that there is none, or that it has no end.
//!
//! *Trap.* The programs are solved in `f64` to some 1e-8, so that what the solver says proves nothing. A point is measured
//! again, a ray is brought to the faces it runs along and measured again, and multipliers of Farkas are moved by
//! [`no_room`] to where their sum is 0 exactly, with a bound on what moving them costs. What remains is undecided.
//! *Bounded.* With unit normals âᵢ, minimize |Σλᵢâᵢ|² over λ ≥ 1. If the sum is 0 and the normals span the space, no ray fits
//! (Stiemke's theorem). Else v = −Σλᵢâᵢ has âᵢ′v ≤ 0 for all i by the conditions of the minimum: a ray. Where the normals do not
//! span, what is orthogonal to all of them is one.
//! *Interior.* The largest ball inside, a linear program; if its radius is not positive, its multipliers are those of
//! Farkas: Σλᵢâᵢ = 0 and Σλᵢbᵢ ≤ 0.

use std::f64::consts::SQRT_2;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus,
    SupportedConeT, ZeroConeT,
};
use taut_kernels::vector::{add_scaled, dot};
use taut_points::{exponent_of, two_to};

use super::HalfSpaces;
use crate::Error;
use crate::shapes::eigen::eigen;

/// The rest that a conic solver leaves of a sum that is 0, for unit normals.
const ZERO: f64 = 1e-6;
/// A ray may rise beyond a face by this for each dimension, as it is rounded.
const RAY_RISE_MAX: f64 = 64.0 * f64::EPSILON;
/// A face whose normal is within this of a right angle to a ray is one it runs along.
const ALONG_TOLERANCE: f64 = 1e-5;
/// Rows and columns are brought to the same size in this many turns.
const SCALING_TURNS: usize = 5;
/// A ball of less than this part of the extent of the polytope is none.
const RADIUS_RATIO_MIN: f64 = 1e-9;

/// A ball of which it is proved that it has no larger radius than this, offsets being 1 at most, counts as none.
const PROVED_RADIUS_MIN: f64 = 1e-6;

/// A center, and the half axes of an ellipsoid around it inside, along the axes of coordinates.
pub(super) struct Interior {
    pub(super) center: Vec<f64>,
    pub(super) half_axes: Vec<f64>,
}

/// The largest ball inside, in units in which no axis stands out.
pub(super) fn interior(sides: &HalfSpaces) -> Result<Interior, Error> {
    let dim = sides.dim;
    let (normals, offsets, units) = equilibrated(sides);
    if offsets.iter().chain(&units).any(|b| !b.is_finite()) {
        return Err(Error::Overflow);
    }
    let spread = is_bounded(&normals, &units)?;
    // Units in which offsets are at most 1.
    let unit = offsets.iter().fold(0.0f64, |m, b| m.max(b.abs()));
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let n = offsets.len();
    let mut values: Vec<f64> =
        (0..dim).flat_map(|j| normals[j..].iter().step_by(dim).copied()).collect();
    values.extend(std::iter::repeat_n(1.0, n));
    let a = dense(n, dim + 1, values);
    let b: Vec<f64> = offsets.iter().map(|b| b / unit).collect();
    let mut objective = vec![0.0; dim + 1];
    objective[dim] = -1.0;
    let (x, z) =
        conic(&CscMatrix::zeros((dim + 1, dim + 1)), &objective, &a, &b, &[NonnegativeConeT(n)])?;
    // As the point is, not as the solver says.
    let room = |i: usize| b[i] - dot(&normals[i * dim..(i + 1) * dim], &x[..dim]);
    let radius = (0..n).map(room).fold(f64::INFINITY, f64::min);
    let extent = (0..n).map(room).fold(0.0, f64::max);
    let is_open = radius > RADIUS_RATIO_MIN * extent;
    if !is_open {
        let radius = no_room(&normals, &b, &z, &spread);
        let is_proved = radius <= PROVED_RADIUS_MIN;
        if !is_proved {
            return Err(Error::Undecided);
        }
        let rows: Vec<u64> = (0..n).filter(|&i| z[i] > 1e-7).map(|i| i as u64).collect();
        let multipliers = rows.iter().map(|&i| z[i as usize] * stretch(sides, &units, i as usize));
        let multipliers = multipliers.collect();
        return Err(Error::NoInterior { rows, multipliers, radius });
    }
    Ok(Interior {
        center: x.iter().zip(&units).map(|(v, u)| v * unit * u).collect(),
        half_axes: units.iter().map(|u| radius * unit * u).collect(),
    })
}

/// Unit normals and offsets in coordinates x/u in which no axis stands out, and u.
fn equilibrated(sides: &HalfSpaces) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let dim = sides.dim;
    let mut units = vec![1.0; dim];
    let mut normals = vec![];
    let mut offsets = vec![];
    for turn in 0..SCALING_TURNS {
        normals.clear();
        offsets.clear();
        for row in sides.rows() {
            let mut normal: Vec<f64> = row.iter().zip(&units).map(|(a, u)| a * u).collect();
            let largest = normal.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            normal.iter_mut().for_each(|v| *v /= largest);
            let norm = dot(&normal, &normal).sqrt();
            normals.extend(normal.iter().map(|v| v / norm));
            offsets.push(row[dim] / largest / norm);
        }
        if turn + 1 == SCALING_TURNS {
            break;
        }
        for (j, unit) in units.iter_mut().enumerate() {
            let most = normals[j..].iter().step_by(dim).fold(0.0f64, |m, v| m.max(v.abs()));
            if most > 0.0 {
                // A power of two, so that coordinates keep their digits.
                *unit *= two_to(-exponent_of(most * SQRT_2).clamp(-500, 500));
            }
        }
    }
    (normals, offsets, units)
}

/// By how much longer the normal of a row is in the coordinates given than in those with units.
fn stretch(sides: &HalfSpaces, units: &[f64], i: usize) -> f64 {
    let row = &sides.values[i * (sides.dim + 1)..][..sides.dim];
    let length = |numbers: &[f64]| {
        let largest = numbers.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        largest * numbers.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
    };
    let seen: Vec<f64> = row.iter().zip(units).map(|(a, u)| a * u).collect();
    length(row) / length(&seen)
}

fn unbounded(direction: &[f64], units: &[f64]) -> Error {
    let scaled: Vec<f64> = direction.iter().zip(units).map(|(v, u)| v * u).collect();
    let largest = scaled.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let scaled: Vec<f64> = scaled.iter().map(|v| v / largest).collect();
    let norm = dot(&scaled, &scaled).sqrt();
    // Adding 0 turns −0 into 0.
    Error::Unbounded { direction: scaled.iter().map(|v| v / norm + 0.0).collect() }
}

/// λ with Σλᵢâᵢ nearly 0 and all λᵢ ≥ 1, and a lower bound on the least singular value of the normals.
struct Spread {
    lambda: Vec<f64>,
    least: f64,
}

/// Returns what the radius of a ball in the polytope is at most: from λ ≥ 0 with Σλᵢâᵢ = 0, Σλᵢbᵢ/Σλᵢ.
///
/// *Idea.* The sum of the multipliers found is some r ≠ 0. With A the matrix of normals, of least singular value σ, there is
/// w with A′w = −r and |w| ≤ |r|/σ, and likewise w₀ for the λ₀ ≥ 1 of a spread and its r₀. Then λ + w + t(λ₀ + w₀) has sum 0
/// exactly, and no negative entry for t = |w|/(1 − |w₀|). It costs |w||b| + t(λ₀′b + |w₀||b|).
fn no_room(normals: &[f64], offsets: &[f64], multipliers: &[f64], spread: &Spread) -> f64 {
    let n = offsets.len();
    let dim = normals.len() / n;
    let rounding = (n + dim + 16) as f64 * f64::EPSILON;
    let lambda: Vec<f64> = multipliers.iter().map(|z| z.max(0.0)).collect();
    let total: f64 = lambda.iter().sum();
    // |Σλᵢâᵢ| and Σλᵢbᵢ, at most.
    let rest = |lambda: &[f64]| {
        let mut sum = vec![0.0; dim];
        normals.chunks_exact(dim).zip(lambda).for_each(|(a, l)| add_scaled(&mut sum, *l, a));
        dot(&sum, &sum).sqrt() + rounding * lambda.iter().sum::<f64>() * (dim as f64).sqrt()
    };
    let value = |lambda: &[f64]| {
        let size: f64 = lambda.iter().zip(offsets).map(|(l, b)| l * b.abs()).sum();
        dot(lambda, offsets) + rounding * size
    };
    let length = dot(offsets, offsets).sqrt() * (1.0 + rounding);
    let (w, w0) = (rest(&lambda) / spread.least, rest(&spread.lambda) / spread.least);
    let t = w / (1.0 - w0);
    let is_moved = spread.least > 0.0 && w0 < 0.5 && w * (n as f64).sqrt() < 0.5 * total;
    if !is_moved {
        return f64::INFINITY;
    }
    let cost = w * length + t * (value(&spread.lambda).max(0.0) + w0 * length);
    // Unit normals are so but for rounding; the multipliers moved sum to half of what they were at least.
    let beta = value(&lambda) + cost;
    (beta / if beta > 0.0 { 0.5 * total } else { 2.0 * total }).max(0.0) * (1.0 + rounding)
}

fn is_bounded(normals: &[f64], units: &[f64]) -> Result<Spread, Error> {
    let dim = units.len();
    let n = normals.len() / dim;
    let mut gram = vec![0.0; dim * dim];
    for row in normals.chunks_exact(dim) {
        for (a, &v) in row.iter().enumerate() {
            add_scaled(&mut gram[a * dim..(a + 1) * dim], v, row);
        }
    }
    let (values, vectors) = eigen(&mut gram, dim);
    if let Some(k) = (0..dim).find(|&k| values[k] <= 1e-14 * n as f64) {
        return Err(match ray(normals, vectors[k * dim..(k + 1) * dim].to_vec()) {
            Some(direction) => unbounded(&direction, units),
            None => Error::Undecided,
        });
    }
    let spectrum = values.iter().copied().fold(f64::INFINITY, f64::min);
    // Variables λ, r: r − Σλᵢâᵢ = 0 and −λ + s = −1.
    let (mut starts, mut rows, mut values) = (vec![0], vec![], vec![]);
    for (i, row) in normals.chunks_exact(dim).enumerate() {
        rows.extend(0..dim);
        values.extend(row.iter().map(|v| -v));
        rows.push(dim + i);
        values.push(-1.0);
        starts.push(rows.len());
    }
    for j in 0..dim {
        rows.push(j);
        values.push(1.0);
        starts.push(rows.len());
    }
    let a = CscMatrix::new(dim + n, n + dim, starts, rows, values);
    let mut b = vec![0.0; dim + n];
    b[dim..].fill(-1.0);
    let mut starts = vec![0; n];
    starts.extend(0..=dim);
    let quadratic =
        CscMatrix::new(n + dim, n + dim, starts, (n..n + dim).collect(), vec![1.0; dim]);
    let objective = vec![0.0; n + dim];
    let (x, _) = conic(&quadratic, &objective, &a, &b, &[ZeroConeT(dim), NonnegativeConeT(n)])?;
    let norm = dot(&x[n..], &x[n..]).sqrt();
    if norm > ZERO
        && let Some(direction) = ray(normals, x[n..].iter().map(|r| -r / norm).collect())
    {
        return Err(unbounded(&direction, units));
    }
    let least = (spectrum - 1e-13 * n as f64).max(0.0).sqrt();
    Ok(Spread { lambda: x[..n].to_vec(), least })
}

/// The direction, moved into the faces it runs along; none where it leaves the polytope all the same.
fn ray(normals: &[f64], mut direction: Vec<f64>) -> Option<Vec<f64>> {
    let dim = direction.len();
    let mut gram = vec![0.0; dim * dim];
    for row in normals.chunks_exact(dim).filter(|a| dot(a, &direction).abs() <= ALONG_TOLERANCE) {
        for (a, &v) in row.iter().enumerate() {
            add_scaled(&mut gram[a * dim..(a + 1) * dim], v, row);
        }
    }
    let (values, vectors) = eigen(&mut gram, dim);
    for _ in 0..2 {
        for (_, vector) in
            values.iter().zip(vectors.chunks_exact(dim)).filter(|(v, _)| **v > ALONG_TOLERANCE)
        {
            let along = dot(vector, &direction);
            add_scaled(&mut direction, -along, vector);
        }
    }
    let norm = dot(&direction, &direction).sqrt();
    direction.iter_mut().for_each(|v| *v /= norm);
    let falls = |a: &[f64]| dot(a, &direction) <= RAY_RISE_MAX * dim as f64;
    (norm > 0.5 && normals.chunks_exact(dim).all(falls)).then_some(direction)
}

fn dense(rows: usize, columns: usize, values: Vec<f64>) -> CscMatrix<f64> {
    let starts = (0..=columns).map(|column| column * rows).collect();
    let places = (0..columns).flat_map(|_| 0..rows).collect();
    CscMatrix::new(rows, columns, starts, places, values)
}

/// The solution and the multipliers of a conic program, as good as they are: callers prove what they take from them.
fn conic(
    quadratic: &CscMatrix<f64>,
    objective: &[f64],
    a: &CscMatrix<f64>,
    b: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let failed = |status: String| Error::Conic { status, points: b.len() };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_threads(1)
        .build()
        .expect("the settings are in range");
    let mut solver = DefaultSolver::new(quadratic, objective, a, b, cones, settings)
        .map_err(|error| failed(error.to_string()))?;
    solver.solve();
    let solution = solver.solution;
    match solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress => {
            Ok((solution.x, solution.z))
        }
        status => Err(failed(format!("{status:?}"))),
    }
}
