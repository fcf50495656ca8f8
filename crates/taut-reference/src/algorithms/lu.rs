//! LU factors by recursion on the columns.
//!
//! *Problem.* P·A = L·U with partial pivoting, in place, for a matrix of m × n in rows.
//! *Idea.* Factor the left half of the columns; exchange the rows of the right half likewise; solve L₁₁·U₁₂ = A₁₂; subtract
//! L₂₁·U₁₂ from A₂₂; factor that. Pivots need whole columns, which is why the recursion halves columns only.
//! *Guarantee.* O(n³/(B√M) + (n²/B)·log n) misses in a tall cache that holds a line of each row. |P·A − L·U| ≤ γ·|L|·|U| element
//! by element, γ = n·u / (1 − n·u) to first order, and |L| ≤ 1; ties of pivots go to the upper row.
//! *Trap.* A zero pivot is no failure of the factors, only of what is solved with them: the column is left as it is, and
//! the answer says so.
//! *Reference.* Toledo, *Locality of reference in LU decomposition with partial pivoting*, SIAM J. Matrix Anal. 18, 1997;
//! thesis, section 5.8; Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., theorem 9.3.

use std::ops::Range;

use super::{check_length, get, set, swap};
use crate::{Error, NoProbe, Probe};

/// The result of [`lu()`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lu {
    /// In step j row j changed places with row `pivots[j]`, which is not above it.
    pub pivots: Vec<usize>,
    /// The first step whose pivot is zero: U is singular.
    pub zero_pivot: Option<usize>,
}

/// Replaces a matrix of any shape by its factors: U on and above the diagonal, below it L, whose diagonal is one.
///
/// ```
/// let mut a = [0.0, 1.0, 2.0, 4.0];
/// let factors = taut_reference::algorithms::lu(&mut a, 2, 2)?;
/// assert_eq!((factors.pivots, a), (vec![1, 1], [2.0, 4.0, 0.0, 1.0]));
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
///
/// # Errors
/// [`Error::Option`] if the array has another length.
pub fn lu(matrix: &mut [f64], rows: usize, columns: usize) -> Result<Lu, Error> {
    lu_instrumented(matrix, rows, columns, &mut NoProbe)
}

/// [`lu()`] under a probe.
///
/// # Errors
/// As there.
pub fn lu_instrumented<P: Probe>(
    matrix: &mut [f64],
    rows: usize,
    columns: usize,
    probe: &mut P,
) -> Result<Lu, Error> {
    check_length("matrix", matrix.len(), rows, columns)?;
    let steps = rows.min(columns);
    let pivots = vec![0; steps];
    probe.place(matrix);
    probe.place(&pivots);
    let mut run = Elimination { a: matrix, rows, columns, pivots };
    run.factor(0..steps, probe);
    // More columns than rows: they take part in the exchanges and in the last solution.
    run.exchange(0..steps, steps..columns, probe);
    run.solve(0..steps, steps..columns, probe);
    let zero_pivot = (0..steps).find(|&j| get(run.a, j * columns + j, probe) == 0.0);
    probe.lift(&run.pivots);
    Ok(Lu { pivots: run.pivots, zero_pivot })
}

struct Elimination<'a> {
    a: &'a mut [f64],
    rows: usize,
    columns: usize,
    pivots: Vec<usize>,
}

impl Elimination<'_> {
    /// Factors the panel of some columns, from the diagonal down.
    fn factor<P: Probe>(&mut self, panel: Range<usize>, probe: &mut P) {
        if panel.len() < 2 {
            panel.for_each(|j| self.eliminate(j, probe));
            return;
        }
        let (left, right) = halves(&panel);
        self.factor(left.clone(), probe);
        self.exchange(left.clone(), right.clone(), probe);
        self.solve(left.clone(), right.clone(), probe);
        self.subtract(right.start..self.rows, left.clone(), right.clone(), probe);
        self.factor(right.clone(), probe);
        self.exchange(right, left, probe);
    }

    /// One step: the pivot of column j, and the column divided by it.
    fn eliminate<P: Probe>(&mut self, j: usize, probe: &mut P) {
        let n = self.columns;
        let (mut pivot, mut largest) = (j, get(self.a, j * n + j, probe));
        for i in j + 1..self.rows {
            let element = get(self.a, i * n + j, probe);
            if element.abs() > largest.abs() {
                (pivot, largest) = (i, element);
            }
        }
        set(&mut self.pivots, j, pivot, probe);
        if largest == 0.0 {
            return;
        }
        if pivot != j {
            swap(self.a, j * n + j, pivot * n + j, probe);
        }
        for i in j + 1..self.rows {
            let element = get(self.a, i * n + j, probe);
            set(self.a, i * n + j, element / largest, probe);
        }
    }

    /// Exchanges rows, within some columns, as some steps did.
    fn exchange<P: Probe>(&mut self, steps: Range<usize>, columns: Range<usize>, probe: &mut P) {
        let n = self.columns;
        for j in steps {
            let pivot = get(&self.pivots, j, probe);
            if pivot != j {
                columns.clone().for_each(|k| swap(self.a, j * n + k, pivot * n + k, probe));
            }
        }
    }

    /// B ← L⁻¹·B for the square L of some rows and columns of the same numbers, and the part B of these rows.
    fn solve<P: Probe>(&mut self, rows: Range<usize>, columns: Range<usize>, probe: &mut P) {
        if rows.len() < 2 {
            return;
        }
        let (upper, lower) = halves(&rows);
        self.solve(upper.clone(), columns.clone(), probe);
        self.subtract(lower.clone(), upper, columns.clone(), probe);
        self.solve(lower, columns, probe);
    }

    /// A_ij ← A_ij − A_ik·A_kj, by halving the longest side.
    fn subtract<P: Probe>(
        &mut self,
        i: Range<usize>,
        k: Range<usize>,
        j: Range<usize>,
        probe: &mut P,
    ) {
        let (n, longest) = (self.columns, i.len().max(k.len()).max(j.len()));
        if i.is_empty() || k.is_empty() || j.is_empty() {
            // Nothing, however long the other sides are.
        } else if longest == 1 {
            let (i, k, j) = (i.start, k.start, j.start);
            let product = get(self.a, i * n + k, probe) * get(self.a, k * n + j, probe);
            let before = get(self.a, i * n + j, probe);
            set(self.a, i * n + j, before - product, probe);
        } else if i.len() == longest {
            let (first, second) = halves(&i);
            self.subtract(first, k.clone(), j.clone(), probe);
            self.subtract(second, k, j, probe);
        } else if j.len() == longest {
            let (first, second) = halves(&j);
            self.subtract(i.clone(), k.clone(), first, probe);
            self.subtract(i, k, second, probe);
        } else {
            let (first, second) = halves(&k);
            self.subtract(i.clone(), first, j.clone(), probe);
            self.subtract(i, second, j, probe);
        }
    }
}

fn halves(range: &Range<usize>) -> (Range<usize>, Range<usize>) {
    let middle = range.start + range.len() / 2;
    (range.start..middle, middle..range.end)
}
