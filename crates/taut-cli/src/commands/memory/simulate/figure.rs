//! Figures 36 to 50 of the thesis, counted instead of timed.
//!
//! The thesis measured seconds on machines of its day. Here are the misses of the same programs in the caches that
//! these machines had, which explain the seconds and are the same everywhere.

use anyhow::bail;
use taut_draw::{Plot, Scale, Series, SeriesStyle, Tone};
use taut_reference::simulate::{CacheShape, Simulator};

use super::algorithm::Algorithm::{self, *};
use super::loops::Layout;
use super::run::{Counted, Policy, Wanted, chart, counted, plot};

/// Second-level cache of the notebook: 256 KiB, 8 ways, lines of 32 bytes (Pentium III).
const PENTIUM: CacheShape = CacheShape::lru(256 << 10, 32).with_ways(8);
/// Second-level cache of the Linux machine: 256 KiB, 16 ways, lines of 64 bytes (Athlon).
const ATHLON: CacheShape = CacheShape::lru(256 << 10, 64).with_ways(16);
/// Second-level cache of the server: 96 KiB, 6 ways, lines of 64 bytes (Itanium).
const ITANIUM_SECOND: CacheShape = CacheShape::lru(96 << 10, 64).with_ways(6);
/// Third-level cache of the server: 2 MiB, 4 ways, lines of 64 bytes (Itanium).
const ITANIUM: CacheShape = CacheShape::lru(2 << 20, 64).with_ways(4);
/// Tables of addresses: 64 pages of 4 KiB in 4 ways (Pentium III), 96 pages of 16 KiB in any place (Itanium).
const PENTIUM_PAGES: CacheShape = CacheShape::lru(64 << 12, 4 << 10).with_ways(4);
const ITANIUM_PAGES: CacheShape = CacheShape::lru(96 << 14, 16 << 10);

/// Rows of square matrices: powers of two, and in between.
const SQUARES: [u64; 11] = [64, 100, 128, 200, 256, 300, 400, 512, 700, 900, 1024];
const PRODUCTS: [u64; 7] = [32, 64, 100, 128, 160, 200, 256];
const TREES: [u64; 7] = [255, 1023, 4095, 16_383, 65_535, 262_143, 1_048_575];
const SORTS: [u64; 6] = [1 << 12, 1 << 14, 1 << 15, 1 << 16, 1 << 17, 1 << 18];

