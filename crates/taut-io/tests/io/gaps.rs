//! Rows that lack a value, and values that are mistyped: none is lost unsaid.

use taut_io::{
    Bounds, Decimal, Format, Input, Missing, RawLayout, ReadOptions, Thinning, open_bytes,
};

use super::{message, text_with, values};

fn numeric() -> ReadOptions {
    ReadOptions { numeric: true, ..Default::default() }
}

fn dropping() -> ReadOptions {
    ReadOptions { missing: Missing::Drop, ..Default::default() }
}

/// The rows of the file, from 0.
fn rows(input: &Input) -> Vec<u64> {
    (0..input.source.len()).map(|row| input.row_in_file(row)).collect()
}

#[test]
fn a_first_row_with_a_mistake_is_no_header_of_columns_of_numbers() {
    let read = |text: &str| message(text_with("t.csv", text, &numeric()));
    let found = read("1O,2,3\n4,5,6\n");
    assert!(found.contains("row 1 (line 1), column 0 (counted from 0) holds `1O`"), "{found}");
    let found = read("x,2019\n1,2\n3,4\n");
    assert!(found.contains("row 1 (line 1) mixes numbers with other text (`x`"), "{found}");
    // A word beside columns of numbers is no name of these.
    let found = text_with("t.csv", "Ulm,1,2\nBonn,3,4\n", &numeric()).unwrap();
    assert_eq!(values(&found), [1.0, 2.0, 3.0, 4.0]);
    // Labels may be numbers or words.
    let options = ReadOptions { label: Some("0".to_owned()), ..numeric() };
    let found = text_with("t.csv", "A7,1\n12,2\n", &options).unwrap();
    assert_eq!((values(&found), found.labels), (vec![1.0, 2.0], vec!["A7".into(), "12".into()]));
}

#[test]
fn a_column_of_numbers_with_a_word_is_refused() {
    let read = |text: &str| message(text_with("t.csv", text, &numeric()));
    let found = read("x,y\n1,2\n3,1O\n5,6\n");
    assert!(found.contains("row 2 (line 3), column 1 (`y`): `1O` is not a number"), "{found}");
    let found = read("1,2\n3,4\n5,u\n");
    assert!(found.contains("row 3 (line 3), column 1"), "{found}");
    // Numbers with the other mark before their decimals.
    let found = read("a;x;y\nu;1,5;2\nv;2,5;3\n");
    assert!(found.contains("row 1 (line 2), column 1 (`x`): `1,5`"), "{found}");
    let comma = ReadOptions { decimal: Decimal::Comma, ..numeric() };
    let found = message(text_with("t.csv", "x;y\n1.5;2\n", &comma));
    assert!(found.contains("`1.5` is not a number"), "{found}");
    // Words with gaps, also as NaN, are words.
    let found = text_with("t.csv", "kind,x\nnan,1\nb,2\n,3\n", &numeric()).unwrap();
    assert_eq!((values(&found), found.columns), (vec![1.0, 2.0, 3.0], vec!["x".to_owned()]));
    // A label is no coordinate.
    let options = ReadOptions { label: Some("id".to_owned()), ..numeric() };
    let found = text_with("t.csv", "id,x\n1,1\nb,2\n", &options).unwrap();
    assert_eq!(found.labels, ["1", "b"]);
    // Who counts what is missing takes columns as they are.
    let options = ReadOptions { missing: Missing::Keep, ..numeric() };
    assert_eq!(text_with("t.csv", "x,y\n1,2\n3,1O\n", &options).unwrap().columns, ["x"]);
}

#[test]
fn a_gap_as_excel_writes_it_is_no_comment() {
    let text = "x,y\n1,2\n#N/A,3\n# a comment\n#n/a\n4,5\n";
    let found = message(text_with("t.csv", text, &ReadOptions::default()));
    assert!(found.contains("row 2 (line 3), column 0 (`x`): `#N/A`"), "{found}");
    let text = "x,y\n1,2\n#N/A,3\n# a comment\n4,5\n";
    let found = text_with("t.csv", text, &dropping()).unwrap();
    assert_eq!((found.dropped_rows(), rows(&found)), (1, vec![0, 2]));
    let one = text_with("t.csv", "x\n1\n#N/A\n#N/Another comment\n2\n", &dropping()).unwrap();
    assert_eq!((one.dropped_rows(), values(&one)), (1, vec![1.0, 2.0]));
}

