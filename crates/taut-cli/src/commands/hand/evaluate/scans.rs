//! Scans of people with what was measured in them: from images, from what `taut hand measure` wrote, from a table, or synthetic.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use rayon::prelude::*;
use taut::points::Monitor;
use taut::recognize::evaluate::{Attempt, HAND_COLUMNS, hand_columns};
use taut::recognize::hand::synthetic::Generator;
use taut::recognize::hand::{FEATURE_NAMES, Hand, HandError, HandOptions, profile_names};

use crate::output::numbers::exact;

/// Extensions of images.
const IMAGES: [&str; 5] = ["png", "jpg", "jpeg", "tif", "tiff"];
/// The largest table and the largest list of labels that are read: 1 GiB.
const TEXT_BYTES_MAX: u64 = 1 << 30;
/// The first columns of a table.
const TABLE_HEAD: [&str; 3] = ["file", "person", "failure"];

/// The features of a scan, or why there are none.
type Measured = Result<Vec<f64>, String>;

/// One scan.
pub(super) struct Scan {
    file: String,
    person: u32,
    measured: Measured,
}

/// All scans.
pub(super) struct Scans {
    /// Names of the people, by number.
    pub(super) people: Vec<String>,
    scans: Vec<Scan>,
}

impl Scans {
    /// Joins scans with the names of their people.
    fn of(named: Vec<(String, String, Measured)>) -> Self {
        let mut people: Vec<String> = named.iter().map(|scan| scan.1.clone()).collect();
        people.sort();
        people.dedup();
        let number: BTreeMap<String, u32> = people.iter().cloned().zip(0..).collect();
        let scan = |(file, person, measured): (String, String, _)| Scan {
            file,
            person: number[&person],
            measured,
        };
        Scans { scans: named.into_iter().map(scan).collect(), people }
    }

