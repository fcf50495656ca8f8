//! Models of the thesis, if `TAUT_DATA` names a folder with them.

use std::io::Read;
use std::path::Path;

use taut_inscribe::{
    BodiesOptions, BodyShape, Error, Objective, OcclusionOptions, occlusion, triangle_rows,
};

use super::shapes::{Mesh, points, solve};
use crate::common::Random;
use crate::test_length::long_or;

/// The triangles of an OFF file.
fn model(name: &str) -> Option<Mesh> {
    let Some(folder) = std::env::var_os("TAUT_DATA") else {
        eprintln!("TAUT_DATA is not set: {name} is left out");
        return None;
    };
    let path = Path::new(&folder).join("inscribe").join(format!("{name}.off.xz"));
    let Ok(file) = std::fs::File::open(&path) else {
        eprintln!("{} is not there: left out", path.display());
        return None;
    };
    let mut text = String::new();
    liblzma::read::XzDecoder::new(file).read_to_string(&mut text).unwrap();
    let mut words = text.split_ascii_whitespace().skip(1);
    let mut counts = || words.next().unwrap().parse::<usize>().unwrap();
    let (vertices, faces, _) = (counts(), counts(), counts());
    let mut number = || words.next().unwrap().parse::<f64>().unwrap();
    let vertices: Vec<[f64; 3]> = (0..vertices).map(|_| [0; 3].map(|_: i32| number())).collect();
    let mut triangles = vec![];
    for _ in 0..faces {
        let corners: Vec<u32> = (0..number() as usize).map(|_| number() as u32).collect();
        triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
    }
    let rows = triangle_rows(&vertices, &triangles).unwrap();
    Some(rows.as_chunks::<3>().0.as_chunks::<3>().0.to_vec())
}

/// Models, numbers of bodies, and parts of the inside that free bodies cover at least.
const PACKED: [(&str, usize, f64); 5] = [
    ("beethoven", 15, 0.88),
    ("porsche", 10, 0.78),
    ("bunny_res2", 45, 0.93),
    ("horse", 10, 0.82),
    ("chinese_dragon_10k", 17, 0.80),
];

/// All models: closed, inverted, with holes, of several parts, without consistent orientation.
const ALL: [&str; 13] = [
    "beethoven",
    "beetle",
    "bunny_res2",
    "chinese_dragon_10k",
    "cow",
    "f16",
    "fandisk",
    "galleon",
    "homer",
    "horse",
    "porsche",
    "rocker_arm",
    "turbine",
];

