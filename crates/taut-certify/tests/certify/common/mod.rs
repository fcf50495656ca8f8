//! Certificates made from multipliers with exact fractions, so that tests know what is true.
#![allow(dead_code, reason = "each test file uses its part")]

pub(crate) mod centers;
pub(crate) mod ellipsoids;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use taut_certify::{Ball, BallCertificate, CheckError, Items, Solution, Trace, Verdict, Violation};
use taut_points::{Monitor, Points, hash_points};

/// A point set and a solution for it.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<f64>,
    pub(crate) columns: usize,
    pub(crate) solution: Solution<Ball>,
}

impl Case {
    pub(crate) fn check(&self) -> Result<Verdict, CheckError> {
        self.solution.check(&Points::new(&self.values, self.columns).unwrap())
    }

    /// The violation found; panics when the case is accepted.
    pub(crate) fn violation(&self) -> Violation {
        match self.check() {
            Err(CheckError::Rejected(violation)) => violation,
            other => panic!("{}: {other:?}", self.name),
        }
    }
}

pub(crate) fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

/// Scales the values by their common denominator, a power of two, to integers. Reducing fractions would take most of the time.
pub(crate) fn whole(values: &[f64]) -> Vec<BigInt> {
    let exact: Vec<BigRational> = values.iter().copied().map(exact).collect();
    let denominator = exact.iter().map(BigRational::denom).max().cloned();
    let denominator = denominator.unwrap_or_else(|| 1.into());
    exact.iter().map(|x| x.numer() * (&denominator / x.denom())).collect()
}

/// √value to about 1e-32, relatively, for values of ordinary size.
fn root(value: &BigRational) -> BigRational {
    if !value.is_positive() {
        return BigRational::zero();
    }
    let mut root = exact(value.to_f64().unwrap().sqrt());
    for _ in 0..2 {
        root = (&root + value / &root) / exact(2.0);
    }
    root
}

/// The true facts about a ball and multipliers, by exact fractions.
pub(crate) struct Truth {
    /// |p − c|² and r, by row.
    pub(crate) rows: Vec<(BigRational, BigRational)>,
    /// R/L − 1 for the lower bound of the multipliers, infinite where L ≤ 0.
    pub(crate) gap: f64,
}

