//! Defines how points are read, the same for every subcommand that reads some.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{anyhow, bail};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use taut::certify::{Fault, ReadingChoice, ScaleChoice, Violation};
use taut::enclose::{Error as SolveError, SearchError};
use taut::inscribe::Error as InscribeError;
use taut::points::{InputError, ReadError, ScalarKind, shown_number};
use taut::{AnySolution, PointSource};
use taut_io::{
    Bounds, Columns, Content, Feature, Format, Header, Input, RawLayout, ReadOptions, Thinning,
};

use crate::input::heights::HeightColumn;
use crate::input::obstacles::Obstacles;
use crate::input::size;
use crate::input::table::{NUMERIC, TableOptions};
use crate::input::units;
use crate::output::numbers::{bytes, coordinates};
use crate::output::writing;
use crate::reports::{Field, remark_of_rows, share};
use crate::watch::Watch;

#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Reading")]
pub(crate) struct Reading {
    /// Format of the points; `taut formats` lists them [default: told by the name]
    #[arg(long, value_name = "F", value_parser = formats(Format::reads), hide_possible_values = true)]
    format: Option<Format>,
    /// Columns that are coordinates, by name, number from 0 or range: x,y,z or 0-2,5 or 1-; or `numeric`, those of a text file that hold
    /// numbers alone [default: all]
    #[arg(long, value_name = "LIST")]
    columns: Option<String>,
    #[command(flatten)]
    table: TableOptions,
    /// Of a GeoJSON, WKT, SVG, npz or shapefile the feature, array or shape to read, by its number from 0 or its name: in GeoJSON the
    /// property `name`, in SVG the id of a path, in npz that of an array [default: the only one; all shapes]
    #[arg(long, value_name = "NAME|NUMBER")]
    select: Option<Feature>,
    /// Of a LAS or LAZ file the classes of points to keep, such as 2 or 2,9; points are numbered after that [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    classes: Option<Vec<u8>>,
    /// Keep the points in a box, given as XMIN,YMIN,XMAX,YMAX or with more coordinates; points are numbered after that
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    bounds: Option<Bounds>,
    /// Keep the first point in each cell of a grid with this side; points are numbered after that
    #[arg(long, value_name = "LENGTH", value_parser = side)]
    thin: Option<f64>,
    /// States whether the first row of a text file holds names
    #[arg(long, value_name = "WHEN", default_value = "auto", value_parser = header())]
    header: Header,
    /// Most memory for points, such as 512M or 2GiB; what is larger is read from disk [default: all]
    #[arg(long, value_name = "SIZE", value_parser = size::parse)]
    memory: Option<u64>,
    /// Coordinates of a point in a raw file, at least 1
    #[arg(long, value_name = "D")]
    raw_dim: Option<usize>,
    /// Type of a coordinate in a raw file, little-endian
    #[arg(long = "type", alias = "raw-type", value_name = "TYPE", value_parser = scalar())]
    raw_type: Option<ScalarKind>,
    /// Bytes before the first coordinate in a raw file [default: 0]
    #[arg(long, value_name = "BYTES")]
    raw_offset: Option<u64>,
    /// A column that is a height, and no axis of the grid that thins.
    #[arg(skip)]
    height: Option<String>,
}

pub(crate) fn formats(
    usable: fn(Format, Content) -> bool,
) -> impl TypedValueParser<Value = Format> {
    let names = Format::all()
        .filter(move |&format| usable(format, Content::Points))
        .map(|format| PossibleValue::new(format.name()).help(format.description(Content::Points)));
    PossibleValuesParser::new(names).try_map(|name| name.parse::<Format>())
}

pub(crate) fn scalar() -> impl TypedValueParser<Value = ScalarKind> {
    PossibleValuesParser::new(["f32", "f64"]).map(|name| match name.as_str() {
        "f32" => ScalarKind::F32,
        _ => ScalarKind::F64,
    })
}

fn side(text: &str) -> Result<f64, String> {
    let side = text.parse::<f64>().ok().filter(|side| *side > 0.0 && side.is_finite());
    side.ok_or_else(|| "expected a length of more than 0".to_owned())
}

fn header() -> impl TypedValueParser<Value = Header> {
    PossibleValuesParser::new(["auto", "present", "absent"]).map(|name| match name.as_str() {
        "present" => Header::Present,
        "absent" => Header::Absent,
        _ => Header::Auto,
    })
}

