//! A number for a set of simplices that depends on the coordinates of their vertices alone.
//!
//! *Value.* Each site has a hash of 128 bits, of its coordinates as `f64` (−0 counts as 0). A simplex has the
//! scrambled sum of the hashes of its vertices, and a set of simplices the sum of theirs, all modulo 2¹²⁸. Sums do not
//! depend on any order: of the input rows, of the vertices in a simplex, of the simplices. The scrambling between the
//! two sums is what makes them tell more than how often each vertex occurs, which a flip of four or five points need
//! not change.
//! *Use.* Equal fingerprints speak for equal triangulations as if the hashes of simplices were random numbers of 128 bits;
//! nothing is proved. *Not* a cryptographic hash.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use taut_points::Points;

use crate::unrolled::unrolled;

/// The fingerprint of a set of simplices. Written as 32 hexadecimal digits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Fingerprint(pub u128);

/// The hash of one site.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SiteHash(u128);

/// Well spread bits: the fractions of π, e, √2, √3 and √5.
const KEYS: [u64; 5] = [
    0x243F_6A88_85A3_08D3,
    0xB7E1_5162_8AED_2A6B,
    0x6A09_E667_F3BC_C909,
    0xBB67_AE85_84CA_A73B,
    0x3C6E_F372_FE94_F82B,
];

/// The two halves of a product, each bit of which depends on most of either factor.
#[inline(always)]
fn folded(a: u64, b: u64) -> (u64, u64) {
    let product = u128::from(a) * u128::from(b);
    ((product >> 64) as u64, product as u64)
}

impl SiteHash {
    /// The hash of the site with these coordinates.
    #[inline(always)]
    pub fn of(coordinates: &[f64]) -> Self {
        let [mut a, mut b, ..] = KEYS;
        for &coordinate in coordinates {
            // Adding 0 turns −0 into 0 and leaves every other value as it is.
            let bits = (coordinate + 0.0).to_bits();
            let (high, low) = folded(a ^ bits, KEYS[2] ^ bits.rotate_left(32));
            (a, b) = (b ^ low, a.wrapping_add(high));
        }
        let (high, low) = folded(a ^ KEYS[3], b ^ KEYS[4]);
        SiteHash(u128::from(high ^ a) << 64 | u128::from(low ^ b))
    }
}

impl Fingerprint {
    /// Adds the simplex with these vertices, at most four, in any order.
    #[inline(always)]
    pub fn add<const V: usize>(&mut self, vertices: [SiteHash; V]) {
        let mut sum = 0u128;
        unrolled!(i < V, { sum = sum.wrapping_add(vertices[i].0) });
        let (high, low) = ((sum >> 64) as u64, sum as u64);
        // Twice: one product alone would tell no more than which pairs of vertices share how many simplices.
        let (a, b) = folded(high ^ KEYS[0], low ^ KEYS[1]);
        let (a, b) = folded(a ^ low ^ KEYS[2], b ^ high ^ KEYS[3]);
        self.0 = self.0.wrapping_add(u128::from(a ^ high) << 64 | u128::from(b ^ low));
    }

    /// Adds all simplices of another set.
    pub fn merge(&mut self, other: Fingerprint) {
        self.0 = self.0.wrapping_add(other.0);
    }
}

/// The fingerprint of simplices of `V` vertices each, given by row numbers of `points`. O(n + simplices).
///
/// # Panics
/// When a number is no row of `points`.
pub fn fingerprint<const V: usize>(
    points: &Points<'_, f64>,
    simplices: impl IntoIterator<Item = [u32; V]>,
) -> Fingerprint {
    let hashes: Vec<SiteHash> = points.rows().map(SiteHash::of).collect();
    let mut sum = Fingerprint::default();
    for simplex in simplices {
        sum.add(simplex.map(|id| hashes[id as usize]));
    }
    sum
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// The text is not what a [`Fingerprint`] is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a fingerprint is 32 digits, each of 0 to 9 or a to f")]
pub struct FingerprintFormError;

impl FromStr for Fingerprint {
    type Err = FingerprintFormError;

    /// Reads what is written, and nothing else: a fingerprint has one form.
    fn from_str(text: &str) -> Result<Self, FingerprintFormError> {
        let form = text.len() == 32 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        match u128::from_str_radix(text, 16) {
            Ok(value) if form => Ok(Fingerprint(value)),
            _ => Err(FingerprintFormError),
        }
    }
}

impl Serialize for Fingerprint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Fingerprint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VALUES: [f64; 10] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.5, 2.0];

    fn of(simplices: &[[u32; 3]]) -> Fingerprint {
        fingerprint(&Points::new(&VALUES, 2).unwrap(), simplices.iter().copied())
    }

    #[test]
    fn orders_do_not_matter_but_flips_do() {
        let print = of(&[[0, 1, 2], [1, 3, 2]]);
        assert_eq!(print, of(&[[2, 1, 3], [2, 0, 1]]));
        assert_ne!(print, of(&[[0, 1, 3], [0, 3, 2]]));
        assert_ne!(print, of(&[[0, 1, 2]]));
        assert_ne!(print, of(&[[0, 1, 2], [1, 3, 2], [1, 3, 2]]));
        assert_eq!(of(&[]), Fingerprint(0));
    }

    /// Both sets have every vertex twice: a plain sum over vertices would not tell them apart.
    #[test]
    fn sets_of_equal_degrees_differ() {
        assert_ne!(of(&[[0, 1, 2], [0, 3, 4]]), of(&[[0, 1, 3], [0, 2, 4]]));
    }

    /// Written certificates hold these.
    #[test]
    fn the_value_stays_what_it_is() {
        assert_eq!(of(&[[0, 1, 2], [1, 3, 2]]).to_string(), "62ec5f08b1d02b5544182c3bb77506e5");
    }

    #[test]
    fn negative_zero_is_zero_and_one_ulp_is_seen() {
        assert_eq!(SiteHash::of(&[-0.0, 1.0]), SiteHash::of(&[0.0, 1.0]));
        assert_ne!(SiteHash::of(&[1.0, 0.0]), SiteHash::of(&[0.0, 1.0]));
        assert_ne!(SiteHash::of(&[1.0, 0.0]), SiteHash::of(&[1f64.next_up(), 0.0]));
    }

    #[test]
    fn a_fingerprint_has_one_form() {
        let text = "000000000000000000000000000feed0";
        assert_eq!(text.parse(), Ok(Fingerprint(0xfeed0)));
        for other in [&text[1..], "", "+00000000000000000000000000feed0", &text.to_uppercase()] {
            assert_eq!(other.parse::<Fingerprint>(), Err(FingerprintFormError), "{other}");
        }
    }
}
