//! k of n without replacement, in order: divide and conquer.
//!
//! *Idea.* How many of the k numbers fall into the lower half of the range is a hypergeometric number; both halves are then
//! independent. Below a few thousand numbers, draw, sort and draw again for those that came twice; where the range is
//! densely filled, a set of bits takes the place of sorting.
//! *Guarantee.* Each set of k numbers comes with the same probability, up to the rounding of hypergeometric numbers. O(k)
//! for any n below 2⁶⁴; each node has random numbers of its own, so threads change nothing.
//! *Trap.* Drawing k numbers and dropping those that come twice gives too few; dropping some of too many favors sets.
//! Drawing on until k are different is exact, since the next new number is any of those not yet drawn, all equally likely.
//! *Reference.* P. Sanders, S. Lamm, L. Hübschle-Schneider, E. Schrade, C. Dachsbacher, *Efficient parallel random
//! sampling: vectorized, cache-efficient, and online*, TOMS 44(3), 2018.

use taut_points::{shown_number, try_reserve_exact};

use super::random::Random;
use super::weights::{binomial, hypergeometric};
use crate::error::Error;
use crate::sort::sort;

/// Up to this many numbers are drawn without dividing: their sort stays within the second-level cache.
const LEAF_NUMBERS: u64 = 1 << 12;
/// A range of fewer than this many numbers for each that is drawn is dense.
const DENSE_RATIO_MAX: u64 = 64;
/// Up to this many missing numbers are put in their places one by one.
const MISSING_MAX: usize = 32;
/// The halves may go to two threads from this many numbers on.
const SHARED_NUMBERS_MIN: u64 = 1 << 15;

/// `k` different numbers below `n`, in order: a set drawn uniformly from all sets of that size.
///
/// Runs on the current rayon pool. O(k) time, for any `n` up to 2⁶⁴ − 1.
///
/// # Errors
/// [`Error::Option`] if `k` is more than `n`, or more than the system gives memory for. Systems that give more than they
/// have end the process instead.
///
/// ```
/// let found = taut_oblivious::sample(7, 1 << 40, 5)?;
/// assert!(found.len() == 5 && found.is_sorted_by(|a, b| a < b) && found[4] < 1 << 40);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn sample(seed: u64, n: u64, k: u64) -> Result<Vec<u64>, Error> {
    if k > n {
        let expected = "at most the number of those to choose from";
        return Err(Error::Option { name: "k", value: k.to_string(), expected });
    }
    let mut found = room(k)?;
    found.resize(k as usize, 0);
    divide::<LEAF_NUMBERS>(Node { seed, number: 1, start: 0, n }, &mut found);
    Ok(found)
}

/// Room for `k` numbers, empty.
fn room(k: u64) -> Result<Vec<u64>, Error> {
    let mut room = Vec::new();
    if usize::try_from(k).is_ok_and(|k| try_reserve_exact(&mut room, k).is_ok()) {
        return Ok(room);
    }
    let expected = "as many numbers as there is memory for";
    Err(Error::Option { name: "k", value: k.to_string(), expected })
}

/// The numbers below `n`, in order, that are kept when each is kept with probability `p`, independently.
///
/// Runs on the current rayon pool. O(np) time.
///
/// # Errors
/// [`Error::Option`] if `p` is not in [0, 1], or if these are more numbers than memory holds.
pub fn bernoulli(seed: u64, n: u64, p: f64) -> Result<Vec<u64>, Error> {
    if !(0.0..=1.0).contains(&p) {
        let expected = "a probability, 0 to 1";
        return Err(Error::Option { name: "p", value: shown_number(p), expected });
    }
    // Before a number is drawn with so large a variance.
    room((n as f64 * p) as u64)?;
    // Given their number, all sets are equally likely. Node 0 is none of the sample's.
    let k = binomial(&mut Random::new(seed, 0), n, p);
    sample(seed, n, k)
}