impl Reading {
    /// The memory that was asked for.
    pub(crate) fn memory(&self) -> Option<u64> {
        self.memory
    }

    /// The same for points that leave most of `memory` to the work on them: what takes more than an eighth is read from disk.
    pub(crate) fn beside_work(&self, memory: u64) -> Self {
        Self { memory: Some(memory / 8), ..self.clone() }
    }

    /// The same where a column is a height.
    pub(crate) fn with_height(&self, height: Option<&str>) -> Self {
        Self { height: height.map(str::to_owned), ..self.clone() }
    }

    pub(crate) fn options(&self) -> anyhow::Result<ReadOptions> {
        let raw = match (self.raw_dim, self.raw_type) {
            (Some(dim), Some(scalar)) => {
                Some(RawLayout { dim, scalar, offset: self.raw_offset.unwrap_or(0) })
            }
            (None, None) if self.raw_offset.is_none() => None,
            _ => return Err(anyhow!("a raw file needs both --raw-dim D and --type f32|f64")),
        };
        let columns = self.columns.as_deref().filter(|columns| *columns != NUMERIC);
        Ok(ReadOptions {
            format: self.format.or(raw.map(|_| Format::Raw)),
            numeric: self.columns.as_deref() == Some(NUMERIC),
            columns: columns.map(str::parse).transpose()?,
            label: self.table.id.clone(),
            missing: self.table.missing(),
            decimal: self.table.decimal(),
            header: self.header,
            memory: self.memory,
            feature: self.select.clone(),
            classes: self.classes.clone(),
            bounds: self.bounds.clone(),
            thinning: self.thin.map(|cell| Thinning { cell, except: self.height.clone() }),
            raw,
            temp_dir: None,
        })
    }

    /// Opens the points of `path`; `-` is standard input.
    pub(crate) fn open(&self, path: &Path) -> anyhow::Result<Opened> {
        if path == Path::new("-") && std::io::stdin().is_terminal() {
            writing::print_error("reading points from the terminal; Ctrl-D ends them");
        }
        let options = self.options()?;
        let input = match taut_io::open(path, &options) {
            // A stream cannot be read twice.
            Err(
                taut_io::Error::NoNames { .. }
                | taut_io::Error::ColumnName { .. }
                | taut_io::Error::ColumnNumber { .. },
            ) if self.table.is_id_stored && !writing::is_stream(path) => {
                taut_io::open(path, &ReadOptions { label: None, ..options })
            }
            input => input,
        };
        Opened::of(input?).chosen(self.choice(), self.table.units.as_ref())
    }

    /// Returns what was chosen, for the JSON of an answer.
    fn choice(&self) -> Option<ReadingChoice> {
        let choice = ReadingChoice { columns: self.columns.clone(), ..self.table.choice() };
        (choice != ReadingChoice::default()).then_some(choice)
    }

    /// The same, with what was chosen for an answer where nothing else is asked for.
    pub(crate) fn as_for(&self, choice: Option<&ReadingChoice>) -> anyhow::Result<Self> {
        let Some(choice) = choice else { return Ok(self.clone()) };
        let columns = self.columns.clone().or_else(|| choice.columns.clone());
        Ok(Self { columns, table: self.table.as_for(choice)?, ..self.clone() })
    }

    /// The same, but says before how much disk the points of a laser scan take while the work lasts, and refuses what surely does
    /// not fit.
    pub(crate) fn open_told(&self, path: &Path, watch: &Watch) -> anyhow::Result<Opened> {
        let options = self.options()?;
        let needed = taut_io::spill_bytes(path, &options);
        if needed > 0 {
            let folder = std::env::temp_dir();
            let (name, keeps_all) = (path.display(), self.keeps_all());
            watch.print(&format!(
                "{name}: {}{} of disk will be taken in {} by its points, which are decoded once",
                if keeps_all { "" } else { "up to " },
                bytes(needed),
                folder.display()
            ));
            let free = taut_io::free_bytes(&folder.join("points"));
            if let Some(free) = free.filter(|&free| keeps_all && free < needed) {
                bail!(
                    "{name}: its points need {} of disk in {}, but {} are free: set TMPDIR to a folder with more room, or allow more memory",
                    bytes(needed),
                    folder.display(),
                    bytes(free)
                );
            }
        }
        self.open(path)
    }

    /// The format that was asked for.
    pub(crate) fn format(&self) -> Option<Format> {
        self.format
    }

