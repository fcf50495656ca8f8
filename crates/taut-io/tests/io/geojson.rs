//! GeoJSON as points.

use super::{message, text, text_with, values};
use taut_io::{Feature, Format, ReadOptions};

const SQUARE: &str = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
const POINTS: [f64; 10] = [0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 0.0, 0.0];

fn polygon(rings: &str) -> String {
    format!("{{\"type\": \"Polygon\", \"coordinates\": [{rings}]}}")
}

fn feature(geometry: &str) -> String {
    format!(
        "{{\"geometry\": {geometry}, \"properties\": {{\"name\": \"a\\\"b\"}}, \"type\": \"Feature\"}}"
    )
}

fn collection(features: &[String]) -> String {
    let features = features.join(",\n");
    format!("{{\"type\": \"FeatureCollection\", \"crs\": null, \"features\": [{features}]}}")
}

#[test]
fn the_outer_ring_of_a_polygon_is_read() {
    let bare = polygon(SQUARE);
    let several = format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [[{SQUARE}]]}}");
    for document in [bare.clone(), feature(&bare), collection(&[feature(&bare)]), several] {
        let input = text("a.geojson", &document).unwrap();
        assert_eq!(
            (input.format, &input.columns[..]),
            (Format::GeoJson, &["x".into(), "y".into()][..])
        );
        assert_eq!(values(&input), POINTS, "{document}");
    }
}