pub(crate) fn truth(
    values: &[f64],
    columns: usize,
    ball: &Ball,
    certificate: &BallCertificate,
) -> Truth {
    let dim = certificate.items.dim(columns);
    let center: Vec<BigRational> = (0..dim)
        .map(|j| exact(ball.center[j]) + exact(ball.center_tail.get(j).copied().unwrap_or(0.0)))
        .collect();
    let parts: Vec<(Vec<BigRational>, BigRational)> = values
        .chunks(columns)
        .map(|row| {
            let r = row.get(dim).map_or(BigRational::zero(), |&r| exact(r));
            (row[..dim].iter().map(|&x| exact(x)).collect(), r)
        })
        .collect();
    let square = |a: &[BigRational], b: &[BigRational]| -> BigRational {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let support: Vec<usize> = certificate.support.iter().map(|&i| i as usize).collect();
    let lambda: Vec<BigRational> = certificate.multipliers.iter().map(|&l| exact(l)).collect();
    let weight: BigRational = lambda.iter().sum();
    let mean = |of: &dyn Fn(usize) -> BigRational| -> BigRational {
        support.iter().zip(&lambda).map(|(&i, l)| of(i) * l).sum::<BigRational>() / &weight
    };
    let p_mean: Vec<BigRational> = (0..dim).map(|j| mean(&|i| parts[i].0[j].clone())).collect();
    let r_mean = mean(&|i| parts[i].1.clone());
    let v = mean(&|i| square(&parts[i].0, &p_mean))
        - mean(&|i| (&parts[i].1 - &r_mean) * (&parts[i].1 - &r_mean));
    let radius = exact(ball.radius);
    let most = support.iter().map(|&i| parts[i].1.clone()).max().unwrap();
    // R − L = (g² − V)/(g + √V), without cancellation.
    let g = &radius - &r_mean;
    let by_multipliers = match v.is_negative() {
        true => g.clone(),
        false if (&g + root(&v)).is_zero() => BigRational::zero(),
        false => (&g * &g - &v) / (&g + root(&v)),
    };
    let x = by_multipliers.min(&radius - most);
    let least = &radius - &x;
    let gap = match () {
        () if x.is_zero() => 0.0,
        () if !least.is_positive() => f64::INFINITY,
        () => (x / least).to_f64().unwrap(),
    };
    let rows = parts.iter().map(|(p, r)| (square(p, &center), r.clone())).collect();
    Truth { rows, gap }
}

/// Returns true if the row with these numbers of [`Truth::rows`] lies in a ball of this radius.
pub(crate) fn is_inside((square, r): &(BigRational, BigRational), radius: f64) -> bool {
    let rho = exact(radius) - r;
    !rho.is_negative() && *square <= &rho * &rho
}

/// The certificate of these multipliers: center from them, with a tail or not, least enclosing `f64` as radius, and
/// the gap that is true.
pub(crate) fn certify(
    name: &'static str,
    values: &[f64],
    columns: usize,
    items: Items,
    support: &[u64],
    multipliers: &[f64],
    with_tail: bool,
) -> Case {
    let dim = items.dim(columns);
    let points = Points::new(values, columns).unwrap();
    let weight: BigRational = multipliers.iter().map(|&l| exact(l)).sum();
    let mean: Vec<BigRational> = (0..dim)
        .map(|j| {
            let at = |&i: &u64| exact(values[i as usize * columns + j]);
            let sum: BigRational =
                support.iter().zip(multipliers).map(|(i, &l)| at(i) * exact(l)).sum();
            sum / &weight
        })
        .collect();
    let less = |m: &BigRational, high: f64| (m - exact(high)).to_f64().unwrap();
    // What is left may be rounded up to half a unit of the last place, and the other neighbor is the sum then.
    let nearest = |m: &BigRational| {
        let high = m.to_f64().unwrap();
        high + less(m, high)
    };
    let center: Vec<f64> = mean.iter().map(nearest).collect();
    let rest = |j: usize| less(&mean[j], center[j]);
    let center_tail = if with_tail { (0..dim).map(rest).collect() } else { vec![] };
    let mut certificate = BallCertificate {
        items,
        support: support.to_vec(),
        multipliers: multipliers.to_vec(),
        directions: vec![],
        gap: 0.0,
        points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
    };
    let mut ball = Ball { center, center_tail, radius: 0.0 };
    let rows = truth(values, columns, &Ball { radius: 1.0, ..ball.clone() }, &certificate).rows;
    let estimate = |(square, r): &(BigRational, BigRational)| {
        square.to_f64().unwrap().sqrt() + r.to_f64().unwrap()
    };
    ball.radius = rows.iter().map(estimate).fold(0.0, f64::max);
    let encloses = |radius: f64| rows.iter().all(|row| is_inside(row, radius));
    while !encloses(ball.radius) {
        ball.radius = ball.radius.next_up();
    }
    while ball.radius > 0.0 && encloses(ball.radius.next_down()) {
        ball.radius = ball.radius.next_down();
    }
    certificate.gap = truth(values, columns, &ball, &certificate).gap;
    let solution = Solution { answer: ball, certificate, trace: Trace::default() };
    Case { name, values: values.to_vec(), columns, solution }
}

/// Multipliers of the smallest ball around few points, by trying every possible support; `None` when rounding hides it.
pub(crate) fn brute_force(values: &[f64], dim: usize) -> Option<(Vec<u64>, Vec<f64>)> {
    let rows: Vec<&[f64]> = values.chunks(dim).collect();
    let mut best: Option<(f64, Vec<u64>, Vec<f64>)> = None;
    for mask in 1u32..1 << rows.len() {
        let support: Vec<usize> = (0..rows.len()).filter(|i| mask >> i & 1 == 1).collect();
        if support.len() > dim + 1 {
            continue;
        }
        let Some(lambda) = circumcenter(&support.iter().map(|&i| rows[i]).collect::<Vec<_>>())
        else {
            continue;
        };
        let center: Vec<f64> = (0..dim)
            .map(|j| support.iter().zip(&lambda).map(|(&i, l)| rows[i][j] * l).sum())
            .collect();
        let square =
            |row: &[f64]| row.iter().zip(&center).map(|(x, c)| (x - c).powi(2)).sum::<f64>();
        let radius = square(rows[support[0]]);
        let encloses = rows.iter().all(|row| square(row) <= radius * (1.0 + 1e-10));
        if encloses && best.as_ref().is_none_or(|(least, ..)| radius < *least) {
            best = Some((radius, support.iter().map(|&i| i as u64).collect(), lambda));
        }
    }
    best.map(|(_, support, lambda)| (support, lambda))
}

/// Barycentric coordinates, all positive, of the center of the smallest sphere through affinely independent points.
pub(crate) fn circumcenter(points: &[&[f64]]) -> Option<Vec<f64>> {
    let k = points.len() - 1;
    let edge = |i: usize| -> Vec<f64> {
        points[i + 1].iter().zip(points[0]).map(|(a, b)| a - b).collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut system: Vec<Vec<f64>> = (0..k)
        .map(|i| {
            let mut row: Vec<f64> = (0..k).map(|j| 2.0 * dot(&edge(i), &edge(j))).collect();
            row.push(dot(&edge(i), &edge(i)));
            row
        })
        .collect();
    let largest = system.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
    for column in 0..k {
        let pivot = (column..k)
            .max_by(|&a, &b| system[a][column].abs().total_cmp(&system[b][column].abs()))?;
        system.swap(column, pivot);
        if system[column][column].abs() <= 1e-9 * largest {
            return None;
        }
        for row in 0..k {
            if row != column {
                let factor = system[row][column] / system[column][column];
                for j in column..=k {
                    system[row][j] -= factor * system[column][j];
                }
            }
        }
    }
    let rest: Vec<f64> = (0..k).map(|i| system[i][k] / system[i][i]).collect();
    let mut lambda = vec![1.0 - rest.iter().sum::<f64>()];
    lambda.extend(rest);
    lambda.iter().all(|&l| l > 1e-9).then_some(lambda)
}

/// Multipliers proportional to these weights.
pub(crate) fn normalized(weights: &[f64]) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| w / sum).collect()
}

/// Numbers in [−1, 1) that look random and are the same on every machine.
pub(crate) fn numbers(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}
