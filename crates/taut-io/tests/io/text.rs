//! The many ways in which people write numbers into text.

use taut_io::{Format, Header, ReadOptions, open_bytes};

use super::{message, text, text_with, values};

#[test]
fn delimiters_are_found() {
    for content in [
        "1,2\n3,4\n",
        "1;2\n3;4\n",
        "1\t2\n3\t4\n",
        "1 2\n3 4\n",
        " 1 ,\t2 \r\n3 , 4",
        "1, 2\n3, 4",
    ] {
        let input = text("p.csv", content).unwrap();
        assert_eq!(
            (input.source.dim(), values(&input)),
            (2, vec![1.0, 2.0, 3.0, 4.0]),
            "{content:?}"
        );
    }
    assert_eq!(text("p.csv", "1\n2\n3").unwrap().source.dim(), 1);
    assert_eq!(values(&text("p.txt", "  1 \t 2  \n\t3 4\t\n").unwrap()), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(text("p.tsv", "a b\tc\n1\t2\n").unwrap().columns, ["a b", "c"]);
    assert_eq!(text("p.csv", "a b;c d\n1;2\n").unwrap().columns, ["a b", "c d"]);
    assert_eq!(text("p.csv", "a b\n1 2\n").unwrap().columns, ["a", "b"]);
}

#[test]
fn marks_comments_blank_lines_and_line_ends_do_not_count() {
    let content = "\u{feff}# said, first\r\n\r\n x , y \r\n\r\n  # and, then\r\n1,2\r\n   \r\n3,4";
    let input = text("p.csv", content).unwrap();
    assert_eq!(input.columns, ["x", "y"]);
    assert_eq!(values(&input), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(values(&text("p.csv", "\u{feff}1,2\n").unwrap()), [1.0, 2.0]);
}

#[test]
fn numbers_in_every_dress() {
    let input = text("p.csv", "+1,-.5,1e3,1E-3,00.1,-0,123456789012345678901234567890\n").unwrap();
    assert_eq!(values(&input), [1.0, -0.5, 1e3, 1e-3, 0.1, -0.0, 123456789012345678901234567890.0]);
}

#[test]
fn quotes_hold_delimiters_quotes_and_line_ends() {
    let content = "\"a,b\",\"say \"\"x\"\"\",\"two\nlines\"\n\"1\",\"2\", \"3\" \n4,5,6\n";
    let input = text("p.csv", content).unwrap();
    assert_eq!(input.columns, ["a,b", "say \"x\"", "two\nlines"]);
    assert_eq!(values(&input), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(message(text("p.csv", "1,2\n3,\"4\n5,6\n")).contains("opens on line 2 never closes"));
    // The comment's apostrophes and inches open nothing.
    assert_eq!(text("p.csv", "# 5\" wide\n1,2\n").unwrap().source.len(), 1);
    let rows = message(text("p.csv", "\"a\nb\",c\n1,2\n3,x\n"));
    assert!(rows.starts_with("p.csv: row 2 (line 4), column 1 (`c`): `x`"), "{rows}");
}

#[test]
fn the_first_row_is_a_header_when_it_is_one() {
    let with = |header, content| {
        text_with("p.csv", content, &ReadOptions { header, ..Default::default() })
    };
    assert_eq!(text("p.csv", "x,y\n1,2\n").unwrap().source.len(), 1);
    assert_eq!(text("p.csv", "1,2\n3,4\n").unwrap().source.len(), 2);
    let promised = with(Header::Present, "1,2\n3,4\n").unwrap();
    assert_eq!(
        (promised.source.len(), promised.columns),
        (1, vec!["1".to_owned(), "2".to_owned()])
    );
    assert!(message(with(Header::Absent, "x,y\n1,2\n")).contains("row 1 (line 1), column 0"));
    // A typing error in the first row is not a header, and NaN is a number.
    assert_eq!(
        message(text("p.csv", "# c\n1,2,x3\n4,5,6\n")),
        "p.csv: row 1 (line 2) mixes numbers with other text (`x3` in column 2, counted from 0): \
         say whether it is a header, select the numeric columns, or repair the value"
    );
    assert!(message(text("p.csv", "1,nan\n3,4\n")).contains("row 1 (line 1), column 1"));
}

#[test]
fn a_first_row_with_a_value_that_went_wrong_is_no_header() {
    for wrong in ["1O", "1e", "-", ".5.", "+x", "NA", "n/a", "null", "?", "", "1 000"] {
        for content in [format!("{wrong},2\n3,4\n"), format!("x,{wrong}\n3,4\n")] {
            let said = message(text("p.csv", &content));
            let place = if content.starts_with('x') { "column 1" } else { "column 0" };
            assert!(said.starts_with(&format!("p.csv: row 1 (line 1), {place}")), "{said}");
            assert!(said.contains(&format!("`{wrong}`")) && said.contains("--header"), "{said}");
            let header = Header::Present;
            let options = ReadOptions { header, ..Default::default() };
            assert_eq!(text_with("p.csv", &content, &options).unwrap().source.len(), 1);
        }
    }
    assert!(text("p.txt", "1,5 2,5\n3 4\n").is_err());
    // A selection does not hide such a field beside names, but beside numbers it may leave it out.
    let by = |columns: &str, content: &str| {
        let columns = Some(columns.parse().unwrap());
        text_with("p.csv", content, &ReadOptions { columns, ..Default::default() })
    };
    assert!(by("1", "1O,x\n3,4\n").is_err());
    assert!(by("y", "1O,x\n3,4\n").is_err());
    assert!(by("x,0", "1O,x\n3,4\n").is_err());
    // The row that holds the names asked for is the header, such as one with a hole over its index.
    assert_eq!(by("x", ",x\n3,4\n").unwrap().source.len(), 1);
    assert_eq!(by("1", "?,2\n3,4\n").unwrap().source.len(), 2);
    assert_eq!(by("1-", "name,1,2\na,1,2\n").unwrap().source.len(), 2);
}

#[test]
fn messages_count_well_and_hold_no_control_characters() {
    let said = message(text("p\u{1b}[31m.csv", "1,2\n3\n"));
    assert!(said.starts_with("p\\u{1b}[31m.csv: row 2 (line 2) has 1 column, but 2 are"), "{said}");
    let columns = Some("z".parse().unwrap());
    let options = ReadOptions { columns, ..Default::default() };
    let said = message(text_with("p.csv", "\u{7}x\n1\n", &options));
    assert!(said.ends_with("there is no column `z`; there is `\\u{7}x`"), "{said}");
    for blank in ["\n\n", "# only this\n", "x,y\n"] {
        let said = message(text("p.csv", blank));
        assert_eq!(said, "p.csv holds no point: there is no row of data in it");
    }
}

#[test]
fn tsplib_gives_two_or_three_coordinates() {
    let head = "NAME : small\nTYPE: TSP\nDIMENSION : 2\nEDGE_WEIGHT_TYPE : EUC_2D\n";
    for tail in ["EOF\n", "", "-1\nEOF", "DISPLAY_DATA_SECTION\n1 9 9\n"] {
        let input =
            text("p.tsp", &format!("{head}NODE_COORD_SECTION\n 1 0.5 2e1\n2 3 4\n{tail}")).unwrap();
        assert_eq!(
            (values(&input), &input.columns[..]),
            (vec![0.5, 20.0, 3.0, 4.0], &["x".to_owned(), "y".to_owned()][..])
        );
    }
    let input = text("p.tsp", "DIMENSION:1\nNODE_COORD_SECTION\n7 1 2 3\nEOF").unwrap();
    assert_eq!(values(&input), [1.0, 2.0, 3.0]);
}

#[test]
fn xyz_with_and_without_symbols_counts_and_further_columns() {
    for content in [
        "0 1 2\n3 4 5\n",
        "2\n\nO 0 1 2\nH 3 4 5\n",
        "2\nwater, 3 atoms 1 2 3\nO 0 1 2 -0.8\nH 3 4 5 0.4\n",
        "2\n0 1 2\n3 4 5\n",
        "0 1 2 255 255 0\n3 4 5 0 0 0\n",
    ] {
        let input = text("p.xyz", content).unwrap();
        assert_eq!(values(&input), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "{content:?}");
        assert_eq!(input.columns, ["x", "y", "z"]);
    }
    let options = ReadOptions { columns: Some("z,3".parse().unwrap()), ..Default::default() };
    assert_eq!(values(&text_with("p.xyz", "A 0 1 2 9\n", &options).unwrap()), [2.0, 9.0]);
}

#[test]
fn a_format_that_is_named_beats_the_extension() {
    let options = ReadOptions { format: Some(Format::Whitespace), ..Default::default() };
    assert_eq!(values(&text_with("p.npy", "1 2\n", &options).unwrap()), [1.0, 2.0]);
    assert_eq!("CSV".parse::<Format>().unwrap(), Format::Csv);
    assert_eq!("pq".parse::<Format>().unwrap(), Format::Parquet);
    assert!("yaml".parse::<Format>().unwrap_err().to_string().contains("the formats are csv, tsv"));
    for format in Format::all() {
        assert_eq!(format.to_string().parse::<Format>().unwrap(), format);
        for extension in format.extensions() {
            assert_eq!(extension.parse::<Format>().unwrap(), format);
        }
    }
}

#[test]
fn content_tells_what_the_name_does_not() {
    use std::io::Write;
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gz.write_all(b"1,2\n").unwrap();
    let packed = gz.finish().unwrap();
    let input = open_bytes(packed.clone(), "p.csv", &ReadOptions::default()).unwrap();
    assert_eq!(values(&input), [1.0, 2.0]);
    // Members that follow each other are one stream.
    let twice = [packed.clone(), packed].concat();
    assert_eq!(open_bytes(twice, "p.csv.GZ", &ReadOptions::default()).unwrap().source.len(), 2);
}
