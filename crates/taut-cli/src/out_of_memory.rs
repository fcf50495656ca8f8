//! Handles the case that the system gives no more memory: one line on standard error and exit code 2, not an abort.
//!
//! *Idea.* The allocator of the command is that of the system, except that it ends the process where that returns nothing.
//! Callers that handle a failure say so ([`failure_is_handled`]) and get it returned.
//! *Trap.* Nothing on the way out may allocate or wait for a lock: the message is made in an array and written by a call of
//! the system, and the process ends without running what was registered for its end.

// The only unsafe code of the command: no safe code can be an allocator.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use taut::points::failure_is_handled;

#[global_allocator]
static ALLOCATOR: EndingAllocator = EndingAllocator;

/// The allocator of the system, except that the process ends where it fails and nobody handles that.
struct EndingAllocator;

// SAFETY: each call is handed to `System` with the same arguments, under the contract that the caller keeps, and what `System`
// returns is returned. No method unwinds: `checked` returns its argument or ends the process.
unsafe impl GlobalAlloc for EndingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the contract of this method is that of the method called.
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the contract of this method is that of the method called.
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the contract of this method is that of the method called.
        checked(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the contract of this method is that of the method called.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Returns the memory; ends the process where there is none and the caller cannot do without.
#[inline]
fn checked(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() && !failure_is_handled() {
        end(size);
    }
    memory
}

/// Says that `size` bytes are not to be had, removes temporary files, and ends the process with exit code 2.
#[cold]
fn end(size: usize) -> ! {
    /// States whether a thread is on this way already: one message is enough.
    static ENDING: AtomicBool = AtomicBool::new(false);
    while ENDING.swap(true, Ordering::SeqCst) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut message = [0; 256];
    let mut rest = &mut message[..];
    let written = writeln!(
        rest,
        "taut: out of memory: the system refused {size} more bytes; read points from disk with --memory SIZE \
         where the command has it, or allow the process more memory"
    );
    let left = rest.len();
    let used = if written.is_ok() { message.len() - left } else { 0 };
    leave(&message[..used])
}

/// Writes the message and ends the process, with no lock and no memory.
#[cfg(unix)]
fn leave(message: &[u8]) -> ! {
    use std::os::fd::AsFd;

    rustix::io::write(std::io::stderr().as_fd(), message).ok();
    taut_io::remove_unfinished();
    signal_hook::low_level::exit(i32::from(crate::exit::FAILURE_CODE))
}

/// Writes the message and ends the process as well as the standard library can.
#[cfg(not(unix))]
fn leave(message: &[u8]) -> ! {
    std::io::stderr().write_all(message).ok();
    taut_io::remove_unfinished();
    std::process::exit(i32::from(crate::exit::FAILURE_CODE))
}
