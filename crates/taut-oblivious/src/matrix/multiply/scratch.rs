//! Memory for packed operands.
//!
//! *Problem.* A product of 256 rows takes half a millisecond, and as much again if the system has to give it a megabyte of
//! fresh pages.
//! *Idea.* Each thread keeps the room of its last small product for its next one; large ones ask for large pages.

use std::cell::Cell;

use crate::pages::Pages;

/// A thread keeps at most this many numbers: 2 MiB.
const KEPT_NUMBERS_MAX: usize = 1 << 18;

thread_local! {
    static LAST_PAGES: Cell<Option<Pages<f64>>> = const { Cell::new(None) };
}

/// Room for numbers, of any content; it begins at a line of the cache.
pub(super) struct Scratch {
    /// None only while it is dropped.
    pages: Option<Pages<f64>>,
    len: usize,
}

impl Scratch {
    /// Room for `len` numbers.
    pub(super) fn of(len: usize) -> Self {
        // A thread that ends has nothing left.
        let last = if len <= KEPT_NUMBERS_MAX {
            LAST_PAGES.try_with(Cell::take).ok().flatten()
        } else {
            None
        };
        let large_enough = last.filter(|pages| pages.words().len() >= len);
        Self { pages: Some(large_enough.unwrap_or_else(|| Pages::zeroed(len))), len }
    }

    /// The numbers.
    pub(super) fn numbers(&mut self) -> &mut [f64] {
        self.pages.as_mut().map_or(&mut [], |pages| &mut pages.words_mut()[..self.len])
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if let Some(pages) =
            self.pages.take().filter(|pages| pages.words().len() <= KEPT_NUMBERS_MAX)
        {
            let _ = LAST_PAGES.try_with(|last| last.set(Some(pages)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_room_is_kept_for_the_same_thread_and_no_other() {
        let address = |scratch: &mut Scratch| scratch.numbers().as_ptr() as usize;
        let first = address(&mut Scratch::of(1000));
        let mut again = Scratch::of(700);
        assert_eq!((address(&mut again), again.numbers().len()), (first, 700));
        let mut beside = Scratch::of(700);
        assert_ne!(address(&mut beside), first);
        let elsewhere = std::thread::spawn(move || address(&mut Scratch::of(700)));
        assert_ne!(elsewhere.join().expect("an address"), first);
        assert_eq!(Scratch::of(KEPT_NUMBERS_MAX + 1).numbers().len(), KEPT_NUMBERS_MAX + 1);
        assert_eq!(Scratch::of(0).numbers().len(), 0);
    }
}
