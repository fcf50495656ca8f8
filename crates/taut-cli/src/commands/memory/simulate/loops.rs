//! The programs that the literature compares with: loops in the order in which one writes them down, and trees laid out
//! in other ways.

use taut::oblivious::{Access, Error, Probe};
use taut_reference::algorithms::VebIndex;

/// Rows of the source, one after the other, into columns of the target.
pub(super) fn transpose<P: Probe>(rows: usize, columns: usize, probe: &mut P) {
    let (from, to) = (vec![0u64; rows * columns], vec![0u64; rows * columns]);
    probe.place(&from);
    probe.place(&to);
    for i in 0..rows {
        for j in 0..columns {
            probe.read(&from[i * columns + j..][..1]);
            probe.write(&to[j * rows + i..][..1]);
        }
    }
    probe.lift(&to);
    probe.lift(&from);
}

/// The sum for each element of the product, one after the other.
pub(super) fn multiply<P: Probe>(n: usize, probe: &mut P) {
    let [a, b, c] = [(); 3].map(|()| vec![0u64; n * n]);
    [&a, &b, &c].into_iter().for_each(|matrix| probe.place(matrix));
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                probe.read(&a[i * n + k..][..1]);
                probe.read(&b[k * n + j..][..1]);
            }
            probe.write(&c[i * n + j..][..1]);
        }
    }
    [&c, &b, &a].into_iter().for_each(|matrix| probe.lift(matrix));
}

/// The way in which the nodes of a complete search tree lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    VanEmdeBoas,
    PreOrder,
    BreadthFirst,
}

/// This many searches are made.
pub(super) const SEARCH_COUNT: u64 = 10_000;

/// Searches for random leaves of a complete tree of `height` levels whose nodes have `width` bytes, of which the first
/// sixteen are read. The tree need not be there: only its places are.
pub(super) fn search<P: Probe>(
    layout: Layout,
    height: usize,
    width: usize,
    probe: &mut P,
) -> Result<(), Error> {
    let index = VebIndex::new(height)?;
    let base = 1 << 44;
    probe.place_at(base, width << height);
    let mut state = 1u64;
    let mut positions = vec![0; height];
    for _ in 0..SEARCH_COUNT {
        let mut node = 1;
        for depth in 0..height {
            positions[depth] = match layout {
                Layout::VanEmdeBoas => index.position(node, depth, &positions),
                Layout::BreadthFirst => node - 1,
                Layout::PreOrder if depth == 0 => 0,
                Layout::PreOrder => {
                    positions[depth - 1] + 1 + (node & 1) * ((1 << (height - depth)) - 1)
                }
            };
            probe.record(base + positions[depth] * width, width.min(16), Access::Read);
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            node = 2 * node + (state >> 63) as usize;
        }
    }
    probe.lift_from(base);
    Ok(())
}
