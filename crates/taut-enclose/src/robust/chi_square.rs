//! The χ² distribution, and the factors by which scatters are made consistent at the normal distribution.
//!
//! *Idea.* With d degrees of freedom, P(χ² ≤ x) is the regularized incomplete gamma function P(d/2, x/2): a series of
//! positive terms to the left of its bulk, a continued fraction to the right.
//! *Reference.* Croux, Haesbroeck, J. Multivariate Analysis 71, 1999, for the consistency; Pison, Van Aelst, Willems,
//! Metrika 55, 2002, for small samples: their formulas with the coefficients their simulations gave.

/// ln Γ(k/2).
fn log_gamma_of_half(k: usize) -> f64 {
    let start = if k.is_multiple_of(2) { 0.0 } else { 0.5 * std::f64::consts::PI.ln() };
    let first = if k.is_multiple_of(2) { 2 } else { 1 };
    start + (first..k).step_by(2).map(|j| (j as f64 / 2.0).ln()).sum::<f64>()
}

/// P(χ² ≤ x) with d degrees of freedom.
pub(super) fn probability(x: f64, d: usize) -> f64 {
    let (a, x) = (d as f64 / 2.0, x / 2.0);
    if x.is_nan() || x <= 0.0 {
        return 0.0;
    }
    let front = (a * x.ln() - x - log_gamma_of_half(d)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut k) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-17 {
            k += 1.0;
            term *= x / k;
            sum += term;
        }
        return (front * sum).min(1.0);
    }
    // Lentz's evaluation of 1/(x + 1 − a − 1(1 − a)/(x + 3 − a − …)).
    let mut b = x + 1.0 - a;
    let (mut c, mut e) = (1e300, 1.0 / b);
    let mut value = e;
    for k in 1..10_000 {
        let k = f64::from(k);
        let numerator = -k * (k - a);
        b += 2.0;
        e = 1.0 / (numerator * e + b);
        c = b + numerator / c;
        let factor = c * e;
        value *= factor;
        if (factor - 1.0).abs() < 1e-16 {
            break;
        }
    }
    (1.0 - front * value).max(0.0)
}

/// The x with P(χ² ≤ x) = p, for p in [0, 1).
pub(super) fn quantile(p: f64, d: usize) -> f64 {
    if p.is_nan() || p <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, d as f64);
    while probability(high, d) < p {
        (low, high) = (high, 2.0 * high);
    }
    let a = d as f64 / 2.0;
    let log_density =
        |x: f64| (a - 1.0) * (x / 2.0).ln() - x / 2.0 - log_gamma_of_half(d) - 2f64.ln();
    let mut x = 0.5 * (low + high);
    for _ in 0..200 {
        let off = probability(x, d) - p;
        if off > 0.0 {
            high = x
        } else {
            low = x
        }
        let newton = x - off / log_density(x).exp();
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= 4e-16 * x {
            break;
        }
        x = next;
    }
    x
}

/// By what the covariance of the part `kept` of normal points, those nearest the center, falls short: its inverse.
pub(super) fn consistency(kept: f64, d: usize) -> f64 {
    if kept >= 1.0 {
        return 1.0;
    }
    kept / probability(quantile(kept, d), d + 2)
}

/// Coefficients of Pison, Van Aelst and Willems for one estimator: at α = 0.5 and at 0.875.
struct SmallSample {
    /// For d = 1 and 2: f = 1 − eᵃ/nᵇ.
    low: [[(f64, f64); 2]; 2],
    /// For more: −a/dᵇ is what f lacks of 1 at n = 2d² and at 3d².
    high: [[(f64, f64); 2]; 2],
}

const RAW: SmallSample = SmallSample {
    low: [
        [(0.262024211897096, 0.604756680630497), (-0.351584646688712, 1.01646567502486)],
        [(0.673292623522027, 0.691365864961895), (0.446537815635445, 1.06690782995919)],
    ],
    high: [
        [(-1.42764571687802, 1.26263336932151), (-1.06141115981725, 1.28907991440387)],
        [(-0.455179464070565, 1.11192541278794), (-0.294241208320834, 1.09649329149811)],
    ],
};

const REWEIGHTED: SmallSample = SmallSample {
    low: [
        [(1.11098143415027, 1.5182890270453), (-0.66046776772861, 0.88939595831888)],
        [(3.11101712909049, 1.91401056721863), (0.79473550581058, 1.10081930350091)],
    ],
    high: [
        [(-1.02842572724793, 1.67659883081926), (-0.26800273450853, 1.35968562893582)],
        [(-0.544482443573914, 1.25994483222292), (-0.343791072183285, 1.25159004257133)],
    ],
};

