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

use crate::cases::{Choice, Run, Section};
use crate::context::Context;

/// Sections and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Rounds where times are taken; the least of them counts.
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// In the section `files`, 10⁸ records under 256 MiB, with 10 GB of disk, and a matrix of 4 GiB.
    #[arg(long, requires = "scratch", conflicts_with = "quick")]
    large: bool,
    /// Folder for the files of the section `files`, which do not stay [default: the system's for temporary files].
    #[arg(long)]
    scratch: Option<PathBuf>,
}

/// All sections, in the order in which they run.
const SECTIONS: &[Section] = &[
    Section {
        name: "search",
        about: "Lower bounds among 2²⁴ sorted u64, in batches and each depending on the one before, beside std's binary search.",
        run: Run::Once(search::run),
    },
    Section {
        name: "sort",
        about: "10⁷ u64 and 10⁷ records of 32 bytes beside std, rdst, voracious_radix_sort and numpy; twelve patterns of 10⁶.",
        run: Run::Once(sort::run),
    },
    Section {
        name: "transpose",
        about: "Four shapes of doubles beside the crate transpose and a copy; sides off by one.",
        run: Run::Once(transpose::run),
    },
    Section {
        name: "in-place",
        about: "The same shapes in their own place, beside the crate transpose and a second array.",
        run: Run::Once(in_place::run),
    },
    Section {
        name: "files",
        about: "Files larger than the memory allowed: sorted beside extsort, put through a queue, and transposed; --large: 10⁸ records and 4 GiB.",
        run: Run::Once(files::run),
    },
    Section {
        name: "packed",
        about: "Ordered sets of 10⁷ u64 beside std's BTreeSet and indexset.",
        run: Run::Once(packed::run),
    },
    Section {
        name: "sample",
        about: "2²⁰ of 2⁴⁰ without replacement, in order; shuffles.",
        run: Run::Once(sample::run),
    },
    Section {
        name: "tree",
        about: "The nearest of 16 million points in space, beside kiddo.",
        run: Run::Once(tree::run),
    },
    Section {
        name: "order",
        about: "A million points along a Hilbert curve, beside CGAL and fast_hilbert.",
        run: Run::Once(order::run),
    },
    Section {
        name: "simulate",
        about: "Accesses per second of the simulator; misses of algorithms beside their bounds.",
        run: Run::Once(simulate::run),
    },
    Section {
        name: "queue",
        about: "10⁷ keys with values through a queue, beside std's BinaryHeap and quickheap.",
        run: Run::Once(queue::run),
    },
];

/// The section of files with `--large`.
static LARGE_FILES: Section = Section {
    name: "files",
    about: "Files larger than the memory allowed: 10⁸ records and 4 GiB.",
    run: Run::Once(files::run_large),
};

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(sections) = arguments.choice.of(SECTIONS, "oblivious")? else { return Ok(()) };
    // All work on this thread, whose processor time is what counts.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    let Arguments { runs, scratch, .. } = arguments;
    let quick = arguments.choice.quick;
    let mut context = Context::begin(*runs, quick, &[1], [300, 300], scratch.as_ref())?;
    let is_large = |section: &Section| arguments.large && section.name == LARGE_FILES.name;
    let sized = |section| if is_large(section) { &LARGE_FILES } else { section };
    let sections = sections.into_iter().map(sized).collect();
    context.run_sections(sections, arguments.choice.json.as_ref(), |usual| 0..usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        assert!(crate::cases::are_unique(SECTIONS));
    }
}
