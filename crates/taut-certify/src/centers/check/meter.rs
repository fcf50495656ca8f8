//! Polls the monitor for cancellation about every 2^21 steps.
//!
//! *Idea.* Steps are counted where they are taken, each about a coordinate of an item, or a word of a set of items: a
//! nanosecond or so.

use taut_points::{Cancelled, Monitor, ReadError};

use crate::CheckError;

/// The monitor is asked again after this many steps: some milliseconds.
const STEPS_BETWEEN_ASKS: u64 = 1 << 21;

/// Counts steps.
pub(super) struct Meter<'a> {
    monitor: Monitor<'a>,
    /// Steps until the monitor is asked next.
    left: u64,
}

impl<'a> Meter<'a> {
    /// A meter that asks at the first step.
    pub(super) fn of(monitor: &Monitor<'a>) -> Self {
        Meter { monitor: *monitor, left: 0 }
    }

    /// Counts steps that are about to be taken.
    #[inline]
    pub(super) fn spend(&mut self, steps: usize) -> Result<(), Cancelled> {
        match self.left.checked_sub(steps as u64) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => self.ask(),
        }
    }

    #[cold]
    fn ask(&mut self) -> Result<(), Cancelled> {
        self.left = STEPS_BETWEEN_ASKS;
        self.monitor.check()
    }
}

impl From<Cancelled> for CheckError {
    fn from(cancelled: Cancelled) -> Self {
        CheckError::Read(ReadError::from(cancelled))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;

    #[test]
    fn the_monitor_is_heard_within_few_steps() {
        let cancel = AtomicBool::new(false);
        let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
        let mut meter = Meter::of(&monitor);
        meter.spend(1).unwrap();
        cancel.store(true, Ordering::Relaxed);
        let mut steps = 0;
        while meter.spend(1000).is_ok() {
            steps += 1000;
        }
        assert!(steps <= STEPS_BETWEEN_ASKS, "{steps}");
        assert_eq!(Meter::of(&monitor).spend(1), Err(Cancelled));
    }
}
