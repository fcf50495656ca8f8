//! The smallest ball around few points, balls or weighted points, in a bracket far narrower than an `f64` can tell.
//!
//! *Problem.* Items of position p, radius r and weight w (r = 0 or w = 1): minimize ρ = max wᵢ|pᵢ − c| + rᵢ over c.
//! *Idea.* A core-set grows by the farthest item; its optimum is that of one of its subsets S. On S all items touch:
//! |pᵢ − c|² = qᵢ(t) with t = ρ and q = (t − r)² for balls, t = ρ² and q = t/w² otherwise. Differences of these equations
//! are linear in c and t, so c = A + t·B in the affine hull of S, and one quadratic equation gives t.
//! *Guarantee.* None of the above is trusted: the upper end is max wᵢ|pᵢ − c| + rᵢ, rounded up, and the lower end follows
//! from multipliers λ by Σλᵢ|pᵢ − x|² = Σλᵢ|pᵢ − p̄|² + |x − p̄|² (with Σλ = 1), rounded down. Both are exact but for
//! roots and quotients of `bits` digits.

use super::dyadic::{Dyadic, distance_square, sum};

/// A point, a ball (weight 1) or a weighted point (radius 0).
#[derive(Clone, Debug)]
pub struct Body {
    /// Position.
    pub position: Vec<Dyadic>,
    /// Radius, at least 0.
    pub radius: Dyadic,
    /// Weight, above 0.
    pub weight: Dyadic,
}

impl Body {
    /// Returns a bracket of w|p − c| + r.
    pub fn reach(&self, center: &[Dyadic], bits: u64) -> [Dyadic; 2] {
        let square = &distance_square(&self.position, center) * &self.weight.square();
        [square.root(bits), square.root_up(bits)].map(|root| &root + &self.radius)
    }

    /// Returns true if w|p − c| + r ≤ `bound`, decided exactly.
    pub fn is_within(&self, center: &[Dyadic], bound: &Dyadic) -> bool {
        let room = bound - &self.radius;
        room >= Dyadic::zero()
            && &distance_square(&self.position, center) * &self.weight.square() <= room.square()
    }
}

/// A ball that touches all items of a set.
#[derive(Clone, Debug)]
pub struct Touching {
    /// Center, to about `bits` digits.
    pub center: Vec<Dyadic>,
    /// ρ, to about `bits` digits.
    pub reach: Dyadic,
    /// Convex multipliers with Σλᵢpᵢ = c, to about `bits` digits.
    pub lambda: Vec<Dyadic>,
}

/// Bounds of the optimum.
#[derive(Clone, Debug)]
pub struct Bracket {
    /// No smaller ball exists.
    pub lower: Dyadic,
    /// A ball of this size exists.
    pub upper: Dyadic,
}

impl Bracket {
    /// Returns true if the bounds agree to 2⁻¹⁰⁰ of themselves. Doubles that are no nearer to the optimum than that are told apart
    /// from it; a double that is nearer equals it, as an algebraic number of few digits is not that near to another one.
    pub fn is_narrow(&self) -> bool {
        &self.upper - &self.lower <= self.upper.scaled(-100)
    }
}

/// Returns how many digits to compute with: those of a narrow bracket, and the range of the data some times over.
pub fn digits(bodies: &[Body]) -> u64 {
    let mut range: Option<(i64, i64)> = None;
    for body in bodies {
        for value in body.position.iter().chain([&body.radius, &body.weight]) {
            if !value.is_zero() {
                let k = value.magnitude();
                range = Some(range.map_or((k, k), |(low, high)| (low.min(k), high.max(k))));
            }
        }
    }
    let (low, high) = range.unwrap_or((0, 0));
    400 + 4 * (high - low) as u64
}

