//! Curves through samples without noise: their vertices are the samples.

mod belief;
mod conservative_crust;
mod corners;
mod crust;
mod graph;
mod hnn_crust;
pub(super) mod near;
mod nn_crust;
mod one_step_crust;
#[cfg(test)]
mod tests;

use std::borrow::Cow;

use taut_certify::CurveComponent;
use taut_points::{Monitor, exponent_of, times_two_to};

use super::answer::Outcome;
use super::chains::{chains, remove_crossings, repair};
use super::cloud::Cloud;
use super::options::{CurveMethod, Ends};
use crate::Error;
use near::Near;

/// Coordinates up to 2^±`SAFE_EXPONENT` are left as they are: their squares neither overflow nor vanish.
const SAFE_EXPONENT: i32 = 200;

/// The curves by one of the methods of this module.
pub(super) fn solve(
    cloud: &Cloud,
    method: CurveMethod,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let sites = normalized(&cloud.sites);
    let edges = edges(&sites, method, monitor)?;
    outcome(cloud, &sites, edges, method.name(), ends, monitor)
}

/// The curves by the method for corners, to which edges of HNN-Crust are more probable than others.
pub(super) fn solve_rugged(
    cloud: &Cloud,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let sites = normalized(&cloud.sites);
    let mut favored = hnn_crust::edges(&Near::new(&sites), monitor)?;
    favored.sort_unstable();
    let graph = graph::edges(&graph::triangulate(&sites, monitor)?);
    let edges = corners::edges(&sites, graph, &favored, monitor)?;
    outcome(cloud, &sites, edges, CurveMethod::Corners.name(), ends, monitor)
}

/// The curves of the edges that a method chose.
fn outcome(
    cloud: &Cloud,
    sites: &[[f64; 2]],
    edges: Vec<[u32; 2]>,
    method: &'static str,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    monitor.check()?;
    let (mut edges, mut repairs) = repair(sites, edges, ends, monitor)?;
    // What is exact of scaled copies need not be so of the sites themselves.
    if !std::ptr::eq(sites, cloud.sites.as_slice()) {
        repairs.crossed += remove_crossings(&cloud.sites, &mut edges);
    }
    let mut lonely = vec![true; sites.len()];
    edges.iter().flatten().for_each(|&site| lonely[site as usize] = false);
    let curves = chains(sites.len(), &edges).into_iter().map(|chain| CurveComponent {
        vertices: chain.sites.iter().map(|&site| cloud.sites[site as usize]).collect(),
        closed: chain.closed,
        rows: chain.sites.iter().map(|&site| cloud.row(site)).collect(),
    });
    let counters = [
        ("edges_cut", repairs.cut),
        ("edges_crossed", repairs.crossed),
        ("ends_joined", repairs.joined),
    ];
    Ok(Outcome {
        method,
        curves: curves.collect(),
        outliers: (0u32..).zip(&lonely).filter(|(_, l)| **l).map(|(site, _)| site).collect(),
        counters: counters.map(|(name, count)| (name.to_owned(), count)).into(),
        ..Outcome::default()
    })
}

/// The edges a method chooses, as they are.
fn edges(
    sites: &[[f64; 2]],
    method: CurveMethod,
    monitor: &Monitor<'_>,
) -> Result<Vec<[u32; 2]>, Error> {
    match method {
        CurveMethod::Crust => crust::edges(sites, monitor),
        CurveMethod::OneStepCrust => {
            Ok(one_step_crust::edges(sites, &graph::triangulate(sites, monitor)?))
        }
        CurveMethod::Corners => {
            // The triangulation is gone before the search, which needs as much memory again.
            let edges = graph::edges(&graph::triangulate(sites, monitor)?);
            corners::edges(sites, edges, &[], monitor)
        }
        CurveMethod::ConservativeCrust => conservative_crust::edges(sites, monitor),
        CurveMethod::HnnCrust => hnn_crust::edges(&Near::new(sites), monitor),
        _ => nn_crust::edges(&Near::new(sites), monitor),
    }
}

/// The sites, scaled by a power of two if squares of their coordinates could leave the range of a double. Scaling is exact but for
/// coordinates 2⁸⁰⁰ times smaller than the largest.
pub(super) fn normalized(sites: &[[f64; 2]]) -> Cow<'_, [[f64; 2]]> {
    let largest = sites.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let exponent = if largest > 0.0 { exponent_of(largest) } else { 0 };
    if exponent.abs() <= SAFE_EXPONENT {
        return Cow::Borrowed(sites);
    }
    let scale = |x: f64| times_two_to(x, -exponent);
    Cow::Owned(sites.iter().map(|site| site.map(scale)).collect())
}
