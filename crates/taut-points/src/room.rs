//! Memory whose lack is an error that is told, not the end of the process.
//!
//! *Idea.* A program may install an allocator that ends it with a message when the system gives no memory, as the `taut`
//! command does. Here a failure is expected and handled, so the thread says so for the time of the call, and such an
//! allocator returns the failure.

use std::cell::Cell;
use std::collections::TryReserveError;

thread_local! {
    /// States whether this thread is within [`try_reserve_exact`].
    static HANDLED: Cell<bool> = const { Cell::new(false) };
}

/// Reserves room for exactly `more` further values, as [`Vec::try_reserve_exact`] does.
///
/// # Errors
/// [`TryReserveError`] where the system gives no such memory, or no system could.
pub fn try_reserve_exact<T>(values: &mut Vec<T>, more: usize) -> Result<(), TryReserveError> {
    HANDLED.set(true);
    let reserved = values.try_reserve_exact(more);
    HANDLED.set(false);
    reserved
}

/// Returns whether the caller of the allocator handles a failure, on this thread. Allocates nothing, so an allocator may
/// ask.
pub fn failure_is_handled() -> bool {
    HANDLED.try_with(Cell::get).unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_that_no_system_has_is_an_error_and_the_thread_says_so_only_meanwhile() {
        assert!(!failure_is_handled());
        let mut values = vec![1.0_f64];
        assert!(try_reserve_exact(&mut values, usize::MAX).is_err());
        assert!(try_reserve_exact(&mut values, isize::MAX as usize / 8).is_err());
        assert!(try_reserve_exact(&mut values, 5).is_ok());
        assert!(!failure_is_handled());
        assert!(values.capacity() >= 6);
    }
}
