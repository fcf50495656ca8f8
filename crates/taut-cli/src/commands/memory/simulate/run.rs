//! Counting misses for lists of n, M and B, and the picture of them.

use std::fmt;

use taut_draw::{Axis, DrawOptions, Plot, Scale, Series, SeriesStyle, Tone};
use taut_reference::simulate::{CacheShape, Replacement, Simulator, Trace};

use super::algorithm::Algorithm;
use crate::input::reading::wrong_option;

/// Which block makes room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Policy {
    /// the one whose last access is longest ago
    Lru,
    /// the one that came first
    Fifo,
    /// any of them with the same probability, drawn from a fixed seed
    Random,
    /// the one whose next access is farthest away, which no other choice beats; 16 bytes for each access
    Optimal,
}

impl fmt::Display for Policy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Policy::Lru => "lru",
            Policy::Fifo => "fifo",
            Policy::Random => "random",
            Policy::Optimal => "optimal",
        })
    }
}

/// The misses to be counted: every n with every M and every B.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    pub(super) algorithm: Algorithm,
    pub(super) base: usize,
    pub(super) sizes: Vec<u64>,
    pub(super) memories: Vec<usize>,
    pub(super) blocks: Vec<usize>,
    pub(super) policy: Policy,
    pub(super) ways: Option<usize>,
}

/// A count.
#[derive(Clone, Debug)]
pub(super) struct Counted {
    pub(super) name: &'static str,
    pub(super) n: u64,
    pub(super) memory: usize,
    pub(super) block: usize,
    pub(super) policy: Policy,
    pub(super) misses: u64,
    pub(super) write_backs: u64,
    pub(super) formula: f64,
}

/// All counts, n by n, M by M, B by B.
pub(super) fn counted(wanted: &Wanted) -> anyhow::Result<Vec<Counted>> {
    let Wanted { algorithm, base, policy, ways, .. } = *wanted;
    wanted.sizes.iter().try_for_each(|&n| algorithm.check(n))?;
    let replacement = match policy {
        Policy::Fifo => Replacement::Fifo,
        Policy::Random => Replacement::Random(0),
        Policy::Lru | Policy::Optimal => Replacement::Lru,
    };
    let shapes: Vec<CacheShape> = wanted
        .memories
        .iter()
        .flat_map(|&memory| wanted.blocks.iter().map(move |&block| (memory, block)))
        .map(|(memory, block)| CacheShape { memory, block, ways, replacement })
        .collect();
    if let Some(shape) = shapes.iter().find(|shape| shape.memory < shape.block) {
        let CacheShape { memory, block, .. } = *shape;
        let expected = format!("at least a block, {block} bytes");
        return Err(wrong_option("memory-sizes", &memory.to_string(), &expected));
    }
    let mut rows = Vec::new();
    for &n in &wanted.sizes {
        // Refuses what is no cache, before anything is run.
        let mut simulator = Simulator::new(&shapes)?;
        let counts = match policy {
            Policy::Optimal => {
                let align = wanted.blocks.iter().copied().max().unwrap_or(8);
                let mut trace = Trace::new(align)?;
                algorithm.run(n, base, &mut trace)?;
                let best = |shape: &CacheShape| trace.optimal(shape.memory, shape.block);
                shapes.iter().map(best).collect::<Result<Vec<_>, _>>()?
            }
            Policy::Lru | Policy::Fifo | Policy::Random => {
                algorithm.run(n, base, &mut simulator)?;
                (0..shapes.len()).map(|cache| simulator.counts(cache)).collect()
            }
        };
        for (shape, counts) in shapes.iter().zip(counts) {
            let CacheShape { memory, block, .. } = *shape;
            rows.push(Counted {
                name: algorithm.name(),
                n,
                memory,
                block,
                policy,
                misses: counts.misses,
                write_backs: counts.write_backs,
                formula: algorithm.formula(n, memory, block),
            });
        }
    }
    Ok(rows)
}

/// Misses and formula against what there is more than one of: n, else M, else B.
pub(super) fn chart(wanted: &Wanted, rows: &[Counted]) -> Plot {
    let (axis, x): (&str, fn(&Counted) -> f64) = match wanted {
        Wanted { sizes, .. } if sizes.len() > 1 => (wanted.algorithm.axis(), |row| row.n as f64),
        Wanted { memories, .. } if memories.len() > 1 => {
            ("bytes of memory, M", |row| row.memory as f64)
        }
        _ => ("bytes of a block, B", |row| row.block as f64),
    };
    // A curve for each choice of the other two.
    let others = |row: &Counted| match axis {
        "bytes of memory, M" => (0, row.block),
        "bytes of a block, B" => (0, 0),
        _ => (row.memory, row.block),
    };
    let named = |(memory, block): (usize, usize)| match (memory, block) {
        (0, 0) => String::new(),
        (0, block) => format!(", B = {block}"),
        (memory, block) => format!(", M = {memory}, B = {block}"),
    };
    let mut groups: Vec<(usize, usize)> = Vec::new();
    for row in rows {
        if !groups.contains(&others(row)) {
            groups.push(others(row));
        }
    }
    const TONES: [Tone; 3] = [Tone::Answer, Tone::Third, Tone::Second];
    let series = groups.iter().zip(TONES.into_iter().cycle()).flat_map(|(&group, tone)| {
        let of = |y: &dyn Fn(&Counted) -> f64| -> Vec<[f64; 2]> {
            rows.iter().filter(|&row| others(row) == group).map(|row| [x(row), y(row)]).collect()
        };
        let curve = |name: &str, tone, style, points| Series {
            name: format!("{name}{}", named(group)),
            tone,
            style,
            points,
        };
        [
            curve("misses", tone, SeriesStyle::LineAndDots, of(&|row| row.misses as f64)),
            curve("formula", Tone::Bound, SeriesStyle::Dashed, of(&|row| row.formula)),
        ]
    });
    let series = series.collect();
    plot(
        format!("Misses of {}", wanted.algorithm.name()),
        "Counted in simulated memories; the formula is in words of 8 bytes, without a constant factor.".to_owned(),
        [axis, "misses"],
        [Scale::Log, Scale::Log],
        series,
    )
}

/// A chart of the usual size.
pub(super) fn plot(
    title: String,
    caption: String,
    [x, y]: [&str; 2],
    [x_scale, y_scale]: [Scale; 2],
    series: Vec<Series>,
) -> Plot {
    let options = DrawOptions::default();
    Plot {
        title,
        caption,
        x: Axis::named(x),
        y: Axis::named(y),
        x_scale,
        y_scale,
        series,
        bars: Vec::new(),
        levels: Vec::new(),
        width: options.width,
        height: (options.height * 0.75).max(180.0),
    }
}
