//! Matrix multiplication by halving the longest of the three sides.
//!
//! *Problem.* C += A·B with A of n × m, B of m × p, in rows.
//! *Idea.* Halve the largest of n, m, p until all are at most `base`.
//! *Guarantee.* O(1 + (nm + mp + np)/B + nmp/(B√M)) misses in a tall cache, the best there is for the n·m·p products;
//! 5·n³/(B√M) measured for n = 256 on borders of blocks. The order of the sums is fixed by the sizes and `base`.
//! *Trap.* Halving m adds into C twice, so C must be read as well as written.
//! *Reference.* Frigo, Leiserson, Prokop, Ramachandran, ACM TALG 8(1), 2012; Hong and Kung, STOC 1981 (the lower bound).

use super::{check_base, check_length, get, set};
use crate::{Error, NoProbe, Probe};

/// The sizes of a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MatrixSizes {
    /// n: rows of A and C.
    pub rows: usize,
    /// m: columns of A and rows of B.
    pub inner: usize,
    /// p: columns of B and C.
    pub columns: usize,
}

impl MatrixSizes {
    /// Of n × n matrices.
    pub const fn square(n: usize) -> Self {
        Self { rows: n, inner: n, columns: n }
    }
}

/// Adds A·B to C; the paper has `base` 1.
///
/// # Errors
/// [`Error::Option`] if an array has another length or `base` is 0.
pub fn multiply(
    a: &[f64],
    b: &[f64],
    c: &mut [f64],
    sizes: MatrixSizes,
    base: usize,
) -> Result<(), Error> {
    multiply_instrumented(a, b, c, sizes, base, &mut NoProbe)
}

/// [`multiply()`] under a probe.
///
/// # Errors
/// As there.
pub fn multiply_instrumented<P: Probe>(
    a: &[f64],
    b: &[f64],
    c: &mut [f64],
    sizes: MatrixSizes,
    base: usize,
    probe: &mut P,
) -> Result<(), Error> {
    check_length("a", a.len(), sizes.rows, sizes.inner)?;
    check_length("b", b.len(), sizes.inner, sizes.columns)?;
    check_length("c", c.len(), sizes.rows, sizes.columns)?;
    check_base(base)?;
    probe.place(a);
    probe.place(b);
    probe.place(c);
    let mut matrices = Matrices { a, b, c, sizes, base };
    matrices.multiply((0, sizes.rows), (0, sizes.inner), (0, sizes.columns), probe);
    Ok(())
}

struct Matrices<'a> {
    a: &'a [f64],
    b: &'a [f64],
    c: &'a mut [f64],
    sizes: MatrixSizes,
    base: usize,
}

impl Matrices<'_> {
    /// The products of rows `i`, inner indices `k` and columns `j`, each from a start on and that many.
    fn multiply<P: Probe>(
        &mut self,
        i: (usize, usize),
        k: (usize, usize),
        j: (usize, usize),
        probe: &mut P,
    ) {
        let longest = i.1.max(k.1).max(j.1);
        if i.1.min(k.1).min(j.1) == 0 {
            // Nothing, however long the other sides are.
        } else if longest <= self.base {
            self.leaf(i, k, j, probe);
        } else if i.1 == longest {
            let (first, second) = halves(i);
            self.multiply(first, k, j, probe);
            self.multiply(second, k, j, probe);
        } else if j.1 == longest {
            let (first, second) = halves(j);
            self.multiply(i, k, first, probe);
            self.multiply(i, k, second, probe);
        } else {
            let (first, second) = halves(k);
            self.multiply(i, first, j, probe);
            self.multiply(i, second, j, probe);
        }
    }

    fn leaf<P: Probe>(
        &mut self,
        (i, di): (usize, usize),
        (k, dk): (usize, usize),
        (j, dj): (usize, usize),
        probe: &mut P,
    ) {
        let MatrixSizes { inner, columns, .. } = self.sizes;
        for i in i..i + di {
            for j in j..j + dj {
                let mut sum = 0.0;
                for k in k..k + dk {
                    sum += get(self.a, i * inner + k, probe) * get(self.b, k * columns + j, probe);
                }
                let before = get(self.c, i * columns + j, probe);
                set(self.c, i * columns + j, before + sum, probe);
            }
        }
    }
}

fn halves((start, length): (usize, usize)) -> ((usize, usize), (usize, usize)) {
    let half = length / 2;
    ((start, half), (start + half, length - half))
}
