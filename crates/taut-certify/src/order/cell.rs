//! The place of a cell on a curve, one bit of each coordinate after the other, from the definition in
//! docs/memory/order.md.
//!
//! *Reference.* Hamilton, *Compact Hilbert Indices*, Dalhousie CS-2006-07, section 2.

use super::OrderCurve;

/// Place of a cell whose coordinates have `bits` bits each.
pub(super) fn place(curve: OrderCurve, cell: &[u32], bits: u32) -> u64 {
    match curve {
        OrderCurve::Morton => (0..bits).rev().fold(0, |place, bit| {
            cell.iter().rev().fold(place, |place, &c| place << 1 | u64::from(c >> bit & 1))
        }),
        OrderCurve::Hilbert => hilbert(cell, bits),
    }
}

fn hilbert(cell: &[u32], bits: u32) -> u64 {
    let d = cell.len() as u32;
    let all = (1u32 << d) - 1;
    let left = |x: u32, by: u32| (x << (by % d) | x >> ((d - by % d) % d)) & all;
    let right = |x: u32, by: u32| left(x, d - by % d);
    let gray = |w: u32| w ^ w >> 1;
    // The corner where the curve enters a cell, and the axis along which it leaves it.
    let (mut entry, mut axis, mut place) = (0, 0, 0u64);
    for bit in (0..bits).rev() {
        let corner = (0..d).fold(0, |corner, i| corner | (cell[i as usize] >> bit & 1) << i);
        let seen = right(corner ^ entry, axis + 1);
        let w = (0..=all).find(|&w| gray(w) == seen).unwrap_or(0);
        place = place << d | u64::from(w);
        let enters = if w == 0 { 0 } else { gray((w - 1) & !1) };
        let leaves = match w {
            0 => 0,
            w if w % 2 == 0 => (w - 1).trailing_ones(),
            w => w.trailing_ones(),
        };
        entry ^= left(enters, axis + 1);
        axis = (axis + leaves % d + 1) % d;
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path through all cells, each a side away from the one before.
    #[test]
    fn cells_that_follow_each_other_share_a_side() {
        for (d, bits) in [(2, 4), (3, 3)] {
            let side = 1u32 << bits;
            let mut cells: Vec<Vec<u32>> = (0..side.pow(d))
                .map(|i| (0..d).map(|axis| i / side.pow(axis) % side).collect())
                .collect();
            cells.sort_by_key(|cell| place(OrderCurve::Hilbert, cell, bits));
            for pair in cells.windows(2) {
                let steps: u32 = pair[0].iter().zip(&pair[1]).map(|(a, b)| a.abs_diff(*b)).sum();
                assert_eq!(steps, 1, "{pair:?}");
            }
        }
    }

    #[test]
    fn z_order_interleaves_bits() {
        assert_eq!(place(OrderCurve::Morton, &[0b11, 0b01], 2), 0b0111);
        assert_eq!(place(OrderCurve::Morton, &[1, 0, 1], 1), 0b101);
    }
}
