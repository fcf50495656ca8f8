//! From input rows to sites: distinct, normalized points, numbered along the Hilbert curve.
//!
//! Idea: a power-of-two scale changes no sign of any predicate, so coordinates are scaled, exactly, to where filters are
//! safe and where gridded data become integers; −0 becomes 0; equal points become one site.
//! Guarantee: sites and their numbers are a function of the point *set*; a site stands for the smallest of its rows.
//! Trap: a set that spans more exponents than a double can hold around 1 cannot be scaled without loss. It is left as it
//! is, and every sign is then taken exactly (`Settings::filtered` off).

use rayon::prelude::*;
use taut_oblivious::hilbert_order;
use taut_points::{InputError, Monitor, Points, Scalar, exponent_of, two_to_in_steps};

use crate::Error;
use crate::kernel::Settings;

/// Rows one task reads.
const TASK: usize = 1 << 14;
/// Filters are proved for magnitudes up to this; larger sets are scaled down.
const UNSCALED_MAX: f64 = (1u64 << 40) as f64;
/// Sets below this are scaled up, so that no filter drowns in its allowance for underflow.
const UNSCALED_MIN: f64 = 1.0 / (1u64 << 20) as f64;

/// The distinct points of an input.
#[derive(Clone, Debug)]
pub(crate) struct Sites<const D: usize> {
    /// Scaled coordinates, in Hilbert order.
    pub(crate) coordinates: Vec<[f64; D]>,
    /// The smallest input row of each site.
    pub(crate) rows: Vec<u32>,
    /// Each row that is not in `rows`, with the smallest row it equals; by row.
    pub(crate) duplicates: Vec<[u32; 2]>,
    /// The properties that the kernels must know.
    pub(crate) settings: Settings,
    /// The factor that the coordinates were multiplied with.
    pub(crate) scale: Scale,
}

/// Multiplication with a power of two that loses nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    exponent: i32,
    /// The factor in two steps, as 2^±2000 is no double.
    steps: [f64; 2],
}

impl Scale {
    fn by(exponent: i32) -> Self {
        Self { exponent, steps: two_to_in_steps(exponent) }
    }

    /// `x` scaled, −0 as 0.
    #[inline(always)]
    pub(crate) fn apply(self, x: f64) -> f64 {
        x * self.steps[0] * self.steps[1] + 0.0
    }

    /// All of a row scaled. A loop, as maps of arrays are not always inlined.
    #[inline(always)]
    pub(crate) fn of_row<const D: usize>(self, mut row: [f64; D]) -> [f64; D] {
        for x in &mut row {
            *x = self.apply(*x);
        }
        row
    }

    /// The scale that undoes this one.
    pub(crate) fn inverse(self) -> Self {
        Self::by(-self.exponent)
    }
}

/// Row `i` as an array. The values are cut to a length that the compiler knows: otherwise the loop is a call of `memcpy`, 8 % of the
/// time of a triangulation of the plane.
#[inline(always)]
pub(crate) fn row<T: Scalar, const D: usize>(points: &Points<'_, T>, i: usize) -> [f64; D] {
    let values = &points.row(i)[..D];
    let mut row = [0.0; D];
    for (x, &value) in row.iter_mut().zip(values) {
        *x = value.into();
    }
    row
}

impl<const D: usize> Sites<D> {
    /// Reads, checks, scales, orders and merges the points.
    pub(crate) fn new<T: Scalar>(
        points: &Points<'_, T>,
        vectors: bool,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let n = points.len();
        if n >= (1 << 30) {
            return Err(Error::Input(InputError::TooManyPoints {
                points: n as u64,
                most: (1 << 30) - 1,
            }));
        }
        let largest = largest_magnitude(points)?;
        monitor.check()?;
        let (scale, integral, filtered) = normalization(points, largest);
        let rows = hilbert_order(n, |i: usize| scale.of_row(row::<T, D>(points, i)));
        monitor.check()?;
        let settings = Settings { integral, filtered, vectors };
        let mut sites =
            Self { coordinates: Vec::new(), rows, duplicates: Vec::new(), settings, scale };
        sites.gather(points);
        sites.duplicates = merge(&mut sites.coordinates, &mut sites.rows);
        Ok(sites)
    }

    /// Reads the coordinates of the sites from the points they stand for.
    pub(crate) fn gather<T: Scalar>(&mut self, points: &Points<'_, T>) {
        let site = |&i: &u32| self.scale.of_row(row(points, i as usize));
        self.coordinates = self.rows.par_iter().with_min_len(TASK).map(site).collect();
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }
}

pub(crate) fn largest_magnitude<T: Scalar>(points: &Points<'_, T>) -> Result<f64, Error> {
    let dim = points.dim();
    let blocks = points.values().par_chunks(TASK * dim.max(1));
    let largest = blocks
        .map(|values| {
            // A NaN or an infinity stays in the sum, which is cheaper than asking each value.
            let (mut largest, mut spoilt) = (0.0f64, 0.0f64);
            for &value in values {
                let x: f64 = value.into();
                largest = if x.abs() > largest { x.abs() } else { largest };
                spoilt += x * 0.0;
            }
            if spoilt == 0.0 { largest } else { f64::NAN }
        })
        .reduce(|| 0.0, |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) });
    if !largest.is_nan() {
        return Ok(largest);
    }
    let place =
        points.values().iter().position(|&v| !Into::<f64>::into(v).is_finite()).unwrap_or(0);
    let value = points.values()[place].into();
    Err(Error::Input(InputError::NonFinite {
        row: (place / dim) as u64,
        column: place % dim,
        value,
    }))
}

