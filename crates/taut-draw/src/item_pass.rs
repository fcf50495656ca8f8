//! One read of all items of a shape: which are drawn, and how far each reaches from the center.
//!
//! *Idea.* Where there are more items than a picture can hold, three kinds are kept: the support; the items that reach
//! farthest, with those extreme in a few directions, since they shape the ball; and of the others those whose numbers
//! have the smallest hashes, an even sample whatever the order of the input.
//! *Guarantee.* The choice depends on the items and the options alone. Memory is proportional to the items kept.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use taut_certify::{Ball, Items};
use taut_points::{Blocks, PointSource, Scratch};

use crate::Error;
use crate::axes::unit;

/// The histogram of distances resolves this many parts of the way to the border.
const HISTOGRAM_STEPS: usize = 12_000;

/// An item this near to the border counts as close to it, as a part of the way there.
pub(crate) const BORDER_TOLERANCE: f64 = 1e-3;

/// Beyond this part of the way an item counts as outside: rounding explains less.
const OUTSIDE_TOLERANCE: f64 = 1e-9;

/// The result of one read of all items.
#[derive(Clone)]
pub(crate) struct ItemPass {
    /// Items to draw, ascending.
    pub(crate) ids: Vec<u64>,
    /// The number of items taken because they reach far.
    pub(crate) far: u64,
    /// Items by the part of the way to the border they reach, in steps of 1/HISTOGRAM_STEPS.
    fine: Vec<u64>,
    /// Items that reach within BORDER_TOLERANCE of the border.
    pub(crate) close: u64,
    /// Items that reach beyond the border by more than rounding.
    pub(crate) outside: u64,
}

pub(crate) fn noun(items: Items) -> &'static str {
    match items {
        Items::Points => "point",
        Items::Balls => "ball",
        Items::Ellipsoids => "ellipsoid",
    }
}

/// A shape that says how far items reach.
pub(crate) trait Measure {
    /// Coordinates of its center.
    fn dim(&self) -> usize;

    /// The vector from the center to an item's place, in some unit.
    fn offset(&self, row: &[f64]) -> Vec<f64>;

    /// Returns how far an item reaches from the center, as a part of the way to the border.
    fn part(&self, row: &[f64], items: Items) -> f64;
}

/// Numbers of a ball, scaled so that sums of squares neither overflow nor vanish.
pub(crate) struct Scaled {
    pub(crate) unit: f64,
    pub(crate) center: Vec<f64>,
    pub(crate) radius: f64,
}

impl Scaled {
    pub(crate) fn new(ball: &Ball) -> Self {
        let unit = unit(ball.center.iter().copied().chain([ball.radius]));
        let mut center: Vec<f64> = ball.center.iter().map(|c| c / unit).collect();
        for (c, tail) in center.iter_mut().zip(&ball.center_tail) {
            *c += tail / unit;
        }
        Scaled { unit, center, radius: ball.radius / unit }
    }

    /// Returns how far an item reaches from the center, in units.
    pub(crate) fn reach(&self, row: &[f64], items: Items) -> f64 {
        let square: f64 = self.offset(row).iter().map(|v| v * v).sum();
        let own = match items {
            Items::Balls => row[self.center.len()] / self.unit,
            Items::Points | Items::Ellipsoids => 0.0,
        };
        square.sqrt() + own
    }
}

impl Measure for Scaled {
    fn dim(&self) -> usize {
        self.center.len()
    }

    fn offset(&self, row: &[f64]) -> Vec<f64> {
        row.iter().zip(&self.center).map(|(p, c)| p / self.unit - c).collect()
    }

    fn part(&self, row: &[f64], items: Items) -> f64 {
        let reach = self.reach(row, items);
        match reach {
            // A finite reach is a finite part, however small the ball.
            _ if self.radius > 0.0 && reach.is_finite() => (reach / self.radius).min(f64::MAX),
            0.0 => 1.0,
            _ => 1.0 + reach,
        }
    }
}

/// The directions in which extreme items are kept: for few dimensions only.
fn directions(dim: usize) -> Vec<Vec<f64>> {
    match dim {
        1 => vec![vec![1.0], vec![-1.0]],
        2 => (0..16)
            .map(|i| (f64::from(i) * std::f64::consts::TAU / 16.0).sin_cos())
            .map(|(s, c)| vec![c, s])
            .collect(),
        3 => (0..27)
            .map(|i| [i / 9, i / 3 % 3, i % 3].map(|k| f64::from(k) - 1.0).to_vec())
            .filter(|v| v.iter().any(|&x| x != 0.0))
            .collect(),
        _ => Vec::new(),
    }
}

/// SplitMix64 of an item's number (Steele, Lea and Flood, OOPSLA 2014): spreads consecutive numbers evenly.
pub(crate) fn spread(id: u64) -> u64 {
    let mut z = id.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The question that a pass over all items answers.
pub(crate) struct PassQuery<'a> {
    pub(crate) items: Items,
    /// Rows that are drawn in any case.
    pub(crate) support: &'a [u64],
    /// Rows that are not measured, ascending: the shape is not about them.
    pub(crate) left_out: &'a [u64],
    /// Most items to draw.
    pub(crate) most: usize,
}

