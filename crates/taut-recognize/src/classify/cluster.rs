//! Clusters from the ball of a kernel (support vector clustering; thesis, 7.6).
//!
//! *Idea.* In the space of the points, the ball of a Gaussian kernel is a set with several components; each is a cluster. Two points are
//! in one cluster if the segment between them stays inside, which is tested at some points of it, or a chain of such segments joins
//! them. Tested are segments between near neighbors, then those between the nearest points of any two of the parts that these leave.
//! *Guarantee.* None: a gap between two tested points of a segment is not seen.
//! *Reference.* Ben-Hur, Horn, Siegelmann and Vapnik, Support vector clustering, JMLR 2, 2001.

use std::collections::BTreeMap;

use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{InputError, Monitor, Points, on_threads};

use super::ball::{BallParameters, Balls, check_nu};
use super::data::{Rows, check_finite};
use super::method::Cells;
use super::width::{Width, squared_distance};
use super::{Classifier, Score};
use crate::Error;

/// How to cluster. Write `ClusterOptions { nu: Some(0.1), ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct ClusterOptions<'a> {
    /// The width of the kernel: the narrower, the more clusters. Default: [`Width::Scale`] with a factor of 8.
    pub width: Width,
    /// ν in (0, 1]: at most this share of the points is in no cluster. Default `None`: all are in one.
    pub nu: Option<f64>,
    /// Nearest neighbors of each point to which segments are tested, at least 1. Default 16.
    pub neighbors: usize,
    /// Points of each segment that are tested, at least 1. Default 10.
    pub samples: usize,
    /// Relative gap of the objective of the ball. Range (0, 1), default 1e-6.
    pub epsilon: f64,
    /// Draws the first points of the search for the ball. Default 0.
    pub seed: u64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The clusters do not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for ClusterOptions<'_> {
    fn default() -> Self {
        ClusterOptions {
            width: Width::Scale { factor: 8.0 },
            nu: None,
            neighbors: 16,
            samples: 10,
            epsilon: 1e-6,
            seed: 0,
            threads: None,
            monitor: Monitor::silent(),
        }
    }
}

/// Clusters of points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clustering {
    /// The number of the cluster of each point, in the order of their first points; none for a point outside the ball.
    pub clusters: Vec<Option<u32>>,
    /// The number of clusters.
    pub count: u32,
}

/// Finds clusters; their number follows from the width of the kernel.
///
/// ```
/// use taut_recognize::classify::{ClusterOptions, cluster};
///
/// let points = taut_points::Points::new(&[0.0, 0.1, 0.2, 5.0, 5.1], 1)?;
/// let found = cluster(points, &ClusterOptions::default())?;
/// assert_eq!(found.clusters, [0, 0, 0, 1, 1].map(Some));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Enclose`] where there is no point, [`Error::Overflow`], and [`Error::Input`] for bad points and options.
pub fn cluster(points: Points<'_, f64>, options: &ClusterOptions<'_>) -> Result<Clustering, Error> {
    check_nu(options.nu)?;
    for (name, value) in [("neighbors", options.neighbors), ("samples", options.samples)] {
        if value == 0 {
            return Err(Error::option(name, "0".to_owned(), "at least 1"));
        }
    }
    check_finite(&points)?;
    if points.is_empty() {
        return Err(taut_enclose::Error::Empty.into());
    }
    on_threads(options.threads, || find(points, options))
}

