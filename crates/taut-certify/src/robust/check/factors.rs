//! The factors of robust estimates, calculated in a way of their own: χ² by its series of positive terms alone.

/// ln Γ(a + 1) for a = d/2: a(a − 1)…, down to Γ(1) = 1 or Γ(1/2) = √π.
fn log_gamma(a: f64, d: usize) -> f64 {
    let mut log_gamma = if d.is_multiple_of(2) { 0.0 } else { 0.5 * std::f64::consts::PI.ln() };
    let mut factor = a;
    while factor > 0.25 {
        log_gamma += factor.ln();
        factor -= 1.0;
    }
    log_gamma
}

/// P(χ² ≤ x) with d degrees of freedom: e^(−y)·yᵃ/Γ(a + 1)·(1 + y/(a + 1) + y²/((a + 1)(a + 2)) + …), y = x/2, a = d/2.
/// To the right of the bulk the terms would grow without bound, and what is beyond is taken from 1.
pub(super) fn probability(x: f64, d: usize) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let (y, a) = (x / 2.0, d as f64 / 2.0);
    if y > a + 1.0 {
        return 1.0 - beyond(x, d);
    }
    let (mut sum, mut term, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-18 * sum {
        term *= y / (a + k);
        sum += term;
        k += 1.0;
    }
    (a * y.ln() - y - log_gamma(a, d) + sum.ln()).exp()
}

/// P(χ² > x) with d degrees of freedom, relatively as sharp for the smallest as for the largest: e^(−y)·Σ yᵏ/Γ(k + 1) for
/// k = a − 1, a − 2, …, and for odd d what the normal distribution leaves beyond √x on both sides.
pub(super) fn beyond(x: f64, d: usize) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let y = x / 2.0;
    let (mut sum, mut k) = (0.0, d as f64 / 2.0 - 1.0);
    let mut term = (k * y.ln() - y - log_gamma(k, d)).exp();
    while k > -0.25 {
        sum += term;
        term *= k / y;
        k -= 1.0;
    }
    if !d.is_multiple_of(2) {
        sum += two_sided_normal(y);
    }
    sum
}

/// erfc √y: near 0 from the series of P, beyond by the continued fraction e^(−y)/√π/(z + ½/(z + 1/(z + 3/2/(z + …)))).
fn two_sided_normal(y: f64) -> f64 {
    if y <= 1.5 {
        return 1.0 - probability(2.0 * y, 1);
    }
    let z = y.sqrt();
    let fraction = (1..=400).rev().fold(z, |below, k| z + 0.5 * f64::from(k) / below);
    (-y).exp() / (fraction * std::f64::consts::PI.sqrt())
}

/// The x with P(χ² ≤ x) = p, for 0 < p < 1, by halving.
pub(super) fn quantile(p: f64, d: usize) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while probability(high, d) < p {
        high *= 2.0;
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if probability(middle, d) < p { low = middle } else { high = middle }
    }
}

/// Croux and Haesbroeck's factor for a covariance of the innermost `part` of normal points.
pub(super) fn consistency(part: f64, d: usize) -> f64 {
    if part < 1.0 { part / probability(quantile(part, d), d + 2) } else { 1.0 }
}

/// Pison, Van Aelst and Willems' factor for n points in dimension d of which h are kept: of the MCD, or of the
/// reweighted MCD. Where the formula gives less than 0 or more than 50 it is not used.
pub(super) fn small_sample(reweighted: bool, h: usize, n: usize, d: usize) -> f64 {
    let half = (n + d).div_ceil(2).min(n);
    let alpha =
        if n > half { 0.5 + (h as f64 - half as f64) / (2 * (n - half)) as f64 } else { 1.0 };
    let alpha = alpha.clamp(0.5, 1.0);
    let dim = d as f64;
    // 1 − f = e^u/n^v at α = 0.5 and at 0.875.
    let lacks = |u: f64, v: f64| u.exp() / (n as f64).powf(v);
    let through = |at_two: (f64, f64), at_three: (f64, f64)| {
        let (two, three) =
            ((at_two.0 / dim.powf(at_two.1)).ln(), (at_three.0 / dim.powf(at_three.1)).ln());
        let v = (two - three) / (3f64.ln() - 2f64.ln());
        lacks(two + v * (2.0 * dim * dim).ln(), v)
    };
    let (at_half, at_most) = match (reweighted, d) {
        (false, 1) => (
            lacks(0.262024211897096, 0.604756680630497),
            lacks(-0.351584646688712, 1.01646567502486),
        ),
        (false, 2) => (
            lacks(0.673292623522027, 0.691365864961895),
            lacks(0.446537815635445, 1.06690782995919),
        ),
        (false, _) => (
            through((1.42764571687802, 1.26263336932151), (1.06141115981725, 1.28907991440387)),
            through((0.455179464070565, 1.11192541278794), (0.294241208320834, 1.09649329149811)),
        ),
        (true, 1) => {
            (lacks(1.11098143415027, 1.5182890270453), lacks(-0.66046776772861, 0.88939595831888))
        }
        (true, 2) => {
            (lacks(3.11101712909049, 1.91401056721863), lacks(0.79473550581058, 1.10081930350091))
        }
        (true, _) => (
            through((1.02842572724793, 1.67659883081926), (0.26800273450853, 1.35968562893582)),
            through((0.544482443573914, 1.25994483222292), (0.343791072183285, 1.25159004257133)),
        ),
    };
    let lacking = if alpha <= 0.875 {
        let part = (alpha - 0.5) / 0.375;
        at_half * (1.0 - part) + at_most * part
    } else {
        at_most * (1.0 - alpha) / 0.125
    };
    let factor = 1.0 / (1.0 - lacking);
    if factor > 0.0 && factor <= 50.0 { factor } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_are_met() {
        assert!((quantile(0.975, 2) + 2.0 * 0.025f64.ln()).abs() < 1e-13);
        assert!((quantile(0.975, 1) - 5.023886187314888).abs() < 1e-12);
        assert!((probability(18.307038053275146, 10) - 0.95).abs() < 1e-14);
        // In the plane: 1 − e^(−q/2)(1 + q/2) for the inner half, q = 2 ln 2.
        let wanted = 0.5 / (1.0 - 0.5 * (1.0 + 2f64.ln()));
        assert!((consistency(0.5, 2) - wanted).abs() < 1e-12);
        // Far out, by fractions of 50 digits.
        for (x, d, wanted) in [
            (100.0, 2, 1.928_749_847_963_917_8e-22),
            (60.0, 1, 9.485_737_571_073_848e-15),
            (1300.0, 4, 651.0 * (-650f64).exp()),
            (3.0, 3, 0.391_625_176_271_089_06),
        ] {
            assert!((beyond(x, d) - wanted).abs() <= 1e-12 * wanted, "{x} {d}: {:e}", beyond(x, d));
        }
        for d in 1..60 {
            let x = d as f64 + 1.9;
            assert!((beyond(x, d) + probability(x, d) - 1.0).abs() < 1e-13, "{d}");
        }
        assert!(probability(1e300, 3) == 1.0 && beyond(1e300, 3) == 0.0);
        assert_eq!(small_sample(false, 30, 30, 4), 1.0);
    }
}
