//! The matcher that comes with the library.
//!
//! *Source.* `examples/default_matcher.rs` learned it from synthetic scans: 70 people with 10 scans each of the seeds 501 to 504.
//! *Trap.* The covariance within people is that of the generator, and the rates say nothing of people. A matcher from scans of some dozens
//! of people on the scanner in question is better.

use std::sync::LazyLock;

use crate::template::Matcher;

static DEFAULT: LazyLock<Matcher> = LazyLock::new(|| {
    Matcher::from_json(include_str!("default_matcher.json"))
        .expect("it was written by this library")
});

impl Matcher {
    /// Returns a matcher of width profiles ([`Hand::profile`](super::Hand::profile)) that was learned from synthetic hands.
    ///
    /// Its threshold accepted at most one in ten thousand comparisons of different synthetic people. [`Matcher::rates`] has what was then
    /// measured on others; error rates of people will differ.
    #[must_use]
    pub fn of_synthetic_hands() -> &'static Matcher {
        &DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::PROFILE;

    #[test]
    fn the_default_matcher_takes_profiles() {
        let matcher = Matcher::of_synthetic_hands();
        assert_eq!(matcher.dim(), PROFILE);
        assert!(matcher.source().contains("synthetic"));
        assert!(matcher.rates().impostor > 1000 && matcher.threshold() > 0.0);
    }
}
