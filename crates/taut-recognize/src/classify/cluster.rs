//! Clusters from the ball of a kernel (support vector clustering; thesis, 7.6).
//!
//! *Idea.* In the space of the points, the ball of a Gaussian kernel is a set with several components; each is a cluster. Two points are
//! in one cluster if the segment between them stays inside, which is tested at some points of it, or a chain of such segments joins
//! them. Only segments between near neighbors are tested.
//! *Guarantee.* None: a gap between two tested points of a segment is not seen.
//! *Reference.* Ben-Hur, Horn, Siegelmann and Vapnik, Support vector clustering, JMLR 2, 2001.

use rayon::prelude::*;
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
    let joined = |&i: &usize| {
        monitor.check().map_err(InputError::from)?;
        let x = points.row(i);
        let mut others: Vec<(f64, usize)> = inside
            .iter()
            .filter(|&&j| j != i)
            .map(|&j| (squared_distance(x, points.row(j)), j))
            .collect();
        let near = options.neighbors.min(others.len());
        if near < others.len() {
            others.select_nth_unstable_by(near, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        let is_joined = |j: usize| {
            (1..=options.samples).all(|k| {
                let t = k as f64 / (options.samples + 1) as f64;
                let between = x.iter().zip(points.row(j)).map(|(x, y)| x + t * (y - x));
                is_inside(&between.collect::<Vec<_>>())
            })
        };
        Ok(others[..near].iter().map(|other| other.1).filter(|&j| is_joined(j)).collect())
    };
    let edges: Vec<Result<Vec<usize>, Error>> = inside.par_iter().map(joined).collect();
    let edges = edges.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(components(points.len(), &inside, &edges))
}

/// The components of a graph, in the order of their first points.
fn components(points: usize, inside: &[usize], edges: &[Vec<usize>]) -> Clustering {
    let mut parent: Vec<usize> = (0..points).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for (&i, edges) in inside.iter().zip(edges) {
        for &j in edges {
            let (a, b) = (root(&mut parent, i), root(&mut parent, j));
            parent[a.max(b)] = a.min(b);
        }
    }
    let (mut clusters, mut number, mut count) = (vec![None; points], vec![None; points], 0);
    for &i in inside {
        // The root of a component is its first point.
        let root = root(&mut parent, i);
        let own = *number[root].get_or_insert_with(|| {
            count += 1;
            count - 1
        });
        clusters[i] = Some(own);
    }
    Clustering { clusters, count }
}
