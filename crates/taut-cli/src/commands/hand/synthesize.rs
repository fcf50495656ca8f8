//! `taut hand synthesize`.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use anyhow::Context;
use rayon::prelude::*;
use taut::recognize::hand::synthetic::{Generator, Rates, Scan};
use taut::recognize::hand::{FEATURE_NAMES, Side};
use taut_io::create_folder;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::wrong_option;
use crate::output::writing::Outputs;

/// Scans of one call, at most.
const SCANS_MAX: u64 = 1_000_000;

/// The table of the folder.
const TRUTH: &str = "truth.csv";

/// Returns a test of whether a file is of an earlier run to this folder, by the table that is there.
fn own_files(folder: &Path) -> impl Fn(&Path) -> bool {
    let table = std::fs::read_to_string(folder.join(TRUTH)).unwrap_or_default();
    let rows = table.strip_prefix(&header()).unwrap_or_default();
    let mut names: HashSet<String> =
        rows.lines().filter_map(|row| row.split(',').next()).map(str::to_owned).collect();
    if !names.is_empty() {
        names.insert(TRUTH.to_owned());
    }
    move |path| path.file_name().and_then(|name| name.to_str()).is_some_and(|n| names.contains(n))
}

/// Make synthetic scans of hands as PNG files, with a table of what they show.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A folder of an earlier run is replaced if it has nothing but its files. It gets a file for each scan, such as \
person-0000-scan-00.png, and truth.csv: the defect of the scan if it has one, the tips and valleys in pixels, and the \
features of the outline before it became pixels. People are drawn by published statistics of hands; colors and noise \
are design values, so that figures on these scans are no error rates of people.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut hand synthesize scans --people 70 --scans 10 --seed 1")]
pub(super) struct Args {
    /// The folder to make or to replace
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// People, at least 1
    #[arg(long, value_name = "N", default_value_t = 10)]
    people: u64,
    /// Scans of each, at least 1
    #[arg(long, value_name = "N", default_value_t = 10)]
    scans: u64,
    /// Dots per inch, 40 to 600
    #[arg(long, value_name = "REAL", default_value_t = Generator::default().dots_per_inch)]
    dpi: f64,
    /// Left hands in place of right ones
    #[arg(long)]
    left: bool,
    /// No defects but those of pose
    #[arg(long)]
    clean: bool,
    /// The seed of people and scans
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let generator = self.generator()?;
        let folder = create_folder(&self.folder, own_files(&self.folder))?;
        let watch = self.effort.start()?;
        let all: Vec<(u64, u64)> =
            (0..self.people).flat_map(|p| (0..self.scans).map(move |s| (p, s))).collect();
        let lines = watch.during("making scans", |monitor| {
            let make = |&(person, scan): &(u64, u64)| -> anyhow::Result<String> {
                monitor.check()?;
                let name = format!("person-{person:04}-scan-{scan:02}.png");
                let made = generator.scan(person, scan);
                std::fs::write(folder.path().join(&name), made.image.to_png()?)
                    .with_context(|| format!("{}: {name}", self.folder.display()))?;
                Ok(line(&name, person, scan, &made))
            };
            all.par_iter().map(make).collect::<anyhow::Result<Vec<String>>>()
        })?;
        std::fs::write(folder.path().join(TRUTH), header() + &lines.concat())
            .with_context(|| format!("{}: {TRUTH}", self.folder.display()))?;
        let mut outputs = Outputs::default();
        outputs.hold_folder(folder);
        if !self.effort.quiet {
            outputs.print(&format!(
                "{} scans of {} people in {}\n",
                all.len(),
                self.people,
                self.folder.display()
            ));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    fn generator(&self) -> anyhow::Result<Generator> {
        let wrong = |name, value: String, expected| Err(wrong_option(name, &value, expected));
        if self.people.saturating_mul(self.scans) > SCANS_MAX {
            let expected = "people times scans of at most 1000000";
            return wrong("people", self.people.to_string(), expected);
        }
        if self.people == 0 || self.scans == 0 {
            let name = if self.people == 0 { "people" } else { "scans" };
            return wrong(name, "0".to_owned(), "at least 1");
        }
        if !(40.0..=600.0).contains(&self.dpi) {
            return wrong("dpi", self.dpi.to_string(), "a number from 40 to 600");
        }
        let none =
            Rates { cut_off: 0.0, lifted: 0.0, ring: 0.0, bandage: 0.0, fused: 0.0, sleeve: 0.0 };
        Ok(Generator {
            seed: self.seed,
            side: if self.left { Side::Left } else { Side::Right },
            dots_per_inch: self.dpi,
            rates: if self.clean { none } else { Rates::default() },
        })
    }
}

fn header() -> String {
    let mut names =
        vec!["file".to_owned(), "person".into(), "scan".into(), "cut_off".into(), "defect".into()];
    for (what, count) in [("tip", 5), ("valley", 4)] {
        names.extend((0..count).flat_map(|i| ["x", "y"].map(|axis| format!("{what} {i} {axis}"))));
    }
    names.extend(FEATURE_NAMES.map(str::to_owned));
    names.join(",") + "\n"
}

fn line(name: &str, person: u64, scan: u64, made: &Scan) -> String {
    let truth = &made.truth;
    let defect = truth.defect.map_or(String::new(), |defect| format!("\"{defect:?}\""));
    let mut fields = vec![
        name.to_owned(),
        person.to_string(),
        scan.to_string(),
        truth.is_cut_off.to_string(),
        defect,
    ];
    fields.extend(truth.tips.iter().chain(&truth.valleys).flatten().map(|x| format!("{x:?}")));
    match &truth.features {
        Some(features) => fields.extend(features.iter().map(|x| format!("{x:?}"))),
        None => fields.extend(FEATURE_NAMES.map(|_| String::new())),
    }
    fields.join(",") + "\n"
}
