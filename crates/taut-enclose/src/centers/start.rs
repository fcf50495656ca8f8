//! Where a search starts: centers, a lower bound, and the first items of its core-set.
//!
//! *Idea.* Farthest-first traversals from four items, each made better by Lloyd's steps ([`super::lloyd`]). The first k + z + 1 items
//! of a traversal are far from one another, which is a lower bound; where z items may be left out, the k + z first centers lose
//! those of the fewest items.
//! *Reference.* Gonzalez, Theoretical Computer Science 38, 1985.

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, OrderBy, ReadError};

use super::cloud::Cloud;
use super::items::Position;
use super::lloyd::improve;
use crate::Error;

/// Centers and the radius from them.
#[derive(Clone, Debug)]
pub(super) struct Incumbent<P> {
    pub(super) centers: Vec<P>,
    pub(super) radius: f64,
}

pub(super) struct Start<P> {
    /// The best centers after Lloyd's steps.
    pub(super) incumbent: Incumbent<P>,
    /// The first centers of the first traversal, as they are.
    pub(super) plain: Incumbent<P>,
    /// No k centers have a smaller radius: of `separated`, no two fit in one smaller ball.
    pub(super) lower: f64,
    /// k + z + 1 items; none where there are not so many different ones.
    pub(super) separated: Vec<u32>,
    /// The items of the traversal that `separated` begins; of groups some items each, and of the largest group, too.
    pub(super) traversal: Vec<u32>,
}

/// Searches for k centers that may leave out z items, from four first items.
pub(super) fn start<P: Position>(
    cloud: &Cloud<P>,
    k: usize,
    z: usize,
    monitor: &Monitor<'_>,
) -> Result<Start<P>, Error> {
    let count = (2 * k).saturating_add(z).saturating_add(cloud.items.dim());
    let (far, near) = extremes(cloud);
    let traversal_of_far = cloud.traverse(far, count, monitor)?.items;
    let others = std::iter::once(near).chain(traversal_of_far.iter().copied().skip(1).take(2));
    let first_items: Vec<u32> = std::iter::once(far).chain(others).collect();
    let from = |&item: &u32| -> Result<Start<P>, Error> {
        monitor.check().map_err(ReadError::from)?;
        let traversal = match item == far {
            true => traversal_of_far.clone(),
            false => cloud.traverse(item, count, monitor)?.items,
        };
        let plain = heaviest(cloud, &traversal, k, z);
        let incumbent = improve(cloud, plain.clone(), k, z, monitor)?;
        let separated: Vec<u32> =
            traversal.iter().copied().take(k.saturating_add(z).saturating_add(1)).collect();
        let separated = if separated.len() > k.saturating_add(z) { separated } else { vec![] };
        let lower = least_pair_radius(cloud, &separated, monitor)?;
        Ok(Start { incumbent, plain, lower, separated, traversal })
    };
    let mut starts =
        first_items.par_iter().map(from).collect::<Result<Vec<_>, Error>>()?.into_iter();
    let mut best = starts.next().expect("that of the farthest item");
    for other in starts {
        if other.incumbent.radius < best.incumbent.radius {
            best.incumbent = other.incumbent;
        }
        if other.lower > best.lower {
            (best.lower, best.separated) = (other.lower, other.separated);
            best.traversal = other.traversal;
        }
    }
    best.traversal = with_largest(cloud, best.traversal);
    Ok(best)
}

/// Of groups in a traversal, the items that stand for them, and those of the group whose own ball is largest: that is a lower bound.
fn with_largest<P: Position>(cloud: &Cloud<P>, traversal: Vec<u32>) -> Vec<u32> {
    let Some(grouping) = &cloud.grouping else { return traversal };
    let largest = (0..grouping.len()).max_by(|&a, &b| {
        grouping.balls[a].radius.total_cmp(&grouping.balls[b].radius).then(b.cmp(&a))
    });
    let largest = largest.map(|group| grouping.members[group][0]);
    let mut all: Vec<u32> = vec![];
    for item in traversal.into_iter().chain(largest) {
        for witness in cloud.witnesses(item) {
            if !all.contains(&witness) {
                all.push(witness);
            }
        }
    }
    all
}

/// The items farthest from and nearest to the mean position.
fn extremes<P: Position>(cloud: &Cloud<P>) -> (u32, u32) {
    let mut mean = P::zeros(cloud.items.dim());
    let count = cloud.len() as f64;
    for item in 0..cloud.len() {
        mean.as_mut().iter_mut().zip(cloud.items.at(item)).for_each(|(m, x)| *m += x / count);
    }
    let far = cloud.farthest(std::slice::from_ref(&mean), 1)[0].item;
    let mut near = (f64::INFINITY, u64::MAX, 0);
    cloud.assign(std::slice::from_ref(&mean), |item, _, distance| {
        let candidate = (distance, cloud.rows[item], item as u32);
        if (candidate.0, candidate.1) < (near.0, near.1) {
            near = candidate;
        }
    });
    (far, near.2)
}

/// The least radius of a ball of two of these; 0 for none.
pub(super) fn least_pair_radius<P: Position>(
    cloud: &Cloud<P>,
    items: &[u32],
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let mut least = f64::INFINITY;
    for (at, &a) in items.iter().enumerate() {
        monitor.check().map_err(ReadError::from)?;
        for &b in &items[..at] {
            least = least.min(cloud.pair_radius(a, b));
        }
    }
    Ok(if least.is_finite() { least } else { 0.0 })
}

/// The first k + z of a traversal, but for the z to which the fewest items are nearest.
fn heaviest<P: Position>(cloud: &Cloud<P>, traversal: &[u32], k: usize, z: usize) -> Incumbent<P> {
    let first: Vec<P> =
        traversal.iter().take(k.saturating_add(z)).map(|&item| cloud.place_of(item)).collect();
    let centers = if first.len() <= k {
        first
    } else {
        let mut sizes = vec![0usize; first.len()];
        cloud.assign(&first, |_, center, _| sizes[center] += 1);
        let mut order: Vec<usize> = (0..first.len()).collect();
        order.order_by_key(|&at| std::cmp::Reverse(sizes[at]));
        order.truncate(k);
        order.sort_unstable();
        order.into_iter().map(|at| first[at].clone()).collect()
    };
    measured(cloud, centers, z)
}

/// Centers with their radius: the reach of the item that is farthest but for z.
pub(super) fn measured<P: Position>(cloud: &Cloud<P>, centers: Vec<P>, z: usize) -> Incumbent<P> {
    let far = cloud.farthest(&centers, z.saturating_add(1));
    let radius = far.get(z).map_or(0.0, |far| far.reach);
    Incumbent { centers, radius }
}
