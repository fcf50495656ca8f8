//! Outlines of countries, if `TAUT_DATA` names a folder with them.

use std::io::Read;
use std::path::Path;

use super::common::{Ring, solve, verify};
use super::ellipses::{solve as solve_ellipse, verified};
use super::triangles;
use taut_inscribe::{
    ConvexOptions, EllipseMethod, EllipseOptions, EllipseThesisOptions, Error,
    OrientedRectangleOptions, RectangleOptions, TriangleMethod, TriangleOptions,
    TriangleThesisOptions, inscribed_ellipse, inscribed_oriented_rectangle, inscribed_polygon,
    inscribed_rectangle, inscribed_triangle,
};
use taut_points::Points;

use crate::test_length::long_or;

/// The rings of a file: countries by name, each a list of rings.
pub(crate) fn rings(name: &str) -> Option<Vec<(String, Ring)>> {
    let Some(folder) = std::env::var_os("TAUT_DATA") else {
        eprintln!("TAUT_DATA is not set: {name} is left out");
        return None;
    };
    let path = Path::new(&folder).join("inscribe").join(name);
    let Ok(file) = std::fs::File::open(&path) else {
        eprintln!("{} is not there: left out", path.display());
        return None;
    };
    let mut text = String::new();
    liblzma::read::XzDecoder::new(file).read_to_string(&mut text).unwrap();
    let all: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut found = vec![];
    collect(&all, "", &mut found);
    Some(found)
}

/// Lists of points at any depth, each under the name of what holds it.
fn collect(value: &serde_json::Value, name: &str, found: &mut Vec<(String, Ring)>) {
    let point = |value: &serde_json::Value| {
        let pair = value.as_array().filter(|pair| pair.len() == 2)?;
        Some([pair[0].as_f64()?, pair[1].as_f64()?])
    };
    match value {
        serde_json::Value::Object(fields) => {
            fields.iter().for_each(|(key, value)| collect(value, key, found));
        }
        serde_json::Value::Array(items) => {
            match items.iter().map(point).collect::<Option<Ring>>() {
                Some(ring) if ring.len() > 2 => found.push((name.to_owned(), ring)),
                _ => items.iter().for_each(|value| collect(value, name, found)),
            }
        }
        _ => {}
    }
}

/// Rings of more vertices are left to the long tests where each takes seconds.
const SHORT_RING_MAX: usize = 1000;

#[test]
fn countries_have_a_proved_circle() {
    for file in ["countries_110m.json.xz", "countries_10m.json.xz"] {
        let Some(rings) = rings(file) else { return };
        assert!(rings.len() > 5, "{file}: {} rings", rings.len());
        let (mut solved, mut refused) = (0, 0);
        for (name, ring) in rings {
            let begun = std::time::Instant::now();
            let found = match solve(&ring) {
                Ok(found) => found,
                Err(Error::NotSimple { .. }) => {
                    refused += 1;
                    continue;
                }
                Err(error) => panic!("{name}: {error}"),
            };
            solved += 1;
            let seconds = begun.elapsed().as_secs_f64();
            let (verdict, json) = (verify(&found, &ring), found.to_json().len());
            assert!(verdict.gap <= 1.01e-9, "{name}: {verdict:?}");
            assert!(json < 200_000, "{name}: {json} bytes");
            if ring.len() > 700 {
                let (vertices, radius) = (ring.len(), found.answer.radius);
                let cells = found.certificate.tree.len();
                println!(
                    "{name}: {vertices} vertices, radius {radius}, {cells} cells, {json} bytes, {seconds:.3} s"
                );
            }
        }
        println!("{file}: {solved} rings solved, {refused} are not simple");
        assert!(solved > 0);
    }
}

#[test]
fn countries_have_a_proved_ellipse() {
    for (file, gap) in [("countries_110m.json.xz", 1e-6), ("countries_10m.json.xz", 1e-3)] {
        let Some(rings) = rings(file) else { return };
        for (name, ring) in rings {
            if ring.len() > long_or(usize::MAX, SHORT_RING_MAX) {
                continue;
            }
            let rings = [ring];
            let begun = std::time::Instant::now();
            let found = match solve_ellipse(&rings, gap) {
                Ok(found) => found,
                Err(Error::NotSimple { .. }) => continue,
                Err(error) => panic!("{name}: {error}"),
            };
            let solved = begun.elapsed().as_secs_f64();
            let begun = std::time::Instant::now();
            let verdict = verified(&found, &rings);
            let checked = begun.elapsed().as_secs_f64();
            assert!(verdict.gap <= gap * (1.0 + 1e-8), "{name}: {verdict:?}");
            let (vertices, cells) = (rings[0].len(), found.certificate.tree.len());
            let (area, json) = (found.answer.area, found.to_json().len());
            println!(
                "{name}: {vertices} vertices, area {area:.6}, {cells} cells, {json} bytes, {solved:.3} s, check {checked:.3} s"
            );
            assert!(cells < 200_000, "{name}: {cells} cells");
        }
    }
}