/// The exponent of the lowest bit of a number that is not 0.
fn lowest_exponent(x: f64) -> i32 {
    let bits = x.to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32 & 0x7ff, bits & ((1 << 52) - 1));
    let significand = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    exponent.max(1) - 1075 + significand.trailing_zeros() as i32
}

/// The exponent of the lowest bit of any coordinate, if it is at least `floor`.
fn lowest_exponent_above<T: Scalar>(points: &Points<'_, T>, floor: i32) -> Option<i32> {
    let mut lowest = i32::MAX;
    for &value in points.values() {
        let x: f64 = value.into();
        if x != 0.0 {
            lowest = lowest.min(lowest_exponent(x));
            if lowest < floor {
                return None;
            }
        }
    }
    Some(lowest)
}

/// Returns how to scale, and whether coordinates are then integers, and filters safe.
pub(crate) fn normalization<T: Scalar>(
    points: &Points<'_, T>,
    largest: f64,
) -> (Scale, bool, bool) {
    normalization_by(largest, |floor| lowest_exponent_above(points, floor))
}

/// The same, from the exponent of the lowest bit of any coordinate if it is at least a floor.
fn normalization_by(
    largest: f64,
    lowest_exponent_above: impl Fn(i32) -> Option<i32>,
) -> (Scale, bool, bool) {
    if largest == 0.0 {
        return (Scale::by(0), true, true);
    }
    let top = exponent_of(largest) + 1;
    if let Some(unit) = lowest_exponent_above(top - 40) {
        return (Scale::by(-unit), true, true);
    }
    if (UNSCALED_MIN..=UNSCALED_MAX).contains(&largest) {
        return (Scale::by(0), false, true);
    }
    // Scaling down must not push the lowest bit below the smallest double.
    let exponent = -top;
    if exponent > 0 || lowest_exponent_above(-1074 - exponent).is_some() {
        (Scale::by(exponent), false, true)
    } else {
        (Scale::by(0), false, false)
    }
}

/// The magnitudes in a set that is seen point by point: what its normalization depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnitudes {
    /// The largest magnitude of a coordinate.
    pub(crate) largest: f64,
    /// The exponent of the lowest bit of any coordinate.
    pub(crate) lowest: i32,
}

impl Magnitudes {
    /// Those of no points.
    pub const EMPTY: Self = Self { largest: 0.0, lowest: i32::MAX };

    /// Adds a finite coordinate.
    #[inline(always)]
    pub fn add(&mut self, x: f64) {
        self.largest = if x.abs() > self.largest { x.abs() } else { self.largest };
        if x != 0.0 {
            self.lowest = self.lowest.min(lowest_exponent(x));
        }
    }

    /// Adds finite coordinates, as [`add`](Self::add) does one by one.
    ///
    /// A number that is not small has no bit below the lowest one so far, whatever its other bits: almost no block of
    /// coordinates in general position is looked at more closely.
    pub(crate) fn add_all(&mut self, coordinates: &[f64]) {
        /// Numbers that are compared side by side, in vectors.
        const LANES: usize = 8;
        let (mut least, mut largest) = ([f64::INFINITY; LANES], [0.0f64; LANES]);
        let (blocks, rest) = coordinates.as_chunks::<LANES>();
        for block in blocks {
            for i in 0..LANES {
                let x = block[i].abs();
                least[i] = if x < least[i] { x } else { least[i] };
                largest[i] = if x > largest[i] { x } else { largest[i] };
            }
        }
        rest.iter().for_each(|&x| self.add(x));
        self.largest = largest.into_iter().fold(self.largest, f64::max);
        let least = least.into_iter().fold(f64::INFINITY, f64::min);
        let bits_of_significand = 52;
        let is_clear =
            least > 0.0 && exponent_of(least) >= self.lowest.saturating_add(bits_of_significand);
        if !is_clear {
            blocks.as_flattened().iter().for_each(|&x| self.add(x));
        }
    }

    /// Adds those of other points.
    pub fn merge(&mut self, other: Self) {
        self.largest = self.largest.max(other.largest);
        self.lowest = self.lowest.min(other.lowest);
    }

    /// The scale of the set, and what the kernels must know of it.
    pub(crate) fn normalization(self, vectors: bool) -> (Scale, Settings) {
        let above = |floor| (self.lowest >= floor).then_some(self.lowest);
        let (scale, integral, filtered) = normalization_by(self.largest, above);
        (scale, Settings { integral, filtered, vectors })
    }
}

