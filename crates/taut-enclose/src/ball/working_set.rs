//! The items a solver works on: their rows relative to an origin, and the Gram matrix of these.
//!
//! Only new rows are multiplied when the set grows, as one matrix product. Everything the active set needs of the
//! d-dimensional points is in the k × k matrix, which is why its steps do not depend on d.

use std::collections::HashMap;
use std::ops::Range;

use taut_kernels::matrix::{Matrix, MatrixMut, set_product};
use taut_kernels::vector::{add_combination, add_scaled_exactly};
use taut_kernels::{Center, DoubleDouble, squared_distances};
use taut_points::parallel::IntoParallel;
use taut_points::{exponent_of, two_to};

/// One task multiplies this many columns of the Gram matrix, which depends on the size of the set only: so the result does not depend on
/// threads. Narrow tiles of a small set keep two threads busy, and leave out most of what is known by symmetry.
const fn tile_columns(items: usize) -> usize {
    if items <= SMALL_SET { 32 } else { 128 }
}
/// Items of a small set.
const SMALL_SET: usize = 512;
/// A center with a coordinate beyond this many radii is kept in two terms: rounding it to one would cost 8·2⁻⁵³ radii.
const FAR_OFF: f64 = 8.0;

pub(super) struct WorkingSet {
    dim: usize,
    origin: Vec<f64>,
    /// Radius of the largest ball, subtracted from all radii; 0 for points.
    radius_offset: f64,
    ids: Vec<u64>,
    position: HashMap<u64, usize>,
    /// k × d, row-major, relative to the origin.
    rows: Vec<f64>,
    /// Radii less `radius_offset`, so all ≤ 0; all 0 for points.
    radii: Vec<f64>,
    /// Row i, symmetric, `stride` apart.
    gram: Vec<f64>,
    stride: usize,
}

impl WorkingSet {
    /// An empty set. Rows will be taken relative to `origin`, radii relative to `radius_offset`.
    pub(super) fn new(origin: Vec<f64>, radius_offset: f64) -> Self {
        WorkingSet {
            dim: origin.len(),
            origin,
            radius_offset,
            ids: vec![],
            position: HashMap::new(),
            rows: vec![],
            radii: vec![],
            gram: vec![],
            stride: 0,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    pub(super) fn origin(&self) -> &[f64] {
        &self.origin
    }

    pub(super) fn radius_offset(&self) -> f64 {
        self.radius_offset
    }

    pub(super) fn id(&self, i: usize) -> u64 {
        self.ids[i]
    }

    pub(super) fn contains(&self, id: u64) -> bool {
        self.position.contains_key(&id)
    }

    /// Where the item with this row number stands in the set.
    pub(super) fn position(&self, id: u64) -> Option<usize> {
        self.position.get(&id).copied()
    }

    /// The row of item `i`, relative to the origin.
    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.dim..(i + 1) * self.dim]
    }

    /// Its radius, relative to the offset: 0 for a point.
    pub(super) fn radius(&self, i: usize) -> f64 {
        self.radii[i]
    }

    /// Products of item `i` with all items.
    pub(super) fn gram_row(&self, i: usize) -> &[f64] {
        &self.gram[i * self.stride..i * self.stride + self.len()]
    }

    /// The squared norm of item `i`.
    pub(super) fn norm2(&self, i: usize) -> f64 {
        self.gram[i * self.stride + i]
    }

    /// The squared distance of item `i` from a center relative to the origin.
    pub(super) fn squared_distance(&self, i: usize, center: &Center) -> f64 {
        let mut squared = [0.0];
        squared_distances(self.row(i), self.dim, center, &mut squared);
        squared[0]
    }

