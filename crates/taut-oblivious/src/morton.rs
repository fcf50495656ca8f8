//! The place of a cell in the Z-order of the plane and of space.
//!
//! Idea: the bits of the coordinates, interleaved; each coordinate is spread by shifts and masks, half of its bits at a
//! time.
//! Guarantee: a bijection of cells onto 0..2^(d·bits) under which a cell of any level holds consecutive keys.
//! Trap: consecutive keys may lie far apart, across a whole cell of any level, which does not happen on the Hilbert curve.
//! Reference: G. M. Morton, *A computer oriented geodetic data base and a new technique in file sequencing*, IBM, 1966.

use crate::hilbert::bits_max;

/// Puts one zero behind each of 16 bits.
#[inline(always)]
fn spread_2(x: u32) -> u32 {
    let x = (x | x << 8) & 0x00FF_00FF;
    let x = (x | x << 4) & 0x0F0F_0F0F;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

/// Puts two zeros behind each of 10 bits.
#[inline(always)]
fn spread_3(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00FF;
    let x = (x | x << 8) & 0x0300_F00F;
    let x = (x | x << 4) & 0x030C_30C3;
    (x | x << 2) & 0x0924_9249
}

/// Returns what [`morton_key()`] computes, without its checks.
#[inline(always)]
pub(crate) fn key<const D: usize>(cell: [u32; D]) -> u32 {
    let mut key = 0;
    for (axis, &c) in cell.iter().enumerate() {
        key |= if D == 2 { spread_2(c) } else { spread_3(c) } << axis;
    }
    key
}

/// The place in Z-order of a cell of the grid with 2¹⁶ × 2¹⁶ cells in the plane (`D = 2`), or 2¹⁰ × 2¹⁰ × 2¹⁰ cells in
/// space (`D = 3`): bit b of axis i is bit d·b + i of the key.
///
/// Cheaper than [`hilbert_key()`](crate::hilbert_key), and with longer steps.
///
/// # Panics
/// If a coordinate has more bits than the grid.
pub fn morton_key<const D: usize>(cell: [u32; D]) -> u32 {
    assert!(cell.iter().all(|&c| c >> bits_max(D) == 0), "cell {cell:?} is outside the grid");
    key(cell)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Bit by bit.
    fn plain<const D: usize>(cell: [u32; D]) -> u32 {
        let bit = |axis: usize, b: u32| (cell[axis] >> b & 1) << (b * D as u32 + axis as u32);
        (0..D)
            .flat_map(|axis| (0..bits_max(D)).map(move |b| (axis, b)))
            .fold(0, |key, (a, b)| key | bit(a, b))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 8 } else { 256 }))]
        #[test]
        fn bits_are_interleaved(x in 0u32..1 << 16, y in 0u32..1 << 16) {
            prop_assert_eq!(morton_key([x, y]), plain([x, y]));
            let [x, y, z] = [x >> 6, y >> 6, (x ^ y) & 1023];
            prop_assert_eq!(morton_key([x, y, z]), plain([x, y, z]));
        }
    }

    #[test]
    fn a_square_and_a_cube_in_order() {
        assert_eq!([[0, 0], [1, 0], [0, 1], [1, 1]].map(morton_key), [0, 1, 2, 3]);
        assert_eq!([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]].map(morton_key), [1, 2, 4, 7]);
        assert_eq!(morton_key([65535, 65535]), u32::MAX);
        assert_eq!(morton_key([1023, 1023, 1023]), (1 << 30) - 1);
    }

    #[test]
    #[should_panic(expected = "outside the grid")]
    fn a_cell_outside_is_refused() {
        morton_key([0, 65536]);
    }
}
