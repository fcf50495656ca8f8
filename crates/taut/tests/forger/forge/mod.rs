//! The attacker: it forges the JSON of a solution and knows no kind of answer.
//!
//! *Idea.* A forgery is an honest document, or one made for other data with the hash of these, and one to three edits at
//! random places of answer and certificate. Places are drawn by their class, a path whose numbers in lists are left out, so
//! that a gap is met as often as a table of a thousand rows. As a forgery is of use when it claims much, half of them claim
//! a gap of 0, or less than was proved, on top.
//! *Trap.* JSON holds neither NaN nor infinity; text that is no number is written in their place, as an attacker would.

pub mod list;
pub mod number;
mod places;

use serde_json::{Map, Value};

use self::places::Places;
use crate::random::Random;

/// A forged document, and how it was made.
pub struct Forgery {
    /// The document.
    pub text: String,
    /// Where it begins and what was edited, one line each.
    pub edits: Vec<String>,
}

/// Forges documents of one input.
pub struct Forger {
    bases: Vec<(String, Value)>,
    own: usize,
    words: Vec<String>,
}

/// Words of the format that are in few documents.
const WORDS: [&str; 30] = [
    "points",
    "balls",
    "ellipsoids",
    "free",
    "rows",
    "apart",
    "search",
    "branches",
    "hilbert",
    "morton",
    "columns",
    "u64",
    "i64",
    "f64",
    "bytes",
    "mcd",
    "mve",
    "trim",
    "inner",
    "outer",
    "left",
    "right",
    "closed",
    "open",
    "none",
    "exact",
    "alpha",
    "front",
    "labels",
    "zero",
];

impl Forger {
    /// Prepares to forge from documents of the input and from documents of others, each with a word on where it is from.
    pub fn new(own: &[(String, Value)], foreign: &[(String, Value)]) -> Self {
        let bases = [own, foreign].concat();
        assert!(!bases.is_empty(), "there is nothing to forge");
        let mut words: Vec<String> = WORDS.map(str::to_owned).into();
        for (_, base) in &bases {
            for part in ["answer", "certificate"] {
                collect_words(&base[part], &mut words);
            }
        }
        words.sort();
        words.dedup();
        Forger { bases, own: own.len(), words }
    }

    /// Returns one forgery.
    pub fn forge(&self, random: &mut Random) -> Forgery {
        let own = self.own > 0 && random.chance(60);
        let base = random.below(if own { self.own } else { self.bases.len() });
        let (name, document) = &self.bases[base];
        let mut document = document.clone();
        let mut edits = vec![format!("from {name}")];
        let count = match random.below(20) {
            0 => 0,
            1..=10 => 1,
            11..=17 => 2,
            _ => 3,
        };
        for _ in 0..count {
            edits.push(self.edit(random, &mut document));
        }
        if random.chance(50) {
            edits.extend(claim_tighter(random, &mut document));
        }
        Forgery { text: written(&document), edits }
    }

    fn edit(&self, random: &mut Random, document: &mut Value) -> String {
        let places = Places::of(document);
        let (class, sort) = *random.pick(&places.classes());
        let of_class = places.of_class(class, sort);
        let pointer = places.pointer(*random.pick(&of_class));
        if random.chance(6) {
            let other = places.pointer(*random.pick(&of_class));
            return swap(document, &pointer, &other);
        }
        if random.chance(6) {
            return self.graft(random, document, &pointer);
        }
        let numbers = places.numbers();
        let Some(value) = document.pointer_mut(&pointer) else { return "no edit".into() };
        let what = match value {
            Value::Number(old) => {
                let new = number::forged(random, old, &numbers);
                let what = format!("{old} becomes {new}");
                *value = new;
                what
            }
            Value::String(text) => {
                let word = random.pick(&self.words).clone();
                let what = format!("{text:?} becomes {word:?}");
                *value = word.into();
                what
            }
            Value::Array(list) => list::forge(random, list),
            Value::Object(map) => self.edit_object(random, map),
            Value::Bool(flag) => {
                *flag = !*flag;
                format!("becomes {flag}")
            }
            Value::Null => {
                *value = Value::from(0);
                "null becomes 0".into()
            }
        };
        format!("{pointer}: {what}")
    }

    fn edit_object(&self, random: &mut Random, map: &mut Map<String, Value>) -> String {
        if random.chance(60)
            && let Some(what) = list::forge_alike(random, map)
        {
            return what;
        }
        if random.chance(30) {
            let factor = number::power(random);
            map.values_mut().for_each(|value| list::each_number(value, &mut |x| x * factor));
            return format!("scale all numbers by {factor:e}");
        }
        let keys: Vec<String> = map.keys().cloned().collect();
        match keys.is_empty() {
            true => "an empty object".into(),
            false => {
                let key = random.pick(&keys);
                map.remove(key);
                format!("without {key}")
            }
        }
    }

