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
/// `malloc` for that (`M_MMAP_THRESHOLD`). To write zeros into them too took 2 % of a build of a million sites in the plane.
const FRESH_MIN: usize = 1 << 25;

/// The slots of a mesh: those in use, zeros behind them, and memory behind these that nobody has written yet.
pub(crate) struct Records<const V: usize> {
    all: Vec<Record<V>>,
    used: usize,
}

impl<const V: usize> Records<V> {
    /// Slots that become zeros at once for one thread: so many that they are still in its cache when it writes simplices there.
    const PIECE: usize = (1 << 18) / size_of::<Record<V>>();

    /// Room for `capacity` slots, none of them in use. Pages that are never touched cost nothing.
    pub(crate) fn new(capacity: usize) -> Self {
        if capacity * size_of::<Record<V>>() >= FRESH_MIN {
            return Self { all: Self::zeros(capacity), used: 0 };
        }
        let mut records = Self { all: Vec::with_capacity(capacity), used: 0 };
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

    /// Returns how many slots there is room for.
    pub(crate) fn capacity(&self) -> usize {
        self.all.capacity()
    }

    /// All slots that are zeros or in use.
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
        debug_assert!(len <= self.all.len(), "there is room");
        self.used = len;
    }

    /// Makes room for `capacity` slots, at least as many as there are.
    pub(crate) fn reserve(&mut self, capacity: usize) {
        self.all.reserve_exact(capacity.saturating_sub(self.all.len()));
    }

    /// Makes some of the room zeros, for one thread. Returns false if there is none.
    pub(crate) fn extend(&mut self) -> bool {
        let len = self.all.len();
        let longer = self.all.capacity().min(len + Self::PIECE);
        // SAFETY: zeros are valid atomic numbers.
        unsafe { fill_with_zeros(&mut self.all, longer) };
        longer > len
    }

    /// Makes all of the room zeros, for several threads: in pages that nobody has touched yet, unless most of it is written.
    pub(crate) fn extend_to_end(&mut self) {
        let capacity = self.all.capacity();
        if self.used > capacity / 2 {
            // SAFETY: zeros are valid atomic numbers.
            unsafe { fill_with_zeros(&mut self.all, capacity) };
        } else if self.all.len() < capacity {
            let fresh = Self::zeros(capacity);
            for (to, from) in fresh.iter().zip(self.as_slice()) {
                to.set(*from);
            }
            self.all = fresh;
        }
    }

    /// The slots in use.
    pub(crate) fn as_slice(&self) -> &[Simplex<V>] {
        const { assert!(size_of::<Record<V>>() == size_of::<Simplex<V>>()) };
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
