//! Tests what the tests of the ball share: a judge of its own, a brute force, and point families.
//!
//! The judge is written apart from the solver and from `taut-certify`, so that an error would have to be made three
//! times to go unseen; [`judge`] also asks the checker and wants the two to agree.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

pub mod families;

use taut_certify::{AnySolution, Ball, Items, Solution};
use taut_enclose::{BallOptions, ball};
use taut_points::Points;

/// A number as the unevaluated sum of two: about 106 bits.
#[derive(Clone, Copy, Debug)]
pub struct Twofold(f64, f64);

impl Twofold {
    pub fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Twofold(s, (a - (s - t)) + (b - t))
    }

    pub fn plus(self, other: Self) -> Self {
        let (s, t) = (Self::sum(self.0, other.0), Self::sum(self.1, other.1));
        let u = Self::sum(s.0, s.1 + t.0);
        Self::sum(u.0, u.1 + t.1)
    }

    pub fn minus(self, other: Self) -> Self {
        self.plus(Twofold(-other.0, -other.1))
    }

    pub fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product);
        Self::sum(product, rest + (self.0 * other.1 + self.1 * other.0))
    }

    pub fn over(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let rest = self.minus(other.times(first.into()));
        let second = rest.0 / other.0;
        let rest = rest.minus(other.times(second.into()));
        Self::sum(first, second).plus((rest.0 / other.0).into())
    }

    pub fn root(self) -> Self {
        if self.0 <= 0.0 {
            return 0.0.into();
        }
        let root = self.0.sqrt();
        let rest = self.minus(Twofold::from(root).times(root.into()));
        Self::sum(root, rest.0 / (2.0 * root))
    }

    pub fn above(self, other: Self) -> bool {
        let difference = self.minus(other);
        difference.0 > 0.0
    }
}

impl From<f64> for Twofold {
    fn from(value: f64) -> Self {
        Twofold(value, 0.0)
    }
}

/// The findings of the judge.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// radius / lower − 1, at least 0.
    pub gap: f64,
    /// The lower bound that the multipliers prove.
    pub lower: f64,
}

/// Judges an answer from the rows alone: finite, well formed, enclosing, and as tight as it says. Errors are sentences.
pub fn judge(values: &[f64], columns: usize, found: &Solution<Ball>) -> Result<Proof, String> {
    let (answer, certificate) = (&found.answer, &found.certificate);
    let dim = certificate.items.dim(columns);
    let numbers = answer
        .center
        .iter()
        .chain(&answer.center_tail)
        .chain(&certificate.multipliers)
        .chain([&answer.radius, &certificate.gap]);
    if let Some(bad) = numbers.clone().find(|v| !v.is_finite()) {
        return Err(format!("{bad} in the answer"));
    }
    if let Some(bad) =
        found.trace.history.iter().find(|b| !(b.lower.is_finite() && b.upper.is_finite()))
    {
        return Err(format!("{bad:?} in the history"));
    }
    if answer.center.len() != dim
        || !(answer.center_tail.is_empty() || answer.center_tail.len() == dim)
    {
        return Err("the center has another dimension".into());
    }
    if answer.radius < 0.0 || certificate.gap < 0.0 {
        return Err("a negative radius or gap".into());
    }
    let support = &certificate.support;
    if support.is_empty() || support.len() != certificate.multipliers.len() {
        return Err("support and multipliers do not match".into());
    }
    if !support.is_sorted_by(|a, b| a < b)
        || support[support.len() - 1] as usize >= values.len() / columns
    {
        return Err(format!("the support {support:?} is not ascending, or beyond the rows"));
    }
    if certificate.multipliers.iter().any(|&l| l <= 0.0) {
        return Err("a multiplier is not positive".into());
    }
    match AnySolution::from_json(&found.to_json()) {
        Ok(AnySolution::Ball(again)) if again == *found => {}
        other => return Err(format!("JSON does not read back: {other:?}")),
    }
    let proof = prove(values, columns, found)?;
    if proof.gap > certificate.gap * (1.0 + 1e-12) + 4.0 * f64::EPSILON {
        return Err(format!("gap {:e} claimed, {:e} proved", certificate.gap, proof.gap));
    }
    let verdict = found
        .check(&Points::new(values, columns).map_err(|e| e.to_string())?)
        .map_err(|e| format!("the checker says: {e}"))?;
    if verdict.gap > certificate.gap * (1.0 + 1e-12) + 4.0 * f64::EPSILON
        || verdict.upper != answer.radius
    {
        return Err(format!("the checker proves {verdict:?}, {:e} claimed", certificate.gap));
    }
    Ok(proof)
}

