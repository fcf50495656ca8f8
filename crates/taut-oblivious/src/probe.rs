//! What an algorithm tells of the memory it touches, at no cost when nobody listens.
//!
//! An algorithm that is generic over a [`Probe`] tells of its touches. [`NoProbe`] is a type without data whose calls compile
//! to nothing; the simulator is another one, and turns the touches into misses of a cache of any size.
//! Touches name places in memory by address and length, so a kernel that works on whole blocks tells of whole blocks.
//!
//! Heard are all of [`reference`](mod@crate::reference), whose bounds are tests; all searches of [`search`](crate::search) and
//! one by one of [`kdtree`](crate::kdtree); single and batched changes and ranges of [`PackedMap`](crate::packed::PackedMap);
//! and whatever has a twin named `…_probed`: transposition, multiplication, LU, Fourier transform, sorting in memory,
//! shuffling, lists, reversal. Not heard are the orders of points, samples, selection, the queues (whose rooms grow, so that
//! addresses move), `nearest_all`, `permute`, `lu_solve`, and what works on files.
//! That silence costs nothing is checked in the machine code of `reference` only: the test reads its assembly with and
//! without calls. The kernels of the other modules tell of whole blocks, outside of their inner loops.

/// Whether memory is read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Access {
    /// The content is used.
    Read,
    /// The content is replaced.
    Write,
}

/// Hears of every array an algorithm uses and of every touch of one.
///
/// An algorithm calls [`Probe::place`] for each array before its first touch (those it was given and those it
/// allocates), [`Probe::lift`] when it frees one, and [`Probe::read`] or [`Probe::write`] as it goes. Local variables
/// and loop counters live in registers and are not told.
pub trait Probe {
    /// Whether anybody listens; what only prepares a touch may be left out where this is false.
    const LISTENS: bool;

    /// An array of `bytes` bytes at `address` comes into use.
    fn place_at(&mut self, address: usize, bytes: usize);

    /// The array at `address` is used no more.
    fn lift_from(&mut self, address: usize);

    /// `bytes` bytes at `address` are read or written.
    fn touch(&mut self, address: usize, bytes: usize, access: Access);

    /// `array` comes into use.
    #[inline(always)]
    fn place<T>(&mut self, array: &[T]) {
        if Self::LISTENS {
            self.place_at(array.as_ptr() as usize, size_of_val(array));
        }
    }

    /// `array` is used no more.
    #[inline(always)]
    fn lift<T>(&mut self, array: &[T]) {
        if Self::LISTENS {
            self.lift_from(array.as_ptr() as usize);
        }
    }

    /// All of `part`, an array or some of its elements, is read.
    #[inline(always)]
    fn read<T>(&mut self, part: &[T]) {
        if Self::LISTENS {
            self.touch(part.as_ptr() as usize, size_of_val(part), Access::Read);
        }
    }

    /// All of `part`, an array or some of its elements, is written.
    #[inline(always)]
    fn write<T>(&mut self, part: &[T]) {
        if Self::LISTENS {
            self.touch(part.as_ptr() as usize, size_of_val(part), Access::Write);
        }
    }
}

/// Nobody listens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoProbe;

impl Probe for NoProbe {
    const LISTENS: bool = false;

    #[inline(always)]
    fn place_at(&mut self, _: usize, _: usize) {}

    #[inline(always)]
    fn lift_from(&mut self, _: usize) {}

    #[inline(always)]
    fn touch(&mut self, _: usize, _: usize, _: Access) {}
}