#[test]
fn all_words_for_a_gap_are_doubtful_as_names() {
    for word in ["", "NA", "n/a", "#N/A", "<NA>", "null", "none", "?", ".", "-"] {
        let text = format!("{word},b\n1,2\n");
        let found = message(text_with("t.csv", &text, &ReadOptions::default()));
        assert!(found.contains("hardly a name"), "{word}: {found}");
    }
}

#[test]
fn semicolons_part_columns_before_decimal_commas() {
    let options =
        ReadOptions { decimal: Decimal::Comma, label: Some("0".to_owned()), ..Default::default() };
    let found = text_with("t.csv", "Ulm, Donau;1,5;2,5\nHof;1;2\n", &options).unwrap();
    assert_eq!((values(&found), found.labels.len()), (vec![1.5, 2.5, 1.0, 2.0], 2));
}

#[test]
fn rows_keep_their_numbers_where_a_box_or_a_grid_leaves_out_more() {
    let text = "0,0\n,9\n9,9\n1,1\n8,NA\n1,1.2\n2,2\n";
    let bounds = Some("0,0,3,3".parse::<Bounds>().unwrap());
    let found = text_with("t.csv", text, &ReadOptions { bounds, ..dropping() }).unwrap();
    assert_eq!(rows(&found), [0, 3, 5, 6]);
    assert_eq!((found.dropped_rows(), found.rows_in_file()), (2, 7));
    let thinning = Some(Thinning { cell: 1.0, except: None });
    let found = text_with("t.csv", text, &ReadOptions { thinning, ..dropping() }).unwrap();
    assert_eq!(rows(&found), [0, 2, 3, 6]);
    assert_eq!(found.describe_cell(1, 0).row, 3);
}

