//! Rounds of a search over points of ellipsoids, and of measuring ellipsoids whole.
//!
//! *Round.* The tree over the known points ends with centers and a lower bound. Each ellipsoid is measured whole from these centers.
//! Lloyd's steps follow: every center becomes that of the smallest ball of the ellipsoids it serves, which asks for further points of
//! them until the ball holds them whole. Last, ellipsoids that reach beyond the radius of the tree get points that lie beyond it,
//! as seen from every center that could serve them.
//! *Guarantee.* The lower bounds of all rounds hold, as the points of one are among those of the next; each tree begins with the
//! core-set of the one before. A round that finds no further point leaves a gap no larger than that of its tree, and the next has a
//! smaller one to reach.
//! *Trap.* Rounding alone may keep the two apart. A round after which nothing is known that was not known before it is the last, and so is
//! one after some that have brought the bounds no nearer to each other, where these are as near as rounding can keep apart.

use taut_certify::{PassBounds, Stop};
use taut_points::{Monitor, OrderBy, ReadError};

use super::bodies::{Bodies, ServedWhole, length};
use super::pool::{Numbered, Pool};
use crate::Error;
use crate::centers::items::Position;
use crate::centers::proof::rounding;
use crate::centers::small_ball::{Ball, Workspace};
use crate::centers::start::{Incumbent, Start, measured, start};
use crate::centers::tree::{self, ProvedBound, SearchResult};
use crate::centers::{GAP_MIN, ROUNDING};

/// The gap of the first trees.
const FIRST_GAP: f64 = 0.1;
/// The gap of a tree is this part of that found, and of that wanted at least.
const TREE_SHARE: f64 = 0.5;
/// The ball of the ellipsoids of a center leaves out no more than this part of the gap of the tree.
const BALL_SHARE: f64 = 0.02;
/// What lies beyond a radius by no more than this part of it does so by rounding, and by so many times what places are off by.
const BEYOND: f64 = 1e-12;
const PLACES_BEYOND: f64 = 4.0;
/// The same for the balls of Lloyd's steps.
const BALL_BEYOND: f64 = 1e-13;
/// Lloyd's steps end when one gains less than this part of the gap of the tree.
const LLOYD_SHARE: f64 = 0.05;
/// And after this many; two to five are usual.
const LLOYD_STEPS_MAX: usize = 30;
/// A ball asks for further points at most this often; five to ten times are usual.
const BALL_STEPS_MAX: usize = 100;
/// This many rounds without a better gap show that rounding is in the way, where the gap is below this or so many times what rounding of
/// the proof comes to.
const STALE_ROUNDS_MAX: u32 = 6;
const STALE_GAP: f64 = 1e-6;
const STALE_ROUNDINGS: f64 = 64.0;
/// Ellipsoids that get points after a tree, for each center and beside these.
const TAKEN_PER_CENTER: usize = 4;
const TAKEN: usize = 16;
/// Centers from which an ellipsoid reaches no farther than so many radii could serve it.
const SERVING_RADII: f64 = 2.0;

/// Centers with all that is known of them.
#[derive(Clone)]
pub(super) struct Best<P> {
    pub(super) centers: Vec<P>,
    pub(super) radius: f64,
}

/// What the rounds have led to.
pub(super) struct Found<P> {
    pub(super) best: Best<P>,
    /// The last cloud, and what was shown of it.
    pub(super) numbered: Numbered<P>,
    pub(super) proved: Vec<ProvedBound>,
    /// Items of that cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) separated: Vec<u32>,
    pub(super) stop: Stop,
    pub(super) nodes: u64,
    pub(super) restarts: u64,
    pub(super) scans: u64,
    pub(super) rounds: u64,
    pub(super) history: Vec<PassBounds>,
}

/// A search in progress.
pub(super) struct Rounds<'a, P> {
    bodies: &'a Bodies<'a>,
    pub(super) pool: Pool<'a, P>,
    k: usize,
    z: usize,
    monitor: &'a Monitor<'a>,
    work: Workspace<P>,
    best: Option<Best<P>>,
}

impl<'a, P: Position> Rounds<'a, P> {
    pub(super) fn new(
        bodies: &'a Bodies<'a>,
        k: usize,
        z: usize,
        monitor: &'a Monitor<'a>,
    ) -> Self {
        let (pool, work) = (Pool::new(bodies), Workspace::new(bodies.dim()));
        let mut rounds = Rounds { bodies, pool, k, z, monitor, work, best: None };
        rounds.take_first();
        rounds
    }

