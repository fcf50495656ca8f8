//! The place of a cell on the Hilbert curve of the plane and of space.
//!
//! Idea: descending one level, the curve visits the 2ᵈ children of a cell in the order of a reflected Gray code, turned
//! so that it enters and leaves where the parent's path demands. The turn is a state: the corner of entry `e` and the
//! axis `a` along which the curve leaves. All turns fit in a table, so several levels cost one lookup.
//! Guarantee: a bijection of cells onto 0..2^(d·bits), in which consecutive cells share a face.
//! Trap: the table is indexed by the bits of each axis side by side (x₁x₀y₁y₀), not interleaved.
//! Reference: C. Hamilton, *Compact Hilbert Indices*, Dalhousie CS-2006-07, section 2 (entry points, directions).

/// Most bits per axis, so that a key fits 32 bits: 16 in the plane, 10 in space.
#[inline(always)]
pub(crate) const fn bits_max(d: usize) -> u32 {
    assert!(d == 2 || d == 3, "the plane and space");
    if d == 2 { 16 } else { 10 }
}

/// Turns of the curve, numbered `entry · d + axis`: 8 in the plane, 24 in space, and room up to a power of two, so that
/// a mask takes the place of a check in the chain of lookups.
const STATES: usize = 32;

/// Levels that one lookup of the table descends.
const fn levels(d: usize) -> u32 {
    if d == 2 { 4 } else { 2 }
}

/// Rotates the lowest `d` bits of `b` to the right.
const fn rotate_right(b: u32, by: u32, d: u32) -> u32 {
    let by = by % d;
    (b >> by | b << (d - by)) & ((1 << d) - 1)
}

/// Rotates the lowest `d` bits of `b` to the left.
const fn rotate_left(b: u32, by: u32, d: u32) -> u32 {
    rotate_right(b, d - by % d, d)
}

/// The rank of `code` in the reflected Gray code.
const fn gray_rank(code: u32) -> u32 {
    let mut rank = code;
    let mut shift = 1;
    while shift < 32 {
        rank ^= rank >> shift;
        shift *= 2;
    }
    rank
}

const fn gray(rank: u32) -> u32 {
    rank ^ rank >> 1
}

/// Where child number `w` is entered, in the frame of the parent.
const fn entry(w: u32) -> u32 {
    if w == 0 { 0 } else { gray((w - 1) / 2 * 2) }
}

/// Along which axis child number `w` is left, in the frame of the parent.
const fn axis(w: u32, d: u32) -> u32 {
    if w == 0 {
        0
    } else if w.is_multiple_of(2) {
        (w - 1).trailing_ones() % d
    } else {
        w.trailing_ones() % d
    }
}

/// One level down: the number of the child at `corner` (bit i for axis i) and the turn inside it.
const fn step(state: u32, corner: u32, d: u32) -> (u32, u32) {
    let (e, a) = (state / d, state % d);
    let w = gray_rank(rotate_right(corner ^ e, a + 1, d));
    let e_inside = e ^ rotate_left(entry(w), a + 1, d);
    let a_inside = (a + axis(w, d) + 1) % d;
    (w, e_inside * d + a_inside)
}

/// `table[state][bits of each axis]` = `place << 8 | state inside`.
const fn table<const ENTRIES: usize>(d: usize) -> [[u16; ENTRIES]; STATES] {
    let levels = levels(d);
    let mut table = [[0u16; ENTRIES]; STATES];
    let mut state = 0;
    while state < (d << d) {
        let mut index = 0;
        while index < ENTRIES {
            let (mut inside, mut place) = (state as u32, 0);
            let mut level = levels;
            while level > 0 {
                level -= 1;
                let (mut corner, mut axis) = (0, 0);
                while axis < d as u32 {
                    corner |= ((index as u32 >> (axis * levels + level)) & 1) << axis;
                    axis += 1;
                }
                let (w, next) = step(inside, corner, d as u32);
                place = place << d | w;
                inside = next;
            }
            table[state][index] = (place << 8 | inside) as u16;
            index += 1;
        }
        state += 1;
    }
    table
}

