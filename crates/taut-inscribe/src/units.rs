//! The polygon in units of its bounding box.
//!
//! *Idea.* Ellipses and triangles stay what they are when an axis is scaled, and their areas keep their ratios. Each axis is shifted by
//! the lower end of the bounding box and scaled by a power of two that brings its extent to [1, 2): needles along an axis and
//! polygons far from the origin are then as good as any other.

use taut_points::{exponent_of, two_to_in_steps};

use crate::pair::{Pair, minus};
use crate::polygon::Segment;

/// The edges in units of the bounding box.
pub(crate) struct Units {
    pub(crate) edges: Vec<Segment>,
    /// The largest coordinates; the smallest are 0.
    pub(crate) extent: [f64; 2],
    axes: [Axis; 2],
}

/// The map of a coordinate.
#[derive(Clone, Copy)]
struct Axis {
    /// The product of both brings the largest coordinate to [1, 2); one alone could overflow.
    factors: [f64; 2],
    /// The lower end of the bounding box, scaled by the factors.
    origin: f64,
    /// The power of two that brings the extent to [1, 2).
    growth: f64,
}

impl Units {
    pub(crate) fn of(edges: &[Segment]) -> Self {
        let axes = [0, 1].map(|k| Axis::of(edges.iter().map(move |edge| edge[0][k])));
        let map = |p: [f64; 2]| [axes[0].units(p[0]), axes[1].units(p[1])];
        let edges: Vec<Segment> = edges.iter().map(|edge| edge.map(map)).collect();
        let extent = [0, 1].map(|k| edges.iter().fold(0.0f64, |most, edge| most.max(edge[0][k])));
        Units { edges, extent, axes }
    }

    /// Units in which both axes have one scale, so that angles are kept: the larger extent is in [1, 2).
    pub(crate) fn square(edges: &[Segment]) -> Self {
        let mut units = Units::of(edges);
        let begins = |k: usize| edges.iter().map(move |edge| edge[0][k]);
        let most = begins(0).chain(begins(1)).fold(0.0f64, |most, x| most.max(x.abs()));
        let factors = factors_of(most);
        let mut extent = 0.0f64;
        for (k, axis) in units.axes.iter_mut().enumerate() {
            let scaled = begins(k).map(|x| x * factors[0] * factors[1]);
            (axis.factors, axis.origin) = (factors, scaled.clone().fold(f64::INFINITY, f64::min));
            extent = scaled.fold(extent, |most, x| most.max(x - axis.origin));
        }
        let [one, other] = factors_of(extent);
        units.axes.iter_mut().for_each(|axis| axis.growth = one * other);
        units.edges = edges.iter().map(|edge| edge.map(|p| units.point(p))).collect();
        units.extent =
            [0, 1].map(|k| units.edges.iter().fold(0.0f64, |most, edge| most.max(edge[0][k])));
        units
    }

    /// A point of the input.
    pub(crate) fn point(&self, p: [f64; 2]) -> [f64; 2] {
        [self.axes[0].units(p[0]), self.axes[1].units(p[1])]
    }

    /// The point of the input that is nearest to one in units, but for rounding.
    pub(crate) fn given_point(&self, p: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let axis = self.axes[k];
            (p[k] / axis.growth + axis.origin) / axis.factors[0] / axis.factors[1]
        })
    }

    /// A bound of the distance along an axis, in units, between a point in units and that of the input for it: a unit of the last place of the
    /// largest coordinate, and of subnormal numbers, on top of roundings of units.
    pub(crate) fn rounding(&self, axis: usize) -> f64 {
        let last = 2.0 * f64::EPSILON + self.scaled(axis, f64::from_bits(1));
        last * self.growth(axis)
    }

    /// A coordinate scaled by the factors of its axis: exact unless it underflows.
    pub(crate) fn scaled(&self, axis: usize, x: f64) -> f64 {
        x * self.axes[axis].factors[0] * self.axes[axis].factors[1]
    }

    /// The power of two that brings scaled coordinates of an axis to units.
    pub(crate) fn growth(&self, axis: usize) -> f64 {
        self.axes[axis].growth
    }

    /// A difference of two coordinates of the input along an axis, in units.
    pub(crate) fn difference(&self, axis: usize, a: f64, b: f64) -> Pair {
        let Axis { factors: [one, other], growth, .. } = self.axes[axis];
        let (high, low) = minus(a * one * other, b * one * other);
        (high * growth, low * growth)
    }

    /// An area, as in the input.
    pub(crate) fn given_area(&self, area: f64) -> f64 {
        let [one, other] = self.axes;
        let scaled = area / one.growth / other.growth;
        // A large factor first meets a small one of the other axis, so that nothing is rounded on the way to a number that is not.
        let [mut f, mut g] = [one.factors, other.factors];
        if f[0].max(f[1]) > 1.0 {
            std::mem::swap(&mut f, &mut g);
        }
        scaled / f[0] / g[0] / f[1] / g[1]
    }

    /// A length along an axis, as in the input.
    pub(crate) fn given_length(&self, axis: usize, length: f64) -> f64 {
        let axis = self.axes[axis];
        length / axis.growth / axis.factors[0] / axis.factors[1]
    }
}

impl Axis {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let factors = factors_of(values.clone().fold(0.0, |most, x| x.abs().max(most)));
        let scaled = values.map(|x| x * factors[0] * factors[1]);
        let origin = scaled.clone().fold(f64::INFINITY, f64::min);
        let extent = scaled.fold(0.0f64, |most, x| most.max(x - origin));
        let [one, other] = factors_of(extent);
        Axis { factors, origin, growth: one * other }
    }

    fn units(self, x: f64) -> f64 {
        (x * self.factors[0] * self.factors[1] - self.origin) * self.growth
    }
}

/// Two powers of two whose product brings a number above 0 to [1, 2); both 1 for 0.
pub(crate) fn factors_of(largest: f64) -> [f64; 2] {
    if largest == 0.0 { [1.0; 2] } else { two_to_in_steps(-exponent_of(largest)) }
}
