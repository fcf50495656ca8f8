//! The weights of edges that bound the clearance in a cell best.
//!
//! *Problem.* Let Dᵢⱼ be the distance of corner j of a cell from edge i. Minimize maxⱼ Σᵢ λᵢDᵢⱼ over λ ≥ 0 with Σ λᵢ = 1: the
//! value of a matrix game with four columns.
//! *Idea.* Column generation: solve the game for few edges; its optimal weights μ of the corners name the edge that lowers the
//! value most, the one with the least Σⱼ Dᵢⱼμⱼ. A game of at most four by four is solved by its square parts: some optimal
//! strategies make as many rows as columns equal (Shapley and Snow, Basic solutions of discrete games, 1950).
//! *Guarantee.* Any λ is valid. That of a game whose value no other edge lowers is optimal up to rounding.

/// Rounds of column generation; more than eight were not seen to lower the value further.
const ROUNDS_MAX: usize = 8;

/// Relative change of the value below which an edge does not lower it.
const VALUE_SLACK: f64 = 1e-13;

/// The amount by which rounding may take a weight below 0 of an optimal strategy.
const WEIGHT_SLACK: f64 = 1e-12;

/// An edge, with its distances from the four corners.
pub(super) type Row = (u32, [f64; 4]);

/// Edges with weights that sum to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Weights {
    /// Edges and weights above 0.
    pub(super) parts: Vec<(Row, f64)>,
    /// maxⱼ Σᵢ λᵢDᵢⱼ.
    pub(super) value: f64,
}

/// Solves the game of all edges, from a first one, until the value is at most `enough`. `least` returns the edge of the least
/// Σⱼ Dᵢⱼμⱼ for weights μ of the corners.
pub(super) fn best(first: Row, enough: f64, least: impl Fn([f64; 4]) -> Row) -> Weights {
    let largest = first.1.into_iter().fold(0.0, f64::max);
    let mut chosen = vec![first];
    let mut best = Weights { parts: vec![(first, 1.0)], value: largest };
    for _ in 0..ROUNDS_MAX {
        let rows: Vec<[f64; 4]> = chosen.iter().map(|row| row.1).collect();
        let (lambda, value) = minimize(&rows, 4);
        if value < best.value || best.parts.len() != chosen.len() {
            let parts = chosen.iter().copied().zip(lambda).filter(|part| part.1 > 0.0);
            best = Weights { parts: parts.collect(), value };
        }
        if best.value <= enough {
            break;
        }
        let mu = corners(&rows);
        let next = least(mu);
        let at_next = (0..4).map(|j| mu[j] * next.1[j]).sum::<f64>();
        let is_chosen = chosen.iter().any(|row| row.0 == next.0);
        if at_next >= best.value * (1.0 - VALUE_SLACK) || is_chosen {
            break;
        }
        if chosen.len() == 4 {
            // The edge that the optimum does without; with four in use, the one of the least weight.
            let least = (0..4).min_by(|&i, &j| lambda[i].total_cmp(&lambda[j])).unwrap_or(0);
            chosen.remove(least);
        }
        chosen.push(next);
    }
    best
}

/// Optimal weights of the four corners for at most four edges.
fn corners(rows: &[[f64; 4]]) -> [f64; 4] {
    let mut columns = [[0.0; 4]; 4];
    for (i, row) in rows.iter().enumerate() {
        for j in 0..4 {
            columns[j][i] = -row[j];
        }
    }
    minimize(&columns, rows.len()).0
}

/// Minimizes maxⱼ Σᵢ λᵢ·rows[i][j] over the first `width` columns, for at most four rows. Returns λ and the value.
fn minimize(rows: &[[f64; 4]], width: usize) -> ([f64; 4], f64) {
    let mut best = ([0.0; 4], f64::INFINITY);
    let mut consider = |lambda: [f64; 4]| {
        let column = |j: usize| rows.iter().zip(lambda).map(|(row, l)| l * row[j]).sum::<f64>();
        let value = (0..width).map(column).fold(f64::NEG_INFINITY, f64::max);
        if value < best.1 {
            best = (lambda, value);
        }
    };
    let count = rows.len();
    for i in 0..count {
        let mut lambda = [0.0; 4];
        lambda[i] = 1.0;
        consider(lambda);
    }
    for own in subsets(count, 2) {
        for columns in subsets(width, 2) {
            let (i, j) = (own[0], own[1]);
            let difference = |row: usize| rows[row][columns[0]] - rows[row][columns[1]];
            let share = difference(j) / (difference(j) - difference(i));
            if (0.0..=1.0).contains(&share) {
                let mut lambda = [0.0; 4];
                (lambda[i], lambda[j]) = (share, 1.0 - share);
                consider(lambda);
            }
        }
    }
    for own in subsets(count, 3) {
        for columns in subsets(width, 3) {
            if let Some(lambda) = equal_in_three(rows, own, columns) {
                consider(lambda);
            }
        }
    }
    best
}

