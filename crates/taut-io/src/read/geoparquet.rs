//! GeoParquet: the positions of its column of geometries.
//!
//! *Read.* The primary column, where it holds well-known binary. Rows that are all single points are points in their order; of others each
//! chain, such as a ring, has a number in a third column.
//! *Chosen.* With `--columns` the columns of numbers are read as of any other file.

use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, Schema};

use super::chains::decode;
use super::geojson::json::{self, Value};
use super::{Decoded, wkb};
use crate::input::Job;
use crate::{Error, Missing, Place};

/// Bytes that the description of the geometries may take.
const DESCRIPTION_BYTES_MAX: u64 = 1 << 24;

/// The position of a row that has none, which is left out and counted like a row without a value.
const GAP: [[f64; 2]; 1] = [[f64::NAN; 2]];

/// The number of the column of geometries; none in other files, and where columns are chosen.
///
/// # Errors
/// Geometries that are not well-known binary are refused: the other columns of numbers would be taken for coordinates.
pub(super) fn column(job: &Job<'_>, schema: &Schema) -> Result<Option<usize>, Error> {
    if job.options.columns.is_some() {
        return Ok(None);
    }
    let Some(name) = primary(schema) else { return Ok(None) };
    let Ok(number) = schema.index_of(&name) else { return Ok(None) };
    match schema.field(number).data_type() {
        DataType::Binary | DataType::LargeBinary => Ok(Some(number)),
        other => {
            let problem = format!(
                "its geometries in column `{name}` are {other}, not well-known binary: write them so, or choose columns of numbers"
            );
            Err(Error::Feature { path: job.path.to_owned(), problem })
        }
    }
}

/// The name of the column of geometries.
fn primary(schema: &Schema) -> Option<String> {
    let text = schema.metadata().get("geo")?;
    let Ok(Value::Object(fields)) = json::parse(text.as_bytes(), DESCRIPTION_BYTES_MAX) else {
        return None;
    };
    fields.iter().find_map(|(name, value)| match value {
        Value::Text(text) if name == "primary_column" => Some(text.clone()),
        _ => None,
    })
}

/// Reads batches that hold the column of geometries alone.
pub(super) fn read(
    job: &Job<'_>,
    (number, name): (usize, &str),
    batches: impl Iterator<Item = Result<RecordBatch, Error>>,
) -> Result<Decoded, Error> {
    let (mut chains, mut row, mut is_points): (Vec<wkb::Chain>, u64, bool) = (vec![], 0, true);
    for batch in batches {
        let batch = batch?;
        let column = batch.column(0);
        for at in 0..column.len() {
            row += 1;
            let place = || {
                let (path, name) = (job.path.to_owned(), Some(name.to_owned()));
                Place { path, row, line: None, column: number, name }
            };
            let Some(bytes) = bytes(column, at) else {
                if job.options.missing == Missing::Refuse {
                    return Err(Error::Missing { place: place() });
                }
                chains.push(GAP.to_vec());
                continue;
            };
            let refused = |problem: String| Error::Feature {
                path: job.path.to_owned(),
                problem: format!("row {row} of column `{name}`: {problem}"),
            };
            let (found, is_point) = wkb::chains(bytes).map_err(refused)?;
            if is_point && found.iter().flatten().flatten().any(|value| value.is_nan()) {
                if job.options.missing == Missing::Refuse {
                    return Err(Error::Missing { place: place() });
                }
                chains.push(GAP.to_vec());
                continue;
            }
            is_points &= is_point;
            chains.extend(found);
        }
    }
    let is_gap = |chain: &wkb::Chain| chain.iter().flatten().any(|value| value.is_nan());
    let whole = chains.iter().filter(|chain| !is_gap(chain)).count();
    decode(job, !is_points && whole > 1, |put| {
        let mut number = 0;
        for positions in chains {
            // A gap has no number of its own, so that those of rings have none between them.
            let next = number + usize::from(!is_gap(&positions));
            positions.into_iter().try_for_each(|at| put(number, at))?;
            number = next;
        }
        Ok(())
    })
}

/// The bytes of a row; none where they are missing.
fn bytes(column: &ArrayRef, at: usize) -> Option<&[u8]> {
    match column.is_null(at) {
        true => None,
        false => Some(match column.data_type() {
            DataType::LargeBinary => column.as_binary::<i64>().value(at),
            _ => column.as_binary::<i32>().value(at),
        }),
    }
}
