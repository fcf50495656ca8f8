//! The weights of edges that bound the size in a cell best, and the step that promises the most.
//!
//! *Problem.* Let Dᵢ be the distance of edge i in the middle of a cell and gᵢₖ half the change of it across the cell along axis k.
//! Minimize Σ λᵢDᵢ + Σₖ |Σᵢ λᵢgᵢₖ| over λ ≥ 0 with Σ λᵢ = 1. Its dual is the step: the point of the cell, each axis in [−1, 1], where
//! the least Dᵢ + gᵢ·ξ is largest.
//! *Method.* The simplex method with five rows; |x| is the sum of two slacks of cost 1. It begins with the nearest edge.
//! *Guarantee.* None is needed: any weights give a bound.

/// Rows of the program: the sum of the weights and four axes.
const ROWS: usize = 5;

/// Pivots after which the weights so far are taken.
const PIVOTS_MAX: usize = 64;

/// Reduced cost, relative to the distance of the nearest edge, that counts as rounding.
const COST_SLACK: f64 = 1e-10;

/// An edge in the program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    pub(super) distance: f64,
    pub(super) gradient: [f64; 4],
}

/// A solution of the program.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// Edges, by their place in the list, and weights above 0 that sum to 1.
    pub(super) parts: Vec<(usize, f64)>,
    /// The coordinates of the best point, each in [−1, 1].
    pub(super) step: [f64; 4],
    /// The least linear distance there.
    pub(super) value: f64,
}

/// A basic variable: an edge, or the slack of an axis with its sign.
#[derive(Clone, Copy, PartialEq)]
enum Basic {
    Edge(usize),
    Slack(usize, f64),
}

/// Solves the program for at least one column.
pub(super) fn best(columns: &[Column]) -> Weights {
    let nearest = (0..columns.len())
        .min_by(|&i, &j| columns[i].distance.total_cmp(&columns[j].distance))
        .unwrap_or(0);
    let entries = |basic: Basic| -> ([f64; ROWS], f64) {
        match basic {
            Basic::Edge(i) => {
                let g = columns[i].gradient;
                ([1.0, g[0], g[1], g[2], g[3]], columns[i].distance)
            }
            Basic::Slack(k, sign) => {
                let mut column = [0.0; ROWS];
                column[k + 1] = sign;
                (column, 1.0)
            }
        }
    };
    // The basis: the nearest edge and, for each axis, the slack that takes up its gradient.
    let mut basis = [Basic::Edge(nearest); ROWS];
    let mut inverse = [[0.0; ROWS]; ROWS];
    inverse[0][0] = 1.0;
    for k in 0..4 {
        let g = columns[nearest].gradient[k];
        let sign = if g > 0.0 { -1.0 } else { 1.0 };
        basis[k + 1] = Basic::Slack(k, sign);
        inverse[k + 1][k + 1] = sign;
        inverse[k + 1][0] = -sign * g;
    }
    let slack = COST_SLACK * columns[nearest].distance;
    let mut prices = [0.0; ROWS];
    for _ in 0..PIVOTS_MAX {
        prices = [0.0; ROWS];
        for (row, &basic) in basis.iter().enumerate() {
            let cost = entries(basic).1;
            for (price, entry) in prices.iter_mut().zip(inverse[row]) {
                *price += cost * entry;
            }
        }
        let mut entering = (None, -slack);
        for (i, column) in columns.iter().enumerate() {
            let g = column.gradient;
            let reduced = column.distance
                - prices[0]
                - (prices[1] * g[0] + prices[2] * g[1] + prices[3] * g[2] + prices[4] * g[3]);
            if reduced < entering.1 {
                entering = (Some(Basic::Edge(i)), reduced);
            }
        }
        for k in 0..4 {
            for sign in [1.0, -1.0] {
                let reduced = 1.0 - sign * prices[k + 1];
                if reduced < entering.1 {
                    entering = (Some(Basic::Slack(k, sign)), reduced);
                }
            }
        }
        let Some(basic) = entering.0 else { break };
        let column = entries(basic).0;
        let direction = inverse.map(|row| row.iter().zip(column).map(|(x, y)| x * y).sum::<f64>());
        // The right side is (1, 0, 0, 0, 0), so that the solution is the first column of the inverse.
        let mut leaving: Option<(usize, f64)> = None;
        for row in 0..ROWS {
            if direction[row] > 1e-12 {
                let ratio = inverse[row][0].max(0.0) / direction[row];
                let is_better = leaving.is_none_or(|(other, least)| {
                    ratio < least || ratio == least && direction[row] > direction[other]
                });
                if is_better {
                    leaving = Some((row, ratio));
                }
            }
        }
        let Some((row, _)) = leaving else { break };
        let pivot = inverse[row].map(|x| x / direction[row]);
        for (other, entries) in inverse.iter_mut().enumerate() {
            if other != row {
                for (entry, x) in entries.iter_mut().zip(pivot) {
                    *entry -= direction[other] * x;
                }
            }
        }
        inverse[row] = pivot;
        basis[row] = basic;
    }
    let mut parts: Vec<(usize, f64)> = vec![];
    for (row, &basic) in basis.iter().enumerate() {
        if let Basic::Edge(i) = basic
            && inverse[row][0] > 0.0
        {
            parts.push((i, inverse[row][0]));
        }
    }
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    parts.iter_mut().for_each(|part| part.1 /= sum);
    let step = [1, 2, 3, 4].map(|k: usize| (-prices[k]).clamp(-1.0, 1.0));
    Weights { parts, step, value: prices[0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(distance: f64, gradient: [f64; 4]) -> Column {
        Column { distance, gradient }
    }

    #[test]
    fn balanced_gradients_share_the_weight() {
        let columns = [
            column(1.0, [0.5, 0.0, 1.0, 0.0]),
            column(1.25, [-0.5, 0.0, -1.0, 0.0]),
            column(3.0, [0.0, 0.0, 0.0, 1.0]),
        ];
        let found = best(&columns);
        assert!((found.value - 1.125).abs() < 1e-12, "{found:?}");
        let sum: f64 = found.parts.iter().map(|part| part.1).sum();
        assert!(found.parts.len() == 2 && (sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn no_step_of_a_grid_promises_more() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for _ in 0..200 {
            let columns: Vec<Column> =
                (0..8).map(|_| column(1.0 + next(), [(); 4].map(|()| next() - 0.5))).collect();
            let found = best(&columns);
            let at = |step: [f64; 4]| {
                let value = |column: &Column| {
                    let change = column.gradient.iter().zip(step).map(|(g, x)| g * x);
                    column.distance + change.sum::<f64>()
                };
                columns.iter().map(value).fold(f64::INFINITY, f64::min)
            };
            assert!((at(found.step) - found.value).abs() < 1e-9, "{found:?}");
            for code in 0..625 {
                let step = [1, 5, 25, 125].map(|place| f64::from(code / place % 5 - 2) / 2.0);
                assert!(at(step) <= found.value + 1e-9, "{found:?}, {step:?}");
            }
        }
    }
}
