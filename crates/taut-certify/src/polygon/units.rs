//! The polygon in units of its bounding box.
//!
//! *Guarantee.* With a factor that brings the largest coordinate of an axis to [1, 2), differences of coordinates are right to u of
//! themselves, and at most 4. Where an extent is not 0 it is at least 2⁻⁵³, so that it is brought to [1, 2] by a power of two below
//! 2⁵⁴. What underflows is below 2⁻¹⁰⁷⁴ before that. A coordinate in units is off by less than [`COORDINATE_ERROR`].
//!
//! *Skewed units* have the second coordinate y + m·x, |m| ≤ 4, shifted and scaled like the first ones. Before scaling it is at most 10
//! in size. It is off by five times the error of a coordinate, and by three roundings: less than [`SKEW_ERROR`].

use super::Polygon;

/// Bound of the errors of coordinates in units: 2⁻⁵¹.
pub(crate) const COORDINATE_ERROR: f64 = f64::from_bits((1023 - 51) << 52);

/// Bound of the errors of skewed coordinates before they are scaled: 2⁻⁴⁷.
const SKEW_ERROR: f64 = f64::from_bits((1023 - 47) << 52);

/// Largest power of two by which skewed coordinates are scaled, so that their errors stay below 2⁻²³: 2²⁴.
const GROWTH_MAX: f64 = (1u64 << 24) as f64;

/// The vertices in units.
pub(crate) struct Units {
    points: Vec<[f64; 2]>,
    /// For each edge the vertex at which it ends.
    ends: Vec<u32>,
    axes: [Axis; 2],
    /// The power of two by which skewed coordinates are scaled; 1 without a skew.
    stretch: f64,
    /// No coordinate of a vertex is off by more.
    error: f64,
}

/// The map of a coordinate.
#[derive(Clone, Copy)]
struct Axis {
    /// The product of both brings the largest coordinate to [1, 2); one alone could overflow.
    factors: [f64; 2],
    /// The lower end of the bounding box, scaled by the factors.
    origin: f64,
    /// The power of two that brings the extent to [1, 2].
    growth: f64,
}

impl Units {
    pub(crate) fn of(polygon: &Polygon) -> Self {
        let given: Vec<[f64; 2]> = (0..polygon.len()).map(|edge| polygon.edge(edge)[0]).collect();
        let axes = [0, 1].map(|k| Axis::of(given.iter().map(move |p| p[k])));
        let units = |p: &[f64; 2]| [axes[0].units(p[0]), axes[1].units(p[1])];
        let points = given.iter().map(units).collect();
        let ends = (0..polygon.len()).map(|edge| polygon.end(edge)).collect();
        Units { points, ends, axes, stretch: 1.0, error: COORDINATE_ERROR }
    }

    /// Units in which both axes have one scale, so that angles are kept: the larger extent is in [1, 2].
    pub(crate) fn square(polygon: &Polygon) -> Self {
        let given: Vec<[f64; 2]> = (0..polygon.len()).map(|edge| polygon.edge(edge)[0]).collect();
        let mut axes = [0, 1].map(|k| Axis::of(given.iter().map(move |p| p[k])));
        let factors =
            power_pair(given.as_flattened().iter().fold(0.0, |most, x| x.abs().max(most)));
        let scaled = |k: usize| given.iter().map(move |p| p[k] * factors[0] * factors[1]);
        let mut extent = 0.0f64;
        for (k, axis) in axes.iter_mut().enumerate() {
            (axis.factors, axis.origin) = (factors, scaled(k).fold(f64::INFINITY, f64::min));
            extent = scaled(k).fold(extent, |most, x| most.max(x - axis.origin));
        }
        let [one, other] = power_pair(extent);
        axes.iter_mut().for_each(|axis| axis.growth = one * other);
        let points = given.iter().map(|p| [axes[0].units(p[0]), axes[1].units(p[1])]).collect();
        let ends = (0..polygon.len()).map(|edge| polygon.end(edge)).collect();
        Units { points, ends, axes, stretch: 1.0, error: COORDINATE_ERROR }
    }

    /// The edge that begins where an edge ends.
    pub(crate) fn end(&self, edge: u32) -> u32 {
        self.ends[edge as usize]
    }

    /// The units with the second coordinate y + m·x, for |m| ≤ 4.
    pub(crate) fn skewed(mut self, skew: f64) -> Self {
        if skew == 0.0 {
            return self;
        }
        let at = |p: &[f64; 2]| p[1] + skew * p[0];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in &self.points {
            (low, high) = (low.min(at(p)), high.max(at(p)));
        }
        let [one, other] = power_pair((high - low).max(0.0));
        let growth = (one * other).min(GROWTH_MAX);
        for p in &mut self.points {
            p[1] = (at(p) - low) * growth;
        }
        self.stretch = growth;
        self.error = COORDINATE_ERROR.max(SKEW_ERROR * growth);
        self
    }

    /// A bound of the errors of the coordinates of vertices.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    /// Edges, which are as many as vertices.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    pub(crate) fn edge(&self, edge: usize) -> [[f64; 2]; 2] {
        [self.points[edge], self.points[self.ends[edge] as usize]]
    }

    /// A coordinate scaled by the factors of its axis alone: exact unless it underflows.
    pub(crate) fn scaled(&self, axis: usize, x: f64) -> f64 {
        x * self.axes[axis].factors[0] * self.axes[axis].factors[1]
    }

    /// The factors of an axis.
    pub(crate) fn factors(&self, axis: usize) -> [f64; 2] {
        self.axes[axis].factors
    }

    /// An area of coordinates scaled by the factors, in units.
    pub(crate) fn grown(&self, area: f64) -> f64 {
        area * self.axes[0].growth * self.axes[1].growth * self.stretch
    }

    /// An area in units as one of the input.
    pub(crate) fn given_area(&self, area: f64) -> f64 {
        let [one, other] = self.axes;
        let scaled = area / self.stretch / one.growth / other.growth;
        // Large factors first meet small ones, so that nothing overflows on the way to a number that does not.
        let [mut f, mut g] = [one.factors, other.factors];
        if one.factors[0] > 1.0 {
            std::mem::swap(&mut f, &mut g);
        }
        scaled / f[0] / g[0] / f[1] / g[1]
    }
}

impl Axis {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let factors = power_pair(values.clone().fold(0.0, |most, x| x.abs().max(most)));
        let scaled = values.map(|x| x * factors[0] * factors[1]);
        let origin = scaled.clone().fold(f64::INFINITY, f64::min);
        let extent = scaled.fold(0.0f64, |most, x| most.max(x - origin));
        let [one, other] = power_pair(extent);
        Axis { factors, origin, growth: one * other }
    }

    fn units(self, x: f64) -> f64 {
        (x * self.factors[0] * self.factors[1] - self.origin) * self.growth
    }
}

/// Two powers of two whose product brings a number to [1, 2); both 1 for 0.
fn power_pair(largest: f64) -> [f64; 2] {
    if largest == 0.0 {
        return [1.0, 1.0];
    }
    let exponent = match largest < f64::MIN_POSITIVE {
        true => -1011 - largest.to_bits().leading_zeros() as i32,
        false => (largest.to_bits() >> 52) as i32 - 1023,
    };
    let half = -exponent / 2;
    [half, -exponent - half].map(|power| f64::from_bits(((1023 + power) as u64) << 52))
}
