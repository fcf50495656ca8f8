//! One attack: forgeries of all cases of a kind against the checker, and an oracle for each that it lets pass.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use taut::AnySolution;

use crate::cases::Case;
use crate::forge::{Forger, Forgery};
use crate::oracle::{CaseOracle, Interval, Truth};

use crate::random::Random;
use crate::test_length::long_or;

/// Forgeries of each kind where `TAUT_FORGERIES` does not say another number, in long tests.
const FORGERIES_LONG: u64 = 1000;
/// The same in other tests.
const FORGERIES_SHORT: u64 = 400;

/// Undecided oracle calls are to be fewer than one in so many accepted forgeries.
const UNDECIDED_ONE_IN: u64 = 1000;

/// At most this many failures are shown in full.
const SHOWN_FAILURES_MAX: usize = 12;

/// The result of an attack.
#[derive(Default)]
pub struct Tally {
    pub forgeries: u64,
    pub unread: u64,
    pub refused: u64,
    pub accepted: u64,
    pub oracle_calls: u64,
    pub undecided: u64,
    pub slowest: Duration,
    /// Why answers were refused, by the head of the message.
    pub reasons: BTreeMap<String, u64>,
    /// False answers that were accepted, and why they are false.
    pub failures: Vec<String>,
    pub doubts: BTreeSet<String>,
}

impl Tally {
    /// Prints the counts, and fails where a false answer was accepted or too much is undecided.
    pub fn report(&self, kind: &str) {
        let slowest = self.slowest.as_millis();
        println!(
            "{kind}: {} forgeries, {} parse errors, {} refused for {} reasons, {} accepted, {} oracle calls, {} undecided; \
             slowest check {slowest} ms",
            self.forgeries,
            self.unread,
            self.refused,
            self.reasons.len(),
            self.accepted,
            self.oracle_calls,
            self.undecided,
        );
        for doubt in self.doubts.iter().take(SHOWN_FAILURES_MAX) {
            println!("  undecided: {doubt}");
        }
        if std::env::var_os("TAUT_FORGER_REASONS").is_some() {
            for (reason, count) in &self.reasons {
                println!("  {count:>8} {reason}");
            }
        }
        assert!(
            self.failures.is_empty(),
            "{kind}: {} false answers were accepted:\n{}",
            self.failures.len(),
            self.failures.iter().take(SHOWN_FAILURES_MAX).cloned().collect::<Vec<_>>().join("\n")
        );
        assert!(self.accepted > 0, "{kind}: no forgery was accepted, so no oracle was asked");
        assert!(
            self.undecided * UNDECIDED_ONE_IN <= self.accepted,
            "{kind}: {} of {} oracle calls were undecided",
            self.undecided,
            self.oracle_calls
        );
    }

    /// Counts why an answer was refused.
    pub fn refuse(&mut self, reason: &str) {
        self.refused += 1;
        // Numbers and names differ between refusals for one reason.
        let head: String =
            reason.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }).collect();
        let words: Vec<&str> = head.split_whitespace().filter(|word| !word.contains('#')).collect();
        *self.reasons.entry(words.join(" ")).or_default() += 1;
    }

    /// Notes what an oracle said.
    pub fn note(&mut self, truth: Truth, told: &dyn Fn() -> String) {
        self.oracle_calls += 1;
        match truth {
            Truth::True => {}
            Truth::False(reason) => self.failures.push(format!("FALSE: {reason}\n{}", told())),
            Truth::Undecided(reason) => {
                self.undecided += 1;
                if self.doubts.len() < SHOWN_FAILURES_MAX {
                    self.doubts.insert(format!("{reason}\n{}", told()));
                }
            }
        }
    }
}

/// Returns how many forgeries are to be made of a kind.
pub fn budget() -> u64 {
    let wanted = std::env::var("TAUT_FORGERIES").ok().and_then(|count| count.parse().ok());
    wanted.unwrap_or(long_or(FORGERIES_LONG, FORGERIES_SHORT))
}

/// Judges the documents of the solvers, then forges those of all cases in turn, and judges what the checker lets pass.
pub fn attack(kind: &'static str, cases: &[Case]) -> Tally {
    let mut attack = Attack::new(kind, cases);
    attack.judge_solvers();
    for number in 0..budget() {
        let at = (number % cases.len() as u64) as usize;
        attack.forge(at, Some(number), &mut Random::new(kind, number));
    }
    attack.tally
}

/// An attack under way.
pub struct Attack<'a> {
    kind: &'static str,
    tally: Tally,
    cases: Vec<Attacked<'a>>,
}

/// A case, what forges its documents, what knows the truth about it, and what was said of it.
struct Attacked<'a> {
    case: &'a Case,
    forger: Forger,
    oracle: CaseOracle<'a>,
    ledger: Ledger,
}

