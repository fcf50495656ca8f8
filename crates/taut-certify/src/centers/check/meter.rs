//! How much of a search there may be, and who may end any work.
//!
//! *Idea.* Steps are counted where they are taken, each about a coordinate of an item, or a word of a set of items, that is
//! looked at: a nanosecond or so. So a limit of work holds for few large nodes as for many small ones, and is the same on
//! every machine.

use taut_points::{Cancelled, Monitor, ReadError};

use super::super::CentersViolation;
use crate::CheckError;

/// The monitor is asked again after this many steps: some milliseconds.
const STEPS_BETWEEN_ASKS: u64 = 1 << 21;

/// Counts steps.
pub(super) struct Meter<'a> {
    monitor: Monitor<'a>,
    most: u64,
    spent: u64,
    /// When the monitor is asked next.
    ask: u64,
}

/// Why work ends before it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    Cancelled(Cancelled),
    /// So many steps are spent, which is the most there may be.
    Spent(u64),
}

impl<'a> Meter<'a> {
    /// At most so many steps.
    pub(super) fn of(monitor: &Monitor<'a>, most: u64) -> Self {
        Meter { monitor: *monitor, most, spent: 0, ask: 0 }
    }

    /// As many steps as it takes; only the monitor ends it.
    pub(super) fn endless(monitor: &Monitor<'a>) -> Self {
        Self::of(monitor, u64::MAX)
    }

    /// Counts steps that are about to be taken.
    #[inline]
    pub(super) fn spend(&mut self, steps: usize) -> Result<(), Stop> {
        self.spent = self.spent.saturating_add(steps as u64);
        if self.spent < self.ask { Ok(()) } else { self.look_up() }
    }

    /// Whether to go on.
    #[cold]
    fn look_up(&mut self) -> Result<(), Stop> {
        self.monitor.check().map_err(Stop::Cancelled)?;
        if self.spent > self.most {
            return Err(Stop::Spent(self.most));
        }
        self.ask = self.spent.saturating_add(STEPS_BETWEEN_ASKS).min(self.most.saturating_add(1));
        Ok(())
    }
}

impl From<Stop> for CheckError {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::Cancelled(cancelled) => CheckError::Read(ReadError::from(cancelled)),
            Stop::Spent(most) => CentersViolation::Work { most }.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;

    #[test]
    fn the_last_step_that_may_be_is_taken_and_no_other() {
        let mut meter = Meter::of(&Monitor::silent(), 10_000_000);
        for _ in 0..10 {
            assert_eq!(meter.spend(1_000_000), Ok(()));
        }
        assert_eq!(meter.spend(1), Err(Stop::Spent(10_000_000)));
        assert_eq!(meter.spend(0), Err(Stop::Spent(10_000_000)));
        assert_eq!(Meter::endless(&Monitor::silent()).spend(usize::MAX), Ok(()));
    }

    #[test]
    fn work_that_is_spent_is_a_refusal() {
        match CheckError::from(Stop::Spent(7)) {
            CheckError::Rejected(violation) => {
                assert_eq!(violation, CentersViolation::Work { most: 7 }.into());
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_monitor_is_heard_within_few_steps() {
        let cancel = AtomicBool::new(false);
        let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
        let mut meter = Meter::endless(&monitor);
        meter.spend(1).unwrap();
        cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        let mut steps = 0;
        while meter.spend(1000).is_ok() {
            steps += 1000;
        }
        assert!(steps <= STEPS_BETWEEN_ASKS, "{steps}");
        assert_eq!(meter.spend(1), Err(Stop::Cancelled(Cancelled)));
    }
}
