//! The dimension as a type where it is small, so that loops over axes are unrolled.

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

/// Any other dimension.
#[derive(Clone, Copy)]
pub(super) struct AnyDim(pub(super) usize);

impl Dim for AnyDim {
    #[inline(always)]
    fn get(self) -> usize {
        self.0
    }
}
