//! One guess of the radius, and points of the stream that are more than twice that apart.

use taut_kernels::{Center, squared_distances};
use taut_points::{
    ByteReader, ByteWriter, Monitor, PartsError, Points, ReadError, Scalar, exponent_of, two_to,
};

use super::{SeparatedSet, rounded_up};
use crate::Error;
use crate::frame::SQUARE_MIN;

/// It is asked whether to go on each time this many points have gone by.
const POINTS_BETWEEN_ASKS: u64 = 64;

/// A guess r and at most k points that are more than 2r apart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Instance {
    k: usize,
    dim: usize,
    /// α, by which a guess that failed is multiplied.
    ratio: f64,
    guess: f64,
    /// The points kept, row-major.
    centers: Vec<f64>,
    rows: Vec<u64>,
    /// The largest distance from each of them to the points that count as its own.
    reaches: Vec<f64>,
}

impl Instance {
    /// Begins with some points, more than k.
    pub(super) fn new(
        k: usize,
        dim: usize,
        ratio: f64,
        guess: f64,
        first: &[f64],
        rows: &[u64],
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let reaches = vec![0.0; rows.len()];
        let (centers, rows) = (first.to_vec(), rows.to_vec());
        let mut instance = Instance { k, dim, ratio, guess, centers, rows, reaches };
        instance.merge(monitor)?;
        Ok(instance)
    }

    pub(super) fn write(&self, bytes: &mut ByteWriter) {
        bytes.float(self.ratio);
        bytes.float(self.guess);
        bytes.floats(&self.centers);
        bytes.wholes(&self.rows);
        bytes.floats(&self.reaches);
    }

    /// Reads what [`write`](Self::write) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub(super) fn read(
        bytes: &mut ByteReader<'_>,
        k: usize,
        dim: usize,
    ) -> Result<Self, PartsError> {
        let (ratio, guess) = (bytes.float()?, bytes.float()?);
        let (centers, rows, reaches) = (bytes.floats()?, bytes.wholes()?, bytes.floats()?);
        let fits = (1..=k).contains(&rows.len())
            && reaches.len() == rows.len()
            && rows.len().checked_mul(dim) == Some(centers.len());
        // A guess has to grow, and to get anywhere.
        let grows = (1.001..=1001.0).contains(&ratio)
            && (f64::MIN_POSITIVE..f64::INFINITY).contains(&guess);
        if !fits || !grows || !centers.iter().all(|x| x.is_finite()) {
            return Err(bytes.wrong());
        }
        Ok(Instance { k, dim, ratio, guess, centers, rows, reaches })
    }

    pub(super) fn centers(&self) -> &[f64] {
        &self.centers
    }

    pub(super) fn rows(&self) -> &[u64] {
        &self.rows
    }

    /// No point is farther from those kept.
    pub(super) fn radius(&self) -> f64 {
        self.reaches.iter().copied().fold(0.0, f64::max)
    }

    /// The next points; the last proof that a guess was too small, if there is one.
    pub(super) fn add<T: Scalar>(
        &mut self,
        first_row: u64,
        points: &Points<'_, T>,
        monitor: &Monitor<'_>,
    ) -> Result<SeparatedSet, Error> {
        let mut separated = SeparatedSet::default();
        let mut center = Center { high: vec![0.0; self.dim], low: vec![] };
        let mut values = vec![];
        for (number, row) in (first_row..).zip(points.rows()) {
            if number % POINTS_BETWEEN_ASKS == 0 {
                monitor.check().map_err(ReadError::from)?;
            }
            center.high.iter_mut().zip(row).for_each(|(c, &v)| *c = v.into());
            let (nearest, distance) = self.nearest(&center, &mut values)?;
            if distance <= 2.0 * self.guess {
                let reach = &mut self.reaches[nearest];
                *reach = reach.max(rounded_up(distance, self.dim));
                continue;
            }
            self.centers.extend_from_slice(&center.high);
            self.rows.push(number);
            self.reaches.push(0.0);
            if self.rows.len() > self.k {
                separated = self.grow(monitor)?;
            }
        }
        if self.radius().is_finite() { Ok(separated) } else { Err(Error::Overflow) }
    }

    /// The point kept that is next to `center`, the first of several, and its distance.
    fn nearest(&self, center: &Center, values: &mut Vec<f64>) -> Result<(usize, f64), Error> {
        values.clear();
        values.resize(self.rows.len(), 0.0);
        squared_distances(&self.centers, self.dim, center, values);
        let least = |values: &[f64]| {
            (0..values.len()).fold(0, |a, b| if values[b] < values[a] { b } else { a })
        };
        let at = least(values);
        if (SQUARE_MIN..f64::INFINITY).contains(&values[at]) {
            return Ok((at, values[at].sqrt()));
        }
        for (value, known) in values.iter_mut().zip(self.centers.chunks_exact(self.dim)) {
            *value = distance(known, &center.high)?;
        }
        let at = least(values);
        Ok((at, values[at]))
    }

    /// There are k + 1 points more than 2r apart: a larger guess, under which at least two of them are one.
    fn grow(&mut self, monitor: &Monitor<'_>) -> Result<SeparatedSet, Error> {
        let least = least_distance(&self.centers, self.dim, monitor)?;
        let separated = SeparatedSet { rows: self.rows.clone(), distance: least };
        while 2.0 * self.guess < least {
            self.guess *= self.ratio;
        }
        self.merge(monitor)?;
        Ok(separated)
    }

    /// Of points that are at most 2r apart only the first stays, and takes over what was the other's.
    fn merge(&mut self, monitor: &Monitor<'_>) -> Result<(), Error> {
        let dim = self.dim;
        let old = std::mem::take(&mut self.centers);
        let rows = std::mem::take(&mut self.rows);
        let reaches = std::mem::take(&mut self.reaches);
        for ((point, row), reach) in old.chunks_exact(dim).zip(rows).zip(reaches) {
            monitor.check().map_err(ReadError::from)?;
            let mut nearest = None;
            for (i, kept) in self.centers.chunks_exact(dim).enumerate() {
                let distance = distance(kept, point)?;
                if nearest.is_none_or(|(_, least)| distance < least) {
                    nearest = Some((i, distance));
                }
            }
            match nearest {
                Some((at, distance)) if distance <= 2.0 * self.guess => {
                    let over = rounded_up(distance + reach, dim);
                    self.reaches[at] = self.reaches[at].max(over);
                }
                _ => {
                    self.centers.extend_from_slice(point);
                    self.rows.push(row);
                    self.reaches.push(reach);
                }
            }
        }
        Ok(())
    }
}

