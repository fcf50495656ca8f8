//! Decides whether what is said of an enclosing ellipsoid is true.
//!
//! *Claims.* Every item lies in the ellipsoid enlarged by 1 + `excess`; `lower` is at most the least log-volume, `upper` at
//! least that of the enlarged ellipsoid, and `gap` at least the difference of the two before rounding; (x − c)ᵀQ(x − c) is
//! at most 1 + `matrix_excess`; the log-volume stated is that of F; the basis of a hull is orthonormal and spans the rows of
//! F, all items are as near to it as stated, and that is near enough to be called flat.
//! *Truth.* The least log-volume is bracketed once per input ([`mvee`](super::mvee), [`exchange`](super::exchange)). Within a
//! hull it is that of the projections of the items; the weights of one hull are nearly the best for any other that is off
//! by rounding, so the bracket is computed again from them.
//! *Tolerances* are those that the documentation of the answer and of its checker states.

#[cfg(test)]
mod tests;

use std::sync::{Mutex, OnceLock};

use taut::certify::Hull;
use taut::certify::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict};
use taut::{Items, Solution};

use super::Truth;
use super::body::{Body, Framed};
use super::claims::Claims;
use super::interval::{Interval, log_unit_ball};
use super::linear::{
    Factor, Matrix, Vector, Way, determinant, difference, dot, exact, exact_rows, gram, image,
    squared_length, transposed,
};
use super::mvee::{self, Bracket, MU_EXPONENT_MIN, Trial, larger};
use super::{exchange, flat};

/// 2⁻⁵³.
pub(super) const U: f64 = f64::EPSILON / 2.0;

/// The truth about the ellipsoids around one input.
pub(crate) struct EllipsoidOracle {
    items: Items,
    dim: usize,
    bodies: Option<Vec<Body>>,
    /// True if the rows are in single precision.
    is_single: bool,
    /// The numbers that a certificate has for these bodies, ascending.
    rows: Vec<u64>,
    /// Of full dimension, found when it is first asked for.
    optimum: OnceLock<Option<Bracket>>,
    /// Weights of earlier hulls.
    weights: Mutex<Vec<Vector>>,
}

impl EllipsoidOracle {
    pub(crate) fn new(values: &[f64], columns: usize, items: Items) -> Self {
        let dim = items.dim(columns);
        let rows = values.chunks_exact(columns.max(1));
        let count = rows.len() as u64;
        let bodies = rows.map(|row| Body::of(items, dim, row)).collect();
        EllipsoidOracle::of_bodies(bodies, (0..count).collect(), dim, items)
    }

    /// As `new`, for some rows of an input.
    pub(super) fn of_bodies(
        bodies: Option<Vec<Body>>,
        rows: Vec<u64>,
        dim: usize,
        items: Items,
    ) -> Self {
        let (optimum, weights) = (OnceLock::new(), Mutex::new(vec![]));
        EllipsoidOracle { items, dim, bodies, is_single: false, rows, optimum, weights }
    }

    /// The same for rows that are in single precision or not.
    pub(crate) fn in_precision(self, is_single: bool) -> Self {
        EllipsoidOracle { is_single, ..self }
    }

    /// The part of its extent by which a flat set may lie off its hull.
    fn flatness(&self) -> f64 {
        match (self.items, self.is_single) {
            (Items::Ellipsoids, false) => 1e-6,
            (Items::Ellipsoids, true) => 1e-3 * (self.dim as f64).sqrt(),
            _ => flat::OF_POINTS,
        }
    }

    fn whole(&self) -> Option<&Bracket> {
        let find = || optimum(self.bodies.as_ref()?, self.items);
        self.optimum.get_or_init(find).as_ref()
    }

    pub(crate) fn judge(
        &self,
        solution: &Solution<Ellipsoid>,
        verdict: &EllipsoidVerdict,
    ) -> Truth {
        let mut claims = Claims::default();
        if !solution.certificate.left_out.is_empty() {
            return Truth::False("an ellipsoid by itself leaves rows out".into());
        }
        self.claims(&mut claims, &solution.answer, &solution.certificate, verdict);
        claims.truth()
    }

