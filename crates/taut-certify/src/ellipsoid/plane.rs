//! Decides whether some rows are *the* support of an ellipse: by exact arithmetic, without any tolerance.
//!
//! *Problem.* The smallest ellipse of points in the plane is that of three to five of them, of which none can be spared
//! (a basis). Given rows that are said to be those, prove it from the input alone.
//! *Idea.* Rows are a basis if each of them lies outside the smallest ellipse of the others, which is decided by the same
//! test for fewer points ([`basis`]). Then their ellipse has all of them on its border, and is known by its equation, in
//! whole numbers ([`conic`]). If it encloses every other point, it is the smallest ellipse of all.
//! *Guarantee.* Every sign is exact: `f64` with a bound of its rounding decides nearly all, whole numbers the rest.
//! *Reference.* Gärtner and Schönherr, Exact primitives for smallest enclosing ellipses, Inf. Proc. Letters 68, 1998.

mod basis;
mod conic;

use std::cmp::Ordering;

use taut_points::{Monitor, OrderBy, PointSource, gather, map_blocks};

use self::basis::Basis;
use crate::hashed_pass::all_finite;
use crate::{CheckError, Violation};

/// The facts that exact arithmetic proved of the support of an ellipse.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EllipseSupport {
    /// Three to five rows; none can be spared, and their smallest ellipse is that of all points.
    pub rows: Vec<u64>,
    /// Points exactly on the border of that ellipse, those rows among them.
    pub on_border: u64,
    /// Points so near the border that it took whole numbers to decide.
    pub near_border: u64,
}

/// A basis is looked for among at most this many rows: more subsets than those of as many are not tried.
const BASIS_ROWS_MAX: usize = 10;

/// Proves by exact arithmetic that the smallest ellipse around some rows of `source` is that around all of them.
///
/// Where rows can be spared, as of many points on one circle, a part of them that does is found. *Cost.* One pass, and
/// for points within rounding of the border a few products of whole numbers of some thousand bits.
///
/// ```
/// use taut_certify::ellipse_support;
/// use taut_points::{Monitor, Points};
///
/// let points = [0.0, 0.0, 4.0, 0.0, 4.0, 2.0, 0.0, 2.0, 1.0, 1.0];
/// let points = Points::new(&points, 2)?;
/// let proved = ellipse_support(&points, &[0, 1, 2, 3], &Monitor::silent())?;
/// assert_eq!((proved.rows, proved.on_border), (vec![0, 1, 2, 3], 4));
/// // The ellipse of three of the corners leaves the fourth outside.
/// assert!(ellipse_support(&points, &[0, 1, 2], &Monitor::silent()).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Violation::NoPlane`], [`Violation::NoBasis`], [`Violation::OutsideSupport`], [`Violation::NonFinite`], and what
/// reading the points says.
pub fn ellipse_support(
    source: &dyn PointSource,
    support: &[u64],
    monitor: &Monitor<'_>,
) -> Result<EllipseSupport, CheckError> {
    if source.dim() != 2 {
        return Err(Violation::NoPlane { dim: source.dim() }.into());
    }
    let values = gather(source, support)?;
    let points = values.as_chunks::<2>().0;
    let (basis, rows) = find(points, support).ok_or(Violation::NoBasis { rows: support.len() })?;
    monitor.pass(1, source.len());
    let counts = map_blocks(source, monitor, |first, rows| {
        all_finite(first, &rows)?;
        let (mut on_border, mut near_border) = (0, 0);
        let mut point = [0.0; 2];
        for i in 0..rows.len() {
            rows.copy_row(i, &mut point);
            let side = basis.quick_side(point).unwrap_or_else(|| {
                near_border += 1;
                basis.side(point)
            });
            match side {
                Ordering::Less => {}
                Ordering::Equal => on_border += 1,
                Ordering::Greater => {
                    return Err(Violation::OutsideSupport { row: first + i as u64 }.into());
                }
            }
        }
        Ok::<(u64, u64), CheckError>((on_border, near_border))
    })?;
    Ok(EllipseSupport {
        rows,
        on_border: counts.iter().map(|count| count.0).sum(),
        near_border: counts.iter().map(|count| count.1).sum(),
    })
}

/// All of the points if they are a basis; else some that are, with the others inside.
fn find(points: &[[f64; 2]], rows: &[u64]) -> Option<(Basis, Vec<u64>)> {
    let finite = points.iter().flatten().all(|v| v.is_finite());
    if !finite || points.len() > BASIS_ROWS_MAX {
        return None;
    }
    // Larger subsets first: the whole support is what is asked about.
    let mut masks: Vec<u32> = (1..1u32 << points.len()).collect();
    masks.retain(|mask| (3..=5).contains(&mask.count_ones()));
    masks.order_by_key(|mask| std::cmp::Reverse(mask.count_ones()));
    masks.into_iter().find_map(|mask| {
        let chosen = |i: &usize| mask >> i & 1 == 1;
        let part: Vec<[f64; 2]> = (0..points.len()).filter(chosen).map(|i| points[i]).collect();
        let basis = Basis::of(&part)?;
        let encloses = points.iter().all(|&point| basis.side(point).is_le());
        encloses.then(|| (basis, (0..points.len()).filter(chosen).map(|i| rows[i]).collect()))
    })
}
