//! Polylines through the nodes of strands, with as many vertices between them as their error asks for.

use taut_certify::CurveComponent;

use super::Frame;
use super::strand::{Node, Strand, hermite};

/// Most edges between two nodes.
const MOST: f64 = 16.0;

/// One polyline for each strand.
pub(super) fn curves(strands: &[Strand], frame: &Frame) -> Vec<CurveComponent> {
    strands.iter().map(|s| polyline(s, frame)).collect()
}

fn polyline(strand: &Strand, frame: &Frame) -> CurveComponent {
    let mut vertices = Vec::new();
    for edge in 0..strand.edges() {
        let (a, b) = strand.edge(edge);
        let pieces = pieces(a, b);
        for k in 0..pieces {
            vertices.push(frame.outward(hermite(a, b, f64::from(k) / f64::from(pieces)).0));
        }
    }
    if let Some(last) = strand.nodes.last().filter(|_| !strand.closed) {
        vertices.push(frame.outward(last.at));
    }
    vertices.dedup();
    if strand.closed && vertices.len() > 1 && vertices.first() == vertices.last() {
        vertices.pop();
    }
    CurveComponent { vertices, closed: strand.closed, rows: Vec::new() }
}

/// Edges between two nodes, so that the arc is no farther from them than half the error of the nodes.
fn pieces(a: &Node, b: &Node) -> u32 {
    // Of a cubic with these ends the sagitta of the chord is chord/8 times the turn, to first order.
    let chord = (b.at[0] - a.at[0]).hypot(b.at[1] - a.at[1]);
    let turn = (a.tangent[0] * b.tangent[1] - a.tangent[1] * b.tangent[0]).abs();
    let sagitta = chord * turn / 8.0;
    let allowed = 0.5 * a.error.max(b.error);
    let wanted = (sagitta / allowed).sqrt().ceil();
    // NaN, of no error and no sagitta, gives one piece.
    if wanted > 1.0 { wanted.min(MOST) as u32 } else { 1 }
}
