//! Sorts of few items, compiled once for all types of items.
//!
//! A sort of the standard library is compiled for each type and closure, which takes five kilobytes; there are hundreds of them, and most
//! sort a few items. Here numbers are sorted, by an order that is called through a pointer, and the items then brought to their places: not
//! for hot loops, nor for many items, which take 12 bytes more each.

use std::cmp::Ordering;

/// Up to this many items are inserted one after the other, which takes no memory.
const INSERTED_MAX: usize = 16;

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

    /// Sorts by the order of the type; equal items stay in their order.
    fn order(&mut self)
    where
        T: Ord,
    {
        self.order_by(&T::cmp);
    }
}

impl<T> OrderBy<T> for [T] {
    #[inline(never)]
    fn order_by(&mut self, compare: &dyn Fn(&T, &T) -> Ordering) {
        if self.len() <= INSERTED_MAX {
            for end in 1..self.len() {
                let mut at = end;
                while at > 0 && compare(&self[at - 1], &self[at]) == Ordering::Greater {
                    self.swap(at - 1, at);
                    at -= 1;
                }
            }
            return;
        }
        let order = numbers_in_order(self.len(), &|a, b| compare(&self[a], &self[b]));
        bring_to_places(self, order);
    }
}

/// Brings item `order[i]` to place i, for all i, in O(n) and without further memory.
///
/// ```
/// let mut items = ["b", "c", "a"];
/// taut_points::bring_to_places(&mut items, vec![2, 0, 1]);
/// assert_eq!(items, ["a", "b", "c"]);
/// ```
///
/// # Panics
/// If `order` has another length than `items`, or a number that is none of an item. If it lists an item twice, the items end
/// in some order.
pub fn bring_to_places<T>(items: &mut [T], mut order: Vec<usize>) {
    assert_eq!(items.len(), order.len());
    // Each cycle of the permutation is followed once; a place that has its item is then a cycle of its own.
    for start in 0..items.len() {
        let mut place = start;
        while order[place] != start && order[place] != place {
            let from = std::mem::replace(&mut order[place], place);
            items.swap(place, from);
            place = from;
        }
        order[place] = place;
    }
}

/// The numbers below `n` by an order, equal ones ascending.
fn numbers_in_order(n: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| compare(a, b));
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn as_the_stable_sort_of_the_standard_library(
            keys in prop_oneof![prop::collection::vec(0u8..20, 0..60), prop::collection::vec(0u8..20, 3000)],
        ) {
            let mut items: Vec<(u8, String)> =
                keys.iter().enumerate().map(|(i, &key)| (key, i.to_string())).collect();
            let mut expected = items.clone();
            expected.sort_by_key(|item| item.0);
            items.order_by_key(|item| item.0);
            prop_assert_eq!(&items, &expected);
            items.order();
            expected.sort();
            prop_assert_eq!(items, expected);
        }
    }
}
