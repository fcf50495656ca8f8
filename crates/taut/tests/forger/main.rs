//! Forged answers, and oracles that tell whether one that a checker accepted is true.

mod oracle;