fn find(points: Points<'_, f64>, options: &ClusterOptions<'_>) -> Result<Clustering, Error> {
    let rows = Rows {
        values: points.values().to_vec(),
        dim: points.dim(),
        labels: vec![0; points.len()],
        classes: 1,
    };
    let ClusterOptions { nu, epsilon, seed, ref monitor, .. } = *options;
    let gamma = options.width.gamma(&rows)?;
    let parameters = BallParameters { gamma, cells: Cells::Power, nu, steps: None, epsilon, seed };
    let ball = Balls::learn(&rows, &parameters, monitor)?;
    let is_inside = |x: &[f64]| {
        let mut out = [Score::default()];
        ball.scores(x, &mut out);
        // Squared distances are at most 4; the gap of the ball moves the border by less than this.
        out[0].value >= -4.0 * epsilon
    };
    let inside: Vec<usize> =
        (0..points.len()).into_par_iter().filter(|&i| is_inside(points.row(i))).collect();
    let is_joined = |i: usize, j: usize| {
        let (x, y) = (points.row(i), points.row(j));
        (1..=options.samples).all(|k| {
            let t = k as f64 / (options.samples + 1) as f64;
            is_inside(&x.iter().zip(y).map(|(x, y)| x + t * (y - x)).collect::<Vec<_>>())
        })
    };
    let near = |&i: &usize| {
        monitor.check().map_err(InputError::from)?;
        let others = nearest(points, i, &inside, options.neighbors);
        Ok(others.into_iter().filter(|&j| is_joined(i, j)).map(|j| (i, j)).collect::<Vec<_>>())
    };
    let edges: Vec<Result<Vec<(usize, usize)>, Error>> = inside.par_iter().map(near).collect();
    let mut forest = Forest((0..points.len()).collect());
    for edges in edges {
        edges?.into_iter().for_each(|(i, j)| forest.join(i, j));
    }
    let between = between_parts(points, &inside, &mut forest);
    let kept: Vec<bool> = between.par_iter().map(|&(i, j)| is_joined(i, j)).collect();
    for (&(i, j), _) in between.iter().zip(kept).filter(|pair| pair.1) {
        forest.join(i, j);
    }
    Ok(forest.clusters(&inside))
}

/// The nearest points of point `i` among some others.
fn nearest(points: Points<'_, f64>, i: usize, others: &[usize], count: usize) -> Vec<usize> {
    let x = points.row(i);
    let others = others.iter().filter(|&&j| j != i);
    let mut others: Vec<(f64, usize)> =
        others.map(|&j| (squared_distance(x, points.row(j)), j)).collect();
    let count = count.min(others.len());
    if count < others.len() {
        others.select_nth_unstable_by(count, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
    others[..count].iter().map(|other| other.1).collect()
}

/// For any two parts their nearest points, the first of equal ones.
fn between_parts(
    points: Points<'_, f64>,
    inside: &[usize],
    forest: &mut Forest,
) -> Vec<(usize, usize)> {
    let roots: Vec<usize> = inside.iter().map(|&i| forest.root(i)).collect();
    let from = |at: usize| {
        let mut nearest: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
        for (&j, &root) in inside.iter().zip(&roots).filter(|other| *other.1 > roots[at]) {
            let square = squared_distance(points.row(inside[at]), points.row(j));
            let best = nearest.entry(root).or_insert((square, j));
            if square < best.0 {
                *best = (square, j);
            }
        }
        nearest
    };
    let all: Vec<BTreeMap<usize, (f64, usize)>> =
        (0..inside.len()).into_par_iter().map(from).collect();
    let mut best: BTreeMap<(usize, usize), (f64, (usize, usize))> = BTreeMap::new();
    for (at, nearest) in all.into_iter().enumerate() {
        for (root, (square, j)) in nearest {
            let pair = (square, (inside[at], j));
            let best = best.entry((roots[at], root)).or_insert(pair);
            if square < best.0 {
                *best = pair;
            }
        }
    }
    best.into_values().map(|best| best.1).collect()
}

/// Trees of points; the root of each is its first point.
struct Forest(Vec<usize>);

impl Forest {
    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.root(i), self.root(j));
        self.0[a.max(b)] = a.min(b);
    }

    /// The trees of some points, in the order of their roots.
    fn clusters(mut self, inside: &[usize]) -> Clustering {
        let count = self.0.len();
        let (mut clusters, mut numbers) = (vec![None; count], vec![None; count]);
        let mut count = 0;
        for &i in inside {
            let own = *numbers[self.root(i)].get_or_insert_with(|| {
                count += 1;
                count - 1
            });
            clusters[i] = Some(own);
        }
        Clustering { clusters, count }
    }
}