    /// Takes in the claims about an answer and its verdict.
    pub(super) fn claims(
        &self,
        claims: &mut Claims,
        answer: &Ellipsoid,
        certificate: &EllipsoidCertificate,
        verdict: &EllipsoidVerdict,
    ) {
        let Some(bodies) = &self.bodies else {
            return claims.undecided("some row is not an item");
        };
        let Some(exactly) = Exact::of(answer, verdict) else {
            return claims.holds(Some(false), || "a number is not finite".into());
        };
        let shape = [answer.center.len(), answer.matrix.len()];
        let is_shaped = shape.iter().all(|&n| n == self.dim)
            && answer.factor.len() == verdict.rank
            && answer.hull.is_some() == (verdict.rank < self.dim)
            && answer.hull.as_ref().is_none_or(|hull| hull.basis.len() == verdict.rank);
        if !is_shaped {
            return claims.holds(Some(false), || "the lengths of lists disagree".into());
        }
        enclosed(claims, &exactly, bodies, &answer.matrix);
        if claims.is_settled_false() {
            return;
        }
        if verdict.rank == 0 {
            let zero = Interval::zero();
            claims.at_most("lower end of a single point", &exactly.lower, &zero);
            claims.at_most("upper end of a single point", &zero, &exactly.upper);
            claims.holds(Some(answer.log_volume == 0.0), || "log-volume of a single point".into());
            flat::claims(
                claims,
                answer,
                &exactly.center,
                bodies,
                self.flatness(),
                verdict.off_hull,
            );
            return;
        }
        let Some(volume) = log_volume(answer, &exactly.factor) else {
            return claims.holds(Some(false), || "the factor is singular".into());
        };
        let of_basis = match answer.hull {
            Some(_) => 16.0 * (verdict.rank * (self.dim + 4)) as f64 * U,
            None => 0.0,
        };
        let granted = log_volume_tolerance(&answer.factor, volume.rounded()) + of_basis;
        claims.near("log-volume", &exactly.log_volume, &volume, granted);
        if answer.hull.is_some() {
            flat::claims(
                claims,
                answer,
                &exactly.center,
                bodies,
                self.flatness(),
                verdict.off_hull,
            );
        }
        let Some(mut optimum) = self.optimum_for(answer.hull.as_ref(), &exactly.lower) else {
            return claims.undecided("the least log-volume is not known");
        };
        claims.holds(Some(is_gap_granted(verdict.gap, certificate.gap, verdict.rank)), || {
            format!("gap {:e} proved, {:e} claimed", verdict.gap, certificate.gap)
        });
        let proved = dual(bodies, &self.rows, certificate, answer.hull.as_ref());
        if let Some(lower) = proved.clone() {
            optimum.lower = larger(optimum.lower, lower).lower();
        }
        let proved = proved.filter(|_| are_directions_kept(bodies, &self.rows, certificate));
        about_optimum(claims, &exactly, &volume, &optimum, answer, proved.as_ref());
    }

    /// The bracket for the whole space or a hull, narrow enough to tell whether `lower` is below it, if possible.
    pub(super) fn optimum_for(&self, hull: Option<&Hull>, lower: &Interval) -> Option<Bracket> {
        let Some(hull) = hull else { return self.whole().cloned() };
        let bodies = self.bodies.as_ref()?;
        let basis = exact_rows(&hull.basis)?;
        let metric = Factor::of(&gram(&basis), Way::Proved)?.determinant().ln()?.scaled(-1);
        let mapped: Vec<Body> = bodies.iter().map(|body| body.mapped(&basis)).collect();
        let moved = |found: Bracket| Bracket {
            lower: found.lower.minus(&metric),
            upper: found.upper.minus(&metric),
        };
        if self.items != Items::Points {
            return exchange::bracket(&mapped).map(moved);
        }
        let points: Matrix = mapped.into_iter().map(|body| body.center).collect();
        let known = self.weights.lock().map(|known| known.clone()).unwrap_or_default();
        for weights in known {
            if let Some(found) = mvee::bracket(&points, &weights).map(moved)
                && found.upper.minus(&found.lower).binary_order() < -70
            {
                return Some(found);
            }
        }
        let weights = mvee::weights(&points, MU_EXPONENT_MIN)?;
        let found = mvee::bracket(&points, &weights).map(moved)?;
        let decides = lower.at_most(&found.lower) == Some(true);
        if let (true, Ok(mut known)) = (decides, self.weights.lock())
            && known.len() < 8
        {
            known.push(weights);
        }
        Some(found)
    }

