//! Products of matrices, beside those of `matrixmultiply` and `faer`, and Strassen's beside the classic ones.

use anyhow::{Result, ensure};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use taut_oblivious::{MatrixView, MatrixViewMut, MultiplyOptions, multiply};

use super::draw::Draw;
use super::lanes::Lanes;
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// The peers, in the tables.
const PEER: &str = "matrixmultiply";
const FAER: &str = "faer";

/// Sizes up to 2000 beside the peers, then two levels of Strassen at 6000.
pub(super) fn run(context: &Context) -> Result<Value> {
    let sizes: &[usize] = if context.quick { &[100, 200] } else { &[256, 500, 1000, 2000] };
    let mut table = Table::new(&[
        "n",
        "taut, GFLOP/s",
        "matrixmultiply, GFLOP/s",
        "faer, GFLOP/s",
        "matrixmultiply ÷ taut",
        "faer ÷ taut",
    ]);
    let mut goals = Goals::default();
    let mut measured = vec![];
    let mut last = f64::NAN;
    for &n in sizes {
        let lanes = beside(context, n)?;
        let rate = |name| format!("{:.1}", 2e-9 * (n as f64).powi(3) / lanes.of(name));
        last = lanes.faster("taut", PEER);
        let faer = lanes.faster("taut", FAER);
        table.push(vec![
            n.to_string(),
            rate("taut"),
            rate(PEER),
            rate(FAER),
            times(last),
            times(faer),
        ]);
        measured.push(json!({ "n": n, "lanes": lanes.json(1) }));
    }
    println!("{table}");
    let n = if context.quick { 512 } else { 6000 };
    let (lanes, error) = strassen(context, n)?;
    let gain = lanes.faster("two levels", "classic");
    println!(
        "n = {n}: two levels of Strassen take {} of the classic time; largest difference over n·max|a|·max|b|·2⁻⁵³: {}\n",
        times(1.0 / gain),
        times(error)
    );
    measured.push(json!({ "n": n, "lanes": lanes.json(1), "difference": error }));
    let what = format!("n = {}: matrixmultiply over taut", sizes[sizes.len() - 1]);
    goals.at_least(&what, last, (1.0, Some(1.05)));
    let what = format!("n = {n}: classic over two levels of Strassen");
    goals.at_least(&what, gain, (1.0, None));
    Ok(json!({ "sizes": measured, "goals": goals.json() }))
}

/// Numbers from −1 to 1.
pub(super) fn draw(seed: u64, n: usize) -> DMatrix<f64> {
    let mut draw = Draw(seed);
    DMatrix::from_fn(n, n, |_, _| 2.0 * draw.unit() - 1.0)
}

/// taut and the peers on the same memory: nalgebra stores columns, taut takes rows, so that taut's product of the
/// transposes in reverse order is the same array.
fn beside(context: &Context, n: usize) -> Result<Lanes> {
    let (a, b) = (draw(1, n), draw(2, n));
    let mut lanes = Lanes::default();
    // Short ones are disturbed more easily.
    for _ in 0..context.runs * (2000 / n).max(1) {
        let mut ours = DMatrix::from_element(n, n, f64::NAN);
        lanes.time("taut", || product(&a, &b, &mut ours, None))?;
        let mut theirs = DMatrix::from_element(n, n, f64::NAN);
        lanes.time(PEER, || theirs.gemm(1.0, &a, &b, 0.0));
        let mut third = DMatrix::from_element(n, n, f64::NAN);
        lanes.time(FAER, || {
            let [a, b] = [&a, &b].map(|m| MatRef::from_column_major_slice(m.as_slice(), n, n));
            let c = MatMut::from_column_major_slice_mut(third.as_mut_slice(), n, n);
            matmul(c, Accum::Replace, a, b, 1.0, Par::Seq);
        });
        ensure!(holds(&a, &b, &third), "{FAER}: a wrong product at n = {n}");
        ensure!(holds(&a, &b, &ours), "taut: a wrong product at n = {n}");
        ensure!(holds(&a, &b, &theirs), "{PEER}: a wrong product at n = {n}");
    }
    Ok(lanes)
}

/// Times of both, and the largest difference in units of n·2⁻⁵³.
fn strassen(context: &Context, n: usize) -> Result<(Lanes, f64)> {
    let (a, b) = (draw(1, n), draw(2, n));
    let mut lanes = Lanes::default();
    let mut largest = 0.0f64;
    for _ in 0..context.runs {
        let mut classic = DMatrix::from_element(n, n, f64::NAN);
        lanes.time("classic", || product(&a, &b, &mut classic, None))?;
        let mut two = DMatrix::from_element(n, n, f64::NAN);
        // Halves are cut again above a third of n, their halves no more.
        lanes.time("two levels", || product(&a, &b, &mut two, Some(n / 3)))?;
        ensure!(holds(&a, &b, &classic) && holds(&a, &b, &two), "a wrong product at n = {n}");
        largest = largest.max((classic - two).amax());
    }
    Ok((lanes, largest / (n as f64 * f64::EPSILON / 2.0)))
}

/// C ← A·B by taut, on arrays of columns.
fn product(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    c: &mut DMatrix<f64>,
    strassen_above: Option<usize>,
) -> Result<()> {
    let n = a.nrows();
    let [a, b] = [a, b].map(|matrix| MatrixView::new(matrix.as_slice(), n, n));
    let c = MatrixViewMut::new(c.as_mut_slice(), n, n)?;
    Ok(multiply(b?, a?, c, &MultiplyOptions { strassen_above })?)
}

/// Whether C·x is A·(B·x) for a random x, up to rounding; a wrong product passes by chance only.
fn holds(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>) -> bool {
    let n = a.nrows();
    let mut draw = Draw(3);
    let x = nalgebra::DVector::from_fn(n, |_, _| 2.0 * draw.unit() - 1.0);
    let gaps = c * &x - a * (b * &x);
    gaps.iter().all(|gap| gap.abs() <= 1e-12 * n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_told_from_others() {
        let (a, b) = (draw(1, 30), draw(2, 30));
        let mut c = DMatrix::from_element(30, 30, f64::NAN);
        assert!(!holds(&a, &b, &c));
        product(&a, &b, &mut c, None).unwrap();
        assert!(holds(&a, &b, &c));
        assert!(!holds(&b, &a, &c));
        c[(3, 4)] += 1e-6;
        assert!(!holds(&a, &b, &c));
    }
}
