//! The hash that ties a certificate to the points it speaks of.
//!
//! *Value.* Each block of [`Blocks`] is hashed on its own, over its coordinates as `f64`, so the blocks can be
//! hashed by any threads in any order, and single-precision points have the hash of their exact copies in double
//! precision; then the block hashes, n and d are hashed in order. −0 counts as 0.
//! *Idea.* 32 lanes, each h ← h·P + mix(v) modulo 2⁶⁴ with P odd. The multiplication is one-to-one, so a change
//! of a single coordinate always changes its lane. mix folds the high half onto the low half, because coordinates
//! with few digits differ in high bits only, which multiplication would never carry down.
//! *Not* a cryptographic hash: it tells that data changed, not that somebody meant to deceive.

#[cfg(target_arch = "x86_64")]
mod x86;

use crate::{Monitor, PointSource, Points, ReadError, Rows, Scalar, map_blocks};

const LANES: usize = 32;
/// Odd multiplier with well spread bits: the fractional part of the golden ratio, as in Knuth, TAOCP 3, 6.4.
const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;

/// The hash of a point set: equal for equal coordinates in equal order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PointsHash(pub u64);

/// The hash of one block, to be put together by [`PointsHash::of_blocks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockHash(u64);

impl BlockHash {
    /// The hash as a number, for those who store it.
    pub fn to_bits(self) -> u64 {
        self.0
    }

    /// The hash that [`to_bits`](Self::to_bits) gave.
    pub fn from_bits(bits: u64) -> Self {
        BlockHash(bits)
    }
}

impl PointsHash {
    /// Puts together the hashes of all blocks of n points of dimension d, in block order.
    pub fn of_blocks(n: u64, dim: usize, blocks: impl IntoIterator<Item = BlockHash>) -> Self {
        let start = step(step(1, n), dim as u64);
        PointsHash(finish(blocks.into_iter().fold(start, |h, block| step(h, block.0))))
    }

    /// The same, of blocks that were put together before.
    pub(crate) fn of_run(n: u64, dim: usize, run: HashRun) -> Self {
        let start = step(step(1, n), dim as u64);
        PointsHash(finish(start.wrapping_mul(power(run.blocks)).wrapping_add(run.sum)))
    }
}

/// The hashes of blocks next to each other: what these blocks do to the hash of those before them.
///
/// A step takes h to h·P + mix(v), so m of them take it to h·Pᵐ and a sum that does not depend on h.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HashRun {
    blocks: u64,
    sum: u64,
}

impl HashRun {
    /// One block.
    pub(crate) fn of(block: BlockHash) -> Self {
        HashRun { blocks: 1, sum: step(0, block.0) }
    }

    /// These blocks and the next ones.
    pub(crate) fn then(self, next: Self) -> Self {
        HashRun {
            blocks: self.blocks + next.blocks,
            sum: self.sum.wrapping_mul(power(next.blocks)).wrapping_add(next.sum),
        }
    }

    /// The number of blocks.
    pub(crate) fn blocks(self) -> u64 {
        self.blocks
    }

    pub(crate) fn to_bits(self) -> (u64, u64) {
        (self.blocks, self.sum)
    }

    pub(crate) fn from_bits(blocks: u64, sum: u64) -> Self {
        HashRun { blocks, sum }
    }
}

/// Pᵐ.
fn power(mut exponent: u64) -> u64 {
    let (mut power, mut square) = (1u64, MULTIPLIER);
    while exponent > 0 {
        if exponent & 1 == 1 {
            power = power.wrapping_mul(square);
        }
        square = square.wrapping_mul(square);
        exponent >>= 1;
    }
    power
}

impl std::fmt::Display for PointsHash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// The text is not what a [`PointsHash`] is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a hash of points is 16 digits, each of 0 to 9 or a to f")]
pub struct HashFormError;

impl std::str::FromStr for PointsHash {
    type Err = HashFormError;

    /// Reads what is written, and nothing else: a hash has one form.
    fn from_str(text: &str) -> Result<Self, HashFormError> {
        let form = text.len() == 16 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        match u64::from_str_radix(text, 16) {
            Ok(hash) if form => Ok(PointsHash(hash)),
            _ => Err(HashFormError),
        }
    }
}

#[inline(always)]
fn step(hash: u64, value: u64) -> u64 {
    hash.wrapping_mul(MULTIPLIER).wrapping_add(value ^ (value >> 32))
}

/// Spreads the last differences over all bits: the finalizer of SplitMix64 (Steele, Lea, Flood 2014).
fn finish(mut h: u64) -> u64 {
    h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    h ^ (h >> 31)
}

#[inline(always)]
fn bits<T: Scalar>(value: T) -> u64 {
    // Adding 0 turns −0 into 0 and leaves every other value as it is.
    (value.into() + 0.0).to_bits()
}

