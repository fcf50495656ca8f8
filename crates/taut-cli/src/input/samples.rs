//! Samples of closed curves in place of the rings of a polygon: they are joined before the search.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::certify::Curve;
use taut::points::{PointSource, Scratch};
use taut::{CurveOptions, curve};

use crate::input::reading::Opened;
use crate::output::numbers::{coordinates, counted, short};
use crate::output::writing::{Outputs, print_error};
use crate::pipeline::{Input, Output};
use crate::reports::Field;

/// How points become rings.
#[derive(Debug, clap::Args)]
pub(crate) struct Samples {
    /// Take points as samples of closed curves in any order, and join them first as `taut curve` does; what is proved is proved of
    /// the polygon found, and the report says whether the samples are dense enough for it
    #[arg(long)]
    samples: bool,
    /// Of --samples, write the polygon found as .csv with columns x, y, ring, for `taut verify`
    #[arg(long, value_name = "FILE", requires = "samples", help_heading = "Writing")]
    ring: Option<PathBuf>,
}

impl Samples {
    /// Refuses to write an answer about a polygon that is written nowhere.
    pub(crate) fn check(&self, output: Output<'_>) -> anyhow::Result<()> {
        if self.samples && self.ring.is_none() && output.out.is_some() {
            bail!(
                "option `--samples` with -o needs --ring FILE: `taut verify` asks for the polygon"
            );
        }
        Ok(())
    }

    /// Opens the rings, or the samples and joins them.
    pub(crate) fn open(&self, input: Input<'_>) -> anyhow::Result<Opened> {
        if let Some(path) = &self.ring
            && path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv"))
        {
            bail!("{}: --ring writes CSV; name it .csv", path.display());
        }
        let opened = input.reading.open(input.path)?;
        if !self.samples {
            return Ok(opened);
        }
        let joined = curve(opened.source(), &CurveOptions::default())
            .map_err(|error| opened.explain(error))?;
        let verdict = joined.check(opened.source())?;
        let found = joined.answer;
        let outliers = found.outliers.len();
        if outliers > 0 && !input.effort.quiet {
            print_error(&format!("{}: no curve accounts for {outliers} points", opened.name()));
        }
        let text = rings(&found, opened.name())?;
        let name = format!("the polygon through {}.csv", opened.name());
        let polygon = Opened::of_bytes(text.as_bytes(), &name)?;
        Ok(polygon.noted(said(&found, verdict.doubt.map(|doubt| doubt.to_string()))))
    }

    /// The file of the polygon, if it is asked for.
    pub(crate) fn files(&self) -> Vec<&Path> {
        self.ring.as_deref().into_iter().collect()
    }

    /// Prepares the file of the polygon.
    pub(crate) fn write(&self, polygon: &Opened, outputs: &mut Outputs) -> anyhow::Result<()> {
        let Some(path) = &self.ring else { return Ok(()) };
        let source: &dyn PointSource = polygon.source();
        let mut scratch = Scratch::new();
        let rows = source.read(0..source.len(), &mut scratch)?;
        let mut text = HEADER.to_owned();
        let mut point = [0.0; 3];
        for row in 0..rows.len() {
            rows.copy_row(row, &mut point);
            writeln!(text, "{}", line(point))?;
        }
        outputs.add(path, text.as_bytes())
    }
}

/// Returns what is known of curves through samples: whether they are certified, and where else a curve was perhaps open.
fn said(found: &Curve, doubt: Option<String>) -> Field {
    let curves = counted(found.curves.len() as u64, "closed curve");
    let field = Field::evidence("samples", format!("joined to {curves}"));
    let Some(doubt) = doubt else { return field.remark("sampled densely enough") };
    let all = || {
        found.curves.iter().flat_map(|curve| {
            let next = curve.vertices.iter().cycle().skip(1);
            curve.vertices.iter().zip(next)
        })
    };
    let length = |(a, b): &(&[f64; 2], &[f64; 2])| (b[0] - a[0]).hypot(b[1] - a[1]);
    let longest = all().max_by(|one, other| length(one).total_cmp(&length(other)));
    let gap = longest.map_or(String::new(), |edge| {
        let ([a, b], length) =
            ([edge.0, edge.1].map(|p| coordinates(p, length(&edge))), length(&edge));
        format!(
            "; if a curve is open, the polygon closes it: its longest edge, {}, is from {a} to {b}",
            short(length)
        )
    });
    field.remark(format!("not certified: {doubt}{gap}"))
}

/// The names of the columns of a polygon.
const HEADER: &str = "x,y,ring\n";

/// A row of a polygon; numbers are read back to the same bits.
fn line([x, y, ring]: [f64; 3]) -> String {
    format!("{x:?},{y:?},{ring}")
}

/// Closed curves as rings; a curve with ends is refused.
fn rings(found: &Curve, name: &str) -> anyhow::Result<String> {
    let mut text = HEADER.to_owned();
    for (ring, component) in found.curves.iter().enumerate() {
        if let (false, [first, .., last]) = (component.closed, &component.vertices[..]) {
            bail!(
                "{name}: the samples make a curve with ends, at ({:?}, {:?}) and ({:?}, {:?}), which holds no polygon: add samples \
                 between them, or give the rings in order without --samples",
                first[0],
                first[1],
                last[0],
                last[1]
            );
        }
        for [x, y] in &component.vertices {
            writeln!(text, "{}", line([*x, *y, ring as f64]))?;
        }
    }
    match found.curves.is_empty() {
        true => bail!("{name}: no curve was found through the samples"),
        false => Ok(text),
    }
}
