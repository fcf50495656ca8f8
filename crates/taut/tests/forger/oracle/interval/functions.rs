//! Constants, exponentials and logarithms of intervals.
//!
//! *Exponential.* eˣ = (e^(x/2ᵏ))^(2ᵏ) for |x|/2ᵏ < 2⁻⁹, by its series; the terms left out are less than twice the first.
//! *Logarithm.* With a plain `f64` y near ln x, ln x = y + ln(1 + t) for t = x·e⁻ʸ − 1, of size 1e-15 or so, by its series;
//! the terms left out are less than twice the first.
//! *π* is 16·arctan(1/5) − 4·arctan(1/239), Machin's formula; *ln 2* is 2·artanh(1/3).

use std::sync::OnceLock;

use super::Interval;

/// Terms of a series are left to the radius from this many bits below the leading one on.
const TERM_BITS: i64 = 280;

/// Adds [−2·|term|, 2·|term|].
fn widened(sum: &Interval, term: &Interval) -> Interval {
    let radius = sum.radius.plus(term.size().plus(term.radius).scaled(1));
    Interval { radius, ..sum.clone() }
}

/// Σ ±1/((2j + 1)·n^(2j + 1)): arctan(1/n) with alternating signs, artanh(1/n) without.
fn inverse_tangent(n: i64, alternates: bool) -> Option<Interval> {
    let mut power = Interval::fraction(1, n)?;
    let square = Interval::integer(n * n);
    let mut sum = Interval::zero();
    for j in 0..200 {
        let term = power.over(&Interval::integer(2 * j + 1))?;
        if term.binary_order() < -TERM_BITS {
            return Some(widened(&sum, &term));
        }
        sum = if alternates && j % 2 == 1 { sum.minus(&term) } else { sum.plus(&term) };
        power = power.over(&square)?;
    }
    None
}

fn constant(
    cell: &'static OnceLock<Interval>,
    find: impl FnOnce() -> Option<Interval>,
) -> &'static Interval {
    cell.get_or_init(|| find().expect("the series of a constant converges"))
}

pub(crate) fn pi() -> &'static Interval {
    static PI: OnceLock<Interval> = OnceLock::new();
    constant(&PI, || {
        let (first, second) = (inverse_tangent(5, true)?, inverse_tangent(239, true)?);
        Some(first.scaled(4).minus(&second.scaled(2)))
    })
}

fn ln_two() -> &'static Interval {
    static LN_TWO: OnceLock<Interval> = OnceLock::new();
    constant(&LN_TWO, || Some(inverse_tangent(3, false)?.scaled(1)))
}

/// The logarithm of the volume of the unit ball of dimension r: κ₀ = 1, κ₁ = 2, κᵣ = κᵣ₋₂·2π/r.
pub(crate) fn log_unit_ball(rank: usize) -> Interval {
    static KNOWN: OnceLock<Vec<Interval>> = OnceLock::new();
    let known = KNOWN.get_or_init(|| {
        let mut volumes = vec![Interval::integer(1), Interval::integer(2)];
        for r in 2..32 {
            let step = pi().scaled(1).over(&Interval::integer(r)).expect("r is not 0");
            volumes.push(volumes[r as usize - 2].times(&step));
        }
        volumes.iter().map(|v| v.ln().expect("volumes are positive")).collect()
    });
    known[rank].clone()
}

impl Interval {
    /// eˣ; `None` beyond 2⁴⁰.
    pub(crate) fn exp(&self) -> Option<Self> {
        if self.magnitude() > 40 {
            return None;
        }
        let halvings = (self.binary_order() + 10).max(0);
        let x = self.scaled(-halvings);
        let (mut sum, mut term) = (Interval::integer(1), Interval::integer(1));
        for j in 1..400 {
            term = term.times(&x).over(&Interval::integer(j))?;
            if term.size().is_zero() || term.binary_order() < -TERM_BITS {
                let mut power = widened(&sum, &term);
                for _ in 0..halvings {
                    power = power.square();
                }
                return Some(power);
            }
            sum = sum.plus(&term);
        }
        None
    }

    /// ln x; `None` where x may be 0 or less.
    pub(crate) fn ln(&self) -> Option<Self> {
        if !self.is_positive() {
            return None;
        }
        let order = self.binary_order();
        let x = self.scaled(-order);
        let near = Interval::exact(x.rounded().ln())?;
        let t = x.times(&near.negative().exp()?).minus(&Interval::integer(1));
        let whole = near.plus(&ln_two().times(&Interval::integer(order)));
        let (mut sum, mut power) = (Interval::zero(), t.clone());
        for j in 1..400 {
            let term = power.over(&Interval::integer(j))?;
            if term.size().plus(term.radius).is_zero() {
                return Some(whole.plus(&sum));
            }
            let is_small = term.upper().absolute().binary_order() < -TERM_BITS
                && term.lower().absolute().binary_order() < -TERM_BITS;
            if is_small || j > 40 {
                // Whatever the radius of t is, the rest is bounded while |t| < 1/2.
                let most =
                    t.upper().absolute().binary_order().max(t.lower().absolute().binary_order());
                return (most < -1).then(|| whole.plus(&widened(&sum, &term)));
            }
            sum = if j % 2 == 1 { sum.plus(&term) } else { sum.minus(&term) };
            power = power.times(&t);
        }
        None
    }
}
