//! Each mistake in a file is met by a message that names file, row, column and value.

use taut_io::{Error, Format, RawLayout, ReadOptions, open_bytes};
use taut_points::ScalarKind;

use super::{message, open_default, text, text_with};

#[test]
fn text_names_row_line_column_and_value() {
    for (name, content, wanted) in [
        (
            "p.csv",
            "# c\nx,y\n1,2\n3\n",
            "p.csv: row 2 (line 4) has 1 column, but 2 are expected as in the header: \
             add or remove values there",
        ),
        (
            "p.csv",
            "1,2\n3,4,5\n",
            "p.csv: row 2 (line 2) has 3 columns, but 2 are expected as in the first row",
        ),
        ("p.csv", "x,y\n1,2\n3,a\n", "p.csv: row 2 (line 3), column 1 (`y`): `a` is not a number"),
        (
            "p.csv",
            "1,2\n3,\n",
            "p.csv: row 2 (line 2), column 1 (counted from 0): `` is not a number; fill in",
        ),
        ("p.csv", "1;2\n3;4,5\n", "`4,5` is not a number; write the decimal point as `.`"),
        (
            "p.csv",
            "1,2\n\n3,NaN\n",
            "p.csv: row 2 (line 3), column 1 (counted from 0): the value is NaN",
        ),
        ("p.csv", "x,y\n-inf,2\n", "p.csv: row 1 (line 2), column 0 (`x`): the value is -inf"),
        (
            "p.csv",
            "1,2\n3,1e999\n",
            "row 2 (line 2), column 1 (counted from 0): the value is 1e999",
        ),
        (
            "p.txt",
            "1 2\n3 4x\n",
            "p.txt: row 2 (line 2), column 1 (counted from 0): `4x` is not a number",
        ),
        ("p.txt", "1 2\n3 4\"5\"\n", "`4\\\"5\\\"` is not a number"),
        ("p.txt", "1 2\n3\"4\" 5\n", "`3\\\"4\\\"` is not a number"),
        ("p.tsv", "1\t2\n3 4\t5\n", "`3 4` is not a number"),
        ("p.csv", "x,y\n", "p.csv holds no point"),
        ("p.csv", "\n# nothing\n", "p.csv holds no point"),
        ("p.csv", "", "p.csv is empty: it holds no byte"),
        ("p.csv", "1\0", "p.csv is damaged or no csv file: it holds zero bytes"),
        ("p", "1,2\n", "p: the format cannot be told from the name; name it (one of csv, tsv"),
        (
            "p.tsp",
            "DIMENSION: 3\nNODE_COORD_SECTION\n1 2 3\nEOF\n",
            "its tsplib header promises 3 nodes, but there is 1",
        ),
        (
            "p.tsp",
            "DIMENSION: 1\nNODE_COORD_SECTION\n1 2 3\n2 3 4\n",
            "promises 1 node, but there are 2",
        ),
        (
            "p.tsp",
            "DIMENSION: x\nNODE_COORD_SECTION\n1 2 3\n",
            "DIMENSION on line 1 is `x`, not a count",
        ),
        ("p.tsp", "NODE_COORD_SECTION\n1 2 3\n", "it has no DIMENSION"),
        ("p.tsp", "DIMENSION: 3\nEDGE_WEIGHT_SECTION\n0 1 2\n", "it has no NODE_COORD_SECTION"),
        ("p.tsp", "DIMENSION: 1\nNODE_COORD_SECTION\n1 2\n", "line 3 has 2 values"),
        ("p.tsp", "DIMENSION: 1\nNODE_COORD_SECTION\n", "p.tsp holds no point"),
        (
            "p.tsp",
            "DIMENSION: 2\nNODE_COORD_SECTION\n1 2 3\n2 3 x\n",
            "p.tsp: row 2 (line 4), column 1 (`y`): `x`",
        ),
        ("p.xyz", "3\n\nO 0 0 0\nH 1 1 1\n", "its xyz header promises 3 points, but there are 2"),
        ("p.xyz", "0 1\n", "line 1 has 2 coordinates, not at least 3"),
        ("p.xyz", "2\n", "p.xyz holds no point"),
        (
            "p.xyz",
            "O 1 2 3\nH 1 2 inf\n",
            "p.xyz: row 2 (line 2), column 2 (`z`): the value is inf",
        ),
    ] {
        let found = message(text(name, content));
        assert!(found.contains(wanted), "{content:?}\n  gave {found}\n  not {wanted}");
    }
}