    /// Σ λᵢ·rowᵢ over the items named.
    pub(super) fn combination(&self, items: &[usize], lambda: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.dim];
        add_combination(&mut sum, lambda, |i| self.row(items[i]));
        sum
    }

    /// The center that the multipliers mean, Σ λᵢpᵢ/Σλᵢ, to twice the precision of `f64`, as one or two terms: two
    /// where rounding it to one would cost more than about 1e-15 of the radius.
    pub(super) fn center(&self, items: &[usize], lambda: &[f64], radius: f64) -> Center {
        let (mut sums, mut errors) = (vec![0.0; self.dim], vec![0.0; self.dim]);
        let mut total = DoubleDouble::ZERO;
        for (&i, &l) in items.iter().zip(lambda) {
            add_scaled_exactly(&mut sums, &mut errors, l, self.row(i));
            total = total + l.into();
        }
        let terms: Vec<DoubleDouble> = (self.origin.iter().zip(sums.into_iter().zip(errors)))
            .map(|(&origin, (sum, error))| DoubleDouble::sum(sum, error) / total + origin.into())
            .collect();
        as_center(&terms, radius)
    }

    /// The center at this offset from the origin.
    pub(super) fn center_at(&self, offset: &[f64], radius: f64) -> Center {
        let terms = self.origin.iter().zip(offset).map(|(&o, &c)| DoubleDouble::sum(o, c));
        as_center(&terms.collect::<Vec<_>>(), radius)
    }

    /// Adds items that are not in the set yet. `rows` holds for each its coordinates, and its radius if `with_radius`.
    pub(super) fn add(&mut self, ids: &[u64], mut rows: Vec<f64>, with_radius: bool) {
        let before = self.len();
        let columns = self.dim + usize::from(with_radius);
        debug_assert_eq!(rows.len(), ids.len() * columns);
        for &id in ids {
            debug_assert!(!self.contains(id));
            self.position.insert(id, self.ids.len());
            self.ids.push(id);
        }
        if with_radius {
            let radius = |row: &[f64]| row[self.dim] - self.radius_offset;
            self.radii.extend(rows.chunks_exact(columns).map(radius));
        } else {
            self.radii.resize(self.ids.len(), 0.0);
        }
        if before == 0 && !with_radius {
            // Most often the largest batch, which need not be copied.
            for row in rows.chunks_exact_mut(columns) {
                row.iter_mut().zip(&self.origin).for_each(|(x, o)| *x -= o);
            }
            self.rows = rows;
        } else {
            self.rows.reserve(ids.len() * self.dim);
            for row in rows.chunks_exact(columns) {
                self.rows.extend(row.iter().zip(&self.origin).map(|(x, o)| x - o));
            }
        }
        self.grow(before);
        self.multiply(before);
    }

    /// Makes room for all items in the Gram matrix; the first `before` are kept.
    fn grow(&mut self, before: usize) {
        let k = self.len();
        if k <= self.stride {
            return;
        }
        // A small set has room for a small second batch: of 10⁴ × 1000 normal points 20 come after 128.
        let room = if k <= SMALL_SET { k + k / 4 } else { k };
        let stride = (2 * self.stride).max(room).next_multiple_of(8);
        let mut gram = vec![0.0; stride * stride];
        for i in 0..before {
            gram[i * stride..i * stride + before]
                .copy_from_slice(&self.gram[i * self.stride..][..before]);
        }
        (self.gram, self.stride) = (gram, stride);
    }

    /// New rows times all rows.
    fn multiply(&mut self, before: usize) {
        let (k, dim) = (self.len(), self.dim);
        let columns = tile_columns(k);
        let rows = |range: Range<usize>| {
            let count = range.len();
            Matrix::from_rows(&self.rows[range.start * dim..range.end * dim], count, dim)
        };
        // Of rows that are new as columns are, those before them have been multiplied by an earlier tile.
        let tile = |first: usize| {
            let (end, start) = (k.min(first + columns), before.max(first));
            let mut product = vec![0.0; (k - start) * (end - first)];
            let target = MatrixMut::from_rows(&mut product, k - start, end - first);
            set_product(target, rows(start..k), rows(first..end).transpose());
            (first..end, start, product)
        };
        let firsts: Vec<usize> = (0..k).step_by(columns).collect();
        let tiles: Vec<_> = if (k - before) * k * dim < 1 << 18 {
            firsts.into_iter().map(tile).collect()
        } else {
            firsts.into_par_iter().map(tile).collect()
        };
        for (columns, start, product) in tiles {
            for (i, row) in (start..k).zip(product.chunks_exact(columns.len())) {
                self.gram[i * self.stride + columns.start..][..columns.len()].copy_from_slice(row);
                for (j, &value) in columns.clone().zip(row) {
                    self.gram[j * self.stride + i] = value;
                }
            }
        }
    }
}

/// One term for each coordinate, or two where rounding to one would cost more than about 1e-15 of the radius.
fn as_center(terms: &[DoubleDouble], radius: f64) -> Center {
    let high: Vec<f64> = terms.iter().map(|term| term.high).collect();
    let largest = high.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if radius == 0.0 || largest > FAR_OFF * radius {
        return Center { high, low: terms.iter().map(|term| term.low).collect() };
    }
    // A coordinate near 0 would keep digits far below the rounding of the others, and of all distances: a center
    // that should be 0 would be 1e-17 and cost the radius an ulp.
    let grid = two_to(exponent_of(radius) - 53);
    Center {
        high: high.into_iter().map(|c| (c / grid).round() * grid + 0.0).collect(),
        low: vec![],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_kernels::vector::dot;
    use taut_points::{Distribution, generate};

    #[test]
    fn the_gram_matrix_is_right_however_the_set_grew() {
        let (n, dim) = (300, 37);
        let rows: Vec<f64> = generate(Distribution::Normal, n, dim, 4).unwrap();
        let mut set = WorkingSet::new(vec![0.5; dim], 0.0);
        for (first, end) in [(0, 1), (1, 20), (20, 150), (150, 300)] {
            let ids: Vec<u64> = (first..end).collect();
            set.add(&ids, rows[first as usize * dim..end as usize * dim].to_vec(), false);
        }
        assert_eq!(
            (set.len(), set.id(7), set.contains(299), set.contains(300)),
            (300, 7, true, false)
        );
        for i in 0..n {
            for j in 0..n {
                let wanted = dot(set.row(i), set.row(j));
                assert!((set.gram_row(i)[j] - wanted).abs() < 1e-11, "{i}, {j}");
            }
        }
    }

    #[test]
    fn radii_are_relative_to_the_largest() {
        let mut set = WorkingSet::new(vec![1.0, 1.0], 5.0);
        set.add(&[3, 8], vec![1.0, 2.0, 5.0, 4.0, 5.0, 0.5], true);
        assert_eq!((set.radius(0), set.radius(1)), (0.0, -4.5));
        assert_eq!(set.row(1), [3.0, 4.0]);
        assert_eq!(set.norm2(1), 25.0);
    }
}
