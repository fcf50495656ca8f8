//! The cells of a branch and bound that wait to be split, the largest bound first.
//!
//! *Batches.* Some cells of the largest bounds are split at once, so that threads can examine their children side by side. How many
//! depends on how many wait, not on the number of threads: so neither does the answer.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The part of the waiting cells that a batch takes: a larger one splits more cells that a better answer would have closed.
const BATCH_PART: usize = 3;

/// Cells of a batch at least, and at most: threads get work for some milliseconds at a time. Each cell is a task, as some cost many times as
/// much as others.
const BATCH_CELLS: [usize; 2] = [64, 1024];

/// A cell that waits, with its place in the tree.
pub(crate) struct Waiting<T> {
    pub(crate) bound: f64,
    pub(crate) node: usize,
    pub(crate) cell: T,
}

/// Cells that wait, and the largest bound of those that never will.
pub(crate) struct Frontier<T> {
    waiting: BinaryHeap<Waiting<T>>,
    done: f64,
}

impl<T> Frontier<T> {
    pub(crate) fn new() -> Self {
        Frontier { waiting: BinaryHeap::new(), done: 0.0 }
    }

    /// Takes a cell to be split.
    pub(crate) fn push(&mut self, bound: f64, node: usize, cell: T) {
        self.waiting.push(Waiting { bound, node, cell });
    }

    /// Takes the bound of a cell that is not split any more.
    pub(crate) fn close(&mut self, bound: f64) {
        self.done = self.done.max(bound);
    }

    /// The largest bound of all cells; 0 without one.
    pub(crate) fn upper(&self) -> f64 {
        self.largest().max(self.done)
    }

    /// Whether the bounds of all waiting cells are at most `goal`.
    pub(crate) fn is_within(&self, goal: f64) -> bool {
        self.largest() <= goal
    }

    /// Takes out the cell of the largest bound if that is above `goal`.
    pub(crate) fn pop(&mut self, goal: f64) -> Option<Waiting<T>> {
        if self.is_within(goal) { None } else { self.waiting.pop() }
    }

    /// Takes out cells of the largest bounds above `goal`, at most `most`.
    pub(crate) fn batch(&mut self, goal: f64, most: usize) -> Vec<Waiting<T>> {
        let [least, greatest] = BATCH_CELLS;
        let count = (self.waiting.len() / BATCH_PART).clamp(least, greatest).min(most);
        (0..count).map_while(|_| self.pop(goal)).collect()
    }

    fn largest(&self) -> f64 {
        self.waiting.peek().map_or(0.0, |top| top.bound)
    }
}

impl<T> Ord for Waiting<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.node.cmp(&self.node))
    }
}

impl<T> PartialOrd for Waiting<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for Waiting<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Waiting<T> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_take_the_largest_bounds_above_the_goal_and_of_equal_ones_the_first() {
        let mut frontier = Frontier::new();
        for node in 0..1000 {
            frontier.push(f64::from(node as u32 % 100), node, ());
        }
        frontier.close(50.0);
        assert_eq!(frontier.upper(), 99.0);
        let places = |batch: Vec<Waiting<()>>| -> Vec<(f64, usize)> {
            batch.iter().map(|waiting| (waiting.bound, waiting.node)).collect()
        };
        let first = places(frontier.batch(90.0, 12));
        let tens = (0..10).map(|ten| (99.0, 100 * ten + 99));
        assert_eq!(first, tens.chain([(98.0, 98), (98.0, 198)]).collect::<Vec<_>>());
        assert_eq!(frontier.batch(40.0, 1000).len(), 988 / BATCH_PART);
        while !frontier.batch(90.0, 1000).is_empty() {}
        assert!(frontier.is_within(90.0) && frontier.upper() <= 90.0);
        while frontier.pop(0.0).is_some() {}
        assert_eq!(frontier.upper(), 50.0);
    }
}
