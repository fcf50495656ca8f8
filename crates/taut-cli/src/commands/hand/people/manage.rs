//! `taut hand list`, `unlock` and `delete`.

use serde_json::json;
use taut::recognize::hand::Side;
use taut::recognize::store::Person;

use super::open::StoreArgs;
use crate::exit::Outcome;
use crate::output::numbers::count;
use crate::output::writing::{self, printable};

/// List the people of a store.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Columns: number, hand, scans, failed verifications since the last accepted one, and with --names the name.
With --json the manifest is there, too: kept elsewhere, it is what --manifest takes.
Exit: 0 done · 2 bad input or usage
Example: taut hand list --store people --key key --names")]
pub(crate) struct ListArgs {
    #[command(flatten)]
    store: StoreArgs,
    /// Print the names as well
    #[arg(long, help_heading = "Writing")]
    names: bool,
    /// Write JSON instead of words
    #[arg(long, help_heading = "Writing")]
    json: bool,
}

/// Clear the failed verifications of a person, who may be locked.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Exit: 0 done · 2 bad input or usage, or no such person
Example: taut hand unlock --store people --key key --person Ada")]
pub(crate) struct UnlockArgs {
    /// The name of the person
    #[arg(long, value_name = "NAME")]
    person: String,
    #[command(flatten)]
    store: StoreArgs,
}

/// Delete a person from a store, for good.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The bytes of the person are overwritten in the file, which is then compacted. Copies of the file are not touched.
Exit: 0 done · 2 bad input or usage, or no such person
Example: taut hand delete --store people --key key --person Ada")]
pub(crate) struct DeleteArgs {
    /// The name of the person
    #[arg(long, value_name = "NAME")]
    person: String,
    #[command(flatten)]
    store: StoreArgs,
}

impl ListArgs {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        self.store.with(|store| {
            let people = store.people()?;
            let text = match self.json {
                true => {
                    let people: Vec<_> = people.iter().map(|person| self.fields(person)).collect();
                    let manifest = store.manifest().to_string();
                    json!({ "people": people, "manifest": manifest }).to_string() + "\n"
                }
                false => {
                    let rates = store.matcher().rates();
                    let head = format!(
                        "{} enrolled; matcher of {}, FMR {} of {}, FNMR {} of {} (evidence)\n",
                        count(people.len() as u64),
                        printable(store.matcher().source()),
                        count(rates.false_matches),
                        count(rates.impostor),
                        count(rates.false_non_matches),
                        count(rates.genuine)
                    );
                    people.iter().fold(head, |text, person| text + &self.line(person))
                }
            };
            writing::print(text.as_bytes())?;
            Ok(Outcome::Done)
        })
    }

    fn fields(&self, person: &Person) -> serde_json::Value {
        let mut fields = json!({
            "number": person.number,
            "hand": hand(person),
            "scans": person.scans,
            "failures": person.failures,
            "locked": person.is_locked,
        });
        if self.names {
            fields["name"] = json!(person.name);
        }
        fields
    }

    fn line(&self, person: &Person) -> String {
        let Person { number, scans, failures, .. } = person;
        let mut line = format!("  {number:>6}  {:<5}  {scans:>4}  {failures:>4}", hand(person));
        if person.is_locked {
            line += " locked";
        }
        if self.names {
            line += &format!("  {}", printable(&person.name));
        }
        line + "\n"
    }
}

fn hand(person: &Person) -> &'static str {
    match person.side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

impl UnlockArgs {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        self.store.with(|store| Ok(store.unlock(&self.person)?))?;
        Ok(Outcome::Done)
    }
}

impl DeleteArgs {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        self.store.with(|store| Ok(store.delete(&self.person)?))?;
        Ok(Outcome::Done)
    }
}