    /// Tests whether no option asks for some rows or columns, or for another way to read cells.
    pub(crate) fn is_plain(&self) -> bool {
        self.keeps_all()
            && self.columns.is_none()
            && self.select.is_none()
            && self.header == Header::Auto
            && self.table.choice() == ReadingChoice::default()
    }

    /// Tests whether all points are kept.
    fn keeps_all(&self) -> bool {
        self.classes.is_none() && self.bounds.is_none() && self.thin.is_none()
    }

    /// Opens the points of `path`, with a column of labels if one is named, and with the columns of these names where the file has
    /// names and no others were asked for.
    pub(crate) fn open_labeled(
        &self,
        path: &Path,
        label: Option<&str>,
        names: &[String],
    ) -> anyhow::Result<Opened> {
        let mut options = self.options()?;
        if options.label.is_some() {
            bail!("--id names points of answers, not of classes: leave it out");
        }
        options.label = label.map(str::to_owned);
        if options.columns.is_none() && !names.is_empty() {
            let columns = Some(Columns::of_names(names.iter().cloned()));
            match taut_io::open(path, &ReadOptions { columns, ..options.clone() }) {
                // A file without names has its columns in the order of the model; a stream cannot be read twice.
                Err(taut_io::Error::NoNames { .. }) if !writing::is_stream(path) => {}
                opened => return Ok(Opened::of(opened?)),
            }
        }
        Ok(Opened::of(taut_io::open(path, &options)?))
    }

    /// Opens the triangles of the mesh of `path`, a row for each, and what bodies in it stay clear of; see [`Obstacles`].
    pub(crate) fn open_mesh(&self, path: &Path, obstacles: &Obstacles) -> anyhow::Result<Opened> {
        obstacles.around(Opened::of(taut_io::open_triangles(path, &self.options()?)?), self)
    }

    /// Opens the rows of an obstacle: of a mesh its triangles, else points.
    pub(super) fn open_obstacle(&self, path: &Path) -> anyhow::Result<Opened> {
        let options = self.options()?;
        let input = match taut_io::open_triangles(path, &options) {
            // A mesh without triangles is a cloud of points.
            Err(taut_io::Error::EmptyMesh { .. }) => taut_io::open(path, &options)?,
            opened => opened?,
        };
        Ok(Opened::of(input))
    }

    /// Opens the rows that an answer of some kind is about.
    pub(crate) fn open_for(
        &self,
        path: &Path,
        obstacles: &Obstacles,
        answer: &AnySolution,
    ) -> anyhow::Result<Opened> {
        match answer {
            AnySolution::Bodies(_) => self.open_mesh(path, obstacles),
            _ => {
                obstacles.refuse()?;
                self.open(path)
            }
        }
    }
}

/// Points that were opened, and what is known of their file.
pub(crate) struct Opened {
    input: Input,
    /// What is known of how they were read, or made of other points.
    notes: Vec<Field>,
    /// The choices that were made when they were read.
    choice: Option<ReadingChoice>,
    /// The points with their heights, where one column is a height.
    heights: Option<HeightColumn>,
}

impl Opened {
    fn of(input: Input) -> Self {
        let notes = missing_rows(&input).into_iter().collect();
        Opened { input, notes, choice: None, heights: None }
    }

    /// The same points, with how they were chosen, and in units if there are some.
    fn chosen(
        mut self,
        choice: Option<ReadingChoice>,
        units: Option<&ScaleChoice>,
    ) -> anyhow::Result<Self> {
        self.choice = choice;
        match units {
            Some(units) => self.in_units(units.clone()),
            None => Ok(self),
        }
    }

    /// The same points with each column divided by its unit.
    pub(crate) fn in_units(mut self, scale: ScaleChoice) -> anyhow::Result<Self> {
        let names = self.names(self.input.source.dim());
        self.notes.push(units::note(&scale, &names));
        let scaled = units::Scaled::new(self.input.source, scale.units.clone());
        self.input.source = Box::new(scaled.map_err(|why| anyhow!("{}: {why}", self.input.path))?);
        self.choice.get_or_insert_default().scale = Some(scale);
        Ok(self)
    }

    pub(crate) fn of_bytes(bytes: &[u8], name: &str) -> anyhow::Result<Self> {
        let input = taut_io::open_bytes(bytes.to_vec(), name, &ReadOptions::default())?;
        Ok(Opened::of(input))
    }

