//! The memory hierarchy: `taut-oblivious` and the reference code of `taut-reference` beside their peers.

mod draw;
mod files;
mod guests;
mod in_place;
mod lanes;
pub(crate) mod one;
mod order;
mod packed;
mod queue;
mod sample;
mod search;
mod simulate;
mod sort;
mod transpose;
mod tree;

use std::path::PathBuf;

use anyhow::Result;
use serde_json::{Value, json};

use crate::context::Context;
use crate::select::select;

/// Sections and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Sections to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    cases: Vec<String>,
    /// Show the sections and do nothing.
    #[arg(long)]
    list: bool,
    /// Rounds where times are taken; the least of them counts.
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// Inputs of some hundredth of their size: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
    /// In the section `files`, 10⁸ records under 256 MiB, with 10 GB of disk, and a matrix of 4 GiB.
    #[arg(long, requires = "scratch", conflicts_with = "quick")]
    large: bool,
    /// Folder for the files of the section `files`, which do not stay [default: the system's for temporary files].
    #[arg(long)]
    scratch: Option<PathBuf>,
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// A section: a part of what has to be shown.
struct Section {
    name: &'static str,
    about: &'static str,
    run: fn(&Context) -> Result<Value>,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "search",
        about: "Lower bounds among 2²⁴ sorted u64, in batches and each depending on the one before, beside std's binary search.",
        run: search::run,
    },
    Section {
        name: "sort",
        about: "10⁷ u64 and 10⁷ records of 32 bytes beside std, rdst, voracious_radix_sort and numpy; twelve patterns of 10⁶.",
        run: sort::run,
    },
    Section {
        name: "transpose",
        about: "Four shapes of doubles beside the crate transpose and a copy; sides off by one.",
        run: transpose::run,
    },
    Section {
        name: "in-place",
        about: "The same shapes in their own place, beside the crate transpose and a second array.",
        run: in_place::run,
    },
    Section {
        name: "files",
        about: "Files larger than the memory allowed: sorted beside extsort, put through a queue, and transposed; --large: 10⁸ records and 4 GiB.",
        run: files::run,
    },
    Section {
        name: "packed",
        about: "Ordered sets of 10⁷ u64 beside std's BTreeSet and indexset.",
        run: packed::run,
    },
    Section {
        name: "sample",
        about: "2²⁰ of 2⁴⁰ without replacement, in order; shuffles.",
        run: sample::run,
    },
    Section {
        name: "tree",
        about: "The nearest of 16 million points in space, beside kiddo.",
        run: tree::run,
    },
    Section {
        name: "order",
        about: "A million points along a Hilbert curve, beside CGAL and fast_hilbert.",
        run: order::run,
    },
    Section {
        name: "simulate",
        about: "Accesses per second of the simulator; misses of algorithms beside their bounds.",
        run: simulate::run,
    },
    Section {
        name: "queue",
        about: "10⁷ keys with values through a queue, beside std's BinaryHeap and quickheap.",
        run: queue::run,
    },
];

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for section in SECTIONS {
            println!("{:<12} {}", section.name, section.about);
        }
        return Ok(());
    }
    let sections = select(SECTIONS, |section| section.name, &arguments.cases, "oblivious")?;
    // All work on this thread, whose processor time is what counts.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    let Arguments { runs, quick, scratch, .. } = arguments;
    let mut context = Context::begin(*runs, *quick, &[1], [300, 300], scratch.as_ref())?;
    let head = |section: &'static Section| [section.name, section.about];
    context.run_all(sections, arguments.json.as_ref(), head, |context, section| {
        let measured = match section.name {
            "files" if arguments.large => files::run_large(context)?,
            _ => (section.run)(context)?,
        };
        context.report.add(json!({ "name": section.name, "measured": measured }));
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        for (at, section) in SECTIONS.iter().enumerate() {
            assert!(SECTIONS[..at].iter().all(|o| o.name != section.name), "{}", section.name);
        }
    }
}
