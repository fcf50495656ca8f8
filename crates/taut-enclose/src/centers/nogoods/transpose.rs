//! Rows of bits become columns, 64 × 64 at a time.
//!
//! *Idea.* The square is cut in four, and the parts off the diagonal change places; then the same in each part, for all of them at once, with
//! masks: 6 steps of 32 exchanges, where one bit after the other would take up to 4096.
//! *Reference.* Warren, Hacker's Delight, section 7-3.

/// Bit j of word i becomes bit i of word j.
pub(super) fn transpose(words: &mut [u64; 64]) {
    let mut width = 32;
    let mut low = u64::MAX >> 32;
    while width > 0 {
        let mut row = 0;
        while row < 64 {
            for at in row..row + width {
                let exchanged = (words[at] >> width ^ words[at + width]) & low;
                words[at] ^= exchanged << width;
                words[at + width] ^= exchanged;
            }
            row += 2 * width;
        }
        width /= 2;
        low ^= low << width;
    }
}

#[cfg(test)]
mod tests {
    use super::transpose;

    #[test]
    fn each_bit_goes_to_its_place() {
        let mut state = 7u64;
        let words: [u64; 64] = std::array::from_fn(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            state ^ state >> 29
        });
        let mut turned = words;
        transpose(&mut turned);
        for (i, word) in words.iter().enumerate() {
            for (j, other) in turned.iter().enumerate() {
                assert_eq!(word >> j & 1, other >> i & 1, "{i}, {j}");
            }
        }
    }
}
