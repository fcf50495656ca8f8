//! The parts that parquet and arrow share: choosing columns of a schema, and batches of columns to rows of points.

use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowPrimitiveType, Float16Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type,
    Int64Type, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, Schema};
use taut_points::{Scalar, ScalarKind, shown_number};

use super::Decoded;
use crate::input::Job;
use crate::labels;
use crate::sink::Sink;
use crate::{Columns, Error, Missing, Place};

/// Which columns of a schema are coordinates.
pub(super) struct Plan {
    /// Their numbers in the schema, in the order of the coordinates; of a list column only its own.
    numbers: Vec<usize>,
    names: Vec<String>,
    /// The column of labels and its name.
    label: Option<(usize, String)>,
    /// True if the only column holds whole points.
    list: bool,
    pub(super) scalar: ScalarKind,
}

impl Plan {
    /// The selected columns, or all numeric ones, or the only column of lists.
    pub(super) fn new(job: &Job<'_>, schema: &Schema) -> Result<Plan, Error> {
        let fields = schema.fields();
        let names: Vec<String> = fields.iter().map(|field| field.name().clone()).collect();
        let find = |wanted: fn(&DataType) -> bool| -> Vec<usize> {
            (0..fields.len()).filter(|&i| wanted(fields[i].data_type())).collect()
        };
        let none = |problem| {
            let typed = |field: &arrow_schema::FieldRef| {
                format!("{} ({})", field.name(), field.data_type())
            };
            let columns = fields.iter().map(typed).collect();
            Err(Error::NoCoordinates { path: job.path.to_owned(), problem, columns })
        };
        let label = job.options.label.as_deref().map(Columns::of_label);
        let label = label.map(|label| -> Result<(usize, Columns), Error> {
            let number = label.resolve(job.path, &names, fields.len())?[0];
            match fields[number].data_type() {
                kind if is_number(kind) || is_text(kind) => Ok((number, label)),
                kind => Err(not_numeric(job, &names[number], kind)),
            }
        });
        let label = label.transpose()?;
        let is_other = |number: &usize| label.as_ref().is_none_or(|label| label.0 != *number);
        let find = |wanted| find(wanted).into_iter().filter(is_other).collect::<Vec<_>>();
        let numbers = match &job.options.columns {
            Some(columns) => {
                let mut numbers = columns.resolve(job.path, &names, fields.len())?;
                numbers.retain(is_other);
                numbers
            }
            None => match find(is_number) {
                numbers if !numbers.is_empty() => numbers,
                _ => match find(is_list) {
                    lists if lists.is_empty() => return none("no numeric column"),
                    lists if lists.len() > 1 => return none("several columns of lists"),
                    lists => lists,
                },
            },
        };
        if let Some((_, label)) = &label {
            labels::check_others(numbers.len(), label)?;
        }
        let list = numbers.len() == 1 && is_list(fields[numbers[0]].data_type());
        if !list {
            for &number in &numbers {
                if !is_number(fields[number].data_type()) {
                    return Err(not_numeric(job, &names[number], fields[number].data_type()));
                }
            }
        }
        let narrow = |&number: &usize| {
            let kind = element(fields[number].data_type());
            matches!(kind, DataType::Float32 | DataType::Float16)
        };
        let scalar = if numbers.iter().all(narrow) { ScalarKind::F32 } else { ScalarKind::F64 };
        let label = label.map(|(number, _)| (number, names[number].clone()));
        let names = numbers.iter().map(|&number| names[number].clone()).collect();
        Ok(Plan { numbers, names, label, list, scalar })
    }

    /// The columns that are needed, rising.
    pub(super) fn held(&self) -> Vec<usize> {
        let label = self.label.iter().map(|(number, _)| *number);
        let mut held: Vec<usize> = self.numbers.iter().copied().chain(label).collect();
        held.sort_unstable();
        held.dedup();
        held
    }

    /// Reads `batches`, which hold the columns `held` of the schema (rising), to points.
    pub(super) fn read(
        self,
        job: &Job<'_>,
        held: &[usize],
        batches: impl Iterator<Item = Result<RecordBatch, Error>>,
    ) -> Result<Decoded, Error> {
        match self.scalar {
            ScalarKind::F32 => self.read_as::<f32>(job, held, batches),
            ScalarKind::F64 => self.read_as::<f64>(job, held, batches),
        }
    }

