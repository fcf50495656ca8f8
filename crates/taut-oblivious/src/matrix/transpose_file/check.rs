//! A second opinion on the transposition of a file.
//!
//! *Idea.* All of it: a sum over elements of a hash of the element and of its place in the target, once from the source,
//! where the place is computed, and once from the target, where it is counted. Some of it: elements drawn at random are
//! read from both files.
//! *Guarantee.* Two sums of 128 bits agree by accident for one pair of different files in 2¹²⁸, as far as the hash is
//! random. One wrong element among n escapes k samples with probability (1 − 1/n)ᵏ.
//! *Trap.* Nothing of the tiles is used here: both files are read from end to end, or at single places.

use std::fs::File;
use std::path::Path;

use taut_points::Monitor;

use super::{FileMatrix, failed, open};
use crate::Error;
use crate::pages::Pages;
use crate::random::mix;
use crate::store::Store;

/// How much of the files to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileCheck {
    /// Every element, two passes.
    Whole,
    /// So many elements at places drawn by this seed.
    Sample {
        /// How many.
        elements: u64,
        /// Of the places.
        seed: u64,
    },
}

/// Bytes that are read in one go.
const BLOCK: usize = 1 << 20;

/// Whether the file `to` ends with the transpose of the matrix in the file `from`, after `header` bytes.
///
/// Reads both files once from end to end, or two elements per sample; about 1 MiB of memory, or one element if that is
/// more. `monitor` hears of a pass per file, or of one.
///
/// # Errors
/// [`Error::Differs`] if it does not, [`Error::Length`], [`Error::File`], [`Error::Cancelled`], and [`Error::Option`] if
/// the extent is not possible.
pub fn check_transposed_file(
    from: &Path,
    matrix: FileMatrix,
    to: &Path,
    header: u64,
    check: FileCheck,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let turned = matrix.transposed(header);
    let source = open(from, &matrix)?;
    let target = open(to, &turned)?;
    let differs = |detail| Error::Differs { path: to.display().to_string(), detail };
    match check {
        FileCheck::Whole => {
            let (rows, columns) = (matrix.rows, matrix.columns);
            monitor.pass(1, rows * columns);
            let there = sum(&source, &matrix, monitor, |i, j| j * rows + i, from)?;
            monitor.pass(2, rows * columns);
            let here = sum(&target, &turned, monitor, |i, j| i * rows + j, to)?;
            if there == here {
                return Ok(());
            }
            Err(differs("the sums over all elements and places disagree".to_owned()))
        }
        FileCheck::Sample { elements, seed } => {
            let all = matrix.rows * matrix.columns;
            if all == 0 {
                return Ok(());
            }
            monitor.pass(1, elements);
            let [mut a, mut b] =
                [Pages::try_zeroed(matrix.width)?, Pages::try_zeroed(matrix.width)?];
            let (a, b) = (a.words_mut(), b.words_mut());
            for k in 0..elements {
                monitor.check()?;
                // The high half of a product with a number of 64 bits: uniform but for 1 in 2⁶⁴ / n.
                let place = ((u128::from(mixed(seed ^ mixed(k))) * u128::from(all)) >> 64) as u64;
                let (i, j) = (place / matrix.columns, place % matrix.columns);
                source.read_exact_at(a, matrix.at(i, j)).map_err(failed(from))?;
                target.read_exact_at(b, turned.at(j, i)).map_err(failed(to))?;
                if a != b {
                    return Err(differs(format!("row {j}, column {i} is not row {i}, column {j}")));
                }
                monitor.points(1);
            }
            Ok(())
        }
    }
}

/// The sum over the elements of a file of their hashes at `place(row, column)`.
fn sum(
    file: &File,
    matrix: &FileMatrix,
    monitor: &Monitor<'_>,
    place: impl Fn(u64, u64) -> u64,
    path: &Path,
) -> Result<u128, Error> {
    let all = matrix.rows * matrix.columns;
    if all == 0 {
        // A width without elements may be more than any memory.
        return Ok(0);
    }
    let block = (BLOCK / matrix.width).max(1);
    let mut buffer = Pages::try_zeroed(block * matrix.width)?;
    let (mut total, mut i, mut j) = (0u128, 0, 0);
    for first in (0..all).step_by(block) {
        monitor.check()?;
        let count = (all - first).min(block as u64);
        let part = &mut buffer.words_mut()[..count as usize * matrix.width];
        let at = matrix.offset + first * matrix.width as u64;
        file.read_exact_at(part, at).map_err(failed(path))?;
        for element in part.chunks_exact(matrix.width) {
            total = total.wrapping_add(hash(element, place(i, j)));
            j += 1;
            if j == matrix.columns {
                (i, j) = (i + 1, 0);
            }
        }
        monitor.points(count);
    }
    Ok(total)
}

/// 128 bits of an element and its place.
fn hash(element: &[u8], place: u64) -> u128 {
    let (mut a, mut b) = (mixed(place), mixed(!place));
    for part in element.chunks(8) {
        let mut word = [0; 8];
        word[..part.len()].copy_from_slice(part);
        let word = u64::from_le_bytes(word);
        (a, b) = (mixed(a ^ word), mixed(b.wrapping_add(word)));
    }
    u128::from(a) << 64 | u128::from(b)
}

/// A bijection of 64 bits without visible pattern, which does not keep 0.
fn mixed(x: u64) -> u64 {
    mix(x.wrapping_add(0x9E37_79B9_7F4A_7C15))
}
