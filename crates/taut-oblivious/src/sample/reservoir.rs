//! k of a stream whose length nobody knows.
//!
//! *Idea.* Give each item a random number; the k items with the smallest ones are the sample. How many items come before
//! the next one with a number below the largest of these can be drawn at once, so that the others cost a decrement.
//! *Guarantee.* After any number of items, each set of k of them is kept with the same probability, up to the rounding
//! of `ln` and `exp`. O(k (1 + log (n/k))) random numbers.
//! *Trap.* Places in the reservoir are no sample of their own: the first one holds early items more often than late ones.
//! *Reference.* K.-H. Li, *Reservoir-sampling algorithms of time complexity O(n(1 + log(N/n)))*, TOMS 20(4), 1994
//! (algorithm L).

use super::random::Random;

/// Keeps a uniform sample of the items it is given.
///
/// ```
/// let mut reservoir = taut_oblivious::Reservoir::new(1, 3);
/// (0..1000).for_each(|i| reservoir.push(i));
/// assert_eq!(reservoir.items().len(), 3);
/// ```
#[derive(Clone, Debug)]
pub struct Reservoir<T> {
    random: Random,
    k: usize,
    items: Vec<T>,
    seen: u64,
    /// Items to let pass before the next one is kept.
    pass: u64,
    /// The largest of the random numbers of the items that are kept.
    largest: f64,
}

impl<T> Reservoir<T> {
    /// An empty reservoir for `k` items.
    pub fn new(seed: u64, k: usize) -> Self {
        let random = Random::new(seed, 0);
        Self { random, k, items: Vec::new(), seen: 0, pass: 0, largest: 1.0 }
    }

    /// Offers an item.
    pub fn push(&mut self, item: T) {
        self.seen = self.seen.saturating_add(1);
        if self.items.len() < self.k {
            self.items.push(item);
            if self.items.len() == self.k {
                self.draw();
            }
        } else if self.pass > 0 {
            self.pass -= 1;
        } else if self.k > 0 {
            let place = self.random.below(self.k as u64) as usize;
            self.items[place] = item;
            self.draw();
        }
    }

    /// Returns how many of the next items are not kept, so that a source that can leave items out may do so.
    pub fn passing(&self) -> u64 {
        if self.k == 0 { u64::MAX } else { self.pass }
    }

    /// Says that `items` items were left out.
    ///
    /// # Panics
    /// If they are more than [`Self::passing`].
    pub fn leave_out(&mut self, items: u64) {
        assert!(items <= self.passing(), "{items} of {} may be left out", self.passing());
        self.seen = self.seen.saturating_add(items);
        if self.k > 0 {
            self.pass -= items;
        }
    }

    /// The sample so far, in no particular order: all items while there were at most k.
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// The sample, in no particular order.
    pub fn into_items(self) -> Vec<T> {
        self.items
    }

    /// Items offered or left out so far; 2⁶⁴ − 1 if they are more.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    /// Draws how many items pass.
    fn draw(&mut self) {
        self.largest *= (self.random.unit().ln() / self.k as f64).exp();
        // As a float beyond 2⁶⁴ this is the largest integer: no stream is that long.
        self.pass = (self.random.unit().ln() / (-self.largest).ln_1p()).floor() as u64;
    }
}
