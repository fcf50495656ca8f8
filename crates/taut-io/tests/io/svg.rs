//! Paths of SVG as points.

use super::{message, text, text_with, values};
use taut_io::{Format, Polyline, ReadOptions, write_polylines};

fn document(inner: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<!DOCTYPE svg [<!ENTITY a \"<path d='M9 9'/>\">]>\n<!-- <path d=\"M8 8\"/> -->\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" viewBox='0 0 4 4'>\n{inner}\n</svg>\n"
    )
}

fn path(data: &str) -> String {
    document(&format!("<path id=\"a\" d=\"{data}\"/>"))
}

fn read(data: &str) -> Vec<f64> {
    let input = text("a.svg", &path(data)).unwrap_or_else(|error| panic!("{data}: {error}"));
    assert_eq!(input.format, Format::Svg);
    values(&input)
}

fn of_feature(text: &str) -> ReadOptions {
    ReadOptions { feature: Some(text.parse().unwrap()), ..Default::default() }
}

#[test]
fn lines_are_read_however_they_are_written() {
    let triangle = [1.0, 2.0, 4.0, 2.0, 4.0, -6.0];
    for data in [
        "M1 2L4 2L4-6Z",
        "M1,2 L4,2 L 4 , -6 z",
        "M 1 2 4 2 4 -6",
        "m1 2 3 0 0-8z",
        "M1 2h3v-8",
        "\n M1e0\t2 H4 V-6Z ",
        "M.1e1+2.H4V-.6e1",
    ] {
        assert_eq!(read(data), triangle, "{data}");
    }
    assert_eq!(read("M0 0h.5.5"), [0.0, 0.0, 0.5, 0.0, 1.0, 0.0]);
}

#[test]
fn subpaths_are_rings() {
    let rings = [0., 0., 0., 4., 0., 0., 4., 4., 0., 1., 1., 1., 2., 1., 1., 2., 2., 1.];
    for data in
        ["M0 0H4V4ZM1 1H2V2Z", "M0 0H4V4zm1 1h1v1", "M7 7M0 0H4V4M1 1H2V2M9 9", "M0 0h4v4M1 1h1v1z"]
    {
        let input = text("a.svg", &path(data)).unwrap();
        assert_eq!(&input.columns[..], ["x", "y", "ring"]);
        assert_eq!(values(&input), rings, "{data}");
    }
    // After Z the next subpath begins where the last one did; a point alone shows where its subpath is closed.
    assert_eq!(read("M1 1H2V2ZL5 5")[9..], [1., 1., 1., 5., 5., 1.]);
    assert_eq!(read("M3 4Z"), [3., 4.]);
    assert!(message(text("a.svg", &path("M3 4"))).contains("holds no point"));
}

#[test]
fn curves_become_chords_that_end_where_the_curves_do() {
    let circle = read("M2 0A2 2 0 0 1-2 0A2 2 0 0 1 2 0Z");
    assert!(circle.len() > 200 && circle.len() < 1000, "{}", circle.len());
    for p in circle.chunks_exact(2) {
        assert!((p[0].hypot(p[1]) - 2.0).abs() < 1e-14, "{p:?}");
    }
    // Flags without blanks, and relative.
    assert_eq!(read("M2 0a2 2 0 01-4 0a2,2,0,0,1,4,0z"), circle);
    let area = |ring: &[f64]| {
        let n = ring.len() / 2;
        (0..n)
            .map(|k| {
                let (a, b) = (2 * k, 2 * ((k + 1) % n));
                (ring[a] * ring[b + 1] - ring[b] * ring[a + 1]) / 2.0
            })
            .sum::<f64>()
    };
    assert!((area(&circle) / (4.0 * std::f64::consts::PI) - 1.0).abs() < 2e-4);
    // A parabola as a quadratic and as a cubic curve; its area with the chord is two thirds of the box.
    for data in [
        "M0 0Q1 2 2 0",
        "M0 0C.6666666666666666 1.3333333333333333 1.3333333333333333 1.3333333333333333 2 0",
    ] {
        let parabola = read(data);
        assert_eq!(parabola[parabola.len() - 2..], [2.0, 0.0]);
        assert!((area(&parabola) + 4.0 / 3.0).abs() < 1e-3, "{data}");
    }
    // S and T mirror the last control point, if the command before has one.
    assert_eq!(read("M0 0Q1 2 2 0T4 0"), read("M0 0q1 2 2 0 1-2 2 0"));
    assert_eq!(read("M0 0C0 1 1 1 1 0S2-1 2 0"), read("M0 0c0 1 1 1 1 0 0-1 1-1 1 0"));
    // Without such a point the curve is the line, if not at one speed.
    let line = read("M0 0H1T3 0");
    assert!(line.ends_with(&[3.0, 0.0]) && line.chunks_exact(2).all(|p| p[1] == 0.0), "{line:?}");
    assert_eq!(read("M0 0A0 5 0 0 1 3 4"), [0., 0., 3., 4.]);
}

