//! Points and options made of any bytes: solved, and judged by the checker. Shared with the fuzz target.

use taut_enclose::{EllipsoidMethod, EllipsoidOptions, Error, ellipsoid};
use taut_points::{InputError, Points};

/// The first byte chooses dimension, method and kind of number; the rest are coordinates, as the bits of `f64` or as
/// small integers, which bring ties, copies and flat sets.
///
/// # Panics
/// When an answer is rejected by the checker, or refused for a reason that these options do not give.
pub(crate) fn solve_and_check(bytes: &[u8]) {
    let Some((&head, rest)) = bytes.split_first() else { return };
    let dim = usize::from(head % 4) + 1;
    let method = match head >> 2 & 3 {
        0 => EllipsoidMethod::ThesisCoreSet,
        1 => EllipsoidMethod::AwaySteps,
        _ => EllipsoidMethod::Newton,
    };
    let mut values: Vec<f64> = if head & 16 == 0 {
        rest.iter().map(|&b| f64::from(b as i8)).collect()
    } else {
        rest.as_chunks::<8>().0.iter().map(|&eight| f64::from_le_bytes(eight)).collect()
    };
    values.truncate((values.len() / dim).min(64) * dim);
    let points = Points::new(&values, dim).expect("whole rows were kept");
    let (epsilon, max_passes) =
        if method == EllipsoidMethod::Newton { (1e-12, 1000) } else { (0.1, 200) };
    let options = EllipsoidOptions { epsilon, method, max_passes, ..Default::default() };
    // Squares and products of two coordinates, and of what each is divided by, have all their digits.
    let moderate = values.iter().all(|v| *v == 0.0 || (1e-70..1e70).contains(&v.abs()));
    match ellipsoid(&points, &options) {
        Ok(found) if !moderate => {
            assert!(found.answer.center.iter().all(|c| c.is_finite()));
            assert!(found.answer.log_volume.is_finite() && found.certificate.gap.is_finite());
        }
        Ok(found) => {
            found.check(&points).unwrap_or_else(|error| panic!("{error}\n{values:?}\n{found:?}"));
        }
        Err(Error::Empty) => assert!(values.is_empty()),
        Err(Error::Input(InputError::NonFinite { row, column, value })) => {
            let at = values[row as usize * dim + column];
            assert!(!at.is_finite() && at.to_bits() == value.to_bits());
        }
        Err(Error::Overflow) => assert!(!moderate, "{values:?}"),
        Err(other) => panic!("{other}\n{values:?}"),
    }
}
