//! Matrices in `.npy` files.

use super::words;

use crate::test_folder::TestFolder;
use crate::test_length::long_or;
/// An array as NumPy writes it.
fn npy(dtype: &str, fortran: bool, shape: &str, values: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let text = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}");
    let text = format!("{text:117}\n");
    let length = (text.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00".as_slice(), &length, text.as_bytes(), values].concat()
}

/// The transpose of rows × columns elements of `width` bytes.
fn turned(values: &[u8], rows: usize, columns: usize, width: usize) -> Vec<u8> {
    let places = (0..columns).flat_map(|j| (0..rows).map(move |i| (i * columns + j) * width));
    places.flat_map(|at| values[at..at + width].to_vec()).collect()
}

#[test]
fn arrays_of_any_type_and_order_are_turned() {
    let folder = TestFolder::new();
    let types =
        [("<f8", 8), (">f4", 4), ("<U2", 8), ("|S3", 3), ("<c16", 16), ("|u1", 1), ("<M8[ns]", 8)];
    for (dtype, width) in types.into_iter().step_by(long_or(1, 3)) {
        let values: Vec<u8> =
            words((70 * 30 * width) as u64).into_iter().map(|word| word as u8).collect();
        let other = turned(&values, 70, 30, width);
        for (fortran, bytes) in [(false, &values), (true, &other)] {
            folder.put("a.npy", npy(dtype, fortran, "(70, 30)", bytes));
            folder
                .taut("memory transpose a.npy --memory 4K -o b.npy --certificate b.json")
                .ends(0)
                .stdout_has(&["30 × 70 elements", dtype, "all elements"]);
            assert!(folder.bytes("b.npy") == npy(dtype, false, "(30, 70)", &other), "{dtype}");
            folder.taut("verify b.json a.npy b.npy").ends(0).stdout_has(&[
                "Verified: 30 × 70, the transpose",
                "each compared with the one of the input",
            ]);
            folder.taut("verify b.json b.npy").ends(0).stdout_has(&["by a hash"]);
            folder
                .taut("memory transpose a.npy --samples 20 -o c.npy")
                .ends(0)
                .stdout_has(&["20 elements"]);
            assert!(folder.bytes("b.npy") == folder.bytes("c.npy"));
        }
    }
    let mut wrong = folder.bytes("b.npy");
    wrong[128 + 8 * 71] ^= 1;
    folder.put("b.npy", wrong);
    folder
        .taut("verify b.json a.npy b.npy")
        .ends(1)
        .stdout_has(&["Rejected: b.npy has another element in row 1, column 1 than a.npy"]);
    folder.taut("verify b.json b.npy a.npy").ends(1);
}

#[test]
fn headers_that_numpy_reads_and_headers_that_lie() {
    let folder = TestFolder::new();
    let values: Vec<u8> = words(5 * 6 * 8).into_iter().map(|word| word as u8).collect();
    for header in [
        r#"{"descr": "<f8", "fortran_order": False, "shape": (5, 6)}"#,
        "{'shape': (5, 6), 'fortran_order': False, 'descr': 'f8', }",
    ] {
        let text = format!("{header:117}\n");
        let length = (text.len() as u16).to_le_bytes();
        folder.put(
            "a.npy",
            [b"\x93NUMPY\x01\x00".as_slice(), &length, text.as_bytes(), values.as_slice()].concat(),
        );
        folder.taut("memory transpose a.npy -o b.npy --certificate b.json").ends(0);
        folder.taut("verify b.json a.npy b.npy").ends(0);
    }
    // Without the type the header is judged all the same.
    let lines = folder.text("b.json");
    let without: Vec<&str> = lines.lines().filter(|line| !line.contains("dtype")).collect();
    folder.put(
        "b.json",
        without.join("\n").replace("\"output_offset\": 128,", "\"output_offset\": 128"),
    );
    folder.taut("verify b.json a.npy b.npy").ends(0).stdout_has(&["byte 128 of the input"]);
    let turned = folder.bytes("b.npy")[128..].to_vec();
    for lie in [npy("<f8", true, "(6, 5)", &turned), npy("<f8", false, "(30, 1)", &turned)] {
        folder.put("b.npy", lie);
        folder.taut("verify b.json b.npy").ends(1).stdout_has(&["Rejected: the header of b.npy"]);
    }
}

#[test]
fn rows_columns_and_nothing() {
    let folder = TestFolder::new();
    let eight = [1, 2, 3, 4, 5, 6, 7, 8];
    for (shape, other) in [("(1, 8)", "(8, 1)"), ("(8, 1)", "(1, 8)")] {
        for fortran in [false, true] {
            folder.put("a.npy", npy("|i1", fortran, shape, &eight));
            folder.taut("memory transpose a.npy -o b.npy --certificate b.json").ends(0);
            assert!(folder.bytes("b.npy") == npy("|i1", false, other, &eight));
            folder.taut("verify b.json a.npy b.npy").ends(0);
        }
    }
    for (shape, other) in [("(0, 8)", "(8, 0)"), ("(5, 0)", "(0, 5)"), ("(0, 0)", "(0, 0)")] {
        folder.put("a.npy", npy("<f8", true, shape, &[]));
        folder.taut("memory transpose a.npy -o b.npy --certificate b.json").ends(0);
        assert!(folder.bytes("b.npy") == npy("<f8", false, other, &[]));
        folder.taut("verify b.json a.npy b.npy").ends(0);
    }
}