/// Merges equal neighbors; the first of each run, which has the smallest row, stays.
fn merge<const D: usize>(coordinates: &mut Vec<[f64; D]>, rows: &mut Vec<u32>) -> Vec<[u32; 2]> {
    let any = coordinates.par_windows(2).with_min_len(TASK).any(|pair| pair[0] == pair[1]);
    let mut duplicates = Vec::new();
    if any {
        let mut kept = 0;
        for i in 1..coordinates.len() {
            if coordinates[i] == coordinates[kept] {
                duplicates.push([rows[i], rows[kept]]);
            } else {
                kept += 1;
                coordinates[kept] = coordinates[i];
                rows[kept] = rows[i];
            }
        }
        coordinates.truncate(kept + 1);
        rows.truncate(kept + 1);
        duplicates.sort_unstable();
    }
    duplicates
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sites(values: &[f64]) -> Sites<2> {
        let points = Points::new(values, 2).expect("whole rows");
        Sites::new(&points, true, &Monitor::silent()).expect("finite")
    }

    #[test]
    fn equal_points_are_one_site_of_the_smallest_row() {
        let found = sites(&[1.0, 2.0, -0.0, 5.0, 1.0, 2.0, 0.0, 5.0, 1.0, 2.0]);
        assert_eq!(found.len(), 2);
        assert_eq!(found.duplicates, [[2, 0], [3, 1], [4, 0]]);
        let mut rows = found.rows.clone();
        rows.sort_unstable();
        assert_eq!(rows, [0, 1]);
    }

    #[test]
    fn grids_of_any_step_become_integers() {
        for step in [1.0, 0.25, 2f64.powi(-700), 2f64.powi(900), 5e-324] {
            let found = sites(&[0.0, step, 3.0 * step, step, 4.0 * step, 2.0 * step]);
            assert!(found.settings.integral && found.settings.filtered, "{step}");
            assert!(found.coordinates.contains(&[3.0, 1.0]), "{step}: {:?}", found.coordinates);
            let back = found.scale.inverse();
            assert!(
                found.coordinates.iter().any(|c| c.map(|x| back.apply(x)) == [3.0 * step, step])
            );
        }
        assert!(!sites(&[0.1, 0.2, 0.3, 0.4]).settings.integral);
    }

    #[test]
    fn exponents_of_the_ends_of_a_double() {
        for (x, low, high) in [
            (1.0, 0, 0),
            (6.0, 1, 2),
            (5e-324, -1074, -1074),
            (f64::MIN_POSITIVE * 0.75, -1024, -1023),
        ] {
            assert_eq!((lowest_exponent(x), exponent_of(-x)), (low, high), "{x}");
        }
        assert_eq!(exponent_of(f64::MAX), 1023);
    }

    #[test]
    fn magnitudes_of_many_are_those_of_each() {
        let grid: Vec<f64> = (0..40).map(|i| f64::from(i) * 0.25).collect();
        let general: Vec<f64> = (1..60).map(|i| 1.0 / f64::from(i)).collect();
        let ends = [f64::MAX, -1.0, 5e-324, 0.0, -f64::MIN_POSITIVE, 1e300, 3.0, 2f64.powi(52)];
        for set in [&grid, &general, ends.as_slice(), &[4.0; 17], &[0.0; 9], &[]] {
            let (mut each, mut all) = (Magnitudes::EMPTY, Magnitudes::EMPTY);
            set.iter().for_each(|&x| each.add(x));
            all.add_all(set);
            assert_eq!(all, each, "{set:?}");
            // A second block, of larger numbers with lower bits, after the first has set the bounds.
            let next: Vec<f64> =
                set.iter().map(|x| x * 3.0 + 1.0).filter(|x| x.is_finite()).collect();
            next.iter().for_each(|&x| each.add(x));
            all.add_all(&next);
            assert_eq!(all, each, "{next:?}");
        }
    }

    #[test]
    fn extreme_magnitudes_are_scaled_without_loss_or_not_at_all() {
        let scaled = sites(&[1.1e300, 2.3e299, -3.7e250, 1e300 / 3.0]);
        assert!(
            scaled.settings.filtered && scaled.coordinates.iter().flatten().all(|x| x.abs() <= 2.0)
        );
        let tiny = sites(&[1.1e-300, 2.3e-299, -3.7e-305, 1e-300 / 3.0]);
        assert!(
            tiny.settings.filtered && tiny.coordinates.iter().flatten().any(|x| x.abs() >= 0.25)
        );
        let mixed = sites(&[1.1e300, 1.7e-300, 3.0, 0.7]);
        assert!(!mixed.settings.filtered);
        assert!(mixed.coordinates.contains(&[1.1e300, 1.7e-300]));
    }

    #[test]
    fn what_is_not_finite_is_named() {
        let values = [0.0, 1.0, 2.0, f64::NAN, f64::INFINITY, 5.0];
        let points = Points::new(&values, 2).expect("whole rows");
        let refused = Sites::<2>::new(&points, true, &Monitor::silent());
        assert!(
            matches!(refused, Err(Error::Input(InputError::NonFinite { row: 1, column: 1, .. }))),
            "{refused:?}"
        );
    }
}