/// Raw values in memory are decoded as those of a pipe are.
#[test]
fn raw_values_that_are_not_mapped_are_left_out_too() {
    let bytes: Vec<u8> =
        [0.0, 1.0, f64::NAN, 3.0, 4.0, 5.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let scalar = taut_points::ScalarKind::F64;
    let (raw, format) = (Some(RawLayout { dim: 2, scalar, offset: 0 }), Some(Format::Raw));
    let options = ReadOptions { raw, format, ..dropping() };
    let found = open_bytes(bytes.clone(), "t.raw", &options).unwrap();
    assert_eq!((values(&found), rows(&found)), (vec![0.0, 1.0, 4.0, 5.0], vec![0, 2]));
    let options = ReadOptions { raw, format, ..Default::default() };
    assert!(message(open_bytes(bytes, "t.raw", &options)).contains("row 2, column 0"));
}

/// A shapefile of these records, each a type and numbers.
fn shapefile(kind: u32, records: &[(u32, &[f64])]) -> Vec<u8> {
    let mut body = vec![];
    for (number, (kind, numbers)) in records.iter().enumerate() {
        body.extend((number as u32 + 1).to_be_bytes());
        body.extend((2 + 4 * numbers.len() as u32).to_be_bytes());
        body.extend(kind.to_le_bytes());
        body.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }
    let mut file = vec![0; 100];
    file[..4].copy_from_slice(&9994_u32.to_be_bytes());
    file[24..28].copy_from_slice(&((100 + body.len() as u32) / 2).to_be_bytes());
    file[28..32].copy_from_slice(&1000_u32.to_le_bytes());
    file[32..36].copy_from_slice(&kind.to_le_bytes());
    file.extend(body);
    file
}

#[test]
fn a_null_shape_among_points_is_a_gap() {
    let file = shapefile(1, &[(1, &[1.0, 2.0]), (0, &[]), (1, &[3.0, 4.0])]);
    let found = message(open_bytes(file.clone(), "t.shp", &ReadOptions::default()));
    assert!(found.starts_with("t.shp: row 2, column 0 (`x`): the value is missing"), "{found}");
    let found = open_bytes(file, "t.shp", &dropping()).unwrap();
    assert_eq!((values(&found), rows(&found)), (vec![1.0, 2.0, 3.0, 4.0], vec![0, 2]));
}

#[test]
fn columns_of_a_table_have_names_of_their_own() {
    use taut_io::{Column, Table};

    let one = || Column::Whole(vec![1]);
    let table = Table::new().with("row", one()).with("row", one()).with("row", one());
    let names = Table::new().with("row", one()).with("row_", one()).with("row__", one());
    assert_eq!(table, names);
}

#[cfg(feature = "arrow")]
mod geometries {
    use std::collections::HashMap;
    use std::sync::Arc;

    use arrow_array::{ArrayRef, BinaryArray, Float64Array, RecordBatch};
    use arrow_schema::{Field, Schema};

    use super::*;

    /// A GeoParquet with this column of geometries.
    fn geoparquet(geometry: ArrayRef) -> Vec<u8> {
        let fields = vec![
            Field::new("size", arrow_schema::DataType::Float64, false),
            Field::new("geometry", geometry.data_type().clone(), true),
        ];
        let geo = r#"{"version": "1.1.0", "primary_column": "geometry", "columns": {}}"#;
        let metadata = HashMap::from([("geo".to_owned(), geo.to_owned())]);
        let schema = Arc::new(Schema::new_with_metadata(fields, metadata));
        let sizes: ArrayRef = Arc::new(Float64Array::from(vec![7.0; geometry.len()]));
        let batch = RecordBatch::try_new(schema.clone(), vec![sizes, geometry]).unwrap();
        let mut bytes = vec![];
        let mut writer = ::parquet::arrow::ArrowWriter::try_new(&mut bytes, schema, None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
        bytes
    }

    fn point(at: [f64; 2]) -> Vec<u8> {
        let mut bytes = vec![1, 1, 0, 0, 0];
        bytes.extend(at.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    fn ring(places: &[[f64; 2]]) -> Vec<u8> {
        let mut bytes = vec![1, 3, 0, 0, 0, 1, 0, 0, 0];
        bytes.extend((places.len() as u32).to_le_bytes());
        bytes.extend(places.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    #[test]
    fn null_and_empty_geometries_are_gaps() {
        let rows_of =
            [Some(point([1.0, 2.0])), None, Some(point([f64::NAN; 2])), Some(point([3.0, 4.0]))];
        let column: BinaryArray = rows_of.iter().map(Option::as_deref).collect();
        let file = geoparquet(Arc::new(column));
        let found = message(open_bytes(file.clone(), "t.parquet", &ReadOptions::default()));
        assert!(found.contains("row 2, column 1 (`geometry`): the value is missing"), "{found}");
        let found = open_bytes(file, "t.parquet", &dropping()).unwrap();
        assert_eq!((values(&found), rows(&found)), (vec![1.0, 2.0, 3.0, 4.0], vec![0, 3]));
        assert_eq!(found.dropped_rows(), 2);
        let empty: BinaryArray =
            [Some(point([f64::NAN; 2]))].iter().map(Option::as_deref).collect();
        let file = geoparquet(Arc::new(empty));
        let found = message(open_bytes(file, "t.parquet", &ReadOptions::default()));
        assert!(found.contains("row 1, column 1 (`geometry`): the value is missing"), "{found}");
    }

    #[test]
    fn rings_have_consecutive_numbers_beside_gaps() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let rows_of = [Some(ring(&square)), None, Some(ring(&square))];
        let column: BinaryArray = rows_of.iter().map(Option::as_deref).collect();
        let found = open_bytes(geoparquet(Arc::new(column)), "t.parquet", &dropping()).unwrap();
        assert_eq!(found.columns, ["x", "y", "ring"]);
        let mut numbers: Vec<f64> = values(&found).chunks(3).map(|row| row[2]).collect();
        numbers.dedup();
        assert_eq!((numbers, found.dropped_rows()), (vec![0.0, 1.0], 1));
        let column: BinaryArray = rows_of[..2].iter().map(Option::as_deref).collect();
        let found = open_bytes(geoparquet(Arc::new(column)), "t.parquet", &dropping()).unwrap();
        assert_eq!(found.columns, ["x", "y"]);
    }

    #[test]
    fn geometries_that_are_not_read_are_not_passed_over() {
        let column: ArrayRef = Arc::new(Float64Array::from(vec![1.0, 2.0]));
        let file = geoparquet(column);
        let found = message(open_bytes(file.clone(), "t.parquet", &ReadOptions::default()));
        assert!(found.contains("column `geometry` are Float64, not well-known binary"), "{found}");
        let columns = Some("size".parse().unwrap());
        let options = ReadOptions { columns, ..Default::default() };
        assert_eq!(values(&open_bytes(file, "t.parquet", &options).unwrap()), [7.0, 7.0]);
    }
}
