//! Claims about the hull of a flat set.
//!
//! With u = 2⁻⁵³, the documentation grants: products of the basis off orthonormal by 16(d + 4)u; rows of the factor, and
//! offsets of points, off the hull by ρ = 32(d + 4)√(r + 1)·u of their length, and widths of bodies by √ρ of them. A set is flat if the
//! distance stated is at most 1e-10 of its extent (1e-6 for ellipsoids, 1e-3·√d in single precision) and what rounding its coordinates explains.

use taut::certify::Ellipsoid;
use taut::certify::Hull;

use super::body::Body;
use super::claims::Claims;
use super::ellipsoid::U;
use super::interval::Interval;
use super::linear::{
    Factor, Matrix, Vector, Way, difference, exact_rows, gram, image, squared_length,
};

/// The part of their extent by which points and balls that are called flat may lie off their hull.
pub(super) const OF_POINTS: f64 = 1e-10;

/// One part in 10⁶ more than granted, for what the checker itself rounds.
const ROUNDED_FACTOR: f64 = 1.0 + 1e-6;

/// A subspace, to find distances from.
struct Subspace {
    basis: Matrix,
    metric: Factor,
}

impl Subspace {
    /// The squared distance of a vector from the subspace, |x|² − zᵀG⁻¹z for z = Bx and G = BBᵀ.
    fn squared_distance(&self, x: &[Interval]) -> Option<Interval> {
        Some(squared_length(x).minus(&self.metric.quadratic(&image(&self.basis, x))?))
    }
}

pub(super) fn claims(
    claims: &mut Claims,
    answer: &Ellipsoid,
    center: &[Interval],
    bodies: &[Body],
    flatness: f64,
    told: f64,
) {
    let found = judge(claims, answer, center, bodies, flatness, 1.0, Some(told));
    if found.is_none() {
        claims.undecided("the hull is not one");
    }
}

/// As [`claims`] where the distance may be `wider` times as large, and how far bodies lie off the hull at most may be `told`;
/// `None` where nothing is known.
pub(super) fn judge(
    claims: &mut Claims,
    answer: &Ellipsoid,
    center: &[Interval],
    bodies: &[Body],
    flatness: f64,
    wider: f64,
    told: Option<f64>,
) -> Option<()> {
    let hull = answer.hull.as_ref()?;
    let (dim, rank) = (center.len(), hull.basis.len());
    let basis = exact_rows(&hull.basis)?;
    let products = gram(&basis);
    let tolerance = 16.0 * (dim + 4) as f64 * U * ROUNDED_FACTOR;
    for (i, row) in products.iter().enumerate() {
        for (j, product) in row.iter().enumerate() {
            let wanted = Interval::integer(i64::from(i == j));
            claims.near("product of rows of the basis", product, &wanted, tolerance);
        }
    }
    if claims.is_settled_false() {
        return Some(());
    }
    let subspace = Subspace { metric: Factor::of(&products, Way::Proved)?, basis };
    let rounding = 32.0 * (dim + 4) as f64 * ((rank + 1) as f64).sqrt() * U * ROUNDED_FACTOR;
    let part = Interval::exact(rounding)?;
    for row in exact_rows(&answer.factor)? {
        let off = subspace.squared_distance(&row)?;
        let granted = squared_length(&row).times(&part.square());
        claims.at_most("squared distance of a row of the factor from the hull", &off, &granted);
    }
    let distance = Interval::exact(hull.distance)?;
    for (row, body) in bodies.iter().enumerate() {
        let offset = difference(&body.center, center);
        let mut reach = subspace.squared_distance(&offset)?.upper().root()?;
        let mut granted = distance.plus(&squared_length(&offset).root()?.times(&part));
        if let Some(shape) = &body.shape {
            let shape = shape.matrix();
            let trace = (0..dim).fold(Interval::zero(), |sum, j| sum.plus(&shape[j][j]));
            // tr S − tr G⁻¹BSBᵀ.
            let mut off = trace.clone();
            for (j, row) in image_of_shape(&subspace.basis, shape).iter().enumerate() {
                off = off.minus(&subspace.metric.solve(row)?[j]);
            }
            reach = reach.plus(&off.root().unwrap_or_else(Interval::zero));
            granted = granted.plus(&trace.root()?.times(&part.root()?));
        }
        claims.at_most(&format!("distance of row {row} from the hull"), &reach, &granted);
        if let Some(told) = told {
            let told = Interval::exact(told)?;
            claims.at_most(&format!("distance of row {row} from the hull, told"), &reach, &told);
        }
    }
    let allowed =
        allowed(bodies, &subspace, dim, flatness)?.times(&Interval::exact(wider * ROUNDED_FACTOR)?);
    claims.at_most("distance of a hull, with what is flat", &distance, &allowed);
    Some(())
}

