//! Linked lists put in order: which node is the how-manieth of which list.
//!
//! *Problem.* Following the links of a list that lies scattered in memory waits for memory at each node.
//! *Idea.* Cut the lists at a few thousand nodes and follow all pieces side by side, some dozens at a time: the waits
//! overlap. Each piece writes its nodes as it goes; at the end the pieces are put together in the order of the lists.
//! *Guarantee.* Every node is in exactly one list, open or closed; the answer is a function of the links alone: lists in
//! the order of their first nodes, a closed one from its smallest node on.
//! *Trap.* Closed lists have no beginning. Those that no cut meets are found at the end, among the nodes that nobody met.
//! *Reference.* Helman, JáJá, *Designing practical efficient algorithms for symmetric multiprocessors*, ALENEX 1999; thesis,
//! section 5.8, whose method is for disks.

use crate::{Error, NoProbe, Probe};

#[cfg(test)]
mod tests;

/// The successor of the last node of an open list.
pub const NO_NODE: u32 = u32::MAX;
/// This many pieces are followed side by side: more than memory answers at once.
const CURSOR_COUNT: usize = 64;
/// There is one cut for this many nodes.
const NODES_PER_CUT: usize = 2048;

/// Lists in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lists {
    /// All nodes, list after list, each from its first node on.
    pub order: Vec<u32>,
    /// Where each list begins in `order`, and the number of nodes.
    pub starts: Vec<usize>,
    /// Whether the last node of the list leads to its first.
    pub closed: Vec<bool>,
}

impl Lists {
    /// The nodes of each list.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|ends| &self.order[ends[0]..ends[1]])
    }

    /// The place of each node in `order`.
    ///
    /// # Panics
    /// If `order` was changed and has a node that is not below its length.
    pub fn ranks(&self) -> Vec<u32> {
        let mut ranks = vec![0; self.order.len()];
        for (rank, &node) in self.order.iter().enumerate() {
            ranks[node as usize] = rank as u32;
        }
        ranks
    }
}

/// Puts all lists in order: `next[i]` is the node after node i, or [`NO_NODE`].
///
/// Lists are ordered by their first node; an open one begins with the node that nothing leads to, a closed one with its
/// smallest node. O(n), about one miss of the cache for each node. Beside the answer 9 bytes a node where lists are long:
/// each list, and each 2048 nodes, take some 150 bytes more.
///
/// # Errors
/// [`Error::Option`] if a link leads to no node, two lead to the same node, or there are 2³² − 1 nodes or more.
///
/// ```
/// use taut_oblivious::{NO_NODE, list_order};
///
/// let lists = list_order(&[3, 4, 1, NO_NODE, 2])?;                    // 0 → 3 and 1 → 4 → 2 → 1
/// assert_eq!(lists.iter().collect::<Vec<_>>(), [&[0, 3][..], &[1, 4, 2]]);
/// assert_eq!(lists.closed, [false, true]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn list_order(next: &[u32]) -> Result<Lists, Error> {
    list_order_probed(next, &mut NoProbe)
}

/// As [`list_order`], and tells `probe` of links and nodes.
///
/// # Errors
/// As [`list_order`].
pub fn list_order_probed<P: Probe>(next: &[u32], probe: &mut P) -> Result<Lists, Error> {
    probe.place(next);
    let lists = order(next, probe);
    probe.lift(next);
    lists
}

fn order<P: Probe>(next: &[u32], probe: &mut P) -> Result<Lists, Error> {
    let n = next.len();
    let refuse = |value, expected| Err(Error::Option { name: "next", value, expected });
    if n >= NO_NODE as usize {
        return refuse(format!("{n} nodes"), "fewer than 2³² − 1");
    }
    // Every node that no link leads to begins a list; the cuts begin pieces of lists.
    let mut begins = Bits::new(n);
    let mut led_to = Bits::new(n);
    probe.place(&begins.words);
    probe.place(&led_to.words);
    for (i, &to) in next.iter().enumerate() {
        probe.read(&next[i..=i]);
        if to != NO_NODE {
            if to as usize >= n {
                return refuse(format!("{to} after node {i}"), "a node, or NO_NODE");
            }
            if led_to.set(to as usize, probe) {
                return refuse(format!("{to} after node {i} and another"), "one link to a node");
            }
        }
    }
    let heads = (0..n).filter(|&i| !led_to.get(i));
    let mut firsts: Vec<u32> =
        heads.chain((0..n).step_by(NODES_PER_CUT)).map(|i| i as u32).collect();
    firsts.sort_unstable();
    firsts.dedup();
    for &first in &firsts {
        begins.set(first as usize, probe);
    }
    let mut pieces = follow(next, &firsts, &begins, probe);
    let met: usize = pieces.iter().map(|piece| piece.nodes.len()).sum();
    if met < n {
        rest(next, &mut firsts, &mut pieces, probe);
    }
    probe.lift(&led_to.words);
    probe.lift(&begins.words);
    Ok(join(n, &firsts, &led_to, pieces, probe))
}

/// A run of nodes, and the node that the last one leads to.
#[derive(Clone, Debug, Default)]
struct Piece {
    nodes: Vec<u32>,
    then: u32,
}

