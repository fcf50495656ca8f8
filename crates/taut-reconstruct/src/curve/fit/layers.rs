//! Curves in layers: those that hide others are found first, then the others among the points that are left.
//!
//! *Problem.* A window around a sparse curve beside a dense one holds more points of that than of its own, and its seeds are lost.
//! *Idea.* Where closed curves are found and beside them open ones or points off all curves, the points of the closed ones are taken away,
//! and the others are searched again alone. What is found so takes the place of the open curves if it has no more of them and fewer points
//! are left off all curves, or as many and fewer curves are open.
//! *Guarantee.* A function of the points that turns and scales with them; at most [`LAYERS_MAX`] searches.

use taut_points::Monitor;

use super::link::Chain;
use super::noise::Noise;
use super::parameters::{
    BAND_DEVIATIONS, BESIDE_SHARE_MAX, EDGE_DEVIATIONS_MAX, LAYER_POINTS_MIN, LAYERS_MAX,
    NODES_PER_SEED, NOISE_RATIO_MIN, NOISE_SEEDS, POINT_DEVIATIONS_MAX,
};
use super::spline::{Spline, assign};
use super::{corners, ends, kinks, link, noisiness, regress, seeds};
use crate::Error;
use crate::curve::Ends;
use crate::curve::index::Index;

type Point = [f64; 2];

/// Curves through points.
pub(super) struct Layer {
    pub(super) splines: Vec<Spline>,
    pub(super) noise: Noise,
    /// The points that are on no curve, ascending.
    pub(super) outliers: Vec<u32>,
    /// Seeds of all searches.
    pub(super) seeds: usize,
    /// Nodes that were put straight, in all rounds.
    pub(super) straightened: usize,
}

/// The curves of points, layer by layer.
pub(super) fn layers(
    points: &[Point],
    index: &Index<'_>,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<Layer, Error> {
    let mut found = Layer::of(points, index, ends, monitor)?;
    for _ in 1..LAYERS_MAX {
        let Some(next) = found.deeper(points, ends, monitor)? else { break };
        found = next;
    }
    Ok(found)
}

impl Layer {
    /// The curves that all points together show.
    fn of(
        points: &[Point],
        index: &Index<'_>,
        joining: Ends,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let found = seeds::seeds(points, index, monitor)?;
        let chains = link::chains(&found, joining);
        let through = |chains: &[Chain]| {
            let mut splines: Vec<Spline> = chains.iter().cloned().map(Spline::through).collect();
            assign(&mut splines, points, POINT_DEVIATIONS_MAX);
            splines
        };
        let mut splines = through(&chains);
        monitor.check()?;
        if joining == Ends::Auto
            && let Some(chains) = ends::joined(&chains, &splines, points, index, monitor)?
        {
            splines = through(&chains);
            monitor.check()?;
        }
        let mut layer = Self {
            splines,
            noise: Noise::UNKNOWN,
            outliers: Vec::new(),
            seeds: found.len(),
            straightened: 0,
        };
        layer.refine(NODES_PER_SEED, false);
        layer.finish(points, monitor)?;
        Ok(layer)
    }

    /// Fits the splines to their members.
    fn refine(&mut self, parts: usize, is_last: bool) {
        let one = |s: &Spline| {
            let mut nodes = regress::regress(s, parts, &self.noise);
            if is_last {
                let found = corners::corners(s);
                corners::insert(&mut nodes, s, &found);
            }
            let straightened = kinks::straighten(&mut nodes, s.closed);
            (Spline::new(nodes, s.closed, NOISE_SEEDS * NODES_PER_SEED), straightened)
        };
        let (splines, straightened): (Vec<Spline>, Vec<usize>) =
            self.splines.iter().map(one).unzip();
        self.splines = splines;
        self.straightened += straightened.iter().sum::<usize>();
    }

    /// Fits the splines once more, now to the noise that there is, and finds the outliers.
    fn finish(&mut self, points: &[Point], monitor: &Monitor<'_>) -> Result<(), Error> {
        assign(&mut self.splines, points, POINT_DEVIATIONS_MAX);
        monitor.check()?;
        // Of a spline without noise, distances are those of polylines.
        let noisy =
            self.splines.iter().filter(|s| noisiness(std::slice::from_ref(s)) > NOISE_RATIO_MIN);
        self.noise = Noise::of(noisy, POINT_DEVIATIONS_MAX);
        self.refine(1, true);
        let width = self.noise.edge.map_or(POINT_DEVIATIONS_MAX, |edge| EDGE_DEVIATIONS_MAX * edge);
        self.outliers = assign(&mut self.splines, points, width);
        Ok(monitor.check()?)
    }

    /// The layer with its closed curves kept and all else searched again among the points that are not on them; none if that is no better.
    fn deeper(
        &self,
        points: &[Point],
        ends: Ends,
        monitor: &Monitor<'_>,
    ) -> Result<Option<Self>, Error> {
        let is_open = |s: &&Spline| !s.closed;
        let loose = self.splines.iter().filter(is_open).count();
        if loose == self.splines.len() || loose == 0 && self.outliers.len() < LAYER_POINTS_MIN {
            return Ok(None);
        }
        let width = self.noise.edge.unwrap_or(BAND_DEVIATIONS);
        let mut is_left = vec![true; points.len()];
        for member in self.splines.iter().filter(|s| s.closed).flat_map(|s| &s.members) {
            is_left[member.site as usize] = member.share > width;
        }
        let left: Vec<Point> =
            points.iter().zip(&is_left).filter(|(_, left)| **left).map(|(&p, _)| p).collect();
        if left.len() < LAYER_POINTS_MIN {
            return Ok(None);
        }
        let below = Self::of(&left, &Index::new(&left), ends, monitor)?;
        let mut kept: Vec<Spline> = self.splines.iter().filter(|s| s.closed).cloned().collect();
        let found = apart(below.splines, &mut kept);
        monitor.check()?;
        let loose_below = found.iter().filter(is_open).count();
        // Curves that chance shows among outliers hold few of them.
        if loose_below > loose || 2 * below.outliers.len() > left.len() {
            return Ok(None);
        }
        let mut all = Self {
            splines: kept.into_iter().chain(found).collect(),
            noise: Noise::UNKNOWN,
            outliers: Vec::new(),
            seeds: self.seeds + below.seeds,
            straightened: self.straightened + below.straightened,
        };
        all.finish(points, monitor)?;
        let (before, after) = (self.outliers.len(), all.outliers.len());
        Ok((after < before || after == before && loose_below < loose).then_some(all))
    }
}

/// The splines that run beside others and not within their bands: what a band has left of its points shows curves along it.
fn apart(splines: Vec<Spline>, others: &mut [Spline]) -> Vec<Spline> {
    let nodes =
        || splines.iter().enumerate().flat_map(|(k, s)| s.nodes.iter().map(move |n| (k, n)));
    let places: Vec<Point> = nodes().map(|(_, node)| node.at).collect();
    let owner: Vec<usize> = nodes().map(|(k, _)| k).collect();
    let mut far = vec![0; splines.len()];
    for place in assign(others, &places, BAND_DEVIATIONS) {
        far[owner[place as usize]] += 1;
    }
    let is_apart = |s: &Spline, far: usize| {
        (s.nodes.len() - far) as f64 <= BESIDE_SHARE_MAX * s.nodes.len() as f64
    };
    splines.into_iter().zip(far).filter(|(s, far)| is_apart(s, *far)).map(|(s, _)| s).collect()
}