/// Tests whether a point at this offset from the center is as near to the hull as stated; `Some(None)` where what the
/// checker rounds may decide.
pub(super) fn is_near(hull: &Hull, offset: &[Interval]) -> Option<Option<bool>> {
    let basis = exact_rows(&hull.basis)?;
    let (dim, rank) = (offset.len(), basis.len());
    let subspace = Subspace { metric: Factor::of(&gram(&basis), Way::Proved)?, basis };
    let off = subspace.squared_distance(offset)?.upper().root()?;
    let rounding = 32.0 * (dim + 4) as f64 * ((rank + 1) as f64).sqrt() * U * ROUNDED_FACTOR;
    let rounding = squared_length(offset).root()?.times(&Interval::exact(rounding)?);
    let distance = Interval::exact(hull.distance)?;
    // A solver states twice the distance of the rows that it kept, so that rounding does not decide about these.
    let is_on = [off.plus(&rounding), off.scaled(1)];
    if is_on.iter().any(|reach| reach.at_most(&distance) == Some(true)) {
        return Some(Some(true));
    }
    Some((off.at_most(&distance.plus(&rounding)) == Some(false)).then_some(false))
}

/// BSBᵀ.
fn image_of_shape(basis: &[Vector], shape: &[Vector]) -> Matrix {
    super::linear::congruent(basis, shape)
}

/// `share` of the extent, and what rounding explains: 128√d·u·√Σⱼ(maxᵢ |xᵢⱼ|·|(I − P)eⱼ|)².
fn allowed(bodies: &[Body], subspace: &Subspace, dim: usize, share: f64) -> Option<Interval> {
    let (mut extent, mut rounding) = (Interval::zero(), Interval::zero());
    for j in 0..dim {
        let (mut low, mut high): (Option<Interval>, Option<Interval>) = (None, None);
        for body in bodies {
            let width = match &body.shape {
                Some(shape) => shape.matrix()[j][j].root()?,
                None => Interval::zero(),
            };
            let (from, to) =
                (body.center[j].minus(&width).lower(), body.center[j].plus(&width).upper());
            let is_lower = low.as_ref().is_none_or(|low| from.at_most(low) == Some(true));
            let is_higher = high.as_ref().is_none_or(|high| high.at_most(&to) == Some(true));
            low = if is_lower { Some(from) } else { low };
            high = if is_higher { Some(to) } else { high };
        }
        let (low, high) = (low?, high?);
        extent = extent.plus(&high.minus(&low).scaled(-1).square());
        let largest = super::mvee::larger(low.absolute(), high.absolute());
        let unit: Vector = (0..dim).map(|k| Interval::integer(i64::from(j == k))).collect();
        let seen = subspace.squared_distance(&unit)?.upper();
        let seen = if seen.is_positive() { seen } else { Interval::zero() };
        rounding = rounding.plus(&largest.square().times(&seen));
    }
    let of_extent = extent.root()?.times(&Interval::exact(share)?);
    let of_rounding = rounding.root()?.times(&Interval::exact(128.0 * (dim as f64).sqrt() * U)?);
    // What the products of a basis that is orthonormal but for rounding seem to leave of a coordinate.
    Some(of_extent.plus(&of_rounding).upper())
}
