//! List ranking: how far each element of a linked list is from its end, by sorting instead of walking.
//!
//! *Problem.* Walking costs a miss per element, as neighbors in a list are no neighbors in memory.
//! *Idea.* Each element throws a coin; one with heads whose successor has tails is taken out, its weight added to that of
//! its predecessors. No two neighbors are taken out, so two sorts do it: by successor to meet the elements taken out,
//! and back by number. Rank the rest, at most three quarters of the elements expected, and put the others back in.
//! *Guarantee.* O(sort(n)) misses expected, with [`funnelsort()`](super::funnelsort()); several lists at once, also such
//! that run into one another.
//! *Trap.* A circle has no end. It is taken out down to an element that is its own successor, and reported.
//! *Reference.* Chiang et al., *External-memory graph algorithms*, SODA 1995; the thesis, 5.8.

use super::funnelsort::funnelsort_instrumented;
use super::random::mix;
use super::{get, set};
use crate::{Error, NoProbe, Probe};

/// Stands for the successor of a last element.
pub const LIST_END: u32 = u32::MAX;

/// Up to this many elements are walked.
const WALKED_MAX: usize = 16;

/// The number of steps from each element to the last of its list, which has the successor [`LIST_END`]. `seed` throws
/// the coins and changes nothing but the cost.
///
/// # Errors
/// [`Error::Option`] if a successor is no element, or if there is a circle.
pub fn list_ranks(next: &[u32], seed: u64) -> Result<Vec<u64>, Error> {
    list_ranks_instrumented(next, seed, &mut NoProbe)
}

/// [`list_ranks()`] under a probe. The answer is announced and stays so, for those who read it.
///
/// # Errors
/// As there.
pub fn list_ranks_instrumented<P: Probe>(
    next: &[u32],
    seed: u64,
    probe: &mut P,
) -> Result<Vec<u64>, Error> {
    probe.place(next);
    if next.len() >= LIST_END as usize {
        return Err(wrong(format!("{} elements", next.len()), "fewer than 2^32 - 1 elements"));
    }
    let mut links = Pile::with_capacity(next.len(), probe);
    for i in 0..next.len() {
        let to = get(next, i, probe);
        if to != LIST_END && to as usize >= next.len() {
            return Err(wrong(format!("{to} behind element {i}"), "the number of an element"));
        }
        links.push((i as u32, to, u64::from(to != LIST_END)), probe);
    }
    let ranked = rank(links, seed, probe)?;
    let mut ranks = vec![0; next.len()];
    probe.place(&ranks);
    for i in 0..ranked.0.len() {
        let (element, _, rank) = get(&ranked.0, i, probe);
        set(&mut ranks, element as usize, rank, probe);
    }
    ranked.lift(probe);
    Ok(ranks)
}

fn wrong(value: String, expected: &'static str) -> Error {
    Error::Option { name: "next", value, expected }
}

fn circle(element: u32) -> Error {
    wrong(format!("a circle through element {element}"), "lists that end")
}

/// Element, successor and steps to it; or successor, element and steps; or element, anything and rank.
type Link = (u32, u32, u64);

/// An array that is filled from its start.
struct Pile(Vec<Link>);

impl Pile {
    fn with_capacity<P: Probe>(capacity: usize, probe: &mut P) -> Self {
        let links = Vec::with_capacity(capacity);
        probe.place_at(links.as_ptr() as usize, capacity * size_of::<Link>());
        Self(links)
    }

    fn push<P: Probe>(&mut self, link: Link, probe: &mut P) {
        self.0.push(link);
        if let Some(last) = self.0.last() {
            probe.write(std::slice::from_ref(last));
        }
    }

    /// Sorted by the first number, which becomes the second one's place.
    fn turned<P: Probe>(mut self, probe: &mut P) -> Self {
        for i in 0..self.0.len() {
            let (a, b, weight) = get(&self.0, i, probe);
            set(&mut self.0, i, (b, a, weight), probe);
        }
        funnelsort_instrumented(&mut self.0, probe);
        self
    }

