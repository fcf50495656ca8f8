//! The rings of a polygon: rows (x, y) of one ring, or rows (x, y, number of the ring) of several.

use taut_points::{PointSource, gather};

use crate::{DrawOptions, Error};

/// The vertices of each ring, one ring after the other.
pub(crate) struct Rings(Vec<Vec<[f64; 2]>>);

impl Rings {
    /// Reads all rows, which must be finite and have two or three numbers.
    ///
    /// # Errors
    /// [`Error::Mismatch`], [`Error::NonFinite`] or [`Error::Read`].
    pub(crate) fn read(source: &dyn PointSource) -> Result<Self, Error> {
        let dim = source.dim();
        if dim != 3 {
            crate::marks::agree("number of coordinates", 2, dim)?;
        }
        let rows: Vec<u64> = (0..source.len()).collect();
        let values = gather(source, &rows)?;
        if let Some(at) = values.iter().position(|x| !x.is_finite()) {
            let what = format!("coordinate {} of point {}", at % dim, at / dim);
            return Err(Error::NonFinite { what, value: values[at] });
        }
        let (mut rings, mut number): (Vec<Vec<[f64; 2]>>, f64) = (vec![], f64::NAN);
        for row in values.chunks_exact(dim) {
            let own = if dim == 3 { row[2] } else { 0.0 };
            if own != number {
                rings.push(vec![]);
                number = own;
            }
            if let Some(ring) = rings.last_mut() {
                ring.push([row[0], row[1]]);
            }
        }
        Ok(Rings(rings))
    }

    /// The edge that begins at a row, which there must be.
    pub(crate) fn edge(&self, mut row: usize) -> [[f64; 2]; 2] {
        for ring in &self.0 {
            if row < ring.len() {
                return [ring[row], ring[if row + 1 == ring.len() { 0 } else { row + 1 }]];
            }
            row -= ring.len();
        }
        [[0.0; 2]; 2]
    }

    /// The rings without vertices that are within half a pixel of the one before.
    pub(crate) fn outlines(&self, options: &DrawOptions) -> Vec<Vec<[f64; 2]>> {
        let extent = |k: usize| {
            let all = || self.0.iter().flatten();
            let low = all().fold(f64::INFINITY, |least, at| least.min(at[k]));
            let high = all().fold(f64::NEG_INFINITY, |most, at| most.max(at[k]));
            high - low
        };
        let step = (extent(0) / options.width).max(extent(1) / options.height) / 2.0;
        self.0.iter().map(|ring| thinned(ring, step)).collect()
    }
}

/// The ring without vertices that are nearer to the one kept before than a step.
fn thinned(ring: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = vec![];
    for &at in ring {
        let is_near =
            kept.last().is_some_and(|last| (at[0] - last[0]).hypot(at[1] - last[1]) < step);
        if !is_near {
            kept.push(at);
        }
    }
    kept
}

/// The point of the segment ab that is nearest to p.
pub(crate) fn nearest(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let e = [b[0] - a[0], b[1] - a[1]];
    let square = e[0] * e[0] + e[1] * e[1];
    let share = ((p[0] - a[0]) * e[0] + (p[1] - a[1]) * e[1]) / square;
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + share * e[0], a[1] + share * e[1]]
}