/// The part of the points that the search did not see that bodies cover, and what else there is to say.
fn packed(name: &str, mesh: &Mesh, options: &BodiesOptions<'_>) -> f64 {
    let clock = std::time::Instant::now();
    let found = solve(mesh, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let solved = clock.elapsed();
    let verdict = found.check(&points(mesh)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let checked = clock.elapsed() - solved;
    let counters = &found.trace.counters;
    let part = counters["covered"] as f64 / counters["sample_points"] as f64;
    println!(
        "{name} {:?}: {} triangles, {} caps, {} of {} bodies with {} facets cover {:.1} % ({:.1} % searched), {} events, {} combined, {} bytes, solved in {:.2} s, checked in {:.2} s",
        options.shape,
        mesh.len(),
        verdict.caps,
        verdict.bodies,
        counters["searched_bodies"],
        counters["facets"],
        100.0 * part,
        100.0 * counters["searched_covered"] as f64 / counters["searched_points"] as f64,
        counters["events"],
        found.trace.core_set,
        found.to_json().len(),
        solved.as_secs_f64(),
        checked.as_secs_f64(),
    );
    part
}

/// The events of a search: all in a build for speed, else few, as what the checker proves does not depend on how many there are.
fn events(all: u64) -> u64 {
    if cfg!(debug_assertions) { all / 10 } else { all }
}

#[test]
fn free_bodies_cover_what_the_documentation_says() {
    for (name, count, least) in PACKED.into_iter().step_by(long_or(1, 2)) {
        let Some(mesh) = model(name) else { return };
        let base = BodiesOptions { close_holes: true, count, ..BodiesOptions::default() };
        let part = packed(name, &mesh, &BodiesOptions { events: events(base.events), ..base });
        let slack = if cfg!(debug_assertions) { 0.15 } else { 0.0 };
        assert!(part >= least - slack, "{name}: {part}");
    }
}

#[test]
fn k_dops_cover_what_the_documentation_says() {
    let covered = [
        ("beethoven", 15, [0.78, 0.69]),
        ("porsche", 10, [0.78, 0.71]),
        ("bunny_res2", 45, [0.86, 0.76]),
        ("horse", 10, [0.67, 0.57]),
    ];
    for (name, count, [overlapping, disjoint]) in
        covered.into_iter().skip(long_or(0, 1)).take(long_or(usize::MAX, 1))
    {
        let Some(mesh) = model(name) else { return };
        for (is_disjoint, least) in [(false, overlapping), (true, disjoint)] {
            let options = BodiesOptions {
                shape: BodyShape::Dop(18),
                close_holes: true,
                count,
                disjoint: is_disjoint,
                ..BodiesOptions::default()
            };
            let part =
                packed(name, &mesh, &BodiesOptions { events: events(options.events), ..options });
            // A tenth of the events leaves many bodies of a large count where they began.
            let slack = if cfg!(debug_assertions) { 0.25 } else { 0.0 };
            assert!(part >= least - slack, "{name}: {part}");
        }
    }
}

#[test]
fn few_free_facets_are_worth_more_than_fixed_ones() {
    let Some(mesh) = model("bunny_res2") else { return };
    let base = BodiesOptions { close_holes: true, count: 15, ..BodiesOptions::default() };
    let base = BodiesOptions { events: events(base.events), ..base };
    let with = |shape| packed("bunny_res2", &mesh, &BodiesOptions { shape, ..base.clone() });
    let [dop, few, many] = [BodyShape::Dop(26), BodyShape::Free(26), BodyShape::Free(40)].map(with);
    assert!(dop < few && few < many, "{dop} {few} {many}");
}

#[test]
fn bodies_of_models_are_proved_inside() {
    let (mut packed_models, mut tried) = (0, 0);
    for name in ALL.into_iter().step_by(long_or(1, 4)) {
        let Some(mesh) = model(name) else { return };
        for shape in [BodyShape::Dop(18), BodyShape::Free(256)] {
            let options = BodiesOptions {
                shape,
                close_holes: true,
                count: 6,
                events: long_or(10_000, 3000),
                ..BodiesOptions::default()
            };
            tried += 1;
            match solve(&mesh, &options) {
                Err(Error::Ambiguous) => println!("{name}: ambiguous"),
                _ => {
                    packed_models += u32::from(packed(name, &mesh, &options) > 0.2);
                }
            }
        }
    }
    assert!(26 * packed_models >= 22 * tried, "{packed_models} of {tried} packed");
}

#[test]
fn no_body_of_an_open_model_is_outside_by_its_winding_number() {
    for name in ["bunny_res2", "galleon", "beetle"] {
        let Some(mesh) = model(name) else { return };
        let options = BodiesOptions {
            close_holes: true,
            count: 10,
            events: 10_000,
            ..BodiesOptions::default()
        };
        let Ok(found) = solve(&mesh, &options) else { continue };
        for (at, proof) in found.certificate.proofs.iter().enumerate() {
            let unit = 2f64.powi(found.answer.exponent);
            let p = [0, 1, 2].map(|c| (found.answer.origin[c] + proof.inside[c]) as f64 * unit);
            // The mesh without its caps goes around the point by more than a half.
            let turns = winding_number(&mesh, p);
            println!("{name}, body {at}: winding number {turns:.3}");
            assert!(turns.abs() > 0.5, "{name}, body {at}: {turns}");
        }
    }
}

/// A rotation by a random unit quaternion.
fn rotation(random: &mut Random) -> [[f64; 3]; 3] {
    let [w, x, y, z] = loop {
        let q = [(); 4].map(|()| 2.0 * random.unit() - 1.0);
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (0.1..=1.0).contains(&length) {
            break q.map(|x| x / length);
        }
    };
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Each model as it is turned at random: all bodies are proved, and the points that prove them inside have an odd number of windings
/// where the mesh is closed, and more than a half of one where it is open, by a sum of solid angles that shares nothing with the
/// checker.
#[test]
fn no_body_of_a_turned_model_is_outside() {
    let rotations = long_or(20, 1);
    let mut random = Random(28);
    let (mut judged, mut ambiguous, mut tried) = (0, 0, 0);
    for name in ALL.into_iter().skip(long_or(0, 2)).step_by(long_or(1, 4)) {
        let Some(mesh) = model(name) else { return };
        for turn in 0..rotations {
            let rows = rotation(&mut random);
            let place = |p: [f64; 3]| rows.map(|u| u[0] * p[0] + u[1] * p[1] + u[2] * p[2]);
            let turned: Mesh = mesh.iter().map(|t| t.map(place)).collect();
            let is_closed =
                solve(&turned, &BodiesOptions { events: 1, ..Default::default() }).is_ok();
            for shape in [BodyShape::Dop(18), BodyShape::Free(256)] {
                tried += 1;
                let base =
                    BodiesOptions { shape, close_holes: true, count: 6, ..Default::default() };
                let found = match solve(&turned, &BodiesOptions { events: 3000, ..base }) {
                    Err(Error::Ambiguous) => {
                        ambiguous += 1;
                        continue;
                    }
                    found => found.unwrap_or_else(|error| panic!("{name}: {error}")),
                };
                let verdict = found.check(&points(&turned));
                verdict.unwrap_or_else(|error| panic!("{name}, rotation {turn}: {error}"));
                for (at, proof) in found.certificate.proofs.iter().enumerate() {
                    let unit = 2f64.powi(found.answer.exponent);
                    let p =
                        [0, 1, 2].map(|c| (found.answer.origin[c] + proof.inside[c]) as f64 * unit);
                    let turns = winding_number(&turned, p);
                    let is_in =
                        if is_closed { turns.round() as i64 % 2 != 0 } else { turns.abs() > 0.5 };
                    assert!(is_in, "{name}, rotation {turn}, {shape:?}, body {at}: {turns}");
                    judged += 1;
                }
            }
        }
    }
    println!("{judged} bodies, {ambiguous} of {tried} shapes ambiguous");
    assert!(26 * judged >= 24 * 4 * tried, "{judged} bodies of {tried} shapes");
}

/// How often a mesh goes around a point: the sum of its solid angles over 4π.
fn winding_number(mesh: &Mesh, p: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let of_triangle = |t: &[[f64; 3]; 3]| {
        let [a, b, c] = t.map(|q| [q[0] - p[0], q[1] - p[1], q[2] - p[2]]);
        let [x, y, z] = [a, b, c].map(|q| dot(q, q).sqrt());
        let cross =
            [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        let below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
        2.0 * dot(a, cross).atan2(below)
    };
    mesh.iter().map(of_triangle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[test]
fn open_models_are_refused_by_name_of_an_edge() {
    for name in ["beetle", "galleon"] {
        let Some(mesh) = model(name) else { return };
        match solve(&mesh, &BodiesOptions::default()) {
            Err(Error::Open { edges, .. }) => println!("{name}: {edges} edges on the boundary"),
            other => panic!("{name}: {:?}", other.map(|found| found.answer.bodies.len())),
        }
    }
}

#[test]
fn ten_dops_hide_more_where_that_is_the_objective() {
    let mut better = 0;
    let shares = [("beethoven", 0.86), ("porsche", 0.79), ("bunny_res2", 0.78)];
    let shares = &shares[..long_or(shares.len(), 2)];
    for &(name, least) in shares {
        let Some(mesh) = model(name) else { return };
        let hidden = |objective| {
            let base = BodiesOptions { close_holes: true, count: 10, ..BodiesOptions::default() };
            let (shape, events) = (BodyShape::Dop(18), events(base.events));
            let found = solve(&mesh, &BodiesOptions { shape, objective, events, ..base }).unwrap();
            found.check(&points(&mesh)).unwrap();
            let options =
                OcclusionOptions { lines: long_or(300_000, 60_000), ..OcclusionOptions::default() };
            occlusion(&points(&mesh), &found.answer, &options).unwrap().share
        };
        let [by_volume, by_lines] = [Objective::Volume, Objective::Occlusion].map(hidden);
        println!(
            "{name}: {:.2} % by volume, {:.2} % by lines",
            100.0 * by_volume,
            100.0 * by_lines
        );
        let slack = if cfg!(debug_assertions) { 0.1 } else { 0.0 };
        assert!(by_lines >= least - slack, "{name}: {by_lines}");
        better += usize::from(by_lines > by_volume);
    }
    assert!(3 * better >= 2 * shares.len(), "{better} of {}", shares.len());
}