/// The state of the lanes before the first value.
#[inline(always)]
fn start() -> [u64; LANES] {
    std::array::from_fn(|lane| lane as u64 + 1)
}

/// Puts the lanes together with the values after the last full group.
#[inline(always)]
fn put_together<T: Scalar>(lanes: [u64; LANES], values: &[T]) -> BlockHash {
    let rest = values.as_chunks::<LANES>().1;
    let hash = rest.iter().fold(values.len() as u64, |h, &value| step(h, bits(value)));
    BlockHash(finish(lanes.into_iter().fold(hash, |h, lane| step(h, finish(lane)))))
}

/// For every processor; the vectors of [`x86`] do the same sooner.
fn portable<T: Scalar>(values: &[T]) -> BlockHash {
    let mut lanes = start();
    for chunk in values.as_chunks::<LANES>().0 {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = step(*lane, bits(value));
        }
    }
    put_together(lanes, values)
}

fn dispatched<T: Scalar>(points: &Points<'_, T>) -> BlockHash {
    #[cfg(target_arch = "x86_64")]
    if let Some(hash) = x86::hash(points.values()) {
        return hash;
    }
    portable(points.values())
}

/// The hash of one block of [`Blocks`](crate::Blocks).
pub fn hash_block(rows: &Rows<'_>) -> BlockHash {
    match rows {
        Rows::F32(points) => dispatched(points),
        Rows::F64(points) => dispatched(points),
    }
}

/// The hash of all points of `source`, in one pass.
///
/// # Errors
/// The error of reading the points.
pub fn hash_points(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<PointsHash, ReadError> {
    let blocks = map_blocks(source, monitor, |_, rows| Ok::<_, ReadError>(hash_block(&rows)))?;
    Ok(PointsHash::of_blocks(source.len(), source.dim(), blocks))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash<T: Scalar>(values: &[T], dim: usize) -> PointsHash {
        hash_points(&Points::new(values, dim).unwrap(), &Monitor::silent()).unwrap()
    }

    #[test]
    fn every_instruction_set_gives_the_same_hash() {
        let mut values: Vec<f64> = (0..1003).map(|i| (i as f64 * 0.37).sin() * 1e300).collect();
        values.extend([-0.0, 0.0, f64::MIN_POSITIVE / 4.0, -1e-310]);
        let narrow: Vec<f32> = values.iter().map(|&v| (v * 1e-300) as f32).collect();
        for n in (0..100).chain([values.len()]) {
            assert_eq!(hashes(&values[values.len() - n..]), []);
            assert_eq!(hashes(&narrow[narrow.len() - n..]), []);
        }
    }

    /// The hashes of instruction sets that are not the portable one.
    fn hashes<T: Scalar>(values: &[T]) -> Vec<BlockHash> {
        #[cfg(target_arch = "x86_64")]
        let vectors = x86::each_instruction_set(values);
        #[cfg(not(target_arch = "x86_64"))]
        let vectors = Vec::<BlockHash>::new();
        vectors.into_iter().filter(|&hash| hash != portable(values)).collect()
    }

    #[test]
    fn single_and_double_precision_agree_on_equal_values() {
        let narrow: Vec<f32> = (0..999).map(|i| (i as f32 * 0.37).sin()).collect();
        let wide: Vec<f64> = narrow.iter().map(|&v| v.into()).collect();
        assert_eq!(hash(&narrow, 3), hash(&wide, 3));
    }

    #[test]
    fn each_single_change_shape_and_order_is_seen() {
        let values: Vec<f64> = (0..120).map(f64::from).collect();
        let before = hash(&values, 2);
        assert_ne!(before, hash(&values, 3));
        assert_ne!(before, hash(&values[..118], 2));
        for i in 0..values.len() {
            for changed in
                [values[i] + 1.0, -values[i] - 1.0, f64::from_bits(values[i].to_bits() + 1)]
            {
                let mut other = values.clone();
                other[i] = changed;
                assert_ne!(before, hash(&other, 2), "value {i}");
            }
        }
        let mut swapped = values.clone();
        swapped.swap(0, 64);
        assert_ne!(before, hash(&swapped, 2));
    }

    #[test]
    fn a_hash_has_one_form() {
        assert_eq!("00000000000feed0".parse(), Ok(PointsHash(0xfeed0)));
        for other in ["feed0", "+000000000feed0a", "00000000000FEED0", "000000000000feed0", ""] {
            assert_eq!(other.parse::<PointsHash>(), Err(HashFormError), "{other}");
        }
    }

    #[test]
    fn negative_zero_is_zero() {
        assert_eq!(hash(&[0.0, 1.0], 1), hash(&[-0.0, 1.0], 1));
    }
}
