//! Balls and ellipsoids as items: what the solvers of shapes need of them.
//!
//! *Items.* Each is {m + v : vv′ ⪯ S}; a ball of radius r has S = r²I, a point S = 0. All are held in memory.
//! *Idea.* For the solvers of points an item is the set of its points: they work on a few of these, and ask again and
//! again which point of which item lies farthest out ([`reach`]). A point is named by its item and a direction a:
//! p = m + Sa/√(a′Sa), which belongs to the item whatever a is.
//! *Trap.* A shape matrix knows half as many digits of a short axis as of a long one, so what lies far apart in size is
//! brought to a common frame with twice the digits ([`frame`]).
//! *Trap.* Rounding the entries of a singular S makes some of its eigenvalues negative. Such a row stands for an S that is
//! a little thicker ([`thickening`]), and all that is asked of S here is asked of that.

pub(crate) mod axes;
pub(crate) mod eigen;
pub(crate) mod frame;
pub(crate) mod reach;
mod thickening;

use taut_certify::Items;
use taut_kernels::DoubleDouble;
use taut_points::parallel::IntoParallel;
use taut_points::{
    BlockHash, Monitor, PointSource, PointsHash, Rows, ScalarKind, hash_block, map_blocks,
};

use self::eigen::eigen;
use crate::Error;

/// Items in memory, each of them valid.
pub(crate) struct Shapes {
    dim: usize,
    items: Items,
    columns: usize,
    values: Vec<f64>,
    hash: PointsHash,
    factors: Vec<Vec<f64>>,
    /// 2τ of each item.
    thickenings: Vec<f64>,
}

impl Shapes {
    /// Reads all rows of a source: one pass.
    pub(crate) fn read(
        source: &dyn PointSource,
        items: Items,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        if source.is_empty() {
            return Err(Error::Empty);
        }
        let columns = source.dim();
        let dim = items.dim(columns);
        match items {
            Items::Balls if dim == 0 => return Err(Error::NoRadius { columns }),
            Items::Ellipsoids if dim == 0 => return Err(Error::NoShape { columns }),
            _ => {}
        }
        monitor.pass(1, source.len());
        let blocks = map_blocks(source, monitor, |first, rows| block(first, &rows))?;
        let hash = PointsHash::of_blocks(source.len(), columns, blocks.iter().map(|block| block.0));
        let values: Vec<f64> = blocks.into_iter().flat_map(|block| block.1).collect();
        let mut shapes =
            Shapes { dim, items, columns, values, hash, factors: vec![], thickenings: vec![] };
        let kind = source.scalar();
        let factors = (0..shapes.len()).into_par_iter().with_min_len(32);
        let factors: Vec<_> = factors.map(|i| shapes.factorize(i, kind)).collect();
        // The first item refused, not the first that a thread met.
        let factors: Vec<_> = factors.into_iter().collect::<Result<_, _>>()?;
        (shapes.factors, shapes.thickenings) = factors.into_iter().unzip();
        Ok(shapes)
    }

    /// The dimension of the space.
    pub(crate) fn dim(&self) -> usize {
        self.dim
    }

    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    pub(crate) fn items(&self) -> Items {
        self.items
    }

