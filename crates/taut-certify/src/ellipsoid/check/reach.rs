//! Measures how far an ellipsoid {m + v : vvᵀ ⪯ S} reaches in the frame of another: the largest |F(x − c)| over its points x.
//!
//! *Formula.* With g = F(m − c) and A = FSFᵀ, the images y = g + w of its points have wwᵀ ⪯ A. For every μ with
//! μI − A positive definite,
//!
//! > |y|² ≤ φ(μ) = μ·(1 + gᵀ(μI − A)⁻¹g),
//!
//! and the least φ(μ) is the largest |y|² (this is the S-lemma). Proof of the bound: μI − wwᵀ ⪰ μI − A, so
//! φ(μ) ≥ μ·(1 + gᵀ(μI − wwᵀ)⁻¹g) = μ + |g|² + (gᵀw)²/(μ − |w|²), and that minus |g + w|² is
//! (μ − |w|² − gᵀw)²/(μ − |w|²) ≥ 0.
//! *Idea.* μ is found by Newton steps on |A^½(μI − A)⁻¹g| = 1, the condition of the minimum; which μ is found does not
//! matter for the proof. φ(μ) is then bounded. All this in plain `f64`, and, where that is not enough, in doubled precision.
//! *Rounding.* A is off by at most η in norm, and the factorization of μI − A by at most σ: so (μ − η − σ)I − A is
//! factorized instead, which makes φ larger.
//! *Trap.* Where g has little part along the longest axes of A, the minimum lies so near μ = λmax(A) that μ must be known to
//! more digits than an `f64` has, and where it has none, μI − A is singular there: μ is then raised by more and more,
//! from what rounding explains, until φ grows.
//! *Reference.* Pólik and Terlaky, A survey of the S-lemma, SIAM Review 49(3), 2007; Moré and Sorensen, SIAM J. Sci.
//! Stat. Comput. 4(3), 1983, for the Newton steps.

use super::enclosure::excess_of_square;
use super::frame::{Frame, power_of_two_below};
use super::item::Item;
use crate::arithmetic::{DoubleDouble, Field, U, factorize};

/// The largest |F(x − c)| − 1 over the item, or a little more.
pub(crate) fn excess(frame: &Frame<'_>, item: &Item<'_>) -> f64 {
    let plain = bound::<f64>(frame, item);
    if plain <= 0.0 { plain } else { bound::<DoubleDouble>(frame, item) }
}

/// The largest |F(x − c)| over the item but for what a few hundred sums in `f64` may be off by, to compare it with others; not a
/// number where squares overflow.
pub(crate) fn length(frame: &Frame<'_>, item: &Item<'_>) -> f64 {
    let image = frame.image(&frame.offset::<f64>(item.center()));
    if item.is_point() {
        return image.iter().map(|y| y * y).sum::<f64>().sqrt();
    }
    let shape = Shape::<f64>::of(frame, item);
    let mu = multiplier(&shape.lower, &image);
    (1.0 + shape.beyond_one(&image, &mu)).max(0.0).sqrt()
}

fn bound<N: Field>(frame: &Frame<'_>, item: &Item<'_>) -> f64 {
    let offset: Vec<N> = frame.offset(item.center());
    let sizes: Vec<f64> = offset.iter().map(|x| x.rounded().abs()).collect();
    let widths: f64 = (0..frame.dim).map(|j| item.width(j, frame.scale)).sum();
    let error = frame.image_error::<N>(&sizes, None) + frame.width_error(widths);
    let image = frame.image(&offset);
    let square = image.iter().fold(N::of(-1.0), |sum, y| sum.plus(&y.times(y)));
    if item.is_point() {
        return excess_of_square(square, image.len()) + error;
    }
    let shape = Shape::<N>::of(frame, item);
    if !shape.trace.is_finite() {
        return f64::INFINITY;
    }
    let (beyond, width) = (excess_of_square(square, image.len()), shape.trace.sqrt());
    let simply = beyond + width + 8.0 * U * (beyond.abs() + width) + error;
    if simply <= -1e-9 {
        return simply;
    }
    let mu = multiplier(&shape.lower, &image);
    simply.min(shape.excess(&image, &mu) + error)
}

/// A = FSFᵀ.
struct Shape<N> {
    n: usize,
    /// The lower triangle, row by row.
    lower: Vec<N>,
    /// tr A, rounded up.
    trace: f64,
    /// η.
    error: f64,
}

