//! Sorts of few items, compiled once for each type of item.
//!
//! A sort of the standard library is compiled for each closure, which takes ten kilobytes; there are hundreds of them, and most sort a few
//! items. Here the order is called through a pointer, so these are not for hot loops, nor for many items.

use std::cmp::Ordering;

/// Sorts of slices outside of hot loops.
pub trait OrderBy<T> {
    /// Sorts; equal items stay in their order.
    ///
    /// ```
    /// use taut_points::OrderBy;
    ///
    /// let mut numbers = [2.0, 1.0, 3.0];
    /// numbers.order_by(&|a, b| f64::total_cmp(b, a));
    /// assert_eq!(numbers, [3.0, 2.0, 1.0]);
    /// ```
    fn order_by(&mut self, compare: &dyn Fn(&T, &T) -> Ordering);

    /// Sorts by a key, which is computed at each comparison; items of equal keys stay in their order.
    fn order_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K) {
        self.order_by(&|a, b| key(a).cmp(&key(b)));
    }
}

impl<T> OrderBy<T> for [T] {
    #[inline(never)]
    fn order_by(&mut self, compare: &dyn Fn(&T, &T) -> Ordering) {
        self.sort_by(compare);
    }
}
