//! The counters of the solvers of ellipsoids.

use std::collections::BTreeMap;

/// Events of a run, for its trace.
#[derive(Clone, Debug, Default)]
pub(super) struct Counters {
    /// Steps of the outer method: Newton steps, or steps of a classical method.
    pub(super) steps: u64,
    /// Points that a quadratic model took up or dropped.
    pub(super) pivots: u64,
    /// Points exchanged for a point that depended on them.
    pub(super) exchanges: u64,
    /// Factors made to guess the points in use.
    pub(super) crashes: u64,
    /// Steps of the interior-point method.
    pub(super) interior: u64,
    /// Other counts, by name.
    pub(super) others: BTreeMap<String, u64>,
}

impl Counters {
    /// The counts that are not zero, by name.
    pub(super) fn into_named(self) -> BTreeMap<String, u64> {
        let mut named = self.others;
        for (name, count) in [
            ("pivots", self.pivots),
            ("exchanges", self.exchanges),
            ("crashes", self.crashes),
            ("interior-steps", self.interior),
        ] {
            if count > 0 {
                named.insert(name.to_owned(), count);
            }
        }
        named
    }
}
