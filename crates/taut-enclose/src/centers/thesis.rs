//! Algorithm 2 of the thesis, with a bound that is valid in place of its own. Kept so that its tables and figures can be rerun;
//! [`super::tree`] needs a thousandth of its nodes and less.
//!
//! *Idea.* The item farthest from all balls is given to each of them in turn, the nearest ball first. σ is the best radius so far; a
//! branch ends when one of its balls has a radius of σ/(1 + ε) or more.
//! *Guarantee.* Radius ≤ (1 + ε)·σ*.
//! *Departures.* The thesis ends a branch when the item is farther than σ from the center of the ball that it is to join. That is
//! not valid, as the center moves: at distance D from the center of a smallest ball of radius r < D, the new radius is at least
//! (D² + r²)/2D and may be as small as that. That bound is asked first, then the ball is made. The index in line 10 of the algorithm
//! should be j. Of the balls that are still empty, only the first is tried, as all are the same. The radius from the centers of
//! each node is a bound on σ*, not only that of the leaves.
//! *Reference.* Thesis, section 2.5.

use taut_certify::{PassBounds, Stop};
use taut_points::{Monitor, OrderBy, ReadError};

use super::cloud::Cloud;
use super::items::{Position, Shape, distance};
use super::small_ball::{Ball, Workspace};
use super::start::Incumbent;
use super::tree::{ProvedBound, SearchResult};
use crate::Error;

struct Cluster<P> {
    members: Vec<u32>,
    ball: Ball<P>,
}

/// A node under way: the clusters that the item joins, in this order; a number beyond them stands for the first empty one.
struct Frame<P> {
    item: u32,
    joins: Vec<usize>,
    next: usize,
    undo: Option<(usize, Option<Ball<P>>)>,
}

/// Solves to a gap of `epsilon`, from the centers of a traversal.
pub(super) fn solve<P: Position>(
    cloud: &Cloud<P>,
    plain: Incumbent<P>,
    k: usize,
    epsilon: f64,
    max_nodes: u64,
    monitor: &Monitor<'_>,
) -> Result<SearchResult<P>, Error> {
    let items = &cloud.items;
    let mut work = Workspace::new(items.dim());
    let mut best = plain;
    let mut clusters: Vec<Cluster<P>> = vec![];
    let mut frames: Vec<Frame<P>> = vec![];
    let mut core_set: Vec<u32> = vec![];
    let mut nodes = 0;
    let stop = 'search: loop {
        if nodes == max_nodes {
            break Stop::NodeBudget;
        }
        nodes += 1;
        monitor.check().map_err(ReadError::from)?;
        let centers: Vec<P> = clusters.iter().map(|cluster| cluster.ball.center.clone()).collect();
        let p = cloud.farthest(&centers, 1)[0];
        if p.reach < best.radius {
            best = Incumbent { centers, radius: p.reach };
        }
        let threshold = best.radius / (1.0 + epsilon);
        if clusters.iter().all(|cluster| cluster.ball.radius < threshold) {
            core_set.push(p.item);
            frames.push(branch(cloud, &clusters, p.item, k, threshold, &mut work));
        }
        loop {
            let Some(frame) = frames.last_mut() else { break 'search Stop::Converged };
            match frame.undo.take() {
                Some((at, Some(ball))) => {
                    clusters[at].members.pop();
                    clusters[at].ball = ball;
                }
                Some((_, None)) => drop(clusters.pop()),
                None => {}
            }
            let Some(&at) = frame.joins.get(frame.next) else {
                frames.pop();
                continue;
            };
            frame.next += 1;
            if let Some(cluster) = clusters.get_mut(at) {
                frame.undo = Some((at, Some(cluster.ball.clone())));
                cluster.ball.grow(items, &cluster.members, frame.item, f64::INFINITY, &mut work);
                cluster.members.push(frame.item);
            } else {
                frame.undo = Some((at, None));
                let ball = Ball::of_one(items, frame.item);
                clusters.push(Cluster { members: vec![frame.item], ball });
            }
            break;
        }
    };
    core_set.sort_unstable();
    core_set.dedup();
    let threshold = best.radius / (1.0 + epsilon);
    let is_shown = stop == Stop::Converged;
    let proved = is_shown.then_some(ProvedBound { threshold, items: core_set.len() });
    let lower = proved.map_or(0.0, |proved| proved.threshold);
    let history =
        vec![PassBounds { lower, upper: best.radius, working_set: core_set.len() as u64 }];
    Ok(SearchResult {
        incumbent: best,
        proved: proved.into_iter().collect(),
        refuted: None,
        core_set,
        stop,
        nodes,
        restarts: 0,
        scans: nodes,
        history,
    })
}

/// The clusters that p can join, the nearest center first.
fn branch<P: Position>(
    cloud: &Cloud<P>,
    clusters: &[Cluster<P>],
    p: u32,
    k: usize,
    threshold: f64,
    work: &mut Workspace<P>,
) -> Frame<P> {
    let items = &cloud.items;
    let mut order: Vec<(f64, usize)> = vec![];
    for (at, cluster) in clusters.iter().enumerate() {
        let r = cluster.ball.radius;
        let d = distance(items.at(p as usize), cluster.ball.center.as_ref());
        let is_too_far =
            items.shape() == Shape::Points && d > r && d * d + r * r >= 2.0 * d * threshold;
        if !is_too_far
            && work.radius_with(items, &cluster.ball, &cluster.members, p, threshold) < threshold
        {
            order.push((d, at));
        }
    }
    order.order_by(&|a, b| a.0.total_cmp(&b.0));
    let mut joins: Vec<usize> = order.into_iter().map(|(_, at)| at).collect();
    if clusters.len() < k && items.radius(p as usize) < threshold {
        joins.push(clusters.len());
    }
    Frame { item: p, joins, next: 0, undo: None }
}