#[test]
fn a_long_value_is_shown_in_part_and_without_control_characters() {
    let found = message(text("p.csv", &format!("x\n{}\u{1b}[31m\n", "z".repeat(38))));
    assert!(found.contains("…") && !found.contains('\u{1b}'), "{found}");
}

fn npy(descr: &str, fortran: &str, shape: &str, values: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values);
    bytes
}

fn read_npy(bytes: Vec<u8>) -> Result<taut_io::Input, Error> {
    open_bytes(bytes, "a.npy", &ReadOptions::default())
}

#[test]
fn arrays_of_every_order_and_integer_type_are_read() {
    let wanted = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let bytes_of = |descr: &str, v: f64| -> Vec<u8> {
        let mut bytes = match &descr[1..] {
            "f4" => (v as f32).to_le_bytes().to_vec(),
            "f8" => v.to_le_bytes().to_vec(),
            "i1" | "u1" => vec![v as u8],
            "i2" | "u2" => (v as u16).to_le_bytes().to_vec(),
            "i4" | "u4" => (v as u32).to_le_bytes().to_vec(),
            _ => (v as u64).to_le_bytes().to_vec(),
        };
        if descr.starts_with('>') {
            bytes.reverse();
        }
        bytes
    };
    for descr in
        ["<f4", ">f4", "<f8", ">f8", "|i1", "|u1", "<i2", ">u2", "<i4", ">u4", "<i8", ">u8"]
    {
        let rows: Vec<u8> = wanted.iter().flat_map(|&v| bytes_of(descr, v)).collect();
        let columns: Vec<u8> =
            [1.0, 3.0, 5.0, 2.0, 4.0, 6.0].iter().flat_map(|&v| bytes_of(descr, v)).collect();
        let quoted = format!("'{descr}'");
        for (fortran, values) in [("False", rows), ("True", columns)] {
            let file = npy(&quoted, fortran, "(3, 2)", &values);
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.npy");
            std::fs::write(&path, &file).unwrap();
            for input in [read_npy(file).unwrap(), open_default(&path).unwrap()] {
                assert_eq!(super::values(&input), wanted, "{descr} {fortran}");
                assert_eq!(input.source.dim(), 2);
            }
        }
    }
    let negative = npy("'>i2'", "False", "(1,)", &[0xff, 0xfe]);
    assert_eq!(super::values(&read_npy(negative).unwrap()), [-2.0]);
    let one = read_npy(npy("'<f8'", "False", "(2,)", &[0; 16])).unwrap();
    assert_eq!((one.source.len(), one.source.dim()), (2, 1));
}