/// The curves that a figure compares.
struct Figure {
    title: &'static str,
    /// A picture for each.
    caches: Vec<CacheShape>,
    sizes: &'static [u64],
    /// Programs with the size at which they stop to divide.
    programs: Vec<(&'static str, Algorithm, usize)>,
    /// The objects that misses are counted for, as the axis has it.
    unit: &'static str,
    scales: [Scale; 2],
}

fn described(number: u32) -> Option<Figure> {
    let [linear, log] = [Scale::Linear, Scale::Log];
    let transposition = |title, cache, columns, base| Figure {
        title,
        caches: vec![cache],
        sizes: &SQUARES,
        programs: vec![
            ("two loops", TransposeLoops(columns), 1),
            ("cache-oblivious", Transpose(columns), base),
        ],
        unit: "misses an element",
        scales: [linear, linear],
    };
    let trees = |title, caches: [CacheShape; 2], width| Figure {
        title,
        caches: caches.to_vec(),
        sizes: &TREES,
        programs: vec![
            ("pre-order", Search(Layout::PreOrder, width), 1),
            ("breadth first", Search(Layout::BreadthFirst, width), 1),
            ("van Emde Boas", Search(Layout::VanEmdeBoas, width), 1),
        ],
        unit: "misses a search",
        scales: [log, linear],
    };
    Some(match number {
        36 | 37 => transposition("Transposition, n × n, notebook", PENTIUM, None, 1),
        38 => transposition("Transposition, n × n, Linux machine", ATHLON, None, 1),
        40 => transposition("Transposition, n × 100", ATHLON, Some(100), 1),
        41 => transposition("Transposition, n × 1000", ATHLON, Some(1000), 1),
        42 => transposition("Blocked transposition, n × n, notebook", PENTIUM, None, 16),
        43 => Figure {
            title: "Blocked matrix product, n × n, Itanium",
            // Matrices of 256 rows all fit the third level.
            caches: vec![ITANIUM_SECOND],
            sizes: &PRODUCTS,
            programs: vec![("three loops", MultiplyLoops, 1), ("cache-oblivious", Multiply, 16)],
            unit: "misses a product of two numbers",
            scales: [linear, linear],
        },
        46 => trees("Search, nodes of 32 bytes, notebook", [PENTIUM_PAGES, PENTIUM], 32),
        47 => trees("Search, nodes of 256 bytes, notebook", [PENTIUM_PAGES, PENTIUM], 256),
        48 => trees("Search, nodes of 48 bytes, Itanium", [ITANIUM_PAGES, ITANIUM], 48),
        49 | 50 => Figure {
            title: "Sorting n numbers, notebook",
            caches: vec![PENTIUM],
            sizes: &SORTS,
            programs: vec![
                ("quicksort", Quicksort, 1),
                ("distribution sort", DistributionSort, 1),
                ("funnelsort", Funnelsort, 1),
            ],
            unit: "misses a number",
            scales: [log, linear],
        },
        _ => return None,
    })
}

/// The counts of a figure, and its picture.
pub(super) fn figure(number: u32) -> anyhow::Result<(Vec<Counted>, Vec<Plot>)> {
    let Some(figure) = described(number) else {
        bail!(
            "option `--thesis-figure` is {number}: expected 36 to 38, 40 to 43, or 46 to 50; figure 39 is code, 44 and 45 show a \
             tree (docs/memory/figures.md)"
        );
    };
    let (mut rows, mut plots) = (Vec::new(), Vec::new());
    for &cache in &figure.caches {
        let (counts, plot) = counted_in(&figure, number, cache)?;
        rows.extend(counts);
        plots.push(plot);
    }
    Ok((rows, plots))
}

/// The counts of a figure in one of its caches.
fn counted_in(
    figure: &Figure,
    number: u32,
    cache: CacheShape,
) -> anyhow::Result<(Vec<Counted>, Plot)> {
    let Figure { title, sizes, programs, unit, scales, .. } = figure;
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    const TONES: [Tone; 3] = [Tone::Second, Tone::Answer, Tone::Third];
    for (&(name, algorithm, base), tone) in programs.iter().zip(TONES) {
        let mut points = Vec::new();
        for &n in *sizes {
            let mut simulator = Simulator::new(&[cache])?;
            algorithm.run(n, base, &mut simulator)?;
            let counts = simulator.counts(0);
            points.push([n as f64, counts.misses as f64 / algorithm.units(n)]);
            rows.push(Counted {
                name: algorithm.name(),
                n,
                memory: cache.memory,
                block: cache.block,
                policy: Policy::Lru,
                misses: counts.misses,
                write_backs: counts.write_backs,
                formula: algorithm.formula(n, cache.memory, cache.block),
            });
        }
        series.push(Series {
            name: name.to_owned(),
            tone,
            style: SeriesStyle::LineAndDots,
            points,
        });
    }
    // The formula of the last program, which is the one that the section is about.
    if let Some(&(_, algorithm, _)) = programs.last() {
        let at = |&n: &u64| {
            [n as f64, algorithm.formula(n, cache.memory, cache.block) / algorithm.units(n)]
        };
        series.push(Series {
            name: "formula".to_owned(),
            tone: Tone::Bound,
            style: SeriesStyle::Dashed,
            points: sizes.iter().map(at).collect(),
        });
    }
    let axis = programs.first().map_or("n", |program| program.1.axis());
    let blocks = if cache.block < 4 << 10 { "lines" } else { "pages" };
    let ways = cache.ways.map_or(String::new(), |ways| format!(" in {ways} ways"));
    let caption = format!(
        "Figure {number} of the thesis, counted: {} {blocks} of {} bytes{ways}, least recently used. The formula is without a \
         constant factor.",
        cache.blocks(),
        cache.block,
    );
    let plot = plot((*title).to_owned(), caption, [axis, *unit], *scales, series);
    Ok((rows, plot))
}

/// Returns a panel of the tour: misses of two algorithms against M and against B, each count within a factor of its formula.
pub(crate) fn panel() -> anyhow::Result<Panel> {
    let wanted = |algorithm, sizes: &[u64], memories: &[usize], blocks: &[usize]| Wanted {
        algorithm,
        base: 1,
        sizes: sizes.to_vec(),
        memories: memories.to_vec(),
        blocks: blocks.to_vec(),
        policy: Policy::Lru,
        ways: None,
    };
    let memories: Vec<usize> = (13..=19).map(|power| 1 << power).collect();
    // Of 256, 1024 and 4096 words, whose roots are powers of two, as the submatrices are.
    let squares = [2 << 10, 8 << 10, 32 << 10];
    let blocks: Vec<usize> = (6..=10).map(|power| 1 << power).collect();
    // The largest constant of each; the tests of the library hold larger sizes against the same.
    let lists = [
        (wanted(Multiply, &[64], &squares, &[64]), 5.5),
        (wanted(Transpose(None), &[256], &[256 << 10], &blocks), 1.01),
        (wanted(Funnelsort, &[1 << 14], &memories, &[64]), 6.0),
        (wanted(DistributionSort, &[1 << 14], &[64 << 10], &blocks[..3]), 6.0),
    ];
    let (mut plots, mut worst) = (Vec::new(), Vec::new());
    for (wanted, allowed) in lists {
        let rows = counted(&wanted)?;
        let ratio = rows.iter().map(|row| row.misses as f64 / row.formula).fold(0.0, f64::max);
        worst.push((wanted.algorithm.name(), ratio, allowed));
        plots.push(chart(&wanted, &rows));
    }
    Ok(Panel { plots, worst })
}

/// Pictures, and for each algorithm the largest ratio of misses to the formula beside the one allowed.
pub(crate) struct Panel {
    pub(crate) plots: Vec<Plot>,
    pub(crate) worst: Vec<(&'static str, f64, f64)>,
}
