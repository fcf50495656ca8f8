//! The dual graph with what flows through it, and the cycles that show objections to be vain.
//!
//! *Idea.* A cycle of cells around which an odd number of facets say "opposite" disagrees with every labeling at one facet at least. Where a
//! facet that disagrees with the labels lies on a cycle of facets that agree, no labeling does better on that cycle. Cycles that share facets
//! share their weights out; a facet is *settled* once cycles through it carry all of its weight. Most facets that disagree do so among
//! slivers, and short cycles settle them.
//! *Trap.* What flows along two cycles in opposite directions cancels, so a facet can carry more than its weight in sum. That settled labels
//! are the best of all is therefore likely and not proved; who turns cells over weighs them exactly.
//! *Guarantee.* Weights are whole numbers, and searches are in a fixed order. What flows from one cell of the facet to the other along a
//! cycle can be turned with the facet when minimum cuts are sought (`signed_cut`).
//! *Reference.* Barahona and Mahjoub, *On the cut polytope*, Math. Programming 36, 1986, for the inequalities of odd cycles.

use super::cells::Cells;
use super::dual_edges::DualEdges;
use taut_delaunay::decode;

/// A cycle is sought among this many cells around a facet. Fewer leave more to minimum cuts, which take longer. More bring E nearer to its
/// least value, and the labels no nearer to the truth: of twelve sieves with bridges of 1.6 to 5 spacings 10 were exact with 100 and 6 with
/// 500 (bench `surface unseen`).
const CELLS_AROUND_MAX: usize = 100;
/// The stamp of cells that no search enters.
const CLOSED: u32 = u32::MAX;

/// The cells, their labels, and what flows across facets that agree with these.
pub(super) struct Network<'a> {
    pub(super) cells: &'a Cells,
    pub(super) dual_edges: &'a DualEdges,
    pub(super) inside: &'a mut [bool],
    /// True if ghosts are one and stay outside.
    pub(super) ghosts_stay: bool,
    /// By cell and facet what flows out, less than 0 if it flows in. Zero pages cost nothing until they are written to.
    used: Vec<[i32; 4]>,
    /// By cell the last search that came by.
    seen: Vec<u32>,
    search: u32,
    /// The cells of the last search in the order in which it came by.
    queue: Vec<Reached>,
    /// Those from which the end of a way can be reached, where it is sought from both ends.
    back: Vec<Reached>,
    /// Cells that searches came by, over all of them.
    pub(super) visited: u64,
}

/// A cell that a search came by.
#[derive(Clone, Copy)]
struct Reached {
    cell: u32,
    /// The facet by which it was entered, as seen from where it was entered from.
    by: u32,
    /// The place of that in the queue.
    from: u32,
}

/// The end of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// A goal at this place of the queue.
    Goal(usize),
    /// There is no goal to be reached, and no other cell than those in the queue.
    Closed,
    /// The search was given up.
    Open,
}

/// A facet that disagrees with the labels.
#[derive(Clone, Debug)]
pub(super) struct Objection {
    /// From its first cell.
    pub(super) facet: u32,
    /// What no cycle carries of its weight.
    pub(super) left: u32,
    /// True if flow goes from the second cell to the first.
    pub(super) is_turned: bool,
    /// True if the sphere of the first cell is larger than that of the second.
    pub(super) is_first_larger: bool,
    /// The ways in which cuts were sought since labels nearby changed, one bit each.
    pub(super) tried: u8,
    /// What cycles carry, each with the facets from the first cell to the second.
    cycles: Vec<(u32, Box<[u32]>)>,
}

impl<'a> Network<'a> {
    pub(super) fn new(
        cells: &'a Cells,
        dual_edges: &'a DualEdges,
        inside: &'a mut [bool],
        ghosts_stay: bool,
    ) -> Self {
        let (used, seen) = (vec![[0; 4]; cells.len()], vec![0; cells.len()]);
        let [queue, back] = [Vec::new(), Vec::new()];
        Self {
            cells,
            dual_edges,
            inside,
            ghosts_stay,
            used,
            seen,
            search: 0,
            queue,
            back,
            visited: 0,
        }
    }

    /// Returns true if a facet disagrees with the labels of its cells.
    pub(super) fn disagrees(&self, facet: u32) -> bool {
        let other = self.cells.mirror(facet) >> 2;
        let is_apart = self.inside[(facet >> 2) as usize] != self.inside[other as usize];
        self.dual_edges.at(facet).is_opposite() != is_apart
    }

