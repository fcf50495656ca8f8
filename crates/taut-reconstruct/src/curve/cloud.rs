//! The distinct points of the input, in an order that depends on them alone.

use taut_oblivious::hilbert_order;
use taut_points::{InputError, Monitor, PointSource, Rows, Scratch};

use crate::Error;

/// Sites, the distinct points, numbered along a Hilbert curve: neighbors in the plane are near in memory, and the numbers do not
/// depend on the order of the input.
#[derive(Clone, Debug, Default)]
pub(super) struct Cloud {
    /// The sites.
    pub(super) sites: Vec<[f64; 2]>,
    /// For each site, where its rows begin in `rows`; one more entry at the end.
    starts: Vec<u32>,
    /// The rows of the input, by site, ascending within one.
    rows: Vec<u32>,
}

impl Cloud {
    /// Reads, checks and sorts all points.
    pub(super) fn read(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<Self, Error> {
        const POINTS_LIMIT: u64 = 1 << 31;
        if source.dim() != 2 {
            return Err(Error::Input(InputError::Dimension {
                dim: source.dim(),
                expected: "2, as curves are sought in the plane",
            }));
        }
        let points = source.len();
        if points >= POINTS_LIMIT {
            return Err(Error::Input(InputError::TooManyPoints { points, most: POINTS_LIMIT - 1 }));
        }
        monitor.pass(1, points);
        let mut scratch = Scratch::new();
        let rows = source.read(0..points, &mut scratch)?;
        rows.check_finite(0)?;
        monitor.check()?;
        // −0 equals 0, but is another pattern of bits.
        Ok(match rows {
            Rows::F32(points) => Self::sorted(points.len(), |i| {
                [f64::from(points.row(i)[0]) + 0.0, f64::from(points.row(i)[1]) + 0.0]
            }),
            Rows::F64(points) => {
                Self::sorted(points.len(), |i| [points.row(i)[0] + 0.0, points.row(i)[1] + 0.0])
            }
        })
    }

    /// The cloud of finite points that a method made.
    pub(super) fn of(points: &[[f64; 2]]) -> Self {
        Self::sorted(points.len(), |i| points[i].map(|x| x + 0.0))
    }

    fn sorted(len: usize, at: impl Fn(usize) -> [f64; 2] + Sync) -> Self {
        let rows = hilbert_order(len, &at);
        let (mut sites, mut starts) = (Vec::with_capacity(len), Vec::with_capacity(len + 1));
        for (place, &row) in rows.iter().enumerate() {
            let point = at(row as usize);
            if sites.last() != Some(&point) {
                sites.push(point);
                starts.push(place as u32);
            }
        }
        starts.push(len as u32);
        Self { sites, starts, rows }
    }

    /// The cloud of some of the sites, ascending.
    pub(super) fn subset(&self, sites: &[u32]) -> Self {
        let (mut rows, mut starts) = (Vec::new(), Vec::with_capacity(sites.len() + 1));
        for &site in sites {
            starts.push(rows.len() as u32);
            rows.extend_from_slice(self.rows(site));
        }
        starts.push(rows.len() as u32);
        Self { sites: sites.iter().map(|&site| self.sites[site as usize]).collect(), starts, rows }
    }

    /// The sites that are so far from the others that no square tells of those any more: all others lie within a 2³⁰⁰th of the
    /// distance. Ascending; none where they are more than one in ten.
    pub(super) fn far(&self) -> Vec<u32> {
        /// A distance over that within which nine tenths lie.
        const FAR_RATIO_MIN: f64 =
            (1u128 << 100) as f64 * (1u128 << 100) as f64 * (1u128 << 100) as f64;
        let count = self.sites.len();
        // Halves, so that no difference overflows.
        let middle = [0, 1].map(|k| {
            let mut all: Vec<f64> = self.sites.iter().map(|p| 0.5 * p[k]).collect();
            match count {
                0 => 0.0,
                _ => *all.select_nth_unstable_by(count / 2, f64::total_cmp).1,
            }
        });
        let distance =
            |p: &[f64; 2]| (0.5 * p[0] - middle[0]).abs().max((0.5 * p[1] - middle[1]).abs());
        let mut all: Vec<f64> = self.sites.iter().map(distance).collect();
        let largest = all.iter().copied().fold(0.0, f64::max);
        let usual = match count {
            0 => return Vec::new(),
            _ => *all.select_nth_unstable_by(count * 9 / 10, f64::total_cmp).1,
        };
        if usual == 0.0 || largest / FAR_RATIO_MIN <= usual {
            return Vec::new();
        }
        let is_far = |site: &u32| distance(&self.sites[*site as usize]) / FAR_RATIO_MIN > usual;
        (0..count as u32).filter(is_far).collect()
    }

    /// The first row of a site.
    pub(super) fn row(&self, site: u32) -> u64 {
        u64::from(self.rows[self.starts[site as usize] as usize])
    }

    /// All rows of a site, ascending.
    pub(super) fn rows(&self, site: u32) -> &[u32] {
        &self.rows[self.starts[site as usize] as usize..self.starts[site as usize + 1] as usize]
    }

    /// For each row its site.
    pub(super) fn site_of_row(&self) -> Vec<u32> {
        let mut sites = vec![0; self.rows.len()];
        for site in 0..self.sites.len() as u32 {
            self.rows(site).iter().for_each(|&row| sites[row as usize] = site);
        }
        sites
    }
}
