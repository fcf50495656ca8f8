//! Exact oracles: whether what a verdict says is true, found in 256 bits and without the code of any checker.

mod body;
mod claims;
pub(crate) mod ellipsoid;
mod exchange;
mod flat;
pub(crate) mod inscribed;
mod interval;
mod linear;
mod mvee;
mod mvie;
pub(crate) mod robust;

/// Whether the claims of one verdict hold.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Truth {
    /// All of them do.
    True,
    /// One of them does not: which, and by how much.
    False(String),
    /// The oracle cannot tell: why.
    Undecided(String),
}
