//! `taut hand verify` and `taut hand identify`.

use std::path::PathBuf;

use serde_json::{Value, json};
use taut::recognize::store::Store;

use super::open::StoreArgs;
use super::scans::Images;
use crate::exit::Outcome;
use crate::output::numbers::{count, counted, short};
use crate::output::writing::{self, printable};

/// Verify that a scan is one of an enrolled person.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each comparison counts as failed until it is accepted; several failures in sequence lock the person, until `taut hand \
unlock`. Scores are not told unless --scores asks for them, as they help to improve a forged hand step by step.
Exit: 0 accepted · 1 rejected · 2 not compared: bad input or usage, no such person, or a locked one
Example: taut hand verify --store people --key key --person Ada scan.png")]
pub(crate) struct VerifyArgs {
    /// A scan of the hand that is enrolled
    #[arg(value_name = "IMAGE")]
    path: PathBuf,
    /// The name of the person
    #[arg(long, value_name = "NAME")]
    person: String,
    #[command(flatten)]
    store: StoreArgs,
    #[command(flatten)]
    images: Images,
    #[command(flatten)]
    answer: Answer,
}

/// Find the enrolled person whose hand a scan shows.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The answer is the nearest of all enrolled people, if it is as near as a verification asks for. Among n people an \
unknown hand has n chances to be near somebody's: the share of unknown people that may be named is told. Locked people \
are left out.
Exit: 0 somebody was found · 1 nobody was · 2 not compared: bad input or usage
Example: taut hand identify --store people --key key scan.png")]
pub(crate) struct IdentifyArgs {
    /// A scan
    #[arg(value_name = "IMAGE")]
    path: PathBuf,
    #[command(flatten)]
    store: StoreArgs,
    #[command(flatten)]
    images: Images,
    #[command(flatten)]
    answer: Answer,
}

/// How a decision is told.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Writing")]
struct Answer {
    /// Tell the distance and the threshold as well
    #[arg(long)]
    scores: bool,
    /// Write JSON instead of words
    #[arg(long)]
    json: bool,
}

impl Answer {
    /// A decision as text, printed once the manifest is written.
    fn text(
        &self,
        mut words: String,
        mut fields: Value,
        distance: Option<f64>,
        store: &Store,
    ) -> String {
        if self.scores {
            let threshold = store.matcher().threshold();
            // Nobody is as near as the threshold where no distance is known.
            let found = distance.map_or("larger".to_owned(), short);
            words += &format!("  distance  {found}; accepted up to {}\n", short(threshold));
            fields["distance"] = json!(distance);
            fields["threshold"] = json!(threshold);
        }
        if self.json { fields.to_string() + "\n" } else { words }
    }
}

impl VerifyArgs {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let scan = self.images.scan(&self.path)?;
        let (text, outcome) = self.store.with(|store| {
            let found = store.verify(&self.person, &scan)?;
            let words = match found.is_accepted {
                true => "Accepted\n".to_owned(),
                false => {
                    let left = counted(found.attempts_left.into(), "attempt");
                    format!("Rejected; {left} left\n")
                }
            };
            let fields =
                json!({ "accepted": found.is_accepted, "attempts_left": found.attempts_left });
            let text = self.answer.text(words, fields, Some(found.distance), store);
            Ok((text, if found.is_accepted { Outcome::Done } else { Outcome::CheckFailed }))
        })?;
        writing::print(text.as_bytes())?;
        Ok(outcome)
    }
}

impl IdentifyArgs {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let scan = self.images.scan(&self.path)?;
        let (text, outcome) = self.store.with(|store| {
            let index = store.index(scan.side)?;
            let found = store.identify(&index, &scan)?;
            let people = index.len() as u64;
            let risk = store.matcher().rates().chance_among(people);
            let mut words = match &found {
                Some(found) => format!("{}\n", printable(&found.name)),
                None => "Nobody\n".to_owned(),
            };
            words += &format!(
                "  compared with {}; an unknown hand is named with a probability of up to {} (estimate)\n",
                match people {
                    1 => "1 person".to_owned(),
                    _ => format!("{} people", count(people)),
                },
                short(risk)
            );
            let fields = json!({
                "person": found.as_ref().map(|found| &found.name),
                "number": found.as_ref().map(|found| found.number),
                "people": people,
                "false_match_estimate": risk,
            });
            let distance = found.as_ref().map(|found| found.distance);
            let text = self.answer.text(words, fields, distance, store);
            Ok((text, if found.is_some() { Outcome::Done } else { Outcome::CheckFailed }))
        })?;
        writing::print(text.as_bytes())?;
        Ok(outcome)
    }
}
