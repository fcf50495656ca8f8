//! Transposition in place of matrices that are not square, by permutations within rows and within columns.
//!
//! *Problem.* The cycles of the transposition wander over the whole matrix, a line of the cache for each element.
//! *Idea.* With c = gcd(m, n), a = m / c and b = n / c it is a composition of three steps, each within columns or rows:
//! column j is rotated by ⌊j / b⌋; row i sends its element j to ((i + ⌊j / b⌋) mod m + j·m) mod n; column j takes for its
//! element i the element (j + i·n − ⌊i / a⌋) mod m. Columns go in groups that fill a line of the cache.
//! *Guarantee.* O(m·n) moves, each element three times, and scratch for one row or one group of columns.
//! *Trap.* The steps go from a wide matrix to a tall one; a tall one takes the inverse steps backwards, so that it is
//! always the rows that are long and the columns that are few and short.
//! *Reference.* Catanzaro, Keller, Garland, *A Decomposition for In-place Matrix Transposition*, PPoPP 2014, with its
//! names: r, d′ and s′.

use bytemuck::Pod;

use crate::Probe;

/// A group of columns has this many bytes in one row.
const GROUP_BYTES: usize = 64;

/// Rows, columns, and what the formulas make of them.
struct Steps {
    m: usize,
    n: usize,
    a: usize,
    b: usize,
}

pub(super) fn transpose<T: Pod, P: Probe>(
    matrix: &mut [T],
    rows: usize,
    columns: usize,
    probe: &mut P,
) {
    let (m, n) = (rows.min(columns), rows.max(columns));
    let c = gcd(m, n);
    let steps = Steps { m, n, a: m / c, b: n / c };
    let group = (GROUP_BYTES / size_of::<T>()).max(1).min(n);
    let mut scratch = vec![T::zeroed(); n.max(m * group)];
    probe.place(&scratch);
    if rows < columns {
        if c > 1 {
            steps.columns(matrix, &mut scratch, group, probe, |i, j| (i, steps.rotated(i, j)));
        }
        steps.rows(matrix, &mut scratch, probe, |row, scratch, j, to| scratch[to] = row[j]);
        steps.columns(matrix, &mut scratch, group, probe, |i, j| (i, steps.shuffled(i, j)));
    } else {
        steps.columns(matrix, &mut scratch, group, probe, |i, j| (steps.shuffled(i, j), i));
        steps.rows(matrix, &mut scratch, probe, |row, scratch, j, from| scratch[j] = row[from]);
        if c > 1 {
            steps.columns(matrix, &mut scratch, group, probe, |i, j| (steps.rotated(i, j), i));
        }
    }
    probe.lift(&scratch);
}

impl Steps {
    /// r: where column j takes its element i from.
    fn rotated(&self, i: usize, j: usize) -> usize {
        (i + j / self.b) % self.m
    }

    /// s′: where column j takes its element i from.
    fn shuffled(&self, i: usize, j: usize) -> usize {
        (j % self.m + (i as u128 * self.n as u128 % self.m as u128) as usize + self.m
            - i / self.a % self.m)
            % self.m
    }

    /// Each column j: `place(i, j)` names pairs (to, from) of its rows.
    fn columns<T: Pod, P: Probe>(
        &self,
        matrix: &mut [T],
        scratch: &mut [T],
        group: usize,
        probe: &mut P,
        place: impl Fn(usize, usize) -> (usize, usize),
    ) {
        for left in (0..self.n).step_by(group) {
            let width = group.min(self.n - left);
            for i in 0..self.m {
                probe.read(&matrix[i * self.n + left..][..width]);
                for k in 0..width {
                    let (to, from) = place(i, left + k);
                    scratch[to * width + k] = matrix[from * self.n + left + k];
                }
            }
            for (i, row) in scratch.chunks_exact(width).take(self.m).enumerate() {
                let place = &mut matrix[i * self.n + left..][..width];
                probe.write(place);
                place.copy_from_slice(row);
            }
        }
    }

    /// Each row i: `carry(row, scratch, j, d′ᵢ(j))` for all j, then the scratch is the row.
    fn rows<T: Pod, P: Probe>(
        &self,
        matrix: &mut [T],
        scratch: &mut [T],
        probe: &mut P,
        carry: impl Fn(&[T], &mut [T], usize, usize),
    ) {
        for (i, row) in matrix.chunks_exact_mut(self.n).enumerate() {
            probe.read(row);
            probe.write(&scratch[..self.n]);
            // j·m mod n, kept by addition: m < n.
            let mut jm = 0;
            for first in (0..self.n).step_by(self.b) {
                let turn = (i + first / self.b) % self.m;
                for j in first..first + self.b {
                    let sum = turn + jm;
                    carry(row, scratch, j, if sum < self.n { sum } else { sum - self.n });
                    jm += self.m;
                    jm -= if jm < self.n { 0 } else { self.n };
                }
            }
            probe.read(&scratch[..self.n]);
            probe.write(row);
            row.copy_from_slice(&scratch[..self.n]);
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