    /// The lower end of the bracket for the whole space, and how wide that is.
    #[cfg(test)]
    pub(crate) fn bracket_for_tests(&self) -> Option<(f64, f64)> {
        let Bracket { lower, upper } = self.whole()?;
        Some((lower.rounded(), upper.minus(lower).rounded()))
    }
}

/// Returns what the multipliers of a certificate prove, whatever the checker makes of them.
fn dual(
    bodies: &[Body],
    rows: &[u64],
    certificate: &EllipsoidCertificate,
    hull: Option<&Hull>,
) -> Option<Interval> {
    let mut points: Matrix = vec![];
    for (position, &row) in certificate.support.iter().enumerate() {
        let body = &bodies[rows.binary_search(&row).ok()?];
        let direction = exact(certificate.directions.get(position).map_or(&[], Vec::as_slice))?;
        points.push(match direction.iter().any(Interval::is_nonzero) {
            true => body.touching(&direction, Way::Proved)?,
            false => body.center.clone(),
        });
    }
    let weights = exact(&certificate.multipliers)?;
    if weights.len() != points.len() || !weights.iter().all(Interval::is_positive) {
        return None;
    }
    let Some(hull) = hull else { return Some(Trial::of(&points, &weights, Way::Proved)?.lower) };
    let basis = exact_rows(&hull.basis)?;
    let mapped: Matrix = points.iter().map(|p| image(&basis, p)).collect();
    let metric = Factor::of(&gram(&basis), Way::Proved)?.determinant().ln()?.scaled(-1);
    Some(Trial::of(&mapped, &weights, Way::Proved)?.lower.minus(&metric))
}

fn optimum(bodies: &[Body], items: Items) -> Option<Bracket> {
    if bodies.iter().all(|body| body.shape.is_none()) || items == Items::Points {
        let points: Matrix = bodies.iter().map(|body| body.center.clone()).collect();
        return mvee::bracket(&points, &mvee::weights(&points, MU_EXPONENT_MIN)?);
    }
    exchange::bracket(bodies)
}

/// The numbers of an answer and its verdict.
struct Exact {
    center: Vector,
    factor: Matrix,
    log_volume: Interval,
    lower: Interval,
    upper: Interval,
    gap: Interval,
    excess: Interval,
    matrix_excess: Interval,
}

impl Exact {
    fn of(answer: &Ellipsoid, verdict: &EllipsoidVerdict) -> Option<Self> {
        Some(Exact {
            center: center(answer)?,
            factor: exact_rows(&answer.factor)?,
            log_volume: Interval::exact(answer.log_volume)?,
            lower: Interval::exact(verdict.lower)?,
            upper: Interval::exact(verdict.upper)?,
            gap: Interval::exact(verdict.gap)?,
            excess: Interval::exact(verdict.excess)?,
            matrix_excess: Interval::exact(verdict.matrix_excess)?,
        })
    }
}

/// The center with its tail.
pub(super) fn center(answer: &Ellipsoid) -> Option<Vector> {
    let (center, tail) = (exact(&answer.center)?, exact(&answer.center_tail)?);
    let mut tails = tail.into_iter();
    Some(center.iter().map(|c| tails.next().map_or(c.clone(), |t| c.plus(&t))).collect())
}