/// The piece that begins at each of `firsts`, up to the next node that begins one.
fn follow<P: Probe>(next: &[u32], firsts: &[u32], begins: &Bits, probe: &mut P) -> Vec<Piece> {
    let mut pieces = vec![Piece::default(); firsts.len()];
    let mut waiting = firsts.iter().copied().enumerate();
    // Which piece each cursor writes, its nodes so far and the node it is at.
    let mut cursors: Vec<(usize, Vec<u32>, u32)> = waiting
        .by_ref()
        .take(CURSOR_COUNT)
        .map(|(piece, first)| (piece, Vec::new(), first))
        .collect();
    let mut k = 0;
    while !cursors.is_empty() {
        if k >= cursors.len() {
            k = 0;
        }
        let (piece, nodes, at) = &mut cursors[k];
        nodes.push(*at);
        probe.read(&next[*at as usize..=*at as usize]);
        probe.write(&nodes[nodes.len() - 1..]);
        let then = next[*at as usize];
        if then != NO_NODE && !begins.get(then as usize) {
            *at = then;
            k += 1;
            continue;
        }
        pieces[*piece] = Piece { nodes: std::mem::take(nodes), then };
        match waiting.next() {
            Some((other, first)) => (*piece, *at) = (other, first),
            None => drop(cursors.swap_remove(k)),
        }
    }
    pieces
}

/// The closed lists that no cut meets: each becomes a piece.
fn rest<P: Probe>(next: &[u32], firsts: &mut Vec<u32>, pieces: &mut Vec<Piece>, probe: &mut P) {
    let mut met = Bits::new(next.len());
    probe.place(&met.words);
    for piece in &*pieces {
        for &node in &piece.nodes {
            met.set(node as usize, probe);
        }
    }
    for first in 0..next.len() {
        let (mut nodes, mut at) = (Vec::new(), first);
        while !met.set(at, probe) {
            nodes.push(at as u32);
            probe.read(&next[at..=at]);
            at = next[at] as usize;
        }
        if !nodes.is_empty() {
            firsts.push(first as u32);
            pieces.push(Piece { nodes, then: first as u32 });
        }
    }
    probe.lift(&met.words);
}

/// Lists of pieces.
fn join<P: Probe>(
    n: usize,
    firsts: &[u32],
    led_to: &Bits,
    mut pieces: Vec<Piece>,
    probe: &mut P,
) -> Lists {
    let mut by_first: Vec<(u32, u32)> =
        firsts.iter().enumerate().map(|(piece, &first)| (first, piece as u32)).collect();
    by_first.sort_unstable();
    let piece_of = |first: u32| {
        let place = by_first.binary_search_by_key(&first, |&(first, _)| first);
        by_first[place.expect("a piece ends where one begins")].1 as usize
    };
    // Each list as its first node, whether it is closed, and its pieces; open ones first, so that the rest is closed.
    let mut lists: Vec<(u32, bool, Vec<usize>)> = Vec::new();
    let mut used = vec![false; pieces.len()];
    let open = (0..pieces.len()).filter(|&k| !led_to.get(firsts[k] as usize));
    for (head, closed) in open.map(|k| (k, false)).chain((0..pieces.len()).map(|k| (k, true))) {
        if used[head] {
            continue;
        }
        let (mut chain, mut piece) = (Vec::new(), head);
        while !used[piece] {
            used[piece] = true;
            chain.push(piece);
            match pieces[piece].then {
                NO_NODE => break,
                then => piece = piece_of(then),
            }
        }
        let mut first = firsts[head];
        if closed {
            // Its smallest node may be inside a piece: that piece is cut there, and its front goes to the end.
            let smallest = |piece: usize| pieces[piece].nodes.iter().copied().min();
            let (place, least) = (0..chain.len())
                .map(|place| (place, smallest(chain[place]).unwrap_or(NO_NODE)))
                .min_by_key(|&(_, node)| node)
                .unwrap_or((0, first));
            chain.rotate_left(place);
            let nodes = &mut pieces[chain[0]].nodes;
            let inside = nodes.iter().position(|&node| node == least).unwrap_or(0);
            if inside > 0 {
                let back = nodes.split_off(inside);
                let front = std::mem::replace(nodes, back);
                chain.push(pieces.len());
                pieces.push(Piece { nodes: front, then: least });
            }
            first = least;
        }
        lists.push((first, closed, chain));
    }
    lists.sort_unstable_by_key(|&(first, ..)| first);
    let mut answer = Lists { order: Vec::with_capacity(n), ..Lists::default() };
    for (_, closed, chain) in lists {
        answer.starts.push(answer.order.len());
        answer.closed.push(closed);
        for piece in chain {
            let nodes = std::mem::take(&mut pieces[piece].nodes);
            probe.read(&nodes);
            let start = answer.order.len();
            answer.order.extend_from_slice(&nodes);
            probe.write(&answer.order[start..]);
        }
    }
    answer.starts.push(n);
    answer
}

/// A set of nodes.
struct Bits {
    words: Vec<u64>,
}

impl Bits {
    fn new(n: usize) -> Self {
        Self { words: vec![0; n.div_ceil(64)] }
    }

    fn get(&self, i: usize) -> bool {
        self.words[i / 64] >> (i % 64) & 1 == 1
    }

    /// Adds i; whether it was there.
    fn set<P: Probe>(&mut self, i: usize, probe: &mut P) -> bool {
        let word = &mut self.words[i / 64..=i / 64];
        probe.read(word);
        let was = word[0] >> (i % 64) & 1 == 1;
        word[0] |= 1 << (i % 64);
        probe.write(word);
        was
    }
}
