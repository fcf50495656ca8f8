//! `taut hand train`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use taut::points::Points;
use taut::recognize::classify::Labeled;
use taut::recognize::hand::Side;
use taut::recognize::template::{Matcher, MatcherOptions, SCANS_MAX};

use super::scans::Images;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::output::numbers::{count, short};
use crate::output::writing::{self, Outputs};

/// What ends the name of a person in the name of a file.
const SEPARATOR: &str = "-scan-";
/// Bytes of a matcher's file, at most.
const MATCHER_BYTES_MAX: u64 = 1 << 26;

/// Learn from scans how much scans of one person differ, and set the threshold of verification.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Files are named PERSON-scan-NUMBER with an extension, as `taut hand synthesize` does. Half of the people teach the \
whitening, a quarter the threshold, and on the last quarter the error rates are measured. Images that show no \
measurable hand are left out and counted. Left and right hands are learned together, and the summary counts them. The \
rates hold for people, scanners and poses like those of the folder: of synthetic hands they say nothing about people.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut hand train scans -o matcher.json --source 'synthetic hands'")]
pub(crate) struct Args {
    /// The folder of images in PNG, JPEG or TIFF
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Where to write the matcher, as JSON
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// The share of impostor comparisons that may be accepted, from 0 and below 1
    #[arg(long, value_name = "REAL", default_value_t = MatcherOptions::default().fmr_max)]
    fmr: f64,
    /// Scans of each person that make a template in the measurement; the others are compared with it
    #[arg(long = "template-scans", alias = "scans", value_name = "N", default_value_t = MatcherOptions::default().enrolled)]
    scans: usize,
    /// Where the scans are from, in words that the matcher keeps
    #[arg(long, value_name = "WORDS", default_value = "scans of unknown origin")]
    source: String,
    /// The seed of the split of people
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    images: Images,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        writing::check_writable(&[&self.out], &[])?;
        writing::check_json(&self.out, "-o")?;
        if !(0.0..1.0).contains(&self.fmr) {
            bail!("option `--fmr` is {}: expected a number from 0, below 1", self.fmr);
        }
        if !(1..SCANS_MAX as usize).contains(&self.scans) {
            bail!("option `--template-scans` is {}: expected from 1 to 999", self.scans);
        }
        let files = self.files()?;
        let paths: Vec<PathBuf> = files.iter().map(|file| file.1.clone()).collect();
        let watch = self.effort.start()?;
        let scans = watch.during("measuring scans", |_| self.images.measurable(&paths))?;
        let (mut values, mut labels) = (vec![], vec![]);
        let mut numbers = BTreeMap::new();
        let mut hands = Hands::default();
        for ((person, _), scan) in files.iter().zip(&scans) {
            let Some(scan) = scan else { continue };
            let next = numbers.len() as u32;
            labels.push(*numbers.entry(person.clone()).or_insert(next));
            hands.count(person, scan.side);
            values.extend_from_slice(&scan.features);
        }
        // Names come in order, so that numbers do, too.
        let names: Vec<String> = numbers.into_keys().collect();
        if labels.is_empty() {
            bail!("{}: no image shows a hand that can be measured", self.folder.display());
        }
        let points = Points::new(&values, values.len() / labels.len())?;
        let options = MatcherOptions {
            fmr_max: self.fmr,
            enrolled: self.scans,
            source: self.source.clone(),
            seed: self.seed,
        };
        let matcher = Matcher::train(Labeled::new(points, &labels, &names)?, &options)?;
        let mut outputs = Outputs::default();
        outputs.add(&self.out, (matcher.to_json() + "\n").as_bytes())?;
        if !self.effort.quiet && !writing::is_stream(&self.out) {
            outputs.print(&summary(&matcher, names.len(), labels.len(), files.len(), &hands));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    /// The images of the folder with the names of their people, in order.
    fn files(&self) -> anyhow::Result<Vec<(String, PathBuf)>> {
        let folder = self.folder.display();
        let mut files = vec![];
        let entries = std::fs::read_dir(&self.folder).with_context(|| format!("{folder}"));
        for entry in entries.map_err(|error| anyhow!("{error:#}"))? {
            let path = entry.map_err(|error| anyhow!("{folder}: {error}"))?.path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if let Some((person, _)) = name.rsplit_once(SEPARATOR) {
                files.push((person.to_owned(), path));
            }
        }
        files.sort();
        match files.is_empty() {
            true => bail!("{folder}: no file is named PERSON{SEPARATOR}NUMBER"),
            false => Ok(files),
        }
    }
}

/// Scans of either hand.
#[derive(Default)]
struct Hands {
    left: u64,
    right: u64,
    /// For each person whether there is a left hand, and a right one.
    people: BTreeMap<String, [bool; 2]>,
}

impl Hands {
    fn count(&mut self, person: &str, side: Side) {
        let [left, right] = self.people.entry(person.to_owned()).or_default();
        match side {
            Side::Left => (self.left, *left) = (self.left + 1, true),
            Side::Right => (self.right, *right) = (self.right + 1, true),
        }
    }

    fn to_words(&self) -> String {
        let both = self.people.values().filter(|hands| **hands == [true; 2]).count() as u64;
        let mixed = match (self.left.min(self.right), both) {
            (0, _) => String::new(),
            (_, 0) => "; the matcher is one for both".to_owned(),
            (_, both) => format!(
                "; both of {}, and compared as one hand: name the hands of a person as two people",
                if both == 1 { "1 person".to_owned() } else { format!("{} people", count(both)) }
            ),
        };
        format!("{} right, {} left{mixed}", count(self.right), count(self.left))
    }
}

fn summary(
    matcher: &Matcher,
    people: usize,
    measured: usize,
    files: usize,
    hands: &Hands,
) -> String {
    let rates = matcher.rates();
    format!(
        "A matcher of {} scans of {} people; {} of {} images show no measurable hand\n  \
         hands      {}\n  \
         threshold  {}\n  \
         FMR        {} of {} comparisons (evidence)\n  \
         FNMR       {} of {} comparisons (evidence)\n",
        count(measured as u64),
        count(people as u64),
        count((files - measured) as u64),
        count(files as u64),
        hands.to_words(),
        short(matcher.threshold()),
        count(rates.false_matches),
        count(rates.impostor),
        count(rates.false_non_matches),
        count(rates.genuine)
    )
}

/// Reads a matcher that this command wrote.
pub(super) fn read_matcher(path: &Path) -> anyhow::Result<Matcher> {
    use std::io::Read;
    let name = path.display();
    let mut text = String::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MATCHER_BYTES_MAX).read_to_string(&mut text))
        .map_err(|error| anyhow!("{name}: {error}"))?;
    Matcher::from_json(&text).map_err(|error| anyhow!("{name}: {error}"))
}
