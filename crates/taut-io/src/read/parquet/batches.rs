//! The rows of a Parquet file, some at a time, as batches of arrow.
//!
//! *Idea.* The columns of a row group are decoded side by side, each by the same number of whole rows; values that are there come without
//! gaps, and their levels say where the gaps are.
//! *Trap.* A footer may count fewer rows than the pages hold. Each column has to end where its row group does; else points would be lost
//! in silence.
//! *Chosen.* The crate's own reader of batches decodes every type there is, by ten times the code.

use std::sync::Arc;

use arrow_array::types::{ArrowPrimitiveType, Float16Type};
use arrow_array::{
    ArrayRef, BinaryArray, Float16Array, Float32Array, Float64Array, Int32Array, Int64Array,
    LargeListArray, RecordBatch, StringArray, UInt32Array, UInt64Array,
};
use arrow_buffer::{NullBuffer, OffsetBuffer};
use arrow_schema::{DataType, Schema, SchemaRef};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType as Physical, FixedLenByteArray};
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::properties::ReaderProperties;
use parquet::file::reader::{ChunkReader, RowGroupReader};
use parquet::file::serialized_reader::SerializedRowGroupReader;

use super::schema::{self, Leaf, ListLevels};

/// A file whose footer has been read.
pub(crate) struct Table<R: ChunkReader> {
    chunks: Arc<R>,
    metadata: ParquetMetaData,
    schema: SchemaRef,
    leaves: Vec<Option<Leaf>>,
}

impl<R: ChunkReader + 'static> Table<R> {
    pub(crate) fn new(chunks: R, metadata: ParquetMetaData) -> Table<R> {
        let (schema, leaves) = schema::of(metadata.file_metadata());
        Table { chunks: Arc::new(chunks), metadata, schema: Arc::new(schema), leaves }
    }

    pub(crate) fn schema(&self) -> &Schema {
        &self.schema
    }

    /// Values of a row in the columns `held`, those of lists counted one by one.
    pub(crate) fn width(&self, held: &[usize]) -> usize {
        let leaves = held.iter().filter_map(|&column| self.leaves[column]);
        let leaves: Vec<usize> = leaves.map(|leaf| leaf.number).collect();
        let (mut values, mut rows) = (0_u64, 0_u64);
        for group in self.metadata.row_groups() {
            rows = rows.saturating_add(u64::try_from(group.num_rows()).unwrap_or(0));
            for &leaf in &leaves {
                let count = group.columns().get(leaf).map_or(0, |column| column.num_values());
                values = values.saturating_add(u64::try_from(count).unwrap_or(0));
            }
        }
        usize::try_from(values / rows.max(1)).unwrap_or(usize::MAX).max(held.len()).max(1)
    }

    /// The columns `held`, `rows` rows at a time; `None` if one of them is neither a number, a text or bytes nor a list of such.
    pub(crate) fn batches(self, held: &[usize], rows: usize) -> Option<Batches<R>> {
        let leaves = held.iter().map(|&column| self.leaves[column]).collect::<Option<Vec<_>>>()?;
        let schema = Arc::new(self.schema.project(held).ok()?);
        let is_read = |field: &arrow_schema::FieldRef| match field.data_type() {
            DataType::LargeList(item) => is_scalar(item.data_type()),
            kind => is_scalar(kind),
        };
        schema.fields().iter().all(is_read).then(|| Batches {
            chunks: self.chunks,
            metadata: self.metadata,
            schema,
            leaves,
            rows,
            group: 0,
            left: 0,
            columns: Vec::new(),
        })
    }
}

fn is_scalar(kind: &DataType) -> bool {
    kind.is_integer() || kind.is_floating() || matches!(kind, DataType::Utf8 | DataType::Binary)
}

/// Batches of the chosen columns, row group by row group.
pub(crate) struct Batches<R: ChunkReader> {
    chunks: Arc<R>,
    metadata: ParquetMetaData,
    schema: SchemaRef,
    leaves: Vec<Leaf>,
    rows: usize,
    /// The row group that is next.
    group: usize,
    /// Rows of the open one that are to be read.
    left: usize,
    columns: Vec<ColumnReader>,
}

