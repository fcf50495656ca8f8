//! How probable each Delaunay edge is an edge of the curve, if every site has two.
//!
//! *Problem.* The set of loops that is cheapest as a whole is often one of many that are nearly as cheap; what it shares with most of
//! them is surer than the rest of it.
//! *Idea.* A choice of two edges at each site has the weight exp(−`SHARPNESS` · cost); the cost of a site with edges a and b that turn
//! by α is (w(a) + w(b))(2 − cos α) / 2, with w the length to the power ¾ after division by the spacing around. Sites tell their
//! neighbors along each edge how much more probable their other edges make it that this one is there (sum-product, or belief
//! propagation), some rounds long. Spacings are smoothed, as a few near sites say little.
//! *Guarantee.* None: with cycles in the graph the probabilities are approximate, and rounds end before they settle.
//! *Trap.* Messages in logarithms cost ten times as much; as ratios they are kept within bounds, and damped by geometric means.
//! *Reference.* Kschischang, Frey and Loeliger, Factor graphs and the sum-product algorithm, 2001.

use taut_points::Monitor;

use super::corners::Graph;
use crate::Error;

/// How sharply costs tell choices apart. Of 1, 1.5, 2, 4 and 8, coastlines were found best with 2.
const SHARPNESS: f64 = 2.0;
/// What a missing edge costs, where an edge as long as the spacing costs one.
const MISSING_EDGE_COST: f64 = 5.0;
/// After this many rounds coastlines change by less than one edge in a thousand.
const ROUNDS_MAX: usize = 20;
/// Ratios of probabilities are at most this, and at least its inverse.
const PROBABILITY_RATIO_MAX: f64 = 1e12;

/// What an edge counts by its length in spacings: long edges where samples are sparse cost less beside short ones than in proportion.
/// Those of a million spacings and more, which may overflow, are all as unlikely.
fn weight(length: f64) -> f64 {
    let root = length.min(1e6).sqrt();
    root * root.sqrt()
}

/// Typical distances of neighbors around each site.
pub(super) fn spacings(graph: &Graph) -> Vec<f64> {
    let own = |site: u32| match graph.around(site) {
        [] => 1.0,
        [only] => only.0,
        [first, second, ..] => second.0.min(4.0 * first.0),
    };
    let mut logs: Vec<f64> = graph.sites().map(|site| own(site).ln()).collect();
    for _ in 0..2 {
        let smooth = |site: u32| {
            let around = graph.around(site);
            let sum: f64 = around.iter().map(|near| logs[near.1 as usize]).sum();
            (2.0 * logs[site as usize] + sum) / (2 + around.len()) as f64
        };
        logs = graph.sites().map(smooth).collect();
    }
    logs.into_iter().map(f64::exp).collect()
}

/// For each place in the lists of neighbors, the probability that its edge is there.
pub(super) fn probabilities(
    sites: &[[f64; 2]],
    graph: &Graph,
    spacings: &[f64],
    monitor: &Monitor<'_>,
) -> Result<Vec<f64>, Error> {
    let mut twins = Vec::new();
    let mut priors = Vec::new();
    let mut turns: Vec<f32> = Vec::new();
    for site in graph.sites() {
        let around = graph.around(site);
        for &(length, to) in around {
            let spacing = spacings[site as usize].sqrt() * spacings[to as usize].sqrt();
            priors.push((-SHARPNESS * weight(length / spacing)).exp());
            let back = graph.around(to).iter().position(|near| near.1 == site);
            twins.push(graph.first(to) + back.expect("edges are listed at both ends"));
        }
        let [x, y] = sites[site as usize];
        let spokes = around.iter().map(|&(length, to)| {
            let [u, v] = sites[to as usize];
            ([(u - x) / length, (v - y) / length], weight(length / spacings[site as usize]))
        });
        let spokes: Vec<_> = spokes.collect();
        for (a, (along, one)) in spokes.iter().enumerate() {
            turns.extend(spokes.iter().enumerate().map(|(b, (other, two))| {
                let cosine = along[0] * other[0] + along[1] * other[1];
                let cost = (one + two) / 2.0 * (1.0 + cosine).max(0.0);
                if a == b { 0.0 } else { (-SHARPNESS * cost).exp() as f32 }
            }));
        }
    }
    let none = (-SHARPNESS * MISSING_EDGE_COST).exp();
    let mut messages = vec![1.0; twins.len()];
    let mut next = messages.clone();
    let mut sums = Vec::new();
    let mut told = Vec::new();
    for _ in 0..ROUNDS_MAX {
        monitor.check()?;
        let (mut place, mut turn) = (0, 0);
        for site in graph.sites() {
            let degree = graph.around(site).len();
            let here = place..place + degree;
            told.clear();
            told.extend(here.clone().map(|i| messages[twins[i]] * priors[i]));
            sums.clear();
            // What the site weighs with each edge, the edge itself left out, and with any choice.
            sums.extend((0..degree).map(|a| {
                let row = &turns[turn + a * degree..turn + (a + 1) * degree];
                none + row.iter().zip(&told).map(|(&t, told)| f64::from(t) * told).sum::<f64>()
            }));
            let pairs: f64 = told.iter().zip(&sums).map(|(told, sum)| told * (sum + none)).sum();
            let all = none * none + pairs / 2.0;
            for (i, (told, sum)) in here.zip(told.iter().zip(&sums)) {
                let without = (all - told * sum).max(all / PROBABILITY_RATIO_MAX);
                next[i] = (messages[i] * sum / without)
                    .sqrt()
                    .clamp(1.0 / PROBABILITY_RATIO_MAX, PROBABILITY_RATIO_MAX);
            }
            place += degree;
            turn += degree * degree;
        }
        std::mem::swap(&mut messages, &mut next);
    }
    let probability = |i: usize| {
        let ratio = messages[i] * messages[twins[i]] * priors[i];
        ratio / (1.0 + ratio)
    };
    Ok((0..twins.len()).map(probability).collect())
}
