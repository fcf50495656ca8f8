//! Figures 5 to 15 and 18 of the thesis, rerun: CSV for those who compute, SVG for those who look.
//!
//! *What is rerun.* The experiments of chapter II: core-set sizes and times of Algorithm 1, pure and fast, by
//! dimension, number of points, distribution and ε, and its time beside CGAL, Gärtner's code and the simple method
//! of Bădoiu and Clarkson. The methods of the thesis take one far point per pass; taut's default method is drawn
//! beside them, with its support and its working set.
//! *What differs.* The machine (the thesis had a 2.66 GHz Xeon, and for figures 14 and 15 a 1 GHz Pentium III), the
//! conic solver, and the random points. Sizes can be compared; times only within one figure.
//! *Figure 18* is about ellipsoids and has a command of its own, as have figures 2, 21 and 22, which are about curves.

mod curve;
mod ellipsoid;
mod figure;
mod series;

use std::path::PathBuf;
use std::time::Duration;

use anyhow::Result;
use tempfile::TempDir;

use crate::machine;

/// Which figures, and how far.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Figures to rerun, 5 to 15; none means all.
    figures: Vec<u32>,
    /// Go to the largest dimensions and numbers of points of the thesis; without it, under about five minutes.
    #[arg(long)]
    full: bool,
    /// Smallest sizes only: to try the program, not to look at.
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Folder for the CSV and SVG files.
    #[arg(long, default_value = "bench/thesis-ball")]
    out: PathBuf,
    /// Times of each point of a curve; the smallest is drawn.
    #[arg(long, default_value_t = 1)]
    runs: usize,
    /// Seconds after which a curve is not continued to larger instances; it is then said where it stops.
    #[arg(long, default_value_t = 15)]
    budget: u64,
}

/// How large the instances are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Size {
    Quick,
    Usual,
    Full,
}

/// What all figures share.
struct Plan {
    size: Size,
    runs: usize,
    budget: Duration,
    temp: TempDir,
}

impl Plan {
    /// The list for the size that was asked for; each longer one begins with the shorter.
    fn upto<'a, T>(&self, list: &'a [T], quick: usize, usual: usize) -> &'a [T] {
        match self.size {
            Size::Quick => &list[..quick],
            Size::Usual => &list[..usual],
            Size::Full => list,
        }
    }
}

/// How far figure 18 goes.
#[derive(clap::Args)]
pub(crate) struct EllipsoidArguments {
    /// Go to larger dimensions and smaller ε; without it, under about a minute.
    #[arg(long)]
    full: bool,
    /// Smallest sizes only: to try the program, not to look at.
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Folder for the CSV and SVG files.
    #[arg(long, default_value = "bench/thesis-ellipsoid")]
    out: PathBuf,
    /// Times of each point of a curve; the smallest is drawn.
    #[arg(long, default_value_t = 1)]
    runs: usize,
    /// Seconds after which a curve is not continued to larger instances; it is then said where it stops.
    #[arg(long, default_value_t = 15)]
    budget: u64,
}

fn plan(full: bool, quick: bool, runs: usize, budget: u64) -> Result<Plan> {
    Ok(Plan {
        size: match (full, quick) {
            (true, _) => Size::Full,
            (_, true) => Size::Quick,
            _ => Size::Usual,
        },
        runs: runs.max(1),
        budget: Duration::from_secs(budget),
        temp: TempDir::new()?,
    })
}

/// Prints figures and writes them.
fn show(figures: Vec<figure::Figure>, folder: &std::path::Path) -> Result<()> {
    for figure in figures {
        figure.print();
        figure.write(folder)?;
    }
    Ok(())
}

/// Where the pictures of curves go.
#[derive(clap::Args)]
pub(crate) struct CurveArguments {
    /// Folder for the SVG files.
    #[arg(long, default_value = "bench/thesis-curve")]
    out: PathBuf,
}

/// Redraws figures 2, 21 and 22.
pub(crate) fn run_curve(arguments: &CurveArguments) -> Result<()> {
    std::fs::create_dir_all(&arguments.out)?;
    for path in curve::write(&arguments.out)? {
        println!("{}", path.display());
    }
    Ok(())
}

/// Reruns figure 18.
pub(crate) fn run_ellipsoid(arguments: &EllipsoidArguments) -> Result<()> {
    let EllipsoidArguments { full, quick, runs, budget, .. } = *arguments;
    let plan = plan(full, quick, runs, budget)?;
    std::fs::create_dir_all(&arguments.out)?;
    println!("Machine and versions: {}\n", machine::describe());
    show(ellipsoid::figures(&plan)?, &arguments.out)
}

/// Reruns the figures that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Arguments { full, quick, runs, budget, .. } = *arguments;
    let plan = plan(full, quick, runs, budget)?;
    std::fs::create_dir_all(&arguments.out)?;
    println!("Machine and versions: {}\n", machine::describe());
    let wanted = |number: &u32| arguments.figures.is_empty() || arguments.figures.contains(number);
    for (numbers, draw) in series::FIGURES {
        if numbers.iter().any(wanted) {
            show(draw(&plan)?, &arguments.out)?;
        }
    }
    Ok(())
}