    /// Measures synthetic scans.
    pub(super) fn synthetic(
        generator: &Generator,
        people: u64,
        scans: u64,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<Self> {
        let all: Vec<(u64, u64)> =
            (0..people).flat_map(|person| (0..scans).map(move |scan| (person, scan))).collect();
        monitor.pass(1, all.len() as u64);
        let measure = |&(person, scan): &(u64, u64)| {
            monitor.check()?;
            let made = generator.scan(person, scan);
            let measured = kept(Hand::from_rgb(&made.image, &HandOptions::default()))?;
            monitor.points(1);
            Ok((format!("scan {scan}"), format!("{person:06}"), measured))
        };
        let named = all.par_iter().map(measure).collect::<anyhow::Result<Vec<_>>>()?;
        Ok(Scans::of(named))
    }

    /// Reads files and folders, or one table.
    pub(super) fn read(
        paths: &[PathBuf],
        labels: Option<&Path>,
        options: &HandOptions,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<Self> {
        if let [table] = paths
            && has_extension(table, &["csv"])
        {
            if labels.is_some() {
                bail!("{} has the people already: leave out --labels", table.display());
            }
            return Scans::of_table(table);
        }
        let mut files = vec![];
        for path in paths {
            match path.is_dir() {
                true => files.extend(scans_of(path)?),
                false => files.push(path.clone()),
            }
        }
        let person_of = labels.map(people_of).transpose()?;
        monitor.pass(1, files.len() as u64);
        let measure = |file: &PathBuf| {
            monitor.check()?;
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let person = match &person_of {
                Some(people) => people.get(&name).cloned().ok_or_else(|| {
                    anyhow!("{}: the labels do not have this file", file.display())
                })?,
                None => person_by_name(&name),
            };
            let measured = match has_extension(file, &["json"]) {
                true => Ok(of_json(file)?),
                false => kept(Hand::from_file(file, options))
                    .map_err(|error| anyhow!("{}: {error}", file.display()))?,
            };
            monitor.points(1);
            Ok((name, person, measured))
        };
        Ok(Scans::of(files.par_iter().map(measure).collect::<anyhow::Result<Vec<_>>>()?))
    }

    /// The attempts, as the library takes them.
    pub(super) fn attempts(&self) -> Vec<Attempt<'_>> {
        let scans = self.scans.iter();
        scans
            .map(|scan| Attempt { person: scan.person, features: scan.measured.as_deref().ok() })
            .collect()
    }

    pub(super) fn len(&self) -> usize {
        self.scans.len()
    }

    /// How often each reason for a failure was given.
    pub(super) fn failures(&self) -> BTreeMap<&str, u64> {
        let mut counts = BTreeMap::new();
        for reason in self.scans.iter().filter_map(|scan| scan.measured.as_ref().err()) {
            *counts.entry(reason.as_str()).or_insert(0) += 1;
        }
        counts
    }

    /// The table of all features.
    pub(super) fn to_table(&self) -> String {
        let mut head: Vec<String> = TABLE_HEAD.map(str::to_owned).to_vec();
        head.extend(hand_columns());
        let mut text = head.join(",") + "\n";
        for scan in &self.scans {
            let person = &self.people[scan.person as usize];
            let mut fields = vec![quoted(&scan.file), quoted(person)];
            match &scan.measured {
                Ok(features) => {
                    fields.push(String::new());
                    fields.extend(features.iter().map(|&value| exact(value)));
                }
                Err(reason) => {
                    fields.push(reason.clone());
                    fields.extend(std::iter::repeat_n(String::new(), HAND_COLUMNS));
                }
            }
            text += &(fields.join(",") + "\n");
        }
        text
    }

    fn of_table(path: &Path) -> anyhow::Result<Self> {
        let name = path.display();
        let text = text_of(path)?;
        let mut lines = text.lines().enumerate();
        let head = lines.next().map(|line| fields_of(line.1)).unwrap_or_default();
        let expected = TABLE_HEAD.map(str::to_owned).into_iter().chain(hand_columns());
        if !head.iter().cloned().eq(expected) {
            bail!("{name}: this is no table that `taut hand evaluate --feature-table` wrote");
        }
        let mut named = vec![];
        for (row, line) in lines.filter(|line| !line.1.is_empty()) {
            let fields = fields_of(line);
            if fields.len() != head.len() {
                bail!("{name}, line {}: {} fields, expected {}", row + 1, fields.len(), head.len());
            }
            let measured = match fields[2].as_str() {
                "" => {
                    let number = |(field, column): (&String, &String)| {
                        field.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
                            anyhow!(
                                "{name}, line {}: `{field}` in `{column}` is no number",
                                row + 1
                            )
                        })
                    };
                    Ok(fields[3..].iter().zip(&head[3..]).map(number).collect::<Result<_, _>>()?)
                }
                reason => Err(reason.to_owned()),
            };
            named.push((fields[0].clone(), fields[1].clone(), measured));
        }
        Ok(Scans::of(named))
    }
}

/// Takes a failure to measure as a result; other errors are those of the caller.
fn kept(measured: Result<Hand, HandError>) -> anyhow::Result<Measured> {
    match measured {
        Ok(hand) => Ok(Ok(taut::recognize::evaluate::hand_row(&hand).to_vec())),
        Err(HandError::Hand(failure)) => Ok(Err(reason(&format!("{failure:?}")))),
        Err(other) => Err(other.into()),
    }
}

