//! The algorithms that can be run under a simulated memory, each with the formula of its misses.

use taut::oblivious::{Error, Probe, sample, shuffle};
use taut_reference::algorithms::{
    DistributorForm, LIST_END, MatrixSizes, columnsort_instrumented,
    distribution_sort_instrumented, distributor_sort_instrumented, funnelsort_instrumented,
    list_ranks_instrumented, mergesort_instrumented, multiply_instrumented, quicksort_instrumented,
    reverse_instrumented, select_instrumented, strassen_instrumented, transpose_instrumented,
};

use super::loops::{self, Layout, SEARCH_COUNT};

/// The algorithm to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Algorithm {
    /// Of a matrix of so many columns; none: as many as rows.
    Transpose(Option<usize>),
    TransposeLoops(Option<usize>),
    Multiply,
    MultiplyLoops,
    Strassen,
    /// In a tree whose nodes have so many bytes.
    Search(Layout, usize),
    Funnelsort,
    DistributionSort,
    DistributorSort,
    Columnsort,
    Mergesort,
    Quicksort,
    Select,
    Reverse,
    ListRanking,
}

use Algorithm::*;

impl Algorithm {
    /// Each with its name and a word on it.
    pub(super) const NAMES: [(&'static str, Algorithm, &'static str); 17] = [
        ("transpose", Transpose(None), "n × n by halving the longer side; 2n²/B"),
        ("transpose-loops", TransposeLoops(None), "n × n by two loops"),
        ("multiply", Multiply, "n × n by halving the longest side; n³/(B√M)"),
        ("multiply-loops", MultiplyLoops, "n × n by three loops"),
        (
            "strassen",
            Strassen,
            "seven products for eight, n a power of two; n^lg 7/(B·M^(lg 7/2 − 1))",
        ),
        (
            "search",
            Search(Layout::VanEmdeBoas, 8),
            "10,000 in a tree of n nodes laid out as van Emde Boas has it; log_B n each",
        ),
        ("search-pre-order", Search(Layout::PreOrder, 8), "the same in pre-order"),
        (
            "search-breadth-first",
            Search(Layout::BreadthFirst, 8),
            "the same level by level, as sorted arrays are searched",
        ),
        ("funnelsort", Funnelsort, "n numbers; (n/B)(1 + log_{M/B}(n/B))"),
        (
            "distribution-sort",
            DistributionSort,
            "n numbers by algorithms 8 and 9 of the thesis; the same formula",
        ),
        ("distributor-sort", DistributorSort, "n numbers by k-distributors; the same formula"),
        (
            "columnsort",
            Columnsort,
            "n numbers, the same accesses for all of them; the same formula",
        ),
        ("mergesort", Mergesort, "n numbers; (n/B)(2 + log₂(n/M))"),
        ("quicksort", Quicksort, "n numbers; the same formula"),
        ("select", Select, "the median of n numbers; n/B"),
        ("reverse", Reverse, "n numbers; n/B"),
        ("list-ranking", ListRanking, "n nodes of a list in random order; two sorts of 2n words"),
    ];

