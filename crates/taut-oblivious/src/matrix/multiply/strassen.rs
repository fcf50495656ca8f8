//! Seven products of halves instead of eight.
//!
//! *Idea.* Winograd's form of Strassen's method, 15 additions, in an order that needs two matrices beside the target:
//! X for sums of parts of A, Y for sums of parts of B. An odd last row, column or product is added by the classic method.
//! *Guarantee.* With ℓ levels max |C − Ĉ| ≤ (18^ℓ·(q² + 6q) − 6p)·u·max |A| · max |B| + O(u²), p the largest dimension and
//! q = p / 2^ℓ; nothing is promised of single elements.
//! *Trap.* A symmetric product (Gram matrix) may lose its symmetry and its positive definiteness.
//! *Reference.* Strassen, Numer. Math. 13, 1969; Winograd 1971; Boyer, Dumas, Pernet, Zhou, *Memory efficient scheduling of
//! Strassen-Winograd's matrix multiplication algorithm*, ISSAC 2009, Table 1, with its names; Higham, *Accuracy and
//! Stability of Numerical Algorithms*, 2nd ed., section 23.2.2. The thesis prints the number of misses with √M in place
//! of M^0.40.

use super::{Level, MatrixView, MatrixViewMut, Update, shared};

/// Multiplies two matrices by the classic method.
pub(super) type Classic<'a> = &'a dyn Fn(MatrixView<'_>, MatrixView<'_>, MatrixViewMut<'_>);

/// C ← A·B; the dimensions are halved while all are longer than `above`.
pub(super) fn multiply(
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    mut c: MatrixViewMut<'_>,
    above: usize,
    classic: Classic<'_>,
) {
    let (m, k, n) = (a.rows / 2, a.columns / 2, b.columns / 2);
    if a.rows.min(a.columns).min(b.columns) <= above {
        return classic(a, b, c);
    }
    halves(
        a.part(0..2 * m, 0..2 * k),
        b.part(0..2 * k, 0..2 * n),
        c.part(0..2 * m, 0..2 * n),
        above,
        classic,
    );
    if a.columns > 2 * k {
        let (last_column, last_row) =
            (a.part(0..2 * m, 2 * k..a.columns), b.part(2 * k..b.rows, 0..2 * n));
        shared(Level::best(), last_column, last_row, c.part(0..2 * m, 0..2 * n), Update::Add);
    }
    if b.columns > 2 * n {
        let (last, columns) = (b.part(0..b.rows, 2 * n..b.columns), 2 * n..b.columns);
        classic(a.part(0..2 * m, 0..a.columns), last, c.part(0..2 * m, columns));
    }
    if a.rows > 2 * m {
        let (rows, columns) = (2 * m..a.rows, 0..b.columns);
        classic(a.part(rows.clone(), 0..a.columns), b, c.part(rows, columns));
    }
}

/// [`multiply`] of even dimensions.
fn halves(
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    mut c: MatrixViewMut<'_>,
    above: usize,
    classic: Classic<'_>,
) {
    let (m, k, n) = (a.rows / 2, a.columns / 2, b.columns / 2);
    let [a11, a12, a21, a22] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| quarter(a, i, j));
    let [b11, b12, b21, b22] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| quarter(b, i, j));
    let mut room_x = vec![0.0; m * k.max(n)];
    let mut room_y = vec![0.0; k * n];
    let times = |a: MatrixView<'_>, b: MatrixView<'_>, c: MatrixViewMut<'_>| {
        multiply(a, b, c, above, classic);
    };
    let mut y = MatrixViewMut { data: &mut room_y, rows: k, columns: n, stride: n };
    {
        let mut x = MatrixViewMut { data: &mut room_x, rows: m, columns: k, stride: k };
        assign(&mut x, a11, a21, |p, q| p - q); // S3
        assign(&mut y, b22, b12, |p, q| p - q); // T3
        times(x.view(), y.view(), c.part(m..2 * m, 0..n)); // P7 in C21
        assign(&mut x, a21, a22, |p, q| p + q); // S1
        assign(&mut y, b12, b11, |p, q| p - q); // T1
        times(x.view(), y.view(), c.part(m..2 * m, n..2 * n)); // P5 in C22
        combine(&mut x, a11, |s1, p| s1 - p); // S2
        combine(&mut y, b22, |t1, p| p - t1); // T2
        times(x.view(), y.view(), c.part(0..m, n..2 * n)); // P6 in C12
        combine(&mut x, a12, |s2, p| p - s2); // S4
        times(x.view(), b22, c.part(0..m, 0..n)); // P3 in C11
    }
    let mut x = MatrixViewMut { data: &mut room_x, rows: m, columns: n, stride: n };
    times(a11, b11, x.again()); // P1
    for i in 0..m {
        let p1 = &x.data[i * n..(i + 1) * n];
        let (upper, lower) = c.data.split_at_mut(m * c.stride);
        let (c11, c12) = upper[i * c.stride..][..2 * n].split_at_mut(n);
        let (c21, c22) = lower[i * c.stride..][..2 * n].split_at_mut(n);
        for j in 0..n {
            let u2 = p1[j] + c12[j];
            let u3 = u2 + c21[j];
            c12[j] = (u2 + c22[j]) + c11[j]; // U5 = U4 + P3
            c21[j] = u3;
            c22[j] += u3; // U7
        }
    }
    combine(&mut y, b21, |t2, p| t2 - p); // T4
    times(a22, y.view(), c.part(0..m, 0..n)); // P4 in C11
    for i in 0..m {
        let (upper, lower) = c.data.split_at_mut(m * c.stride);
        let (p4, u3) = (&upper[i * c.stride..][..n], &mut lower[i * c.stride..][..n]);
        u3.iter_mut().zip(p4).for_each(|(u, p)| *u -= p); // U6
    }
    times(a12, b21, c.part(0..m, 0..n)); // P2 in C11
    combine(&mut c.part(0..m, 0..n), x.view(), |p2, p1| p1 + p2); // U1
}

/// The quarter in half i of the rows and half j of the columns.
fn quarter(of: MatrixView<'_>, i: usize, j: usize) -> MatrixView<'_> {
    let (rows, columns) = (of.rows / 2, of.columns / 2);
    of.part(i * rows..(i + 1) * rows, j * columns..(j + 1) * columns)
}

/// Each element of `to` becomes `f` of those of `a` and `b`.
fn assign(
    to: &mut MatrixViewMut<'_>,
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    f: impl Fn(f64, f64) -> f64,
) {
    for i in 0..to.rows {
        let row = to.row(i);
        let (from_a, from_b) = (&a.data[i * a.row_stride..], &b.data[i * b.row_stride..]);
        if (a.column_stride, b.column_stride) == (1, 1) {
            for ((x, &p), &q) in row.iter_mut().zip(from_a).zip(from_b) {
                *x = f(p, q);
            }
        } else {
            for (j, x) in row.iter_mut().enumerate() {
                *x = f(from_a[j * a.column_stride], from_b[j * b.column_stride]);
            }
        }
    }
}

/// Each element x of `to` becomes `f(x, p)` with the element p of `from`.
fn combine(to: &mut MatrixViewMut<'_>, from: MatrixView<'_>, f: impl Fn(f64, f64) -> f64) {
    for i in 0..to.rows {
        let row = to.row(i);
        let from_row = &from.data[i * from.row_stride..];
        if from.column_stride == 1 {
            row.iter_mut().zip(from_row).for_each(|(x, &p)| *x = f(*x, p));
        } else {
            for (j, x) in row.iter_mut().enumerate() {
                *x = f(*x, from_row[j * from.column_stride]);
            }
        }
    }
}