impl<R: ChunkReader + 'static> Batches<R> {
    fn step(&mut self) -> Result<Option<RecordBatch>, ParquetError> {
        while self.left == 0 {
            self.check_ends()?;
            let Some(group) = self.metadata.row_groups().get(self.group) else { return Ok(None) };
            self.left = usize::try_from(group.num_rows())
                .map_err(|_| general("a row group has a negative number of rows"))?;
            let properties = Arc::new(ReaderProperties::builder().build());
            let group =
                SerializedRowGroupReader::new(self.chunks.clone(), group, None, properties)?;
            let columns = self.leaves.iter().map(|leaf| group.get_column_reader(leaf.number));
            self.columns = columns.collect::<Result<_, _>>()?;
            self.group += 1;
        }
        let rows = self.rows.min(self.left);
        self.left -= rows;
        let arrays = self.decode(rows)?;
        for (array, field) in arrays.iter().zip(self.schema.fields()) {
            if array.len() != rows {
                let name = field.name();
                return Err(general(&format!("column `{name}` has fewer rows than its row group")));
            }
        }
        let batch = RecordBatch::try_new(self.schema.clone(), arrays);
        batch.map(Some).map_err(|error| general(&error.to_string()))
    }

    /// The next `rows` rows of each column, or as many as it has.
    fn decode(&mut self, rows: usize) -> Result<Vec<ArrayRef>, ParquetError> {
        let columns = self.columns.iter_mut().zip(&self.leaves).zip(self.schema.fields());
        columns
            .map(|((column, leaf), field)| decode(column, *leaf, field.data_type(), rows))
            .collect()
    }

    /// Refuses columns that go on behind the last row of the open row group.
    fn check_ends(&mut self) -> Result<(), ParquetError> {
        let beyond = self.decode(1)?;
        match beyond.iter().zip(self.schema.fields()).find(|(array, _)| !array.is_empty()) {
            None => Ok(()),
            Some((_, field)) => {
                let name = field.name();
                Err(general(&format!("column `{name}` has more rows than its row group")))
            }
        }
    }
}

impl<R: ChunkReader + 'static> Iterator for Batches<R> {
    type Item = Result<RecordBatch, ParquetError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.step().transpose()
    }
}

fn general(problem: &str) -> ParquetError {
    ParquetError::General(problem.to_owned())
}

/// The next `rows` rows of a column, or as many as there are.
fn decode(
    column: &mut ColumnReader,
    leaf: Leaf,
    kind: &DataType,
    rows: usize,
) -> Result<ArrayRef, ParquetError> {
    let item = match kind {
        DataType::LargeList(item) => item.data_type(),
        kind => kind,
    };
    let mut levels = Levels::default();
    let array: ArrayRef = match (item, column) {
        (DataType::Int32, ColumnReader::Int32ColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0)?;
            Arc::new(Int32Array::new(values.into(), levels.nulls(leaf)))
        }
        (DataType::UInt32, ColumnReader::Int32ColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0)?;
            let values = values.into_iter().map(i32::cast_unsigned).collect();
            Arc::new(UInt32Array::new(values, levels.nulls(leaf)))
        }
        (DataType::Int64, ColumnReader::Int64ColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0)?;
            Arc::new(Int64Array::new(values.into(), levels.nulls(leaf)))
        }
        (DataType::UInt64, ColumnReader::Int64ColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0)?;
            let values = values.into_iter().map(i64::cast_unsigned).collect();
            Arc::new(UInt64Array::new(values, levels.nulls(leaf)))
        }
        (DataType::Float32, ColumnReader::FloatColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0.0)?;
            Arc::new(Float32Array::new(values.into(), levels.nulls(leaf)))
        }
        (DataType::Float64, ColumnReader::DoubleColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, 0.0)?;
            Arc::new(Float64Array::new(values.into(), levels.nulls(leaf)))
        }
        (DataType::Float16, ColumnReader::FixedLenByteArrayColumnReader(column)) => {
            let values = levels.read(column, leaf, rows, vec![0, 0].into())?;
            let half = |value: FixedLenByteArray| match value.data() {
                &[low, high] => {
                    Ok(<Float16Type as ArrowPrimitiveType>::Native::from_le_bytes([low, high]))
                }
                _ => Err(general("a number of two bytes has another length")),
            };
            let values = values.into_iter().map(half).collect::<Result<_, _>>()?;
            Arc::new(Float16Array::new(values, levels.nulls(leaf)))
        }
        (DataType::Utf8, ColumnReader::ByteArrayColumnReader(column)) => {
            let (ends, bytes) = joined(&levels.read(column, leaf, rows, Vec::new().into())?)?;
            let texts = StringArray::try_new(ends, bytes.into(), levels.nulls(leaf));
            Arc::new(texts.map_err(|error| general(&error.to_string()))?)
        }
        (DataType::Binary, ColumnReader::ByteArrayColumnReader(column)) => {
            let (ends, bytes) = joined(&levels.read(column, leaf, rows, Vec::new().into())?)?;
            Arc::new(BinaryArray::new(ends, bytes.into(), levels.nulls(leaf)))
        }
        _ => return Err(general("a column is stored in another type than the schema says")),
    };
    match (leaf.list, kind) {
        (Some(list), DataType::LargeList(item)) => {
            let (ends, present) = levels.lists(list)?;
            let nulls = Some(NullBuffer::from(present)).filter(|nulls| nulls.null_count() > 0);
            let lists = LargeListArray::try_new(item.clone(), ends, array, nulls);
            Ok(Arc::new(lists.map_err(|error| general(&error.to_string()))?))
        }
        _ => Ok(array),
    }
}

