//! Models of the thesis, if `TAUT_DATA` names a folder with them.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

use taut_inscribe::{DopsOptions, Error, triangle_rows};

use super::shapes::{Mesh, points, proved, solve};

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

/// Closes holes by triangles from the mean of all their corners to the edges that belong to an odd number of triangles.
fn capped(mut mesh: Mesh) -> Mesh {
    let mut odd: BTreeSet<[[u64; 3]; 2]> = BTreeSet::new();
    for &[a, b, c] in &mesh {
        for edge in [[a, b], [b, c], [c, a]] {
            let mut ends = edge.map(|end| end.map(|x| (x + 0.0).to_bits()));
            ends.sort_unstable();
            if ends[0] != ends[1] && !odd.remove(&ends) {
                odd.insert(ends);
            }
        }
    }
    while let Some(first) = odd.pop_first() {
        // The edges that hang together with the first.
        let mut hole = vec![first];
        let mut at = 0;
        while at < hole.len() {
            let ends = hole[at];
            let next: Vec<_> =
                odd.iter().filter(|e| e.iter().any(|p| ends.contains(p))).copied().collect();
            for edge in &next {
                odd.remove(edge);
            }
            hole.extend(next);
            at += 1;
        }
        let edges: Vec<_> = hole.iter().map(|edge| edge.map(|p| p.map(f64::from_bits))).collect();
        let corners = edges.as_flattened();
        let apex =
            [0, 1, 2].map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / corners.len() as f64);
        mesh.extend(edges.iter().map(|&[a, b]| [a, b, apex]));
    }
    mesh
}

#[test]
fn models_are_packed_and_proved() {
    // The models of the thesis with few events: what the checker proves does not depend on how many there are.
    for (name, count, least) in [
        ("beethoven", 15, 0.6),
        ("bunny_res2", 15, 0.6),
        ("horse", 10, 0.5),
        ("cow", 6, 0.5),
        ("rocker_arm", 6, 0.3),
        ("homer", 6, 0.5),
    ] {
        let Some(open) = model(name) else { return };
        let mesh = capped(open.clone());
        let options = DopsOptions { count, events: 20_000, ..DopsOptions::default() };
        let found = solve(&mesh, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        let verdict = found.check(&points(&mesh)).unwrap();
        let counters = &found.trace.counters;
        let share = counters["covered"] as f64 / counters["sample_points"] as f64;
        println!(
            "{name}: {} triangles and {} in holes, {} bodies cover {:.1} %, {} combined entries, {} bytes",
            open.len(),
            mesh.len() - open.len(),
            verdict.bodies,
            100.0 * share,
            found.trace.core_set,
            found.to_json().len()
        );
        assert!(share > least, "{name}: {share}");
    }
}

#[test]
fn open_models_are_refused_by_name_of_an_edge() {
    for name in ["beetle", "galleon"] {
        let Some(mesh) = model(name) else { return };
        match solve(&mesh, &DopsOptions::default()) {
            Err(Error::Open { edges, .. }) => println!("{name}: {edges} edges on the boundary"),
            other => panic!("{name}: {:?}", other.map(|found| found.answer.bodies.len())),
        }
    }
    if let Some(mesh) = model("cow") {
        let options = DopsOptions { events: 2000, ..DopsOptions::default() };
        println!("cow: {:?}", proved(&mesh, &options).1);
    }
}
