//! A thread that is alone with a mesh, and its plain records.
//!
//! *Idea.* Who borrows all records for itself may look at them as cells of plain numbers, which the compiler keeps in registers and
//! writes at once. With atomic numbers a build on one thread took up to 1 % longer, and that of points on two skew lines 7 %.
//! *Guarantee.* The cells live as long as the borrow of the atomic numbers under them, and cannot be sent to another thread.
#![allow(unsafe_code)]

use std::cell::Cell;
use std::sync::atomic::AtomicU8;

use crate::simplex::{DEAD_MARK, Simplex};
use crate::threads::{Hold, Mark, Record, Slot};

/// The only thread holds everything.
pub(crate) struct Alone;

impl Hold for Alone {
    const SHARED: bool = false;

    type Slot<const V: usize> = Plain<V>;
    type Mark = Cell<u8>;

    #[inline(always)]
    fn hold<const V: usize>(&mut self, _: [u32; V]) -> bool {
        true
    }

    #[inline(always)]
    fn hold_new(&mut self, _: u32) {}

    #[inline(always)]
    fn done(&mut self) {}

    #[inline(always)]
    fn back_off(&mut self) {}
}

/// A [`Simplex`] in cells.
#[repr(C)]
pub(crate) struct Plain<const V: usize> {
    vertices: Cell<[u32; V]>,
    neighbors: Cell<[u32; V]>,
}

impl<const V: usize> Slot<V> for Plain<V> {
    #[inline(always)]
    fn vertex(&self, i: usize) -> u32 {
        self.vertices.as_array_of_cells()[i].get()
    }

    #[inline(always)]
    fn neighbor(&self, i: usize) -> u32 {
        self.neighbors.as_array_of_cells()[i].get()
    }

    #[inline(always)]
    fn vertices(&self) -> [u32; V] {
        self.vertices.get()
    }

    #[inline(always)]
    fn neighbors(&self) -> [u32; V] {
        self.neighbors.get()
    }

    /// Wide stores: after eight narrow ones a vector load that follows soon has to wait for them, which took 4 % of the time of a torus
    /// with noise.
    #[inline(always)]
    fn set(&self, simplex: Simplex<V>) {
        self.vertices.set(simplex.vertices);
        self.neighbors.set(simplex.neighbors);
    }

    #[inline(always)]
    fn set_neighbor(&self, i: usize, code: u32) {
        self.neighbors.as_array_of_cells()[i].set(code);
    }

    #[inline(always)]
    fn kill(&self) {
        self.vertices.as_array_of_cells()[0].set(DEAD_MARK);
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn addresses(&self) -> [*const u32; 2] {
        [self.vertices.as_ptr().cast(), self.neighbors.as_ptr().cast()]
    }
}

impl Mark for Cell<u8> {
    #[inline(always)]
    fn get(&self) -> u8 {
        Cell::get(self)
    }

    #[inline(always)]
    fn set(&self, value: u8) {
        Cell::set(self, value);
    }
}

/// The records of a thread that is alone with them.
pub(crate) fn plain_records<const V: usize>(records: &mut [Record<V>]) -> &[Plain<V>] {
    const {
        assert!(size_of::<Record<V>>() == size_of::<Plain<V>>());
        assert!(align_of::<Record<V>>() == align_of::<Plain<V>>());
    };
    // SAFETY: the same numbers at the same places, where every number is valid; they are borrowed as long as the cells live, so
    // nobody else reads or writes them.
    unsafe { std::slice::from_raw_parts(records.as_mut_ptr().cast(), records.len()) }
}

/// The marks of a thread that is alone with them.
pub(crate) fn plain_marks(marks: &mut [AtomicU8]) -> &[Cell<u8>] {
    // SAFETY: as above.
    unsafe { std::slice::from_raw_parts(marks.as_mut_ptr().cast(), marks.len()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<const V: usize>(record: &impl Slot<V>) -> Simplex<V> {
        let simplex = Simplex { vertices: record.vertices(), neighbors: record.neighbors() };
        for i in 0..V {
            assert_eq!(record.vertex(i), simplex.vertices[i]);
            assert_eq!(record.neighbor(i), simplex.neighbors[i]);
        }
        simplex
    }

    /// Miri (`scripts/miri`) checks that the borrow allows it.
    #[test]
    fn what_one_thread_writes_others_read_and_it_reads_what_they_wrote() {
        let none = Simplex { vertices: [0; 4], neighbors: [0; 4] };
        let simplex = Simplex { vertices: [1, 2, 3, 4], neighbors: [50, 60, 70, 80] };
        let changed = Simplex { vertices: [DEAD_MARK, 2, 3, 4], neighbors: [50, 60, 70, 81] };
        let mut records: [Record<4>; 4] = std::array::from_fn(|_| Record::default());
        records[1].set(simplex);
        let cells = plain_records(&mut records);
        let (first, second) = (&cells[1], &cells[2]);
        second.set(read(first));
        first.set_neighbor(3, 81);
        first.kill();
        assert_eq!([0, 1, 2, 3].map(|i| read(&cells[i])), [none, changed, simplex, none]);
        assert_eq!([0, 1, 2, 3].map(|i| read(&records[i])), [none, changed, simplex, none]);
        records[2].set_neighbor(3, 81);
        records[2].kill();
        assert_eq!(read(&plain_records(&mut records)[2]), changed);
    }

    #[test]
    fn marks_of_one_thread_are_those_of_many() {
        let mut marks = [0, 1, 2].map(AtomicU8::new);
        let cells = plain_marks(&mut marks);
        Mark::set(&cells[0], Mark::get(&cells[2]));
        assert_eq!(marks.map(AtomicU8::into_inner), [2, 1, 2]);
    }
}