static PLANE: [[u16; 256]; STATES] = table(2);
static SPACE: [[u16; 64]; STATES] = table(3);

/// The key of a cell given with all bits that fit; what [`hilbert_key()`] computes, without its checks.
#[inline(always)]
pub(crate) fn key<const D: usize>(cell: [u32; D]) -> u32 {
    let step = const { levels(D) };
    let mask = (1 << step) - 1;
    let (mut state, mut key) = (0, 0);
    let mut shift = const { bits_max(D) };
    while shift > 0 {
        shift -= step;
        let mut index = 0;
        for (axis, &c) in cell.iter().enumerate() {
            index |= (((c >> shift) & mask) << (axis as u32 * step)) as usize;
        }
        let found = if D == 2 { PLANE[state][index & 255] } else { SPACE[state][index & 63] };
        key = key << (step * D as u32) | u32::from(found >> 8);
        state = usize::from(found) & (STATES - 1);
    }
    key
}

/// The place on the Hilbert curve of a cell of the grid with 2¹⁶ × 2¹⁶ cells in the plane (`D = 2`), or 2¹⁰ × 2¹⁰ × 2¹⁰
/// cells in space (`D = 3`).
///
/// Consecutive keys are cells that share a side; all keys below 2³² in the plane, 2³⁰ in space, are used once.
///
/// # Panics
/// If a coordinate has more bits than the grid.
pub fn hilbert_key<const D: usize>(cell: [u32; D]) -> u32 {
    assert!(cell.iter().all(|&c| c >> bits_max(D) == 0), "cell {cell:?} is outside the grid");
    key(cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks the first `side`ᵈ cells of the curve, wherever it puts them.
    fn walk<const D: usize>(side: u32) -> Vec<[u32; D]> {
        let mut cells = Vec::new();
        let mut cell = [0; D];
        loop {
            cells.push(cell);
            let Some(axis) = (0..D).find(|&i| cell[i] + 1 < side) else { break };
            cell[axis] += 1;
            cell[..axis].fill(0);
        }
        cells.sort_by_cached_key(|&c| hilbert_key(c));
        cells
    }

    #[test]
    fn consecutive_cells_share_a_face_and_keys_are_dense() {
        fn check<const D: usize>(side: u32) {
            let cells = walk::<D>(side);
            for (place, pair) in cells.windows(2).enumerate() {
                assert_eq!(hilbert_key(pair[0]) as usize, place);
                let steps: u32 = (0..D).map(|i| pair[0][i].abs_diff(pair[1][i])).sum();
                assert_eq!(steps, 1, "{:?} to {:?}", pair[0], pair[1]);
            }
        }
        check::<2>(if cfg!(miri) { 8 } else { 64 });
        check::<3>(if cfg!(miri) { 4 } else { 16 });
    }

    #[test]
    fn the_far_corners_are_inside_the_key_range() {
        // From one corner of the square to the other end of a side; two thirds of the way to the opposite corner.
        assert_eq!(hilbert_key([0, 0]), 0);
        let ends = [hilbert_key([65535, 0]), hilbert_key([0, 65535])];
        assert!(ends.contains(&u32::MAX) && ends.contains(&(u32::MAX / 3)), "{ends:?}");
        assert_eq!(hilbert_key([65535, 65535]), u32::MAX / 3 * 2);
        let corner = |k: u32| hilbert_key(std::array::from_fn::<_, 3, _>(|i| (k >> i & 1) * 1023));
        let corners: Vec<u32> = (0..8).map(corner).collect();
        assert!(corners.contains(&0) && corners.contains(&((1 << 30) - 1)), "{corners:?}");
        assert!(corners.iter().all(|&key| key < 1 << 30));
    }

    #[test]
    #[should_panic(expected = "outside the grid")]
    fn a_cell_outside_is_refused() {
        hilbert_key([1024, 0, 0]);
    }
}