#[test]
fn arrays_that_are_no_points_are_refused_with_a_remedy() {
    for (descr, fortran, shape, values, wanted) in [
        ("'<c16'", "False", "(1, 1)", 16, "its element type is `<c16`; save it as float32"),
        ("'|O'", "False", "(1, 1)", 8, "its element type is `|O`"),
        (
            "[('x', '<f4'), ('y', '<f4')]",
            "False",
            "(1,)",
            8,
            "its elements are records with fields",
        ),
        ("'<f8'", "False", "(1, 1, 1)", 8, "its shape [1, 1, 1] has 3 axes"),
        ("'<f8'", "False", "()", 8, "has 0 axes"),
        ("'<f8'", "False", "(2, 0)", 0, "points of dimension 0"),
        ("'<f8'", "False", "(0, 2)", 0, "a.npy holds no point"),
        (
            "'<f8'",
            "False",
            "(2, 2)",
            31,
            "its npy header promises 32 bytes of values, but there are 31",
        ),
        ("'<f8'", "False", "(2, 2)", 33, "promises 32 bytes of values, but there are 33"),
        ("'<f8'", "True", "(2, 2)", 31, "promises 32 bytes of values, but there are 31"),
        ("'<f8'", "False", "(99999999999, 99999999999)", 8, "but there are 8"),
        ("'<f8'", "True", "(99999999999, 99999999999)", 8, "but there are 8"),
        ("'<f8'", "Maybe", "(1, 1)", 8, "its header is no dictionary"),
        ("'<f8'", "'x'", "(1, 1)", 8, "`fortran_order` is neither True nor False"),
        ("'<f8'", "False", "'x'", 8, "`shape` is no tuple"),
    ] {
        let file = npy(descr, fortran, shape, &vec![0; values]);
        let found = message(read_npy(file.clone()));
        assert!(found.contains(wanted), "{descr} {shape}: {found}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        std::fs::write(&path, &file).unwrap();
        let found = message(open_default(&path));
        assert!(found.contains(wanted), "{descr} {shape} as a file: {found}");
    }
    assert!(message(read_npy(b"1,2\n3,4\n".to_vec())).contains("no npy file: it does not begin"));
    assert!(message(read_npy(b"\x93NUMPY\x09\x00xx".to_vec())).contains("its version is 9"));
}

#[test]
fn values_of_arrays_are_named_by_row_and_column() {
    let nan: Vec<u8> =
        [1.0, 2.0, 3.0, f64::NAN].iter().flat_map(|v: &f64| v.to_le_bytes()).collect();
    let found = message(read_npy(npy("'<f8'", "False", "(2, 2)", &nan)));
    assert!(
        found.starts_with("a.npy: row 2, column 1 (counted from 0): the value is NaN"),
        "{found}"
    );
    let found = message(read_npy(npy("'<f8'", "True", "(2, 2)", &nan)));
    assert!(found.starts_with("a.npy: row 2, column 1"), "{found}");
    let nan_elsewhere = ReadOptions { columns: Some("0".parse().unwrap()), ..Default::default() };
    let input = open_bytes(npy("'<f8'", "False", "(2, 2)", &nan), "a.npy", &nan_elsewhere).unwrap();
    assert_eq!(super::values(&input), [1.0, 3.0]);
    let large = (i64::MAX).to_le_bytes();
    let found = message(read_npy(npy("'<i8'", "False", "(1, 1)", &large)));
    assert!(found.contains("the integer 9223372036854775807 is not exact as f64"), "{found}");
}

#[test]
fn fortran_order_must_fit_into_the_allowed_memory() {
    let options = ReadOptions { memory: Some(100), ..Default::default() };
    let file = npy("'<f8'", "True", "(4, 2)", &[0; 64]);
    let found = message(open_bytes(file, "a.npy", &options));
    assert!(found.contains("takes at least 128 bytes, but 100 are allowed"), "{found}");
}

#[test]
fn raw_values_need_a_layout_that_fits() {
    let with = |dim, offset| ReadOptions {
        raw: Some(RawLayout { dim, scalar: ScalarKind::F32, offset }),
        ..Default::default()
    };
    let read = |bytes: usize, options: &ReadOptions| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.raw");
        std::fs::write(&path, vec![0; bytes]).unwrap();
        let by_path = taut_io::open(&path, options)
            .map_err(|e| e.to_string().replace(path.to_str().unwrap(), "a.raw"));
        let by_bytes = open_bytes(vec![0; bytes], "a.raw", options).map_err(|e| e.to_string());
        let shape = |input: taut_io::Input| (input.source.len(), input.source.dim());
        let (by_path, by_bytes) = (by_path.map(shape), by_bytes.map(shape));
        assert_eq!(by_path, by_bytes);
        by_path
    };
    assert_eq!(read(24, &with(3, 0)), Ok((2, 3)));
    assert_eq!(read(24, &with(2, 8)), Ok((2, 2)));
    assert!(
        read(24, &ReadOptions::default()).unwrap_err().contains("tell neither dimension nor type")
    );
    assert!(read(24, &with(0, 0)).unwrap_err().contains("dimension at least 1"));
    assert_eq!(
        read(26, &with(3, 4)).unwrap_err(),
        "a.raw: 22 bytes after the first 4 do not make whole points of 12 bytes: 10 are left over; \
         check dimension, type and offset"
    );
    assert!(read(24, &with(usize::MAX, 0)).unwrap_err().contains("do not make whole points"));
    assert!(read(24, &with(3, 24)).unwrap_err().contains("holds no point"));
}

