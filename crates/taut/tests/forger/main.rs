//! Forged answers against the checkers, and exact oracles that judge what the checkers let pass.
//!
//! `cargo test -p taut --test forger -- --nocapture` makes 10⁴ forgeries of each kind of answer and prints what came of
//! them; `TAUT_FORGERIES=100000` makes so many of each kind, and `TAUT_FORGER_REASONS=1` lists why they were refused.
#![allow(unreachable_pub)] // modules of one test binary

mod attack;
mod cases;
mod forge;
mod oracle;
mod random;

use attack::attack;

#[test]
fn no_false_ball_is_accepted() {
    attack("ball", &cases::ball::all()).report("ball");
}

#[test]
fn no_false_centers_are_accepted() {
    attack("centers", &cases::centers::all()).report("centers");
}