/// Returns the balls that touch all of `set` and have their center in its convex hull.
pub fn touching(set: &[&Body], bits: u64) -> Vec<Touching> {
    let first = set[0];
    let are_balls = set.iter().any(|body| !body.radius.is_zero());
    let one = Dyadic::integer(1);
    if set.len() == 1 {
        let center = first.position.clone();
        return vec![Touching { center, reach: first.radius.clone(), lambda: vec![one] }];
    }
    let arms: Vec<Vec<Dyadic>> = set[1..]
        .iter()
        .map(|body| body.position.iter().zip(&first.position).map(|(a, b)| a - b).collect())
        .collect();
    let dot = |a: &[Dyadic], b: &[Dyadic]| sum(a.iter().zip(b).map(|(a, b)| a * b));
    let inverse_square = |body: &Body| one.quotient(&body.weight.square(), bits);
    // G·a = b₀ + t·b₁.
    let mut rows: Vec<Vec<Dyadic>> = Vec::new();
    for (i, arm) in arms.iter().enumerate() {
        let mut row: Vec<Dyadic> = arms.iter().map(|other| dot(arm, other)).collect();
        let (constant, linear) = if are_balls {
            let (r, s) = (&set[i + 1].radius, &first.radius);
            (&r.square() - &s.square(), (s - r).scaled(1))
        } else {
            (Dyadic::zero(), &inverse_square(set[i + 1]) - &inverse_square(first))
        };
        row.push((&row[i] - &constant).scaled(-1));
        row.push(-&linear.scaled(-1));
        rows.push(row);
    }
    let gram = rows.clone();
    let Some([constant, linear]) = solve(rows, bits) else { return vec![] };
    let form = |a: &[Dyadic], b: &[Dyadic]| {
        sum((0..a.len()).map(|i| &a[i] * &sum((0..b.len()).map(|j| &gram[i][j] * &b[j]))))
    };
    let (c, b, a) = (form(&constant, &constant), form(&constant, &linear), form(&linear, &linear));
    let roots = if are_balls {
        let s = &first.radius;
        quadratic(&(&a - &one), &(&b + s), &(&c - &s.square()), bits)
    } else {
        quadratic(&a, &(&b - &inverse_square(first).scaled(-1)), &c, bits)
    };
    let mut found = vec![];
    for t in roots {
        let parts: Vec<Dyadic> = constant
            .iter()
            .zip(&linear)
            .map(|(constant, linear)| (constant + &(linear * &t)).floored(bits))
            .collect();
        let rest = &one - &sum(parts.iter().cloned());
        let lambda: Vec<Dyadic> = [rest].into_iter().chain(parts).collect();
        let least = -&Dyadic::power(-(bits as i64) / 3);
        if lambda.iter().any(|l| *l < least) {
            continue;
        }
        let reach = if are_balls { t } else { t.root(bits) };
        if set.iter().any(|body| body.radius > reach) {
            continue;
        }
        let center = (0..first.position.len())
            .map(|j| {
                let moved = sum(arms.iter().zip(&lambda[1..]).map(|(arm, l)| &arm[j] * l));
                (&first.position[j] + &moved).floored(bits)
            })
            .collect();
        let lambda = lambda.into_iter().map(|l| l.max(Dyadic::zero())).collect();
        found.push(Touching { center, reach, lambda });
    }
    found
}

/// Returns the solutions for the last two columns of a positive definite system, none if it is singular.
fn solve(mut rows: Vec<Vec<Dyadic>>, bits: u64) -> Option<[Vec<Dyadic>; 2]> {
    let n = rows.len();
    let largest = (0..n).map(|i| rows[i][i].magnitude()).max()?;
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].is_zero() || rows[k][k].magnitude() < largest - (bits as i64 * 3) / 4 {
            return None;
        }
        for i in 0..n {
            if i != k && !rows[i][k].is_zero() {
                let factor = rows[i][k].quotient(&rows[k][k], 2 * bits);
                for j in k..n + 2 {
                    rows[i][j] = (&rows[i][j] - &(&factor * &rows[k][j])).floored(2 * bits);
                }
            }
        }
    }
    let column = |j: usize| (0..n).map(|i| rows[i][j].quotient(&rows[i][i], 2 * bits)).collect();
    Some([column(n), column(n + 1)])
}

/// Returns the roots of a·t² + 2b·t + c above 0.
fn quadratic(a: &Dyadic, b: &Dyadic, c: &Dyadic, bits: u64) -> Vec<Dyadic> {
    let largest = [a.magnitude(), b.magnitude()].into_iter().max().unwrap_or(0);
    let root = (&b.square() - &(a * c)).root(2 * bits);
    let parts = [&(-b) + &root, &(-b) - &root];
    let mut roots: Vec<Dyadic> = vec![];
    // t = c/q and t = q/a with q = −b ± √(b² − ac), the larger in size: no digits cancel.
    let q = if parts[0].abs() >= parts[1].abs() { &parts[0] } else { &parts[1] };
    if !q.is_zero() {
        roots.push(c.quotient(q, 2 * bits));
    }
    if !a.is_zero() && a.magnitude() > largest - bits as i64 {
        roots.push(q.quotient(a, 2 * bits));
    }
    roots.retain(|t| *t > Dyadic::zero());
    roots
}

/// Returns the smallest ball of at most d + 2 items by trying all subsets.
fn smallest(set: &[&Body], bits: u64) -> Option<(Vec<usize>, Touching)> {
    let mut best: Option<(Vec<usize>, Touching)> = None;
    for mask in 1u32..1 << set.len() {
        let chosen: Vec<usize> = (0..set.len()).filter(|i| mask >> i & 1 == 1).collect();
        let subset: Vec<&Body> = chosen.iter().map(|&i| set[i]).collect();
        for ball in touching(&subset, bits) {
            let granted = &ball.reach + &ball.reach.scaled(-(bits as i64) / 3);
            let is_better = best.as_ref().is_none_or(|(_, known)| ball.reach < known.reach);
            if is_better && set.iter().all(|body| body.is_within(&ball.center, &granted)) {
                best = Some((chosen.clone(), ball));
            }
        }
    }
    best
}

