//! Balls in the feature space of a kernel, in exact numbers.
//!
//! *Decided.* Squared distances of all rows from the center, the objective of the answer, and the lower bound D/s of its multipliers,
//! exactly but for the exponential function, which is found to 2⁻²⁰⁰ of 1 − e^{−z}. What differs by less than 2⁻¹⁵⁰ is taken as equal: no
//! margin of the checker is so narrow. That D/s is a lower bound, is a theorem.
//! *Exact.* No division is needed: with s = Σλ, each inequality is multiplied by 2s², and where necessary also by s or νn.

use std::collections::BTreeMap;

use taut::Solution;
use taut::certify::{Kernel, KernelBall, KernelBallVerdict};

use super::Truth;
use super::dyadic::{Dyadic, distance_square, sum};

/// Bits to which the exponential function is worked out.
const BITS: u64 = 320;

/// Knows the truth about the balls of kernels of one input.
pub struct KernelBallOracle {
    rows: Vec<Vec<Dyadic>>,
    /// ρ between all rows, by kernel.
    distances: BTreeMap<String, Vec<Vec<Dyadic>>>,
}

fn exact(x: f64) -> Dyadic {
    if x.is_finite() { Dyadic::of(x) } else { Dyadic::zero() }
}

/// 1 − e^{−z}.
fn decay(z: &Dyadic) -> Dyadic {
    /// The series is that of z/2²⁴.
    const HALVINGS: i64 = 24;
    if z > &Dyadic::integer(2000) {
        return Dyadic::integer(1);
    }
    // (1 − e^{−y})/y by the series for y = z/2²⁴; the square of e^{−y} doubles y.
    let y = z.floored(BITS).scaled(-HALVINGS);
    let (mut term, mut series) = (Dyadic::integer(1), Dyadic::zero());
    for k in 1..40 {
        series = &series + &term;
        term = (&-&term * &y).quotient(&Dyadic::integer(k + 1), BITS).floored(BITS);
    }
    let mut less = (&series * &y).floored(BITS);
    for _ in 0..HALVINGS {
        less = (&less * &(&Dyadic::integer(2) - &less)).floored(BITS);
    }
    less
}

impl KernelBallOracle {
    /// Holds rows of any length.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let rows = values.chunks_exact(columns).map(|row| row.iter().copied().map(exact).collect());
        KernelBallOracle { rows: rows.collect(), distances: BTreeMap::new() }
    }

    fn product(&self, kernel: Kernel, i: usize, j: usize) -> Dyadic {
        let dot = || sum(self.rows[i].iter().zip(&self.rows[j]).map(|(a, b)| a * b));
        match kernel {
            Kernel::Polynomial { gamma, offset, degree } => {
                let base = &(&exact(gamma) * &dot()) + &exact(offset);
                (1..degree).fold(base.clone(), |power, _| &power * &base)
            }
            Kernel::Precomputed => self.rows[i][j].clone(),
            _ => dot(),
        }
    }

    fn distance(&self, kernel: Kernel, i: usize, j: usize) -> Dyadic {
        if let Kernel::Gaussian { gamma } = kernel {
            let square = distance_square(&self.rows[i], &self.rows[j]);
            return decay(&(&exact(gamma) * &square)).scaled(1);
        }
        let [own, other] = [i, j].map(|k| self.product(kernel, k, k));
        &(&own + &other) - &self.product(kernel, i, j).scaled(1)
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&mut self, found: &Solution<KernelBall>, verdict: &KernelBallVerdict) -> Truth {
        let ball = &found.answer;
        let n = self.rows.len();
        let wrong = |what: &str| Truth::False(what.to_owned());
        let support: Vec<usize> = ball.support.iter().map(|&id| id as usize).collect();
        if support.is_empty() || support.len() != ball.multipliers.len() {
            return wrong("the lists have no length, or different ones");
        }
        if support.iter().any(|&id| id >= n) || support.windows(2).any(|pair| pair[0] >= pair[1]) {
            return wrong("the support is no ascending list of rows");
        }
        // Finite and positive, so that s > 0: every claim below is multiplied by powers of it.
        if !ball.multipliers.iter().all(|l| l.is_finite() && *l > 0.0) {
            return wrong("a multiplier is not a positive number");
        }
        let key = format!("{:?}", ball.kernel);
        if !self.distances.contains_key(&key) {
            let row = |i: usize| (0..n).map(|j| self.distance(ball.kernel, i, j)).collect();
            let all = (0..n).map(row).collect();
            self.distances.insert(key.clone(), all);
        }
        let distances = &self.distances[&key];
        let lambda: Vec<Dyadic> = ball.multipliers.iter().copied().map(exact).collect();
        let total = sum(lambda.iter().cloned());
        let scale = total.square().scaled(1);
        let weighted_sum = |values: &dyn Fn(usize) -> Dyadic| -> Dyadic {
            sum(support.iter().zip(&lambda).map(|(&i, l)| l * &values(i)))
        };
        // Times s.
        let means: Vec<Dyadic> =
            (0..n).map(|k| weighted_sum(&|i| distances[k][i].clone())).collect();
        // From here on times 2s².
        let spread = weighted_sum(&|i| means[i].clone());
        let squares = means.iter().map(|mean| &(mean * &total).scaled(1) - &spread);
        let squares: Vec<Dyadic> = squares.collect();
        let radius = &exact(ball.squared_radius) * &scale;
        let one = Dyadic::integer(1);
        let slightly = Dyadic::power(-150);
        let (more, less) = (&one + &slightly, &one - &slightly);
        let beyond: Vec<Dyadic> =
            squares.iter().map(|square| square - &radius).filter(|x| x.sign().is_gt()).collect();
        // With w = νn, or 1 without ν: 2s²w times the objective; w; s times the divisor of the lower bound, which is max(1, w·λmax/s),
        // or 1 without ν.
        let (objective, weight, excess) = match ball.nu {
            None if beyond.iter().any(|x| x > &(&slightly * &radius)) => {
                return wrong("a point is outside");
            }
            None => (radius.clone(), one.clone(), total.clone()),
            Some(nu) if !(nu > 0.0 && nu <= 1.0) => return wrong("ν is out of its range"),
            Some(nu) => {
                let most = &exact(nu) * &Dyadic::integer(n as i64);
                let largest = lambda.iter().max().cloned().unwrap_or_else(Dyadic::zero);
                let excess = (&largest * &most).max(total.clone());
                (&(&radius * &most) + &sum(beyond), most, excess)
            }
        };
        let [lower, upper] = [verdict.lower, verdict.upper].map(exact);
        let gap = exact(verdict.gap);
        let inner = &radius * &less;
        let count = squares.iter().filter(|&square| square > &inner).count();
        let scaled_bound = &(&spread.max(Dyadic::zero()) * &total) * &more;
        let claims = [
            (&(&lower * &scale) * &excess <= scaled_bound, "the lower bound is none"),
            (&objective * &less <= &(&upper * &scale) * &weight, "the objective is larger"),
            (&upper * &less <= &(&gap + &one) * &lower, "the gap is larger"),
            (verdict.outside as usize <= count, "fewer points are outside"),
            (
                verdict.gap <= found.certificate.gap * 1.000_000_1 + 1e-15,
                "the gap claimed is smaller",
            ),
        ];
        let lie = claims.iter().find(|(holds, _)| !holds);
        Truth::claim(lie.is_none(), || lie.map_or(String::new(), |(_, lie)| (*lie).into()))
    }
}