    /// Ellipsoids far from one another, as many as a search over points begins with, and that with the longest axis.
    fn take_first(&mut self) {
        let bodies = self.bodies;
        let count = (2 * self.k).saturating_add(self.z).saturating_add(bodies.dim() + 1);
        let mut reaches = vec![f64::INFINITY; bodies.len()];
        let mut next = 0;
        for _ in 0..count.min(bodies.len()) {
            self.pool.take(next);
            let center = bodies.center(next);
            // It is not to come again.
            reaches[next] = f64::NEG_INFINITY;
            for (i, reach) in reaches.iter_mut().enumerate() {
                *reach = reach.min(length(bodies.center(i), center) + bodies.longest[i]);
            }
            next = first_of_largest(&reaches);
        }
        self.pool.take(first_of_largest(&bodies.longest));
    }

    /// Solves to this gap, or as near to it as nodes and rounding allow.
    pub(super) fn run(&mut self, epsilon: f64, max_nodes: u64) -> Result<Found<P>, Error> {
        let wanted = (epsilon - GAP_MIN).max(0.5 * ROUNDING);
        let least = (TREE_SHARE * wanted).max(GAP_MIN);
        let mut lower = 0.0f64;
        let (mut core_set, mut separated, mut proved) = (vec![], vec![], vec![]);
        let (mut nodes, mut restarts, mut scans, mut rounds) = (0, 0, 0, 0);
        let mut history = vec![];
        let mut gap = least.max(FIRST_GAP);
        let (mut nearest, mut stale) = (f64::INFINITY, 0);
        loop {
            rounds += 1;
            let numbered = self.pool.cloud();
            let cloud = &numbered.cloud;
            let start = match &self.best {
                None => {
                    let start = start(cloud, self.k, self.z, self.monitor)?;
                    lower = lower.max(start.lower);
                    separated = numbered.points(&start.separated);
                    start
                }
                Some(best) => {
                    let incumbent = measured(cloud, best.centers.clone(), self.z);
                    let (plain, traversal) = (incumbent.clone(), numbered.items(&core_set));
                    Start { incumbent, plain, lower, separated: vec![], traversal }
                }
            };
            let left = max_nodes.saturating_sub(nodes);
            let found = tree::solve(cloud, start, self.k, self.z, gap, left, self.monitor)?;
            let SearchResult { incumbent, stop, .. } = found;
            core_set = numbered.points(&found.core_set);
            lower = found.proved.iter().map(|bound| bound.threshold).fold(lower, f64::max);
            proved.extend(found.proved);
            nodes += found.nodes;
            restarts += found.restarts;
            scans += found.scans;
            let known = self.pool.len();
            let before = self.best.as_ref().map_or(f64::INFINITY, |best| best.radius);
            self.measure(&incumbent, gap)?;
            let best = self.best.clone().expect("centers were just measured");
            let working_set = core_set.len() as u64;
            history.push(PassBounds { lower, upper: best.radius, working_set });
            let rounding = rounding(cloud, lower.max(f64::MIN_POSITIVE));
            let sure = lower * (1.0 - rounding);
            let open = if sure > 0.0 { best.radius / sure - 1.0 } else { f64::INFINITY };
            let is_known = self.pool.len() == known && best.radius >= before;
            stale = if open < nearest { 0 } else { stale + 1 };
            nearest = nearest.min(open);
            let is_stale =
                stale >= STALE_ROUNDS_MAX && nearest <= (STALE_ROUNDINGS * rounding).max(STALE_GAP);
            let stop = match stop {
                _ if open <= wanted => Stop::Converged,
                Stop::NodeBudget => Stop::NodeBudget,
                _ if is_known && gap <= least || is_stale => Stop::Rounding,
                _ => {
                    let next = (TREE_SHARE * open).clamp(least, FIRST_GAP.max(least));
                    // Where nothing is new, the tree alone keeps the bounds apart.
                    gap = if is_known { next.min(TREE_SHARE * gap).max(least) } else { next };
                    continue;
                }
            };
            proved.order_by(&|a, b| a.threshold.total_cmp(&b.threshold));
            let (core_set, separated) = (numbered.items(&core_set), numbered.items(&separated));
            return Ok(Found {
                best,
                numbered,
                proved,
                core_set,
                separated,
                stop,
                nodes,
                restarts,
                scans,
                rounds,
                history,
            });
        }
    }

    /// Measures the ellipsoids from the centers of a tree; then Lloyd's steps, and points of what lies beyond its radius.
    fn measure(&mut self, found: &Incumbent<P>, gap: f64) -> Result<(), Error> {
        let served = self.bodies.served(&found.centers);
        let order = self.farthest_first(&served);
        let beyond = found.radius * (1.0 + BEYOND) + self.places();
        let most = self.z + TAKEN_PER_CENTER * self.k + TAKEN;
        let outside = order.iter().copied().take(most).take_while(|&i| served[i].reach > beyond);
        let outside: Vec<usize> = outside.collect();
        self.improve(found.centers.clone(), served, order, gap)?;
        for i in outside {
            self.take(i, &found.centers, beyond)?;
        }
        Ok(())
    }

