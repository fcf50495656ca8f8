//! Exact oracles: whether the claims of an accepted answer are true, by arithmetic that shares nothing with a checker.

pub(crate) mod curve;
mod lattice;
mod numbers;
pub(crate) mod surface;
pub(crate) mod triangulation;

/// What an oracle says about the claims of an accepted answer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Truth {
    /// Every claim is true.
    True,
    /// A claim is false; the text names it.
    False(String),
    /// The oracle cannot tell; the text says why.
    Undecided(String),
}
