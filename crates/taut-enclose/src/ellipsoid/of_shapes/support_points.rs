//! Points in which items touch: the working set knows each by its number, its item and a direction.

use taut_kernels::vector::dot;
use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;

use crate::ellipsoid::sample::Sample;
use crate::ellipsoid::working_set::WorkingSet;
use crate::shapes::eigen::eigen;
use crate::shapes::frame::Framed;

/// The first working set has this many points for each of the d(d + 3)/2 that can be needed.
const FIRST_POOL_FACTOR: usize = 4;
/// An affine basis is taken from a sample of this many items.
const SAMPLE_SIZE: usize = 200;

/// A point of an item by its direction in the base.
#[derive(Clone)]
pub(super) struct SupportPoint {
    pub(super) item: usize,
    pub(super) direction: Vec<f64>,
}

/// The points of a working set by their numbers.
pub(super) struct SupportPoints {
    pub(super) list: Vec<SupportPoint>,
}

impl SupportPoints {
    /// The directions of the points with a multiplier, by item.
    pub(super) fn seeds(&self, set: &WorkingSet, items: usize) -> Vec<Vec<&[f64]>> {
        let mut seeds = vec![vec![]; items];
        let weighted = set.ids().iter().zip(set.weights()).filter(|(_, u)| **u > 0.0);
        for support_point in weighted.map(|(&id, _)| &self.list[id as usize]) {
            seeds[support_point.item].push(&support_point.direction[..]);
        }
        seeds
    }

    pub(super) fn support(&self, set: &WorkingSet) -> Vec<(SupportPoint, f64)> {
        let weighted = set.ids().iter().zip(set.weights()).filter(|(_, u)| **u > 0.0);
        weighted.map(|(&id, &u)| (self.list[id as usize].clone(), u)).collect()
    }
}

/// Squares of half axes, and their directions as rows.
pub(super) struct Axes {
    squares: Vec<f64>,
    directions: Vec<f64>,
}

impl Axes {
    /// The longest half axis, rounded up.
    pub(super) fn longest(&self) -> f64 {
        self.squares.iter().copied().fold(0.0, f64::max).sqrt() * (1.0 + 1e-12)
    }
}

pub(super) fn axes(framed: &Framed) -> Vec<Axes> {
    let axes = |i: usize| {
        let (squares, directions) = eigen(&mut framed.shape(i).to_vec(), framed.rank);
        Axes { squares, directions }
    };
    (0..framed.len()).into_par_iter().with_min_len(32).map(axes).collect()
}

/// Equal weights on ends of axes that lie far out, on what is extreme in a sample, and on an affine basis unless that holds one.
pub(super) fn first_working_set(framed: &Framed, axes: Vec<Axes>) -> (WorkingSet, SupportPoints) {
    let rank = framed.rank;
    let mut list = vec![];
    let mut points = vec![];
    for (i, axes) in axes.into_iter().enumerate() {
        let before = list.len();
        for (&square, v) in axes.squares.iter().zip(axes.directions.chunks_exact(rank)) {
            // An axis that rounding may have made is none.
            if square > 1e-14 {
                list.push(SupportPoint { item: i, direction: v.to_vec() });
                list.push(SupportPoint { item: i, direction: v.iter().map(|v| -v).collect() });
            }
        }
        if list.len() == before {
            list.push(SupportPoint { item: i, direction: vec![0.0; rank] });
        }
        points.extend(list[before..].iter().map(|t| framed.touching(t.item, &t.direction)));
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    let leverages: Vec<f64> = points.iter().map(|y| dot(y, y)).collect();
    order.order_by(&|&a, &b| leverages[b].total_cmp(&leverages[a]));
    let size = FIRST_POOL_FACTOR * (rank + 1) * (rank + 2) / 2;
    let mut chosen: Vec<usize> = order.iter().take(size).copied().collect();
    let step = framed.len().div_ceil(SAMPLE_SIZE);
    let mut sample = Sample { origin: vec![0.0; rank], set: WorkingSet::new(rank) };
    for (at, support_point) in list.iter().enumerate() {
        if support_point.item.is_multiple_of(step) {
            sample.set.push(at as u64, &points[at], 1.0);
        }
    }
    let spread = sample.spread(sample.set.blocks(), &[]);
    chosen.extend(spread.into_iter().map(|i| sample.set.ids()[i] as usize));
    let mut set = WorkingSet::new(rank);
    for at in chosen {
        set.push(at as u64, &points[at], 1.0);
    }
    set.normalize();
    (set, SupportPoints { list })
}
