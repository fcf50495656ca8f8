//! Squared distances of codes of seven bits, for a block of templates at once.
//!
//! *Idea.* Codes of a block are stored coordinate after coordinate. Differences are at most 127, so that four squares fit into 16 bits:
//! sums of four are taken there, and then widened. All is exact, and no branch is in the inner loops, so that the compiler takes as
//! many numbers at a time as the vectors of the processor have.

use pulp::{Simd, WithSimd};
use taut_points::vectors;

/// Templates of a block.
pub(super) const BLOCK: usize = 64;
/// Coordinates whose squares are summed in 16 bits: 4·127² < 2¹⁶.
pub(super) const GROUP: usize = 4;
/// The largest code.
pub(super) const CODE_MAX: u8 = 127;

/// Who asks for sums of squares.
pub(super) trait Visitor {
    /// The largest sum of interest in a block.
    fn limit(&self, block: usize) -> u32;

    /// Takes the sums of a block of which one at least is within its limit.
    fn visit(&mut self, block: usize, sums: &[u32; BLOCK]);
}

/// Goes over every `stride`-th block of `codes`, each of which has [`BLOCK`] codes for each coordinate of `query`.
///
/// The number of coordinates is a multiple of [`GROUP`], and no code is larger than [`CODE_MAX`].
pub(super) fn screen(codes: &[u8], query: &[u8], stride: usize, visitor: &mut impl Visitor) {
    vectors().dispatch(Pass { codes, query, stride, visitor });
}

struct Pass<'a, V> {
    codes: &'a [u8],
    query: &'a [u8],
    stride: usize,
    visitor: &'a mut V,
}

impl<V: Visitor> WithSimd for Pass<'_, V> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Pass { codes, query, stride, visitor } = self;
        // Most templates are too far by half of their coordinates.
        let half = query.len() / GROUP / 2 * GROUP;
        let (first, second) = query.split_at(half);
        let blocks = codes.chunks_exact(query.len() * BLOCK).enumerate().step_by(stride);
        for (number, block) in blocks {
            let (block_first, block_second) = block.split_at(half * BLOCK);
            let limit = visitor.limit(number);
            let mut sums = [0u32; BLOCK];
            add_squares(block_first, first, &mut sums);
            if !is_any_within(&sums, limit) {
                continue;
            }
            add_squares(block_second, second, &mut sums);
            if is_any_within(&sums, limit) {
                visitor.visit(number, &sums);
            }
        }
    }
}

#[inline(always)]
fn is_any_within(sums: &[u32; BLOCK], limit: u32) -> bool {
    sums.iter().fold(u32::MAX, |least, &sum| least.min(sum)) <= limit
}

/// Adds the squares of the differences of some coordinates.
#[inline(always)]
fn add_squares(codes: &[u8], query: &[u8], sums: &mut [u32; BLOCK]) {
    for (codes, query) in codes.chunks_exact(GROUP * BLOCK).zip(query.chunks_exact(GROUP)) {
        let mut narrow = [0u16; BLOCK];
        for (codes, &q) in codes.chunks_exact(BLOCK).zip(query) {
            let q = i16::from(q);
            for (sum, &code) in narrow.iter_mut().zip(codes) {
                let difference = i16::from(code).wrapping_sub(q);
                *sum = sum.wrapping_add(difference.wrapping_mul(difference).cast_unsigned());
            }
        }
        sums.iter_mut().zip(&narrow).for_each(|(sum, &part)| *sum += u32::from(part));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct All(Vec<(usize, [u32; BLOCK])>, u32);

    impl Visitor for All {
        fn limit(&self, _: usize) -> u32 {
            self.1
        }

        fn visit(&mut self, block: usize, sums: &[u32; BLOCK]) {
            self.0.push((block, *sums));
        }
    }

    #[test]
    fn sums_are_those_of_the_definition() {
        for groups in [1, 2, 3, 16] {
            let dim = groups * GROUP;
            // The extremes of both signs are among them.
            let code = |i: usize| (i * i * 31 % 130).min(127) as u8;
            let codes: Vec<u8> = (0..3 * dim * BLOCK).map(code).collect();
            let query: Vec<u8> = (0..dim).map(|j| [0, 127, 64, 5][j % 4]).collect();
            let expected = |block: usize, i: usize| -> u32 {
                let difference =
                    |j: usize| u32::from(codes[(block * dim + j) * BLOCK + i].abs_diff(query[j]));
                (0..dim).map(|j| difference(j) * difference(j)).sum()
            };
            let mut all = All(vec![], u32::MAX);
            screen(&codes, &query, 1, &mut all);
            assert_eq!(all.0.len(), 3);
            let mut least = [u32::MAX; 3];
            for (block, sums) in &all.0 {
                for (i, &sum) in sums.iter().enumerate() {
                    assert_eq!(sum, expected(*block, i), "{groups} {block} {i}");
                    least[*block] = least[*block].min(sum);
                }
            }
            // Blocks without a sum within the limit are left out, and no others.
            for limit in least {
                let mut some = All(vec![], limit);
                screen(&codes, &query, 1, &mut some);
                let expected: Vec<usize> = (0..3).filter(|&block| least[block] <= limit).collect();
                assert_eq!(some.0.iter().map(|found| found.0).collect::<Vec<_>>(), expected);
            }
            let mut sparse = All(vec![], u32::MAX);
            screen(&codes, &query, 2, &mut sparse);
            assert_eq!(sparse.0.iter().map(|found| found.0).collect::<Vec<_>>(), [0, 2]);
        }
    }
}