impl<N: Field> Shape<N> {
    fn of(frame: &Frame<'_>, item: &Item<'_>) -> Self {
        let (n, dim) = (frame.rank, frame.dim);
        // Axis by axis in the unit of the item: S·s² may overflow where the axes of F differ by many orders.
        let powers: Vec<f64> = (0..dim).map(|j| power_of_two_below(item.width(j, 1.0))).collect();
        let widths: Vec<f64> = (0..dim).map(|j| item.width(j, 1.0 / powers[j])).collect();
        let entry = |j: usize, k: usize| {
            let (j, k) = (j.max(k), j.min(k));
            item.shape::<N>(j, k, [1.0 / powers[j], 1.0 / powers[k]])
        };
        let shape: Vec<N> = (0..dim * dim).map(|at| entry(at / dim, at % dim)).collect();
        let mut lower = Vec::with_capacity(n * (n + 1) / 2);
        let mut products = vec![N::of(0.0); n * dim];
        let factor: Vec<f64> = (0..n).flat_map(|a| in_units(frame, a, &powers)).collect();
        let (mut trace, mut sizes) = (0.0, 0.0);
        for a in 0..n {
            let product = &mut products[a * dim..(a + 1) * dim];
            let span = frame.row(a).1;
            for j in span.clone() {
                let f = N::of(factor[a * dim + j]);
                for (sum, s) in product.iter_mut().zip(&shape[j * dim..(j + 1) * dim]) {
                    *sum = sum.plus(&f.times(s));
                }
            }
            for b in 0..=a {
                let span = frame.row(b).1;
                let row = &factor[b * dim..][span.clone()];
                let terms = row.iter().zip(&products[a * dim..(a + 1) * dim][span]);
                lower.push(terms.fold(N::of(0.0), |sum, (&f, p)| sum.plus(&N::of(f).times(p))));
            }
            trace += lower[lower.len() - 1].rounded();
            let row = &factor[a * dim..(a + 1) * dim];
            let size: f64 = row.iter().zip(&widths).map(|(f, width)| f.abs() * width).sum();
            sizes += size * size;
        }
        // |Sⱼₖ| ≤ √(SⱼⱼSₖₖ), so no sum of sizes in the entry (a, b) exceeds the product of two of these.
        let error = (2 * dim + 20) as f64 * N::ROUNDOFF * sizes + f64::MIN_POSITIVE;
        let trace = if trace.is_nan() { f64::INFINITY } else { trace.max(0.0) };
        let trace = trace * (1.0 + (n + 8) as f64 * U) + n as f64 * error;
        Shape { n, lower, trace, error }
    }

    /// √φ(μ) − 1 for a μ near the one given, rounded up.
    fn excess(&self, g: &[N], mu: &N) -> f64 {
        excess_of_square(N::of(self.beyond_one(g, mu)), self.n)
    }

    /// φ(μ) − 1 for a μ near the one given, but for the rounding of one more sum.
    fn beyond_one(&self, g: &[N], mu: &N) -> f64 {
        let least = self.error + self.rounding(mu.rounded());
        let mut best = self.beyond_one_at(g, mu);
        let mut raised = least.max(f64::MIN_POSITIVE);
        for _ in 0..RAISES_MAX {
            let next = self.beyond_one_at(g, &mu.plus(&N::of(raised)));
            // φ is convex: once it grows it does not fall again.
            if next >= best && best.is_finite() || raised > self.trace {
                return best.min(next);
            }
            best = best.min(next);
            raised *= 2.0;
        }
        best
    }

    /// σ.
    fn rounding(&self, mu: f64) -> f64 {
        (16 * self.n + 64) as f64 * N::ROUNDOFF * (self.n as f64 * mu)
    }

    fn beyond_one_at(&self, g: &[N], mu: &N) -> f64 {
        let n = self.n;
        let lost = self.error + self.rounding(mu.rounded());
        let lowered = mu.minus(&N::of(lost * (1.0 + 4.0 * U)));
        let mut factor: Vec<N> = self.lower.iter().map(|v| N::of(0.0).minus(v)).collect();
        for j in 0..n {
            let at = j * (j + 3) / 2;
            factor[at] = lowered.minus(&self.lower[at]);
        }
        if !factorize(&mut factor, n) {
            return f64::INFINITY;
        }
        let mut solved = Vec::with_capacity(n);
        let mut square = N::of(0.0);
        for i in 0..n {
            let row = &factor[i * (i + 1) / 2..];
            let value = solved
                .iter()
                .zip(row)
                .fold(g[i], |rest: N, (t, l): (&N, &N)| rest.minus(&t.times(l)));
            solved.push(value);
            square = square.plus(&value.times(&value).over(&row[i]));
        }
        let rounding = 1.0 + 4.0 * (n + 8) as f64 * N::ROUNDOFF;
        let beyond = mu.minus(&N::of(1.0)).plus(&mu.times(&square).times(&N::of(rounding)));
        if beyond.rounded().is_nan() { f64::INFINITY } else { beyond.rounded() }
    }
}

