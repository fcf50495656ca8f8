//! What every area takes from the command line, and the sections of areas that have no cases with goals of their own.

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Result, ensure};
use serde_json::{Value, json};

use crate::context::Context;
use crate::select::select;

/// Which cases, and where what they measure goes.
#[derive(clap::Args)]
pub(crate) struct Choice {
    /// Cases to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    pub(crate) cases: Vec<String>,
    /// Show the cases and do nothing.
    #[arg(long)]
    list: bool,
    /// Inputs of about a tenth of their size, few rounds and few draws: to try the bench, not to quote.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Write everything that was measured to this file.
    #[arg(long)]
    pub(crate) json: Option<PathBuf>,
}

/// Something that runs by name.
pub(crate) trait Named {
    /// Its name on the command line, and what it shows.
    fn head(&self) -> [&'static str; 2];
}

impl Choice {
    /// Returns those of `all` that are meant; `None`, after showing them all, for `--list`.
    ///
    /// # Errors
    /// When a word means none.
    pub(crate) fn of<'a, C: Named>(&self, all: &'a [C], area: &str) -> Result<Option<Vec<&'a C>>> {
        if self.list {
            for [name, about] in all.iter().map(Named::head) {
                println!("{name:<24} {about}");
            }
            return Ok(None);
        }
        select(all, |case| case.head()[0], &self.cases, area).map(Some)
    }
}

/// Whether no two have one name.
#[cfg(test)]
pub(crate) fn are_unique<C: Named>(all: &[C]) -> bool {
    let names: std::collections::BTreeSet<_> = all.iter().map(|case| case.head()[0]).collect();
    names.len() == all.len()
}

/// A part of what has to be shown, whose measurements are one value of the report.
pub(crate) struct Section {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    pub(crate) run: Run,
}

/// How a section runs.
pub(crate) enum Run {
    /// On inputs of its own.
    Once(fn(&Context) -> Result<Value>),
    /// On so many draws of each input, unless the command line says otherwise.
    Drawn(u64, fn(&Context, Range<u64>) -> Result<Value>),
}

impl Named for Section {
    fn head(&self) -> [&'static str; 2] {
        [self.name, self.about]
    }
}

/// How often inputs are drawn.
#[derive(clap::Args)]
pub(crate) struct Draws {
    /// Draws of each input [default: those of the section].
    #[arg(long)]
    seeds: Option<u64>,
    /// The first seed.
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
}

impl Draws {
    /// Refuses to draw nothing.
    pub(crate) fn check(&self) -> Result<()> {
        ensure!(self.seeds != Some(0), "at least one seed");
        Ok(())
    }

    /// The seeds of a section that has `usual` draws.
    pub(crate) fn of(&self, usual: u64) -> Range<u64> {
        self.first_seed..self.first_seed + self.seeds.unwrap_or(usual)
    }
}

impl Context {
    /// Runs sections in order; `seeds` are those of one with so many draws.
    pub(crate) fn run_sections(
        &mut self,
        sections: Vec<&Section>,
        json: Option<&PathBuf>,
        seeds: impl Fn(u64) -> Range<u64>,
    ) -> Result<()> {
        self.run_all(sections, json, |context, section| {
            let measured = match section.run {
                Run::Once(run) => run(context)?,
                Run::Drawn(usual, run) => run(context, seeds(usual))?,
            };
            context.report.add(json!({ "name": section.name, "measured": measured }));
            Ok(())
        })
    }
}
