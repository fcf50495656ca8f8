//! How many words of a line of memory are smaller than a given one: the step of every search by lines.
//!
//! Idea: a line of 64 bytes is one vector of AVX-512, or two of AVX2; one comparison gives a bit for each word, and the
//! count of bits is the place. The portable form adds up comparisons. All count the same.
//! Trap: left to the compiler, a loop over many searches becomes gathers across them, twice as slow.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// The counting of one kind of words, for each set of instructions.
pub trait Lanes: Copy {
    /// The words of `line`, a whole line, that are smaller than `word`.
    ///
    /// # Safety
    /// The machine has AVX-512 F, and the 64 bytes from `line` on are readable.
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    unsafe fn below_avx512(line: *const Self, word: Self) -> usize;

    /// The same with AVX2.
    ///
    /// # Safety
    /// The machine has AVX2, and the 64 bytes from `line` on are readable.
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    unsafe fn below_avx2(line: *const Self, word: Self) -> usize;
}

impl Lanes for u64 {
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below_avx512(line: *const Self, word: Self) -> usize {
        // SAFETY: the caller vouches for AVX-512F, and for 64 bytes that can be read from `line` on; they may lie anywhere.
        let mask = unsafe {
            _mm512_cmplt_epu64_mask(
                _mm512_loadu_si512(line.cast()),
                _mm512_set1_epi64(word.cast_signed()),
            )
        };
        u32::from(mask).count_ones() as usize
    }

    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below_avx2(line: *const Self, word: Self) -> usize {
        // SAFETY: the caller vouches for AVX2, and for 64 bytes that can be read from `line` on; they may lie anywhere.
        unsafe {
            // Signs are flipped, as AVX2 compares signed numbers only.
            let sign = _mm256_set1_epi64x(i64::MIN);
            let word = _mm256_xor_si256(_mm256_set1_epi64x(word.cast_signed()), sign);
            let low = _mm256_xor_si256(_mm256_loadu_si256(line.cast()), sign);
            let high = _mm256_xor_si256(_mm256_loadu_si256(line.add(4).cast()), sign);
            let low = _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(word, low)));
            let high = _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(word, high)));
            (low | high << 4).count_ones() as usize
        }
    }
}

impl Lanes for u32 {
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below_avx512(line: *const Self, word: Self) -> usize {
        // SAFETY: the caller vouches for AVX-512F, and for 64 bytes that can be read from `line` on; they may lie anywhere.
        let mask = unsafe {
            _mm512_cmplt_epu32_mask(
                _mm512_loadu_si512(line.cast()),
                _mm512_set1_epi32(word.cast_signed()),
            )
        };
        u32::from(mask).count_ones() as usize
    }

    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below_avx2(line: *const Self, word: Self) -> usize {
        // SAFETY: the caller vouches for AVX2, and for 64 bytes that can be read from `line` on; they may lie anywhere.
        unsafe {
            // Signs are flipped, as AVX2 compares signed numbers only.
            let sign = _mm256_set1_epi32(i32::MIN);
            let word = _mm256_xor_si256(_mm256_set1_epi32(word.cast_signed()), sign);
            let low = _mm256_xor_si256(_mm256_loadu_si256(line.cast()), sign);
            let high = _mm256_xor_si256(_mm256_loadu_si256(line.add(8).cast()), sign);
            let low = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(word, low)));
            let high = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(word, high)));
            (low | high << 8).count_ones() as usize
        }
    }
}

/// A way to count, and to bring a line closer ahead of its use.
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
impl<W: Lanes> Count<W> for Avx512 {
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        // SAFETY: the caller vouches for the instructions, and that the whole line from `first` on is in `words`.
        unsafe { W::below_avx512(words.as_ptr().add(first), word) }
    }
}

#[cfg(target_arch = "x86_64")]
impl<W: Lanes> Count<W> for Avx2 {
    #[allow(unsafe_code, reason = "a vector kernel")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        // SAFETY: the caller vouches for the instructions, and that the whole line from `first` on is in `words`.
        unsafe { W::below_avx2(words.as_ptr().add(first), word) }
    }
}

impl<W: crate::Word> Count<W> for Portable {
    #[allow(unsafe_code, reason = "the form without vectors of the kernels")]
    #[inline(always)]
    unsafe fn below(words: &[W], first: usize, word: W) -> usize {
        words[first..first + W::LANES].iter().map(|&other| usize::from(other < word)).sum()
    }
}

/// Asks for the line of `words` that holds word `at`, to be in the second cache soon; any `at` is allowed.
///
/// The second cache, as it waits for twice as many lines at once as the first: 12 instead of 22 ns for a search of 2²⁴
/// keys in batches.
#[allow(unsafe_code, reason = "a prefetch")]
#[inline(always)]
pub(crate) fn prefetch<W>(words: &[W], at: usize) {
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    // SAFETY: a prefetch reads nothing, whatever the address.
    unsafe {
        _mm_prefetch::<_MM_HINT_T1>(words.as_ptr().wrapping_add(at).cast());
    }
    #[cfg(not(all(target_arch = "x86_64", not(miri))))]
    let _ = (words, at);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Word;
    use crate::level::Level;
    use crate::pages::Pages;

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
                Level::Portable => Portable::below(words, first, word),
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
