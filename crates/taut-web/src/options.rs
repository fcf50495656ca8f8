//! Options of a tool as the page sends them: a JSON object of those that differ from the usual ones.

use serde_json::{Map, Value, json};
use taut::points::Choice;

/// The options that are given.
#[derive(Clone, Debug, Default)]
pub(crate) struct Options(Map<String, Value>);

impl Options {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        match serde_json::from_str(text) {
            Ok(Value::Object(given)) => Ok(Options(given)),
            _ => Err("options are a JSON object".to_owned()),
        }
    }

    /// A number; what is given may be text.
    pub(crate) fn number(&self, name: &str, usual: f64) -> Result<f64, String> {
        match self.0.get(name) {
            None => Ok(usual),
            Some(Value::Number(number)) => Ok(number.as_f64().unwrap_or(f64::NAN)),
            Some(Value::String(text)) => text
                .trim()
                .parse()
                .map_err(|_| format!("option `{name}` is {text}: expected a number")),
            Some(other) => Err(format!("option `{name}` is {other}: expected a number")),
        }
    }

    /// A whole number, at least 0.
    pub(crate) fn whole(&self, name: &str, usual: u64) -> Result<u64, String> {
        let number = self.number(name, usual as f64)?;
        // Beyond 2⁵³ not every whole number is an `f64`.
        match number.fract() == 0.0 && (0.0..=9_007_199_254_740_992.0).contains(&number) {
            true => Ok(number as u64),
            false => Err(format!("option `{name}` is {number}: expected a whole number")),
        }
    }

    /// One of a few names.
    pub(crate) fn choice<T>(&self, name: &str) -> Result<T, String>
    where
        T: Choice + std::str::FromStr<Err: std::fmt::Display>,
    {
        match self.0.get(name) {
            None => Ok(T::CHOICES[0].1),
            Some(Value::String(text)) => text.parse().map_err(|error: T::Err| error.to_string()),
            Some(other) => Err(format!("option `{name}` is {other}: expected a name")),
        }
    }

    /// Yes or no, usually no.
    pub(crate) fn flag(&self, name: &str) -> bool {
        matches!(self.0.get(name), Some(Value::Bool(true)))
    }
}

/// Describes a number to the page.
pub(crate) fn number(name: &str, usual: f64, help: &str) -> Value {
    json!({ "name": name, "kind": "number", "usual": usual, "help": help })
}

/// Describes a whole number to the page.
pub(crate) fn whole(name: &str, usual: u64, least: u64, help: &str) -> Value {
    json!({ "name": name, "kind": "whole", "usual": usual, "least": least, "help": help })
}

/// Describes a choice to the page, with the words of the command for those that `keeps` keeps.
pub(crate) fn choice<T: Choice>(name: &str, help: &str, keeps: impl Fn(&str) -> bool) -> Value {
    let choices: Vec<Value> = T::CHOICES
        .iter()
        .filter(|(name, ..)| keeps(name))
        .map(|(name, _, help)| json!({ "name": name, "help": help }))
        .collect();
    json!({ "name": name, "kind": "choice", "choices": choices, "help": help })
}

/// Describes a yes or no to the page.
pub(crate) fn flag(name: &str, help: &str) -> Value {
    json!({ "name": name, "kind": "flag", "help": help })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_or_refused_by_name() {
        let given =
            r#"{"epsilon":"1e-3","k":4,"open":true,"order":"hilbert","bad":"x","part":0.5}"#;
        let options = Options::parse(given).unwrap();
        assert_eq!(options.number("epsilon", 0.0), Ok(1e-3));
        assert_eq!(options.whole("k", 2), Ok(4));
        assert_eq!(options.whole("absent", 2), Ok(2));
        assert!(options.flag("open") && !options.flag("closed"));
        let order: taut::delaunay::InsertionOrder = options.choice("order").unwrap();
        assert_eq!(order.name(), "hilbert");
        assert!(options.number("bad", 0.0).unwrap_err().contains("`bad` is x"));
        assert!(options.whole("part", 0).is_err());
        assert!(options.choice::<taut::BallMethod>("bad").is_err());
        assert!(Options::parse("[]").is_err());
    }
}
