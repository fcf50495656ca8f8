//! Lloyd's steps with exact balls: every item goes to the nearest center, every center to that of the smallest ball of its items.
//!
//! *Idea.* Most cells of the cloud have one center that can be nearest, and all of their items go there at once. A ball starts from those items
//! of the step before that determined it. In few dimensions, where the farthest item outside it is sought, cells that lie in the ball
//! are skipped.
//! *Guarantee.* Clusters are those of a look at all items, and so are balls, but for rounding.
//! *Evidence.* On 15,112 cities and k = 10, steps that look at all items are a third of the whole search, and these less than a fifth
//! (the example `centers_speed`, sampled).
//! *Reference.* Lloyd, IEEE Trans. Information Theory 28, 1982.

use std::ops::Range;

use taut_points::{Monitor, ReadError};

use super::cloud::{Cloud, Far};
use super::items::Position;
use super::small_ball::{Ball, REACH_TOLERANCE, STALLS_MAX, Workspace};
use super::start::{Incumbent, measured};
use crate::Error;

/// Lloyd's steps end when one gains less than this part of the radius.
const LLOYD_GAIN_MIN: f64 = 1e-9;
/// And after this many; most starts need five to twenty.
const MOST_STEPS: usize = 100;
/// In more dimensions bounds of cells are weak, and a ball takes several items at once.
const SKIPPING_DIM_MAX: usize = 3;

/// Items of one cell that follow one another and are in one cluster.
#[derive(Clone, Copy, PartialEq)]
struct Run {
    cell: u32,
    first: u32,
    end: u32,
}

impl Run {
    fn new(cell: usize, items: Range<usize>) -> Self {
        Run { cell: cell as u32, first: items.start as u32, end: items.end as u32 }
    }

    fn items(&self) -> Range<u32> {
        self.first..self.end
    }
}

/// The items of a cluster.
type Cluster = Vec<Run>;

/// Lloyd's steps, as long as the radius gets smaller.
pub(super) fn improve<P: Position>(
    cloud: &Cloud<P>,
    mut best: Incumbent<P>,
    k: usize,
    z: usize,
    monitor: &Monitor<'_>,
) -> Result<Incumbent<P>, Error> {
    let mut work = Workspace::new(cloud.items.dim());
    let mut clusters: Vec<Cluster> = vec![];
    // Those whose balls have the present centers, and the items that determine these balls.
    let mut before: Vec<Cluster> = vec![];
    let mut supports: Vec<Vec<u32>> = vec![];
    for _ in 0..MOST_STEPS {
        monitor.check().map_err(ReadError::from)?;
        let far = cloud.farthest(&best.centers, z).into_iter();
        let mut left_out: Vec<u32> = far.flat_map(|far| cloud.linked(far.item)).collect();
        left_out.sort_unstable();
        let mut centers = best.centers.clone();
        // A center that is still free goes where it helps most.
        if let Some(Far { item, .. }) = outliers_left(cloud, &best, k, z) {
            centers.push(cloud.place_of(item));
        }
        clusters.iter_mut().for_each(Vec::clear);
        clusters.resize(centers.len(), vec![]);
        cloud.assign_runs(&centers, |cell, items, center| {
            visit_remaining(&left_out, items, |items| {
                clusters[center].push(Run::new(cell, items));
            });
        });
        // Near the end few clusters change, and in the last step none.
        let is_as_before = |at: usize| before.get(at) == Some(&clusters[at]);
        if (0..clusters.len()).all(is_as_before) {
            return Ok(best);
        }
        supports.resize(centers.len(), vec![]);
        let mut ball_center = |(at, center): (usize, P)| match clusters[at][..] {
            [] => center,
            _ if is_as_before(at) => center,
            ref cluster => {
                let ball = ball_of(cloud, cluster, &supports[at], &mut work);
                supports[at] = ball.support;
                ball.center
            }
        };
        let centers = centers.into_iter().enumerate().map(&mut ball_center).collect();
        std::mem::swap(&mut before, &mut clusters);
        let next = measured(cloud, centers, z);
        if next.radius >= best.radius * (1.0 - LLOYD_GAIN_MIN) {
            return Ok(if next.radius < best.radius { next } else { best });
        }
        best = next;
    }
    Ok(best)
}

/// Calls `visit` for the runs that are left of some items without those that are left out, which are in order.
fn visit_remaining(left_out: &[u32], items: Range<usize>, mut visit: impl FnMut(Range<usize>)) {
    let from = left_out.partition_point(|&item| (item as usize) < items.start);
    let mut start = items.start;
    for &item in left_out[from..].iter().take_while(|&&item| (item as usize) < items.end) {
        if start < item as usize {
            visit(start..item as usize);
        }
        start = item as usize + 1;
    }
    if start < items.end {
        visit(start..items.end);
    }
}

