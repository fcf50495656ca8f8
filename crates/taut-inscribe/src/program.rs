//! The weights of conditions that bound the area in a cell best, and the step that promises the most.
//!
//! *Problem.* Minimize −Σ λᵢOᵢ + Σₖ |Tₖ − Σᵢ λᵢgᵢₖ| over λ ≥ 0. Its dual is the step: the ξ in [−1, 1]ᴺ of the largest T·ξ among those
//! with Oᵢ + gᵢ·ξ ≤ 0 for all conditions i.
//! *Method.* The simplex method with N rows, one for each unknown; |x| is the sum of two slacks of cost 1. It begins with slacks alone.
//! *Guarantee.* None is needed: any weights give a bound.

/// Pivots after which the weights so far are taken.
const PIVOTS_MAX: usize = 120;

/// Reduced cost, relative to the size of a condition, that counts as rounding.
const COST_SLACK: f64 = 1e-11;

/// Entry of a direction that counts as rounding.
const ENTRY_SLACK: f64 = 1e-11;

/// How much farther than needed weights grow where no bound limits them.
const RAY_EXCESS: f64 = 1.01;

/// A condition O + g·ξ ≤ 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column<const N: usize> {
    /// O and g, over the sum of the sizes of g.
    value: f64,
    gradient: [f64; N],
    /// That sum.
    size: f64,
}

impl<const N: usize> Column<N> {
    pub(crate) fn new(value: f64, gradient: [f64; N]) -> Self {
        let size = gradient.iter().map(|g| g.abs()).sum::<f64>().max(f64::MIN_POSITIVE);
        Column { value: value / size, gradient: gradient.map(|g| g / size), size }
    }

    /// The value in the middle, in sizes of the gradient.
    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    /// Whether some step of [−1, 1]ᴺ breaks the condition.
    pub(crate) fn can_bind(&self) -> bool {
        self.value > -1.0
    }
}

/// A solution of the program.
#[derive(Clone, Debug)]
pub(crate) struct Weights<const N: usize> {
    /// Conditions, by their place in the list, and weights above 0.
    pub(crate) parts: Vec<(usize, f64)>,
    /// The best step, each coordinate in [−1, 1], if all pivots were made.
    pub(crate) step: [f64; N],
    /// The value of the weights; −∞ where it has no bound and none was needed.
    pub(crate) value: f64,
}

/// A basic variable: a condition, or a slack of a row with its sign.
#[derive(Clone, Copy)]
enum Basic {
    Condition(usize),
    Slack(usize, f64),
}

/// Solves the program, at least until the value is not above `enough`.
pub(crate) fn best<const N: usize>(
    columns: &[Column<N>],
    target: &[f64; N],
    enough: f64,
) -> Weights<N> {
    let mut basis = [Basic::Slack(0, 1.0); N];
    let mut inverse = [[0.0; N]; N];
    let mut solution = [0.0; N];
    for k in 0..N {
        let sign = if target[k] < 0.0 { -1.0 } else { 1.0 };
        basis[k] = Basic::Slack(k, sign);
        inverse[k][k] = sign;
        solution[k] = target[k].abs();
    }
    let (mut prices, mut value) = ([0.0; N], 0.0);
    for _ in 0..PIVOTS_MAX {
        (prices, value) = ([0.0; N], 0.0);
        for (row, &basic) in basis.iter().enumerate() {
            let cost = match basic {
                Basic::Condition(i) => -columns[i].value,
                Basic::Slack(..) => 1.0,
            };
            value += cost * solution[row];
            for (price, entry) in prices.iter_mut().zip(inverse[row]) {
                *price += cost * entry;
            }
        }
        if value <= enough {
            break;
        }
        let (mut entering, mut least) = (None, -COST_SLACK);
        for (i, column) in columns.iter().enumerate() {
            let dot: f64 = prices.iter().zip(column.gradient).map(|(y, g)| y * g).sum();
            let reduced = -column.value - dot;
            if reduced < least {
                (entering, least) = (Some(Basic::Condition(i)), reduced);
            }
        }
        for (k, price) in prices.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let reduced = 1.0 - sign * price;
                if reduced < least {
                    (entering, least) = (Some(Basic::Slack(k, sign)), reduced);
                }
            }
        }
        let Some(basic) = entering else { break };
        let direction: [f64; N] = match basic {
            Basic::Condition(i) => {
                let g = columns[i].gradient;
                inverse.map(|row| row.iter().zip(g).map(|(x, y)| x * y).sum())
            }
            Basic::Slack(k, sign) => inverse.map(|row| sign * row[k]),
        };
        let mut leaving: Option<(usize, f64)> = None;
        for row in 0..N {
            if direction[row] > ENTRY_SLACK {
                let ratio = solution[row].max(0.0) / direction[row];
                let is_better = leaving.is_none_or(|(other, least)| {
                    ratio < least || ratio == least && direction[row] > direction[other]
                });
                if is_better {
                    leaving = Some((row, ratio));
                }
            }
        }
        let Some((row, ratio)) = leaving else {
            // The weights can grow without end, and the value falls with them.
            let ray = RAY_EXCESS * (value - enough) / -least;
            if ray.is_finite() {
                for (x, d) in solution.iter_mut().zip(direction) {
                    *x -= ray * d;
                }
                let extra = match basic {
                    Basic::Condition(i) => Some((i, ray)),
                    Basic::Slack(..) => None,
                };
                let parts = parts(columns, &basis, &solution, extra);
                return Weights { parts, step: prices, value: f64::NEG_INFINITY };
            }
            return Weights { parts: vec![], step: prices, value: f64::NEG_INFINITY };
        };
        let pivot = inverse[row].map(|x| x / direction[row]);
        for other in 0..N {
            if other != row {
                solution[other] -= ratio * direction[other];
                for (entry, x) in inverse[other].iter_mut().zip(pivot) {
                    *entry -= direction[other] * x;
                }
            }
        }
        solution[row] = ratio;
        inverse[row] = pivot;
        basis[row] = basic;
    }
    let step = prices.map(|price| price.clamp(-1.0, 1.0));
    Weights { parts: parts(columns, &basis, &solution, None), step, value }
}

