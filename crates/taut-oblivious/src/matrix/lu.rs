//! LU factors by recursion on the columns.
//!
//! *Problem.* P·A = L·U with partial pivoting, in place, at the rate of multiplication.
//! *Idea.* Factor the left half of the columns; exchange the rows of the right half likewise; solve L₁₁·U₁₂ = A₁₂; take
//! L₂₁·U₁₂ from A₂₂; factor that. The pivots need whole columns, which is why the recursion halves columns only.
//! *Guarantee.* |P·A − L·U| ≤ γ·|L|·|U| element by element, γ = n·u / (1 − n·u) to first order, and |L| ≤ 1. Ties go to the
//! upper row; the bits are the same for any number of threads and any processor.
//! *Trap.* A zero pivot is no failure of the factors, only of what is solved with them: the column is left as it is, and
//! the answer says so.
//! *Reference.* Toledo, *Locality of reference in LU decomposition with partial pivoting*, SIAM J. Matrix Anal. 18, 1997;
//! thesis, section 5.8; Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., theorem 9.3.

use super::multiply::{Update, recurse, shared};
use super::view::{MatrixView, MatrixViewMut};
use crate::level::Level;
use crate::{Error, NoProbe, Probe};

#[cfg(test)]
mod tests;

/// Up to this many columns are factored one at a time.
const LEAF_COLUMNS: usize = 16;

/// What [`lu`] did to the rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lu {
    /// In step j row j changed places with row `pivots[j]`, which is not above it.
    pub pivots: Vec<usize>,
    /// The first step whose pivot is zero: U is singular.
    pub zero_pivot: Option<usize>,
}

/// Replaces a matrix by its factors: U on and above the diagonal, below it L, whose diagonal is one.
///
/// The matrix may be rectangular. Runs on the current rayon pool. O(m·n·min(m, n)); memory for
/// m·min(m, n)/2 numbers, and for m² more if the matrix is wider than high.
///
/// ```
/// use taut_oblivious::{MatrixViewMut, lu};
///
/// let mut a = [0.0, 1.0, 2.0, 4.0];
/// let factors = lu(MatrixViewMut::new(&mut a, 2, 2)?);
/// assert_eq!((factors.pivots, a), (vec![1, 1], [2.0, 4.0, 0.0, 1.0]));
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn lu(matrix: MatrixViewMut<'_>) -> Lu {
    run(matrix, &mut NoProbe)
}

/// As [`lu`], on one thread, and tells `probe` of rows of panels and of all that multiplication tells.
pub fn lu_probed<P: Probe>(matrix: MatrixViewMut<'_>, probe: &mut P) -> Lu {
    let address = matrix.data.as_ptr() as usize;
    probe.place(matrix.data);
    let factors = run(matrix, probe);
    probe.lift_from(address);
    factors
}

/// Solves A·x = b with the factors of a square A; `b` becomes x.
///
/// O(n²).
///
/// # Errors
/// [`Error::Option`] if the shapes do not match or the factors have a zero pivot.
pub fn lu_solve(matrix: MatrixView<'_>, factors: &Lu, b: &mut [f64]) -> Result<(), Error> {
    let n = b.len();
    let refuse = |value, expected| Err(Error::Option { name: "factors", value, expected });
    if matrix.shape() != (n, n) || factors.pivots.len() != n {
        let value =
            format!("{:?} with {} pivots for {n} values", matrix.shape(), factors.pivots.len());
        return refuse(value, "a square matrix, a pivot and a value for each row");
    }
    if let Some(step) = factors.zero_pivot {
        return refuse(format!("singular in step {step}"), "no zero pivot");
    }
    if factors.pivots.iter().any(|&pivot| pivot >= n) {
        return refuse("a pivot beyond the rows".to_owned(), "the pivots that lu returned");
    }
    let at = |i: usize, j: usize| matrix.data[i * matrix.row_stride + j * matrix.column_stride];
    for (j, &pivot) in factors.pivots.iter().enumerate() {
        b.swap(j, pivot);
    }
    for i in 0..n {
        b[i] = (0..i).fold(b[i], |x, j| x - at(i, j) * b[j]);
    }
    for i in (0..n).rev() {
        b[i] = (i + 1..n).fold(b[i], |x, j| x - at(i, j) * b[j]) / at(i, i);
    }
    Ok(())
}

fn run<P: Probe>(mut matrix: MatrixViewMut<'_>, probe: &mut P) -> Lu {
    let (m, n) = (matrix.rows, matrix.columns);
    let steps = m.min(n);
    let mut factors = Lu { pivots: vec![0; steps], zero_pivot: None };
    let mut left = vec![0.0; m * steps.div_ceil(2)];
    probe.place(&left);
    factor(&mut matrix.part(0..m, 0..steps), &mut factors.pivots, &mut left, probe);
    if n > steps {
        // More columns than rows: they take part in the exchanges and in the last solution.
        exchange(&mut matrix, steps..n, &factors.pivots);
        let square = copied(matrix.view().part(0..m, 0..m));
        solve(view(&square, m, m), &mut matrix.part(0..m, steps..n), probe);
    }
    factors.zero_pivot = (0..steps).find(|&j| matrix.row(j)[j] == 0.0);
    probe.lift(&left);
    factors
}

