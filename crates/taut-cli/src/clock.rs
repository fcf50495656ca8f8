//! Seconds by step, for people; no result depends on it and no file holds it.

use std::time::{Duration, Instant};

use crate::output::numbers::seconds;
use crate::reports::Field;

pub(crate) struct Clock {
    start: Instant,
    laps: Vec<(&'static str, Duration)>,
}

impl Clock {
    pub(crate) fn start() -> Self {
        Clock { start: Instant::now(), laps: Vec::new() }
    }

    /// Ends a step.
    pub(crate) fn lap(&mut self, what: &'static str) {
        let before: Duration = self.laps.iter().map(|(_, time)| time).sum();
        self.laps.push((what, self.start.elapsed() - before));
    }

    pub(crate) fn field(&self) -> Field {
        let all: Duration = self.laps.iter().map(|(_, time)| time).sum();
        let laps: Vec<String> =
            self.laps.iter().map(|(what, time)| format!("{what} {}", seconds(*time))).collect();
        Field::new("time", seconds(all)).remark(laps.join(", "))
    }
}
