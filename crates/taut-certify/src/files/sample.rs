//! The checker of a sample: the numbers are drawn again, from their definition in docs/memory/sample.md.
//!
//! *Idea.* The definition is a tree of ranges and, at its leaves, numbers drawn until enough are different. It is walked
//! from left to right, so that numbers come in order and are compared with the lines of the file one by one.
//! *Guarantee.* Exact: the file is the one that the seed gives, so its numbers are different, in order and below n.
//! *Trap.* Probabilities are compared with a random number in double precision, so the order of the operations is a part of
//! the definition. How many numbers there are is what the JSON says: a file too short for them is refused before any is drawn.

mod random;

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use taut_points::Monitor;

use self::random::{Random, fall_below};
use super::bytes::Source;
use super::{FileAnswer, FileCheckError, FileVerdict, FileViolation, Files, WhichFile};

/// A file of numbers drawn without replacement, one in a line, in order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a sample: an object with of and drawn")]
pub struct DrawnSample {
    /// The number of numbers to choose from: 0 to `of` − 1.
    pub of: u64,
    /// The number of draws.
    pub drawn: u64,
}

/// The data that reproduce the numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the certificate of a sample: an object with seed")]
pub struct SampleCertificate {
    /// The seed they were drawn with.
    pub seed: u64,
}

/// A range of numbers from which so many are drawn.
struct Range {
    node: u64,
    start: u64,
    n: u64,
    k: u64,
}

/// Up to this many numbers are drawn without dividing the range.
const LEAF_SIZE: u64 = 4096;

impl FileAnswer for DrawnSample {
    type Certificate = SampleCertificate;
    const KIND: &'static str = "sample";

    fn check(
        &self,
        certificate: &SampleCertificate,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        if self.drawn > self.of {
            let (what, value) = ("drawn", self.drawn.to_string());
            let expected = "at most the number of those to choose from";
            return Err(FileViolation::Number { what, value, expected }.into());
        }
        if files.input.is_some() {
            return Err(FileCheckError::NoInput);
        }
        let mut output = Source::new(WhichFile::Output, files.output)?;
        // A digit for each number, and a line feed between any two.
        let least = (2 * u128::from(self.drawn)).saturating_sub(1);
        if u128::from(output.length) < least {
            let (file, found, lines) = (output.which, output.length, self.drawn);
            return Err(FileViolation::Short { file, found, lines, least }.into());
        }
        let mut numbers = Numbers::new(certificate.seed, self.of, self.drawn);
        let mut line = 0;
        let differs = |line, found, expected| {
            let file = WhichFile::Output;
            FileCheckError::from(FileViolation::Drawn { file, line, found, expected })
        };
        let nothing = || "nothing".to_owned();
        monitor.pass(1, self.drawn);
        output.lines(monitor, |text| {
            line += 1;
            let expected = numbers.next().map(|number| number.to_string());
            // After the last number no line is expected, whatever it says.
            if expected.as_ref().is_some_and(|expected| text == expected.as_bytes()) {
                return Ok(());
            }
            let found = String::from_utf8_lossy(text).into_owned();
            Err(differs(line, found, expected.unwrap_or_else(nothing)))
        })?;
        if let Some(number) = numbers.next() {
            return Err(differs(line + 1, nothing(), number.to_string()));
        }
        monitor.points(self.drawn);
        Ok(FileVerdict { items: self.drawn, compared: false })
    }
}

/// The numbers that a seed gives, in order.
struct Numbers {
    seed: u64,
    /// Ranges still to come, the next one last.
    open: Vec<Range>,
    /// Numbers of the range that was last, the next one last.
    ready: Vec<u64>,
}

impl Numbers {
    fn new(seed: u64, n: u64, k: u64) -> Self {
        Self { seed, open: vec![Range { node: 1, start: 0, n, k }], ready: Vec::new() }
    }
}

impl Iterator for Numbers {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        while self.ready.is_empty() {
            let Range { node, start, n, k } = self.open.pop()?;
            let mut random = Random::of_node(self.seed, node);
            if k <= LEAF_SIZE {
                self.ready = leaf(&mut random, start, n, k);
                continue;
            }
            let half = n / 2;
            let below = fall_below(&mut random, n, half, k);
            let (left, right) = (node.wrapping_mul(2), node.wrapping_mul(2).wrapping_add(1));
            self.open.push(Range { node: right, start: start + half, n: n - half, k: k - below });
            self.open.push(Range { node: left, start, n: half, k: below });
        }
        self.ready.pop()
    }
}

/// Draws until enough are different; of more than half of a range, those that are left out. The last comes first.
fn leaf(random: &mut Random, start: u64, n: u64, k: u64) -> Vec<u64> {
    let few = k.min(n - k);
    let mut drawn = BTreeSet::new();
    while (drawn.len() as u64) < few {
        drawn.insert(random.below(n));
    }
    if k == few {
        return drawn.into_iter().rev().map(|number| start + number).collect();
    }
    (0..n).rev().filter(|number| !drawn.contains(number)).map(|number| start + number).collect()
}
