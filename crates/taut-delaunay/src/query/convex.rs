//! Convex bodies of the plane and of space as lists of corners, cut by half-spaces.
//!
//! Idea: a half-space keeps the corners on its side and adds where edges cross its border; in space the crossings of
//! all faces are the corners of a new face, in order around their middle.
//! Guarantee: volumes to rounding. Corners are floating-point numbers: nothing exact may hang on them.
//! Reference: Sutherland and Hodgman, *Reentrant polygon clipping*, 1974.

use taut_points::OrderBy;

use crate::vector::{cross, difference, dot};

/// The half-space of points x with normal·x ≤ offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace<const D: usize> {
    pub(crate) normal: [f64; D],
    pub(crate) offset: f64,
}

impl<const D: usize> HalfSpace<D> {
    /// The points at least as near to `a` as to `b`.
    pub(crate) fn nearer_to(a: [f64; D], b: [f64; D]) -> Self {
        let normal = difference(b, a);
        let middle: [f64; D] = std::array::from_fn(|i| 0.5 * a[i] + 0.5 * b[i]);
        Self { normal, offset: dot(normal, middle) }
    }

    /// Returns how far outside `p` is, in multiples of the normal's length.
    fn excess(&self, p: [f64; D]) -> f64 {
        dot(self.normal, p) - self.offset
    }
}

/// Cuts a closed loop of corners; appends the corners on the border to `border`.
fn cut_loop<const D: usize>(
    corners: &[[f64; D]],
    by: &HalfSpace<D>,
    border: &mut Vec<[f64; D]>,
) -> Vec<[f64; D]> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, &p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let (out_p, out_q) = (by.excess(p), by.excess(q));
        if out_p <= 0.0 {
            kept.push(p);
        }
        if (out_p <= 0.0) != (out_q <= 0.0) {
            let along = out_p / (out_p - out_q);
            let crossing = std::array::from_fn(|k| p[k] + along * (q[k] - p[k]));
            kept.push(crossing);
            border.push(crossing);
        }
    }
    kept
}

/// A convex body that half-spaces cut down, in the plane or in space.
pub(crate) trait Body<const D: usize>: Clone {
    /// The box between two corners.
    fn from_box(low: [f64; D], high: [f64; D]) -> Self;
    /// Cuts off what is outside.
    fn cut(&mut self, by: &HalfSpace<D>);
    /// With each corner moved.
    fn map(self, to: impl Fn([f64; D]) -> [f64; D]) -> Self;
    /// Returns true if nothing is left.
    fn is_empty(&self) -> bool;
    /// Area or volume.
    fn volume(&self) -> f64;
}

/// A convex polygon: its corners, counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// Corners, counter-clockwise; empty if nothing is left.
    pub corners: Vec<[f64; 2]>,
}

/// A convex polyhedron: its faces, each with its corners counter-clockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyhedron {
    /// Faces; empty if nothing is left.
    pub faces: Vec<Vec<[f64; 3]>>,
}

impl Body<2> for Polygon {
    fn from_box(low: [f64; 2], high: [f64; 2]) -> Self {
        Self { corners: vec![low, [high[0], low[1]], high, [low[0], high[1]]] }
    }

    fn cut(&mut self, by: &HalfSpace<2>) {
        self.corners = cut_loop(&self.corners, by, &mut Vec::new());
    }

    fn map(mut self, to: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        self.corners.iter_mut().for_each(|corner| *corner = to(*corner));
        self
    }

    fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    fn volume(&self) -> f64 {
        self.area()
    }
}

impl Polygon {
    /// The area.
    pub fn area(&self) -> f64 {
        let Some(&first) = self.corners.first() else { return 0.0 };
        let fan = self.corners.windows(2).map(|pair| {
            let (u, v) = (difference(pair[0], first), difference(pair[1], first));
            u[0] * v[1] - u[1] * v[0]
        });
        0.5 * fan.sum::<f64>()
    }
}

