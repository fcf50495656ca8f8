//! Parquet as other programs write it, and what they read of ours.

use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::Compression;
use ::parquet::file::properties::{WriterProperties, WriterVersion};
use arrow_array::builder::{FixedSizeListBuilder, Float64Builder, ListBuilder};
use arrow_array::cast::AsArray;
use arrow_array::types::{
    Float16Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type,
    UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType, BooleanArray, Date32Array, Date64Array, Decimal128Array,
    DictionaryArray, DurationSecondArray, FixedSizeListArray, Float64Array, Int32Array, Int64Array,
    PrimitiveArray, RecordBatch, StringArray, StructArray, Time32SecondArray,
    Time64MicrosecondArray, TimestampMillisecondArray, TimestampSecondArray,
};
use arrow_schema::{DataType, Field, Schema, TimeUnit};
use proptest::prelude::*;
use taut_io::{Missing, ReadOptions, open_bytes, write_points};
use taut_points::{Monitor, Points};

use crate::{message, values};

/// A file of these columns, which may all lack values.
fn file(columns: &[(&str, ArrayRef)], properties: WriterProperties) -> Vec<u8> {
    let fields =
        columns.iter().map(|(name, array)| Field::new(*name, array.data_type().clone(), true));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.iter().map(|(_, array)| array.clone()).collect();
    let batch = RecordBatch::try_new(schema.clone(), arrays).unwrap();
    let mut bytes = vec![];
    let mut writer = ArrowWriter::try_new(&mut bytes, schema, Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
    bytes
}

fn plain() -> WriterProperties {
    WriterProperties::builder().build()
}

fn dropping() -> ReadOptions {
    ReadOptions { missing: Missing::Drop, ..ReadOptions::default() }
}

#[test]
fn numbers_of_every_type_are_read() {
    fn column<T: ArrowPrimitiveType>(values: [T::Native; 3]) -> ArrayRef {
        Arc::new(PrimitiveArray::<T>::from_iter_values(values))
    }
    type Half = <Float16Type as ArrowPrimitiveType>::Native;
    let half = |value| Half::from_f32(value);
    let columns: Vec<(&str, ArrayRef, [f64; 3])> = vec![
        ("i8", column::<Int8Type>([-128, 0, 127]), [-128.0, 0.0, 127.0]),
        ("i16", column::<Int16Type>([-32768, 0, 1]), [-32768.0, 0.0, 1.0]),
        ("i32", column::<Int32Type>([i32::MIN, 0, 5]), [f64::from(i32::MIN), 0.0, 5.0]),
        (
            "i64",
            column::<Int64Type>([-(1 << 53), 0, 1 << 53]),
            [-(2f64.powi(53)), 0.0, 2f64.powi(53)],
        ),
        ("u8", column::<UInt8Type>([255, 0, 1]), [255.0, 0.0, 1.0]),
        ("u16", column::<UInt16Type>([65535, 0, 1]), [65535.0, 0.0, 1.0]),
        ("u32", column::<UInt32Type>([u32::MAX, 0, 1]), [f64::from(u32::MAX), 0.0, 1.0]),
        ("u64", column::<UInt64Type>([1 << 63, 0, 1]), [2f64.powi(63), 0.0, 1.0]),
        (
            "f16",
            column::<Float16Type>([half(0.5), half(-2.0), half(65504.0)]),
            [0.5, -2.0, 65504.0],
        ),
        (
            "f32",
            column::<Float32Type>([0.1, -2.0, 3e38]),
            [f64::from(0.1f32), -2.0, f64::from(3e38f32)],
        ),
        ("f64", column::<Float64Type>([0.1, -0.0, 1e300]), [0.1, 0.0, 1e300]),
    ];
    let arrays: Vec<(&str, ArrayRef)> =
        columns.iter().map(|(name, array, _)| (*name, array.clone())).collect();
    let expected: Vec<f64> =
        (0..3).flat_map(|row| columns.iter().map(move |(_, _, values)| values[row])).collect();
    let found = open_bytes(file(&arrays, plain()), "t.parquet", &ReadOptions::default()).unwrap();
    assert_eq!(values(&found), expected);
}

#[test]
fn what_is_no_number_is_named() {
    let numbers =
        |name: &'static str| -> (&str, ArrayRef) { (name, Arc::new(Int64Array::from(vec![1, 2]))) };
    let inner: ArrayRef = Arc::new(Float64Array::from(vec![1.0, 2.0]));
    let structs =
        StructArray::from(vec![(Arc::new(Field::new("v", DataType::Float64, true)), inner)]);
    let mut nested = ListBuilder::new(ListBuilder::new(Float64Builder::new()));
    for _ in 0..2 {
        nested.values().append_value([Some(1.0)]);
        nested.append(true);
    }
    let class = |values: Vec<i64>| -> ArrayRef { Arc::new(Int64Array::from(values)) };
    let classes = DictionaryArray::new(Int32Array::from(vec![1, 0]), class(vec![7, 9]));
    let item = Arc::new(Field::new("item", DataType::Duration(TimeUnit::Second), true));
    let durations = DurationSecondArray::from(vec![1, 2]);
    let durations = FixedSizeListArray::new(item, 1, Arc::new(durations), None);
    let others: Vec<(ArrayRef, &str)> = vec![
        (Arc::new(BooleanArray::from(vec![true, false])), "Boolean"),
        (Arc::new(Date32Array::from(vec![1, 2])), "Date32"),
        (Arc::new(Time64MicrosecondArray::from(vec![1, 2])), "Time64"),
        (Arc::new(TimestampMillisecondArray::from(vec![1, 2])), "Timestamp"),
        (Arc::new(DurationSecondArray::from(vec![1, 2])), "Duration"),
        (Arc::new(TimestampSecondArray::from(vec![1, 2])), "Timestamp"),
        (Arc::new(Time32SecondArray::from(vec![1, 2])), "Time32"),
        (Arc::new(Date64Array::from(vec![86_400_000, 172_800_000])), "Date64"),
        (Arc::new(classes), "Dictionary"),
        (Arc::new(durations), "Duration"),
        (Arc::new(Decimal128Array::from(vec![1, 2])), "Decimal128"),
        (Arc::new(StringArray::from(vec!["a", "b"])), "Utf8"),
        (Arc::new(structs), "Struct"),
        (Arc::new(nested.finish()), "List"),
    ];
    for (array, kind) in others {
        let bytes = file(&[numbers("x"), ("other", array)], plain());
        let found = open_bytes(bytes.clone(), "t.parquet", &ReadOptions::default()).unwrap();
        assert_eq!(values(&found), [1.0, 2.0], "{kind}");
        let options =
            ReadOptions { columns: Some("other".parse().unwrap()), ..ReadOptions::default() };
        let found = message(open_bytes(bytes, "t.parquet", &options));
        assert!(found.contains("`other`") && found.contains(kind), "{kind}: {found}");
    }
}

#[test]
fn labels_may_be_texts_of_a_dictionary() {
    let labels: DictionaryArray<Int32Type> = vec!["here", "there", "here"].into_iter().collect();
    let x: ArrayRef = Arc::new(Float64Array::from(vec![1.0, 2.0, 3.0]));
    let bytes = file(&[("x", x), ("kind", Arc::new(labels))], plain());
    let options = ReadOptions { label: Some("kind".to_owned()), ..ReadOptions::default() };
    let found = open_bytes(bytes, "t.parquet", &options).unwrap();
    assert_eq!(found.labels, ["here", "there", "here"]);
}

#[test]
fn lists_that_are_no_points_are_refused_with_their_row() {
    let lists = |rows: &[Option<Vec<Option<f64>>>]| {
        let mut lists = ListBuilder::new(Float64Builder::new());
        rows.iter().for_each(|row| lists.append_option(row.clone()));
        file(&[("p", Arc::new(lists.finish()) as ArrayRef)], plain())
    };
    let row = |values: &[f64]| Some(values.iter().copied().map(Some).collect::<Vec<_>>());
    let good = lists(&[row(&[1.0, 2.0]), row(&[3.0, 4.0])]);
    let found = open_bytes(good, "t.parquet", &ReadOptions::default()).unwrap();
    assert_eq!(values(&found), [1.0, 2.0, 3.0, 4.0]);
    for (rows, expected) in [
        ([row(&[1.0, 2.0]), None], "row 2, column 0 (`p`): the value is missing"),
        ([row(&[1.0, 2.0]), row(&[])], "row 2"),
        ([row(&[1.0, 2.0]), row(&[3.0])], "row 2"),
        ([row(&[1.0, 2.0]), Some(vec![Some(3.0), None])], "row 2"),
        ([row(&[]), row(&[])], "are empty"),
    ] {
        let found = message(open_bytes(lists(&rows), "t.parquet", &ReadOptions::default()));
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn wide_points_are_lists_of_one_length_to_other_programs() {
    let coordinates: Vec<f64> = (0..3003).map(f64::from).collect();
    let points = Points::new(&coordinates, 1001).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wide.parquet");
    write_points(&points, &[], &path, None, &Monitor::silent()).unwrap();
    let reader =
        ParquetRecordBatchReaderBuilder::try_new(std::fs::File::open(path).unwrap()).unwrap();
    assert!(matches!(reader.schema().field(0).data_type(), DataType::FixedSizeList(_, 1001)));
    let batch = reader.build().unwrap().next().unwrap().unwrap();
    let lists = batch.column(0).as_fixed_size_list();
    assert_eq!(lists.values().as_primitive::<Float64Type>().values().to_vec(), coordinates);
}

#[test]
fn rows_that_the_footer_does_not_count_are_not_lost() {
    let x: ArrayRef = Arc::new(Int64Array::from(vec![7, 8, 9]));
    let bytes = file(&[("x", x)], plain());
    let at = bytes.len() - 8;
    let length = u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let footer = at - length..at;
    // Each 3 of the footer is a zigzag 6; those that count rows are among them.
    let mut refused = 0;
    for place in footer.filter(|&place| bytes[place] == 6) {
        let mut bytes = bytes.clone();
        bytes[place] = 4;
        match open_bytes(bytes, "t.parquet", &ReadOptions::default()) {
            Ok(found) => assert_eq!(values(&found), [7.0, 8.0, 9.0], "byte {place}"),
            Err(error) => refused += usize::from(error.to_string().contains("more rows")),
        }
    }
    assert!(refused > 0);
}

/// Settings under which files differ in pages, dictionaries and row groups.
fn settings() -> impl Strategy<Value = WriterProperties> {
    let compression = prop::sample::select(vec![
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::LZ4_RAW,
        Compression::GZIP(Default::default()),
    ]);
    (1usize..40, 1usize..9, any::<bool>(), any::<bool>(), compression).prop_map(
        |(group, page, is_new, has_dictionary, compression)| {
            WriterProperties::builder()
                .set_max_row_group_row_count(Some(group))
                .set_data_page_row_count_limit(page)
                .set_write_batch_size(page)
                .set_dictionary_enabled(has_dictionary)
                .set_compression(compression)
                .set_writer_version(match is_new {
                    true => WriterVersion::PARQUET_2_0,
                    false => WriterVersion::PARQUET_1_0,
                })
                .build()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rows_are_those_that_were_written(
        rows in prop::collection::vec((prop::option::weighted(0.8, -1e9..1e9), any::<i32>()), 1..100),
        settings in settings(),
    ) {
        let x: ArrayRef = Arc::new(rows.iter().map(|row| row.0).collect::<Float64Array>());
        let y: ArrayRef = Arc::new(PrimitiveArray::<Int32Type>::from_iter_values(rows.iter().map(|row| row.1)));
        let bytes = file(&[("x", x), ("y", y)], settings);
        let whole: Vec<f64> =
            rows.iter().filter_map(|row| Some([row.0?, f64::from(row.1)])).flatten().collect();
        match open_bytes(bytes, "t.parquet", &dropping()) {
            Ok(found) => prop_assert_eq!(values(&found), whole),
            Err(_) => prop_assert!(whole.is_empty()),
        }
    }

    #[test]
    fn lists_are_those_that_were_written(
        rows in prop::collection::vec(prop::option::weighted(0.8, [-1e9..1e9, -1.0..1.0, -1.0..1.0]), 1..100),
        odd in prop::option::weighted(0.3, (any::<prop::sample::Index>(), any::<bool>())),
        settings in settings(),
    ) {
        // A list that is missing or empty is refused with its row, wherever pages and row groups end.
        if let Some((at, is_missing)) = odd {
            let at = at.index(rows.len());
            let mut lists = ListBuilder::new(Float64Builder::new());
            for (row, values) in rows.iter().enumerate() {
                let values = values.unwrap_or([0.5; 3]).map(Some);
                match row == at {
                    true => lists.append_option((!is_missing).then(Vec::<Option<f64>>::new)),
                    false => lists.append_value(values),
                }
            }
            let bytes = file(&[("p", Arc::new(lists.finish()) as ArrayRef)], settings);
            let found = message(open_bytes(bytes, "t.parquet", &ReadOptions::default()));
            // Of the first row an empty list is the dimension of all, and the second is the one that differs.
            let is_told = found.contains(&format!("row {}", at + 1)) || (at == 0 && !is_missing);
            prop_assert!(is_told, "{}", found);
            return Ok(());
        }
        let mut lists = FixedSizeListBuilder::new(Float64Builder::new(), 3);
        for row in &rows {
            let row = row.unwrap_or([f64::NAN; 3]);
            row.iter().for_each(|&value| lists.values().append_option((!value.is_nan()).then_some(value)));
            lists.append(true);
        }
        let bytes = file(&[("p", Arc::new(lists.finish()) as ArrayRef)], settings);
        let whole: Vec<f64> = rows.iter().flatten().flatten().copied().collect();
        match open_bytes(bytes, "t.parquet", &dropping()) {
            Ok(found) => prop_assert_eq!(values(&found), whole),
            Err(_) => prop_assert!(whole.is_empty()),
        }
    }
}