/// The smallest ball of a cluster that is not empty, from those of its items which determined the ball of the step before.
fn ball_of<P: Position>(
    cloud: &Cloud<P>,
    cluster: &[Run],
    support_before: &[u32],
    work: &mut Workspace<P>,
) -> Ball<P> {
    let items = &cloud.items;
    // Groups have no cells.
    if cloud.grouping.is_some() || items.dim() > SKIPPING_DIM_MAX {
        let all: Vec<u32> = cluster.iter().flat_map(Run::items).collect();
        return Ball::of_all(items, &all, work);
    }
    let is_here = |item: &u32| {
        let at = cluster.partition_point(|run| run.end <= *item);
        cluster.get(at).is_some_and(|run| run.items().contains(item))
    };
    let mut support: Vec<u32> = support_before.iter().copied().filter(is_here).collect();
    if support.is_empty() {
        support.push(cluster[0].first);
    }
    let mut ball = Ball::of_all(items, &support, work);
    let mut stalls = 0;
    while let Some(item) = farthest_outside(cloud, cluster, &ball) {
        let radius = ball.radius;
        support.clone_from(&ball.support);
        if stalls > STALLS_MAX || support.contains(&item) {
            break;
        }
        ball.grow(items, &support, item, f64::INFINITY, work);
        stalls += u32::from(ball.radius <= radius * (1.0 + REACH_TOLERANCE));
    }
    ball
}

/// The item of a cluster that reaches farthest beyond a ball, the first of several.
fn farthest_outside<P: Position>(cloud: &Cloud<P>, cluster: &[Run], ball: &Ball<P>) -> Option<u32> {
    let mut farthest = None;
    let mut most = ball.radius * (1.0 + REACH_TOLERANCE);
    for run in cluster {
        let bound = cloud.bound_of_cell(run.cell as usize, std::slice::from_ref(&ball.center));
        if bound <= most {
            continue;
        }
        for item in run.items() {
            let reach = cloud.items.reach(item as usize, &ball.center);
            if reach > most {
                (farthest, most) = (Some(item), reach);
            }
        }
    }
    farthest
}

