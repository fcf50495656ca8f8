//! How a caller watches long work and stops it.

use std::sync::atomic::{AtomicBool, Ordering};

/// The caller asked long work to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped on request")]
pub struct Cancelled;

/// Watches long work: hears of progress, and can stop it. [`Monitor::silent`] does neither.
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

impl Monitor<'_> {
    /// A monitor that neither hears nor stops anything.
    pub fn silent() -> Self {
        Self::default()
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

    /// Whether to go on.
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
