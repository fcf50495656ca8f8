//! `taut stream`: the Delaunay triangulation of points that come in a coherent order, simplices leaving meanwhile.

use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::Monitor;
use taut::delaunay::outofcore::{
    Coherence, Dim, Dimension, Stream, StreamOptions, TakeSimplex, Totals,
};
use taut_io::{RowForm, RowStream};

use crate::clock::Clock;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::size;
use crate::output::numbers::{count, counted};
use crate::output::writing;
use crate::reports::{self, Field};

/// Memory if nothing else is asked for.
const MEMORY_DEFAULT: &str = "192M";
/// Bytes of simplices that are written at once.
const WRITE_BYTES: usize = 1 << 16;

/// Triangulate points while they come; finished simplices leave at once.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Points come once, from standard input, as lines of numbers or, with --raw, as little-endian f64. The stream must say where no \
more points will come: --sorted x promises that x never falls. With --depth L the box is cut into 2^L cells along each axis, and \
a row of NaN and a number, nan,17 in the plane and nan,17,0 in space, says that cell 17 is complete; cells are counted along x \
first. Points are numbered from 0 in the order they come; such rows are not counted.
Simplices leave as lines of the numbers of their vertices, positively oriented, or with --raw-out as little-endian u64. Of equal \
points the first stands for all. The summary goes to standard error.
Exit: 0 done · 2 bad input or usage: what was finished before has left
Example: sort -g points.csv | taut stream --box 0,0,1,1 --sorted x > triangles.csv
See: docs/delaunay.md for the order of points, and taut delaunay for points in files")]
pub(crate) struct Args {
    /// Where points come from; - is standard input
    #[arg(value_name = "POINTS", default_value = "-")]
    points: PathBuf,
    /// A box that holds all points: the smallest coordinates, then the largest
    #[arg(
        long = "box",
        alias = "within",
        value_name = "X,Y,..",
        value_delimiter = ',',
        allow_negative_numbers = true,
        required = true
    )]
    within: Vec<f64>,
    /// Coordinates along this axis never fall
    #[arg(long, value_name = "AXIS", value_parser = ["x", "y", "z"], required_unless_present = "cells")]
    sorted: Option<String>,
    /// Points come cell by cell, of 2^L along each axis, and the stream says which are complete
    #[arg(long = "depth", alias = "cells", value_name = "L", conflicts_with = "sorted")]
    cells: Option<u32>,
    /// Most memory, at least 32M
    #[arg(long, value_name = "SIZE", default_value = MEMORY_DEFAULT, value_parser = size::parse)]
    memory: u64,
    /// Points come as little-endian f64 without anything between
    #[arg(long)]
    raw: bool,
    /// Simplices leave as little-endian u64 without anything between
    #[arg(long, help_heading = "Writing")]
    raw_out: bool,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match self.within.len() {
            4 => self.run_in::<2>(),
            6 => self.run_in::<3>(),
            n => bail!("--box has {n} numbers: 4 are a box of the plane, 6 one of space"),
        }
    }

    fn run_in<const D: usize>(&self) -> anyhow::Result<Outcome>
    where
        Dim<D>: Dimension<D>,
    {
        let watch = self.effort.start()?;
        let (name, input) = open(&self.points)?;
        let form = if self.raw { RowForm::Raw } else { RowForm::Text };
        let mut rows = RowStream::new(input, &name, form);
        let mut clock = Clock::start();
        let mut out = Simplices::new(self.raw_out);
        let found = watch.during("triangulating", |monitor| {
            monitor.pass(1, 0);
            self.triangulate::<D>(&mut rows, &mut out, monitor)
        });
        let (totals, counts) = match (found, out.has_closed) {
            (Ok(found), _) => found,
            // Whoever took the simplices wants no more of them.
            (Err(_), true) => return Ok(Outcome::Done),
            (Err(error), false) => return Err(error),
        };
        clock.lap("triangulating");
        if !self.effort.quiet {
            let place = if D == 2 { "the plane" } else { "space" };
            let points = counted(counts.rows, "point");
            let title = format!("Delaunay triangulation of {points} in {place}, as they came");
            let mut fields = fields(&totals, counts);
            fields.push(clock.field());
            writing::print_line(reports::text(&title, &fields).trim_end());
        }
        Ok(Outcome::Done)
    }

    fn triangulate<const D: usize>(
        &self,
        rows: &mut RowStream<Box<dyn Read>>,
        out: &mut Simplices,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<(Totals, StreamCounts)>
    where
        Dim<D>: Dimension<D>,
    {
        let mut within = [[0.0; D]; 2];
        within.as_flattened_mut().copy_from_slice(&self.within);
        let coherence = match (self.cells, self.sorted.as_deref()) {
            (Some(levels), _) => Coherence::Cells { levels },
            (None, Some("z")) => Coherence::Sorted { axis: 2 },
            (None, axis) => Coherence::Sorted { axis: usize::from(axis == Some("y")) },
        };
        let options = StreamOptions {
            within,
            coherence,
            memory: self.memory,
            vectors: true,
            monitor: *monitor,
        };
        let take: &mut TakeSimplex<'_> = &mut |vertices| out.take(vertices);
        let mut stream = Stream::new(options)?;
        let mut row = [0.0; D];
        while rows.next(&mut row)? {
            let pushed = match (row[0].is_nan(), self.cells) {
                (true, Some(_)) => stream.close(cell(row[1], rows)?, take),
                _ => stream.push(row, take),
            };
            pushed.map_err(|error| anyhow!("{}: {error}", rows.place()))?;
        }
        let counts = StreamCounts {
            rows: stream.rows(),
            front_most: stream.front_most(),
            first_after: stream.first_after(),
        };
        let totals = stream.end(take)?;
        out.flush()?;
        Ok((totals, counts))
    }
}

