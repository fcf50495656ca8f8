//! Catches a panic without the words that a panic prints.
//!
//! *Idea.* Printing is done by the hook of the process. Once, ours is put before the one that is there: it is silent
//! on a thread that is within [`catch`] and calls the other on all others. So nothing has to be put back, and no
//! other thread loses its words meanwhile.

use std::any::Any;
use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    static SILENT: Cell<bool> = const { Cell::new(false) };
}

/// Calls `work`; a panic in it, on this thread, is returned and not printed.
pub(crate) fn catch<R>(work: impl FnOnce() -> R) -> Result<R, Box<dyn Any + Send>> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !SILENT.get() {
                before(info);
            }
        }));
    });
    let outer = SILENT.replace(true);
    let done = panic::catch_unwind(AssertUnwindSafe(work));
    SILENT.set(outer);
    done
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    /// The only test of this binary that may touch the hook: there is one for the whole process.
    #[test]
    fn panics_are_caught_and_the_thread_speaks_again_afterwards() {
        static HEARD: AtomicU32 = AtomicU32::new(0);
        panic::set_hook(Box::new(|_| {
            HEARD.fetch_add(1, Ordering::Relaxed);
        }));
        assert_eq!(catch(|| 1).unwrap(), 1);
        let nested = catch(|| {
            assert!(catch(|| panic!("inner")).is_err());
            assert!(SILENT.get());
            panic!("outer")
        });
        assert!(nested.is_err() && !SILENT.get());
        assert_eq!(HEARD.load(Ordering::Relaxed), 0);
        assert!(panic::catch_unwind(|| panic!("aloud")).is_err());
        assert_eq!(HEARD.load(Ordering::Relaxed), 1);
    }
}
