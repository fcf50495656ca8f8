//! The oracles: each decides, by exact arithmetic, whether what a checker let pass is true.

/// What an oracle says of an accepted answer and of every field of its verdict.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Every claim is true.
    True,
    /// A claim is false, and why.
    False(String),
    /// The oracle cannot decide, and why. This must be rare.
    Undecided(String),
}