/// Row a of F for coordinates that are divided by these powers of two.
fn in_units(frame: &Frame<'_>, a: usize, powers: &[f64]) -> Vec<f64> {
    let exponent = |power: f64| ((power.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    let scale = exponent(frame.scale);
    let in_unit = |(f, &power): (&f64, &f64)| {
        // Both powers at once may leave the range where each half of their product does not.
        let k = scale + exponent(power);
        f * 2f64.powi(k / 2) * 2f64.powi(k - k / 2)
    };
    frame.full_row(a).iter().zip(powers).map(in_unit).collect()
}

/// μ where φ is least, or a little more; nothing that is proved depends on how good it is.
fn multiplier<N: Field>(lower: &[N], g: &[N]) -> N {
    let n = g.len();
    let zero = N::of(0.0);
    let dot = |a: &[N], b: &[N]| a.iter().zip(b).fold(zero, |sum, (a, b)| sum.plus(&a.times(b)));
    let times = |x: &[N]| -> Vec<N> {
        let at = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
        let row = |i: usize| (0..n).fold(zero, |sum, j| sum.plus(&at(i, j).times(&x[j])));
        (0..n).map(row).collect()
    };
    let diagonal = (0..n).map(|j| lower[j * (j + 3) / 2]);
    let mut below =
        diagonal.fold(zero, |most, v| if v.minus(&most).rounded() > 0.0 { v } else { most });
    // The left side of the condition is at most √λmax·|g|/(μ − λmax). Rounding may have made A indefinite, so that neither
    // its trace nor gᵀAg bound what they would.
    let norm = dot(lower, lower).rounded().sqrt() * std::f64::consts::SQRT_2 * (1.0 + 8.0 * U);
    let mut above = N::of(norm + (norm * dot(g, g).rounded()).sqrt());
    let mut mu = above;
    for _ in 0..STEPS_MAX {
        let mut factor: Vec<N> = lower.iter().map(|v| zero.minus(v)).collect();
        (0..n).for_each(|j| factor[j * (j + 3) / 2] = factor[j * (j + 3) / 2].plus(&mu));
        let mut next = None;
        if factorize(&mut factor, n) {
            let z = solve(&factor, g);
            let az = times(&z);
            let square = dot(&z, &az).rounded();
            if square > 1.0 {
                below = mu
            } else {
                above = mu
            }
            if (square - 1.0).abs() < 1e-9 {
                return mu;
            }
            let slope = dot(&az, &solve(&factor, &z)).rounded();
            next = Some(mu.plus(&N::of((square.sqrt() - 1.0) * square / slope)));
        } else {
            below = mu;
        }
        let width = above.minus(&below);
        let is_wide = width.rounded() > N::ROUNDOFF * above.rounded();
        if !is_wide {
            break;
        }
        let is_between =
            |mu: &N| mu.minus(&below).rounded() > 0.0 && above.minus(mu).rounded() > 0.0;
        let middle = below.plus(&width.scaled(0.5));
        mu = next.filter(is_between).unwrap_or(middle);
    }
    above
}

/// A root is looked for in at most this many steps: halving alone would need as many as doubled precision has bits.
const STEPS_MAX: usize = 128;

/// A bound is raised at most this often: doublings from the last digit of doubled precision up to 1, and some.
const RAISES_MAX: usize = 128;

/// (L·D·Lᵀ)⁻¹x.
fn solve<N: Field>(factor: &[N], x: &[N]) -> Vec<N> {
    let row = |i: usize| &factor[i * (i + 1) / 2..][..=i];
    let mut x = x.to_vec();
    for i in 0..x.len() {
        let known =
            row(i).iter().zip(&x[..i]).fold(N::of(0.0), |sum, (l, x)| sum.plus(&l.times(x)));
        x[i] = x[i].minus(&known);
    }
    for i in (0..x.len()).rev() {
        x[i] = x[i].over(&row(i)[i]);
    }
    for i in (0..x.len()).rev() {
        let value = x[i];
        for (x, l) in x[..i].iter_mut().zip(row(i)) {
            *x = x.minus(&l.times(&value));
        }
    }
    x
}
