//! The forger of the tests with its oracles, one forgery at a time, as the bytes of a fuzzer choose it.

#![allow(dead_code)] // attacks of a fixed length, and those on files, are the tests' alone

use std::cell::RefCell;
use std::sync::OnceLock;

#[path = "../../crates/taut/tests/forger/attack.rs"]
mod attack;
#[path = "../../crates/taut/tests/forger/cases/mod.rs"]
pub mod cases;
#[path = "../../crates/taut/tests/forger/forge/mod.rs"]
mod forge;
#[path = "../../crates/taut/tests/forger/oracle/mod.rs"]
mod oracle;
#[path = "../../crates/taut/tests/forger/random.rs"]
mod random;
#[path = "../../crates/test_length.rs"]
mod test_length;

use attack::Attack;
use cases::Case;
use random::Random;

thread_local! {
    static ATTACK: RefCell<Option<Attack<'static>>> = const { RefCell::new(None) };
}

/// Makes the forgery that the bytes choose, and judges it if the checker lets it pass.
///
/// # Panics
/// When a false answer is accepted, and when the checker panics.
pub fn forge_and_judge(kind: &'static str, cases: fn() -> Vec<Case>, bytes: &[u8]) {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    ATTACK.with_borrow_mut(|attack| {
        let attack = attack.get_or_insert_with(|| Attack::new(kind, CASES.get_or_init(cases)));
        attack.forge_any(&mut Random::from_bytes(bytes));
    });
}