/// Reads all items once.
pub(crate) fn item_pass(
    shape: &dyn Measure,
    question: &PassQuery<'_>,
    source: &dyn PointSource,
) -> Result<ItemPass, Error> {
    let n = source.len();
    let all = n <= question.most as u64;
    let support: BTreeSet<u64> = question.support.iter().copied().collect();
    let room = question.most.saturating_sub(support.len());
    // More far items than this would show as a ring where their density meets that of the sample.
    let far_room = room / 50;
    let directions = if all { Vec::new() } else { directions(shape.dim()) };
    let mut extreme: Vec<Option<(f64, u64)>> = vec![None; directions.len()];
    // Parts are at least 0, so their bits order as they do; ties go to the lower number.
    let mut far: BinaryHeap<Reverse<(u64, Reverse<u64>)>> = BinaryHeap::new();
    let mut sample: BinaryHeap<(u64, u64)> = BinaryHeap::new();
    let mut found = ItemPass {
        ids: Vec::new(),
        far: 0,
        fine: vec![0; HISTOGRAM_STEPS + 1],
        close: 0,
        outside: 0,
    };
    let mut row = vec![0.0; source.dim()];
    let mut scratch = Scratch::new();
    let blocks = Blocks::of(source);
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        let rows = source.read(range, &mut scratch)?;
        for i in 0..rows.len() {
            let id = first + i as u64;
            rows.copy_row(i, &mut row);
            if let Some(column) = row.iter().position(|v| !v.is_finite()) {
                let what = format!("coordinate {column} of point {id}");
                return Err(Error::NonFinite { what, value: row[column] });
            }
            if let (Items::Balls, Some(&value)) = (question.items, row.last())
                && value < 0.0
            {
                return Err(Error::NegativeRadius { what: format!("radius of ball {id}"), value });
            }
            let part = shape.part(&row, question.items);
            if !part.is_finite() {
                // Only beside a shape many orders of magnitude smaller, which cannot be the answer for this point.
                let what = format!("distance of point {id} from the center, in radii,");
                return Err(Error::NonFinite { what, value: part });
            }
            if question.left_out.binary_search(&id).is_err() {
                found.fine[((part * HISTOGRAM_STEPS as f64) as usize).min(HISTOGRAM_STEPS)] += 1;
                found.close += u64::from(part >= 1.0 - BORDER_TOLERANCE);
                found.outside += u64::from(part > 1.0 + OUTSIDE_TOLERANCE);
            }
            if all {
                continue;
            }
            keep(&mut far, Reverse((part.to_bits(), Reverse(id))), far_room);
            keep(&mut sample, (spread(id), id), room);
            let offset = if directions.is_empty() { Vec::new() } else { shape.offset(&row) };
            for (direction, best) in directions.iter().zip(&mut extreme) {
                let along: f64 = offset.iter().zip(direction).map(|(v, u)| v * u).sum();
                if best.is_none_or(|(most, _)| along > most) {
                    *best = Some((along, id));
                }
            }
        }
    }
    if all {
        found.ids = (0..n).collect();
        return Ok(found);
    }
    let mut ids = support;
    let before = ids.len();
    ids.extend(extreme.iter().flatten().map(|(_, id)| id));
    // The extreme items may overlap the far ones, and both the sample: fill up to the most in that order.
    let mut fill = |mut wanted: Vec<u64>, until: usize| {
        wanted.reverse();
        while ids.len() < until {
            let Some(id) = wanted.pop() else { break };
            ids.insert(id);
        }
        ids.len()
    };
    let far: Vec<_> =
        far.into_sorted_vec().into_iter().map(|Reverse((_, Reverse(id)))| id).collect();
    let with_far = fill(far, before + far_room);
    found.far = (with_far - before) as u64;
    fill(sample.into_sorted_vec().into_iter().map(|(_, id)| id).collect(), question.most);
    found.ids = ids.into_iter().collect();
    Ok(found)
}

/// Keeps the `room` smallest items.
fn keep<T: Ord>(heap: &mut BinaryHeap<T>, item: T, room: usize) {
    if heap.len() < room {
        heap.push(item);
    } else if heap.peek().is_some_and(|worst| item < *worst) {
        heap.pop();
        heap.push(item);
    }
}

impl ItemPass {
    /// The histogram from the smallest distance to the border in about `wanted` bins: (from, to, items), ends as parts
    /// of the way.
    pub(crate) fn bins(&self, wanted: usize) -> Vec<(f64, f64, u64)> {
        let lowest = self.fine.iter().position(|&c| c > 0).unwrap_or(0).min(HISTOGRAM_STEPS - 1);
        let step = (HISTOGRAM_STEPS - lowest).div_ceil(wanted).max(1);
        let mut bins = Vec::new();
        let mut top = HISTOGRAM_STEPS;
        while top > lowest {
            let bottom = top.saturating_sub(step);
            // What reaches the border or beyond belongs to the last bin.
            let end = if top == HISTOGRAM_STEPS { HISTOGRAM_STEPS + 1 } else { top };
            let items = self.fine[bottom..end].iter().sum();
            bins.push((
                bottom as f64 / HISTOGRAM_STEPS as f64,
                top as f64 / HISTOGRAM_STEPS as f64,
                items,
            ));
            top = bottom;
        }
        bins.reverse();
        bins
    }
}