#[test]
fn answers_of_the_solver_are_true_and_doctored_ones_are_false() {
    use taut::Points;
    use taut::enclose::{KernelBallOptions, kernel_ball};
    type Change<'a> = &'a dyn Fn(&mut Solution<KernelBall>, &mut KernelBallVerdict);

    let values = [0.0, 0.0, 3.0, 0.5, 1.0, 2.0, -1.0, 1.5, 0.5, -1.0, 9.0, 9.0];
    let points = Points::new(&values, 2).unwrap();
    let kernels = [
        Kernel::Linear,
        Kernel::Gaussian { gamma: 0.1 },
        Kernel::Polynomial { gamma: 0.5, offset: 1.0, degree: 3 },
    ];
    for (kernel, nu) in kernels.into_iter().flat_map(|kernel| [(kernel, None), (kernel, Some(0.4))])
    {
        let options = KernelBallOptions { kernel, nu, ..Default::default() };
        let found = kernel_ball(&points, &options).unwrap();
        let verdict = found.check(&points).unwrap();
        let mut oracle = KernelBallOracle::new(&values, 2);
        assert!(matches!(oracle.judge(&found, &verdict), Truth::True), "{kernel:?} {nu:?}");
        let mut is_false = |what: &str, change: Change<'_>| {
            let (mut found, mut verdict) = (found.clone(), verdict);
            change(&mut found, &mut verdict);
            let truth = oracle.judge(&found, &verdict);
            assert!(matches!(truth, Truth::False(_)), "{kernel:?} {nu:?}: {what}");
        };
        is_false("a smaller ball", &|found, _| found.answer.squared_radius *= 0.99);
        is_false("a larger lower bound", &|_, verdict| verdict.lower *= 1.0001);
        is_false("a smaller upper bound", &|_, verdict| verdict.upper *= 0.9999);
        is_false("more points outside", &|_, verdict| verdict.outside += 6);
        is_false("an infinite multiplier", &|found, _| found.answer.multipliers[0] = f64::INFINITY);
        is_false("other multipliers", &|found, _| found.answer.multipliers[0] *= 3.0);
        is_false("no support", &|found, _| {
            found.answer.support.clear();
            found.answer.multipliers.clear();
        });
    }
}