#[test]
fn what_is_no_matrix_is_refused_by_name() {
    let folder = TestFolder::new();
    let plain = npy("<f8", false, "(1, 2)", &[0; 16]);
    for (bytes, options, said) in [
        (npy("<f8", false, "(3,)", &[0; 24]), "-o b.npy", &["a.npy", "1 axes"][..]),
        (npy("<f8", false, "(1, 2, 3)", &[0; 48]), "-o b.npy", &["a.npy", "3 axes"]),
        (npy("|O", false, "(1, 2)", &[0; 16]), "-o b.npy", &["a.npy", "|O"]),
        (npy("<f8", false, "(1, 3)", &[0; 16]), "-o b.npy", &["a.npy", "16"]),
        (b"1,2\n".to_vec(), "-o b.npy", &["a.npy"]),
        (plain.clone(), "-o b.bin", &["b.bin", "name it .npy"]),
        (plain.clone(), "--rows 1 -o b.npy", &["--row-count", "a.npy"]),
        (plain.clone(), "--offset 1 -o b.npy", &["--raw-offset"]),
        (plain.clone(), "-o a.npy", &["a.npy", "is the input"]),
    ] {
        folder.put("a.npy", bytes);
        folder.taut(&format!("memory transpose a.npy {options}")).ends(2).stderr_has(said);
        assert_eq!(folder.files(), ["a.npy"]);
    }
    folder.taut("memory transpose a.npy --samples 1 --certificate b.json -o b.npy").ends(2);
    for missing in ["missing.npy -o b.npy", "missing.bin --rows 1 --columns 2 -o b.bin"] {
        let named = ["missing", ": no such file or folder"];
        folder.taut(&format!("memory transpose {missing}")).ends(2).stderr_has(&named);
    }
    folder.put("a.bin", [0; 16]);
    folder.taut("memory transpose a.bin -o b.bin").ends(2).stderr_has(&["a.bin", "--row-count N"]);
    folder
        .taut("memory transpose a.bin --rows 1 --columns 2 -o b.npy")
        .ends(2)
        .stderr_has(&["b.npy", "without a header"]);
    folder
        .taut("memory transpose a.bin --rows 1 --columns 2 -o b.bin --certificate b.json")
        .ends(0);
    folder.taut("verify b.json a.bin c.bin").ends(2).stderr_has(&["c.bin: no such file or folder"]);
    folder
        .taut("verify b.json a.bin b.bin")
        .ends(0)
        .stdout_has(&["Verified: 2 × 1, the transpose"]);
}

#[test]
fn rows_of_arrays_are_sorted_by_their_header() {
    let folder = TestFolder::new();
    let rows: Vec<[f64; 3]> = words(900)
        .as_chunks::<3>()
        .0
        .iter()
        .map(|row| row.map(|word| word as i64 as f64))
        .collect();
    let bytes = |rows: &[[f64; 3]]| -> Vec<u8> {
        rows.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect()
    };
    let mut sorted = rows.clone();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    folder.put("in.npy", npy("<f8", false, "(300, 3)", &bytes(&rows)));
    folder
        .taut("memory sort in.npy -o out.npy --certificate out.json")
        .ends(0)
        .stdout_has(&["300 records of 24 bytes in order of bytes 0 to 7"]);
    assert!(folder.bytes("out.npy") == npy("<f8", false, "(300, 3)", &bytes(&sorted)));
    folder.taut("verify out.json in.npy out.npy").ends(0).stdout_has(&[
        "Verified: 300 records of 24 bytes in order",
        "as f64; proved: no key is below",
        "\n  header     128 bytes; proved: as it was, by the same hash\n",
    ]);
    // Another header is another file, and so is another number.
    for at in [70, 150] {
        let mut wrong = folder.bytes("out.npy");
        wrong[at] ^= 1;
        folder.put("wrong.npy", wrong);
        folder.taut("verify out.json wrong.npy").ends(1);
    }
    // By the second column, and numbers of one axis.
    sorted.sort_by(|a, b| a[1].total_cmp(&b[1]));
    folder.taut("memory sort in.npy -o out.npy --sort-key 8:16 --quiet").ends(0);
    assert!(folder.bytes("out.npy")[128..] == bytes(&sorted));
    let whole: Vec<u8> = [3i64, -1, 2].into_iter().flat_map(i64::to_le_bytes).collect();
    folder.put("whole.npy", npy("<i8", true, "(3,)", &whole));
    folder.taut("memory sort whole.npy -o whole.npy --quiet").ends(2);
    folder.taut("memory sort whole.npy -o less.npy --quiet").ends(0);
    let less: Vec<u8> = [-1i64, 2, 3].into_iter().flat_map(i64::to_le_bytes).collect();
    assert!(folder.bytes("less.npy") == npy("<i8", true, "(3,)", &less));
    folder.put("small.npy", npy("<f4", false, "(2, 2)", &[0; 16]));
    folder.put("columns.npy", npy("<f8", true, "(2, 2)", &[0; 32]));
    folder.put("none.npy", npy("<f8", false, "(2, 0)", &[]));
    folder.put("large.npy", npy("<f8", false, "(0, 4294967296, 4294967296)", &[]));
    folder.put("one.npy", npy("<f8", false, "()", &[0; 8]));
    for (line, said) in [
        ("small.npy -o x.npy", "rows of type <f4 have no order"),
        ("columns.npy -o x.npy", "Fortran order"),
        ("none.npy -o x.npy", "its rows have no bytes, or too many"),
        ("large.npy -o x.npy", "its rows have no bytes, or too many"),
        ("one.npy -o x.npy", "is a single number"),
        ("in.npy -o x.bin", "name it .npy"),
        ("in.npy -o x.npy --item-bytes 8", "leave it out"),
    ] {
        folder.taut(&format!("memory sort {line}")).ends(2).stderr_has(&[said]);
    }
}
