//! A tree of boxes over points with potentials, for the least edge out of a component.

use super::{LENGTH_ROUNDING, NONE, UNITS, distance, length};

/// A leaf has at most this many points.
const LEAF_SIZE: usize = 8;
/// The mark of a box with points of several components.
const MIXED_MARK: u32 = NONE;

/// Points in an order in which each half of a run is again a run, to runs of [`LEAF_SIZE`].
pub(super) struct Boxes {
    /// The numbers of the points in that order, and what is needed of them.
    numbers: Vec<u32>,
    at: Vec<[f64; 2]>,
    potentials: Vec<f64>,
    /// For each point its place in the order.
    places: Vec<u32>,
    /// A heap: the halves of node k are 2k + 1 and 2k + 2.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Node {
    low: [f64; 2],
    high: [f64; 2],
    /// The least potential of its points.
    potential: f64,
    /// The component of all its points, or [`MIXED_MARK`].
    component: u32,
}

const EMPTY: Node = Node {
    low: [f64::INFINITY; 2],
    high: [f64::NEG_INFINITY; 2],
    potential: f64::INFINITY,
    component: MIXED_MARK,
};

impl Boxes {
    pub(super) fn of(at: &[[f64; 2]], potentials: &[f64]) -> Self {
        let n = at.len();
        let mut numbers: Vec<u32> = (0..n as u32).collect();
        let mut levels = 0;
        while n.div_ceil(1 << levels) > LEAF_SIZE {
            levels += 1;
        }
        halve(&mut numbers, at, levels);
        let mut places = vec![0; n];
        (0u32..).zip(&numbers).for_each(|(place, &p)| places[p as usize] = place);
        let mut boxes = Self {
            at: numbers.iter().map(|&p| at[p as usize]).collect(),
            potentials: numbers.iter().map(|&p| potentials[p as usize]).collect(),
            numbers,
            places,
            nodes: vec![EMPTY; (2 << levels) - 1],
        };
        boxes.bound(0, 0, n);
        boxes.mark(&(0..n as u32).collect::<Vec<_>>());
        boxes
    }

    fn is_leaf(&self, node: usize) -> bool {
        2 * node + 1 >= self.nodes.len()
    }

    /// Boxes of a node and below.
    fn bound(&mut self, node: usize, from: usize, to: usize) {
        let mut own = EMPTY;
        if self.is_leaf(node) {
            for place in from..to {
                let p = self.at[place];
                own.low = [own.low[0].min(p[0]), own.low[1].min(p[1])];
                own.high = [own.high[0].max(p[0]), own.high[1].max(p[1])];
                own.potential = own.potential.min(self.potentials[place]);
            }
        } else {
            let middle = middle(from, to);
            for (half, from, to) in [(2 * node + 1, from, middle), (2 * node + 2, middle, to)] {
                self.bound(half, from, to);
                let of = self.nodes[half];
                own.low = [own.low[0].min(of.low[0]), own.low[1].min(of.low[1])];
                own.high = [own.high[0].max(of.high[0]), own.high[1].max(of.high[1])];
                own.potential = own.potential.min(of.potential);
            }
        }
        self.nodes[node] = own;
    }

    /// Marks boxes by the components of points.
    pub(super) fn mark(&mut self, components: &[u32]) {
        self.mark_from(0, 0, self.at.len(), components);
    }

    fn mark_from(&mut self, node: usize, from: usize, to: usize, components: &[u32]) -> u32 {
        let component = if self.is_leaf(node) {
            let of = |place: usize| components[self.numbers[place] as usize];
            let first = if from < to { of(from) } else { MIXED_MARK };
            if (from..to).all(|place| of(place) == first) { first } else { MIXED_MARK }
        } else {
            let middle = middle(from, to);
            let first = self.mark_from(2 * node + 1, from, middle, components);
            let second = self.mark_from(2 * node + 2, middle, to, components);
            if first == second { first } else { MIXED_MARK }
        };
        self.nodes[node].component = component;
        component
    }

    /// The least edge from a point to another component, by weight and other end. If none is below `most`: that, and no point.
    pub(super) fn nearest_outside(&self, p: usize, components: &[u32], most: i64) -> (i64, u32) {
        let place = self.places[p] as usize;
        let (at, pi, own) = (self.at[place], self.potentials[place], components[p]);
        let mut best = (most as f64, NONE);
        // Halves that are put off, at most one a level.
        let mut later = [(0.0, 0, 0, 0); 64];
        let mut waiting = 1;
        later[0] = (f64::NEG_INFINITY, 0, 0, self.at.len());
        while waiting > 0 {
            waiting -= 1;
            let (bound, mut node, mut from, mut to) = later[waiting];
            if bound >= best.0 {
                continue;
            }
            loop {
                if self.nodes[node].component == own {
                    break;
                }
                if self.is_leaf(node) {
                    for place in from..to {
                        let other = self.numbers[place];
                        if components[other as usize] != own {
                            let weight = length(at, self.at[place]) + (pi + self.potentials[place]);
                            if weight < best.0 {
                                best = (weight, other);
                            }
                        }
                    }
                    break;
                }
                let middle = middle(from, to);
                let first = (self.least_weight(2 * node + 1, at, pi), 2 * node + 1, from, middle);
                let second = (self.least_weight(2 * node + 2, at, pi), 2 * node + 2, middle, to);
                let (near, far) =
                    if first.0 <= second.0 { (first, second) } else { (second, first) };
                if far.0 < best.0 {
                    later[waiting] = far;
                    waiting += 1;
                }
                if near.0 >= best.0 {
                    break;
                }
                (_, node, from, to) = near;
            }
        }
        match best {
            (_, NONE) => (most, NONE),
            (weight, other) => (weight as i64, other),
        }
    }

    /// No edge from a point with potential `pi` into the box weighs less.
    #[inline(always)]
    fn least_weight(&self, node: usize, at: [f64; 2], pi: f64) -> f64 {
        let Node { low, high, potential, .. } = self.nodes[node];
        let nearest = [0, 1].map(|k| at[k].clamp(low[k], high[k].max(low[k])));
        (distance(at, nearest) * (1.0 - 4.0 * LENGTH_ROUNDING) * UNITS).floor() + (pi + potential)
    }
}

/// Where a run is halved.
fn middle(from: usize, to: usize) -> usize {
    from + (to - from).div_ceil(2)
}

/// Sorts a run so that its halves are apart along its wider side, and so on.
fn halve(numbers: &mut [u32], at: &[[f64; 2]], levels: u32) {
    if levels == 0 || numbers.len() < 2 {
        return;
    }
    let mut ends = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for &p in numbers.iter() {
        for k in 0..2 {
            ends[0][k] = ends[0][k].min(at[p as usize][k]);
            ends[1][k] = ends[1][k].max(at[p as usize][k]);
        }
    }
    let k = usize::from(ends[1][1] - ends[0][1] > ends[1][0] - ends[0][0]);
    let middle = middle(0, numbers.len());
    if middle < numbers.len() {
        let by = |&p: &u32, &q: &u32| at[p as usize][k].total_cmp(&at[q as usize][k]);
        numbers.select_nth_unstable_by(middle, by);
    }
    let (first, second) = numbers.split_at_mut(middle);
    taut_points::parallel::join(|| halve(first, at, levels - 1), || halve(second, at, levels - 1));
}