/// The name of a failure without its numbers, in words: `CutOff { .. }` is "cut off".
fn reason(debug: &str) -> String {
    let name = debug.split([' ', '(', '{']).next().unwrap_or_default();
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

/// The images and measured hands of a folder, by name.
fn scans_of(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let name = folder.display();
    let entries = fs::read_dir(folder).map_err(|source| anyhow!("{name}: {source}"))?;
    let mut files = vec![];
    for entry in entries {
        let path = entry.map_err(|source| anyhow!("{name}: {source}"))?.path();
        let is_scan = has_extension(&path, &IMAGES) || has_extension(&path, &["json"]);
        if is_scan && path.is_file() {
            files.push(path);
        }
    }
    if files.is_empty() {
        bail!("{name}: the folder has no scans in PNG, JPEG or TIFF, and no hands in JSON");
    }
    files.sort();
    Ok(files)
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    extension.and_then(|e| e.into_string().ok()).is_some_and(|e| extensions.contains(&e.as_str()))
}

/// The name of a file without extension, and without the number at its end.
fn person_by_name(file: &str) -> String {
    let stem = file.rsplit_once('.').map_or(file, |parts| parts.0);
    let person = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let person = person.trim_end_matches(['-', '_', ' ', '.']);
    if person.is_empty() { stem.to_owned() } else { person.to_owned() }
}

/// What `taut hand measure -o` wrote.
fn of_json(path: &Path) -> anyhow::Result<Vec<f64>> {
    let name = path.display();
    let value: serde_json::Value = serde_json::from_str(&text_of(path)?)
        .map_err(|error| anyhow!("{name}: this is no JSON: {error}"))?;
    let number = |part: &str, key: &str| {
        value[part][key].as_f64().ok_or_else(|| {
            anyhow!("{name}: no number for `{key}`: expected what `taut hand measure -o` writes")
        })
    };
    let features = FEATURE_NAMES.iter().map(|key| number("features", key));
    let profile = profile_names();
    features.chain(profile.iter().map(|key| number("profile", key))).collect()
}

/// The people of files, from a table with the columns `file` and `person`.
fn people_of(path: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let name = path.display();
    let text = text_of(path)?;
    let mut lines = text.lines();
    let head = lines.next().map(fields_of).unwrap_or_default();
    let place = |column: &str| {
        head.iter().position(|field| field == column).ok_or_else(|| {
            anyhow!("{name}: no column `{column}`: labels have the columns `file` and `person`")
        })
    };
    let (file, person) = (place("file")?, place("person")?);
    let mut people = BTreeMap::new();
    for (row, line) in lines.enumerate().filter(|line| !line.1.is_empty()) {
        let fields = fields_of(line);
        let [Some(file), Some(person)] = [file, person].map(|at| fields.get(at).cloned()) else {
            bail!("{name}, line {}: too few fields", row + 2);
        };
        if people.insert(file.clone(), person).is_some() {
            bail!("{name}, line {}: `{file}` has a label already", row + 2);
        }
    }
    Ok(people)
}

fn text_of(path: &Path) -> anyhow::Result<String> {
    let name = path.display();
    let failed = |source: std::io::Error| anyhow!("{name}: {source}");
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        bail!("{name}: not a regular file");
    }
    if metadata.len() > TEXT_BYTES_MAX {
        bail!("{name}: more than {TEXT_BYTES_MAX} bytes");
    }
    fs::read_to_string(path).map_err(failed)
}

/// A field of CSV, in quotes where it needs them.
fn quoted(field: &str) -> String {
    match field.contains([',', '"']) || field.trim() != field {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_owned(),
    }
}

/// The fields of a line of CSV.
fn fields_of(line: &str) -> Vec<String> {
    let (mut fields, mut field, mut is_quoted) = (vec![], String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                letters.next();
                field.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => fields.push(std::mem::take(&mut field)),
            other => field.push(other),
        }
    }
    fields.push(field);
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_are_found_in_the_names_of_files() {
        assert_eq!(person_by_name("person-0000-scan-03.png"), "person-0000-scan");
        assert_eq!(person_by_name("anna_12.jpeg"), "anna");
        assert_eq!(person_by_name("007.tif"), "007");
        assert_eq!(reason("CutOff { edge: Left }"), "cut off");
        assert_eq!(reason("OtherHand"), "other hand");
    }

    #[test]
    fn fields_come_back_from_quotes() {
        for field in ["plain", "a, b", "say \"a\"", " wide "] {
            assert_eq!(fields_of(&(quoted(field) + ",1")), [field, "1"]);
        }
    }
}
