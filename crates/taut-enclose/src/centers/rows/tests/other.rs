//! Another exact method, for up to 64 points: bisection over all distances, and covers by rows as a dominating set is found.

use super::judge::Problem;

/// The least radius.
pub(super) fn radius(problem: &Problem<'_>) -> f64 {
    let n = problem.len();
    let reach = |i: usize, j: usize| problem.reach(i, problem.row(j));
    let mut radii: Vec<f64> =
        (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| reach(i, j)).collect();
    radii.sort_unstable_by(f64::total_cmp);
    radii.dedup();
    let covers = |radius: f64| {
        let ball = |j| (0..n).filter(|&i| reach(i, j) <= radius).fold(0u64, |set, i| set | 1 << i);
        let balls: Vec<u64> = (0..n).map(ball).collect();
        let all = if n == 64 { u64::MAX } else { (1 << n) - 1 };
        covered(&balls, all, problem.k, problem.outliers)
    };
    radii[radii.partition_point(|&radius| !covers(radius))]
}

/// Returns true if k of the balls hold all of `rest` but some outliers: some ball has to hold the row that is in the fewest, or it is
/// left out.
fn covered(balls: &[u64], rest: u64, k: usize, outliers: usize) -> bool {
    let open = rest.count_ones() as usize;
    if open <= outliers {
        return true;
    }
    let largest = balls.iter().map(|ball| (ball & rest).count_ones() as usize).max().unwrap_or(0);
    if k == 0 || k * largest + outliers < open {
        return false;
    }
    let holders = |row: &usize| balls.iter().filter(|&&ball| ball >> row & 1 == 1).count();
    let row =
        (0..64).filter(|row| rest >> row & 1 == 1).min_by_key(holders).expect("rest has rows");
    let mut tried: Vec<u64> = vec![];
    for &ball in balls.iter().filter(|&&ball| ball >> row & 1 == 1) {
        let new = ball & rest;
        if tried.iter().any(|&other| new & !other == 0) {
            continue;
        }
        tried.push(new);
        if covered(balls, rest & !new, k - 1, outliers) {
            return true;
        }
    }
    outliers > 0 && covered(balls, rest & !(1 << row), k, outliers - 1)
}
