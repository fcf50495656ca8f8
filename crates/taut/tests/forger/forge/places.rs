//! The places of a document, by classes.
//!
//! *Idea.* A place knows its parent and its own key, so that a path is written only for the place that is drawn; documents have tens of
//! thousands of numbers, and most forgeries change one.

use std::collections::HashMap;

use serde_json::{Number, Value};

/// The content of a document at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sort {
    Number,
    Text,
    List,
    Object,
}

/// The last part of a path.
#[derive(Clone, Copy)]
enum Key<'a> {
    Name(&'a str),
    Index(usize),
}

struct Place<'a> {
    parent: Option<usize>,
    key: Key<'a>,
    class: usize,
    sort: Sort,
    value: &'a Value,
}

/// The places of answer and certificate. A class is a path whose numbers in lists are left out.
pub struct Places<'a> {
    list: Vec<Place<'a>>,
    /// The classes by number.
    names: Vec<String>,
    /// The number of a class by that of the one around it and its last part.
    known: HashMap<(Option<usize>, &'a str), usize>,
}

impl<'a> Places<'a> {
    pub fn of(document: &'a Value) -> Self {
        let mut places = Places { list: vec![], names: vec![], known: HashMap::new() };
        for part in ["answer", "certificate"] {
            let class = places.class(None, part);
            places.collect(&document[part], None, Key::Name(part), class);
        }
        places
    }

    fn class(&mut self, around: Option<usize>, part: &'a str) -> usize {
        if let Some(&class) = self.known.get(&(around, part)) {
            return class;
        }
        let before = around.map_or("", |class| &self.names[class]);
        self.names.push(format!("{before}/{part}"));
        self.known.insert((around, part), self.names.len() - 1);
        self.names.len() - 1
    }

    fn collect(&mut self, value: &'a Value, parent: Option<usize>, key: Key<'a>, class: usize) {
        let sort = match value {
            Value::Number(_) | Value::Bool(_) | Value::Null => Sort::Number,
            Value::String(_) => Sort::Text,
            Value::Array(_) => Sort::List,
            Value::Object(_) => Sort::Object,
        };
        let here = Some(self.list.len());
        self.list.push(Place { parent, key, class, sort, value });
        match value {
            Value::Array(list) if !list.is_empty() => {
                let class = self.class(Some(class), "*");
                for (i, value) in list.iter().enumerate() {
                    self.collect(value, here, Key::Index(i), class);
                }
            }
            Value::Object(map) => {
                // The hash of the data is known to all, and any other is refused at once.
                for (name, value) in map.iter().filter(|(name, _)| !name.ends_with("points_hash")) {
                    let class = self.class(Some(class), name);
                    self.collect(value, here, Key::Name(name), class);
                }
            }
            _ => {}
        }
    }

    /// The classes, each with what is at its places, by their names.
    pub fn classes(&self) -> Vec<(usize, Sort)> {
        let mut found: Vec<(usize, Sort)> = vec![];
        let mut seen = vec![[false; 4]; self.names.len()];
        for place in &self.list {
            let seen = &mut seen[place.class][place.sort as usize];
            if !std::mem::replace(seen, true) {
                found.push((place.class, place.sort));
            }
        }
        found.sort_by_key(|&(class, sort)| (&self.names[class], sort));
        found
    }

    /// The places of a class.
    pub fn of_class(&self, class: usize, sort: Sort) -> Vec<usize> {
        let is_wanted = |place: &Place<'_>| (place.class, place.sort) == (class, sort);
        (0..self.list.len()).filter(|&i| is_wanted(&self.list[i])).collect()
    }

    /// The path to a place, as [`Value::pointer`] takes it.
    pub fn pointer(&self, place: usize) -> String {
        let Place { parent, key, .. } = self.list[place];
        let before = parent.map_or(String::new(), |parent| self.pointer(parent));
        match key {
            Key::Name(name) => format!("{before}/{name}"),
            Key::Index(i) => format!("{before}/{i}"),
        }
    }

    /// All numbers.
    pub fn numbers(&self) -> Vec<Number> {
        self.list.iter().filter_map(|place| place.value.as_number().cloned()).collect()
    }
}

#[test]
fn places_are_named_by_path_and_class() {
    let document = serde_json::json!({
        "answer": { "a": [1, [2, "x"]], "points_hash": "0" }, "certificate": { "gap": 0.5 }, "trace": 3
    });
    let places = Places::of(&document);
    let named = |(class, sort): (usize, Sort)| {
        let pointers = places.of_class(class, sort).into_iter().map(|i| places.pointer(i));
        (places.names[class].as_str(), sort, pointers.collect::<Vec<_>>().join(" "))
    };
    let found: Vec<(&str, Sort, String)> = places.classes().into_iter().map(named).collect();
    let expected = [
        ("/answer", Sort::Object, "/answer"),
        ("/answer/a", Sort::List, "/answer/a"),
        ("/answer/a/*", Sort::Number, "/answer/a/0"),
        ("/answer/a/*", Sort::List, "/answer/a/1"),
        ("/answer/a/*/*", Sort::Number, "/answer/a/1/0"),
        ("/answer/a/*/*", Sort::Text, "/answer/a/1/1"),
        ("/certificate", Sort::Object, "/certificate"),
        ("/certificate/gap", Sort::Number, "/certificate/gap"),
    ];
    assert_eq!(found, expected.map(|(class, sort, pointer)| (class, sort, pointer.to_owned())));
    assert_eq!(places.numbers().len(), 3);
}