/// Areas that triangles in the coarse outlines have at least, from a program of another kind.
const TRIANGLES: [(&str, f64); 6] = [
    ("France", 0.2324),
    ("Italy", 0.0947),
    ("Vietnam", 0.0320),
    ("Croatia", 0.0795),
    ("Switzerland", 0.1539),
    ("Kenya", 0.2731),
];

#[test]
fn countries_have_a_proved_triangle() {
    for (file, gap) in
        [("countries_110m.json.xz", 1e-3), ("countries_10m.json.xz", long_or(1e-2, 1e-1))]
    {
        let Some(rings) = rings(file) else { return };
        for (name, ring) in rings {
            if ring.len() > long_or(usize::MAX, SHORT_RING_MAX) {
                continue;
            }
            let rings = [ring];
            // Long winding coasts take too many cells for a test: they end with the gap that they reach.
            let is_large = rings[0].len() > 3500;
            let max_cells = if is_large { 1000 } else { 200_000 };
            let begun = std::time::Instant::now();
            let found = match triangles::solve_with(&rings, gap, max_cells) {
                Ok(found) => found,
                Err(Error::NotSimple { .. }) => continue,
                Err(error) => panic!("{name}: {error}"),
            };
            let solved = begun.elapsed().as_secs_f64();
            let begun = std::time::Instant::now();
            let verdict = triangles::verified(&found, &rings);
            let checked = begun.elapsed().as_secs_f64();
            let (vertices, cells) = (rings[0].len(), found.certificate.tree.len());
            let (area, json) = (found.answer.area, found.to_json().len());
            println!(
                "{name}: {vertices} vertices, area {area:.6}, gap {:.1e}, {cells} cells, {json} bytes, {solved:.3} s, check {checked:.3} s",
                verdict.gap
            );
            assert!(is_large || verdict.gap <= gap * (1.0 + 1e-8), "{name}: {verdict:?}");
            let known = TRIANGLES.iter().find(|known| file.contains("110m") && known.0 == name);
            assert!(known.is_none_or(|known| area >= known.1), "{name}: {area}");
        }
    }
}

#[test]
fn rings_that_touch_themselves_are_named() {
    let Some(rings) = rings("countries_10m_selftouching.json.xz") else { return };
    let mut refused = 0;
    for (name, ring) in rings {
        match solve(&ring) {
            Err(Error::NotSimple { edge, other }) => {
                println!("{name}: edges {edge:?} and {other:?} of {}", ring.len());
                refused += 1;
            }
            Ok(found) => drop(verify(&found, &ring)),
            Err(error) => panic!("{name}: {error}"),
        }
    }
    assert!(refused > 0);
}

#[test]
fn countries_have_a_proved_convex_polygon() {
    for file in ["countries_110m.json.xz", "countries_10m.json.xz"] {
        let Some(rings) = rings(file) else { return };
        for (name, ring) in rings {
            if ring.len() > long_or(usize::MAX, SHORT_RING_MAX) {
                continue;
            }
            let source = Points::new(ring.as_flattened(), 2).unwrap();
            let begun = std::time::Instant::now();
            let options = ConvexOptions { rounds: long_or(200, 10), ..Default::default() };
            let found = match inscribed_polygon(&source, &options) {
                Ok(found) => found,
                Err(Error::NotSimple { .. }) => continue,
                Err(error) => panic!("{name}: {error}"),
            };
            let solved = begun.elapsed().as_secs_f64();
            let verdict = found.check(&source).unwrap_or_else(|error| panic!("{name}: {error}"));
            let (vertices, corners) = (ring.len(), found.answer.vertices.len());
            let (area, gap) = (found.answer.area, verdict.gap);
            println!(
                "{name}: {vertices} vertices, area {area:.6}, {corners} corners, gap {gap:.3}, {solved:.3} s"
            );
            assert!(gap <= 0.671, "{name}: {gap}");
        }
    }
}

