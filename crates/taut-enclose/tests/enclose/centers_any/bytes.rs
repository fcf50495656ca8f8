//! Items and options made of any bytes: centers are found, and judged by the checker. Shared with the fuzz target.

use taut_certify::{Items, Placement};
use taut_enclose::{CentersMethod, CentersOptions, Error, StreamingOptions, centers};
use taut_points::{InputError, Points};

/// A case has at most this many rows: more are solved as well, but each case should take a moment.
const ROWS_MAX: usize = 24;

/// The first byte chooses dimension, k and kind of number, the second what is asked for; the rest are coordinates, as
/// small integers, which bring ties, copies and lines, or as the bits of `f64`.
///
/// # Panics
/// When an answer is rejected by the checker, or refused for a reason that these options do not give.
pub(crate) fn solve_and_check(bytes: &[u8]) {
    let Some((&[head, wish], rest)) = bytes.split_first_chunk::<2>() else { return };
    let dim = usize::from(head % 4) + 1;
    let k = usize::from(head >> 2 & 3) + 1;
    let (items, weights) = match wish & 3 {
        0 => (Items::Balls, false),
        1 => (Items::Points, true),
        _ => (Items::Points, false),
    };
    let columns = dim + usize::from(weights || items == Items::Balls);
    let (placement, outliers, method) = match wish >> 2 & 7 {
        0 => (Placement::Rows, 0, CentersMethod::Tree),
        1 => (Placement::Rows, 2, CentersMethod::Tree),
        2 => (Placement::Free, 1, CentersMethod::Tree),
        3 if !weights => (Placement::Free, 0, CentersMethod::Thesis),
        4 => (Placement::Free, 0, CentersMethod::FarthestFirst),
        5 if (items, weights) == (Items::Points, false) => {
            (Placement::Free, 0, CentersMethod::Stream(StreamingOptions::DEFAULT))
        }
        _ => (Placement::Free, 0, CentersMethod::Tree),
    };
    let is_whole = head & 16 == 0;
    let mut values: Vec<f64> = match is_whole {
        true => rest.iter().map(|&b| f64::from(b as i8)).collect(),
        false => rest.as_chunks::<8>().0.iter().map(|&eight| f64::from_le_bytes(eight)).collect(),
    };
    values.truncate((values.len() / columns).min(ROWS_MAX) * columns);
    if columns > dim {
        for last in values.iter_mut().skip(dim).step_by(columns) {
            *last = last.abs() + if weights { 1.0 } else { 0.0 };
        }
    }
    let rows = values.len() / columns;
    let points = Points::new(&values, columns).expect("whole rows were kept");
    let options = CentersOptions {
        epsilon: if wish & 64 == 0 { 1e-6 } else { 0.1 },
        method,
        placement,
        outliers,
        weights,
        max_nodes: if wish & 128 == 0 { 20_000 } else { 50 },
        assignment: !matches!(method, CentersMethod::Stream(_)),
        inputs: items,
        ..CentersOptions::default()
    };
    match centers(&points, k, &options) {
        Ok(found) => {
            found.check(&points).unwrap_or_else(|error| panic!("{error}\n{values:?}\n{found:?}"));
            assert!(
                found.answer.lower_bound <= found.answer.radius && found.answer.centers.len() <= k
            );
            let assigned = if options.assignment { rows } else { 0 };
            assert_eq!(found.answer.assignment.len(), assigned);
        }
        Err(Error::Empty) => assert!(values.is_empty()),
        Err(Error::Input(InputError::NonFinite { row, column, value })) => {
            let at = values[row as usize * columns + column];
            assert!(!at.is_finite() && at.to_bits() == value.to_bits());
        }
        Err(Error::Input(InputError::Option { name: "outliers", .. })) => {
            assert!(outliers >= rows as u64)
        }
        Err(Error::Overflow) => assert!(!is_whole, "{values:?}"),
        Err(other) => panic!("{other}\n{values:?}"),
    }
}
