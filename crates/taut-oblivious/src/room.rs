//! Memory for a moment, on huge pages where the system has them.
//!
//! *Trap.* Fresh memory is mapped page by page as it is first written; in pages of 4 KiB this costs as much as a pass or
//! two of the sort that needs the memory.
#![allow(unsafe_code)]

/// From this many bytes on, pages are asked for; a huge page has 2 MiB.
const HUGE: usize = 1 << 21;

/// The items in a row, on huge pages if they are many and the system has them.
pub(crate) fn filled<T>(items: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut room = Vec::with_capacity(items.len());
    advise(&room);
    room.extend(items);
    room
}

/// Asks for huge pages under all that `room` has capacity for.
fn advise<T>(room: &Vec<T>) {
    let start = (room.as_ptr() as usize).next_multiple_of(HUGE);
    let end = room.as_ptr() as usize + room.capacity() * size_of::<T>();
    #[cfg(all(target_os = "linux", not(miri)))]
    if start + HUGE <= end {
        let from = room.as_ptr().cast::<u8>().wrapping_add(start - room.as_ptr() as usize);
        // SAFETY: the range belongs to the vector, and this advice changes no content. That it is refused, or unknown to
        // the system, only costs time.
        let _ = unsafe {
            rustix::mm::madvise(
                from.cast_mut().cast(),
                end - start,
                rustix::mm::Advice::LinuxHugepage,
            )
        };
    }
    #[cfg(not(all(target_os = "linux", not(miri))))]
    let _ = (start, end);
}
