//! Claims about the quantile and the factors of a robust estimate, in plain `f64`: 1e-9 is granted for each.
//!
//! *Quantile.* P(χ² ≤ cutoff) = level with r degrees of freedom. *Factors.* With q(p) the quantile at p, n rows on the hull,
//! h of them kept and m not weighed out: by `mcd` (h/n)/P′(q(h/n)) with P′ that of r + 2 degrees, times the factor of Pison,
//! Van Aelst and Willems (Metrika 55, 2002) for small samples; by `mve` and `trim` (1 + 15/(n − r))²/q(h/(n + 1)) (Rousseeuw
//! and van Zomeren 1990). For the points not weighed out (m/n)/P′(q(m/n)), by `mcd` times its factor for small samples; or
//! level/P′(q(level)), where the certificate says so.

use taut::RobustMethod;
use taut::certify::{RobustCertificate, RobustScale, RobustVerdict};

use super::super::claims::Claims;

/// A factor may be off by this, relatively: the checker grants 1e-9, and both are rounded.
const FACTOR_TOLERANCE: f64 = 1.1e-9;
/// A probability may be off by this: 4e-16 by the checker, and what the series here is rounded by.
const PROBABILITY_TOLERANCE: f64 = 1e-13;

pub(super) fn claims(
    claims: &mut Claims,
    certificate: &RobustCertificate,
    verdict: &RobustVerdict,
    rows: usize,
) {
    let RobustCertificate { method, level, cutoff, raw_scale, scale, scaled_by, .. } = *certificate;
    let mut near = |what: &str, found: f64, wanted: f64, granted: f64| {
        let is_near = (found - wanted).abs() <= granted;
        claims.holds(Some(is_near), || format!("{what}: {found:?} in place of {wanted:?}"));
    };
    let is_trim = method == RobustMethod::Trim;
    if is_trim {
        near("level", level, 1.0, 0.0);
        near("quantile", cutoff, 0.0, 0.0);
        near("factor of the scatter", scale, 0.0, 0.0);
    }
    let rank = verdict.rank;
    if rank == 0 {
        return near("factor of the points kept", raw_scale, 1.0, 0.0);
    }
    let (h, n) = (verdict.wanted as f64, verdict.on_hull as f64);
    let left = (rows - certificate.weighed_out.len()) as f64;
    let is_mcd = method == RobustMethod::Mcd;
    let first = if is_mcd {
        consistency(h / n, rank) * small_sample(RAW_SMALL_SAMPLE, h, n, rank)
    } else {
        let small = if n > rank as f64 { 1.0 + 15.0 / (n - rank as f64) } else { 1.0 };
        small * small / quantile(h / (n + 1.0), rank)
    };
    near("factor of the points kept", raw_scale, first, FACTOR_TOLERANCE * first);
    if is_trim {
        return;
    }
    let rest = 1.0 - level;
    let beyond = 1.0 - probability(cutoff, rank);
    near("part beyond the quantile", beyond, rest, FACTOR_TOLERANCE * rest + PROBABILITY_TOLERANCE);
    let last = match (verdict.reweighted, left == n) {
        (false, _) => raw_scale,
        _ if scaled_by == RobustScale::Level => consistency(level, rank),
        (true, true) => 1.0,
        (true, false) if is_mcd => {
            consistency(left / n, rank) * small_sample(REWEIGHTED, h, n, rank)
        }
        (true, false) => consistency(left / n, rank),
    };
    near("factor of the scatter", scale, last, FACTOR_TOLERANCE * last);
}