/// Texts or bytes one after the other, with the place where each ends.
fn joined(values: &[ByteArray]) -> Result<(OffsetBuffer<i32>, Vec<u8>), ParquetError> {
    let total: usize = values.iter().map(|value| value.len()).sum();
    if i32::try_from(total).is_err() {
        return Err(general("texts of a batch of rows take more than 2 GiB"));
    }
    let mut bytes = Vec::with_capacity(total);
    values.iter().for_each(|value| bytes.extend_from_slice(value.data()));
    Ok((OffsetBuffer::from_lengths(values.iter().map(|value| value.len())), bytes))
}

/// The levels of rows that were read.
#[derive(Default)]
struct Levels {
    defined: Vec<i16>,
    repeated: Vec<i16>,
}

impl Levels {
    /// Values of the next `rows` rows, of lists all items, with `gap` for each that is missing.
    fn read<T: Physical>(
        &mut self,
        column: &mut ColumnReaderImpl<T>,
        leaf: Leaf,
        rows: usize,
        gap: T::T,
    ) -> Result<Vec<T::T>, ParquetError> {
        let mut values = Vec::new();
        // A page without values gives nothing, too, and is not yet the end.
        let (mut left, mut idle) = (rows, 0);
        while left > 0 && idle < 2 {
            let (records, _, levels) = column.read_records(
                left,
                (leaf.defined > 0).then_some(&mut self.defined),
                leaf.list.is_some().then_some(&mut self.repeated),
                &mut values,
            )?;
            left -= records;
            idle = if records == 0 && levels == 0 { idle + 1 } else { 0 };
        }
        if self.is_there(leaf).all(|is_there| is_there) {
            return Ok(values);
        }
        let mut values = values.into_iter();
        let mut spaced = Vec::with_capacity(self.defined.len());
        for is_there in self.is_there(leaf) {
            spaced.push(match is_there {
                true => values.next().ok_or_else(|| general("a column has too few values"))?,
                false => gap.clone(),
            });
        }
        Ok(spaced)
    }

    /// For each value or item whether it is there; nothing where none can be missing.
    fn is_there(&self, leaf: Leaf) -> impl Iterator<Item = bool> {
        let least = leaf.list.map_or(0, |list| list.item);
        self.defined
            .iter()
            .filter(move |level| **level >= least)
            .map(move |&level| level == leaf.defined)
    }

    fn nulls(&self, leaf: Leaf) -> Option<NullBuffer> {
        let nulls: Vec<bool> = self.is_there(leaf).collect();
        (!nulls.is_empty()).then(|| NullBuffer::from(nulls)).filter(|nulls| nulls.null_count() > 0)
    }

    /// Where each list ends among the items, and whether it is there.
    fn lists(&self, list: ListLevels) -> Result<(OffsetBuffer<i64>, Vec<bool>), ParquetError> {
        let (mut lengths, mut present) = (Vec::new(), Vec::new());
        for (&defined, &repeated) in self.defined.iter().zip(&self.repeated) {
            if repeated == 0 {
                lengths.push(0);
                present.push(defined >= list.present);
            }
            match lengths.last_mut() {
                Some(length) if defined >= list.item => *length += 1,
                _ if repeated == 0 => {}
                _ => return Err(general("a list goes on without an item")),
            }
        }
        Ok((OffsetBuffer::from_lengths(lengths), present))
    }
}
