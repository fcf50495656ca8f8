//! A cycle of nodes as an array, with the place of each node.
//!
//! *Idea.* A move replaces edges by reversing runs of the array; of a run and the rest, the shorter is reversed, as a cycle read
//! backwards is the same cycle. What was reversed is noted on request, so that moves can be taken back.
//! *Trap.* After a reversal of the rest the cycle runs the other way: callers name edges by both their ends.

/// A cyclic order of nodes 0, 1, ….
#[derive(Clone, Debug)]
pub(super) struct Cycle {
    order: Vec<u32>,
    place: Vec<u32>,
    /// Runs that were reversed, if they are to be noted: first place and length.
    journal: Vec<[u32; 2]>,
    noting: bool,
}

impl Cycle {
    pub(super) fn new(order: Vec<u32>) -> Self {
        let mut place = vec![0; order.len()];
        (0u32..).zip(&order).for_each(|(at, &node)| place[node as usize] = at);
        Self { order, place, journal: Vec::new(), noting: false }
    }

    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    #[inline(always)]
    pub(super) fn place(&self, node: u32) -> u32 {
        self.place[node as usize]
    }

    /// The node at a place, which is counted around.
    #[inline(always)]
    pub(super) fn at(&self, place: usize) -> u32 {
        let n = self.order.len();
        self.order[if place < n { place } else { place - n }]
    }

    #[inline(always)]
    pub(super) fn next(&self, node: u32) -> u32 {
        self.at(self.place[node as usize] as usize + 1)
    }

    #[inline(always)]
    pub(super) fn prev(&self, node: u32) -> u32 {
        let place = self.place[node as usize] as usize;
        self.order[if place == 0 { self.order.len() - 1 } else { place - 1 }]
    }

    /// The neighbor ahead, for one who reads forward, or backward.
    #[inline(always)]
    pub(super) fn ahead(&self, node: u32, forward: bool) -> u32 {
        if forward { self.next(node) } else { self.prev(node) }
    }

    /// Returns how many steps ahead of `from` a node is.
    #[inline(always)]
    pub(super) fn steps(&self, from: u32, node: u32, forward: bool) -> u32 {
        let (a, b) = (self.place[from as usize], self.place[node as usize]);
        let (a, b) = if forward { (a, b) } else { (b, a) };
        if b >= a { b - a } else { b + self.order.len() as u32 - a }
    }

    /// Replaces edges ab and cd by ac and bd, where b is ahead of a as d is of c, one way or the other.
    pub(super) fn swap_edges(&mut self, a: u32, b: u32, c: u32, d: u32) {
        let (first, last) = if self.next(a) == b { (b, c) } else { (a, d) };
        self.reverse(self.place(first) as usize, self.place(last) as usize);
    }

    /// From x₁→x₂ … y₁→y₂ … z₁→z₂, one way or the other, to x₁→y₂ … z₁→x₂ … y₁→z₂: two runs change places.
    pub(super) fn exchange_runs(&mut self, x: [u32; 2], y: [u32; 2], z: [u32; 2]) {
        let forward = self.next(x[0]) == x[1];
        let runs = [
            self.steps(x[1], y[0], forward),
            self.steps(y[1], z[0], forward),
            self.steps(z[1], x[0], forward),
        ];
        // The same move takes any two of the three runs; the longest stays.
        let (x, y, z) = match (0..3).max_by_key(|&k| (runs[k], k)) {
            Some(0) => (y, z, x),
            Some(1) => (z, x, y),
            _ => (x, y, z),
        };
        self.swap_edges(x[0], x[1], z[0], z[1]);
        self.swap_edges(x[0], z[0], y[1], y[0]);
        self.swap_edges(z[0], y[0], x[1], z[1]);
    }

    /// Takes a node out and puts it between two neighbors of each other.
    pub(super) fn insert_between(&mut self, node: u32, a: u32, b: u32) {
        let (a, b) = if self.next(a) == b { (a, b) } else { (b, a) };
        let (before, after) = (self.prev(node), self.next(node));
        self.exchange_runs([before, node], [node, after], [a, b]);
    }

    /// Three runs that follow one another, the first after place `at`, from S₁S₂S₃ to S₃S₂S₁: the double bridge.
    pub(super) fn double_bridge(&mut self, at: usize, lengths: [usize; 3]) {
        let n = self.len();
        let [a, b, c] = lengths;
        let begin = at + 1;
        let mut flip = |from: usize, len: usize| self.reverse_run(from % n, len);
        flip(begin, a + b + c);
        flip(begin, c);
        flip(begin + c, b);
        flip(begin + c + b, a);
    }

