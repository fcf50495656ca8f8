//! Measures how far items reach from the nearest of some centers.

use taut_certify::{Centers, CentersCertificate, Items};

use crate::axes::unit;
use crate::body::reach_from;
use crate::item_pass::Measure;

/// Centers and their radius, scaled so that sums of squares neither overflow nor vanish.
pub(super) struct Nearest {
    pub(super) unit: f64,
    dim: usize,
    centers: Vec<f64>,
    middle: Vec<f64>,
    radius: f64,
    weights: bool,
}

impl Nearest {
    pub(super) fn new(answer: &Centers, certificate: &CentersCertificate, dim: usize) -> Self {
        let numbers = answer.centers.iter().flatten().copied();
        let unit = unit(numbers.clone().chain([answer.radius]));
        let centers: Vec<f64> = numbers.map(|x| x / unit).collect();
        let mut middle = vec![0.0; dim];
        for center in centers.chunks_exact(dim) {
            let part = 1.0 / answer.centers.len() as f64;
            middle.iter_mut().zip(center).for_each(|(m, x)| *m += part * x);
        }
        let (radius, weights) = (answer.radius / unit, certificate.weights);
        Nearest { unit, dim, centers, middle, radius, weights }
    }

    /// Returns how far an item reaches from the center next to it, in units.
    pub(super) fn reach(&self, row: &[f64], items: Items) -> f64 {
        let each = 0..self.centers.len() / self.dim;
        each.map(|center| self.reach_from(center, row, items)).fold(f64::INFINITY, f64::min)
    }

    /// Returns how far an item reaches from one of the centers, in units.
    pub(super) fn reach_from(&self, center: usize, row: &[f64], items: Items) -> f64 {
        let center = &self.centers[center * self.dim..][..self.dim];
        if items == Items::Ellipsoids {
            let place: Vec<f64> = center.iter().map(|c| c * self.unit).collect();
            return reach_from(items, self.dim, row, &place) / self.unit;
        }
        let square: f64 = center.iter().zip(row).map(|(c, x)| (x / self.unit - c).powi(2)).sum();
        match items {
            _ if self.weights => row[self.dim] * square.sqrt(),
            Items::Balls => square.sqrt() + row[self.dim] / self.unit,
            Items::Points | Items::Ellipsoids => square.sqrt(),
        }
    }

    /// For each row the center from which it reaches least far.
    pub(super) fn centers_of(&self, rows: &[f64], items: Items) -> Vec<usize> {
        let columns = if self.weights { self.dim + 1 } else { items.columns(self.dim) };
        let center = |row: &[f64]| {
            let reaches = (0..self.centers.len() / self.dim)
                .map(|center| (center, self.reach_from(center, row, items)));
            reaches.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(center, _)| center)
        };
        rows.chunks_exact(columns).map(center).collect()
    }

    /// The centers from the middle of all, in units.
    pub(super) fn offsets(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        self.centers
            .chunks_exact(self.dim)
            .map(|center| center.iter().zip(&self.middle).map(|(x, m)| x - m).collect())
    }
}

impl Measure for Nearest {
    fn dim(&self) -> usize {
        self.dim
    }

    fn offset(&self, row: &[f64]) -> Vec<f64> {
        row.iter().zip(&self.middle).map(|(x, m)| x / self.unit - m).collect()
    }

    fn part(&self, row: &[f64], items: Items) -> f64 {
        let reach = self.reach(row, items);
        match reach {
            // A finite reach is a finite part, however small the radius.
            _ if self.radius > 0.0 && reach.is_finite() => (reach / self.radius).min(f64::MAX),
            0.0 => 1.0,
            _ => 1.0 + reach,
        }
    }
}