#[test]
fn several_rings_have_a_column_with_their_number() {
    let hole = "[[1,1],[2,1],[2,2],[1,1]]";
    let with_hole = polygon(&format!("{SQUARE}, {hole}"));
    let parts = format!("{{\"type\": \"MultiPolygon\", \"coordinates\": [[{SQUARE}], [{hole}]]}}");
    let expected: Vec<f64> = POINTS
        .chunks_exact(2)
        .flat_map(|p| [p[0], p[1], 0.0])
        .chain([1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0])
        .collect();
    for document in [with_hole.clone(), feature(&with_hole), collection(&[feature(&parts)])] {
        let input = text("a.geojson", &document).unwrap();
        assert_eq!(&input.columns[..], ["x", "y", "ring"]);
        assert_eq!(values(&input), expected, "{document}");
    }
    let options = ReadOptions { columns: Some("ring,x".parse().unwrap()), ..Default::default() };
    let input = text_with("a.geojson", &with_hole, &options).unwrap();
    assert_eq!(values(&input)[8..12], [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn points_and_lines_are_read() {
    let document = format!("{{\"type\": \"LineString\", \"coordinates\": {SQUARE}}}");
    assert_eq!(values(&text("a.geojson", &document).unwrap()), POINTS);
    // With heights, which are left out.
    let document = "{\"coordinates\": [[1, 2, 3], [4, 5, 6]], \"type\": \"MultiPoint\"}";
    assert_eq!(values(&text("a.geojson", document).unwrap()), [1.0, 2.0, 4.0, 5.0]);
    let point = |x: u32| feature(&format!("{{\"type\": \"Point\", \"coordinates\": [{x}, 7]}}"));
    let document = collection(&[point(1), feature("null"), point(2)]);
    assert_eq!(values(&text("a.geojson", &document).unwrap()), [1.0, 7.0, 2.0, 7.0]);
    let options = ReadOptions { columns: Some("y".parse().unwrap()), ..Default::default() };
    let input = text_with("a.geojson", &polygon(SQUARE), &options).unwrap();
    assert_eq!(values(&input), [0.0, 0.0, 4.0, 4.0, 0.0]);
}

/// Two polygons with names, one of them twice, and points.
fn world() -> String {
    let named = |name: &str, x: u32| {
        let ring = format!("[[{x},0],[{x}.5,0],[{x},1]]");
        let geometry = polygon(&ring);
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"pop\": 3, \"NAME\": {name}}}, \"geometry\": {geometry}}}"
        )
    };
    let all =
        [("\"C\\u00f4te\"", 1), ("\"Kenya\"", 2), ("\"7\"", 3), ("\"Kenya\"", 4), ("null", 5)];
    collection(&all.map(|(name, x)| named(name, x)))
}

fn of_feature(text: &str) -> ReadOptions {
    ReadOptions { feature: Some(text.parse().unwrap()), ..Default::default() }
}

#[test]
fn one_feature_of_many_is_chosen_by_number_or_name() {
    for (feature, x) in [("0", 1.0), ("1", 2.0), ("4", 5.0), ("C\u{f4}te", 1.0)] {
        let input = text_with("world.geojson", &world(), &of_feature(feature)).unwrap();
        assert_eq!(values(&input), [x, 0.0, x + 0.5, 0.0, x, 1.0], "{feature}");
    }
    // Digits are a number, so that a name of digits is chosen by the library alone.
    let name = ReadOptions { feature: Some(Feature::Name("7".to_owned())), ..Default::default() };
    assert_eq!(values(&text_with("world.geojson", &world(), &name).unwrap())[0], 3.0);
    let bare = text_with("a.geojson", &polygon(SQUARE), &of_feature("0")).unwrap();
    assert_eq!(values(&bare), POINTS);
    for (feature, words) in [
        ("5", "there is no feature 5: it has 5, counted from 0"),
        ("18446744073709551615", "there is no feature 18446744073709551615"),
        ("Kenya", "feature 1 and feature 3 (from 0) both have the name \"Kenya\""),
        (
            "kenya",
            "no feature has the name \"kenya\"; there are [\"C\u{f4}te\", \"Kenya\", \"7\", \"Kenya\"]",
        ),
    ] {
        let said = message(text_with("world.geojson", &world(), &of_feature(feature)));
        assert!(said.contains(words) && said.contains("world.geojson"), "{said}");
    }
    let said = message(text("world.geojson", &world()));
    assert!(said.contains("choose one by its number or name with --select"), "{said}");
    let said = message(text_with("a.geojson", &polygon(SQUARE), &of_feature("a")));
    assert!(said.contains("no feature has a property `name`"), "{said}");
    let said = message(text_with("a.csv", "1,2\n", &of_feature("0")));
    assert!(
        said.contains("csv files have no features") && said.contains("geojson, svg, wkt"),
        "{said}"
    );
}

#[test]
fn what_is_not_supported_is_named() {
    for (document, words) in [
        (
            collection(&[feature(&polygon(SQUARE)), feature(&polygon(SQUARE))]),
            "feature 0 and feature 1 (from 0) are both geometries",
        ),
        (
            polygon(&format!("{SQUARE}, 7")),
            "ring 1 (from 0) of the Polygon of feature 0 (from 0) is no list",
        ),
        (polygon("[[0,0],[4,0],[4,\"x\"]]"), "position 2 (from 0) of the Polygon of feature 0"),
        (polygon("[[0,0],[4],[4,4]]"), "position 1 (from 0)"),
        (polygon("[[0,0],[4,0],[4,1e999]]"), "position 2 (from 0)"),
        (feature("{\"type\": \"GeometryCollection\"}"), "is a \"GeometryCollection\""),
        ("{\"type\": \"Polygon\"}".to_owned(), "has no `coordinates`"),
        ("{\"features\": []}".to_owned(), "the document has no `type`"),
        ("[1, 2]".to_owned(), "the document is no object"),
        (polygon(""), "holds no point"),
        (collection(&[]), "holds no point"),
    ] {
        let said = message(text("a.geojson", &document));
        assert!(said.contains(words) && said.contains("a.geojson"), "{said}");
    }
}

#[test]
fn a_file_that_is_cut_short_is_refused_at_every_length() {
    let document = collection(&[feature(&polygon(SQUARE))]);
    for length in 0..document.len() {
        assert!(text("a.geojson", &document[..length]).is_err(), "{length}");
    }
}