/// ln κᵣ − ln |det F|, or of F within the hull: with G = BBᵀ, ln κᵣ − ln |det FBᵀ| + ½·ln det G.
pub(super) fn log_volume(answer: &Ellipsoid, factor: &Matrix) -> Option<Interval> {
    let of_ball = log_unit_ball(factor.len());
    let Some(hull) = &answer.hull else {
        return Some(of_ball.minus(&determinant(factor)?.absolute().ln()?));
    };
    let basis = exact_rows(&hull.basis)?;
    let within: Matrix = factor.iter().map(|row| image(&basis, row)).collect();
    let metric = Factor::of(&gram(&basis), Way::Proved)?.determinant().ln()?.scaled(-1);
    Some(of_ball.minus(&determinant(&within)?.absolute().ln()?).plus(&metric))
}

/// 40u times the sizes of the logarithms that a log-volume is made of, and the rank: the checker grants 32u.
pub(super) fn log_volume_tolerance(factor: &[Vec<f64>], volume: f64) -> f64 {
    let rank = factor.len() as f64;
    let of_ball: f64 =
        (2..=factor.len()).map(|k| (std::f64::consts::TAU / k as f64).ln().abs()).sum();
    let largest = factor.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
    let of_scale = if largest > 0.0 { rank * largest.ln().abs() } else { 0.0 };
    40.0 * U * (volume.abs() + 2.0 * (of_ball + of_scale) + 4.0 * rank + 1.0)
}

/// Claims about enclosure: by F up to the excess, and by Q up to the excess of the matrix.
fn enclosed(claims: &mut Claims, exactly: &Exact, bodies: &[Body], matrix: &[Vec<f64>]) {
    let Some(matrix) = exact_rows(matrix) else {
        return claims.holds(Some(false), || "an entry of the matrix is not finite".into());
    };
    let one = Interval::integer(1);
    let limit = one.plus(&exactly.excess).square();
    let deviation = deviation(&exactly.factor, &matrix);
    let quadric = Quadric { matrix, deviation, limit: one.plus(&exactly.matrix_excess) };
    for (row, body) in bodies.iter().enumerate() {
        // The narrowest shape must be enclosed, whichever of those that rounding explains is meant.
        let framed = Framed::of(&exactly.factor, &exactly.center, body);
        claims.holds(framed.is_within(&limit), || {
            let norm = squared_length(&framed.g).rounded().sqrt();
            format!("row {row} lies outside (its center at {norm:?})")
        });
        matrix_claim(claims, exactly, row, body, &quadric, &limit);
    }
}

/// The set {x : (x − c)ᵀQ(x − c) ≤ limit}.
struct Quadric {
    /// Q.
    matrix: Matrix,
    /// |Q − FᵀF|, entry by entry.
    deviation: Matrix,
    limit: Interval,
}

/// Returns |Q − FᵀF|, entry by entry.
fn deviation(factor: &[Vector], matrix: &[Vector]) -> Matrix {
    let entry = |j: usize, k: usize, q: &Interval| {
        let products = factor.iter().map(|f| f[j].times(&f[k]));
        q.minus(&products.fold(Interval::zero(), |sum, p| sum.plus(&p))).absolute()
    };
    let row =
        |(j, row): (usize, &Vector)| row.iter().enumerate().map(|(k, q)| entry(j, k, q)).collect();
    matrix.iter().enumerate().map(row).collect()
}

/// (x − c)ᵀQ(x − c) = |F(x − c)|² + (x − c)ᵀ(Q − FᵀF)(x − c), the second part bounded by how far the item reaches along the axes.
fn matrix_claim(
    claims: &mut Claims,
    exactly: &Exact,
    row: usize,
    body: &Body,
    quadric: &Quadric,
    within: &Interval,
) {
    let Quadric { matrix, deviation, limit } = quadric;
    let offset = difference(&body.center, &exactly.center);
    let at_center = dot(&offset, &image(matrix, &offset));
    let Some(shape) = &body.shape else {
        return claims.holds(at_center.at_most(limit), || {
            format!("row {row} has (x − c)ᵀQ(x − c) = {:?}", at_center.rounded())
        });
    };
    let reach: Option<Vector> = offset
        .iter()
        .enumerate()
        .map(|(j, x)| Some(x.absolute().plus(&shape.matrix()[j][j].root()?)))
        .collect();
    let Some(reach) = reach else { return claims.undecided(format!("row {row} has no width")) };
    let mut bound = within.clone();
    for (row, along_row) in deviation.iter().zip(&reach) {
        for (entry, along_column) in row.iter().zip(&reach) {
            bound = bound.plus(&entry.times(along_row).times(along_column));
        }
    }
    let mut holds = bound.at_most(limit).filter(|&holds| holds);
    if holds.is_none() && exceeds_matrix(exactly, body, matrix, limit) {
        holds = Some(false);
    }
    claims.holds(holds, || format!("row {row} may exceed the matrix by {:?}", bound.rounded()));
}