/// The conditions of a basis with weights above 0, and one more.
fn parts<const N: usize>(
    columns: &[Column<N>],
    basis: &[Basic; N],
    solution: &[f64; N],
    extra: Option<(usize, f64)>,
) -> Vec<(usize, f64)> {
    let of_basis = basis.iter().zip(solution).filter_map(|(&basic, &x)| match basic {
        Basic::Condition(i) if x > 0.0 => Some((i, x)),
        _ => None,
    });
    of_basis.chain(extra).map(|(i, x)| (i, x / columns[i].size)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: usize = 9;

    fn random() -> impl FnMut() -> f64 {
        let mut state = 7u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5
        }
    }

    fn value_of(parts: &[(usize, f64)], rows: &[(f64, [f64; ROWS])], target: &[f64; ROWS]) -> f64 {
        let mut rest = *target;
        let mut value = 0.0;
        for &(i, weight) in parts {
            value -= weight * rows[i].0;
            for (x, g) in rest.iter_mut().zip(rows[i].1) {
                *x -= weight * g;
            }
        }
        value + rest.iter().map(|x| x.abs()).sum::<f64>()
    }

    #[test]
    fn weights_and_step_have_one_value() {
        let mut next = random();
        for _ in 0..300 {
            let target = [(); ROWS].map(|()| next());
            let rows: Vec<(f64, [f64; ROWS])> =
                (0..12).map(|_| (next() - 0.4, [(); ROWS].map(|()| next()))).collect();
            let columns: Vec<Column<ROWS>> =
                rows.iter().map(|row| Column::new(row.0, row.1)).collect();
            let found = best(&columns, &target, f64::NEG_INFINITY);
            let value = value_of(&found.parts, &rows, &target);
            assert!((found.value - value).abs() < 1e-9, "{found:?}");
            let dot = |g: &[f64; ROWS]| g.iter().zip(found.step).map(|(x, y)| x * y).sum::<f64>();
            assert!((dot(&target) - value).abs() < 1e-9, "{found:?}");
            assert!(rows.iter().all(|row| row.0 + dot(&row.1) < 1e-9), "{found:?}");
        }
    }

    #[test]
    fn conditions_that_no_step_meets_have_weights_of_any_value() {
        let target = [1.0; ROWS];
        let mut gradient = [0.0; ROWS];
        gradient[2] = 1.0;
        // ξ₂ ≤ −2.
        let rows = [(2.0, gradient)];
        let columns = [Column::new(2.0, gradient)];
        let found = best(&columns, &target, -5.0);
        assert!(value_of(&found.parts, &rows, &target) <= -5.0, "{found:?}");
    }
}
