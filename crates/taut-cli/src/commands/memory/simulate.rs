//! `taut memory simulate`: misses of an algorithm in memories of many sizes, beside the formula.

mod algorithm;
mod figure;
mod loops;
mod run;

use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::builder::{PossibleValue, PossibleValuesParser};

use self::algorithm::Algorithm;
pub(crate) use self::figure::panel;
use self::run::{Counted, Policy, Wanted, chart, counted};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::size;
use crate::output::numbers;
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing::{self, Outputs};

/// Count the cache misses of an algorithm in simulated memories, beside the formula.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The counts are exact and the same on every machine: addresses are simulated, too. A memory of M bytes holds blocks of \
B bytes; formulas are in words of 8 bytes, without a constant factor. --thesis-figure N counts again what figures 36 to 50 of \
the thesis measured, in the caches of its machines.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut memory simulate transpose -n 512 --memory-sizes 4K,64K --block 64 --draw misses.svg
         taut memory simulate --thesis-figure 36 --draw figure.svg")]
pub(super) struct Args {
    /// The algorithm
    #[arg(value_name = "ALGORITHM", value_parser = algorithms(), required_unless_present = "figure")]
    algorithm: Option<String>,
    /// Sizes of the input: rows of a square matrix, numbers to sort, nodes of a tree [default: one that fits the algorithm]
    #[arg(short, value_name = "LIST", value_delimiter = ',')]
    n: Vec<u64>,
    /// Sizes of the memory
    #[arg(long = "memory-sizes", alias = "memory", value_name = "LIST", value_delimiter = ',', value_parser = size::parse, default_value = "4K,16K,64K,256K")]
    memory: Vec<u64>,
    /// Sizes of its blocks, powers of two
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = size::parse, default_value = "64")]
    block: Vec<u64>,
    /// Which block makes room
    #[arg(long, value_enum, default_value = "lru")]
    policy: Policy,
    /// Blocks of a set: block b can only be in set b modulo the number of sets [default: one set]
    #[arg(long, value_name = "N")]
    ways: Option<usize>,
    /// Size at which matrix algorithms stop to divide
    #[arg(long, value_name = "N", default_value_t = 1)]
    base: usize,
    /// A figure of the thesis instead: 36 to 38, 40 to 43, or 46 to 50
    #[arg(long = "thesis-figure", alias = "figure", value_name = "N", conflicts_with_all = ["algorithm", "n", "memory", "block", "policy", "ways", "base"])]
    figure: Option<u32>,

    /// Write the counts, as .csv or .json; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print JSON instead of the table
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw misses and formula; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,

    #[command(flatten)]
    effort: Effort,
}

fn algorithms() -> PossibleValuesParser {
    let named = |&(name, _, help): &(&'static str, Algorithm, &'static str)| {
        PossibleValue::new(name).help(help)
    };
    PossibleValuesParser::new(Algorithm::NAMES.iter().map(named))
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        let outputs: Vec<&Path> =
            [&self.out, &self.draw].into_iter().flatten().map(|path| &**path).collect();
        writing::check_writable(&outputs, &[])?;
        let to_file = self.out.as_deref().map(|out| writing::writes_json(out, self.json, "csv"));
        let to_file = to_file.transpose()?;
        self.effort.start()?;
        let (rows, plots) = match self.figure {
            Some(number) => figure::figure(number)?,
            None => {
                let wanted = self.wanted()?;
                let rows = counted(&wanted)?;
                let plot = chart(&wanted, &rows);
                (rows, vec![plot])
            }
        };
        let mut outputs = Outputs::default();
        if let (Some(path), Some(as_json)) = (&self.out, to_file) {
            let text = if as_json { json(&rows) } else { csv(&rows) };
            outputs.add(path, text.as_bytes())?;
        }
        if let (Some(path), Some(picture)) = (&self.draw, picture) {
            let drawing = Drawing {
                title: "Misses in simulated memories".to_owned(),
                heading: plots.first().map_or(String::new(), |plot| plot.title.clone()),
                fields: Vec::new(),
                figures: plots.into_iter().map(taut_draw::Figure::Plot).collect(),
            };
            outputs.add(path, &picture.draw(drawing, &PictureOptions::default())?)?;
        }
        if self.out.as_deref().is_none_or(|out| !writing::is_stream(out)) {
            match (self.json, self.effort.quiet) {
                (true, _) => outputs.print(&json(&rows)),
                (false, true) => {}
                (false, false) => outputs.print(&table(&rows)),
            }
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    fn wanted(&self) -> anyhow::Result<Wanted> {
        let Some(algorithm) = self.algorithm.as_deref().and_then(Algorithm::named) else {
            bail!("name an algorithm, or a figure with --thesis-figure");
        };
        let sizes = match self.n.is_empty() {
            true => vec![algorithm.usual_size()],
            false => self.n.clone(),
        };
        if self.policy == Policy::Optimal && self.ways.is_some() {
            bail!(
                "--ways belongs to lru, fifo and random: the best replacement is that of one set"
            );
        }
        let fits = |sizes: &[u64]| -> Vec<usize> {
            sizes.iter().map(|&size| usize::try_from(size).unwrap_or(usize::MAX)).collect()
        };
        Ok(Wanted {
            algorithm,
            base: self.base,
            sizes,
            memories: fits(&self.memory),
            blocks: fits(&self.block),
            policy: self.policy,
            ways: self.ways,
        })
    }
}

fn csv(rows: &[Counted]) -> String {
    let mut text = "algorithm,n,memory,block,policy,misses,write_backs,formula\n".to_owned();
    for row in rows {
        let Counted { name, n, memory, block, policy, misses, write_backs, formula } = row;
        text += &format!(
            "{name},{n},{memory},{block},{policy},{misses},{write_backs},{}\n",
            numbers::short(*formula)
        );
    }
    text
}

fn json(rows: &[Counted]) -> String {
    let row = |row: &Counted| {
        let Counted { name, n, memory, block, policy, misses, write_backs, formula } = row;
        serde_json::json!({
            "algorithm": name, "n": n, "memory": memory, "block": block, "policy": policy.to_string(),
            "misses": misses, "write_backs": write_backs, "formula": formula,
        })
    };
    format!("{:#}\n", serde_json::Value::Array(rows.iter().map(row).collect()))
}

fn table(rows: &[Counted]) -> String {
    let mut text = format!(
        "{:<20} {:>9} {:>9} {:>7} {:>13} {:>13} {:>8}\n",
        "algorithm", "n", "M", "B", "misses", "formula", "ratio"
    );
    for Counted { name, n, memory, block, misses, formula, .. } in rows {
        let ratio = match *formula > 0.0 {
            true => format!("{:.3}", *misses as f64 / formula),
            false => "-".to_owned(),
        };
        text += &format!(
            "{name:<20} {n:>9} {memory:>9} {block:>7} {:>13} {:>13} {ratio:>8}\n",
            numbers::count(*misses),
            // A few misses, or a part of one, are not rounded to other ones.
            match *formula < 100.0 {
                true => numbers::short(*formula),
                false => numbers::count(formula.round() as u64),
            },
        );
    }
    text
}
