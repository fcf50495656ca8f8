//! Figures and the table of the thesis, rerun: CSV for those who compute, SVG for those who look.
//!
//! *What is rerun.* k centers (figures 1, 16 and 17), core-sets and times of balls (figures 5 to 15) and of ellipsoids (figure 18), curves through noisy
//! points (figures 2, 21 and 22), surfaces (table 1), diamonds and times of triangulations (figures 52 and 53), classifiers (tables 2 and 3), the ellipse in a projected model (figure 62), and k-dops in meshes (tables 4 to 6, figures 76 and
//! 77). taut's default methods are drawn beside those of the thesis.
//! *What differs.* The machine (the thesis had a 2.66 GHz Xeon for chapter 2, and for figures 14 and 15 a 1 GHz Pentium III; other
//! chapters name others), the conic solver, and the random points. Sizes can be compared; times only within one figure.

mod ball;
mod centers;
mod curve;
mod dops;
mod ellipse;
mod ellipsoid;
mod figure;
mod memory;
mod outofcore;
mod recognize;
mod surface;
mod sweep;

use std::fmt::Write as _;
use std::fs;

use taut_draw::{
    Aspect, Axis, DrawOptions, Figure as Drawing, Layer2, LineStyle, Plot, Point2, Scale, Scene2,
    Series, SeriesStyle, Shape2, Style, Tone, surface_figures, to_svg,
};
use taut_enclose::{BallMethod, BallOptions, EllipsoidMethod, EllipsoidOptions};
use taut_points::generate::curves::{CurveNoise, TestCurve, sample_curve};
use taut_reconstruct::{CurveMethod, CurveOptions, CurveThesisOptions, SurfaceOptions};
use tempfile::TempDir;

use crate::input::Input;
use crate::judge::judge;
use crate::machine;
use crate::prelude::*;
use crate::surface::found::ours;
use crate::surface::table_one::{TABLE, TableOne};
use figure::{Curve, Figure};
use sweep::{Measured, Sweep, warning};

/// Which figures, and how far.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Figures by number, `table-1`, or `all`; none lists them.
    names: Vec<String>,
    /// Show what can be rerun and do nothing.
    #[arg(long)]
    list: bool,
    /// Go to the largest dimensions and numbers of points of the thesis; without it, under about five minutes.
    #[arg(long)]
    full: bool,
    /// Smallest sizes only: to try the program, not to look at.
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Folder for the CSV and SVG files.
    #[arg(long, default_value = "bench/thesis")]
    out: PathBuf,
    /// Times of each instance, of which the smallest is drawn or written.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    runs: u64,
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

/// What all reruns share.
struct Plan {
    size: Size,
    /// Runs of each instance; `limit` is the budget of a curve.
    context: Context,
    /// Where files go.
    out: PathBuf,
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

/// One experiment, which gives one figure or several: their names on the command line, what it shows, and how it runs.
type Rerun = (&'static [&'static str], &'static str, fn(&Plan) -> Result<()>);

const RERUNS: &[Rerun] = &[
    (&["1", "16", "17"], "k centers of cities and in space, by Algorithm 2.", centers::figures),
    (&["2.4-delta"], "Balls: the accuracy δ of the conic solver.", ball::by_delta),
    (&["2.4-largest"], "Balls: 10⁵ points in dimension 1500.", ball::largest),
    (&["2"], "A curve through noisy points.", |plan| curve::write(plan, "02")),
    (&["5", "6"], "Balls: the pure and the fast variant, by dimension.", ball::pure_and_fast),
    (&["7", "8"], "Balls: two numbers of points.", ball::two_numbers_of_points),
    (&["9", "10"], "Balls: four distributions.", ball::four_distributions),
    (&["11", "12"], "Balls: by ε, with USPS.", ball::by_epsilon),
    (&["13"], "Balls: low dimensions.", ball::low_dimensions),
    (&["14"], "Balls: beside exact codes.", ball::beside_exact_codes),
    (&["15"], "Balls: beside Bădoiu and Clarkson.", ball::beside_badoiu_clarkson),
    (&["18"], "Ellipsoids: sizes of core-sets, by dimension and by ε.", ellipsoid::figures),
    (&["21"], "Curves: the crude method and its jagged result.", |plan| curve::write(plan, "21")),
    (&["22"], "Curves: the crude method at sharp turns.", |plan| curve::write(plan, "22")),
    (&["5.2.2"], "2¹⁵ of 2³⁰ numbers at random, in order.", memory::subset),
    (
        &["49", "50"],
        "Distribution sort with one and two levels over a library's sort.",
        memory::sorts,
    ),
    (&["52"], "Diamonds over cities of the USA.", outofcore::figure_52),
    (&["53"], "Triangulations larger than memory: times.", outofcore::figure_53),
    (&["62"], "The largest ellipse in a projection of the bunny.", ellipse::write),
    (&["76", "77"], "Dops: the share covered, by their number.", dops::figures),
    (&["table-4", "table-5", "table-6"], "Dops: times and shares covered.", dops::tables),
    (&["56"], "Hands: errors by the width of the kernel.", recognize::figure_56),
    (
        &["table-2", "57", "58", "59", "60"],
        "Hands: errors of identification and verification on synthetic scans.",
        recognize::table_2,
    ),
    (&["table-3"], "Breast cancer: accuracies, beside scikit-learn.", recognize::table_3),
    (&["table-1"], "Surfaces: times and topology, with pictures.", surface::write),
];

/// Reruns what was asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list || arguments.names.is_empty() {
        for (names, about, _) in RERUNS {
            println!("{:<10} {about}", names.join(", "));
        }
        return Ok(());
    }
    let all: Vec<&str> = RERUNS.iter().flat_map(|(names, ..)| *names).copied().collect();
    let is_wanted = |name: &str| arguments.names.iter().any(|word| word == name || word == "all");
    for word in &arguments.names {
        let is_known = word == "all" || all.contains(&word.as_str());
        ensure!(is_known, "no figure or table is called `{word}`: see `bench thesis --list`");
    }
    let plan = Plan {
        size: match (arguments.full, arguments.quick) {
            (true, _) => Size::Full,
            (_, true) => Size::Quick,
            _ => Size::Usual,
        },
        context: Context {
            runs: arguments.runs as usize,
            quick: arguments.quick,
            threads: vec![1],
            peers: &[],
            seeds: 1..2,
            limit: Duration::from_secs(arguments.budget),
            peer_budget: Duration::from_secs(arguments.budget),
            scratch: None,
            temp: TempDir::new()?,
        },
        out: arguments.out.clone(),
    };
    std::fs::create_dir_all(&plan.out)?;
    println!("Machine and versions: {}\n", machine::describe());
    let mut wanted = RERUNS.iter().filter(|(names, ..)| names.iter().any(|name| is_wanted(name)));
    wanted.try_for_each(|(_, _, run)| run(&plan))
}
