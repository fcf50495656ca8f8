//! The hash of a record, and of many in which order does not count.
//!
//! Written from the definition in docs/memory/sort.md; nothing here is the sort's. The hash of many is the sum, modulo
//! 2¹²⁸, of the hashes of each.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A hash of 128 bits of a multiset of records; 32 hexadecimal digits in JSON.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Hash128(pub u128);

impl Hash128 {
    /// Adds a record that is the bytes of all `parts`, one behind the other.
    pub(super) fn add(&mut self, parts: [&[u8]; 2]) {
        self.0 = self.0.wrapping_add(record(parts));
    }
}

/// START, FACTOR and FINAL of the definition, by lane.
const LANES: [[u64; 3]; 2] = [
    [0x243f_6a88_85a3_08d3, 0x9e37_79b9_7f4a_7c15, 0xbf58_476d_1ce4_e5b9],
    [0x1319_8a2e_0370_7344, 0xd6e8_feb8_6659_fd93, 0x94d0_49bb_1331_11eb],
];

/// The two halves of a product of 128 bits, added bit by bit.
fn fold(a: u64, b: u64) -> u64 {
    let [low, high] = {
        let product = u128::from(a) * u128::from(b);
        [product as u64, (product >> 64) as u64]
    };
    low ^ high
}

/// The rest of a record after some of its words.
struct Lanes {
    low: u64,
    high: u64,
}

impl Lanes {
    fn word(&mut self, x: u64) {
        self.low = fold(self.low ^ x, LANES[0][1]);
        let exchanged = x.rotate_left(32);
        self.high = fold(self.high.wrapping_add(exchanged), LANES[1][1]);
    }
}

fn record(parts: [&[u8]; 2]) -> u128 {
    let mut lanes = Lanes { low: LANES[0][0], high: LANES[1][0] };
    let (mut held, mut filled) = (0u64, 0);
    for part in parts {
        let mut rest = part;
        // Whole words where the parts before were whole ones.
        while filled == 0
            && let Some((word, more)) = rest.split_first_chunk()
        {
            lanes.word(u64::from_le_bytes(*word));
            rest = more;
        }
        for byte in rest {
            held |= u64::from(*byte) << (8 * filled);
            filled += 1;
            if filled == 8 {
                lanes.word(held);
                (held, filled) = (0, 0);
            }
        }
    }
    if filled > 0 {
        lanes.word(held);
    }
    let [low, high] = [(lanes.low, LANES[0]), (lanes.high, LANES[1])]
        .map(|(h, [_, factor, last])| fold(h ^ last, factor));
    u128::from(low) | u128::from(high) << 64
}

impl fmt::Display for Hash128 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// The text is not what a [`Hash128`] is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a hash is 32 digits, each of 0 to 9 or a to f")]
pub struct Hash128FormError;

impl FromStr for Hash128 {
    type Err = Hash128FormError;

    /// Reads what is written, and nothing else: a hash has one form.
    fn from_str(text: &str) -> Result<Self, Hash128FormError> {
        let form = text.len() == 32 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        match u128::from_str_radix(text, 16) {
            Ok(value) if form => Ok(Hash128(value)),
            _ => Err(Hash128FormError),
        }
    }
}

impl Serialize for Hash128 {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Hash128 {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}
