//! Defines how a caller watches long work and stops it.

use std::fmt;
use std::ptr;
use std::sync::atomic::{AtomicBool, Ordering};

/// The caller asked long work to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped on request")]
pub struct Cancelled;

/// Watches long work: receives progress, and can stop it. [`Monitor::silent`] does neither.
///
/// Progress is told in blocks of the pass that is running; it never steers an algorithm.
#[derive(Clone, Copy, Default)]
pub struct Monitor<'a> {
    /// Called from any thread after each block with the number of points in it.
    pub on_points: Option<&'a (dyn Fn(u64) + Sync)>,
    /// Called at the start of each pass with its number (from 1) and the number of points it will read.
    pub on_pass: Option<&'a (dyn Fn(u64, u64) + Sync)>,
    /// Once true, work ends with [`Cancelled`] after the blocks that are under way.
    pub cancel: Option<&'a AtomicBool>,
}

impl fmt::Debug for Monitor<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Monitor")
            .field("on_points", &self.on_points.is_some())
            .field("on_pass", &self.on_pass.is_some())
            .field("cancel", &self.cancel)
            .finish()
    }
}

/// Two monitors are equal if the addresses of their functions and of their flag are equal. Different closures without
/// captured values can have one address, so that equal monitors may call different functions.
impl PartialEq for Monitor<'_> {
    fn eq(&self, other: &Self) -> bool {
        fn same<T: ?Sized, U: ?Sized>(a: Option<&T>, b: Option<&U>) -> bool {
            match (a, b) {
                (Some(a), Some(b)) => ptr::addr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }
        }
        same(self.on_points, other.on_points)
            && same(self.on_pass, other.on_pass)
            && same(self.cancel, other.cancel)
    }
}

impl Eq for Monitor<'_> {}

impl Monitor<'_> {
    /// A monitor that neither reports nor stops anything.
    pub const fn silent() -> Self {
        Monitor { on_points: None, on_pass: None, cancel: None }
    }

    /// Tells that pass number `pass` over `points` points begins.
    pub fn pass(&self, pass: u64, points: u64) {
        if let Some(hear) = self.on_pass {
            hear(pass, points);
        }
    }

    /// Tells that `points` more points of this pass are done.
    pub fn points(&self, points: u64) {
        if let Some(hear) = self.on_points {
            hear(points);
        }
    }

    /// Tests whether to go on.
    ///
    /// # Errors
    /// [`Cancelled`] once the caller asked to stop.
    pub fn check(&self) -> Result<(), Cancelled> {
        match self.cancel {
            Some(flag) if flag.load(Ordering::Relaxed) => Err(Cancelled),
            _ => Ok(()),
        }
    }
}
