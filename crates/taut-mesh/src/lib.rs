//! Polylines of the plane, and how far apart two sets of them are.
#![forbid(unsafe_code)]

/// A chain of straight edges in the plane, borrowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<'a> {
    /// Its vertices in order.
    pub vertices: &'a [[f64; 2]],
    /// Whether an edge leads from the last vertex back to the first.
    pub closed: bool,
}
