//! Polylines through the nodes of splines, with as many vertices between them as their error asks for.

use taut_certify::CurveComponent;
use taut_oblivious::hilbert_order;
use taut_points::Monitor;

use super::Frame;
use super::parameters::{EDGES_PER_NODE_MAX, PIECE_VERTICES_MIN};
use super::spline::{Node, Spline, hermite};
use crate::Error;
use crate::curve::Ends;
use crate::curve::chains::{chains, repair};

/// One polyline for each spline that has points, unless some cross: then fewer edges, and how many are gone.
pub(super) fn curves(
    splines: &[Spline],
    frame: &Frame,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<(Vec<CurveComponent>, u64), Error> {
    let curves: Vec<CurveComponent> =
        splines.iter().filter(|s| !s.members.is_empty()).map(|s| polyline(s, frame)).collect();
    let curves: Vec<CurveComponent> =
        curves.into_iter().filter(|c| c.vertices.len() > 1 + usize::from(c.closed)).collect();
    let vertices: Vec<[f64; 2]> = curves.iter().flat_map(|c| c.vertices.iter().copied()).collect();
    let order = hilbert_order(vertices.len(), |i| vertices[i]);
    let mut number = vec![0u32; vertices.len()];
    for (place, &i) in order.iter().enumerate() {
        number[i as usize] = place as u32;
    }
    let sites: Vec<[f64; 2]> = order.iter().map(|&i| vertices[i as usize]).collect();
    let mut edges = Vec::with_capacity(vertices.len());
    let mut first = 0;
    for curve in &curves {
        let count = curve.vertices.len();
        for k in 0..count - usize::from(!curve.closed) {
            edges.push([number[first + k], number[first + (k + 1) % count]]);
        }
        first += count;
    }
    let (edges, repairs) = repair(&sites, edges, Ends::Open, monitor)?;
    if repairs.crossed == 0 {
        return Ok((curves, 0));
    }
    let (edges, _) = repair(&sites, edges, ends, monitor)?;
    let pieces =
        chains(sites.len(), &edges).into_iter().filter(|c| c.sites.len() >= PIECE_VERTICES_MIN);
    let curves = pieces.map(|chain| CurveComponent {
        vertices: chain.sites.iter().map(|&site| sites[site as usize]).collect(),
        closed: chain.closed,
        rows: Vec::new(),
    });
    Ok((curves.collect(), repairs.crossed))
}

fn polyline(spline: &Spline, frame: &Frame) -> CurveComponent {
    let mut vertices = Vec::new();
    // An open curve goes on along its ends, to the last points there.
    let beyond = |node: &Node, length: f64| {
        frame
            .outward([node.at[0] + length * node.tangent[0], node.at[1] + length * node.tangent[1]])
    };
    if let (false, Some(first)) = (spline.closed, spline.members.first())
        && first.arc < 0.0
    {
        vertices.push(beyond(&spline.nodes[0], first.arc));
    }
    for edge in 0..spline.edges() {
        let (a, b) = spline.edge(edge);
        let pieces = pieces(a, b);
        for k in 0..pieces {
            vertices.push(frame.outward(hermite(a, b, f64::from(k) / f64::from(pieces)).0));
        }
    }
    if let Some(last) = spline.nodes.last().filter(|_| !spline.closed) {
        vertices.push(frame.outward(last.at));
        let farthest = spline.members.last().map_or(0.0, |m| m.arc - spline.length());
        if farthest > 0.0 {
            vertices.push(beyond(last, farthest));
        }
    }
    vertices.dedup();
    CurveComponent { vertices, closed: spline.closed, rows: Vec::new() }
}

/// Edges between two nodes, so that the arc is no farther from them than half the error of the nodes.
fn pieces(a: &Node, b: &Node) -> u32 {
    // Of a cubic with these ends the sagitta of the chord is chord/8 times the turn, to first order.
    let chord = (b.at[0] - a.at[0]).hypot(b.at[1] - a.at[1]);
    let turn = (a.leaving[0] * b.tangent[1] - a.leaving[1] * b.tangent[0]).abs();
    let sagitta = chord * turn / 8.0;
    let allowed = 0.5 * a.error.max(b.error);
    let wanted = (sagitta / allowed).sqrt().ceil();
    // NaN, of no error and no sagitta, gives one piece.
    if wanted > 1.0 { wanted.min(EDGES_PER_NODE_MAX) as u32 } else { 1 }
}
