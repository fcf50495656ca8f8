//! Records which memory an algorithm accesses, at no cost where nothing is recorded.
//!
//! An algorithm that is generic over a [`Probe`] reports each access. [`NoProbe`] is a type without data whose calls compile
//! to nothing; the simulator of `taut-reference` is another probe, and turns accesses into misses of a cache of any size.
//! An access names a place in memory by address and length, so a kernel that works on whole blocks reports whole blocks.
//!
//! Instrumented are sorting in memory, shuffling and transposition in memory, each by a twin named `…_instrumented`, and single
//! searches of [`kdtree`](crate::kdtree). Not instrumented are the orders of points, samples, `nearest_all`, `permute`, and what
//! works on files. A test of `taut-reference` compares the machine code of its algorithms with and without these calls.

/// States whether memory is read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Access {
    /// The content is used.
    Read,
    /// The content is replaced.
    Write,
}

/// Records every array that an algorithm uses and every access to one.
///
/// An algorithm calls [`Probe::place`] for each array before its first access (those it was given and those it
/// allocates), [`Probe::lift`] when it frees one, and [`Probe::read`] or [`Probe::write`] as it goes. Local variables
/// and loop counters live in registers and are not recorded.
pub trait Probe {
    /// States whether accesses are recorded; what only prepares an access may be left out where this is false.
    const IS_RECORDING: bool;

    /// An array of `bytes` bytes at `address` comes into use.
    fn place_at(&mut self, address: usize, bytes: usize);

    /// The array at `address` is used no more.
    fn lift_from(&mut self, address: usize);

    /// `bytes` bytes at `address` are read or written.
    fn record(&mut self, address: usize, bytes: usize, access: Access);

    /// `array` comes into use.
    #[inline(always)]
    fn place<T>(&mut self, array: &[T]) {
        if Self::IS_RECORDING {
            self.place_at(array.as_ptr() as usize, size_of_val(array));
        }
    }

    /// `array` is used no more.
    #[inline(always)]
    fn lift<T>(&mut self, array: &[T]) {
        if Self::IS_RECORDING {
            self.lift_from(array.as_ptr() as usize);
        }
    }

    /// All of `part`, an array or some of its elements, is read.
    #[inline(always)]
    fn read<T>(&mut self, part: &[T]) {
        if Self::IS_RECORDING {
            self.record(part.as_ptr() as usize, size_of_val(part), Access::Read);
        }
    }

    /// All of `part`, an array or some of its elements, is written.
    #[inline(always)]
    fn write<T>(&mut self, part: &[T]) {
        if Self::IS_RECORDING {
            self.record(part.as_ptr() as usize, size_of_val(part), Access::Write);
        }
    }
}

/// Records nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoProbe;

impl Probe for NoProbe {
    const IS_RECORDING: bool = false;

    #[inline(always)]
    fn place_at(&mut self, _: usize, _: usize) {}

    #[inline(always)]
    fn lift_from(&mut self, _: usize) {}

    #[inline(always)]
    fn record(&mut self, _: usize, _: usize, _: Access) {}
}
