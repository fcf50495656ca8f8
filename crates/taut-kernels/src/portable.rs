//! Lanes for any processor: plain arrays, which the compiler turns into what registers there are.
//!
//! No fused multiply-add: where the processor has none, it would be a function call. On x86-64, where other files serve nearly all
//! processors, nothing need be inlined either, which halves the code and slows down the others.
#![allow(unsafe_code)]

use taut_points::Scalar;

use super::lanes::Lanes;

#[derive(Clone, Copy)]
pub(super) struct Portable([f64; 8]);

impl Lanes for Portable {
    // Of AArch64; it only chooses how much is worked on together.
    const IN_REGISTERS: usize = 8;

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn zero() -> Self {
        Portable([0.0; 8])
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn load<T: Scalar>(from: *const T) -> Self {
        // SAFETY: eight values are readable at `from`, by the caller's promise.
        Portable(std::array::from_fn(|i| unsafe { from.add(i).read_unaligned() }.into()))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn load_first<T: Scalar>(from: *const T, count: usize) -> Self {
        let mut lanes = [0.0; 8];
        for (i, lane) in lanes.iter_mut().enumerate().take(count) {
            // SAFETY: `count` values are readable at `from`, by the caller's promise.
            *lane = unsafe { from.add(i).read_unaligned() }.into();
        }
        Portable(lanes)
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn sub(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn add(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn square_add(self, sum: Self) -> Self {
        Portable(std::array::from_fn(|i| sum.0[i] + self.0[i] * self.0[i]))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn sum_each(rows: [Self; 8]) -> [f64; 8] {
        rows.map(|Portable([a, b, c, d, e, f, g, h])| ((a + b) + (c + d)) + ((e + f) + (g + h)))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn broadcast(value: f64) -> Self {
        Portable([value; 8])
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn multiply_add(self, factor: Self, sum: Self) -> Self {
        Portable(std::array::from_fn(|i| sum.0[i] + self.0[i] * factor.0[i]))
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn multiply_add_one(a: f64, b: f64, sum: f64) -> f64 {
        sum + a * b
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn store(self, to: *mut f64) {
        for (i, value) in self.0.into_iter().enumerate() {
            // SAFETY: eight values are writable at `to`, by the caller's promise.
            unsafe { to.add(i).write_unaligned(value) };
        }
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn prefetch(_: *const u8) {}

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn bits_above(self, bound: Self) -> u32 {
        let lanes = self.0.into_iter().zip(bound.0).enumerate();
        lanes.fold(0, |bits, (i, (value, bound))| bits | u32::from(value > bound) << i)
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn split(first: Self, second: Self) -> (Self, Self) {
        let all = [first.0, second.0];
        let lane = |i: usize| all[i / 8][i % 8];
        (
            Portable(std::array::from_fn(|i| lane(2 * i))),
            Portable(std::array::from_fn(|i| lane(2 * i + 1))),
        )
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn pairs(starts: [*const f64; 8]) -> (Self, Self) {
        // SAFETY: the caller's promise.
        unsafe {
            (Portable(starts.map(|start| *start)), Portable(starts.map(|start| *start.add(1))))
        }
    }

    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    unsafe fn transpose(rows: [Self; 8]) -> [Self; 8] {
        std::array::from_fn(|j| Portable(std::array::from_fn(|i| rows[i].0[j])))
    }
}
