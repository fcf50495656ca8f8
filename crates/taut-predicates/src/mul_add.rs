//! a·b + c with one rounding or with two: the filters are written once over this choice.
//!
//! Where the processor has the fused instruction a filter with it is shorter and a little sharper; where it has
//! not, `f64::mul_add` is a library call and some fifty times slower. So a kernel is generic over [`MulAdd`] and
//! chooses once per batch, inside a function compiled for that processor. Both give certain signs only, hence
//! the same meshes.

/// The way to compute a·b + c.
pub trait MulAdd: Copy {
    /// a·b + c, rounded once or twice.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;
}

/// One rounding. Only for code compiled with the `fma` target feature.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fused;

/// Two roundings, on any processor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Separate;

impl MulAdd for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl MulAdd for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}
