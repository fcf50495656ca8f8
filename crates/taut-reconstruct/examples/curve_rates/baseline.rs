//! The draws of another build, kept in a file, beside those of this one.
//!
//! Tab-separated: section, class, seed, whether the answer is right, whether it is certified (1 or 0).

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write;

use super::record::{Draw, classes};

/// Whether each draw is right, by section, class and seed.
pub(crate) type Before = BTreeMap<(String, String, u64), bool>;

/// Writes a line for each draw.
pub(crate) fn write(file: &str, draws: &[(&str, Draw)]) -> Result<(), Box<dyn Error>> {
    let mut out = std::io::BufWriter::new(std::fs::File::create(file)?);
    for (section, draw) in draws {
        let [right, certified] = [draw.is_right, draw.is_certified].map(u8::from);
        writeln!(out, "{section}\t{}\t{}\t{right}\t{certified}", draw.class, draw.seed)?;
    }
    Ok(out.flush()?)
}

/// Reads such a file.
pub(crate) fn read(file: &str) -> Result<Before, Box<dyn Error>> {
    let mut before = Before::new();
    for (line, text) in std::fs::read_to_string(file)?.lines().enumerate() {
        let fields: Vec<&str> = text.split('\t').collect();
        let [section, class, seed, right, _] = fields[..] else {
            return Err(format!("{file}, line {}: {text:?} is not five fields", line + 1).into());
        };
        let seed = seed.parse().map_err(|e| format!("{file}, line {}: {e}", line + 1))?;
        before.insert((section.to_owned(), class.to_owned(), seed), right == "1");
    }
    Ok(before)
}

/// Prints how many of the draws that were right before are not now, and the other way around, class by class and in all.
pub(crate) fn compare(before: &Before, section: &str, draws: &[Draw]) {
    let mut sums = [0; 3];
    for class in classes(draws) {
        let (mut right, mut lost, mut gained) = (0, vec![], vec![]);
        for draw in draws.iter().filter(|draw| draw.class == class) {
            let key = (section.to_owned(), class.to_owned(), draw.seed);
            match (before.get(&key), draw.is_right) {
                (Some(true), now) => {
                    right += 1;
                    if !now {
                        lost.push(draw.seed);
                    }
                }
                (Some(false), true) => gained.push(draw.seed),
                _ => {}
            }
        }
        for (sum, count) in sums.iter_mut().zip([right, lost.len(), gained.len()]) {
            *sum += count;
        }
        if !lost.is_empty() || !gained.is_empty() {
            let (few, more) = (&lost[..lost.len().min(8)], gained.len());
            println!(
                "  {class}: of {right} right before {} lost {few:?}, {more} gained",
                lost.len()
            );
        }
    }
    let [right, lost, gained] = sums;
    let percent = 100.0 * f64::from(lost as u32) / f64::from((right as u32).max(1));
    println!(
        "against the baseline: of {right} right before {lost} lost ({percent:.1} %, at most 2 % asked), {gained} gained"
    );
}
