//! Well-known text as points.

use super::{message, text, text_with, values};
use taut_io::{Format, ReadOptions};

const SQUARE: &str = "(0 0, 4 0, 4 4, 0 4, 0 0)";
const HOLE: &str = "(1 1,2 1,2 2,1 1)";
const POINTS: [f64; 10] = [0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 0.0, 0.0];

fn of_feature(text: &str) -> ReadOptions {
    ReadOptions { feature: Some(text.parse().unwrap()), ..Default::default() }
}

#[test]
fn positions_of_every_kind_are_read() {
    for document in [
        format!("POLYGON ({SQUARE})"),
        format!("polygon({SQUARE})\n"),
        format!("\u{feff}  LineString  {SQUARE}"),
        format!("SRID=4326;MULTIPOLYGON(({SQUARE}))"),
        "MULTIPOINT (0 0, 4 0, 4 4, 0 4, 0 0)".to_owned(),
        "MULTIPOINT ((0 0), (4 0), ( 4 4 ),(0 4),(0 0))".to_owned(),
        "POINT(0 0) POINT (4 0)\nPOINT(4 4)\nPOINT EMPTY POINT(0 4) POINT(0 0)".to_owned(),
        "LINESTRING Z (0 0 9, 4 0 9, 4 4 -1e3, 0 4 9, 0 0 .5)".to_owned(),
        "LINESTRINGZM (0 0 9 1, 4 0 9 1, 4. 4 9 1, 0 +4e0 9 1, -0 0 9 1)".to_owned(),
    ] {
        let input = text("a.wkt", &document).unwrap();
        assert_eq!(
            (input.format, &input.columns[..]),
            (Format::Wkt, &["x".into(), "y".into()][..])
        );
        assert_eq!(values(&input), POINTS, "{document}");
    }
}

#[test]
fn several_rings_have_a_column_with_their_number() {
    let expected: Vec<f64> = POINTS
        .chunks_exact(2)
        .flat_map(|p| [p[0], p[1], 0.0])
        .chain([1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0])
        .collect();
    for document in
        [format!("POLYGON({SQUARE},{HOLE})"), format!("MULTIPOLYGON(({SQUARE}),\n({HOLE}))")]
    {
        let input = text("a.wkt", &document).unwrap();
        assert_eq!(&input.columns[..], ["x", "y", "ring"]);
        assert_eq!(values(&input), expected, "{document}");
        let options =
            ReadOptions { columns: Some("ring,x".parse().unwrap()), ..Default::default() };
        let input = text_with("a.wkt", &document, &options).unwrap();
        assert_eq!(values(&input)[8..12], [0.0, 0.0, 1.0, 1.0]);
    }
}

#[test]
fn one_geometry_of_many_is_chosen() {
    let document = format!("POLYGON({HOLE})\nPOLYGON({SQUARE})\nPOINT(7 8)\nPOINT(9 9)");
    assert_eq!(values(&text_with("a.wkt", &document, &of_feature("1")).unwrap()), POINTS);
    assert_eq!(values(&text_with("a.wkt", &document, &of_feature("2")).unwrap()), [7.0, 8.0]);
    for (feature, words) in [
        ("4", "there is no geometry 4: it has 4, counted from 0"),
        ("Kenya", "but no names such as \"Kenya\""),
    ] {
        let said = message(text_with("a.wkt", &document, &of_feature(feature)));
        assert!(said.contains(words) && said.contains("a.wkt"), "{said}");
    }
}

#[test]
fn what_is_refused_is_named_by_line_and_byte() {
    for (document, words) in [
        (
            &*format!("POLYGON({SQUARE})\n POLYGON({HOLE})"),
            "a.wkt: geometry 0 and geometry 1 (from 0) are both there",
        ),
        (
            "POLYGON((1 2,\n3 4  \n\n",
            "line 2: byte 4 of the line: the text ends early: expected a comma",
        ),
        ("POINT(1 2)\nLINESTRING(1 2,3 4)", "geometry 0 and geometry 1 (from 0) are both there"),
        ("GEOMETRYCOLLECTION(POINT(1 2))", "\"GEOMETRYCOLLECTION\" is not read"),
        ("MULTILINESTRING((1 2,3 4))", "\"MULTILINESTRING\" is not read"),
        (
            "POLYGON((1 2,\n3 x,4 5))",
            "line 2: byte 3 of the line: expected a position of at least 2",
        ),
        ("POLYGON((1 2,3))", "line 1: byte 15 of the line: expected a position of at least 2"),
        ("POINT(1 2 3 4 5)", "more than 4 numbers"),
        ("POINT(1 2, 3 4)", "expected a closing parenthesis after one position"),
        ("POINT(1 1e999)", "the number is not finite"),
        ("POINT(1 1e-999)", "too small for double precision"),
        ("POINT(1 2x)", "expected a blank, a comma or a parenthesis"),
        ("POINT(1 -)", "this is no number"),
        ("POINT Q(1 2)", "expected an opening parenthesis or EMPTY"),
        ("POLYGON(EMPTY)", "expected an opening parenthesis"),
        ("SRID=4326 POINT(1 2)", "expected a semicolon"),
        ("1 2", "expected the name of a geometry"),
        ("POLYGON EMPTY", "holds no point"),
        ("  \n", "holds no point"),
    ] {
        let said = message(text("a.wkt", document));
        assert!(said.contains(words) && said.contains("a.wkt"), "{document}: {said}");
    }
}

#[test]
fn a_text_that_is_cut_short_is_refused_at_every_length() {
    let document = format!("POLYGON({SQUARE},{HOLE})");
    for length in 1..document.len() {
        assert!(text("a.wkt", &document[..length]).is_err(), "{length}");
    }
}

#[test]
fn little_memory_refuses_a_large_text_and_not_its_points() {
    let document = format!("MULTIPOINT({}0 0)", "1 2,".repeat(300_000));
    let tight = |memory| ReadOptions { memory: Some(memory), ..Default::default() };
    let said = message(text_with("a.wkt", &document, &tight(1 << 20)));
    assert!(
        said.contains("a text of WKT") && said.contains("write the positions as csv"),
        "{said}"
    );
    // The points take three times as much as the text, and more than is allowed: they are read from disk.
    let input = text_with("a.wkt", &document, &tight(25 << 17)).unwrap();
    assert_eq!(input.source.len(), 300_001);
    assert_eq!(values(&input)[..4], [1.0, 2.0, 1.0, 2.0]);
}
