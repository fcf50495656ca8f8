//! The instruction sets that kernels may use on this machine: asked once, in one place.
//!
//! *Idea.* Each kernel has a portable version and some have versions for wider vectors. All of them choose here, so that one
//! environment variable, `TAUT_KERNELS`, puts an upper limit on all of them at once: tests run the portable kernels on a
//! processor that has better ones, and compare the answers.
//! *Trap.* Kernels that are compiled for an instruction set are called because of what [`instruction_set`] returns: it must
//! never name one that the processor lacks, whatever the variable says.

use std::sync::OnceLock;

use pulp::{Arch, WithSimd};

/// The environment variable that limits the instruction sets: `portable`, `neon`, `avx2` or `avx512`; any other text stands for
/// `portable`, an empty one and no variable for no limit.
pub const KERNELS_VARIABLE: &str = "TAUT_KERNELS";

/// Instruction sets for which there are kernels, each of those of one processor family included in the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What every processor of the target has: one number at a time, or what the compiler makes of it.
    Portable,
    /// Vectors of 16 bytes of 64-bit ARM, with fused multiply-add.
    Neon,
    /// Vectors of 32 bytes of x86-64: AVX2, FMA, POPCNT, BMI1 and BMI2.
    Avx2,
    /// Vectors of 64 bytes of x86-64: AVX-512 F, DQ and VL besides [`Avx2`](Self::Avx2).
    Avx512,
}

impl InstructionSet {
    const NAMES: [(InstructionSet, &str); 4] = [
        (InstructionSet::Portable, "portable"),
        (InstructionSet::Neon, "neon"),
        (InstructionSet::Avx2, "avx2"),
        (InstructionSet::Avx512, "avx512"),
    ];

    /// The name that the variable `TAUT_KERNELS` has for it.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }

    /// The number of this set in bytes.
    pub fn to_bits(self) -> u64 {
        self as u64
    }

    /// The set that [`to_bits`](Self::to_bits) gave.
    pub fn from_bits(bits: u64) -> Option<Self> {
        let at = usize::try_from(bits).ok()?;
        Self::NAMES.get(at).map(|(set, _)| *set)
    }
}

/// Returns the best instruction set that this processor has and `TAUT_KERNELS` allows.
///
/// The processor and the variable are asked once; after that a call costs one load.
///
/// ```
/// use taut_points::{InstructionSet, instruction_set};
///
/// assert!(instruction_set() >= InstructionSet::Portable);
/// ```
#[inline(always)]
pub fn instruction_set() -> InstructionSet {
    static FOUND: OnceLock<InstructionSet> = OnceLock::new();
    *FOUND.get_or_init(ask)
}

/// Returns the vectors that kernels written with `pulp` use: as wide as [`instruction_set`] allows.
///
/// A WebAssembly module has the vectors that it was compiled for, as it cannot ask.
#[inline]
pub fn vectors() -> Arch {
    match instruction_set() {
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => pulp::x86::V3::try_new().map_or(Arch::Scalar, Arch::V3),
        InstructionSet::Portable if !cfg!(target_family = "wasm") => Arch::Scalar,
        _ => Arch::new(),
    }
}

/// Runs a kernel with vectors of 32 bytes at most: for what gains nothing from wider ones, so that there is no copy of its code for them.
#[inline]
pub fn with_narrow_vectors<Kernel: WithSimd>(kernel: Kernel) -> Kernel::Output {
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::Simd;
        match pulp::x86::V3::try_new().filter(|_| instruction_set() >= InstructionSet::Avx2) {
            Some(avx2) => Simd::vectorize(avx2, kernel),
            None => Simd::vectorize(pulp::Scalar::new(), kernel),
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    vectors().dispatch(kernel)
}

#[cold]
fn ask() -> InstructionSet {
    let allowed = std::env::var_os(KERNELS_VARIABLE)
        .filter(|name| !name.is_empty())
        .map_or(InstructionSet::Avx512, |name| limit(&name.to_string_lossy()));
    let best = supported().iter().rev().find(|&&set| set <= allowed);
    best.copied().unwrap_or(InstructionSet::Portable)
}

/// Returns the largest set that the variable allows.
fn limit(name: &str) -> InstructionSet {
    match name {
        "avx512" => InstructionSet::Avx512,
        "avx2" => InstructionSet::Avx2,
        "neon" => InstructionSet::Neon,
        _ => InstructionSet::Portable,
    }
}

/// Returns the sets that the processor has, the best one last. An interpreter runs the portable one alone.
fn supported() -> &'static [InstructionSet] {
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    {
        use InstructionSet::{Avx2, Avx512, Portable};
        let has_avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("popcnt")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2");
        let has_avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl");
        match (has_avx2, has_avx512) {
            (true, true) => &[Portable, Avx2, Avx512],
            (true, false) => &[Portable, Avx2],
            (false, _) => &[Portable],
        }
    }
    // Part of every such target.
    #[cfg(all(target_arch = "aarch64", not(miri)))]
    return &[InstructionSet::Portable, InstructionSet::Neon];
    #[cfg(any(miri, not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
    &[InstructionSet::Portable]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_limit_is_the_portable_set() {
        assert_eq!(limit("avx512"), InstructionSet::Avx512);
        assert_eq!(limit("avx2"), InstructionSet::Avx2);
        for name in ["portable", "AVX2", "avx1024", " "] {
            assert_eq!(limit(name), InstructionSet::Portable, "{name:?}");
        }
    }

    #[test]
    fn only_sets_of_the_processor_are_named() {
        let set = instruction_set();
        assert!(supported().contains(&set));
        assert_eq!(set, ask());
    }
}
