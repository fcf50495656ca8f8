//! Counts the words of a line of memory that are smaller than a given one: the step of every search by lines.
//!
//! Idea: a line of 64 bytes is one vector of AVX-512, or two of AVX2; one comparison gives a bit for each word, and the
//! count of bits is the place. The portable form adds up comparisons. All count the same.
//! Trap: left to the compiler, a loop over many searches becomes gathers across them, twice as slow.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

use crate::Word;

/// Returns how many words of `line`, a whole line, are smaller than `word`.
///
/// # Safety
/// The machine has AVX-512F, and the 64 bytes from `line` on are readable.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "a vector kernel")]
#[inline(always)]
unsafe fn below_avx512<W: Word>(line: *const W, word: W) -> usize {
    let word: u64 = word.into();
    // SAFETY: the caller vouches for AVX-512F, and for 64 bytes that can be read from `line` on; they may lie anywhere.
    let mask = unsafe {
        let line = _mm512_loadu_si512(line.cast());
        if size_of::<W>() == 8 {
            u32::from(_mm512_cmplt_epu64_mask(line, _mm512_set1_epi64(word.cast_signed())))
        } else {
            u32::from(_mm512_cmplt_epu32_mask(line, _mm512_set1_epi32(word as i32)))
        }
    };
    mask.count_ones() as usize
}

/// As [`below_avx512`], with AVX2.
///
/// # Safety
/// The machine has AVX2, and the 64 bytes from `line` on are readable.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "a vector kernel")]
#[inline(always)]
unsafe fn below_avx2<W: Word>(line: *const W, word: W) -> usize {
    let word: u64 = word.into();
    // SAFETY: the caller vouches for AVX2, and for 64 bytes that can be read from `line` on; they may lie anywhere.
    unsafe {
        let line: *const __m256i = line.cast();
        let (low, high) = (_mm256_loadu_si256(line), _mm256_loadu_si256(line.add(1)));
        // Signs are flipped, as AVX2 compares signed numbers only.
        let (low, high) = if size_of::<W>() == 8 {
            let sign = _mm256_set1_epi64x(i64::MIN);
            let word = _mm256_xor_si256(_mm256_set1_epi64x(word.cast_signed()), sign);
            let low = _mm256_cmpgt_epi64(word, _mm256_xor_si256(low, sign));
            let high = _mm256_cmpgt_epi64(word, _mm256_xor_si256(high, sign));
            (
                _mm256_movemask_pd(_mm256_castsi256_pd(low)),
                _mm256_movemask_pd(_mm256_castsi256_pd(high)),
            )
        } else {
            let sign = _mm256_set1_epi32(i32::MIN);
            let word = _mm256_xor_si256(_mm256_set1_epi32(word as i32), sign);
            let low = _mm256_cmpgt_epi32(word, _mm256_xor_si256(low, sign));
            let high = _mm256_cmpgt_epi32(word, _mm256_xor_si256(high, sign));
            (
                _mm256_movemask_ps(_mm256_castsi256_ps(low)),
                _mm256_movemask_ps(_mm256_castsi256_ps(high)),
            )
        };
        (low | high << 8).count_ones() as usize
    }
}

pub(crate) trait Count<W> {
    /// The words of the line that starts at `first` of `words` that are smaller than `word`.
    ///
    /// # Safety
    /// The machine has the instructions, `words` starts a line of memory, and `first` is a multiple of the words of a
    /// line, all of which are in `words`.
    #[allow(unsafe_code, reason = "a vector kernel")]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize;
}

/// Counts with vectors of 64 bytes.
#[cfg(target_arch = "x86_64")]
pub(crate) struct Avx512;

/// Counts with vectors of 32 bytes.
#[cfg(target_arch = "x86_64")]
pub(crate) struct Avx2;

/// Counts on any machine.
pub(crate) struct Portable;

#[cfg(target_arch = "x86_64")]
impl<W: Word> Count<W> for Avx512 {
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        // SAFETY: the caller vouches for the instructions, and that the whole line from `first` on is in `words`.
        unsafe { below_avx512(words.as_ptr().add(first), word) }
    }
}

#[cfg(target_arch = "x86_64")]
impl<W: Word> Count<W> for Avx2 {
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        // SAFETY: the caller vouches for the instructions, and that the whole line from `first` on is in `words`.
        unsafe { below_avx2(words.as_ptr().add(first), word) }
    }
}

impl<W: Word> Count<W> for Portable {
    #[allow(unsafe_code, reason = "the form without vectors of the kernels")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        words[first..first + W::LANES].iter().map(|&other| usize::from(other < word)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Level;
    use crate::Pages;

    #[allow(unsafe_code, reason = "calls the kernels one by one")]
    fn count<W: Word>(level: Level, words: &[W], first: usize, word: W) -> usize {
        assert!(first + W::LANES <= words.len() && first.is_multiple_of(W::LANES));
        // SAFETY: the line is inside as asserted, and a level is the proof that the machine has it.
        unsafe {
            match level {
                #[cfg(target_arch = "x86_64")]
                Level::Avx512(_) => Avx512::below(words, first, word),
                #[cfg(target_arch = "x86_64")]
                Level::Avx2(_) => Avx2::below(words, first, word),
                _ => Portable::below(words, first, word),
            }
        }
    }

    fn levels_agree<W: Word>(samples: &[W]) {
        let mut pages = Pages::<W>::zeroed(4 * W::LANES);
        for (i, word) in pages.words_mut().iter_mut().enumerate() {
            *word = samples[(i * i + i / 3) % samples.len()];
        }
        let words = pages.words();
        for first in (0..words.len()).step_by(W::LANES) {
            for &word in samples {
                let want =
                    words[first..first + W::LANES].iter().filter(|&&other| other < word).count();
                for level in Level::all() {
                    assert_eq!(count(level, words, first, word), want, "{level:?}");
                }
            }
        }
    }

    #[test]
    fn all_instructions_count_the_same() {
        let half = 1u64 << 63;
        levels_agree(&[0, 1, 2, half - 1, half, half + 1, u64::MAX - 1, u64::MAX]);
        let half = 1u32 << 31;
        levels_agree(&[0, 1, half - 1, half, half + 1, u32::MAX - 1, u32::MAX]);
    }
}