/// Returns a bracket of the smallest ball around all bodies.
pub fn bracket(bodies: &[Body]) -> Bracket {
    let bits = digits(bodies);
    let all: Vec<&Body> = bodies.iter().collect();
    let mut core: Vec<usize> = vec![0];
    loop {
        let set: Vec<&Body> = core.iter().map(|&i| all[i]).collect();
        let (basis, ball) = smallest(&set, bits).expect("some subset determines the smallest ball");
        let granted = &ball.reach + &ball.reach.scaled(-(bits as i64) / 3);
        core = basis.iter().map(|&i| core[i]).collect();
        let outside = (0..all.len())
            .filter(|&i| !all[i].is_within(&ball.center, &granted))
            .max_by_key(|&i| all[i].reach(&ball.center, bits)[0].clone());
        match outside {
            Some(i) => core.push(i),
            None => {
                let support: Vec<&Body> = core.iter().map(|&i| all[i]).collect();
                return proved(&all, &support, &ball, bits);
            }
        }
    }
}

/// Returns the bounds that a center and multipliers prove.
pub fn proved(all: &[&Body], support: &[&Body], ball: &Touching, bits: u64) -> Bracket {
    let upper = all
        .iter()
        .map(|body| body.reach(&ball.center, bits)[1].clone())
        .max()
        .unwrap_or_else(Dyadic::zero);
    let largest = all.iter().map(|body| body.radius.clone()).max().unwrap_or_else(Dyadic::zero);
    let lower = dual(support, &ball.lambda, bits).max(largest);
    Bracket { lower, upper }
}

/// Returns the lower bound that multipliers prove, rounded down.
pub fn dual(support: &[&Body], lambda: &[Dyadic], bits: u64) -> Dyadic {
    // λ = ν·w² exactly, so that the sum of λ/w² is that of ν.
    let nu: Vec<Dyadic> = support
        .iter()
        .zip(lambda)
        .map(|(body, l)| l.quotient(&body.weight.square(), bits).floored(bits))
        .collect();
    let lambda: Vec<Dyadic> =
        support.iter().zip(&nu).map(|(body, n)| n * &body.weight.square()).collect();
    let weight = sum(lambda.iter().cloned());
    let below = |x: Dyadic| &x - &x.abs().scaled(4 - bits as i64);
    let dim = support[0].position.len();
    // W·Σλ|p|² − |Σλp|² = W²·(the mean of |p − p̄|²), and the same of the radii.
    let spread = |value: &dyn Fn(&Body) -> Dyadic| {
        let mean = sum(support.iter().zip(&lambda).map(|(body, l)| l * &value(body)));
        let squares = sum(support.iter().zip(&lambda).map(|(body, l)| l * &value(body).square()));
        &(&weight * &squares) - &mean.square()
    };
    let positions = sum((0..dim).map(|j| spread(&|body: &Body| body.position[j].clone())));
    if support.iter().all(|body| body.radius.is_zero()) {
        let divisor = &weight * &sum(nu.iter().cloned());
        return below(below(positions.quotient(&divisor, bits)).root(bits));
    }
    let radii = spread(&|body: &Body| body.radius.clone());
    let mean = sum(support.iter().zip(&lambda).map(|(body, l)| l * &body.radius));
    let variance = &positions - &radii;
    let root = below(below(variance.quotient(&weight.square(), bits)).root(bits));
    below(&below(mean.quotient(&weight, bits)) + &root)
}

#[test]
fn brackets_are_narrow_and_hold_closed_forms() {
    let body = |position: &[f64], radius: f64, weight: f64| Body {
        position: super::dyadic::exact(position),
        radius: Dyadic::of(radius),
        weight: Dyadic::of(weight),
    };
    let cases: [(Vec<Body>, f64); 6] = [
        (vec![body(&[0.0, 0.0], 0.0, 1.0)], 0.0),
        (vec![body(&[0.0, 0.0], 0.0, 1.0), body(&[6.0, 8.0], 0.0, 1.0)], 5.0),
        (vec![body(&[0.0], 0.0, 1.0), body(&[3.0], 0.0, 2.0)], 2.0),
        (vec![body(&[0.0], 1.0, 1.0), body(&[5.0], 2.0, 1.0)], 4.0),
        (vec![body(&[0.0, 0.0], 9.0, 1.0), body(&[1.0, 0.0], 2.0, 1.0)], 9.0),
        (
            vec![
                body(&[5.0, 0.0], 1.0, 1.0),
                body(&[-3.0, 4.0], 1.0, 1.0),
                body(&[-3.0, -4.0], 1.0, 1.0),
                body(&[0.0, 5.0], 1.0, 1.0),
            ],
            6.0,
        ),
    ];
    for (bodies, radius) in cases {
        let found = bracket(&bodies);
        let radius = Dyadic::of(radius);
        assert!(found.lower <= radius && radius <= found.upper, "{}", radius.text());
        assert!(found.is_narrow(), "{}", radius.text());
    }
}