    /// Returns true if a cell is one of those that are outside whatever is said.
    pub(super) fn is_fixed(&self, cell: u32) -> bool {
        self.ghosts_stay && self.cells.is_ghost(cell)
    }

    /// How much more can flow out of a cell by a facet.
    fn room(&self, facet: u32) -> i64 {
        if self.disagrees(facet) {
            return 0;
        }
        let (cell, i) = decode(facet);
        i64::from(self.dual_edges.at(facet).weight()) - i64::from(self.used[cell as usize][i])
    }

    /// Has more flow out of a cell by a facet.
    pub(super) fn push(&mut self, facet: u32, amount: i32) {
        let (other, k) = decode(self.cells.mirror(facet));
        let (cell, i) = decode(facet);
        // Between two of the ways that are turned together a sum may leave the range, but the last one is within a weight:
        // arithmetic modulo 2³² gets there.
        let there = &mut self.used[cell as usize][i];
        *there = there.wrapping_add(amount);
        let there = &mut self.used[other as usize][k];
        *there = there.wrapping_sub(amount);
    }

    /// Searches the cells that flow from one can reach, nearest first, for a goal. Fixed cells are not left again.
    pub(super) fn search(
        &mut self,
        from: u32,
        cells_max: usize,
        is_goal: impl Fn(&Self, u32) -> bool,
    ) -> Found {
        self.search += 1;
        self.seen[from as usize] = self.search;
        self.queue.clear();
        self.queue.push(Reached { cell: from, by: 0, from: 0 });
        let mut next = 0;
        let found = loop {
            let Some(&Reached { cell, .. }) = self.queue.get(next) else { break Found::Closed };
            if self.queue.len() > cells_max {
                break Found::Open;
            }
            let mut goal = None;
            for i in 0..4 {
                let facet = cell << 2 | i;
                let other = self.cells.mirror(facet) >> 2;
                let seen = self.seen[other as usize];
                if seen == self.search || seen == CLOSED || self.room(facet) <= 0 {
                    continue;
                }
                self.seen[other as usize] = self.search;
                let is_goal = is_goal(self, other);
                if is_goal || !self.is_fixed(other) {
                    self.queue.push(Reached { cell: other, by: facet, from: next as u32 });
                }
                if is_goal {
                    goal = Some(self.queue.len() - 1);
                    break;
                }
            }
            if let Some(goal) = goal {
                break Found::Goal(goal);
            }
            next += 1;
        };
        self.visited += self.queue.len() as u64;
        found
    }

    /// The facets from where the last search began to a place of its queue, the last one first.
    pub(super) fn way(&self, mut place: usize) -> Vec<u32> {
        let mut way = Vec::new();
        while place > 0 {
            let Reached { by, from, .. } = self.queue[place];
            way.push(by);
            place = from as usize;
        }
        way
    }

    /// Searches a way for flow from both ends, nearest cells first, and returns its facets; none if there is none among so many cells.
    fn between(&mut self, from: u32, to: u32, cells_max: usize) -> Option<Vec<u32>> {
        let ends = [self.search + 1, self.search + 2];
        self.search += 2;
        let mut queues = [std::mem::take(&mut self.queue), std::mem::take(&mut self.back)];
        for ((queue, cell), stamp) in queues.iter_mut().zip([from, to]).zip(ends) {
            queue.clear();
            queue.push(Reached { cell, by: 0, from: 0 });
            self.seen[cell as usize] = stamp;
        }
        let (mut next, mut meeting) = ([0, 0], None);
        'search: while queues[0].len() + queues[1].len() <= cells_max {
            // The side that has come by fewer cells goes on.
            let side = usize::from(queues[1].len() < queues[0].len());
            let Some(&Reached { cell, .. }) = queues[side].get(next[side]) else { break };
            for i in 0..4 {
                let facet = cell << 2 | i;
                let mirror = self.cells.mirror(facet);
                let other = mirror >> 2;
                let seen = self.seen[other as usize];
                if seen == ends[side] || seen == CLOSED || self.is_fixed(other) {
                    continue;
                }
                let along = if side == 0 { facet } else { mirror };
                if self.room(along) <= 0 {
                    continue;
                }
                if seen == ends[1 - side] {
                    let place = queues[1 - side].iter().position(|reached| reached.cell == other);
                    let mut places = [next[side], place.unwrap_or(0)];
                    if side == 1 {
                        places.swap(0, 1);
                    }
                    meeting = Some((places, along));
                    break 'search;
                }
                self.seen[other as usize] = ends[side];
                queues[side].push(Reached { cell: other, by: along, from: next[side] as u32 });
            }
            next[side] += 1;
        }
        self.visited += (queues[0].len() + queues[1].len()) as u64;
        [self.queue, self.back] = queues;
        let ([first, mut last], middle) = meeting?;
        let mut way = self.way(first);
        way.push(middle);
        while last > 0 {
            let Reached { by, from, .. } = self.back[last];
            way.push(by);
            last = from as usize;
        }
        Some(way)
    }

    /// The cell at a place of the queue of the last search.
    pub(super) fn reached(&self, place: usize) -> u32 {
        self.queue[place].cell
    }

    /// Lets at most so much flow along some facets, and returns how much does.
    pub(super) fn flow(&mut self, way: &[u32], most: u32) -> u32 {
        let room = way.iter().map(|&facet| self.room(facet)).min().unwrap_or(0);
        let amount = i64::from(most).min(room) as i32;
        way.iter().for_each(|&facet| self.push(facet, amount));
        amount as u32
    }

    /// The cells of the last search, which no search enters any more.
    pub(super) fn close(&mut self) -> Vec<u32> {
        let cells: Vec<u32> = self.queue.iter().map(|reached| reached.cell).collect();
        cells.iter().for_each(|&cell| self.seen[cell as usize] = CLOSED);
        cells
    }

    pub(super) fn is_closed(&self, cell: u32) -> bool {
        self.seen[cell as usize] == CLOSED
    }

    /// Has searches enter some cells again.
    pub(super) fn reopen(&mut self, cells: &[u32]) {
        cells.iter().for_each(|&cell| self.seen[cell as usize] = 0);
    }
}