#[test]
fn countries_have_a_proved_rectangle() {
    for (file, epsilon) in [("countries_110m.json.xz", 1e-3), ("countries_10m.json.xz", 1e-2)] {
        let Some(rings) = rings(file) else { return };
        for (name, ring) in rings {
            if ring.len() > long_or(usize::MAX, SHORT_RING_MAX) {
                continue;
            }
            let source = Points::new(ring.as_flattened(), 2).unwrap();
            let begun = std::time::Instant::now();
            let options = RectangleOptions { epsilon, max_cells: 300_000, ..Default::default() };
            let found = match inscribed_rectangle(&source, &options) {
                Ok(found) => found,
                Err(Error::NotSimple { .. }) => continue,
                Err(error) => panic!("{name}: {error}"),
            };
            let solved = begun.elapsed().as_secs_f64();
            let verdict = found.check(&source).unwrap_or_else(|error| panic!("{name}: {error}"));
            let (vertices, cells) = (ring.len(), found.certificate.tree.len());
            let (area, gap) = (found.answer.area, verdict.gap);
            println!(
                "{name}: {vertices} vertices, area {area:.6}, {cells} cells, gap {gap:.2e}, {solved:.3} s"
            );
            assert!(gap <= 0.05, "{name}: {gap}");
        }
    }
}

#[test]
fn countries_have_a_proved_oriented_rectangle() {
    let Some(rings) = rings("countries_110m.json.xz") else { return };
    for (name, ring) in rings.into_iter().step_by(long_or(1, 3)) {
        let source = Points::new(ring.as_flattened(), 2).unwrap();
        let begun = std::time::Instant::now();
        let found = inscribed_oriented_rectangle(&source, &OrientedRectangleOptions::default());
        let found = found.unwrap_or_else(|error| panic!("{name}: {error}"));
        let solved = begun.elapsed().as_secs_f64();
        let begun = std::time::Instant::now();
        let verdict = found.check(&source).unwrap_or_else(|error| panic!("{name}: {error}"));
        let checked = begun.elapsed().as_secs_f64();
        let (vertices, cells) = (ring.len(), found.certificate.tree.len());
        let (area, json) = (found.answer.area, found.to_json().len());
        println!(
            "{name}: {vertices} vertices, area {area:.6}, {cells} cells, {json} bytes, {solved:.3} s, check {checked:.3} s"
        );
        assert!(verdict.gap <= 1e-3 * (1.0 + 1e-8), "{name}: {verdict:?}");
        let options = RectangleOptions { epsilon: 1e-2, ..Default::default() };
        let along_axes = inscribed_rectangle(&source, &options).unwrap().answer.area;
        assert!(area * (1.0 + 1e-3) >= along_axes, "{name}: {area} and {along_axes}");
    }
}

#[test]
fn countries_have_shapes_by_the_methods_of_the_thesis() {
    let Some(rings) = rings("countries_110m.json.xz") else { return };
    let mut shares = [vec![], vec![], vec![]];
    let count = long_or(rings.len(), 1);
    for (name, ring) in rings.into_iter().take(count) {
        let source = Points::new(ring.as_flattened(), 2).unwrap();
        let begun = std::time::Instant::now();
        let method = TriangleMethod::Thesis(TriangleThesisOptions::DEFAULT);
        let options = TriangleOptions { method, epsilon: 1e-2, ..Default::default() };
        let found = inscribed_triangle(&source, &options).unwrap();
        let verdict = found.check(&source).unwrap_or_else(|error| panic!("{name}: {error}"));
        shares[0].push(verdict.lower / verdict.upper);
        let mut line = format!("{name}: triangle {:.3}", verdict.lower / verdict.upper);
        // Long countries are thinner than a spacing of 200 samples.
        let thesis = EllipseThesisOptions { sample_count: 400, fatness: 0.5, ..Default::default() };
        for (place, method) in
            [(1, EllipseMethod::Thesis(thesis)), (2, EllipseMethod::FivePoint(thesis))]
        {
            let options = EllipseOptions { method, epsilon: 1e-2, ..Default::default() };
            match inscribed_ellipse(&source, &options) {
                Err(Error::NoneAmongSamples { .. }) => line += &format!(", {method} none"),
                Err(error) => panic!("{name}: {method}: {error}"),
                Ok(found) => {
                    let verdict =
                        found.check(&source).unwrap_or_else(|error| panic!("{name}: {error}"));
                    let share = verdict.lower / verdict.upper;
                    shares[place].push(share);
                    line += &format!(", {method} {share:.3}");
                }
            }
        }
        println!("{line} of the bound, {:.2} s", begun.elapsed().as_secs_f64());
    }
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    assert!(shares[0].len() == count && mean(&shares[0]) > 0.75, "{shares:?}");
    // Some countries are thinner than a spacing.
    let is_good = |list: &Vec<f64>| 3 * list.len() > 2 * count && mean(list) > 0.8;
    assert!(shares[1..].iter().all(is_good), "{shares:?}");
}