/// Enclosure of every row, and the lower bound of the multipliers, in twofold precision.
fn prove(values: &[f64], columns: usize, found: &Solution<Ball>) -> Result<Proof, String> {
    let (answer, certificate) = (&found.answer, &found.certificate);
    let dim = certificate.items.dim(columns);
    let largest = values.iter().chain(&answer.center).fold(answer.radius, |m, v| m.max(v.abs()));
    // An exact power of two keeps squares in range.
    let scale = if largest > 2f64.powi(300) {
        2f64.powi(-700)
    } else if answer.radius < 2f64.powi(-300) && largest < 2f64.powi(100) {
        2f64.powi(700)
    } else {
        1.0
    };
    let tail = |j: usize| answer.center_tail.get(j).map_or(0.0, |t| t * scale);
    let offset = |row: &[f64], j: usize| {
        Twofold::sum(row[j] * scale, -answer.center[j] * scale).minus(tail(j).into())
    };
    let radius_of = |row: &[f64]| match certificate.items {
        Items::Points | Items::Ellipsoids => 0.0,
        Items::Balls => row[dim] * scale,
    };
    let distance2 = |row: &[f64]| {
        (0..dim).fold(Twofold::from(0.0), |sum, j| {
            let x = offset(row, j);
            sum.plus(x.times(x))
        })
    };
    let radius = answer.radius * scale;
    // What is left of 106 bits after d sums and one square.
    let rounding = Twofold::from(1.0).plus(((dim as f64 + 20.0) * 2f64.powi(-100)).into());
    for (i, row) in values.chunks_exact(columns).enumerate() {
        let room = Twofold::sum(radius, -radius_of(row));
        if room.0 < 0.0 || distance2(row).above(room.times(room).times(rounding)) {
            let excess = distance2(row).root().minus(room).0 / radius;
            return Err(format!("row {i} is outside by {excess:e} of the radius"));
        }
    }
    let rows: Vec<&[f64]> = certificate
        .support
        .iter()
        .map(|&id| &values[id as usize * columns..(id as usize + 1) * columns])
        .collect();
    let total = certificate.multipliers.iter().fold(Twofold::from(0.0), |s, &l| s.plus(l.into()));
    if (total.0 - 1.0).abs() > 1e-12 {
        return Err(format!("the multipliers sum to {}", total.0));
    }
    let weights: Vec<Twofold> =
        certificate.multipliers.iter().map(|&l| Twofold::from(l).over(total)).collect();
    let mean = rows
        .iter()
        .zip(&weights)
        .fold(Twofold::from(0.0), |s, (row, w)| s.plus(w.times(radius_of(row).into())));
    let mut inner = Twofold::from(0.0);
    for (row, w) in rows.iter().zip(&weights) {
        let spread = Twofold::from(radius_of(row)).minus(mean);
        inner = inner.plus(w.times(distance2(row).minus(spread.times(spread))));
    }
    for j in 0..dim {
        let beside = rows
            .iter()
            .zip(&weights)
            .fold(Twofold::from(0.0), |s, (row, w)| s.plus(w.times(offset(row, j))));
        inner = inner.minus(beside.times(beside));
    }
    let mut lower = mean.plus(inner.root());
    for row in &rows {
        if Twofold::from(radius_of(row)).above(lower) {
            lower = radius_of(row).into();
        }
    }
    let gap = if radius == 0.0 {
        0.0
    } else {
        Twofold::from(radius).over(lower).minus(1.0.into()).0.max(0.0)
    };
    Ok(Proof { gap, lower: lower.0 / scale })
}

/// The exact ball of points, judged; panics with the name of the case. The gap asked for is `gap`.
pub fn exact(name: &str, values: &[f64], dim: usize, gap: f64) -> Solution<Ball> {
    exact_with(name, values, dim, gap, &BallOptions { epsilon: 0.0, ..Default::default() })
}

