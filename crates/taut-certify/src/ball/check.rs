//! The checker of the ball, in arithmetic of its own.
//!
//! *Problem.* Given rows pᵢ with radii rᵢ (0 for points), a ball of center c and radius R, and multipliers λᵢ > 0 on a
//! few rows, prove L ≤ R* ≤ R, where R* is the radius of the smallest ball that encloses all rows.
//! *Upper bound.* |pᵢ − c| + rᵢ ≤ R for every row, decided exactly: [`enclosure`].
//! *Lower bound.* With W = Σλᵢ, p̄ = Σλᵢpᵢ/W, r̄ = Σλᵢrᵢ/W and V = Σλᵢ(|pᵢ − p̄|² − (rᵢ − r̄)²)/W, every enclosing ball has
//! radius at least r̄ + √V if V ≥ 0, and at least r̄ in any case. Proof: let the ball of center x and radius ρ enclose
//! all rows. Then |pᵢ − x|² ≤ (ρ − rᵢ)² with ρ ≥ rᵢ; averaged with weights λᵢ/W the left side is
//! |x − p̄|² + Σλᵢ|pᵢ − p̄|²/W and the right side (ρ − r̄)² + Σλᵢ(rᵢ − r̄)²/W, so V ≤ (ρ − r̄)² with ρ ≥ r̄.
//! *In which form.* Averages about p̄ and r̄ can be taken about any other center and radius. About c and R themselves,
//! with tᵢ = |pᵢ − c|² − (R − rᵢ)², g = R − r̄ and
//!
//! > σ = |p̄ − c|² − Σλᵢtᵢ/W,  V = g² − σ,  so  L = r̄ + √V = R − x  with  x = σ / (g + √(g² − σ)).
//!
//! For a good answer tᵢ is nearly 0 on the support and p̄ nearly c, so x, by which R can be too large, is computed
//! from small numbers and without cancellation, for balls that touch from inside just as for points: [`lower_bound`].
//! Where the root does not exist, x = g. And x ≤ R − rᵢ, as no enclosing ball is smaller than what it encloses.
//! *Ellipsoids.* Both bounds in [`ellipsoids`].
//! *Order.* Structure, then one pass (finite rows, hash, enclosure), then the support rows as that pass read them (center, gap).
//! *Scale.* Where squares could leave the range of `f64`, differences pᵢ − c are multiplied by the power of two that
//! brings R to [1, 2): exactly, but for what underflows beside R.
//! *Tolerances.* Enclosure has none. The others only ask that stated numbers are what they are said to be, up to the
//! rounding that writing them down as `f64` costs, and weaken neither bound; each is derived where it stands.
//! *Reference.* For points, the dual of Yıldırım, SIAM J. Optim. 19(3), 2008.

mod difference;
pub(crate) mod ellipsoids;
mod enclosure;
mod lower_bound;
pub(crate) mod parts;
mod plain_squares;
mod scale;
pub(crate) mod structure;

use taut_points::{Monitor, PointSource};

use self::enclosure::Enclosure;
use self::lower_bound::Bound;
use super::{Ball, BallCertificate};
use crate::{CheckError, Items, Verdict, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and in units of 1.
///
/// A solver finds its gap as R/L − 1 in arithmetic of its own: a few units in the last place of the quotient, 4e-16,
/// and a relative error of the gap, for which 1e-9 is ample. As a radius that is larger by a factor 1 + 1e-9 raises
/// a gap g by 1e-9·(1 + g), it is still seen.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-16);

pub(super) fn check(
    ball: &Ball,
    certificate: &BallCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Verdict, CheckError> {
    structure::check(ball, certificate, source.len(), source.dim())?;
    monitor.pass(1, source.len());
    let bound = if certificate.items == Items::Ellipsoids {
        ellipsoids::prove(ball, certificate, source, monitor)?
    } else {
        let enclosure = Enclosure::of(ball, certificate.items);
        let support = enclosure.check(source, certificate, monitor)?;
        lower_bound::prove(ball, certificate, &support, monitor)?
    };
    verdict(ball, certificate, &bound)
}

/// Compares the gap that was proved with the one that is claimed.
fn verdict(
    ball: &Ball,
    certificate: &BallCertificate,
    bound: &Bound,
) -> Result<Verdict, CheckError> {
    let (relative, absolute) = GAP_SLACK;
    let is_proved = bound.gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(Violation::Gap { claimed: certificate.gap, proved: bound.gap }.into());
    }
    Ok(Verdict { lower: bound.lower, upper: ball.radius, gap: bound.gap })
}