    /// The same points, with one thing more that is known of how they were made.
    pub(crate) fn noted(mut self, note: Field) -> Self {
        self.notes.push(note);
        self
    }

    /// What is known of how the points were read, or made of others.
    pub(crate) fn notes(&self) -> Vec<Field> {
        self.notes.clone()
    }

    /// The choices that were made when they were read, for the JSON of an answer.
    pub(crate) fn choice(&self) -> Option<ReadingChoice> {
        self.choice.clone()
    }

    /// Has fields name rows by their numbers in the file and, where rows have names, by these.
    pub(crate) fn name_rows(&self, fields: &mut [Field]) {
        if self.input.dropped_rows() == 0 && self.labels().is_empty() {
            return;
        }
        for field in fields.iter_mut().filter(|field| !field.rows.is_empty()) {
            let own = remark_of_rows(&field.rows, |row| row.saturating_add(1).to_string());
            let named = remark_of_rows(&field.rows, |row| self.row_name(row));
            if let (Some(remark), Some(own), Some(named)) = (&mut field.remark, own, named) {
                *remark = remark.replacen(&own, &named, 1);
            }
        }
    }

    /// The number of a row in the file, from 1, and its name if it has one.
    pub(crate) fn row_name(&self, row: u64) -> String {
        let name = usize::try_from(row).ok().and_then(|row| self.labels().get(row));
        match name {
            Some(name) => format!("{} ({name})", self.row(row)),
            None => self.row(row).to_string(),
        }
    }

    /// The same file with other points.
    pub(super) fn with_source(mut self, source: Box<dyn PointSource>, name: String) -> Self {
        (self.input.source, self.input.path) = (source, name);
        self
    }

    /// The same file with other points, made from the points as they were read.
    pub(super) fn picked(
        mut self,
        pick: impl FnOnce(Arc<dyn PointSource>) -> (Box<dyn PointSource>, HeightColumn),
    ) -> Self {
        let (places, heights) = pick(Arc::from(self.input.source));
        self.input.source = places;
        Opened { heights: Some(heights), ..self }
    }

    /// The points with their heights, where one column is a height.
    pub(crate) fn heights(&self) -> Option<&HeightColumn> {
        self.heights.as_ref()
    }

    /// The vertices of a mesh: the points, with their heights last where one column is a height.
    pub(crate) fn vertices(&self) -> &dyn PointSource {
        self.heights.as_ref().map_or(&*self.input.source, |heights| &heights.solid)
    }

    pub(crate) fn source(&self) -> &dyn PointSource {
        &*self.input.source
    }

    /// What the points leave of `memory`, but not less than 64 MiB of it.
    pub(crate) fn memory_left(&self, memory: u64) -> u64 {
        let source = self.heights.as_ref().map_or(&*self.input.source, |heights| &*heights.points);
        let held = match source.in_memory() {
            Some(_) => source.len().saturating_mul(8 * source.dim() as u64),
            None => 0,
        };
        memory.saturating_sub(held).max(memory.min(64 << 20))
    }

    /// The file as shown to people.
    pub(crate) fn name(&self) -> &str {
        &self.input.path
    }

    /// The label of each point, where they were asked for.
    pub(crate) fn labels(&self) -> &[String] {
        &self.input.labels
    }

    /// Names of the first `dim` coordinates, as far as the file has some.
    pub(crate) fn names(&self, dim: usize) -> Vec<String> {
        self.input.columns.iter().take(dim).cloned().collect()
    }

    /// Returns what a solver refused, with the place in the file, which it cannot know.
    pub(crate) fn explain(&self, error: impl Into<taut::Error>) -> anyhow::Error {
        match error.into() {
            taut::Error::Input(error) => self.explain_input(error),
            taut::Error::Enclose(error) => self.explain_enclosing(error),
            taut::Error::Search(error) => self.explain_searching(error),
            taut::Error::Inscribe(error) => self.explain_inscribing(error),
            other => anyhow!("{}: {other}", self.name()),
        }
    }

    /// Returns the same, with another name for an option: that of the library, and that of the command line.
    pub(crate) fn explain_option(
        &self,
        error: impl Into<taut::Error>,
        [library, own]: [&str; 2],
    ) -> anyhow::Error {
        match error.into() {
            taut::Error::Input(InputError::Option { name, value, expected }) if name == library => {
                wrong_option(own, &value, expected)
            }
            other => self.explain(other),
        }
    }

