//! Forged answers against the checkers, and exact oracles that judge what the checkers let pass.

mod oracle;