    /// Takes what another document has at the same place.
    fn graft(&self, random: &mut Random, document: &mut Value, pointer: &str) -> String {
        let (name, other) = random.pick(&self.bases);
        let (parent, key) = pointer.rsplit_once('/').unwrap_or(("", pointer));
        let part = other.pointer(pointer).cloned();
        match (part, document.pointer_mut(parent)) {
            (Some(part), Some(Value::Object(map))) => {
                map.insert(key.to_owned(), part);
            }
            (Some(part), _) => {
                if let Some(value) = document.pointer_mut(pointer) {
                    *value = part;
                }
            }
            (None, Some(Value::Object(map))) => drop(map.remove(key)),
            (None, _) => {}
        }
        // Optional parts of the other document come along, as there is no place for them here.
        let grafted = match (other.pointer(parent), document.pointer_mut(parent)) {
            (Some(Value::Object(from)), Some(Value::Object(to))) => {
                let new: Vec<&String> = from.keys().filter(|key| !to.contains_key(*key)).collect();
                match new.is_empty() {
                    true => String::new(),
                    false => {
                        let key = *random.pick(&new);
                        to.insert(key.clone(), from[key].clone());
                        format!(", and {key}")
                    }
                }
            }
            _ => String::new(),
        };
        format!("{pointer}: that of {name}{grafted}")
    }
}

/// Exchanges the values at two places.
fn swap(document: &mut Value, a: &str, b: &str) -> String {
    if let (Some(first), Some(second)) =
        (document.pointer(a).cloned(), document.pointer(b).cloned())
    {
        if let Some(value) = document.pointer_mut(a) {
            *value = second;
        }
        if let Some(value) = document.pointer_mut(b) {
            *value = first;
        }
    }
    format!("{a} and {b} exchanged")
}

/// Makes each stated gap smaller.
fn claim_tighter(random: &mut Random, document: &mut Value) -> Vec<String> {
    let way = random.below(6);
    let mut edits = vec![];
    for part in ["answer", "certificate"] {
        let mut tighten = |path: &str, value: &mut Value| {
            let old = value.as_f64().unwrap_or(0.0);
            let new = match way {
                0..=2 => 0.0,
                3 => 5e-324,
                4 => old * (1.0 - 10f64.powi(-(random.between(1, 12) as i32))),
                _ => old / 2.0,
            };
            *value = number::value(new);
            edits.push(format!("{path}: claims {new:e} instead of {old:e}"));
        };
        each_gap(&mut document[part], &mut format!("/{part}"), &mut tighten);
    }
    edits
}

/// Calls a function for each number or flag whose key ends with "gap", with the path to it.
fn each_gap(value: &mut Value, path: &mut String, call: &mut dyn FnMut(&str, &mut Value)) {
    let length = path.len();
    match value {
        Value::Array(list) => {
            for (i, value) in list.iter_mut().enumerate().filter(|(_, value)| has_parts(value)) {
                path.push_str(&format!("/{i}"));
                each_gap(value, path, call);
                path.truncate(length);
            }
        }
        Value::Object(map) => {
            for (key, value) in map {
                path.push_str(&format!("/{key}"));
                match value {
                    Value::Array(_) | Value::Object(_) => each_gap(value, path, call),
                    Value::String(_) => {}
                    _ if key.ends_with("gap") => call(path, value),
                    _ => {}
                }
                path.truncate(length);
            }
        }
        _ => {}
    }
}

fn has_parts(value: &Value) -> bool {
    matches!(value, Value::Array(_) | Value::Object(_))
}

/// The document, with values that are no JSON as they are.
fn written(document: &Value) -> String {
    let mut text = document.to_string();
    let mark = "\"\\u0001";
    while let Some(start) = text.find(mark) {
        let rest = &text[start + mark.len()..];
        let mut end = 0;
        while !rest[end..].starts_with('"') || rest[..end].ends_with('\\') {
            end += 1;
        }
        let raw = rest[..end].replace("\\\"", "\"");
        let after = start + mark.len() + end + 1;
        text.replace_range(start..after, &raw);
    }
    text
}

fn collect_words(value: &Value, words: &mut Vec<String>) {
    match value {
        Value::String(word) => words.push(word.clone()),
        Value::Array(list) => list.iter().for_each(|value| collect_words(value, words)),
        Value::Object(map) => map.values().for_each(|value| collect_words(value, words)),
        _ => {}
    }
}

#[test]
fn text_that_is_no_json_is_written_as_it_is() {
    let raw = |text: &str| Value::String(format!("{}{text}", number::RAW));
    let document = serde_json::json!({ "a": raw("1e999"), "b": [raw("\"1\""), "x"] });
    assert_eq!(written(&document), r#"{"a":1e999,"b":["1","x"]}"#);
}
