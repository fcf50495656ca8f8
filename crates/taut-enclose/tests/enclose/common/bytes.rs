//! Points, balls and options made of any bytes: solved, and judged by the checker. Shared with the fuzz target.

use taut_certify::Items;
use taut_enclose::{BallOptions, Error, ball};
use taut_points::{InputError, Points};

/// The first byte chooses dimension, kind and batch; the rest are coordinates, as the bits of `f64` or as small
/// integers, which bring ties and copies.
///
/// # Panics
/// When an answer is rejected by the checker, or refused for a reason that these options do not give.
pub(crate) fn solve_and_check(bytes: &[u8]) {
    let Some((&head, rest)) = bytes.split_first() else { return };
    let dim = usize::from(head % 4) + 1;
    let items = if head & 4 == 0 { Items::Points } else { Items::Balls };
    let batch = if head & 8 == 0 { None } else { Some(1) };
    let columns = dim + usize::from(items == Items::Balls);
    let mut values: Vec<f64> = if head & 16 == 0 {
        rest.iter().map(|&b| f64::from(b as i8)).collect()
    } else {
        rest.as_chunks::<8>().0.iter().map(|&eight| f64::from_le_bytes(eight)).collect()
    };
    values.truncate((values.len() / columns).min(64) * columns);
    if items == Items::Balls {
        values.iter_mut().skip(dim).step_by(columns).for_each(|radius| *radius = radius.abs());
    }
    let points = Points::new(&values, columns).expect("whole rows were kept");
    let options = BallOptions { epsilon: 0.0, batch, ..BallOptions::default() };
    match ball(&points, &BallOptions { inputs: items, ..options.clone() }) {
        Ok(found) => {
            found.check(&points).unwrap_or_else(|error| panic!("{error}\n{values:?}\n{found:?}"));
        }
        Err(Error::Empty) => assert!(values.is_empty()),
        Err(Error::Input(InputError::NonFinite { row, column, value })) => {
            let at = values[row as usize * columns + column];
            assert!(!at.is_finite() && at.to_bits() == value.to_bits());
        }
        Err(Error::Overflow) => assert!(values.iter().any(|v| v.abs() > f64::MAX / 64.0)),
        Err(other) => panic!("{other}\n{values:?}"),
    }
}
