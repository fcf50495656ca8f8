//! What goals of Delaunay triangulations ask for.

use super::*;

pub(super) const OF_CGAL: Quantity =
    Quantity::new("processor time of one thread over CGAL's", Unit::Times);
pub(super) const OF_UNIFORM: Quantity =
    Quantity::new("processor time per point over that of a uniform set of this size", Unit::Times);
/// Of the peak, with any number of threads.
pub(super) const BYTES: Quantity = Quantity::new("bytes per point above the input", Unit::Fixed(1));
pub(super) const EXACT_RATE: Quantity =
    Quantity::new("share of predicates decided exactly", Unit::Power);
/// With one thread.
pub(super) const CHECK: Quantity =
    Quantity::new("processor time of the check over that of the build", Unit::Times);
/// By the clock, in the median of all rounds.
pub(super) const SPEEDUP: Quantity =
    Quantity::new("time of one thread over that of two", Unit::Times);

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
            found.add(BYTES, self.bytes(Program::Taut(threads)));
        }
        found.add(EXACT_RATE, self.exact(one));
        found.add(CHECK, self.check(one));
        found.median(SPEEDUP, self.speedup(), times);
        found
    }
}