/// A range of numbers, and its place in the tree of halves: the root is 1, children are 2i and 2i + 1.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) seed: u64,
    pub(super) number: u64,
    pub(super) start: u64,
    pub(super) n: u64,
}

/// Draws `found.len()` numbers from `node.start..node.start + node.n`; leaves have up to `LEAF_NUMBERS` numbers.
pub(super) fn divide<const LEAF_NUMBERS: u64>(node: Node, found: &mut [u64]) {
    let (k, Node { seed, number, start, n }) = (found.len() as u64, node);
    let mut random = Random::new(seed, number);
    if k <= LEAF_NUMBERS {
        return leaf(&mut random, start, n, found);
    }
    // A range holds more numbers than are drawn from it, so this ends above 2⁶³ nodes.
    let half = n / 2;
    let low = hypergeometric(&mut random, n, half, k);
    let (below, above) = found.split_at_mut(low as usize);
    let lower = Node { number: 2 * number, n: half, ..node };
    let upper = Node { number: 2 * number + 1, start: start + half, n: n - half, ..node };
    if k >= SHARED_NUMBERS_MIN && rayon::current_num_threads() > 1 {
        taut_points::parallel::join(
            || divide::<LEAF_NUMBERS>(lower, below),
            || divide::<LEAF_NUMBERS>(upper, above),
        );
    } else {
        divide::<LEAF_NUMBERS>(lower, below);
        divide::<LEAF_NUMBERS>(upper, above);
    }
}

fn leaf(random: &mut Random, start: u64, n: u64, found: &mut [u64]) {
    let k = found.len() as u64;
    if k == n {
        // All of them.
        found.iter_mut().zip(start..).for_each(|(place, number)| *place = number);
    } else if n / DENSE_RATIO_MAX < k {
        dense(random, start, n, found);
    } else {
        sparse(random, start, n, found);
    }
}

/// Draws until all are different; there are many more to choose from.
fn sparse(random: &mut Random, start: u64, n: u64, found: &mut [u64]) {
    let mut different = 0;
    while found.len() - different > MISSING_MAX {
        found[different..].fill_with(|| start + random.below(n));
        sort(found);
        different = distinct(found);
    }
    while different < found.len() {
        let number = start + random.below(n);
        if let Err(place) = found[..different].binary_search(&number) {
            found.copy_within(place..different, place + 1);
            found[place] = number;
            different += 1;
        }
    }
}

/// Moves numbers that differ from the one before to the front, and counts them.
fn distinct(sorted: &mut [u64]) -> usize {
    if sorted.windows(2).fold(true, |yes, pair| yes & (pair[0] < pair[1])) {
        return sorted.len();
    }
    let mut different = 1;
    for i in 1..sorted.len() {
        if sorted[i] != sorted[different - 1] {
            sorted[different] = sorted[i];
            different += 1;
        }
    }
    different
}

/// Marks numbers in a set of bits: those that are drawn, or if these are more than half, the others.
fn dense(random: &mut Random, start: u64, n: u64, found: &mut [u64]) {
    let mut bits = vec![0u64; n.div_ceil(64) as usize];
    let k = found.len() as u64;
    let (marks, keep) = if k <= n / 2 { (k, true) } else { (n - k, false) };
    let mut marked = 0;
    while marked < marks {
        let number = random.below(n);
        let (word, bit) = (&mut bits[(number / 64) as usize], 1 << (number % 64));
        marked += u64::from(*word & bit == 0);
        *word |= bit;
    }
    let mut places = found.iter_mut();
    for (i, &word) in bits.iter().enumerate() {
        let from = 64 * i as u64;
        let mut left = if keep { word } else { !word };
        if n - from < 64 {
            left &= (1 << (n - from)) - 1;
        }
        while left != 0 {
            if let Some(place) = places.next() {
                *place = start + from + u64::from(left.trailing_zeros());
            }
            left &= left - 1;
        }
    }
}
