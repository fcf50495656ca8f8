//! The claims of one verdict, and what is found of them.

use super::Truth;
use super::interval::Interval;
use super::mvee::Bracket;

/// Numbers that differ by less than 2⁻¹⁰⁰ are not told apart from an optimum: a gap of 0 may be exact.
const GRAIN_EXPONENT: i64 = -100;

/// The first claim found false, and the first one left open.
#[derive(Default)]
pub(super) struct Claims {
    wrong: Option<String>,
    open: Option<String>,
}

impl Claims {
    /// Takes in whether a claim holds; `None` for a claim that is not decided.
    pub(super) fn holds(&mut self, holds: Option<bool>, words: impl FnOnce() -> String) {
        match holds {
            Some(true) => {}
            Some(false) => self.wrong = self.wrong.take().or_else(|| Some(words())),
            None => self.open = self.open.take().or_else(|| Some(words())),
        }
    }

    /// Claims that a ≤ b.
    pub(super) fn at_most(&mut self, what: &str, a: &Interval, b: &Interval) {
        self.holds(a.at_most(b), || {
            let (x, y, off) = (a.rounded(), b.rounded(), a.minus(b).rounded());
            format!("{what}: {x:?} is to be at most {y:?}, and exceeds it by {off:e}")
        });
    }

    /// Claims that a is within `tolerance` of b.
    pub(super) fn near(&mut self, what: &str, a: &Interval, b: &Interval, tolerance: f64) {
        let off = a.minus(b);
        let holds = Interval::exact(tolerance).and_then(|t| off.absolute().at_most(&t));
        self.holds(holds, || {
            let (x, y, off) = (a.rounded(), b.rounded(), off.rounded());
            format!("{what}: {x:?} in place of {y:?}, off by {off:e} with {tolerance:e} granted")
        });
    }

    /// Claims that a number is at most the optimum: it is at the near end of the bracket, and is not beyond the far one.
    pub(super) fn below(&mut self, what: &str, value: &Interval, optimum: &Bracket) {
        let least = value.minus(&Interval::integer(1).scaled(GRAIN_EXPONENT));
        let holds = decided(least.at_most(&optimum.lower), least.at_most(&optimum.upper));
        self.holds(holds, || beside(what, value, optimum));
    }

    /// Claims that a number is at least the optimum.
    pub(super) fn above(&mut self, what: &str, value: &Interval, optimum: &Bracket) {
        let most = value.plus(&Interval::integer(1).scaled(GRAIN_EXPONENT));
        let holds = decided(optimum.upper.at_most(&most), optimum.lower.at_most(&most));
        self.holds(holds, || beside(what, value, optimum));
    }

    pub(super) fn is_settled_false(&self) -> bool {
        self.wrong.is_some()
    }

    pub(super) fn undecided(&mut self, words: impl Into<String>) {
        self.holds(None, || words.into());
    }

    pub(super) fn truth(self) -> Truth {
        match (self.wrong, self.open) {
            (Some(words), _) => Truth::False(words),
            (None, Some(words)) => Truth::Undecided(words),
            (None, None) => Truth::True,
        }
    }
}

/// Tests whether a claim holds that is sure at one end of a bracket, and refuted at the other.
fn decided(near: Option<bool>, far: Option<bool>) -> Option<bool> {
    match (near, far) {
        (Some(true), _) => Some(true),
        (_, Some(false)) => Some(false),
        _ => None,
    }
}

fn beside(what: &str, value: &Interval, optimum: &Bracket) -> String {
    let (v, l) = (value.rounded(), optimum.lower.rounded());
    format!("{what}: {v:?}, the optimum is {l:?}, {:e} less", value.minus(&optimum.lower).rounded())
}