/// Returns what the determinant criterion of n points in dimension d falls short of for h of them kept; α is in [0.5, 1].
///
/// Where n is so small that the formula leaves what it was fitted to, and says less than 0 or more than 50, it is 1.
fn small_sample(table: &SmallSample, alpha: f64, n: usize, d: usize) -> f64 {
    let (n, dim) = (n as f64, d as f64);
    let at = |which: usize| -> f64 {
        let (a, b) = if d <= 2 {
            table.low[d - 1][which]
        } else {
            // ln(1 − f) = a − b·ln n through both points.
            let [two, three] = table.high[which].map(|(a, b)| (-a / dim.powf(b)).ln());
            let slope = (three - two) / 1.5f64.ln();
            (two - slope * (2.0 * dim * dim).ln(), -slope)
        };
        1.0 - a.exp() / n.powf(b)
    };
    let (half, most) = (at(0), at(1));
    let lacking = if alpha <= 0.875 {
        half + (most - half) / 0.375 * (alpha - 0.5)
    } else {
        most + (1.0 - most) / 0.125 * (alpha - 0.875)
    };
    let factor = 1.0 / lacking;
    if factor > 0.0 && factor <= 50.0 { factor } else { 1.0 }
}

/// α of h as the literature has it: 0.5 for ⌊(n + d + 1)/2⌋ points, 1 for n.
fn interpolated(h: usize, n: usize, d: usize) -> f64 {
    let half = super::options::least(n, d);
    if n == half {
        1.0
    } else {
        (0.5 + 0.5 * (h as f64 - half as f64) / (n - half) as f64).clamp(0.5, 1.0)
    }
}

/// By what the covariance of the h points of the MCD is multiplied.
pub(super) fn mcd_scale(h: usize, n: usize, d: usize) -> f64 {
    consistency(h as f64 / n as f64, d) * small_sample(&RAW, interpolated(h, n, d), n, d)
}

/// By what the covariance of the `left` points not weighed out is multiplied, after an MCD of h points.
pub(super) fn mcd_reweighted_scale(left: usize, h: usize, n: usize, d: usize) -> f64 {
    if left == n {
        return 1.0;
    }
    consistency(left as f64 / n as f64, d) * small_sample(&REWEIGHTED, interpolated(h, n, d), n, d)
}

/// By what (F′F)⁻¹ of the MVE of h points is multiplied: the border lies where a part h/(n + 1) of normal points is
/// inside, and the factor for small samples is that of Rousseeuw and van Zomeren, JASA 85, 1990.
pub(super) fn mve_scale(h: usize, n: usize, d: usize) -> f64 {
    let small = if n > d { 1.0 + 15.0 / (n - d) as f64 } else { 1.0 };
    small * small / quantile(h as f64 / (n as f64 + 1.0), d)
}

/// By what the covariance of the `left` points not weighed out is multiplied, after an MVE.
pub(super) fn mve_reweighted_scale(left: usize, n: usize, d: usize) -> f64 {
    consistency(left as f64 / n as f64, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (p, d, wanted) in [
            (0.975, 1, 5.023886187314888),
            (0.975, 2, 7.377758908227871),
            (0.975, 3, 9.348403604496148),
            (0.95, 10, 18.307038053275146),
            (0.5, 100, 99.33412923598846),
            (0.01, 1, 0.00015708785790970184),
        ] {
            let found = quantile(p, d);
            assert!((found / wanted - 1.0).abs() < 1e-13, "{p}, {d}: {found}");
        }
        for d in [1, 2, 5, 40, 300] {
            for p in [1e-6, 0.1, 0.5, 0.9, 0.999_999] {
                let off = probability(quantile(p, d), d) / p - 1.0;
                // The cost of rounding the quantile far out.
                assert!(off.abs() < 1e-14 * (10 + d) as f64, "{p}, {d}: {off:e}");
            }
        }
    }

    #[test]
    fn half_of_normal_numbers_have_the_variance_of_the_truncated_normal() {
        // Var(Z | |Z| ≤ q) = 1 − 2qφ(q)/(2Φ(q) − 1).
        let q = 0.6744897501960817f64;
        let density = (-0.5 * q * q).exp() / std::f64::consts::TAU.sqrt();
        let wanted = 1.0 / (1.0 - 2.0 * q * density / 0.5);
        assert!((consistency(0.5, 1) - wanted).abs() < 1e-12);
        assert_eq!(consistency(1.0, 3), 1.0);
    }

    #[test]
    fn factors_of_small_samples_tend_to_one() {
        assert!((mcd_scale(39, 75, 3) / consistency(39.0 / 75.0, 3)) > 1.0);
        let large = mcd_scale(500_006, 1_000_000, 10) / consistency(0.500_006, 10);
        assert!((large - 1.0).abs() < 1e-3, "{large}");
        assert_eq!(mcd_scale(20, 20, 3), 1.0);
    }
}