#[test]
fn one_path_of_many_is_chosen_by_number_or_id() {
    let inner = "<defs><path d='M7 7H9'/></defs><g><path id=\"one\" d='M1 1H2V2'/></g>\n\
        <g transform=\"rotate(3)\"><path id='two' d='M3 3H4V4'/></g><rect width='1'/><svg:path d='M5 5H6'/>\
        <style><![CDATA[ a > b ]]></style>";
    let of = |feature| text_with("a.svg", &document(inner), &of_feature(feature));
    for feature in ["0", "one"] {
        assert_eq!(values(&of(feature).unwrap()), [1., 1., 2., 1., 2., 2.]);
    }
    assert_eq!(values(&of("2").unwrap()), [5., 5., 6., 5.]);
    for (feature, words) in [
        ("two", "line 6: byte 15 of the line: the path is under a `transform`"),
        ("3", "there is no path 3: it has 3, counted from 0"),
        ("three", "no path has the `id` \"three\""),
    ] {
        let said = message(of(feature));
        assert!(said.contains(words) && said.contains("a.svg"), "{said}");
    }
    let said = message(text("a.svg", &document(inner)));
    assert!(said.contains("path 0 and path 1 (from 0) are both there"), "{said}");
}

#[test]
fn what_is_refused_is_named_by_line_and_byte() {
    for (inner, words) in [
        ("<rect/>", "there is no path in it"),
        ("<path/>", "there is no path in it"),
        ("<path d='L1 2'/>", "line 5: byte 10 of the line: a path begins with M"),
        ("<path d='M1 2\nL3 x'/>", "line 6: byte 4 of the line: expected a number"),
        ("<path d='M1 2B3 4'/>", "line 5: byte 14 of the line: 'B' is no command of a path"),
        ("<path d='M1 2L3'/>", "line 5: byte 16 of the line: expected a number"),
        ("<path d='M1 2#'/>", "expected a command"),
        ("<path d='M1 1e999'/>", "the number is not finite"),
        ("<path d='M1e308 1l1e308 1'/>", "beyond the range of double precision"),
        ("<path d='M1 1A1 1 0 2 1 3 4'/>", "expected a flag of an arc"),
        ("<path d='M1 1&#32;L2 2'/>", "expected a command"),
        ("<path d=M/>", "expected a value between quotes"),
        ("<path d='M1 1", "a value does not end"),
        ("</g></svg></svg>", "the end of an element that is not open"),
        ("<!-- ", "a comment does not end"),
        ("<path transform='scale(2)' d='M1 1H2'/>", "under a `transform`"),
    ] {
        let said = message(text("a.svg", &document(inner)));
        assert!(said.contains(words) && said.contains("a.svg"), "{inner}: {said}");
    }
}

#[test]
fn curves_that_taut_wrote_are_read_back() {
    let folder = std::env::temp_dir().join(format!("taut-svg-{}.svg", std::process::id()));
    let outer = [[0.0, 0.1], [4.0, 1e-7], [4.0, 4.0]];
    let inner = [[3.0, 1.0], [3.5, 1.0], [3.5, 2.0]];
    let curves = [&outer, &inner].map(|vertices| Polyline { vertices, closed: true });
    write_polylines(&curves, &folder, None).unwrap();
    let input = taut_io::open(&folder, &ReadOptions::default());
    std::fs::remove_file(&folder).unwrap();
    let expected: Vec<f64> = (0..2)
        .flat_map(|ring| curves[ring].vertices.iter().flat_map(move |&[x, y]| [x, y, ring as f64]))
        .collect();
    assert_eq!(values(&input.unwrap()), expected);
}

#[test]
fn a_document_that_is_cut_within_its_path_is_refused() {
    let whole = path("M0 0L4 0L4 4Z");
    let end = whole.find("/>\n</svg").unwrap();
    for length in whole.find("<svg").unwrap()..end {
        assert!(text("a.svg", &whole[..length]).is_err(), "{length}");
    }
}
