//! The kernel on x86-64: AVX-512 or AVX2 with FMA, as the processor has them.
#![allow(unsafe_code)]

mod avx2;
mod avx512;

use taut_points::{InstructionSet, Scalar, instruction_set};

use super::triangle::Work;
use super::{Center, all_rows, short_rows};
use avx2::Avx2;
use avx512::Avx512;

/// As [`super::squared_distances`], or false when the processor has none of the features.
pub(super) fn squared_distances<T: Scalar>(
    values: &[T],
    stride: usize,
    center: &Center,
    out: &mut [f64],
) -> bool {
    if instruction_set() == InstructionSet::Avx512 {
        // SAFETY: the processor has the features; the lengths were checked by the caller.
        unsafe { with_avx512(values, stride, center, out) };
        true
    } else if instruction_set() >= InstructionSet::Avx2 {
        // SAFETY: the processor has the features; the lengths were checked by the caller.
        unsafe { with_avx2(values, stride, center, out) };
        true
    } else {
        false
    }
}

/// Does the work with the best registers there are, or gives it back when the processor has none of the features.
pub(super) fn run<W: Work>(work: W) -> Option<W> {
    run_as(Set::Avx512, work).and_then(|work| run_as(Set::Avx2, work))
}

/// Instruction sets with a file of their own.
#[derive(Clone, Copy, Debug)]
pub(super) enum Set {
    Avx512,
    Avx2,
}

/// Does the work with the given instruction set, or gives it back when the processor does not have it.
pub(super) fn run_as<W: Work>(set: Set, work: W) -> Option<W> {
    #[target_feature(enable = "avx512f,fma")]
    fn with_avx512<W: Work>(work: W) {
        // SAFETY: this function is only called where the feature is.
        unsafe { work.run::<Avx512>() }
    }
    #[target_feature(enable = "avx2,fma")]
    fn with_avx2<W: Work>(work: W) {
        // SAFETY: this function is only called where the features are.
        unsafe { work.run::<Avx2>() }
    }
    match set {
        Set::Avx512 if instruction_set() == InstructionSet::Avx512 => {
            // SAFETY: the processor has the features.
            unsafe { with_avx512(work) };
            None
        }
        Set::Avx2 if instruction_set() >= InstructionSet::Avx2 => {
            // SAFETY: the processor has both features.
            unsafe { with_avx2(work) };
            None
        }
        _ => Some(work),
    }
}

/// # Safety
/// The processor has AVX-512F; lengths as [`super::squared_distances`] checks them.
#[target_feature(enable = "avx512f,fma")]
unsafe fn with_avx512<T: Scalar>(values: &[T], stride: usize, center: &Center, out: &mut [f64]) {
    if !short_rows(values, stride, center, out) {
        // SAFETY: the caller's promise.
        unsafe { all_rows::<Avx512, T>(values, stride, center, out) }
    }
}

/// # Safety
/// The processor has AVX2 and FMA; lengths as [`super::squared_distances`] checks them.
#[target_feature(enable = "avx2,fma")]
unsafe fn with_avx2<T: Scalar>(values: &[T], stride: usize, center: &Center, out: &mut [f64]) {
    if !short_rows(values, stride, center, out) {
        // SAFETY: the caller's promise.
        unsafe { all_rows::<Avx2, T>(values, stride, center, out) }
    }
}

/// Both instruction sets, for the tests to compare, each if the processor has it.
#[cfg(test)]
pub(super) fn each_instruction_set<T: Scalar>(
    values: &[T],
    stride: usize,
    center: &Center,
    rows: usize,
) -> Vec<Vec<f64>> {
    let mut results = Vec::new();
    if instruction_set() == InstructionSet::Avx512 {
        let mut out = vec![0.0; rows];
        // SAFETY: the processor has the features; the tests pass matching lengths.
        unsafe { with_avx512(values, stride, center, &mut out) };
        results.push(out);
    }
    if instruction_set() >= InstructionSet::Avx2 {
        let mut out = vec![0.0; rows];
        // SAFETY: the processor has the features; the tests pass matching lengths.
        unsafe { with_avx2(values, stride, center, &mut out) };
        results.push(out);
    }
    results
}
