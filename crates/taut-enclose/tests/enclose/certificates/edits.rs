//! Certificates edited at any place, by any bytes: the checker accepts or refuses, and never panics. Shared with the fuzz
//! target.

use std::sync::OnceLock;

use serde_json::{Value, json};
use taut_certify::{AnySolution, Placement, RobustMethod};
use taut_enclose::{
    CentersMethod, CentersOptions, InscribedOptions, RobustOptions, centers, inscribed_ellipsoid,
    robust_ellipsoid,
};
use taut_points::{Distribution, Monitor, Points, generate};

/// Rows, columns, and what was found for them.
struct Sound {
    values: Vec<f64>,
    columns: usize,
    json: Value,
}

/// One answer of each kind that has certificates within certificates, or a check of its own.
fn sound() -> &'static [Sound] {
    static SOUND: OnceLock<Vec<Sound>> = OnceLock::new();
    SOUND.get_or_init(|| {
        let plain: Vec<f64> = generate(Distribution::Normal, 20, 2, 3).unwrap();
        let mut flat: Vec<f64> = generate(Distribution::Normal, 20, 3, 4).unwrap();
        flat.chunks_mut(3).take(17).for_each(|row| row[2] = row[0] - row[1]);
        let mut all = vec![];
        for method in RobustMethod::ALL {
            for (values, columns) in [(&plain, 2), (&flat, 3)] {
                let points = Points::new(values, columns).unwrap();
                let options = RobustOptions { method, ..Default::default() };
                let json = robust_ellipsoid(&points, &options).unwrap().to_json();
                all.push((values.clone(), columns, json));
            }
        }
        let sides =
            vec![1.0, 0.0, 4.0, -1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, -1.0, 0.0, 1.0, 1.0, 5.0];
        let found =
            inscribed_ellipsoid(&Points::new(&sides, 3).unwrap(), &InscribedOptions::default());
        all.push((sides, 3, found.unwrap().to_json()));
        let asked = [
            (Placement::Free, 1, CentersMethod::Tree),
            (Placement::Rows, 0, CentersMethod::Tree),
            (Placement::Free, 0, CentersMethod::FarthestFirst),
        ];
        for (placement, outliers, method) in asked {
            let options = CentersOptions {
                placement,
                outliers,
                method,
                assignment: true,
                ..Default::default()
            };
            let found = centers(&Points::new(&plain, 2).unwrap(), 3, &options);
            all.push((plain.clone(), 2, found.unwrap().to_json()));
        }
        let parsed = |(values, columns, json): (Vec<f64>, usize, String)| {
            let json = serde_json::from_str(&json).unwrap();
            Sound { values, columns, json }
        };
        all.into_iter().map(parsed).collect()
    })
}

/// Bytes one after the other; zeros once they are used up.
struct Choices<'a>(std::slice::Iter<'a, u8>);

impl Choices<'_> {
    fn below(&mut self, count: usize) -> usize {
        let (high, low) = (self.0.next().unwrap_or(&0), self.0.next().unwrap_or(&0));
        usize::from(u16::from_be_bytes([*high, *low])) % count.max(1)
    }
}

/// The nodes of a tree.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(fields) => fields.values().map(count).sum::<usize>(),
        _ => 0,
    }
}

/// The node of that number, in order of a walk.
fn node<'a>(value: &'a mut Value, number: &mut usize) -> Option<&'a mut Value> {
    if *number == 0 {
        return Some(value);
    }
    *number -= 1;
    match value {
        Value::Array(items) => items.iter_mut().find_map(|item| node(item, number)),
        Value::Object(fields) => fields.values_mut().find_map(|field| node(field, number)),
        _ => None,
    }
}

fn edit(value: &mut Value, choices: &mut Choices<'_>) {
    let numbers =
        [json!(0), json!(1), json!(-1.0), json!(0.5), json!(1e300), json!(1e-300), json!(u64::MAX)];
    let number = numbers[choices.below(numbers.len())].clone();
    let how = choices.below(6);
    match value {
        Value::Array(items) => {
            let at = choices.below(items.len());
            match how {
                0 => items.push(number),
                1 => _ = items.pop(),
                2 => items.clear(),
                3 if !items.is_empty() => items.push(items[at].clone()),
                4 if !items.is_empty() => _ = items.remove(at),
                _ => items.reverse(),
            }
        }
        Value::Object(fields) => {
            let at = choices.below(fields.len());
            let name = fields.keys().nth(at).cloned();
            if let Some(name) = name {
                match how {
                    0 | 1 => _ = fields.remove(&name),
                    2 => _ = fields.insert(name, Value::Null),
                    _ => _ = fields.insert(name, number),
                }
            }
        }
        Value::Number(old) => match (how, old.as_f64()) {
            (0, Some(old)) => *value = json!(-old),
            (1, Some(old)) => *value = json!(old * 2.0),
            (2, Some(old)) => *value = json!(old * 1e160),
            (3, Some(old)) => *value = json!(old * 1e-160),
            _ => *value = number,
        },
        other => *other = number,
    }
}

/// The first byte chooses the answer; each edit takes eight more.
///
/// # Panics
/// When the checker does, which is what this is to find out.
pub(crate) fn edit_and_check(bytes: &[u8]) {
    let Some((&first, rest)) = bytes.split_first() else { return };
    let sound = &sound()[usize::from(first) % sound().len()];
    let mut json = sound.json.clone();
    for eight in rest.chunks(8).take(4) {
        let mut choices = Choices(eight.iter());
        // The head says which kind of answer it is, and is read by others.
        for part in ["answer", "certificate"].into_iter().skip(choices.below(2)).take(1) {
            let part = &mut json[part];
            let mut at = choices.below(count(part));
            if let Some(place) = node(part, &mut at) {
                edit(place, &mut choices);
            }
        }
    }
    if let Ok(edited) = AnySolution::from_json(&json.to_string()) {
        let points = Points::new(&sound.values, sound.columns).expect("whole rows");
        _ = edited.check(&points, &Monitor::silent());
    }
}