impl Body<3> for Polyhedron {
    fn from_box(low: [f64; 3], high: [f64; 3]) -> Self {
        let corner = |code: usize| {
            std::array::from_fn(|k| if code >> k & 1 == 1 { high[k] } else { low[k] })
        };
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Self {
            faces: faces
                .iter()
                .map(|face| face.iter().map(|&code| corner(code)).collect())
                .collect(),
        }
    }

    fn cut(&mut self, by: &HalfSpace<3>) {
        let mut border = Vec::new();
        if self.faces.iter().flatten().all(|&p| by.excess(p) <= 0.0) {
            return;
        }
        self.faces = self
            .faces
            .iter()
            .map(|face| cut_loop(face, by, &mut border))
            .filter(|f| f.len() > 2)
            .collect();
        if border.len() > 2 {
            self.faces.push(around_middle(border, by.normal));
        }
    }

    fn map(mut self, to: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.faces.iter_mut().flatten().for_each(|corner| *corner = to(*corner));
        self
    }

    fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    fn volume(&self) -> f64 {
        let Some(&apex) = self.faces.first().and_then(|face| face.first()) else { return 0.0 };
        let mut six_fold = 0.0;
        for face in &self.faces {
            let a = difference(face[0], apex);
            for pair in face[1..].windows(2) {
                six_fold += dot(a, cross(difference(pair[0], apex), difference(pair[1], apex)));
            }
        }
        six_fold / 6.0
    }
}

impl Polyhedron {
    /// The volume.
    pub fn volume(&self) -> f64 {
        Body::volume(self)
    }
}

/// Corners of a convex face in counter-clockwise order as seen from where its normal points.
fn around_middle(mut corners: Vec<[f64; 3]>, normal: [f64; 3]) -> Vec<[f64; 3]> {
    let count = corners.len() as f64;
    let middle: [f64; 3] =
        std::array::from_fn(|k| corners.iter().map(|c| c[k]).sum::<f64>() / count);
    // Any axis far from the normal gives a frame of the face.
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let u = cross(normal, axis);
    let v = cross(normal, u);
    let length = |w: [f64; 3]| dot(w, w).sqrt();
    let (lu, lv) = (length(u), length(v));
    let angle = |c: &[f64; 3]| {
        let w = difference(*c, middle);
        (dot(w, v) / lv).atan2(dot(w, u) / lu)
    };
    corners.order_by(&|a, b| angle(a).total_cmp(&angle(b)));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::numbers;

    #[test]
    fn cutting_a_box_in_half_halves_it() {
        let mut square = Polygon::from_box([0.0, 0.0], [2.0, 1.0]);
        square.cut(&HalfSpace { normal: [1.0, 1.0], offset: 1.0 });
        assert!((square.area() - 0.5).abs() < 1e-15);
        let mut cube = Polyhedron::from_box([0.0; 3], [1.0; 3]);
        assert_eq!(cube.volume(), 1.0);
        cube.cut(&HalfSpace { normal: [1.0; 3], offset: 1.0 });
        assert!((cube.volume() - 1.0 / 6.0).abs() < 1e-15);
        cube.cut(&HalfSpace { normal: [-1.0; 3], offset: -2.0 });
        assert!(cube.is_empty());
        assert_eq!(cube.volume(), 0.0);
    }

    #[test]
    fn two_halves_make_the_whole() {
        let mut drawn = numbers(200 * 12 * 4, 5).into_iter().map(|x| x - 0.5);
        let mut next = || drawn.next().expect("enough are drawn");
        for _ in 0..200 {
            let mut body = Polyhedron::from_box([-1.0; 3], [1.0; 3]);
            for _ in 0..12 {
                let by = HalfSpace { normal: [next(), next(), next()], offset: next() };
                let turned = HalfSpace { normal: by.normal.map(|x| -x), offset: -by.offset };
                let (mut one, mut other) = (body.clone(), body.clone());
                one.cut(&by);
                other.cut(&turned);
                assert!((one.volume() + other.volume() - body.volume()).abs() < 1e-12);
                body = if one.volume() > other.volume() { one } else { other };
            }
        }
    }
}