/// The item to open a further center at, where there are fewer than k.
fn outliers_left<P: Position>(
    cloud: &Cloud<P>,
    best: &Incumbent<P>,
    k: usize,
    z: usize,
) -> Option<Far> {
    if best.centers.len() >= k || best.radius == 0.0 {
        return None;
    }
    cloud.farthest(&best.centers, z.saturating_add(1)).pop()
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::super::items::{ItemSet, Shape};
    use super::*;

    fn cloud<P: Position>(shape: Shape, dim: usize, grid: f64, seed: u64) -> Cloud<P> {
        let values: Vec<f64> = generate(Distribution::Normal, 900, dim + 1, seed).unwrap();
        let mut items = ItemSet::new(shape, dim);
        for row in values.chunks_exact(dim + 1) {
            let position: Vec<f64> = row[..dim].iter().map(|x| (grid * x).round() / grid).collect();
            items.push(&position, row[dim].abs() + 0.1);
        }
        Cloud::new(items, &[])
    }

    /// The radii of balls from several starts are those of a look at all items.
    fn judge<P: Position>(cloud: &Cloud<P>, what: &str) {
        let mut work = Workspace::new(cloud.items.dim());
        let centers = [0, 300, 500, 501].map(|item| cloud.items.position(item));
        let left_out = [0, 1, 40, 63, 64, 899];
        let mut clusters: [Cluster; 4] = Default::default();
        cloud.assign_runs(&centers, |cell, items, center| {
            visit_remaining(&left_out, items, |items| clusters[center].push(Run::new(cell, items)));
        });
        let mut seen = 0;
        for cluster in clusters.iter().filter(|cluster| !cluster.is_empty()) {
            let items: Vec<u32> = cluster.iter().flat_map(Run::items).collect();
            assert!(items.iter().all(|item| !left_out.contains(item)), "{what}");
            seen += items.len();
            let expected = Ball::of_all(&cloud.items, &items, &mut work);
            // Several items of the cluster, and some of others.
            let stale: Vec<u32> = (0..900).step_by(61).collect();
            let few = [items[0], items[items.len() / 2], items[items.len() - 1]];
            for before in [&[][..], &stale[..3], &few, &expected.support] {
                let ball = ball_of(cloud, cluster, before, &mut work);
                assert!(items.iter().all(|&item| ball.holds(&cloud.items, item)), "{what}");
                let ratio = ball.radius / expected.radius;
                assert!((ratio - 1.0).abs() < 1e-12 || items.len() == 1, "{what}: {ratio}");
            }
        }
        assert_eq!(seen, cloud.len() - left_out.len(), "{what}");
    }

    /// Lloyd's steps that look at all items.
    fn plain_improve<P: Position>(
        cloud: &Cloud<P>,
        mut best: Incumbent<P>,
        k: usize,
        z: usize,
    ) -> Incumbent<P> {
        let mut work = Workspace::new(cloud.items.dim());
        loop {
            let left_out: Vec<u32> =
                cloud.farthest(&best.centers, z).iter().map(|far| far.item).collect();
            let mut centers = best.centers.clone();
            if centers.len() < k {
                let far = cloud.farthest(&centers, z + 1)[z].item;
                centers.push(cloud.place_of(far));
            }
            let mut clusters = vec![vec![]; centers.len()];
            cloud.assign(&centers, |item, center, _| {
                if !left_out.contains(&(item as u32)) {
                    clusters[center].push(item as u32);
                }
            });
            for (center, cluster) in centers.iter_mut().zip(&clusters) {
                if !cluster.is_empty() {
                    *center = Ball::of_all(&cloud.items, cluster, &mut work).center;
                }
            }
            let next = measured(cloud, centers, z);
            if next.radius >= best.radius * (1.0 - LLOYD_GAIN_MIN) {
                return if next.radius < best.radius { next } else { best };
            }
            best = next;
        }
    }

    #[test]
    fn steps_are_those_of_a_look_at_all_items() {
        let mut steps = 0;
        for (seed, k, z) in [(1, 3, 0), (2, 5, 0), (3, 5, 4), (4, 8, 40), (5, 1, 3), (6, 9, 0)] {
            for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
                let cloud = cloud::<[f64; 2]>(shape, 2, 1e9, seed);
                for given in [k, k - k / 3] {
                    let centers = (0..given).map(|at| cloud.items.position(at * 97)).collect();
                    let start = measured(&cloud, centers, z);
                    let expected = plain_improve(&cloud, start.clone(), k, z);
                    let found = improve(&cloud, start.clone(), k, z, &Monitor::silent()).unwrap();
                    let ratio = found.radius / expected.radius;
                    // Items that determine a ball are equally far, and rounding says which of them are left out.
                    let tolerance = if z == 0 { 1e-9 } else { 0.1 };
                    assert!(
                        (ratio - 1.0).abs() < tolerance,
                        "{shape:?}, k = {k}, z = {z}: {ratio}"
                    );
                    steps += usize::from(found.radius < 0.9 * start.radius);
                }
            }
        }
        assert!(steps > 15, "{steps}");
    }

    /// A point outside by δ raises the radius by δ²/2, less than rounding, and the one opposite by δ.
    #[test]
    fn a_point_that_raises_the_radius_by_nothing_does_not_end_the_ball() {
        let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
        for place in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0 + 2e-7], [0.0, -1.0 - 1.9e-7]] {
            items.push(&place, 0.0);
        }
        let cloud = Cloud::new(items, &[]);
        let number = |x: f64| (0..4).find(|&item| cloud.items.at(item as usize)[0] == x).unwrap();
        let cluster = [Run::new(0, 0..4)];
        let mut work = Workspace::new(2);
        let ball = ball_of(&cloud, &cluster, &[number(1.0), number(-1.0)], &mut work);
        let across = [number(1.0), number(-1.0)];
        let others = (0..4).filter(|item| !across.contains(item));
        let in_order: Vec<u32> = across.into_iter().chain(others).collect();
        for ball in [ball, Ball::of_all(&cloud.items, &in_order, &mut work)] {
            assert!((ball.radius - (1.0 + 1.95e-7)).abs() < 1e-13, "{}", ball.radius);
        }
    }

    #[test]
    fn balls_of_clusters_are_those_of_a_look_at_all_items() {
        for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
            for (seed, grid) in [(1, 1e9), (2, 30.0), (3, 2.0)] {
                let what = format!("{shape:?}, grid 1/{grid}");
                judge(&cloud::<[f64; 2]>(shape, 2, grid, seed), &what);
                judge(&cloud::<[f64; 3]>(shape, 3, grid, seed), &what);
                judge(&cloud::<Vec<f64>>(shape, 1, grid, seed), &what);
                judge(&cloud::<Vec<f64>>(shape, 6, grid, seed), &what);
            }
        }
    }

    #[test]
    fn runs_without_what_is_left_out() {
        let left = |left_out: &[u32], items: Range<usize>| {
            let mut left = vec![];
            visit_remaining(left_out, items, |items| left.push((items.start, items.end)));
            left
        };
        assert_eq!(left(&[], 3..9), [(3, 9)]);
        assert_eq!(left(&[1, 2, 9], 3..9), [(3, 9)]);
        assert_eq!(left(&[3, 5, 6, 8], 3..9), [(4, 5), (7, 8)]);
        assert_eq!(left(&[3, 4], 3..5), []);
    }
}