/// The number of a cell.
fn cell(x: f64, rows: &RowStream<Box<dyn Read>>) -> anyhow::Result<u64> {
    if (0.0..9e15).contains(&x) && x.fract() == 0.0 {
        Ok(x as u64)
    } else {
        bail!("{}: {x} is no number of a cell: expected a whole number from 0", rows.place())
    }
}

/// Opens a stream, with its name.
fn open(path: &Path) -> anyhow::Result<(String, Box<dyn Read>)> {
    if writing::is_stream(path) {
        return Ok(("standard input".to_owned(), Box::new(std::io::stdin().lock())));
    }
    let name = path.display().to_string();
    let file = std::fs::File::open(path).map_err(|source| anyhow!("{name}: {source}"))?;
    Ok((name, Box::new(file)))
}

/// What is known of a stream when its points have come.
struct StreamCounts {
    rows: u64,
    front_most: u64,
    first_after: Option<u64>,
}

fn fields(totals: &Totals, counts: StreamCounts) -> Vec<Field> {
    let equal = match totals.duplicates {
        0 => "no two points are equal".to_owned(),
        1 => "1 point equals another one".to_owned(),
        more => format!("{} points equal another one", count(more)),
    };
    let first = match counts.first_after {
        Some(rows) => format!("the first left after {} had come", counted(rows, "point")),
        None => "all left at the end".to_owned(),
    };
    vec![
        Field::new("sites", count(totals.sites)).remark(equal),
        Field::new("simplices", count(totals.simplices)).remark(first),
        Field::new("hull", counted(totals.hull, "facet")),
        Field::new("unfinished", count(counts.front_most)).remark("sites at most"),
        Field::new("fingerprint", totals.fingerprint.to_string())
            .remark("of the simplices, whatever their order"),
    ]
}

/// Simplices on their way to standard output.
struct Simplices {
    out: BufWriter<std::io::StdoutLock<'static>>,
    is_raw: bool,
    line: Vec<u8>,
    /// Whoever reads them has stopped.
    has_closed: bool,
}

impl Simplices {
    fn new(is_raw: bool) -> Self {
        let out = BufWriter::with_capacity(WRITE_BYTES, std::io::stdout().lock());
        Self { out, is_raw, line: Vec::new(), has_closed: false }
    }

    #[inline]
    fn take(&mut self, vertices: &[u64]) -> std::io::Result<()> {
        self.line.clear();
        if self.is_raw {
            vertices.iter().for_each(|row| self.line.extend(row.to_le_bytes()));
        } else {
            for &row in vertices {
                push_decimal(&mut self.line, row);
                self.line.push(b',');
            }
            if let Some(last) = self.line.last_mut() {
                *last = b'\n';
            }
        }
        let written = self.out.write_all(&self.line);
        self.note(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let written = self.out.flush();
        self.note(written)
    }

    fn note(&mut self, written: std::io::Result<()>) -> std::io::Result<()> {
        if let Err(error) = &written {
            self.has_closed = error.kind() == std::io::ErrorKind::BrokenPipe;
        }
        written
    }
}

/// Appends the digits of a number.
fn push_decimal(line: &mut Vec<u8>, mut number: u64) {
    let mut digits = [0u8; 20];
    let mut begin = digits.len();
    loop {
        begin -= 1;
        digits[begin] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    line.extend_from_slice(&digits[begin..]);
}
