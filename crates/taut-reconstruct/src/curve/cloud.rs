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
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(Error::Input(InputError::NonFinite { row: row as u64, column, value }));
        }
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