    /// Returns what any solver refuses.
    fn explain_input(&self, error: InputError) -> anyhow::Error {
        match error {
            InputError::NonFinite { row, column, value } => {
                let column = self.heights.as_ref().map_or(column, |heights| heights.axes[column]);
                self.not_finite(row, column, value)
            }
            InputError::Dimension { dim, expected } => anyhow!(
                "{}: points have {dim} coordinate{}: expected {expected}; choose them with --columns",
                self.name(),
                if dim == 1 { "" } else { "s" }
            ),
            InputError::Option { name, value, expected } => wrong_option(name, &value, expected),
            InputError::Read(error) => self.reading_failed(error),
            InputError::Cancelled(_) => error.into(),
            other => anyhow!("{}: {other}", self.name()),
        }
    }

    /// Returns what is refused of balls, ellipsoids, weights and half-spaces.
    fn explain_enclosing(&self, error: SolveError) -> anyhow::Error {
        let last = self.input.source.dim() - 1;
        match error {
            SolveError::NegativeRadius { row, value } => anyhow!(
                "{}: the radius is {}, and radii (the last column with --balls) must be at least 0: repair \
                 or remove that row, or choose the columns with --columns",
                self.input.describe_cell(row, last),
                shown_number(value)
            ),
            SolveError::NoRadius { .. } => anyhow!(
                "{}: a ball needs a center and a radius, at least two columns, but there is one: leave out --balls \
                 or choose more with --columns",
                self.name()
            ),
            SolveError::NonPositiveWeight { row, value } => anyhow!(
                "{}: the weight is {}, and weights (the last column with --weights) must be more than 0: repair \
                 or remove that row, or choose the columns with --columns",
                self.input.describe_cell(row, last),
                shown_number(value)
            ),
            SolveError::NoWeight { .. } => anyhow!(
                "{}: a point with a weight needs a coordinate and a weight, at least two columns, but there is one: \
                 leave out --weights or choose more with --columns",
                self.name()
            ),
            SolveError::NoShape { columns } => anyhow!(
                "{}: ellipsoids in dimension d have d(d + 3)/2 columns, 2, 5, 9, 14, …, the center and the lower \
                 triangle of the shape matrix, but there are {columns}: leave out --ellipsoids or choose others with \
                 --columns",
                self.name()
            ),
            SolveError::NegativeShape { row } => anyhow!(
                "{}, row {}: the shape matrix of ellipsoid {row} is not positive semidefinite: its eigenvalues, the \
                 squared half axes, must be at least 0; repair or remove that row, or choose the columns with \
                 --columns",
                self.name(),
                self.row(row)
            ),
            SolveError::NoNormal { .. } if last == 0 => anyhow!(
                "{}: a half-space needs a normal and an offset, at least two columns, but there is one: choose more \
                 with --columns",
                self.name()
            ),
            SolveError::NoNormal { row } => anyhow!(
                "{}, row {}: the half-space has no normal, as all numbers but the last, the offset, are 0: repair or \
                 remove that row, or choose the columns with --columns",
                self.name(),
                self.row(row)
            ),
            SolveError::Unbounded { direction } => anyhow!(
                "{}: the polytope is unbounded in the direction {}, so no ellipsoid in it is the largest: add \
                 half-spaces that end it",
                self.name(),
                coordinates(&direction, 1.0)
            ),
            SolveError::NoInterior { rows, radius, .. } => anyhow!(
                "{}: the polytope has no interior point, or hardly any: a ball in it has at most {radius:.0e} times its \
                 extent as radius, so there is no ellipsoid; the half-spaces of {} say so",
                self.name(),
                self.rows(&rows)
            ),
            SolveError::Undecided => anyhow!("{}: {error}", self.name()),
            SolveError::Empty | SolveError::Overflow => anyhow!("{}: {error}", self.name()),
            other => other.into(),
        }
    }

    /// Returns what is refused of points, balls and rays in queries; of balls it is what solvers refuse.
    fn explain_searching(&self, error: SearchError) -> anyhow::Error {
        match error {
            SearchError::NegativeRadius { row, value } => {
                self.explain_enclosing(SolveError::NegativeRadius { row, value })
            }
            SearchError::NoRadius { columns } => {
                self.explain_enclosing(SolveError::NoRadius { columns })
            }
            SearchError::NoDirection { row } => anyhow!(
                "{}, row {}: the ray has no direction, as the numbers after the origin are all 0: repair or remove that row, or \
                 choose the columns with --columns",
                self.name(),
                self.row(row)
            ),
            other => anyhow!("{}: {other}", self.name()),
        }
    }