    fn lift<P: Probe>(self, probe: &mut P) {
        probe.lift_from(self.0.as_ptr() as usize);
    }
}

/// Ranks of the elements of `links`, both in ascending order of elements.
fn rank<P: Probe>(links: Pile, seed: u64, probe: &mut P) -> Result<Pile, Error> {
    let n = links.0.len();
    if n <= WALKED_MAX {
        return walk(links, probe);
    }
    let heads = |element: u32| mix(seed ^ mix(u64::from(element))) & 1 == 1;
    let mut out = Pile::with_capacity(n, probe);
    let mut rest = Pile::with_capacity(n, probe);
    for i in 0..n {
        let (element, next, weight) = get(&links.0, i, probe);
        if element == next {
            return Err(circle(element));
        }
        let leaves = heads(element) && (next == LIST_END || !heads(next));
        if leaves { &mut out } else { &mut rest }.push((element, next, weight), probe);
    }
    links.lift(probe);
    // By successor, as the elements taken out are by number: a scan of both bridges the gaps.
    let mut rest = rest.turned(probe);
    let mut gone = 0;
    for i in 0..rest.0.len() {
        let (next, element, weight) = get(&rest.0, i, probe);
        while gone < out.0.len() && get(&out.0, gone, probe).0 < next {
            gone += 1;
        }
        if gone < out.0.len() {
            let (skipped, behind, more) = get(&out.0, gone, probe);
            if skipped == next {
                set(&mut rest.0, i, (behind, element, weight + more), probe);
            }
        }
    }
    let ranked = rank(rest.turned(probe), mix(seed), probe)?;
    // Those taken out stand before elements that stayed, or at an end.
    let mut out = out.turned(probe);
    let mut met = 0;
    for i in 0..out.0.len() {
        let (next, element, weight) = get(&out.0, i, probe);
        let mut behind = 0;
        if next != LIST_END {
            while get(&ranked.0, met, probe).0 < next {
                met += 1;
            }
            behind = get(&ranked.0, met, probe).2;
        }
        set(&mut out.0, i, (next, element, weight + behind), probe);
    }
    let out = out.turned(probe);
    let merged = merge(&out, &ranked, probe);
    out.lift(probe);
    ranked.lift(probe);
    Ok(merged)
}

fn merge<P: Probe>(a: &Pile, b: &Pile, probe: &mut P) -> Pile {
    let mut merged = Pile::with_capacity(a.0.len() + b.0.len(), probe);
    let (mut i, mut j) = (0, 0);
    while i < a.0.len() || j < b.0.len() {
        let from_a =
            j == b.0.len() || (i < a.0.len() && get(&a.0, i, probe).0 < get(&b.0, j, probe).0);
        if from_a {
            merged.push(get(&a.0, i, probe), probe);
            i += 1;
        } else {
            merged.push(get(&b.0, j, probe), probe);
            j += 1;
        }
    }
    merged
}

/// Ranks of few elements, step by step.
fn walk<P: Probe>(mut links: Pile, probe: &mut P) -> Result<Pile, Error> {
    let n = links.0.len();
    let mut ranks = [0; WALKED_MAX];
    for start in 0..n {
        let (element, mut next, mut rank) = get(&links.0, start, probe);
        let mut steps = 0;
        while next != LIST_END {
            steps += 1;
            if steps > n {
                return Err(circle(element));
            }
            for i in 0..n {
                let (other, behind, weight) = get(&links.0, i, probe);
                if other == next {
                    (next, rank) = (behind, rank + weight);
                    break;
                }
            }
        }
        ranks[start] = rank;
    }
    for i in 0..n {
        let (element, next, _) = get(&links.0, i, probe);
        set(&mut links.0, i, (element, next, ranks[i]), probe);
    }
    Ok(links)
}
