//! Proofs that this processor has an instruction set, for all kernels of the crate; its last cache; prefetches.
//!
//! *Guarantee.* A value of [`Avx2`] or [`Avx512`] is the proof that the processor has what it stands for: only asking it
//! makes one. Whoever takes a [`Level`] gives the same bits on every level.

use taut_points::{InstructionSet, instruction_set};

/// Proof that the processor has AVX2, FMA and POPCNT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

/// Proof that the processor has AVX-512F besides AVX2, FMA and POPCNT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx512(());

/// A set of instructions that this machine can run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One number at a time, on any processor.
    Portable,
    /// Vectors of 32 bytes.
    Avx2(Avx2),
    /// Vectors of 64 bytes.
    Avx512(Avx512),
}

impl Level {
    /// Returns the fastest one that `TAUT_KERNELS` allows on this machine.
    #[inline(always)]
    pub fn best() -> Self {
        match instruction_set() {
            InstructionSet::Avx512 => Level::Avx512(Avx512(())),
            InstructionSet::Avx2 => Level::Avx2(Avx2(())),
            // The compiler knows by itself which vectors each such processor has.
            InstructionSet::Neon | InstructionSet::Portable => Level::Portable,
        }
    }

    /// Returns all levels of this machine, the fastest last: what tests compare.
    pub fn all() -> Vec<Self> {
        let best = Self::best();
        let mut all = vec![Level::Portable];
        if best != Level::Portable {
            all.push(Level::Avx2(Avx2(())));
        }
        if matches!(best, Level::Avx512(_)) {
            all.push(best);
        }
        all
    }
}

/// Bytes of the last level of cache: larger targets are written past it. 32 MiB where the processor does not say.
pub(crate) fn last_cache_bytes() -> usize {
    static BYTES: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    // Under a virtual machine the question costs some microseconds.
    *BYTES.get_or_init(ask_last_cache_bytes)
}

fn ask_last_cache_bytes() -> usize {
    const CACHE_BYTES_DEFAULT: usize = 32 << 20;
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    {
        use std::arch::x86_64::{__cpuid, __cpuid_count};
        // Deterministic cache parameters: leaf 4 as Intel numbers it, 8000_001D where AMD put the same answer.
        let largest = [4, 0x8000_001D]
            .into_iter()
            .filter(|&leaf| __cpuid(leaf & 0x8000_0000).eax >= leaf)
            .flat_map(|leaf| (0..8).map(move |level| __cpuid_count(leaf, level)))
            .filter(|answer| answer.eax & 31 != 0)
            .map(|answer| {
                let (line, parts, ways) =
                    (answer.ebx & 0xFFF, answer.ebx >> 12 & 0x3FF, answer.ebx >> 22);
                (line as usize + 1)
                    * (parts as usize + 1)
                    * (ways as usize + 1)
                    * (answer.ecx as usize + 1)
            })
            .max();
        largest.unwrap_or(CACHE_BYTES_DEFAULT)
    }
    #[cfg(not(all(target_arch = "x86_64", not(miri))))]
    CACHE_BYTES_DEFAULT
}

/// Asks for the line of `words` that holds word `at`, to be in the second cache soon; any `at` is allowed.
///
/// The second cache, as it waits for twice as many lines at once as the first: 12 instead of 22 ns for a search of 2²⁴
/// keys in batches.
#[allow(unsafe_code, reason = "a prefetch")]
#[inline(always)]
pub fn prefetch<W>(words: &[W], at: usize) {
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    // SAFETY: a prefetch reads nothing, whatever the address.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T1>(words.as_ptr().wrapping_add(at).cast());
    }
    #[cfg(not(all(target_arch = "x86_64", not(miri))))]
    let _ = (words, at);
}