#[test]
fn paths_that_are_no_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.csv");
    assert_eq!(
        message(open_default(&missing)),
        format!("{}: no such file or folder", missing.display())
    );
    assert_eq!(
        message(open_default(folder.path())),
        format!("{} is a folder: name a file in it", folder.path().display())
    );
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("secret.csv");
    std::fs::write(&path, "1,2\n").unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)).unwrap();
    if std::fs::File::open(&path).is_ok() {
        println!("skipped a_file_without_permission_is_named: this user may read everything");
        return;
    }
    assert_eq!(
        message(open_default(&path)),
        format!("{}: no permission to read it", path.display())
    );
}

#[cfg(unix)]
#[test]
fn a_pipe_is_read_like_standard_input() {
    use std::io::Write;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    if !made.is_ok_and(|status| status.success()) {
        println!("skipped a_pipe_is_read_like_standard_input: there is no mkfifo");
        return;
    }
    let writer = {
        let path = path.clone();
        std::thread::spawn(move || {
            std::fs::File::options()
                .write(true)
                .open(path)
                .unwrap()
                .write_all(b"1,2\n3,4\n")
                .unwrap();
        })
    };
    let input = open_default(&path).unwrap();
    writer.join().unwrap();
    assert_eq!((input.format, super::values(&input)), (Format::Csv, vec![1.0, 2.0, 3.0, 4.0]));
}

#[test]
fn a_selection_by_name_needs_names() {
    let options = ReadOptions { columns: Some("x".parse().unwrap()), ..Default::default() };
    assert!(message(text_with("p.csv", "1,2\n", &options)).contains("select columns by number"));
}

#[cfg(not(feature = "arrow"))]
#[test]
fn formats_left_out_of_the_build_are_refused_with_a_sentence() {
    let found = message(open_bytes(b"PAR1".to_vec(), "p.parquet", &ReadOptions::default()));
    assert!(found.contains("this build of taut reads and writes no parquet files"), "{found}");
}

