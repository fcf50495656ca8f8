//! k centers of cities and of normal points, with and without outliers: time, nodes and the gap proved, each bound replayed.
//!
//! `TAUT_DATA=<folder> cargo run --release -p taut-enclose --example centers_speed -- 3 germany` takes medians of three runs of the
//! cases whose names contain a word that follows; all cases where none does. `held-out` names sets that nothing was tuned on.

use std::time::Instant;

use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Points, generate};

type Failed = Box<dyn std::error::Error>;

/// Longitudes and latitudes between which cities are taken.
type Window = [f64; 4];

const FRANCE: Window = [-5.0, 8.0, 42.0, 51.0];
const MEXICO: Window = [-117.0, -87.0, 14.0, 32.0];
const ITALY: Window = [6.5, 18.5, 36.5, 47.0];
const BALKANS: Window = [13.0, 30.0, 35.0, 48.0];
const CENTRAL_EUROPE: Window = [6.0, 15.0, 47.3, 55.0];
const EASTERN_EUROPE: Window = [14.0, 39.5, 44.0, 56.0];

#[derive(Clone, Copy)]
enum Set {
    /// A file of `ball`, whose rows end with two coordinates.
    File(&'static str),
    /// Places of at least a thousand inhabitants.
    Places(Window),
    /// Normal points of space.
    Normal(usize),
}

struct Case {
    name: &'static str,
    set: Set,
    k: usize,
    outliers: u64,
    epsilon: f64,
}

const GERMANY: Set = Set::File("d15112.tsp.xz");
const USA: Set = Set::File("usa13509.xy.xz");

const fn case(name: &'static str, set: Set, k: usize, outliers: u64, epsilon: f64) -> Case {
    Case { name, set, k, outliers, epsilon }
}

const CASES: &[Case] = &[
    case("germany 10", GERMANY, 10, 0, 1e-6),
    case("germany 12", GERMANY, 12, 0, 1e-6),
    case("germany 15", GERMANY, 15, 0, 0.01),
    case("usa 10", USA, 10, 0, 1e-6),
    case("usa 15", USA, 15, 0, 0.01),
    case("space 8", Set::Normal(10_000), 8, 0, 0.01),
    case("space 10", Set::Normal(10_000), 10, 0, 0.01),
    case("germany 4 outliers", GERMANY, 4, 5, 1e-3),
    case("usa 4 outliers", USA, 4, 5, 1e-3),
    case("france 4 outliers", Set::Places(FRANCE), 4, 5, 1e-3),
    case("mexico 4 outliers", Set::Places(MEXICO), 4, 5, 1e-3),
    case("germany 6 outliers", GERMANY, 6, 5, 1e-3),
    case("usa 6 outliers", USA, 6, 5, 1e-3),
    case("france 6 outliers", Set::Places(FRANCE), 6, 5, 1e-3),
    case("mexico 6 outliers", Set::Places(MEXICO), 6, 5, 1e-3),
    case("italy 12 held-out", Set::Places(ITALY), 12, 0, 1e-6),
    case("balkans 12 held-out", Set::Places(BALKANS), 12, 0, 1e-6),
    case("central 15", Set::Places(CENTRAL_EUROPE), 15, 0, 0.01),
    case("eastern 15", Set::Places(EASTERN_EUROPE), 15, 0, 0.01),
    case("italy 4 outliers held-out", Set::Places(ITALY), 4, 5, 1e-3),
    case("balkans 4 outliers held-out", Set::Places(BALKANS), 4, 5, 1e-3),
    case("italy 6 outliers held-out", Set::Places(ITALY), 6, 5, 1e-3),
    case("balkans 6 outliers held-out", Set::Places(BALKANS), 6, 5, 1e-3),
    case("central 6 outliers held-out", Set::Places(CENTRAL_EUROPE), 6, 5, 1e-3),
    case("eastern 6 outliers held-out", Set::Places(EASTERN_EUROPE), 6, 5, 1e-3),
    case("germany 20", GERMANY, 20, 0, 0.01),
];

fn text(name: &str) -> Result<String, Failed> {
    let file = std::fs::File::open(format!("{}/{name}", std::env::var("TAUT_DATA")?))?;
    Ok(std::io::read_to_string(liblzma::read::XzDecoder::new(file))?)
}

/// The numbers of a line, if it is made of numbers.
fn numbers(line: &str, separator: char) -> Option<Vec<f64>> {
    line.split(separator).filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect()
}

impl Set {
    /// Coordinates and dimension.
    fn read(self) -> Result<(Vec<f64>, usize), Failed> {
        Ok(match self {
            Set::File(name) => {
                let text = text(&format!("ball/{name}"))?;
                let rows = text.lines().filter_map(|line| numbers(line, ' '));
                let rows = rows.filter(|row| row.len() >= 2);
                (rows.flat_map(|row| row[row.len() - 2..].to_vec()).collect(), 2)
            }
            Set::Places([west, east, south, north]) => {
                let text = text("delaunay/geonames_cities1000.csv.xz")?;
                let rows = text.lines().filter_map(|line| numbers(line, ','));
                let is_inside = |row: &[f64]| {
                    (west..=east).contains(&row[0]) && (south..=north).contains(&row[1])
                };
                let rows = rows.filter(|row| is_inside(row));
                (rows.flat_map(|row| row[..2].to_vec()).collect(), 2)
            }
            Set::Normal(n) => (generate(Distribution::Normal, n, 3, 42)?, 3),
        })
    }
}

fn main() -> Result<(), Failed> {
    let mut words = std::env::args().skip(1);
    let runs: usize = words.next().map_or(Ok(3), |word| word.parse())?;
    let words: Vec<String> = words.collect();
    println!(
        "case | points | median, s | nodes | radius | gap | proof nodes | core-set | check, s | stop"
    );
    for case in CASES {
        if !words.is_empty() && !words.iter().any(|word| case.name.contains(word.as_str())) {
            continue;
        }
        let (values, dim) = case.set.read()?;
        let points = Points::new(&values, dim)?;
        let options = CentersOptions {
            epsilon: case.epsilon,
            outliers: case.outliers,
            ..CentersOptions::default()
        };
        let mut seconds = vec![];
        let mut solve = || {
            let start = Instant::now();
            let found = centers(&points, case.k, &options);
            seconds.push(start.elapsed().as_secs_f64());
            found
        };
        let found = solve()?;
        for _ in 1..runs {
            assert_eq!(solve()?, found, "two runs differ");
        }
        seconds.sort_by(f64::total_cmp);
        let start = Instant::now();
        let verdict = found.check(&points)?;
        let check = start.elapsed().as_secs_f64();
        println!(
            "{} | {} | {:.4} | {} | {} | {:.2e} | {} | {} | {check:.3} | {:?}",
            case.name,
            points.len(),
            seconds[seconds.len() / 2],
            found.trace.iterations,
            found.answer.radius,
            verdict.gap,
            verdict.branches,
            found.certificate.core_set.len(),
            found.trace.stop,
        );
    }
    Ok(())
}