    fn read_as<T: Scalar>(
        self,
        job: &Job<'_>,
        held: &[usize],
        batches: impl Iterator<Item = Result<RecordBatch, Error>>,
    ) -> Result<Decoded, Error> {
        let mut sink: Option<Sink<'_, T>> = None;
        let mut labels = Vec::new();
        for batch in batches {
            let batch = batch?;
            if batch.num_rows() == 0 {
                continue;
            }
            let first = sink.as_ref().map_or(0, Sink::len);
            let column = |number: usize| {
                let at = held.binary_search(&number);
                batch.column(at.expect("every planned column is held"))
            };
            let columns: Vec<&ArrayRef> = self.numbers.iter().copied().map(column).collect();
            if let Some((number, name)) = &self.label {
                read_labels(job, column(*number), (*number, name), first, &mut labels)?;
            }
            let (dim, points) = match self.list {
                true => self.lists::<T>(job, columns[0], first, sink.as_ref().map(Sink::dim))?,
                false => (columns.len(), self.scalars::<T>(job, &columns, first)?),
            };
            sink.get_or_insert_with(|| Sink::new(job, dim)).push(&points)?;
        }
        let sink = sink.ok_or_else(|| Error::NoRows { path: job.path.to_owned() })?;
        let source = sink.finish()?;
        Ok(match self.list {
            true => Decoded { source, columns: Vec::new(), numbers: None, labels },
            false => Decoded { source, columns: self.names, numbers: Some(self.numbers), labels },
        })
    }

    /// One column for each coordinate.
    fn scalars<T: Scalar>(
        &self,
        job: &Job<'_>,
        columns: &[&ArrayRef],
        first: u64,
    ) -> Result<Vec<T>, Error> {
        let dim = columns.len();
        let mut points = vec![T::from_f64(0.0); columns[0].len() * dim];
        for (j, column) in columns.iter().enumerate() {
            let values = numbers::<T>(column, job.options.missing)
                .map_err(|fault| fault.at(job, first, 1, self.numbers[j], &self.names[j]))?;
            for (point, value) in points.chunks_exact_mut(dim).zip(values) {
                point[j] = value;
            }
        }
        Ok(points)
    }

    /// One list for each point; returns their dimension too.
    fn lists<T: Scalar>(
        &self,
        job: &Job<'_>,
        column: &ArrayRef,
        first: u64,
        dim: Option<usize>,
    ) -> Result<(usize, Vec<T>), Error> {
        let ends: Vec<usize> = match column.data_type() {
            DataType::FixedSizeList(..) => {
                let lists = column.as_fixed_size_list();
                (0..=lists.len()).map(|row| lists.value_offset(row) as usize).collect()
            }
            DataType::LargeList(_) => {
                column.as_list::<i64>().value_offsets().iter().map(|&end| end as usize).collect()
            }
            _ => column.as_list::<i32>().value_offsets().iter().map(|&end| end as usize).collect(),
        };
        let dim = dim.unwrap_or(ends[1] - ends[0]);
        for (row, end) in ends.windows(2).enumerate() {
            let (number, found) = (first + row as u64 + 1, end[1] - end[0]);
            let (path, name) = (job.path.to_owned(), self.names[0].clone());
            if column.is_null(row) {
                let (column, name) = (self.numbers[0], Some(name));
                let place = Place { path, row: number, line: None, column, name };
                return Err(Error::Missing { place });
            }
            if found != dim {
                let (row, column, expected) = (number, name, dim);
                return Err(Error::RaggedList { path, row, column, found, expected });
            }
        }
        if dim == 0 {
            return Err(Error::Array {
                path: job.path.to_owned(),
                problem: format!("the lists of column `{}` are empty", self.names[0]),
                remedy: "a point needs at least one coordinate",
            });
        }
        let child = match column.data_type() {
            DataType::FixedSizeList(..) => column.as_fixed_size_list().values(),
            DataType::LargeList(_) => column.as_list::<i64>().values(),
            _ => column.as_list::<i32>().values(),
        };
        let child = child.slice(ends[0], ends[ends.len() - 1] - ends[0]);
        let values = numbers::<T>(&child, job.options.missing)
            .map_err(|fault| fault.at(job, first, dim, fault.index % dim, &self.names[0]))?;
        Ok((dim, values))
    }
}

/// Appends the labels of a batch whose first row is `first`.
fn read_labels(
    job: &Job<'_>,
    array: &ArrayRef,
    (number, name): (usize, &str),
    first: u64,
    labels: &mut Vec<String>,
) -> Result<(), Error> {
    let texts: Vec<Option<String>> = match array.data_type() {
        DataType::Utf8 => owned(array.as_string::<i32>()),
        DataType::LargeUtf8 => owned(array.as_string::<i64>()),
        DataType::Utf8View => owned(array.as_string_view()),
        _ => {
            let values = numbers::<f64>(array, Missing::Keep)
                .map_err(|fault| fault.at(job, first, 1, number, name))?;
            let text = |value: f64| (!value.is_nan()).then(|| shown_number(value));
            values.into_iter().map(text).collect()
        }
    };
    for (row, text) in (first + 1..).zip(texts) {
        match text.filter(|text| !text.trim().is_empty()) {
            Some(text) => labels.push(text),
            None => {
                let (path, name) = (job.path.to_owned(), Some(name.to_owned()));
                let place = Place { path, row, line: None, column: number, name };
                return Err(Error::NoLabel { place });
            }
        }
    }
    Ok(())
}

