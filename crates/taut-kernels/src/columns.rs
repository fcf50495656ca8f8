//! Squared distances to points stored by coordinate, in up to three dimensions.
//!
//! *Guarantee.* The values are those of [`squared_distances`](crate::squared_distances) for rows of the same
//! coordinates, bit by bit: the squares are added in order of the coordinates, and no operation is fused.
//! *Trap.* That a box is no nearer than its points holds in rounded arithmetic, too, as long as both sides round the same
//! operations in the same order: rounding never changes which of two numbers is larger.

use crate::vector::dispatched;

/// A group has this many points: two registers, or more where they are shorter.
pub const GROUP_SIZE: usize = 16;

dispatched! {
    /// Lowers each of `least` to the squared distance of its point to `center`, where that is less; returns the largest
    /// of them then. `columns` holds coordinate after coordinate of as many points, a multiple of [`GROUP_SIZE`].
    ///
    /// # Panics
    /// If there are no coordinates or more than three, or fewer values than that.
    lower(columns: &[f64], center: &[f64], least: &mut [f64]) -> f64, lower_body
}

#[inline(always)]
fn lower_body<const FUSED: bool>(columns: &[f64], center: &[f64], least: &mut [f64]) -> f64 {
    let n = least.len();
    let column = |j: usize| &columns[j * n..(j + 1) * n];
    match *center {
        [x] => lower_of([column(0)], [x], least),
        [x, y] => lower_of([column(0), column(1)], [x, y], least),
        [x, y, z] => lower_of([column(0), column(1), column(2)], [x, y, z], least),
        _ => unreachable!("points of more dimensions are not stored by coordinate"),
    }
}

#[inline(always)]
fn lower_of<const D: usize>(columns: [&[f64]; D], center: [f64; D], least: &mut [f64]) -> f64 {
    let columns = columns.map(|column| column.as_chunks::<GROUP_SIZE>().0);
    let mut largest = [0.0f64; GROUP_SIZE];
    for (g, least) in least.as_chunks_mut::<GROUP_SIZE>().0.iter_mut().enumerate() {
        let group = columns.map(|column| &column[g]);
        for i in 0..GROUP_SIZE {
            let mut sum = 0.0;
            for j in 0..D {
                let difference = group[j][i] - center[j];
                sum += difference * difference;
            }
            least[i] = if sum < least[i] { sum } else { least[i] };
            largest[i] = if least[i] > largest[i] { least[i] } else { largest[i] };
        }
    }
    largest.into_iter().fold(0.0, |m, v| if v > m { v } else { m })
}

dispatched! {
    /// Adds to each of `gaps` the square of how far its value lies outside of `low ..= high`.
    add_gaps(values: &[f64], low: f64, high: f64, gaps: &mut [f64]), add_gaps_body
}

#[inline(always)]
fn add_gaps_body<const FUSED: bool>(values: &[f64], low: f64, high: f64, gaps: &mut [f64]) {
    for (gap, &value) in gaps.iter_mut().zip(values) {
        let (below, above) = (low - value, value - high);
        let outside = if below > above { below } else { above };
        let outside = if outside > 0.0 { outside } else { 0.0 };
        *gap += outside * outside;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Center, squared_distances};
    use proptest::prelude::*;

    proptest! {
        /// Every value is that of the kernel for rows, and no box is farther than a point in it.
        #[test]
        fn columns_and_boxes_agree_with_rows(
            dim in 1usize..=3,
            values in prop::collection::vec(prop_oneof![-1.0..1.0f64, (-3..4i32).prop_map(f64::from)], 3 * 32),
            center in prop::collection::vec(prop_oneof![-2.0..2.0f64, (-3..4i32).prop_map(f64::from)], 3),
        ) {
            let (rows, center) = (&values[..dim * 32], &center[..dim]);
            let mut wanted = vec![0.0; 32];
            let as_center = Center { high: center.to_vec(), low: vec![] };
            squared_distances(rows, dim, &as_center, &mut wanted);
            let columns: Vec<f64> =
                (0..dim).flat_map(|j| rows.iter().skip(j).step_by(dim).copied()).collect();
            let mut least = vec![f64::INFINITY; 32];
            least[5] = 0.125;
            let largest = lower(&columns, center, &mut least);
            wanted[5] = wanted[5].min(0.125);
            prop_assert_eq!(&least, &wanted);
            prop_assert_eq!(largest, wanted.iter().copied().fold(0.0, f64::max));
            let mut gap = [0.0];
            for j in 0..dim {
                let column = &columns[j * 32..(j + 1) * 32];
                let low = column.iter().copied().fold(f64::INFINITY, f64::min);
                let high = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                add_gaps(&[center[j]], low, high, &mut gap);
            }
            wanted.remove(5);
            prop_assert!(wanted.iter().all(|&value| gap[0] <= value));
        }
    }
}