/// The least distance of two of the points.
pub(super) fn least_distance(
    points: &[f64],
    dim: usize,
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let mut least = f64::INFINITY;
    for (i, a) in points.chunks_exact(dim).enumerate() {
        monitor.check().map_err(ReadError::from)?;
        for b in points[(i + 1) * dim..].chunks_exact(dim) {
            least = least.min(distance(a, b)?);
        }
    }
    Ok(least)
}

/// |a − b|, whatever its size.
///
/// # Errors
/// [`Error::Overflow`] where it is larger than the largest number.
pub(super) fn distance(a: &[f64], b: &[f64]) -> Result<f64, Error> {
    let differences = || a.iter().zip(b).map(|(a, b)| a - b);
    let square: f64 = differences().map(|d| d * d).sum();
    if (SQUARE_MIN..f64::INFINITY).contains(&square) {
        return Ok(square.sqrt());
    }
    let largest = differences().fold(0.0, |m: f64, d| m.max(d.abs()));
    if largest == 0.0 {
        return Ok(0.0);
    }
    if largest.is_infinite() {
        return Err(Error::Overflow);
    }
    // By a power of two that brings the largest to about 1, and does not overflow itself.
    let scale = two_to((-exponent_of(largest)).clamp(-1020, 1020));
    let root = differences().map(|d| (d * scale).powi(2)).sum::<f64>().sqrt() / scale;
    if root.is_finite() { Ok(root) } else { Err(Error::Overflow) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_all_sizes() {
        for size in [5e-324, 1e-310, 1e-200, 1.0, 1e200, 2f64.powi(1021)] {
            let found = distance(&[0.0, 4.0 * size], &[3.0 * size, 0.0]).unwrap();
            assert_eq!(found, 5.0 * size, "{size}");
        }
        assert_eq!(distance(&[f64::MAX], &[f64::MAX]).unwrap(), 0.0);
        assert!(matches!(distance(&[f64::MAX], &[-f64::MAX]), Err(Error::Overflow)));
        let corner = [f64::MAX / 1.2; 2];
        assert!(matches!(distance(&corner, &[0.0, 0.0]), Err(Error::Overflow)));
    }
}