    /// Returns what is refused of rings, with rows of the file.
    fn explain_inscribing(&self, error: InscribeError) -> anyhow::Error {
        match error {
            InscribeError::NotSimple { edge, other } => {
                let [a, b, c, d] = [edge[0], edge[1], other[0], other[1]].map(|row| self.row(row));
                anyhow!(
                    "{}: the edge from row {a} to row {b} meets the edge from row {c} to row {d}: rings may neither cross nor \
                     touch themselves or each other",
                    self.name()
                )
            }
            InscribeError::RingNumber { row, value } => anyhow!(
                "{}, row {}: the number of the ring is {}: expected 0 in the first row, and in each other row that of the row \
                 before or one more",
                self.name(),
                self.row(row),
                shown_number(value)
            ),
            other => anyhow!("{}: {other}", self.name()),
        }
    }

    /// The number of a row in the file, from 1.
    pub(crate) fn row(&self, row: u64) -> u64 {
        self.input.row_in_file(row).saturating_add(1)
    }

    /// Numbers of rows in the file; of many, the first few.
    fn rows(&self, rows: &[u64]) -> String {
        const SHOWN_ROWS_MAX: usize = 8;
        let places: Vec<String> =
            rows.iter().take(SHOWN_ROWS_MAX).map(|&row| self.row(row).to_string()).collect();
        let more = rows.len().saturating_sub(SHOWN_ROWS_MAX);
        match (places.len(), more) {
            (1, _) => format!("row {}", places[0]),
            (_, 0) => format!("rows {}", places.join(", ")),
            (_, more) => format!("rows {} and {more} others", places.join(", ")),
        }
    }

    /// A coordinate that is NaN or infinite.
    pub(crate) fn not_finite(&self, row: u64, column: usize, value: f64) -> anyhow::Error {
        anyhow!(
            "{}: the value is {value}, and all coordinates must be finite: repair or remove that row{}, or \
             choose other columns with --columns",
            self.input.describe_cell(row, column),
            if value.is_nan() { ", leave out such rows with --missing drop" } else { "" }
        )
    }

    /// Why an answer was rejected: in which of the two files, and where, which a checker cannot know.
    pub(crate) fn explain_violation(&self, violation: &Violation, answer: &str) -> String {
        let points = self.name();
        match violation.fault(self.input.source.len()) {
            // Points count from 0, rows of a file from 1.
            Fault::Row(row) => format!("{points}, row {}: {violation}", self.row_name(row)),
            Fault::Points => format!("{points} does not belong to {answer}: {violation}"),
            Fault::Answer => format!("{answer}: {violation}"),
        }
    }

    /// Returns what went wrong while the points were read again.
    pub(crate) fn reading_failed(&self, error: ReadError) -> anyhow::Error {
        match error {
            // These name the file themselves.
            ReadError::Io { .. } | ReadError::Truncated { .. } => error.into(),
            other => anyhow!("{}: {other}", self.name()),
        }
    }
}

/// Says how many rows were left out because they lack a value.
fn missing_rows(input: &Input) -> Option<Field> {
    let dropped = input.dropped_rows();
    (dropped > 0).then(|| {
        Field::new("missing", share(dropped, input.rows_in_file())).remark(format!(
            "row{} left out, as a value is missing; rows are numbered as in the file",
            if dropped == 1 { "" } else { "s" }
        ))
    })
}

/// Returns what a library says of an option, under the name that the command line gives it.
pub(crate) fn wrong_option(name: &str, value: &str, expected: &str) -> anyhow::Error {
    anyhow!("option `--{}` is {value}: expected {expected}", name.replace('_', "-"))
}

/// The file of points, as every subcommand takes it.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Points {
    /// Points, in any format of `taut formats`; - is standard input
    #[arg(value_name = "POINTS")]
    pub(crate) path: PathBuf,
}

/// The file of half-spaces.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct HalfSpaces {
    /// Half-spaces a·x ≤ b, in each row the d numbers of a, then b, in any format of `taut formats`; - is standard input
    #[arg(value_name = "HALF-SPACES")]
    pub(crate) path: PathBuf,
}
