//! LU factors with partial pivoting, beside faer's and nalgebra's.

use anyhow::{Result, ensure};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::{MatMut, Par, Spec};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use taut_oblivious::{MatrixView, MatrixViewMut, lu, lu_solve};

use super::draw::Draw;
use super::lanes::Lanes;
use super::multiply::draw;
use crate::context::Context;
use crate::stats::times;
use crate::table::Table;

const FAER: &str = "faer";
const NALGEBRA: &str = "nalgebra";

/// Three sizes; no bound is set for them.
pub(super) fn run(context: &Context) -> Result<Value> {
    let sizes: &[usize] = if context.quick { &[100, 200] } else { &[500, 1000, 2000] };
    let mut table = Table::new(&[
        "n",
        "taut, GFLOP/s",
        "faer, GFLOP/s",
        "nalgebra, GFLOP/s",
        "faer ÷ taut",
        "nalgebra ÷ taut",
    ]);
    let mut measured = vec![];
    for &n in sizes {
        let lanes = beside(context, n)?;
        let rate = |name| format!("{:.1}", 2e-9 / 3.0 * (n as f64).powi(3) / lanes.of(name));
        table.push(vec![
            n.to_string(),
            rate("taut"),
            rate(FAER),
            rate(NALGEBRA),
            times(lanes.faster("taut", FAER)),
            times(lanes.faster("taut", NALGEBRA)),
        ]);
        measured.push(json!({ "n": n, "lanes": lanes.json(1) }));
    }
    println!("factors in place, with what each needs beside the matrix\n\n{table}");
    Ok(json!({ "sizes": measured }))
}

/// The same numbers in the order each program works along: taut has rows, the peers have columns.
fn beside(context: &Context, n: usize) -> Result<Lanes> {
    let a = draw(1, n);
    let rows = a.transpose();
    let mut random = Draw(3);
    let b = DVector::from_fn(n, |_, _| 2.0 * random.unit() - 1.0);
    let mut lanes = Lanes::default();
    // Short ones are disturbed more easily.
    for _ in 0..context.runs * (2000 / n).max(1) {
        let mut work = rows.as_slice().to_vec();
        let view = MatrixViewMut::new(&mut work, n, n)?;
        let factors = lanes.time("taut", || lu(view));
        let mut x = b.clone();
        lu_solve(MatrixView::new(&work, n, n)?, &factors, x.as_mut_slice())?;
        ensure!(holds(&a, &x, &b), "taut: wrong factors at n = {n}");

        let mut work = a.as_slice().to_vec();
        let mut order = [vec![0usize; n], vec![0; n]];
        let [forward, inverse] = &mut order;
        lanes.time(FAER, || {
            let needed = lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default());
            let mut room = MemBuffer::new(needed);
            let work = MatMut::from_column_major_slice_mut(&mut work, n, n);
            let stack = MemStack::new(&mut room);
            lu_in_place(work, forward, inverse, Par::Seq, stack, Spec::default());
        });
        let x = solved(&DMatrix::from_vec(n, n, work), &order[0], &b);
        ensure!(x.is_some_and(|x| holds(&a, &x, &b)), "{FAER}: wrong factors at n = {n}");

        let work = a.clone();
        let factors = lanes.time(NALGEBRA, || work.lu());
        let x = factors.solve(&b);
        ensure!(x.is_some_and(|x| holds(&a, &x, &b)), "{NALGEBRA}: wrong factors at n = {n}");
    }
    Ok(lanes)
}

/// What solves L·U·x = P·b, with both factors in one matrix and row i of P·b row `order[i]` of b.
fn solved(factors: &DMatrix<f64>, order: &[usize], b: &DVector<f64>) -> Option<DVector<f64>> {
    let mut x = DVector::from_iterator(b.len(), order.iter().map(|&row| b[row]));
    for j in 0..x.len() {
        for i in j + 1..x.len() {
            x[i] -= factors[(i, j)] * x[j];
        }
    }
    factors.solve_upper_triangular_mut(&mut x).then_some(x)
}

/// Whether A·x is b, with an error that rounding explains: normwise backward stable to n·2⁻⁵³ and some growth.
fn holds(a: &DMatrix<f64>, x: &DVector<f64>, b: &DVector<f64>) -> bool {
    let n = b.len() as f64;
    (a * x - b).amax() <= 1e-14 * n * (n * x.amax() + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_told_from_others() {
        let a = DMatrix::from_row_slice(2, 2, &[0.0, 2.0, 1.0, 3.0]);
        let b = DVector::from_row_slice(&[2.0, 5.0]);
        // Rows exchanged: L is one, U is the exchanged matrix.
        let factors = DMatrix::from_row_slice(2, 2, &[1.0, 3.0, 0.0, 2.0]);
        let x = solved(&factors, &[1, 0], &b).unwrap();
        assert!(holds(&a, &x, &b));
        let x = solved(&factors, &[0, 1], &b).unwrap();
        assert!(!holds(&a, &x, &b));
    }
}
