//! Areas and their sections: what the command line chooses, and how it is run.

use crate::prelude::*;
use crate::report::Report;

/// A part of what has to be shown.
#[derive(Clone, Copy)]
pub(crate) struct Section<Kind> {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    /// What it shows.
    pub(crate) about: &'static str,
    /// What is done.
    pub(crate) kind: Kind,
    /// What has to be reached by all of its inputs.
    pub(crate) must: &'static [Goal],
    /// What is hoped for.
    pub(crate) aim: &'static [Goal],
    /// Peers beside taut, by program name.
    pub(crate) peers: &'static [&'static str],
    /// How often inputs are drawn, unless the command line says otherwise.
    draws: u64,
    /// Whether it runs only when it is named.
    is_extra: bool,
}

/// What is done in a section that has its inputs and goals in its code.
pub(crate) type Run = fn(&Context, &mut Outcome) -> Result<()>;

/// A section of its own kind.
pub(crate) const fn section<Kind: Copy>(name: &'static str, kind: Kind) -> Section<Kind> {
    Section { name, about: "", kind, must: &[], aim: &[], peers: &[], draws: 1, is_extra: false }
}

/// A section that has its inputs and goals in its code.
pub(crate) const fn runs(name: &'static str, run: Run) -> Section<Run> {
    section(name, run)
}

impl<Kind: Copy> Section<Kind> {
    pub(crate) const fn about(self, about: &'static str) -> Self {
        Section { about, ..self }
    }

    pub(crate) const fn must(self, must: &'static [Goal]) -> Self {
        Section { must, ..self }
    }

    pub(crate) const fn aim(self, aim: &'static [Goal]) -> Self {
        Section { aim, ..self }
    }

    pub(crate) const fn peers(self, peers: &'static [&'static str]) -> Self {
        Section { peers, ..self }
    }

    pub(crate) const fn draws(self, draws: u64) -> Self {
        Section { draws, ..self }
    }

    /// Runs only when it is named.
    pub(crate) const fn extra(self) -> Self {
        Section { is_extra: true, ..self }
    }
}

/// An area: its sections, in the order in which they run, and what holds where the command line says nothing.
pub(crate) struct Area<Kind: 'static> {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    pub(crate) sections: &'static [Section<Kind>],
    /// Rounds.
    pub(crate) runs: usize,
    /// Numbers of threads.
    pub(crate) threads: &'static [usize],
    /// Seconds for one run of a peer.
    pub(crate) limit: u64,
    /// Seconds for all runs of a peer on one input.
    pub(crate) peer_budget: u64,
}

/// Which sections, how often, and where what they measure goes.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Sections to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    pub(crate) sections: Vec<String>,
    /// Show the sections and do nothing.
    #[arg(long)]
    list: bool,
    /// Inputs of about a tenth of their size, few rounds and few draws: to try the bench, not to quote.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Rounds where times are taken [default: those of the area].
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    runs: Option<u64>,
    /// Numbers of threads taut is run with; goals are about the last of them [default: those of the area].
    #[arg(long, value_delimiter = ',')]
    pub(crate) threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped [default: those of the area].
    #[arg(long)]
    limit: Option<u64>,
    /// Seconds after which a peer that is slow takes part in no further round of an input [default: those of the area].
    #[arg(long)]
    peer_budget: Option<u64>,
    /// Folder for large files; needs as much free disk.
    #[arg(long)]
    scratch: Option<PathBuf>,
    /// Draws of each input [default: those of the section].
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: Option<u64>,
    /// The first seed.
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
}

impl<Kind> Area<Kind> {
    /// Runs the sections that were asked for; what was measured is written after each.
    pub(crate) fn run(
        &self,
        options: &Options,
        run: impl Fn(&Context, &mut Outcome, &'static Section<Kind>) -> Result<()>,
    ) -> Result<()> {
        let Some(sections) = self.choose(options)? else { return Ok(()) };
        let mut context = self.context(options)?;
        let mut report = Report::begin();
        if options.quick {
            println!("Quick: inputs are smaller than the sections say. Not to be quoted.\n");
        }
        for section in sections {
            let quick = section.draws.div_ceil(10);
            let draws = options.seeds.unwrap_or(context.size(section.draws, quick));
            context.peers = section.peers;
            context.seeds = options.first_seed..options.first_seed + draws;
            println!("## {}\n{}\n", section.name, section.about);
            let mut out = Outcome::new([section.must, section.aim]);
            run(&context, &mut out, section)?;
            report.add(out.finish(section.name));
            report.write(options.json.as_deref())?;
        }
        Ok(())
    }

    /// Returns the sections that were asked for; `None`, after showing them all, for `--list`.
    ///
    /// # Errors
    /// When a word means none.
    pub(crate) fn choose(&self, options: &Options) -> Result<Option<Vec<&'static Section<Kind>>>> {
        if options.list {
            for Section { name, about, .. } in self.sections {
                println!("{name:<24} {about}");
            }
            return Ok(None);
        }
        let mut chosen =
            select(self.sections, |section| section.name, &options.sections, self.name)?;
        chosen.retain(|section| !section.is_extra || !options.sections.is_empty());
        Ok(Some(chosen))
    }

