//! The lanes of the hash in vector registers.
//!
//! Integer arithmetic gives the same hash on every machine; wider registers only give it sooner: hashing rides on the
//! first pass of a solver and would otherwise cost as much as two. The vectors are written out, since a compiler that is
//! told to save space makes none of its own: the check of a ball took 2.7 times as long.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::{BlockHash, LANES, MULTIPLIER, put_together, start};
use crate::{InstructionSet, Scalar, ScalarKind, instruction_set};

/// The hash of `values`, or nothing when the processor has no vectors for it.
pub(super) fn hash<T: Scalar>(values: &[T]) -> Option<BlockHash> {
    match instruction_set() {
        // SAFETY: the processor has the features of the set.
        InstructionSet::Avx512 => Some(unsafe { avx512(values) }),
        // SAFETY: as above.
        InstructionSet::Avx2 => Some(unsafe { avx2(values) }),
        _ => None,
    }
}

#[target_feature(enable = "avx512f,avx512dq")]
fn avx512<T: Scalar>(values: &[T]) -> BlockHash {
    let mut lanes = start();
    let multiplier = _mm512_set1_epi64(MULTIPLIER.cast_signed());
    // SAFETY: `lanes` and each chunk hold 32 numbers, in groups of eight; `T` is f32 or f64 and nothing else (the trait is
    // sealed), so a cast guided by `KIND` keeps the type.
    unsafe {
        let mut hashes = [_mm512_setzero_si512(); LANES / 8];
        for (k, hash) in hashes.iter_mut().enumerate() {
            *hash = _mm512_loadu_epi64(lanes.as_ptr().add(8 * k).cast());
        }
        for chunk in values.as_chunks::<LANES>().0 {
            for (k, hash) in hashes.iter_mut().enumerate() {
                let from = chunk.as_ptr().add(8 * k);
                let value = match T::KIND {
                    ScalarKind::F32 => _mm512_cvtps_pd(_mm256_loadu_ps(from.cast())),
                    ScalarKind::F64 => _mm512_loadu_pd(from.cast()),
                };
                // Adding 0 turns −0 into 0.
                let bits = _mm512_castpd_si512(_mm512_add_pd(value, _mm512_setzero_pd()));
                let mixed = _mm512_xor_si512(bits, _mm512_srli_epi64::<32>(bits));
                *hash = _mm512_add_epi64(_mm512_mullo_epi64(*hash, multiplier), mixed);
            }
        }
        for (k, hash) in hashes.into_iter().enumerate() {
            _mm512_storeu_epi64(lanes.as_mut_ptr().add(8 * k).cast(), hash);
        }
    }
    put_together(lanes, values)
}

#[target_feature(enable = "avx2")]
fn avx2<T: Scalar>(values: &[T]) -> BlockHash {
    let mut lanes = start();
    let low = _mm256_set1_epi64x((MULTIPLIER & 0xFFFF_FFFF).cast_signed());
    let swapped = _mm256_set1_epi64x(MULTIPLIER.rotate_left(32).cast_signed());
    let zero = _mm256_setzero_si256();
    // SAFETY: as in `avx512`, in groups of four.
    unsafe {
        let mut hashes = [_mm256_setzero_si256(); LANES / 4];
        for (k, hash) in hashes.iter_mut().enumerate() {
            *hash = _mm256_loadu_si256(lanes.as_ptr().add(4 * k).cast());
        }
        for chunk in values.as_chunks::<LANES>().0 {
            for (k, hash) in hashes.iter_mut().enumerate() {
                let from = chunk.as_ptr().add(4 * k);
                let value = match T::KIND {
                    ScalarKind::F32 => _mm256_cvtps_pd(_mm_loadu_ps(from.cast())),
                    ScalarKind::F64 => _mm256_loadu_pd(from.cast()),
                };
                let bits = _mm256_castpd_si256(_mm256_add_pd(value, _mm256_setzero_pd()));
                let mixed = _mm256_xor_si256(bits, _mm256_srli_epi64::<32>(bits));
                // The product modulo 2⁶⁴ from products of halves, of which the registers have no other: that of the low
                // halves, and above it the low halves of the two others.
                let crossed = _mm256_mullo_epi32(*hash, swapped);
                let above = _mm256_add_epi32(
                    _mm256_slli_epi64::<32>(crossed),
                    _mm256_blend_epi32::<0b1010_1010>(zero, crossed),
                );
                let product = _mm256_add_epi64(_mm256_mul_epu32(*hash, low), above);
                *hash = _mm256_add_epi64(product, mixed);
            }
        }
        for (k, hash) in hashes.into_iter().enumerate() {
            _mm256_storeu_si256(lanes.as_mut_ptr().add(4 * k).cast(), hash);
        }
    }
    put_together(lanes, values)
}

/// The hash with each instruction set that the processor has.
#[cfg(test)]
pub(super) fn each_instruction_set<T: Scalar>(values: &[T]) -> Vec<BlockHash> {
    let mut hashes = Vec::new();
    if instruction_set() == InstructionSet::Avx512 {
        // SAFETY: the processor has the features of the set.
        hashes.push(unsafe { avx512(values) });
    }
    if instruction_set() >= InstructionSet::Avx2 {
        // SAFETY: as above.
        hashes.push(unsafe { avx2(values) });
    }
    hashes
}
