//! What goals of Delaunay triangulations ask for.

use super::program::Program;
use super::rounds::Rounds;
use crate::prelude::*;

const OF_CGAL: &str = "processor time of one thread over CGAL's";
const OF_UNIFORM: &str = "processor time per point over that of a uniform set of this size";
const BYTES: &str = "bytes per point above the input";
const EXACT_RATE: &str = "share of predicates decided exactly";
const CHECK: &str = "processor time of the check over that of the build";
const SPEEDUP: &str = "time of one thread over that of two";

/// Processor time of one thread is at most this share of CGAL's.
pub(super) const fn of_cgal(bound: f64) -> Goal {
    Goal::at_most(OF_CGAL, bound, Unit::Times)
}

/// Processor time per point of one thread is at most so many times that for a uniform set of the same size.
pub(super) const fn of_uniform(bound: f64) -> Goal {
    Goal::at_most(OF_UNIFORM, bound, Unit::Times)
}

/// The peak above the input is at most so many bytes per point, with any number of threads.
pub(super) const fn bytes(bound: f64) -> Goal {
    Goal::at_most(BYTES, bound, Unit::Plain)
}

/// At most this share of predicates gets to an exact stage.
pub(super) const fn exact_rate(bound: f64) -> Goal {
    Goal::at_most(EXACT_RATE, bound, Unit::Power)
}

/// The check of the answer takes at most this share of the processor time of the build, with one thread.
pub(super) const fn check(bound: f64) -> Goal {
    Goal::at_most(CHECK, bound, Unit::Times)
}

/// Two threads are at least so many times faster than one, by the clock, in the median of all rounds.
pub(super) const fn speedup(bound: f64) -> Goal {
    Goal::at_least(SPEEDUP, bound, Unit::Times)
}

impl Rounds {
    /// What goals ask for. Builds that are not right are left out by the rounds themselves.
    pub(super) fn found(&self) -> Found {
        let one = Program::Taut(1);
        let mut found = Found::default();
        found.say(
            OF_CGAL,
            self.of_cgal(one).map(|(least, rounds)| {
                (least, format!("{}; by rounds {}", times(least), range(rounds, times)))
            }),
        );
        found.add(OF_UNIFORM, self.of_uniform(one));
        for threads in self.threads() {
            let bytes = self.bytes(Program::Taut(threads));
            found.say(BYTES, bytes.map(|bytes| (bytes, format!("{bytes:.1} B"))));
        }
        found.add(EXACT_RATE, self.exact(one));
        found.add(CHECK, self.check(one));
        found.median(SPEEDUP, self.speedup(), times);
        found
    }
}