/// P(χ² ≤ x) with d degrees of freedom: yᵃe^(−y)/Γ(a + 1)·Σ yᵏ/((a + 1)…(a + k)) for y = x/2 and a = d/2.
fn probability(x: f64, d: usize) -> f64 {
    let (y, a) = (x / 2.0, d as f64 / 2.0);
    if y <= 0.0 {
        return 0.0;
    }
    // Beyond this, what is missing to 1 is less than 1e-40 for the dimensions of the tests.
    if y > 150.0 + 4.0 * a {
        return 1.0;
    }
    let root_of_pi = std::f64::consts::PI.sqrt();
    let mut gamma = if d.is_multiple_of(2) { 1.0 } else { root_of_pi };
    let mut k = if d.is_multiple_of(2) { 1.0 } else { 0.5 };
    while k <= a {
        gamma *= k;
        k += 1.0;
    }
    let (mut sum, mut term, mut k) = (0.0, 1.0, 0.0);
    while term > 1e-20 * sum {
        sum += term;
        k += 1.0;
        term *= y / (a + k);
    }
    (y.powf(a) * (-y).exp() / gamma * sum).min(1.0)
}

/// The x with P(χ² ≤ x) = p, by halving.
fn quantile(p: f64, d: usize) -> f64 {
    let (mut low, mut high) = (0.0, 400.0 + 10.0 * d as f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if probability(middle, d) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn consistency(part: f64, d: usize) -> f64 {
    if part < 1.0 { part / probability(quantile(part, d), d + 2) } else { 1.0 }
}

/// For each dimension, or the two sample sizes 2d² and 3d² from the third on, u and v of 1 − eᵘ/nᵛ, or u/dᵛ: at a coverage of
/// one half, then at 7/8.
struct Table {
    one: [(f64, f64); 2],
    two: [(f64, f64); 2],
    more: [[(f64, f64); 2]; 2],
}

const RAW_SMALL_SAMPLE: Table = Table {
    one: [(0.262024211897096, 0.604756680630497), (-0.351584646688712, 1.01646567502486)],
    two: [(0.673292623522027, 0.691365864961895), (0.446537815635445, 1.06690782995919)],
    more: [
        [(1.42764571687802, 1.26263336932151), (1.06141115981725, 1.28907991440387)],
        [(0.455179464070565, 1.11192541278794), (0.294241208320834, 1.09649329149811)],
    ],
};

const REWEIGHTED: Table = Table {
    one: [(1.11098143415027, 1.5182890270453), (-0.66046776772861, 0.88939595831888)],
    two: [(3.11101712909049, 1.91401056721863), (0.79473550581058, 1.10081930350091)],
    more: [
        [(1.02842572724793, 1.67659883081926), (0.26800273450853, 1.35968562893582)],
        [(0.544482443573914, 1.25994483222292), (0.343791072183285, 1.25159004257133)],
    ],
};

fn small_sample(table: Table, h: f64, n: f64, d: usize) -> f64 {
    let dim = d as f64;
    // What 1 lacks at both coverages.
    let lacks = |at: usize| match d {
        1 | 2 => {
            let (u, v) = if d == 1 { table.one[at] } else { table.two[at] };
            u.exp() * n.powf(-v)
        }
        _ => {
            // A line through two points of ln n and the logarithm.
            let logs = table.more[at].map(|(u, v)| u.ln() - v * dim.ln());
            let sizes = [(2.0 * dim * dim).ln(), (3.0 * dim * dim).ln()];
            let slope = (logs[1] - logs[0]) / (sizes[1] - sizes[0]);
            (logs[0] + slope * (n.ln() - sizes[0])).exp()
        }
    };
    let half = ((n + dim + 1.0) / 2.0).floor().min(n);
    let alpha = if n > half { (h - 2.0 * half + n) / (2.0 * (n - half)) } else { 1.0 };
    let alpha = alpha.clamp(0.5, 1.0);
    let lacking = match alpha <= 0.875 {
        true => lacks(0) + (lacks(1) - lacks(0)) * (alpha - 0.5) / 0.375,
        false => lacks(1) * (1.0 - alpha) / 0.125,
    };
    let factor = 1.0 / (1.0 - lacking);
    if factor > 0.0 && factor <= 50.0 { factor } else { 1.0 }
}