    /// Reverses from one place to another, or the rest.
    fn reverse(&mut self, first: usize, last: usize) {
        let n = self.order.len();
        let len = (if last >= first { last - first } else { last + n - first }) + 1;
        if 2 * len <= n {
            self.reverse_run(first, len);
        } else {
            let after = last + 1;
            self.reverse_run(if after == n { 0 } else { after }, n - len);
        }
    }

    fn reverse_run(&mut self, first: usize, len: usize) {
        if self.noting {
            self.journal.push([first as u32, len as u32]);
        }
        let n = self.order.len();
        if len < 2 {
            return;
        }
        let last = first + len - 1;
        if last < n {
            self.order[first..=last].reverse();
            for place in first..=last {
                self.place[self.order[place] as usize] = place as u32;
            }
            return;
        }
        let (mut i, mut j) = (first, last - n);
        for _ in 0..len / 2 {
            self.order.swap(i, j);
            self.place[self.order[i] as usize] = i as u32;
            self.place[self.order[j] as usize] = j as u32;
            i = if i + 1 == n { 0 } else { i + 1 };
            j = if j == 0 { n - 1 } else { j - 1 };
        }
    }

    /// Notes what is reversed from now on.
    pub(super) fn note(&mut self) {
        self.journal.clear();
        self.noting = true;
    }

    /// Takes back all that was noted.
    pub(super) fn take_back(&mut self) {
        self.noting = false;
        while let Some([first, len]) = self.journal.pop() {
            self.reverse_run(first as usize, len as usize);
        }
        self.noting = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(cycle: &Cycle) -> Vec<[u32; 2]> {
        let mut edges: Vec<_> =
            (0..cycle.len() as u32).map(|v| [v.min(cycle.next(v)), v.max(cycle.next(v))]).collect();
        edges.sort_unstable();
        edges
    }

    /// A move against the edges it says it replaces, for all choices on cycles of 4 to 9 nodes read both ways.
    #[test]
    fn moves_replace_the_edges_they_name() {
        for n in 4..10u32 {
            for backward in [false, true] {
                let order: Vec<u32> =
                    if backward { (0..n).rev().collect() } else { (0..n).collect() };
                let next = |v: u32| (v + 1) % n;
                let start = Cycle::new(order);
                let check = |changed: &Cycle, out: &[[u32; 2]], new: &[[u32; 2]]| {
                    let sorted = |e: &[u32; 2]| [e[0].min(e[1]), e[0].max(e[1])];
                    let mut want = edges(&start);
                    for e in out {
                        let at = want.iter().position(|w| *w == sorted(e)).expect("an edge");
                        want.remove(at);
                    }
                    want.extend(new.iter().map(sorted));
                    want.sort_unstable();
                    assert_eq!(edges(changed), want, "{n} {out:?}");
                };
                for a in 0..n {
                    for c in (0..n).filter(|&c| c != a) {
                        let mut cycle = start.clone();
                        cycle.note();
                        cycle.swap_edges(a, next(a), c, next(c));
                        check(&cycle, &[[a, next(a)], [c, next(c)]], &[[a, c], [next(a), next(c)]]);
                        cycle.take_back();
                        assert_eq!(cycle.order(), start.order());
                    }
                    for (i, j) in (1..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
                        let [y, z] = [i, j].map(|k| (a + k) % n);
                        let mut cycle = start.clone();
                        cycle.exchange_runs([a, next(a)], [y, next(y)], [z, next(z)]);
                        let out = [[a, next(a)], [y, next(y)], [z, next(z)]];
                        check(&cycle, &out, &[[a, next(y)], [z, next(a)], [y, next(z)]]);
                    }
                    for b in (0..n).filter(|&b| b != a && next(b) != a) {
                        let mut cycle = start.clone();
                        cycle.insert_between(a, next(b), b);
                        assert_eq!(
                            [next(b), b].map(|v| cycle.next(a) == v || cycle.prev(a) == v),
                            [true; 2]
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_double_bridge_changes_four_edges() {
        let mut cycle = Cycle::new((0..12).collect());
        cycle.note();
        cycle.double_bridge(9, [2, 1, 3]);
        // 9 | 10 11 | 0 | 1 2 3 | 4 becomes 9 | 1 2 3 | 0 | 10 11 | 4.
        for (a, b) in [(9, 1), (3, 0), (0, 10), (11, 4), (10, 11), (1, 2)] {
            assert_eq!(cycle.next(a), b);
        }
        cycle.take_back();
        assert_eq!(cycle.order(), (0..12).collect::<Vec<u32>>());
    }
}