/// The same with options.
pub fn exact_with(
    name: &str,
    values: &[f64],
    dim: usize,
    gap: f64,
    options: &BallOptions<'_>,
) -> Solution<Ball> {
    let found = ball(&Points::new(values, dim).unwrap(), options)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let proof = judge(values, dim, &found).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(
        proof.gap <= gap && found.certificate.gap <= gap,
        "{name}: gap {:e} claimed, {:e} proved, {gap:e} wanted; {:?}",
        found.certificate.gap,
        proof.gap,
        found.trace
    );
    found
}

/// The exact ball of balls, judged.
pub fn exact_of_balls(name: &str, values: &[f64], columns: usize, gap: f64) -> Solution<Ball> {
    let options = BallOptions { epsilon: 0.0, ..Default::default() };
    let found = ball(
        &Points::new(values, columns).unwrap(),
        &BallOptions { inputs: Items::Balls, ..options.clone() },
    )
    .unwrap_or_else(|error| panic!("{name}: {error}"));
    let proof = judge(values, columns, &found).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(
        proof.gap <= gap && found.certificate.gap <= gap,
        "{name}: gap {:e} claimed, {:e} proved, {gap:e} wanted; {:?}",
        found.certificate.gap,
        proof.gap,
        found.trace
    );
    found
}

/// The radius of the smallest enclosing ball, by trying every support of up to d + 1 points. For few points.
pub fn brute_force(values: &[f64], dim: usize) -> f64 {
    let rows: Vec<&[f64]> = values.chunks_exact(dim).collect();
    let n = rows.len();
    let mut least = f64::INFINITY;
    for subset in 1u32..1 << n {
        if subset.count_ones() as usize > dim + 1 {
            continue;
        }
        let support: Vec<&[f64]> =
            (0..n).filter(|i| subset >> i & 1 == 1).map(|i| rows[i]).collect();
        let Some(center) = circumcenter(&support, dim) else { continue };
        let reach = |row: &[f64]| -> f64 {
            row.iter().zip(&center).map(|(x, c)| (x - c) * (x - c)).sum::<f64>().sqrt()
        };
        // Any center gives an enclosing ball, so the least farthest reach over all circumcenters is the answer.
        least = least.min(rows.iter().map(|row| reach(row)).fold(0.0, f64::max));
    }
    least
}

/// The center, in their affine hull, of the sphere through the points; none when they depend on each other.
fn circumcenter(support: &[&[f64]], dim: usize) -> Option<Vec<f64>> {
    let edges: Vec<Vec<f64>> =
        support[1..].iter().map(|p| (0..dim).map(|j| p[j] - support[0][j]).collect()).collect();
    let k = edges.len();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut system: Vec<Vec<f64>> = (0..k)
        .map(|i| {
            let mut row: Vec<f64> = (0..k).map(|j| product(&edges[i], &edges[j])).collect();
            row.push(product(&edges[i], &edges[i]) / 2.0);
            row
        })
        .collect();
    for step in 0..k {
        let pivot =
            (step..k).max_by(|&a, &b| system[a][step].abs().total_cmp(&system[b][step].abs()))?;
        system.swap(step, pivot);
        if system[step][step].abs() <= 1e-13 * product(&edges[step], &edges[step]) {
            return None;
        }
        for i in 0..k {
            if i != step {
                let factor = system[i][step] / system[step][step];
                for j in step..=k {
                    system[i][j] -= factor * system[step][j];
                }
            }
        }
    }
    let mut center = support[0].to_vec();
    for (i, edge) in edges.iter().enumerate() {
        let weight = system[i][k] / system[i][i];
        center.iter_mut().zip(edge).for_each(|(c, e)| *c += weight * e);
    }
    Some(center)
}

/// The least radius of k balls that hold all items but z, where `one` is that of one ball for each set.
pub fn least_of_partitions(one: &[f64], k: usize, z: usize) -> f64 {
    let all = one.len();
    let mut best = one.to_vec();
    for _ in 1..k {
        let before = best.clone();
        for set in 1..all {
            let mut part = set;
            while part > 0 {
                best[set] = best[set].min(one[part].max(before[set & !part]));
                part = (part - 1) & set;
            }
        }
    }
    let n = all.trailing_zeros();
    let kept = (0..all).filter(|set| set.count_ones() + z as u32 >= n);
    kept.map(|set| best[set]).fold(f64::INFINITY, f64::min)
}