/// Weights of three rows for which three columns have one value.
fn equal_in_three(rows: &[[f64; 4]], own: [usize; 3], columns: [usize; 3]) -> Option<[f64; 4]> {
    let difference = |k: usize, c: usize| rows[own[k]][columns[c]] - rows[own[k]][columns[0]];
    let (one, other) = ([0, 1, 2].map(|k| difference(k, 1)), [0, 1, 2].map(|k| difference(k, 2)));
    // λ is at right angles to both.
    let cross = [
        one[1] * other[2] - one[2] * other[1],
        one[2] * other[0] - one[0] * other[2],
        one[0] * other[1] - one[1] * other[0],
    ];
    let sum = cross[0] + cross[1] + cross[2];
    let weights = cross.map(|x| x / sum);
    if !weights.iter().all(|weight| (-WEIGHT_SLACK..=1.0 + 3.0 * WEIGHT_SLACK).contains(weight)) {
        return None;
    }
    let mut lambda = [0.0; 4];
    let positive = weights.map(|weight| weight.max(0.0));
    let sum: f64 = positive.iter().sum();
    for (k, weight) in own.into_iter().zip(positive) {
        lambda[k] = weight / sum;
    }
    Some(lambda)
}

/// All subsets of 0..n with two or three members, ascending; of two, the last entry is of no meaning.
fn subsets(n: usize, size: usize) -> impl Iterator<Item = [usize; 3]> {
    let pairs = (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)));
    pairs.flat_map(move |(i, j)| {
        let thirds = if size == 2 { n - 1..n } else { j + 1..n };
        thirds.map(move |k| [i, j, k])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves the game of all rows.
    fn best_of(rows: &[[f64; 4]]) -> Weights {
        let least = |mu: [f64; 4]| {
            let at = |row: &[f64; 4]| (0..4).map(|j| mu[j] * row[j]).sum::<f64>();
            let all = rows.iter().enumerate();
            let (i, row) = all.min_by(|one, other| at(one.1).total_cmp(&at(other.1))).unwrap();
            (i as u32, *row)
        };
        best((0, rows[0]), 0.0, least)
    }

    #[test]
    fn three_sides_of_a_triangle_balance() {
        // Distances from lines with normals that sum to 0 have the mean 1 at every point.
        let normals = [[1.0, 0.0], [-0.5, 0.75f64.sqrt()], [-0.5, -(0.75f64.sqrt())]];
        let corners = [[-0.3, -0.2], [0.4, -0.2], [-0.3, 0.5], [0.4, 0.5]];
        let rows: Vec<[f64; 4]> = normals
            .iter()
            .map(|n| corners.map(|p| 1.0 - n[0] * p[0] - n[1] * p[1]))
            .chain([[2.0; 4], [1.5; 4]])
            .collect();
        let found = best_of(&rows);
        assert!((found.value - 1.0).abs() < 1e-12, "{found:?}");
        assert_eq!(found.parts.len(), 3);
        assert!(found.parts.iter().all(|part| (part.1 - 1.0 / 3.0).abs() < 1e-9));
    }

    #[test]
    fn no_weights_of_a_fine_grid_are_better() {
        let mut state = 3u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        const PARTS: usize = 24;
        for _ in 0..200 {
            // Distances of corners of a cell are nearly those of a plane.
            let rows: Vec<[f64; 4]> = (0..4)
                .map(|_| {
                    let (c, x, y) = (1.0 + next(), next() - 0.5, next() - 0.5);
                    [c, c + x, c + y, c + x + y]
                })
                .collect();
            let found = best_of(&rows);
            let mut least = f64::INFINITY;
            for i in 0..=PARTS {
                for j in 0..=PARTS - i {
                    for k in 0..=PARTS - i - j {
                        let weights = [i, j, k, PARTS - i - j - k];
                        let at =
                            |c: usize| (0..4).map(|e| weights[e] as f64 * rows[e][c]).sum::<f64>();
                        let value = (0..4).map(at).fold(0.0, f64::max) / PARTS as f64;
                        least = least.min(value);
                    }
                }
            }
            assert!(found.value <= least + 1e-12, "{rows:?}: {found:?}, but {least}");
        }
    }
}
