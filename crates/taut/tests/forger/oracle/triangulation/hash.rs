//! The fingerprint of a set of simplices, written from its definition: a sum over simplices of a scrambled sum over
//! vertices, modulo 2¹²⁸.

/// The fractions of π, e, √2, √3 and √5.
const KEYS: [u64; 5] = [
    0x243f_6a88_85a3_08d3,
    0xb7e1_5162_8aed_2a6b,
    0x6a09_e667_f3bc_c909,
    0xbb67_ae85_84ca_a73b,
    0x3c6e_f372_fe94_f82b,
];

/// High and low half of a product.
fn halves(a: u64, b: u64) -> [u64; 2] {
    let product = u128::from(a) * u128::from(b);
    [(product >> 64) as u64, product as u64]
}

fn joined(high: u64, low: u64) -> u128 {
    u128::from(high) << 64 | u128::from(low)
}

fn of_site(coordinates: &[f64]) -> u128 {
    let [mut a, mut b] = [KEYS[0], KEYS[1]];
    for &x in coordinates {
        let bits = if x == 0.0 { 0 } else { x.to_bits() };
        let [high, low] = halves(a ^ bits, KEYS[2] ^ bits.rotate_left(32));
        [a, b] = [b ^ low, a.wrapping_add(high)];
    }
    let [high, low] = halves(a ^ KEYS[3], b ^ KEYS[4]);
    joined(high ^ a, low ^ b)
}

/// The fingerprint of simplices, given by rows of `values`.
pub(super) fn of_simplices(values: &[f64], columns: usize, simplices: &[Vec<u32>]) -> u128 {
    let site = |&id: &u32| of_site(&values[id as usize * columns..][..columns]);
    let simplex = |ids: &Vec<u32>| {
        let sum = ids.iter().map(site).fold(0u128, u128::wrapping_add);
        let [high, low] = [(sum >> 64) as u64, sum as u64];
        let [a, b] = halves(high ^ KEYS[0], low ^ KEYS[1]);
        let [a, b] = halves(a ^ low ^ KEYS[2], b ^ high ^ KEYS[3]);
        joined(a ^ high, b ^ low)
    };
    simplices.iter().map(simplex).fold(0, u128::wrapping_add)
}
