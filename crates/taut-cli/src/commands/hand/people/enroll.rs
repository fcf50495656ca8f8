//! `taut hand enroll`.

use std::path::PathBuf;

use anyhow::bail;
use serde_json::json;
use taut::recognize::store::{Store, StoreOptions};
use taut::recognize::template::Matcher;

use super::open::StoreArgs;
use super::scans::Images;
use super::train::read_matcher;
use crate::exit::Outcome;
use crate::output::numbers::counted;
use crate::output::writing;

/// Enroll a person in a store, by scans of one hand.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Three scans or more make errors fewer. The store keeps their mean after whitening, encrypted, and no images. A scan \
that differs from the others more than scans of one hand do is refused. The default matcher was learned from synthetic \
hands: `taut hand train` learns one from scans of your scanner, and --model takes it. The name is not printed, but \
other users of the machine may see the command while it runs.
Exit: 0 enrolled · 2 bad input or usage, or an image that gives no reliable features;
        nobody is enrolled
Example: taut hand enroll --create --store people --key key --person Ada \\
             ada-1.png ada-2.png ada-3.png")]
pub(crate) struct Args {
    /// Scans of one hand of the person, in PNG, JPEG or TIFF
    #[arg(value_name = "IMAGE", required = true)]
    paths: Vec<PathBuf>,
    /// The name of the person
    #[arg(long, value_name = "NAME")]
    person: String,
    #[command(flatten)]
    store: StoreArgs,
    /// Make the store, which must not exist
    #[arg(long, help_heading = "Store")]
    create: bool,
    /// The matcher of the new store, from `taut hand train` [default: learned from synthetic hands]
    #[arg(long, value_name = "FILE", requires = "create", help_heading = "Store")]
    model: Option<PathBuf>,
    /// Failed verifications in sequence that lock a person of the new store [default: 5]
    #[arg(long, value_name = "N", requires = "create", help_heading = "Store")]
    failures: Option<u32>,
    #[command(flatten)]
    images: Images,
    /// Write JSON instead of words
    #[arg(long, help_heading = "Writing")]
    json: bool,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let mut options = StoreOptions::default();
        if let Some(failures) = self.failures {
            if failures == 0 {
                bail!("option `--failures` is 0: expected at least 1");
            }
            options.failures_max = failures;
        }
        let model = self.model.as_deref().map(read_matcher).transpose()?;
        let scans = self.images.scans(&self.paths)?;
        let enroll = |store: &mut Store| Ok(store.enroll(&self.person, &scans)?);
        let number = match self.create {
            true => {
                let matcher = model.as_ref().unwrap_or_else(|| Matcher::of_synthetic_hands());
                self.store.with_new(matcher, &options, enroll)?
            }
            false => self.store.with(enroll)?,
        };
        let text = match self.json {
            true => json!({ "number": number, "scans": scans.len() }).to_string(),
            false => {
                let scans = counted(scans.len() as u64, "scan");
                format!("Enrolled as person number {number} by {scans}")
            }
        };
        writing::print((text + "\n").as_bytes())?;
        Ok(Outcome::Done)
    }
}
