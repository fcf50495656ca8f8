//! An attacker on the checkers, and the exact oracles that judge what it gets accepted.

mod oracle;