/// Factors a panel with at least as many rows as columns; `scratch` holds half of its columns.
fn factor<P: Probe>(
    a: &mut MatrixViewMut<'_>,
    pivots: &mut [usize],
    scratch: &mut [f64],
    probe: &mut P,
) {
    let (m, n) = (a.rows, a.columns);
    if n <= LEAF_COLUMNS {
        return factor_columns(a, pivots, probe);
    }
    let half = n / 2;
    factor(&mut a.part(0..m, 0..half), &mut pivots[..half], scratch, probe);
    exchange(a, half..n, &pivots[..half]);
    // L shares its rows with what it is multiplied into, so it is read from a copy.
    let left = &mut scratch[..m * half];
    for (i, row) in left.chunks_exact_mut(half).enumerate() {
        row.copy_from_slice(&a.row(i)[..half]);
        probe.read(&a.row(i)[..half]);
        probe.write(row);
    }
    let left = view(left, m, half);
    solve(left.part(0..half, 0..half), &mut a.part(0..half, half..n), probe);
    let (upper, lower) = a.data.split_at_mut(half * a.stride);
    let upper = MatrixViewMut { data: upper, rows: half, columns: n, stride: a.stride };
    let mut lower = MatrixViewMut { data: lower, rows: m - half, columns: n, stride: a.stride };
    let below = left.part(half..m, 0..half);
    let right = upper.view().part(0..half, half..n);
    subtract(below, right, lower.part(0..m - half, half..n), probe);
    factor(&mut lower.part(0..m - half, half..n), &mut pivots[half..], scratch, probe);
    exchange(&mut lower, 0..half, &pivots[half..]);
    pivots[half..].iter_mut().for_each(|pivot| *pivot += half);
}

/// One column after the other.
fn factor_columns<P: Probe>(a: &mut MatrixViewMut<'_>, pivots: &mut [usize], probe: &mut P) {
    let (m, n, stride) = (a.rows, a.columns, a.stride);
    for j in 0..n {
        let mut pivot = j;
        for i in j + 1..m {
            if a.data[i * stride + j].abs() > a.data[pivot * stride + j].abs() {
                pivot = i;
            }
        }
        pivots[j] = pivot;
        swap(a, 0..n, j, pivot);
        // The last row need not be a whole stride long.
        let (upper, lower) = a.data.split_at_mut(((j + 1) * stride).min(a.data.len()));
        let above = &upper[j * stride..][..n];
        if above[j] == 0.0 {
            continue;
        }
        for row in lower.chunks_mut(stride).take(m - j - 1) {
            probe.read(&row[j..n]);
            probe.write(&row[j..n]);
            row[j] /= above[j];
            let factor = row[j];
            for (x, &y) in row[j + 1..n].iter_mut().zip(&above[j + 1..]) {
                *x -= factor * y;
            }
        }
    }
}

/// Exchanges the given columns of rows as the steps of the pivots did.
fn exchange(a: &mut MatrixViewMut<'_>, columns: std::ops::Range<usize>, pivots: &[usize]) {
    for (j, &pivot) in pivots.iter().enumerate() {
        swap(a, columns.clone(), j, pivot);
    }
}

/// Exchanges the given columns of rows i ≤ k.
fn swap(a: &mut MatrixViewMut<'_>, columns: std::ops::Range<usize>, i: usize, k: usize) {
    if i < k {
        let (upper, lower) = a.data.split_at_mut(k * a.stride);
        upper[i * a.stride..][columns.clone()].swap_with_slice(&mut lower[columns]);
    }
}

/// B ← L⁻¹·B for a square L whose diagonal counts as one.
fn solve<P: Probe>(l: MatrixView<'_>, b: &mut MatrixViewMut<'_>, probe: &mut P) {
    let (k, n) = (l.rows, b.columns);
    if k <= LEAF_COLUMNS {
        for i in 1..k {
            let (above, row) = b.data.split_at_mut(i * b.stride);
            let row = &mut row[..n];
            for (j, above) in above.chunks(b.stride).enumerate() {
                let factor = l.data[i * l.row_stride + j];
                for (x, &y) in row.iter_mut().zip(&above[..n]) {
                    *x -= factor * y;
                }
            }
            probe.read(row);
            probe.write(row);
        }
        return;
    }
    let half = k / 2;
    let (upper, lower) = b.data.split_at_mut(half * b.stride);
    let mut upper = MatrixViewMut { data: upper, rows: half, columns: n, stride: b.stride };
    let mut lower = MatrixViewMut { data: lower, rows: k - half, columns: n, stride: b.stride };
    solve(l.part(0..half, 0..half), &mut upper, probe);
    subtract(l.part(half..k, 0..half), upper.view(), lower.again(), probe);
    solve(l.part(half..k, half..k), &mut lower, probe);
}

/// C ← C − A·B, by all threads if nobody listens.
fn subtract<P: Probe>(a: MatrixView<'_>, b: MatrixView<'_>, c: MatrixViewMut<'_>, probe: &mut P) {
    if P::LISTENS {
        recurse(Level::best(), a, b, c, Update::Subtract, probe);
    } else {
        shared(Level::best(), a, b, c, Update::Subtract);
    }
}

fn view(data: &[f64], rows: usize, columns: usize) -> MatrixView<'_> {
    MatrixView { data, rows, columns, row_stride: columns, column_stride: 1 }
}

fn copied(from: MatrixView<'_>) -> Vec<f64> {
    (0..from.rows)
        .flat_map(|i| from.data[i * from.row_stride..][..from.columns].iter().copied())
        .collect()
}
