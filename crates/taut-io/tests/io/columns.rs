//! Which columns are coordinates.

use taut_io::{Columns, ReadOptions, open_bytes};

use super::{message, text_with, values};

fn selecting(columns: &str) -> ReadOptions {
    ReadOptions { columns: Some(columns.parse().unwrap()), ..Default::default() }
}

const TABLE: &str = "name,x,y,x-1\nfirst,1,2,3\nsecond,4,5,6\n";

#[test]
fn names_numbers_and_ranges_select_in_their_order() {
    for (columns, wanted) in [
        ("x,y", vec![1.0, 2.0, 4.0, 5.0]),
        ("y,x", vec![2.0, 1.0, 5.0, 4.0]),
        ("1-2", vec![1.0, 2.0, 4.0, 5.0]),
        ("3", vec![3.0, 6.0]),
        (" 3 , x ", vec![3.0, 1.0, 6.0, 4.0]),
        ("x-1", vec![3.0, 6.0]),
        ("1-", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
    ] {
        let input = text_with("t.csv", TABLE, &selecting(columns)).unwrap();
        assert_eq!(values(&input), wanted, "{columns}");
        assert_eq!(input.columns.len(), input.source.dim());
    }
}

#[test]
fn a_cell_is_described_by_its_column_in_the_file() {
    let input = text_with("t.csv", TABLE, &selecting("y,x")).unwrap();
    assert_eq!(input.describe_cell(1, 0).to_string(), "t.csv: row 2, column 2 (`y`)");
    let input = text_with("t.csv", "1,2,3\n", &selecting("2")).unwrap();
    assert_eq!(input.describe_cell(0, 0).to_string(), "t.csv: row 1, column 2 (counted from 0)");
}

#[test]
fn columns_that_are_not_there_are_named() {
    let read = |columns| message(text_with("t.csv", TABLE, &selecting(columns)));
    assert_eq!(read("4"), "t.csv: there is no column 4: it has 4 columns, counted from 0");
    assert_eq!(read("2-9"), "t.csv: there is no column 9: it has 4 columns, counted from 0");
    assert_eq!(read("z"), "t.csv: there is no column `z`; there are `name`, `x`, `y`, `x-1`");
    assert!(message(text_with("t.csv", "1,2\n3,4\n", &selecting("x"))).contains("has no header"));
}

#[test]
fn a_label_without_a_header_is_left_out_by_number() {
    let input = text_with("t.csv", "a,1,2\nb,3,4\n", &selecting("1-")).unwrap();
    assert_eq!(values(&input), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn arrays_select_by_number() {
    let mut npy = b"\x93NUMPY\x01\x00\x3e\x00".to_vec();
    npy.extend(b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }   \n");
    npy.truncate(10 + 0x3e);
    npy.extend([1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0].iter().flat_map(|v| v.to_le_bytes()));
    let input = open_bytes(npy, "a.npy", &selecting("2,0")).unwrap();
    assert_eq!(values(&input), [3.0, 1.0, 6.0, 4.0]);
}

#[test]
fn a_selection_that_says_nothing_is_refused_with_examples() {
    for wrong in ["", "x,,y", ",", "3-1", "99999999999999999999999"] {
        let refused = wrong.parse::<Columns>().unwrap_err().to_string();
        assert!(refused.contains("`0-2,5`"), "{wrong}: {refused}");
    }
}

#[test]
fn a_selection_reads_back_from_its_own_text() {
    for text in ["x,y,z", "0-2,5", "1-", "x-1,0"] {
        let columns: Columns = text.parse().unwrap();
        assert_eq!(columns.to_string(), text);
        assert_eq!(columns.to_string().parse::<Columns>().unwrap(), columns);
    }
}