/// Returns true if a point of the body that may be the farthest by F exceeds Q.
fn exceeds_matrix(exactly: &Exact, body: &Body, matrix: &Matrix, limit: &Interval) -> bool {
    let framed = Framed::of(&exactly.factor, &exactly.center, body);
    let directions = framed.upper().and_then(|upper| framed.touching(&upper)).unwrap_or_default();
    let exceeds = |point: Vector| {
        let offset = difference(&point, &exactly.center);
        dot(&offset, &image(matrix, &offset)).at_most(limit) == Some(false)
    };
    let touching = |t: &Vector| body.touching(&transposed(&exactly.factor, t), Way::Proved);
    directions.iter().filter_map(touching).chain([body.center.clone()]).any(exceeds)
}

/// Claims about the least log-volume.
fn about_optimum(
    claims: &mut Claims,
    exactly: &Exact,
    volume: &Interval,
    optimum: &Bracket,
    answer: &Ellipsoid,
    proved: Option<&Interval>,
) {
    let (rank, is_flat) = (answer.rank(), answer.hull.is_some());
    claims.below("lower end", &exactly.lower, optimum);
    if is_flat {
        // Without a hull it follows from the enclosure.
        claims.above("upper end", &exactly.upper, optimum);
    }
    let Some(grown) = Interval::integer(1).plus(&exactly.excess).ln() else {
        return claims.undecided("the excess has no logarithm");
    };
    let enlarged = volume.plus(&grown.times(&Interval::integer(rank as i64)));
    claims.at_most(
        "log-volume of the enlarged ellipsoid, as the upper end",
        &enlarged,
        &exactly.upper,
    );
    let least = enlarged.minus(&exactly.gap);
    claims.below("log-volume less the gap", &least, optimum);
    // The optimum may be above what the multipliers prove, and would hide a gap that is too small.
    if let Some(proved) = proved {
        let bracket = Bracket { lower: proved.lower(), upper: proved.upper() };
        claims.below("log-volume less the gap, as the multipliers prove it", &least, &bracket);
    }
}

/// Returns true if the checker takes the directions as they are: it brings the largest entry to 1, first of a direction and then of one
/// whose entries are multiplied by powers of two near the widths, and rounds. Another point of the item is as good, but what
/// the multipliers prove with it is not known here.
fn are_directions_kept(bodies: &[Body], rows: &[u64], certificate: &EllipsoidCertificate) -> bool {
    let is_kept = |(row, direction): (&u64, &Vec<f64>)| {
        let Some(shape) = rows.binary_search(row).ok().and_then(|at| bodies[at].shape.as_ref())
        else {
            return true;
        };
        let wide = direction.iter().enumerate().map(|(j, a)| {
            let width = shape.matrix()[j][j].root().map_or(0.0, |width| width.rounded());
            let power = if width > 0.0 { width.log2().floor().exp2() } else { 0.0 };
            a * power
        });
        let is_power = |size: f64| size.is_normal() && size.log2().floor().exp2() == size;
        let most =
            |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, |m: f64, v| m.max(v.abs()));
        is_power(most(&mut direction.iter().copied())) && is_power(most(&mut wide.into_iter()))
    };
    certificate.support.iter().zip(&certificate.directions).all(is_kept)
}

/// Returns true if a gap in log-volume is as small as the one claimed, up to the slack that the format grants.
pub(super) fn is_gap_granted(proved: f64, claimed: f64, rank: usize) -> bool {
    proved <= (claimed * (1.0 + 1e-9) + 2e-15 * rank as f64) * (1.0 + 1e-15)
}