    /// What the command line says of how sections run.
    pub(crate) fn context(&self, options: &Options) -> Result<Context> {
        ensure!(!options.threads.contains(&0), "at least one thread");
        let threads = match &options.threads[..] {
            [] => self.threads,
            given => given,
        };
        let usual = if options.quick { self.runs.min(2) } else { self.runs };
        Ok(Context {
            runs: options.runs.map_or(usual, |runs| runs as usize),
            quick: options.quick,
            threads: threads.to_vec(),
            peers: &[],
            seeds: 0..1,
            limit: Duration::from_secs(options.limit.unwrap_or(self.limit)),
            peer_budget: Duration::from_secs(options.peer_budget.unwrap_or(self.peer_budget)),
            scratch: options.scratch.clone(),
            temp: tempfile::TempDir::new()?,
        })
    }

    /// Runs one input that is no section.
    pub(crate) fn run_one(
        &self,
        options: &Options,
        name: &str,
        run: impl Fn(&Context, &mut Outcome) -> Result<()>,
    ) -> Result<()> {
        let (context, mut report) = (self.context(options)?, Report::begin());
        let mut out = Outcome::new([&[]; 2]);
        run(&context, &mut out)?;
        report.add(out.finish(name));
        report.write(options.json.as_deref())
    }
}

impl Area<Run> {
    /// Runs the sections that were asked for.
    pub(crate) fn run_all(&self, options: &Options) -> Result<()> {
        self.run(options, |context, out, section| (section.kind)(context, out))
    }
}

/// Returns the items whose names are meant by one of `words`, in their order; without words all of them.
///
/// A word means an item by its whole name, so that `balls-10` is not also `balls-100`, or, where no item has that name,
/// by the beginning of it.
///
/// # Errors
/// When a word means none; `area` then says where the list is.
pub(crate) fn select<'a, T>(
    items: &'a [T],
    name: impl Fn(&T) -> &str,
    words: &[String],
    area: &str,
) -> Result<Vec<&'a T>> {
    let means = |word: &str, item: &T| match items.iter().any(|item| name(item) == word) {
        true => name(item) == word,
        false => name(item).starts_with(word),
    };
    for word in words {
        let known = items.iter().any(|item| means(word, item));
        ensure!(known, "no name begins with `{word}`: see `bench {area} --list`");
    }
    let meant = |item: &&T| words.is_empty() || words.iter().any(|word| means(word, item));
    Ok(items.iter().filter(meant).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ball, centers, curve, delaunay, ellipsoid, oblivious, surface};

    #[test]
    fn names_are_unique() {
        fn are_unique<Kind>(area: &Area<Kind>) -> bool {
            let names: std::collections::BTreeSet<_> =
                area.sections.iter().map(|section| section.name).collect();
            names.len() == area.sections.len()
        }
        let areas = [ball::AREA, centers::AREA, ellipsoid::AREA, curve::AREA, surface::AREA];
        assert!(areas.iter().all(are_unique));
        assert!(are_unique(&oblivious::AREA) && are_unique(&delaunay::AREA));
    }

    #[test]
    fn a_whole_name_means_that_section_alone() {
        let names = ["balls-3", "balls-10", "balls-100", "small"];
        let meant = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|word| word.to_string()).collect();
            select(&names, |name| name, &words, "ball").map(|found| found.len())
        };
        assert_eq!(meant(&["balls-10"]).unwrap(), 1);
        assert_eq!(meant(&["balls"]).unwrap(), 3);
        assert_eq!(meant(&["small", "balls-3"]).unwrap(), 2);
        assert_eq!(meant(&[]).unwrap(), 4);
        let refused = meant(&["small", "none"]).unwrap_err().to_string();
        assert_eq!(refused, "no name begins with `none`: see `bench ball --list`");
    }
}