    pub(crate) fn hash(&self) -> PointsHash {
        self.hash
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// m of item i.
    pub(crate) fn center(&self, i: usize) -> &[f64] {
        &self.row(i)[..self.dim]
    }

    /// Returns the coordinates that describe S.
    fn described(&self, i: usize) -> &[f64] {
        &self.row(i)[self.dim..]
    }

    /// Returns true if S = 0.
    pub(crate) fn is_point(&self, i: usize) -> bool {
        self.described(i).iter().all(|&v| v == 0.0)
    }

    /// Entry (j, k) of S, thickened.
    #[inline(always)]
    pub(crate) fn entry(&self, i: usize, j: usize, k: usize) -> DoubleDouble {
        let (j, k) = (j.max(k), j.min(k));
        match self.items {
            Items::Ellipsoids => {
                let entry = self.described(i)[j * (j + 1) / 2 + k];
                let added = if j == k { self.thickenings[i] } else { 0.0 };
                if added == 0.0 {
                    return entry.into();
                }
                DoubleDouble::from(entry) + DoubleDouble::product(entry, added)
            }
            Items::Balls if j == k => {
                let radius = self.described(i)[0];
                DoubleDouble::product(radius, radius)
            }
            Items::Balls | Items::Points => DoubleDouble::ZERO,
        }
    }

    /// √Sⱼⱼ: how far the item reaches from its own center along axis j.
    pub(crate) fn width(&self, i: usize, j: usize) -> f64 {
        match self.items {
            Items::Ellipsoids => {
                (self.described(i)[j * (j + 3) / 2] * (1.0 + self.thickenings[i])).sqrt()
            }
            Items::Balls => self.described(i)[0],
            Items::Points => 0.0,
        }
    }

    /// Rows e with S = Σ ee′, as many as S has rank.
    pub(crate) fn factor(&self, i: usize) -> std::slice::ChunksExact<'_, f64> {
        self.factors[i].chunks_exact(self.dim)
    }

    /// The factor and the thickening of item i. The factor comes from the eigenvectors of D^−½SD^−½, D being the diagonal of S, so that units of
    /// coordinates do not matter. Fails where an eigenvalue is negative beyond rounding.
    fn factorize(&self, i: usize, kind: ScalarKind) -> Result<(Vec<f64>, f64), Error> {
        let dim = self.dim;
        if self.items == Items::Balls {
            let radius = self.described(i)[0];
            if radius < 0.0 {
                return Err(Error::NegativeRadius { row: i as u64, value: radius });
            }
            let entry = |at: usize| if at / dim == at % dim { radius } else { 0.0 };
            let rows = if radius == 0.0 { vec![] } else { (0..dim * dim).map(entry).collect() };
            return Ok((rows, 0.0));
        }
        let refused = || Error::NegativeShape { row: i as u64 };
        if self.is_point(i) {
            return Ok((vec![], 0.0));
        }
        let described = self.described(i);
        let widths: Vec<f64> = (0..dim).map(|j| described[j * (j + 3) / 2].sqrt()).collect();
        if widths.iter().any(|w| w.is_nan()) {
            return Err(refused());
        }
        let mut correlations = vec![0.0; dim * dim];
        for j in 0..dim {
            for k in 0..=j {
                let value = described[j * (j + 1) / 2 + k];
                if widths[j] == 0.0 || widths[k] == 0.0 {
                    if value != 0.0 {
                        return Err(refused());
                    }
                    continue;
                }
                let value = if j == k { 1.0 } else { value / widths[j] / widths[k] };
                correlations[j * dim + k] = value;
                correlations[k * dim + j] = value;
            }
        }
        let (values, vectors) = eigen(&mut correlations, dim);
        // The largest value that rounding of the entries can make of an eigenvalue of 0.
        let of_entries = match kind {
            ScalarKind::F32 => 4.0 * dim as f64 * f64::from(f32::EPSILON / 2.0),
            ScalarKind::F64 => 0.0,
        };
        let rounding = 16.0 * ((dim + 8) * (dim + 8)) as f64 * f64::EPSILON + of_entries;
        let mut rows = vec![];
        for (value, vector) in values.iter().zip(vectors.chunks_exact(dim)) {
            let refuses = *value < -rounding || value.is_nan();
            if refuses {
                return Err(refused());
            }
            if *value > rounding {
                let root = value.sqrt();
                rows.extend(vector.iter().zip(&widths).map(|(v, w)| root * v * w));
            }
        }
        let thickening = thickening::thickening(described, dim).ok_or_else(refused)?;
        Ok((rows, thickening))
    }
}

/// The hash and the values of a block of finite rows.
fn block(first: u64, rows: &Rows<'_>) -> Result<(BlockHash, Vec<f64>), Error> {
    rows.check_finite(first)?;
    let values = match rows {
        Rows::F32(points) => points.values().iter().map(|&v| v.into()).collect(),
        Rows::F64(points) => points.values().to_vec(),
    };
    Ok((hash_block(rows), values))
}