impl<'a> Attack<'a> {
    /// Prepares an attack.
    pub fn new(kind: &'static str, cases: &'a [Case]) -> Self {
        let attacked = |case: &'a Case| Attacked {
            case,
            forger: Forger::new(&case.own, &case.foreign),
            oracle: CaseOracle::new(&case.input),
            ledger: Ledger::default(),
        };
        Attack { kind, tally: Tally::default(), cases: cases.iter().map(attacked).collect() }
    }

    /// Checks the documents as solvers wrote them.
    fn judge_solvers(&mut self) {
        let (kind, tally) = (self.kind, &mut self.tally);
        for Attacked { case, oracle, .. } in &mut self.cases {
            for (way, document) in &case.own {
                let forgery = Forgery { text: document.to_string(), edits: vec![way.clone()] };
                let told = || told(kind, None, case, &forgery);
                let solution = AnySolution::from_json(&forgery.text).expect("a solver writes JSON");
                match case.input.check(&solution) {
                    Ok(verdict) => tally.note(oracle.judge(&solution, &verdict), &told),
                    // That is a fault of the solver or of the checker, and no false claim.
                    Err(error) => {
                        println!("{kind}: the answer of a solver is refused: {error}\n{}", told())
                    }
                }
            }
        }
    }

    /// Makes one forgery of any case.
    ///
    /// # Panics
    /// When a false answer is accepted.
    pub fn forge_any(&mut self, random: &mut Random) {
        self.forge(random.below(self.cases.len()), None, random);
        assert!(self.tally.failures.is_empty(), "{}", self.tally.failures.join("\n"));
    }

    /// Makes one forgery of a case and judges it if the checker lets it pass.
    fn forge(&mut self, at: usize, number: Option<u64>, random: &mut Random) {
        let (kind, tally) = (self.kind, &mut self.tally);
        let Attacked { case, forger, oracle, ledger } = &mut self.cases[at];
        let forgery = forger.forge(random);
        let told = || told(kind, number, case, &forgery);
        tally.forgeries += 1;
        let Ok(solution) = AnySolution::from_json(&forgery.text) else {
            tally.unread += 1;
            return;
        };
        let begin = Instant::now();
        let checked = case.input.check(&solution);
        tally.slowest = tally.slowest.max(begin.elapsed());
        match checked {
            Err(error) => tally.refuse(&error.to_string()),
            Ok(verdict) => {
                tally.accepted += 1;
                tally.note(oracle.judge(&solution, &verdict), &told);
                let intervals = oracle.intervals(&solution, &verdict);
                let contradictions = intervals.into_iter().filter_map(|i| ledger.enter(i, &told));
                tally.failures.extend(contradictions);
            }
        }
    }
}

/// The forgery, so that it can be made again.
fn told(kind: &str, number: Option<u64>, case: &Case, forgery: &Forgery) -> String {
    let number = number.map_or(String::new(), |number| format!(" forgery {number},"));
    let text = match forgery.text.len() {
        0..2500 => forgery.text.clone(),
        _ => head_of(&forgery.text),
    };
    let values = match case.input.values.len() {
        0..60 => format!("\n  rows of {}: {:?}", case.input.columns, case.input.values),
        _ => String::new(),
    };
    let edits = forgery.edits.join("\n  ");
    format!("{kind},{number} of {}\n  {edits}\n  {text}{values}", case.input.name)
}

/// A document that is too long to be shown: the start of it.
fn head_of(text: &str) -> String {
    text.chars().take(2500).chain(" …".chars()).collect()
}

/// The narrowest bracket of each optimum that was verified so far, and by which forgery.
#[derive(Default)]
struct Ledger(BTreeMap<String, [(f64, String); 2]>);

impl Ledger {
    /// Enters a bracket; says so if it excludes another one of the same optimum.
    fn enter(&mut self, interval: Interval, told: &dyn Fn() -> String) -> Option<String> {
        let Interval { optimum, lower, upper } = interval;
        let Some([most, least]) = self.0.get_mut(&optimum) else {
            self.0.insert(optimum, [(lower, told()), (upper, told())]);
            return None;
        };
        if lower > most.0 {
            *most = (lower, told());
        }
        if upper < least.0 {
            *least = (upper, told());
        }
        (most.0 > least.0).then(|| {
            let text = format!(
                "CONTRADICTION: {optimum} is at least {:?} and at most {:?}\nat least: {}\nat most: {}",
                most.0, least.0, most.1, least.1
            );
            // Each contradiction is told once.
            *most = (f64::NEG_INFINITY, String::new());
            text
        })
    }
}
