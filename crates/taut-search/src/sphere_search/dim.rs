//! The dimension as a type where it is small, so that loops over axes are unrolled.

use pulp::Simd;

/// How many coordinates a point has.
pub(super) trait Dim: Copy + Send + Sync + 'static {
    fn get(self) -> usize;
}

/// A dimension that the compiler knows.
#[derive(Clone, Copy)]
pub(super) struct Fixed<const D: usize>;

impl<const D: usize> Dim for Fixed<D> {
    #[inline(always)]
    fn get(self) -> usize {
        D
    }
}

/// The dimension for which loops are compiled for itself. The copy of the code for processors of x86-64 without AVX2 has
/// one loop for all dimensions, which saves a hundred kilobytes.
#[inline(always)]
pub(super) fn unrolled<S: Simd>(dim: usize) -> Option<usize> {
    let is_old = cfg!(target_arch = "x86_64") && S::IS_SCALAR;
    (!is_old).then_some(dim)
}

/// Any other dimension.
#[derive(Clone, Copy)]
pub(super) struct AnyDim(pub(super) usize);

impl Dim for AnyDim {
    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }
}