#[cfg(not(all(feature = "xz", feature = "zstd")))]
#[test]
fn compressions_left_out_of_the_build_are_refused_with_a_sentence() {
    let packed: [(&str, &[u8]); 2] =
        [("xz", b"\xfd7zXZ\0"), ("zst", &[0x28, 0xb5, 0x2f, 0xfd, 0, 0])];
    for (extension, start) in packed {
        let name = format!("p.csv.{extension}");
        if super::unpacks(&name) {
            continue;
        }
        let wanted = match extension {
            "xz" => {
                "this build of taut reads and writes no xz files; build it with the feature `xz`"
            }
            _ => {
                "this build of taut reads and writes no zstd files; build it with the feature `zstd`"
            }
        };
        // By the name, and by the first bytes.
        for name in [&*name, "p"] {
            let found = message(open_bytes(start.to_vec(), name, &ReadOptions::default()));
            assert!(found.contains(wanted), "{found}");
        }
        let folder = tempfile::tempdir().unwrap();
        let points = taut_points::Points::new(&[1.0, 2.0], 2).unwrap();
        let monitor = taut_points::Monitor::silent();
        let path = folder.path().join(&name);
        let refused = taut_io::write_points(&points, &[], &path, None, &monitor).unwrap_err();
        assert!(refused.to_string().contains(wanted), "{refused}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}

#[cfg(feature = "arrow")]
mod tables {
    use std::sync::Arc;

    use arrow_array::types::{Float32Type, Int32Type};
    use arrow_array::{
        ArrayRef, BooleanArray, FixedSizeListArray, Float32Array, Float64Array, Int64Array,
        ListArray, RecordBatch, StringArray,
    };
    use taut_io::{Input, ReadOptions, open_bytes};
    use taut_points::ScalarKind;

    use super::message;

    fn arrow(columns: &[(&str, ArrayRef)]) -> Vec<u8> {
        let batch = RecordBatch::try_from_iter(columns.iter().cloned()).unwrap();
        let mut bytes = Vec::new();
        let mut writer =
            arrow_ipc::writer::FileWriter::try_new(&mut bytes, &batch.schema()).unwrap();
        writer.write(&batch).unwrap();
        writer.finish().unwrap();
        drop(writer);
        bytes
    }

    fn parquet(columns: &[(&str, ArrayRef)]) -> Vec<u8> {
        let batch = RecordBatch::try_from_iter(columns.iter().cloned()).unwrap();
        let mut bytes = Vec::new();
        let mut writer =
            ::parquet::arrow::ArrowWriter::try_new(&mut bytes, batch.schema(), None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
        bytes
    }

    /// Returns what both formats say, which must be the same.
    fn both(columns: &[(&str, ArrayRef)], selected: Option<&str>) -> Result<Input, String> {
        let options = ReadOptions {
            columns: selected.map(|text| text.parse().unwrap()),
            ..Default::default()
        };
        let read = |bytes, name| open_bytes(bytes, name, &options);
        let (one, other) = (read(arrow(columns), "t.arrow"), read(parquet(columns), "t.parquet"));
        match (one, other) {
            (Ok(one), Ok(other)) => {
                assert_eq!(super::super::values(&one), super::super::values(&other));
                assert_eq!(one.columns, other.columns);
                Ok(one)
            }
            (one, other) => {
                let (one, other) = (message(one), message(other));
                assert_eq!(one, other.replace("t.parquet", "t.arrow"));
                Err(one)
            }
        }
    }

    fn label() -> (&'static str, ArrayRef) {
        ("label", Arc::new(StringArray::from(vec!["a", "b"])))
    }

    #[test]
    fn numeric_columns_are_taken_and_others_left() {
        let table = [
            label(),
            ("x", Arc::new(Float32Array::from(vec![1.0, 2.0])) as ArrayRef),
            ("n", Arc::new(Int64Array::from(vec![3, 4]))),
            ("yes", Arc::new(BooleanArray::from(vec![true, false]))),
        ];
        let input = both(&table, None).unwrap();
        assert_eq!(input.columns, ["x", "n"]);
        assert_eq!(input.source.scalar(), ScalarKind::F64);
        assert_eq!(super::super::values(&input), [1.0, 3.0, 2.0, 4.0]);
        assert_eq!(input.describe_cell(1, 1).to_string(), "t.arrow: row 2, column 2 (`n`)");
        let narrow = both(&table, Some("x,x")).unwrap();
        assert_eq!(narrow.source.scalar(), ScalarKind::F32);
        assert_eq!(super::super::values(&narrow), [1.0, 1.0, 2.0, 2.0]);
        assert_eq!(super::super::values(&both(&table, Some("n,x")).unwrap()), [3.0, 1.0, 4.0, 2.0]);
    }

    #[test]
    fn a_column_of_lists_is_the_points() {
        let lists = |rows: Vec<Option<Vec<Option<f32>>>>| -> [(&str, ArrayRef); 2] {
            let rows = ListArray::from_iter_primitive::<Float32Type, _, _>(rows);
            [label(), ("point", Arc::new(rows))]
        };
        let good = lists(vec![Some(vec![Some(1.0), Some(2.0)]), Some(vec![Some(3.0), Some(4.0)])]);
        let input = both(&good, None).unwrap();
        assert_eq!((input.source.dim(), input.source.scalar()), (2, ScalarKind::F32));
        assert_eq!(super::super::values(&input), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(super::super::values(&both(&good, Some("point")).unwrap()).len(), 4);
        let fixed = FixedSizeListArray::from_iter_primitive::<Int32Type, _, _>(
            [Some([Some(1), Some(2)]), Some([Some(3), Some(4)])],
            2,
        );
        let input = both(&[("point", Arc::new(fixed) as ArrayRef)], None).unwrap();
        assert_eq!(super::super::values(&input), [1.0, 2.0, 3.0, 4.0]);

        let ragged = lists(vec![Some(vec![Some(1.0), Some(2.0)]), Some(vec![Some(3.0)])]);
        let found = both(&ragged, None).unwrap_err();
        assert!(
            found.contains("row 2 of column `point` is a list of 1 values, but the first has 2")
        );
        let hole = lists(vec![Some(vec![Some(1.0), Some(2.0)]), Some(vec![None, Some(3.0)])]);
        let found = both(&hole, None).unwrap_err();
        assert!(found.starts_with("t.arrow: row 2, column 0 (`point`): the value is missing"));
        let missing = lists(vec![Some(vec![Some(1.0)]), None]);
        assert!(both(&missing, None).unwrap_err().contains("row 2, column 1 (`point`)"));
        let nan = lists(vec![Some(vec![Some(1.0)]), Some(vec![Some(f32::NAN)])]);
        assert!(
            both(&nan, None).unwrap_err().contains("row 2, column 0 (`point`): the value is NaN")
        );
        let empty = lists(vec![Some(vec![]), Some(vec![])]);
        assert!(both(&empty, None).unwrap_err().contains("the lists of column `point` are empty"));
    }

    #[test]
    fn bad_values_and_columns_are_named() {
        let x = |values: Vec<Option<f64>>| -> [(&str, ArrayRef); 2] {
            [label(), ("x", Arc::new(Float64Array::from(values)))]
        };
        let found = both(&x(vec![Some(1.0), None]), None).unwrap_err();
        assert!(found.starts_with("t.arrow: row 2, column 1 (`x`): the value is missing (null)"));
        let found = both(&x(vec![Some(1.0), Some(f64::INFINITY)]), None).unwrap_err();
        assert!(found.starts_with("t.arrow: row 2, column 1 (`x`): the value is inf"), "{found}");
        let large: ArrayRef = Arc::new(Int64Array::from(vec![0, (1 << 53) + 1]));
        let found = both(&[("n", large)], None).unwrap_err();
        assert!(found.contains("row 2, column 0 (`n`): the integer 9007199254740993 is not exact"));
        let found = both(&x(vec![Some(1.0), Some(2.0)]), Some("label,x")).unwrap_err();
        assert!(found.contains("column `label` holds Utf8, not numbers"), "{found}");
        let found = both(&[label()], None).unwrap_err();
        assert!(found.contains("no numeric column among its columns `label (Utf8)`"), "{found}");
        let found = both(&x(vec![Some(1.0), Some(2.0)]), Some("y")).unwrap_err();
        assert!(found.contains("there is no column `y`; there are `label`, `x`"), "{found}");
        let none: ArrayRef = Arc::new(Float64Array::from(Vec::<f64>::new()));
        assert!(both(&[("x", none)], None).unwrap_err().contains("holds no point"));
    }

    #[test]
    fn streams_and_compressed_batches_are_read() {
        let batch = RecordBatch::try_from_iter([
            label(),
            ("x", Arc::new(Float64Array::from(vec![1.0, 2.0])) as ArrayRef),
        ])
        .unwrap();
        for compression in [
            None,
            Some(arrow_ipc::CompressionType::LZ4_FRAME),
            cfg!(feature = "zstd").then_some(arrow_ipc::CompressionType::ZSTD),
        ] {
            let options = arrow_ipc::writer::IpcWriteOptions::default()
                .try_with_compression(compression)
                .unwrap();
            let mut bytes = Vec::new();
            let mut writer = arrow_ipc::writer::StreamWriter::try_new_with_options(
                &mut bytes,
                &batch.schema(),
                options,
            )
            .unwrap();
            writer.write(&batch).unwrap();
            writer.write(&batch.slice(1, 1)).unwrap();
            writer.finish().unwrap();
            drop(writer);
            // Without a name, the first bytes tell.
            let input = open_bytes(bytes, "stream", &ReadOptions::default()).unwrap();
            assert_eq!(super::super::values(&input), [1.0, 2.0, 2.0]);
        }
    }
}
