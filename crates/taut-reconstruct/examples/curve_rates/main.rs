//! Prints rates of curve reconstruction over drawn inputs of every class, beside what is asked of each.
//!
//! `cargo run --release -p taut-reconstruct --example curve_rates -- [SECTION]... [OPTION]...`; options are `--full`,
//! `--held-back SEED`, `--save FILE` and `--baseline FILE`.
//!
//! Sections: `smooth`, `borders`, `noisy`, `certificates`, `concentric`, `folds`; all of them if none is named. Each class is drawn from two
//! halves of fixed seeds: the tuning half, from 0 on, on which thresholds may be chosen, and the held-back half, from [`HELD_BACK`] on, which
//! no choice looks at, or from another seed beyond, that was never drawn (`--held-back`). The usual size takes minutes, `--full` is the size of
//! the claims. `--save` writes a line for each draw; another build compares itself with such a file draw by draw (`--baseline`) and prints what
//! it lost and gained.

#[path = "../../tests/reconstruct/curve_scenes/mod.rs"]
mod curve_scenes;

mod baseline;
mod borders;
mod certificates;
mod noisy;
mod record;
mod smooth;
mod spaced;

use std::error::Error;
use std::ops::Range;

use record::Draw;
use taut_certify::{Curve, Solution};
use taut_points::Points;
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

/// The first seed of the held-back half.
const HELD_BACK: u64 = 2_000_000;

/// A group of classes: its name, how it prints its draws, and how many draws of each class it takes from each half, usually and at full
/// size.
struct Section {
    name: &'static str,
    draws: [u64; 2],
    draw: fn(Range<u64>) -> Vec<Draw>,
    print: fn(&[Draw]),
}

const SECTIONS: [Section; 6] = [
    Section { name: "smooth", draws: [8, 100], draw: smooth::draw, print: smooth::print },
    Section { name: "borders", draws: [30, 100], draw: borders::draw, print: record::print },
    Section { name: "noisy", draws: [20, 100], draw: noisy::draw, print: record::print },
    Section {
        name: "certificates",
        draws: [12, 620],
        draw: certificates::draw,
        print: certificates::print,
    },
    Section {
        name: "concentric",
        draws: [20, 100],
        draw: spaced::concentric,
        print: record::print,
    },
    Section { name: "folds", draws: [20, 100], draw: spaced::folds, print: record::print },
];

/// The methods for points without noise, of which the best is the measure of `auto`.
const CLEAN: [CurveMethod; 4] =
    [CurveMethod::NnCrust, CurveMethod::HnnCrust, CurveMethod::OneStepCrust, CurveMethod::Corners];

/// The curves of pairs of coordinates.
fn solve(values: &[f64], method: CurveMethod) -> Solution<Curve> {
    let points = Points::new(values, 2).expect("pairs");
    let options = CurveOptions { method, ..Default::default() };
    curve(&points, &options).expect("finite points of the plane")
}

/// What the command line asks for.
#[derive(Default)]
struct Options {
    sections: Vec<String>,
    is_full: bool,
    held_back: Option<u64>,
    save: Option<String>,
    baseline: Option<String>,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let mut options = Self::default();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--full" => options.is_full = true,
                "--held-back" => {
                    let seed: u64 = words.next().ok_or("--held-back needs a seed")?.parse()?;
                    options.held_back = Some(seed).filter(|&seed| seed >= HELD_BACK);
                    options.held_back.ok_or(format!("held-back seeds are {HELD_BACK} or more"))?;
                }
                "--save" => options.save = Some(words.next().ok_or("--save needs a file")?),
                "--baseline" => {
                    options.baseline = Some(words.next().ok_or("--baseline needs a file")?);
                }
                name if SECTIONS.iter().any(|section| section.name == name) => {
                    options.sections.push(word);
                }
                _ => {
                    let names = SECTIONS.map(|section| section.name).join(", ");
                    return Err(format!("unknown word {word:?}; sections: {names}").into());
                }
            }
        }
        Ok(options)
    }

    fn asks_for(&self, section: &Section) -> bool {
        self.sections.is_empty() || self.sections.iter().any(|name| name == section.name)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse(std::env::args().skip(1))?;
    let before = options.baseline.as_deref().map(baseline::read).transpose()?;
    let mut all = vec![];
    for section in SECTIONS.iter().filter(|section| options.asks_for(section)) {
        let count = section.draws[usize::from(options.is_full)];
        println!("\n{}: {count} seeds of each half", section.name);
        let mut draws = (section.draw)(0..count);
        let held_back = options.held_back.unwrap_or(HELD_BACK);
        draws.extend((section.draw)(held_back..held_back + count));
        (section.print)(&draws);
        if let Some(before) = &before {
            baseline::compare(before, section.name, &draws);
        }
        all.extend(draws.into_iter().map(|draw| (section.name, draw)));
    }
    if let Some(file) = &options.save {
        baseline::write(file, &all)?;
    }
    Ok(())
}
