//! Forged lists, and lists of one object that are forged alike.

use serde_json::Value;

use super::number;

use crate::random::Random;
/// A change of the places of a list.
#[derive(Clone, Debug)]
enum Shuffle {
    Swap(usize, usize),
    Drop(usize),
    Repeat(usize, usize),
    Split(usize),
    Overwrite(usize, usize),
    Move(usize, usize),
    Rotate(usize),
    Reverse,
    Truncate(usize),
}

impl Shuffle {
    fn random(random: &mut Random, length: usize) -> Self {
        let at = |random: &mut Random| random.below(length);
        match random.below(10) {
            0 | 1 => Shuffle::Swap(at(random), at(random)),
            2 => Shuffle::Drop(at(random)),
            3 => Shuffle::Repeat(at(random), at(random)),
            4 => Shuffle::Overwrite(at(random), at(random)),
            5 => Shuffle::Move(at(random), at(random)),
            6 => Shuffle::Rotate(1 + random.below(length)),
            7 => Shuffle::Reverse,
            8 => Shuffle::Split(at(random)),
            _ => Shuffle::Truncate(at(random)),
        }
    }

    fn apply(&self, list: &mut Vec<Value>) {
        match *self {
            Shuffle::Swap(a, b) => list.swap(a, b),
            Shuffle::Drop(a) => drop(list.remove(a)),
            Shuffle::Repeat(a, b) => list.insert(b, list[a].clone()),
            Shuffle::Split(a) => {
                // Doubles are parted, so that their sum stays.
                if let Some(x) = list[a].as_f64().filter(|_| list[a].is_f64()) {
                    list[a] = number::value(0.5 * x);
                }
                list.insert(a, list[a].clone());
            }
            Shuffle::Overwrite(a, b) => list[b] = list[a].clone(),
            Shuffle::Move(a, b) => {
                let value = list.remove(a);
                list.insert(b, value);
            }
            Shuffle::Rotate(by) => list.rotate_left(by),
            Shuffle::Reverse => list.reverse(),
            Shuffle::Truncate(length) => list.truncate(length),
        }
    }
}

/// Changes all numbers in a value by one function.
pub fn each_number(value: &mut Value, change: &mut impl FnMut(f64) -> f64) {
    match value {
        Value::Number(old) if old.is_f64() => {
            *value = number::value(change(old.as_f64().unwrap_or(0.0)));
        }
        Value::Array(list) => list.iter_mut().for_each(|value| each_number(value, change)),
        Value::Object(map) => map.values_mut().for_each(|value| each_number(value, change)),
        _ => {}
    }
}

/// Forges one list; says how.
pub fn forge(random: &mut Random, list: &mut Vec<Value>) -> String {
    if list.is_empty() {
        list.push(match random.below(3) {
            0 => number::value(number::extreme(random)),
            1 => Value::from(random.next() % 10),
            _ => Value::Array(vec![]),
        });
        if random.chance(30) {
            list.push(list[0].clone());
        }
        return format!("put {} into an empty list", list[0]);
    }
    match random.below(11) {
        0 | 1 => {
            let factor = number::power(random);
            list.iter_mut().for_each(|value| each_number(value, &mut |x| x * factor));
            format!("scale by {factor:e}")
        }
        2 | 10 => {
            let constant = number::extreme(random);
            list.iter_mut().for_each(|value| each_number(value, &mut |_| constant));
            format!("set all to {constant:e}")
        }
        3 => {
            let part = 10f64.powi(random.between(-17, 0) as i32);
            let mut shake = |x: f64| x + random.signed() * part * x.abs().max(1e-300);
            list.iter_mut().for_each(|value| each_number(value, &mut shake));
            format!("shake by {part:e}")
        }
        4 => {
            list.iter_mut().for_each(|value| each_number(value, &mut |x| -x));
            "negate all".into()
        }
        5 => balance(random, list),
        _ => {
            let shuffle = Shuffle::random(random, list.len());
            shuffle.apply(list);
            format!("{shuffle:?}")
        }
    }
}

/// Moves weight from one number of a list to another, so that the sum stays.
fn balance(random: &mut Random, list: &mut [Value]) -> String {
    let (a, b) = (random.below(list.len()), random.below(list.len()));
    let (Some(from), Some(to)) = (list[a].as_f64(), list[b].as_f64()) else {
        list.swap(a, b);
        return format!("swap {a} and {b}");
    };
    let moved = match random.below(3) {
        0 => from,
        1 => from * random.unit(),
        _ => from * 10f64.powi(-(random.between(1, 17) as i32)),
    };
    if a != b {
        list[a] = number::value(from - moved);
        list[b] = number::value(to + moved);
    }
    format!("move {moved:e} from {a} to {b}")
}

/// Forges lists of equal length in an object alike: one shuffle of the places of them all.
pub fn forge_alike(
    random: &mut Random,
    map: &mut serde_json::Map<String, Value>,
) -> Option<String> {
    let lengths: Vec<usize> =
        map.values().filter_map(Value::as_array).map(Vec::len).filter(|&n| n > 0).collect();
    if lengths.is_empty() {
        return None;
    }
    let length = *random.pick(&lengths);
    let shuffle = Shuffle::random(random, length);
    for list in map.values_mut().filter_map(Value::as_array_mut) {
        if list.len() == length {
            shuffle.apply(list);
        }
    }
    Some(format!("{shuffle:?} in all lists of length {length}"))
}