impl Objection {
    /// That of a facet which disagrees.
    pub(super) fn new(facet: u32, is_first_larger: bool, network: &Network<'_>) -> Self {
        let left = network.dual_edges.at(facet).weight();
        Self { facet, left, is_turned: false, is_first_larger, tried: 0, cycles: Vec::new() }
    }

    /// Where flow comes from, and where it goes.
    pub(super) fn ends(&self, network: &Network<'_>) -> [u32; 2] {
        let ends = [self.facet >> 2, network.cells.mirror(self.facet) >> 2];
        if self.is_turned { [ends[1], ends[0]] } else { ends }
    }

    /// Has cycles carry as much of the weight as the facets around have room for.
    pub(super) fn settle(&mut self, network: &mut Network<'_>) {
        while self.left > 0 {
            let [mut from, mut to] = [self.facet >> 2, network.cells.mirror(self.facet) >> 2];
            // Nothing leaves a fixed cell, and all fixed ones are one.
            let is_backward = network.is_fixed(from);
            if is_backward != self.is_turned {
                self.turn(network);
            }
            if is_backward {
                std::mem::swap(&mut from, &mut to);
            }
            let way = if network.is_fixed(to) {
                match network.search(from, CELLS_AROUND_MAX, Network::is_fixed) {
                    Found::Goal(place) => Some(network.way(place)),
                    Found::Closed | Found::Open => None,
                }
            } else {
                network.between(from, to, CELLS_AROUND_MAX)
            };
            let Some(way) = way else { return };
            let amount = network.flow(&way, self.left);
            self.left -= amount;
            // As it would be from the first cell to the second.
            let way = match is_backward {
                true => way.iter().map(|&facet| network.cells.mirror(facet)).collect(),
                false => way.into(),
            };
            self.cycles.push((amount, way));
        }
    }

    /// Turns what cycles carry.
    pub(super) fn turn(&mut self, network: &mut Network<'_>) {
        for (amount, way) in &self.cycles {
            let twice = (*amount as i32).wrapping_mul(if self.is_turned { 2 } else { -2 });
            way.iter().for_each(|&facet| network.push(facet, twice));
        }
        self.is_turned = !self.is_turned;
    }

    /// Gives up the cycles that have facets which disagree now, besides this one; all of them, if this one agrees.
    pub(super) fn reconsider(&mut self, network: &mut Network<'_>) {
        let is_vain = !network.disagrees(self.facet);
        let (left, tried, is_turned) = (&mut self.left, &mut self.tried, self.is_turned);
        self.cycles.retain(|(amount, way)| {
            let is_kept = !is_vain && !way.iter().any(|&facet| network.disagrees(facet));
            if !is_kept {
                let back = (*amount as i32).wrapping_mul(if is_turned { 1 } else { -1 });
                way.iter().for_each(|&facet| network.push(facet, back));
                *left += amount;
                *tried = 0;
            }
            is_kept
        });
    }
}