    pub(super) fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(known, ..)| *known == name).map(|(_, algorithm, _)| *algorithm)
    }

    /// Its name; of variants that the command line has no word for, that of the plain one.
    pub(super) fn name(self) -> &'static str {
        let plain = match self {
            Transpose(_) => Transpose(None),
            TransposeLoops(_) => TransposeLoops(None),
            Search(layout, _) => Search(layout, 8),
            other => other,
        };
        Self::NAMES.iter().find(|entry| entry.1 == plain).map_or("", |entry| entry.0)
    }

    /// A size that takes a moment.
    pub(super) fn usual_size(self) -> u64 {
        match self {
            Transpose(_) | TransposeLoops(_) => 512,
            Multiply | MultiplyLoops | Strassen => 128,
            Search(..) => (1 << 18) - 1,
            _ => 1 << 16,
        }
    }

    /// The sizes it takes: more would take hours, or more memory than there is.
    pub(super) fn check(self, n: u64) -> Result<(), Error> {
        let (most, expected) = match self {
            Transpose(_) | TransposeLoops(_) => (1 << 13, "1 to 8192 rows"),
            Multiply | MultiplyLoops => (1 << 11, "1 to 2048 rows"),
            Strassen => (1 << 10, "a power of two of rows, up to 1024"),
            Search(..) => (1 << 36, "1 to 68719476736 nodes"),
            ListRanking => (1 << 22, "1 to 4194304 nodes"),
            _ => (1 << 26, "1 to 67108864 numbers"),
        };
        if (1..=most).contains(&n) && (self != Strassen || n.is_power_of_two()) {
            return Ok(());
        }
        Err(Error::Option { name: "n", value: n.to_string(), expected })
    }

    /// Returns what there are n of, as an axis has it.
    pub(super) fn axis(self) -> &'static str {
        match self {
            Transpose(_) | TransposeLoops(_) | Multiply | MultiplyLoops | Strassen => "rows, n",
            Search(..) => "nodes of the tree, n",
            ListRanking => "nodes of the list, n",
            _ => "numbers, n",
        }
    }

    /// Runs it on an input of size n. What it is run on is random and the same each time.
    pub(super) fn run<P: Probe>(self, n: u64, base: usize, probe: &mut P) -> Result<(), Error> {
        self.check(n)?;
        let size = n as usize;
        let square = || vec![1.0f64; size * size];
        let mut numbers = match self {
            Transpose(_) | TransposeLoops(_) | Multiply | MultiplyLoops | Strassen | Search(..) => {
                Vec::new()
            }
            _ => random(size),
        };
        match self {
            Transpose(columns) => {
                let columns = columns.unwrap_or(size);
                let from = vec![1u64; size * columns];
                let mut to = vec![0; size * columns];
                transpose_instrumented(&from, &mut to, size, columns, base, probe)?;
            }
            TransposeLoops(columns) => loops::transpose(size, columns.unwrap_or(size), probe),
            Multiply => {
                let mut to = square();
                let sizes = MatrixSizes::square(size);
                multiply_instrumented(&square(), &square(), &mut to, sizes, base, probe)?;
            }
            MultiplyLoops => loops::multiply(size, probe),
            Strassen => {
                strassen_instrumented(&square(), &square(), &mut square(), size, base, probe)?
            }
            Search(layout, width) => loops::search(layout, height(n), width, probe)?,
            Funnelsort => funnelsort_instrumented(&mut numbers, probe),
            DistributionSort => distribution_sort_instrumented(&mut numbers, 1, probe),
            DistributorSort => {
                distributor_sort_instrumented(&mut numbers, DistributorForm::Unfolded, 1, probe);
            }
            Columnsort => columnsort_instrumented(&mut numbers, probe),
            Mergesort => mergesort_instrumented(&mut numbers, probe),
            Quicksort => quicksort_instrumented(&mut numbers, 1, probe),
            Select => {
                select_instrumented(&mut numbers, size / 2, probe);
            }
            Reverse => reverse_instrumented(&mut numbers, probe),
            ListRanking => {
                let mut order: Vec<u32> = (0..n as u32).collect();
                shuffle(&mut order, 1);
                let mut next = vec![LIST_END; size];
                order.windows(2).for_each(|pair| next[pair[0] as usize] = pair[1]);
                list_ranks_instrumented(&next, 1, probe)?;
            }
        }
        Ok(())
    }

    /// Misses in a memory of `memory` bytes in blocks of `block` bytes, by the formula without its constant.
    pub(super) fn formula(self, n: u64, memory: usize, block: usize) -> f64 {
        let (m, b) = (memory as f64 / 8.0, block as f64 / 8.0);
        let (words, scan) = (n as f64, n as f64 / b);
        // At least one: what fits comes in once.
        let sort = |n: f64| (n / b) * (1.0 + ((n / b).ln() / (m / b).max(2.0).ln()).max(0.0));
        let halves = scan * (2.0 + (words / m).log2().max(0.0));
        match self {
            Transpose(columns) | TransposeLoops(columns) => {
                2.0 * words * columns.map_or(words, |columns| columns as f64) / b
            }
            Multiply | MultiplyLoops => words.powi(3) / (b * m.sqrt()),
            Strassen => words.powf(7f64.log2()) / (b * m.powf(7f64.log2() / 2.0 - 1.0)),
            Search(_, width) => {
                let nodes = (block as f64 / width as f64).max(1.0);
                SEARCH_COUNT as f64 * (words + 1.0).ln() / (nodes + 1.0).ln()
            }
            Funnelsort | DistributionSort | DistributorSort | Columnsort => sort(words),
            Mergesort | Quicksort => halves,
            Select | Reverse => scan.max(1.0),
            ListRanking => sort(2.0 * words),
        }
    }

    /// Returns what one miss is counted for in figures: elements of matrices, numbers, searches.
    pub(super) fn units(self, n: u64) -> f64 {
        match self {
            Transpose(columns) | TransposeLoops(columns) => {
                n as f64 * columns.map_or(n as f64, |columns| columns as f64)
            }
            Multiply | MultiplyLoops | Strassen => (n as f64).powi(3),
            Search(..) => SEARCH_COUNT as f64,
            _ => n as f64,
        }
    }
}

/// Levels of the complete tree of at least n nodes.
fn height(n: u64) -> usize {
    (n + 1).next_power_of_two().ilog2() as usize
}

/// Numbers in random order, all different.
fn random(n: usize) -> Vec<u64> {
    let mut numbers = sample(1, 1 << 40, n as u64).unwrap_or_default();
    shuffle(&mut numbers, 2);
    numbers
}