fn owned<'a>(texts: impl IntoIterator<Item = Option<&'a str>>) -> Vec<Option<String>> {
    texts.into_iter().map(|text| text.map(str::to_owned)).collect()
}

fn not_numeric(job: &Job<'_>, column: &str, kind: &DataType) -> Error {
    let (path, column, kind) = (job.path.to_owned(), column.to_owned(), kind.to_string());
    Error::NotNumeric { path, column, kind }
}

/// Why the value at an index is no coordinate.
struct Fault {
    index: usize,
    kind: Kind,
}

enum Kind {
    Null,
    NonFinite(f64),
    Inexact(i128),
}

impl Fault {
    /// The error, where each row of the file, counted from `first`, is `dim` values.
    fn at(&self, job: &Job<'_>, first: u64, dim: usize, column: usize, name: &str) -> Error {
        let (path, name) = (job.path.to_owned(), Some(name.to_owned()));
        let row = first + (self.index / dim) as u64 + 1;
        let place = Place { path, row, line: None, column, name };
        match self.kind {
            Kind::Null => Error::Missing { place },
            Kind::NonFinite(value) => Error::NonFinite { place, value: value.to_string() },
            Kind::Inexact(value) => Error::Inexact { place, value: value.to_string() },
        }
    }
}

/// The values of a numeric column.
fn numbers<T: Scalar>(array: &ArrayRef, missing: Missing) -> Result<Vec<T>, Fault> {
    let array = &Values { array, missing };
    match array.array.data_type() {
        DataType::Float16 => convert::<Float16Type, T>(array, |value| Ok(value.to_f64())),
        DataType::Float32 => convert::<Float32Type, T>(array, |value| Ok(value.into())),
        DataType::Float64 => convert::<Float64Type, T>(array, Ok),
        DataType::Int8 => convert::<Int8Type, T>(array, |value| Ok(value.into())),
        DataType::Int16 => convert::<Int16Type, T>(array, |value| Ok(value.into())),
        DataType::Int32 => convert::<Int32Type, T>(array, |value| Ok(value.into())),
        DataType::Int64 => convert::<Int64Type, T>(array, |value| exact(value.into())),
        DataType::UInt8 => convert::<UInt8Type, T>(array, |value| Ok(value.into())),
        DataType::UInt16 => convert::<UInt16Type, T>(array, |value| Ok(value.into())),
        DataType::UInt32 => convert::<UInt32Type, T>(array, |value| Ok(value.into())),
        DataType::UInt64 => convert::<UInt64Type, T>(array, |value| exact(value.into())),
        other => unreachable!("the plan holds numeric columns only, not {other}"),
    }
}

/// The values of a column, and what becomes of rows that lack one.
struct Values<'a> {
    array: &'a ArrayRef,
    missing: Missing,
}

fn convert<P: ArrowPrimitiveType, T: Scalar>(
    values: &Values<'_>,
    widen: impl Fn(P::Native) -> Result<f64, i128>,
) -> Result<Vec<T>, Fault> {
    let (array, drops) = (values.array.as_primitive::<P>(), values.missing != Missing::Refuse);
    if !drops && let Some(index) = (0..array.len()).find(|&index| array.is_null(index)) {
        return Err(Fault { index, kind: Kind::Null });
    }
    let mut values = Vec::with_capacity(array.len());
    for (index, &native) in array.values().iter().enumerate() {
        if drops && array.is_null(index) {
            values.push(T::from_f64(f64::NAN));
            continue;
        }
        match widen(native) {
            Ok(value) if drops && value.is_nan() => values.push(T::from_f64(value)),
            Ok(value) if value.is_finite() => values.push(T::from_f64(value)),
            Ok(value) => return Err(Fault { index, kind: Kind::NonFinite(value) }),
            Err(value) => return Err(Fault { index, kind: Kind::Inexact(value) }),
        }
    }
    Ok(values)
}

fn exact(integer: i128) -> Result<f64, i128> {
    if integer as f64 as i128 == integer { Ok(integer as f64) } else { Err(integer) }
}

/// Returns what a list is made of; any other type is made of itself.
fn element(kind: &DataType) -> &DataType {
    match kind {
        DataType::List(field) | DataType::LargeList(field) | DataType::FixedSizeList(field, _) => {
            field.data_type()
        }
        other => other,
    }
}

fn is_list(kind: &DataType) -> bool {
    element(kind) != kind && is_number(element(kind))
}

fn is_text(kind: &DataType) -> bool {
    matches!(kind, DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View)
}

fn is_number(kind: &DataType) -> bool {
    kind.is_integer() || kind.is_floating()
}
