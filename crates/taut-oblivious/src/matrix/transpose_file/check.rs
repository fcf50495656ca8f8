//! Compares a sample of the elements of a file with those of the file that it is the transpose of.
//!
//! *Idea.* Elements drawn at random are read from both files. `taut-certify` compares all of them.
//! *Guarantee.* One wrong element among n escapes k samples with probability (1 − 1/n)ᵏ.
//! *Trap.* Nothing of the tiles is used here: both files are read at single places.

use std::path::Path;

use taut_points::Monitor;

use super::{FileMatrix, failed, open};
use crate::Error;
use crate::pages::Pages;
use crate::random::mix;
use crate::store::Store;

/// Compares `samples` elements, drawn by `seed`, of the matrix in the file `from` with its transpose in the file `to`, which
/// begins after `header` bytes.
///
/// Reads two elements per sample; memory for two elements. `monitor` is told of one pass.
///
/// # Errors
/// [`Error::Differs`] if an element differs, [`Error::Length`], [`Error::File`], [`Error::Cancelled`], and [`Error::Option`]
/// if the extent is not possible.
pub fn check_transposed_samples(
    from: &Path,
    matrix: FileMatrix,
    to: &Path,
    header: u64,
    [samples, seed]: [u64; 2],
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let turned = matrix.transposed(header);
    let source = open(from, &matrix)?;
    let target = open(to, &turned)?;
    let all = matrix.rows * matrix.columns;
    if all == 0 {
        // A width without elements may be more than any memory.
        return Ok(());
    }
    monitor.pass(1, samples);
    let [mut a, mut b] = [Pages::try_zeroed(matrix.width)?, Pages::try_zeroed(matrix.width)?];
    let (a, b) = (a.words_mut(), b.words_mut());
    for k in 0..samples {
        monitor.check()?;
        // The high half of a product with a number of 64 bits: uniform but for 1 in 2⁶⁴ / n.
        let place = ((u128::from(mixed(seed ^ mixed(k))) * u128::from(all)) >> 64) as u64;
        let (i, j) = (place / matrix.columns, place % matrix.columns);
        source.read_exact_at(a, matrix.at(i, j)).map_err(failed(from))?;
        target.read_exact_at(b, turned.at(j, i)).map_err(failed(to))?;
        if a != b {
            let detail = format!("row {j}, column {i} is not row {i}, column {j}");
            return Err(Error::Differs { path: to.display().to_string(), detail });
        }
        monitor.points(1);
    }
    Ok(())
}

/// A bijection of 64 bits without visible pattern, which does not keep 0.
fn mixed(x: u64) -> u64 {
    mix(x.wrapping_add(0x9E37_79B9_7F4A_7C15))
}
