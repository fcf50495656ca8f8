//! Forged numbers.

use serde_json::{Number, Value};

use crate::random::Random;

/// Doubles at the ends of the range and at other places where arithmetic changes.
const EXTREMES: [f64; 22] = [
    5e-324,
    1e-323,
    1e-310,
    1e-308,
    f64::MIN_POSITIVE,
    1e-300,
    1e-200,
    1e-160,
    1e-154,
    1e-100,
    1e-61,
    1e-16,
    f64::EPSILON,
    1e61,
    1e100,
    1e154,
    1e155,
    1e200,
    1e300,
    1e308,
    8.98846567431158e307,
    f64::MAX,
];

/// Integers where types end.
const INTEGERS: [u64; 14] = [
    0,
    1,
    2,
    3,
    1 << 31,
    (1 << 32) - 1,
    1 << 32,
    1 << 53,
    (1 << 53) + 1,
    (1 << 63) - 1,
    1 << 63,
    (1 << 63) + 1,
    u64::MAX - 1,
    u64::MAX,
];

/// Values that are no number; the text after the mark stands in the document without quotes.
const OTHERS: [&str; 8] = ["null", "1e999", "-1e999", "1e-999", "NaN", "true", "[]", "\"1\""];

/// Marks a string whose text is to stand in the document as it is.
pub const RAW: char = '\u{1}';

/// Returns a value of JSON from a double.
pub fn value(number: f64) -> Value {
    match Number::from_f64(number) {
        Some(number) => Value::Number(number),
        None => raw("1e999"),
    }
}

/// Returns text that is to stand in the document as it is.
fn raw(text: &str) -> Value {
    Value::String(format!("{RAW}{text}"))
}

/// The doubles that most checks have to think of.
const EDGES: [f64; 8] = [0.0, -0.0, 5e-324, 1e-308, f64::MIN_POSITIVE, 1e308, f64::MAX, 1.0];

/// Returns one of the doubles at the ends of the range, of either sign.
pub fn extreme(random: &mut Random) -> f64 {
    if random.chance(60) {
        return *random.pick(&EDGES);
    }
    let size = *random.pick(&EXTREMES);
    if random.chance(40) { -size } else { size }
}

/// Moves a double by a few units in the last place.
fn by_ulps(random: &mut Random, old: f64) -> f64 {
    let mut new = old;
    let up = random.chance(50);
    for _ in 0..*random.pick(&[1, 1, 1, 2, 3, 8]) {
        new = if up { new.next_up() } else { new.next_down() };
    }
    new
}

/// Moves a double by a small part of itself.
fn nearby(random: &mut Random, old: f64) -> f64 {
    let part = 10f64.powi(-(random.between(1, 17) as i32));
    old * (1.0 + random.signed() * part)
}

/// Multiplies by a power of two, mostly a small one, sometimes one that leads to the end of the range.
pub fn power(random: &mut Random) -> f64 {
    let k = match random.below(4) {
        0 | 1 => random.between(-3, 3),
        2 => random.between(-60, 60),
        _ => random.between(-1074, 1023),
    };
    2f64.powi(k as i32)
}

/// Returns a forged number in the place of another; `others` are numbers of the document.
pub fn forged(random: &mut Random, old: &Number, others: &[Number]) -> Value {
    if random.chance(4) {
        let text = *random.pick(&OTHERS);
        return raw(text);
    }
    if random.chance(8) && !others.is_empty() {
        return Value::Number(random.pick(others).clone());
    }
    match old.as_u64().filter(|_| !old.is_f64()) {
        Some(integer) if !random.chance(5) => Value::Number(match random.below(6) {
            0 => (*random.pick(&INTEGERS)).into(),
            1 => integer.wrapping_add(1).into(),
            2 => integer.wrapping_sub(1).into(),
            3 => (integer ^ 1 << random.below(64)).into(),
            4 => (random.next() % 40).into(),
            _ => integer.wrapping_add(random.next() % 9).wrapping_sub(4).into(),
        }),
        _ => value(double(random, old.as_f64().unwrap_or(0.0))),
    }
}

/// Returns a forged double.
pub fn double(random: &mut Random, old: f64) -> f64 {
    match random.below(11) {
        0 | 1 | 10 => extreme(random),
        2 | 3 => by_ulps(random, old),
        4 => -old,
        5 => old * power(random),
        6 | 7 => nearby(random, old),
        8 => old + random.signed() * 10f64.powi(random.between(-17, 1) as i32),
        _ => *random.pick(&INTEGERS) as f64,
    }
}
