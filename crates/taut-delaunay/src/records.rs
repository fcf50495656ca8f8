//! The memory of the simplices of a mesh under construction.
#![allow(unsafe_code)]

use std::mem::ManuallyDrop;

use crate::simplex::Simplex;
use crate::threads::atomics::AtomicU8;
use crate::threads::{Plain, Record, Slot, plain_records};

/// Zeros, in pages that nobody has touched yet.
pub(crate) fn zeros(count: usize) -> Vec<AtomicU8> {
    // SAFETY: zeros are valid atomic numbers.
    unsafe { Box::<[AtomicU8]>::new_zeroed_slice(count).assume_init() }.into_vec()
}

/// Makes zeros `count` in all, at least as many as there are.
pub(crate) fn extend_zeros(zeros: &mut Vec<AtomicU8>, count: usize) {
    // SAFETY: zeros are valid atomic numbers.
    unsafe { fill_with_zeros(zeros, count) }
}

/// Makes an array longer, its new part zero. One write fills it: `resize_with` writes number by number, and of a mesh that grows again
/// and again, of points on two skew lines, that took 8 % of the build.
///
/// # Safety
/// Zero bytes are a valid `T`.
unsafe fn fill_with_zeros<T>(array: &mut Vec<T>, count: usize) {
    let len = array.len();
    let more = count.checked_sub(len).expect("arrays only grow");
    array.reserve_exact(more);
    // SAFETY: there is room for so many, and the caller says that zeros are valid.
    unsafe {
        array.as_mut_ptr().add(len).write_bytes(0, more);
        array.set_len(count);
    }
}

/// Arrays of so many bytes are fresh pages of the system, which are zeros without being written: the highest threshold of glibc's
/// `malloc` for that (`M_MMAP_THRESHOLD`). To write zeros there too took 2 % of a build of a million sites in the plane.
const FRESH_BYTES_MIN: usize = 1 << 25;

/// The slots of a mesh: those in use, zeros behind them, and room that nobody has written to.
pub(crate) struct Records<const V: usize> {
    all: Vec<Record<V>>,
    used: usize,
    room: usize,
}

impl<const V: usize> Records<V> {
    /// Slots that become zeros at once for one thread: 256 KiB, which its cache still has when it writes simplices there. To write
    /// all zeros of a small mesh at once took 3 % of a build of 100 000 sites in space.
    const PIECE: usize = (1 << if cfg!(miri) { 10 } else { 18 }) / size_of::<Record<V>>();

    /// Makes room for `room` slots, none of them in use. Pages that are never touched cost nothing.
    pub(crate) fn new(room: usize) -> Self {
        if room.saturating_mul(size_of::<Record<V>>()) >= FRESH_BYTES_MIN {
            return Self { all: Self::zeros(room), used: 0, room };
        }
        let mut records = Self { all: Vec::with_capacity(room), used: 0, room };
        records.extend();
        records
    }

    fn zeros(count: usize) -> Vec<Record<V>> {
        // SAFETY: zeros are valid atomic numbers.
        unsafe { Box::<[Record<V>]>::new_zeroed_slice(count).assume_init() }.into_vec()
    }

    /// Returns how many slots are in use, dead ones included.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.used
    }

    /// Returns for how many slots there is room.
    pub(crate) fn room(&self) -> usize {
        self.room
    }

    /// All slots that are in use, and the zeros behind them.
    #[inline(always)]
    pub(crate) fn all(&self) -> &[Record<V>] {
        &self.all
    }

    /// The same for a thread that is alone with them.
    #[inline(always)]
    pub(crate) fn alone(&mut self) -> &[Plain<V>] {
        plain_records(&mut self.all)
    }

    /// Takes the first `len` slots into use.
    pub(crate) fn set_len(&mut self, len: usize) {
        assert!(len <= self.all.len(), "there is room");
        self.used = len;
    }

    /// Makes room for `room` slots, if there is not as much already. The memory is taken when the room becomes zeros.
    pub(crate) fn reserve(&mut self, room: usize) {
        self.room = self.room.max(room);
    }

    /// Makes some of the room zeros, for one thread. Returns false if there is no more.
    pub(crate) fn extend(&mut self) -> bool {
        let len = self.all.len();
        // All of the room at once, or each piece would move the slots.
        self.all.reserve_exact(self.room - len);
        let longer = self.room.min(len + Self::PIECE);
        // SAFETY: zeros are valid atomic numbers.
        unsafe { fill_with_zeros(&mut self.all, longer) };
        longer > len
    }

    /// Makes all of the room zeros, for several threads. If more slots are to be zeroed than are in use, those in use move to
    /// pages that nobody has touched yet, so that each thread touches its own.
    pub(crate) fn extend_to_end(&mut self) {
        if self.room - self.all.len() <= self.used {
            // SAFETY: zeros are valid atomic numbers.
            unsafe { fill_with_zeros(&mut self.all, self.room) };
        } else {
            let all = Self::zeros(self.room);
            all.iter().zip(self.as_slice()).for_each(|(record, &simplex)| record.set(simplex));
            self.all = all;
        }
    }

    /// The slots in use.
    pub(crate) fn as_slice(&self) -> &[Simplex<V>] {
        const {
            assert!(size_of::<Record<V>>() == size_of::<Simplex<V>>());
            assert!(align_of::<Record<V>>() == align_of::<Simplex<V>>());
        };
        // SAFETY: the same numbers at the same places, and nobody writes while they are borrowed: this module's callers write
        // in methods of a mesh that borrow it for themselves.
        unsafe { std::slice::from_raw_parts(self.all.as_ptr().cast(), self.used) }
    }

    /// The slots in use, in the same memory.
    pub(crate) fn into_simplices(self) -> Vec<Simplex<V>> {
        const { assert!(align_of::<Record<V>>() == align_of::<Simplex<V>>()) };
        let mut all = ManuallyDrop::new(self.all);
        // SAFETY: `all` gives its memory away; size and alignment are the same, and any numbers are a simplex. To convert one
        // by one would read and write all of it once more, as the compiler does not see that nothing changes.
        unsafe { Vec::from_raw_parts(all.as_mut_ptr().cast(), self.used, all.capacity()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Miri (`scripts/miri`) checks that nothing is read which was not written.
    #[test]
    fn room_becomes_zeros_in_pieces_or_at_once() {
        let some = Simplex { vertices: [1, 2, 3, 4], neighbors: [5, 6, 7, 8] };
        let none = Simplex { vertices: [0; 4], neighbors: [0; 4] };
        let check = |records: &mut Records<4>, len: usize| {
            assert_eq!(records.all().len(), len);
            records.set_len(len);
            let mut slots = records.as_slice().iter();
            assert_eq!(slots.next(), Some(&some));
            assert!(slots.all(|slot| *slot == none));
            records.set_len(1);
        };
        let piece = Records::<4>::PIECE;
        for room in [10, piece, 3 * piece - 1] {
            let mut records = Records::<4>::new(room);
            records.all()[0].set(some);
            records.set_len(1);
            let mut len = piece.min(room);
            check(&mut records, len);
            while records.extend() {
                len = (len + piece).min(room);
                check(&mut records, len);
            }
            assert_eq!(len, room);
            records.reserve(room + 1);
            records.extend_to_end();
            check(&mut records, room + 1);
            records.reserve(room + 2 * piece);
            records.extend_to_end();
            check(&mut records, room + 2 * piece);
            assert!(!records.extend());
            assert_eq!(records.into_simplices(), [some]);
        }
    }
}