    /// Adds points of an ellipsoid that lie beyond a radius from the centers that could serve it.
    fn take(&mut self, i: usize, centers: &[P], radius: f64) -> Result<(), Error> {
        self.monitor.check().map_err(ReadError::from)?;
        self.pool.take(i);
        for center in centers {
            let center = center.as_ref();
            if length(self.bodies.center(i), center) > SERVING_RADII * radius
                || self.bodies.reach(i, center) > SERVING_RADII * radius
            {
                continue;
            }
            for direction in self.bodies.farthest(i, center, radius) {
                self.pool.add(i, direction);
            }
        }
        // From far centers alone it is seen by the nearest.
        let near = |a: &&P, b: &&P| {
            let distance = |c: &P| length(self.bodies.center(i), c.as_ref());
            distance(a).total_cmp(&distance(b))
        };
        if let Some(center) = centers.iter().min_by(near) {
            for direction in self.bodies.farthest(i, center.as_ref(), radius) {
                self.pool.add(i, direction);
            }
        }
        Ok(())
    }

    /// In length, what rounding of places may make of something beyond a radius.
    fn places(&self) -> f64 {
        PLACES_BEYOND * self.bodies.place_error
    }

    /// Ellipsoids in the order of how far they reach.
    fn farthest_first(&self, served: &[ServedWhole]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..served.len()).collect();
        order.order_by(&|&a, &b| served[b].reach.total_cmp(&served[a].reach).then(a.cmp(&b)));
        order
    }

    /// Lloyd's steps, as long as the radius gets smaller; keeps the best centers.
    fn improve(
        &mut self,
        mut centers: Vec<P>,
        mut served: Vec<ServedWhole>,
        mut order: Vec<usize>,
        gap: f64,
    ) -> Result<(), Error> {
        let slack = (BALL_SHARE * gap).max(BALL_BEYOND);
        let mut radius = self.keep(&centers, &served, &order);
        for _ in 0..LLOYD_STEPS_MAX {
            let mut clusters = vec![vec![]; centers.len()];
            for &i in &order[self.z.min(order.len())..] {
                clusters[served[i].center].push(i);
            }
            let mut next = Vec::with_capacity(centers.len());
            for (cluster, center) in clusters.iter().zip(&centers) {
                next.push(match cluster[..] {
                    [] => center.clone(),
                    _ => self.ball(cluster, slack)?,
                });
            }
            centers = next;
            served = self.bodies.served(&centers);
            order = self.farthest_first(&served);
            let before = radius;
            radius = self.keep(&centers, &served, &order);
            if radius >= before * (1.0 - LLOYD_SHARE * gap) {
                break;
            }
        }
        Ok(())
    }

    /// Keeps centers if they are better than all before; their radius.
    fn keep(&mut self, centers: &[P], served: &[ServedWhole], order: &[usize]) -> f64 {
        let radius = order.get(self.z).map_or(0.0, |&i| served[i].reach);
        if self.best.as_ref().is_none_or(|best| radius < best.radius) {
            self.best = Some(Best { centers: centers.to_vec(), radius });
        }
        radius
    }

    /// The center of the smallest ball of ellipsoids, the farthest first, which may leave out `slack` of its radius.
    fn ball(&mut self, cluster: &[usize], slack: f64) -> Result<P, Error> {
        self.pool.take(cluster[0]);
        let mut members: Vec<u32> =
            cluster.iter().flat_map(|&i| self.pool.points_of(i)).copied().collect();
        let mut ball = Ball::of_all(&self.pool.places, &members, &mut self.work);
        for _ in 0..BALL_STEPS_MAX {
            self.monitor.check().map_err(ReadError::from)?;
            let (mut farthest, mut most) = (None, ball.radius * (1.0 + slack) + self.places());
            for &i in cluster {
                let center = ball.center.as_ref();
                // No point of it is farther than this.
                if length(self.bodies.center(i), center) + self.bodies.longest[i] <= most {
                    continue;
                }
                let reach = self.bodies.reach(i, center);
                if reach > most {
                    (farthest, most) = (Some(i), reach);
                }
            }
            let Some(i) = farthest else { break };
            let known = self.pool.points_of(i).len();
            if known == 0 {
                self.pool.take(i);
            }
            let beyond = ball.radius * (1.0 + BALL_BEYOND);
            for direction in self.bodies.farthest(i, ball.center.as_ref(), beyond) {
                self.pool.add(i, direction);
            }
            let new = self.pool.points_of(i)[known..].to_vec();
            if new.is_empty() {
                break;
            }
            for point in new {
                let places = &self.pool.places;
                ball.grow(places, &members, point, f64::INFINITY, &mut self.work);
                members.push(point);
            }
        }
        Ok(ball.center)
    }
}

/// The number of the largest value, the first of several.
fn first_of_largest(values: &[f64]) -> usize {
    let order = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]).then(b.cmp(a));
    (0..values.len()).max_by(order).unwrap_or(0)
}
