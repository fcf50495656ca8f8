//! The front of the thesis on public samples, where the folder `TAUT_DATA` holds them under `surface/`.

use std::io::Read;
use std::path::PathBuf;

use taut_mesh::{TriangleMesh, self_intersections, topology};
use taut_points::{Monitor, Points};
use taut_reconstruct::thesis::{Extent, ThesisOptions, thesis_surface_of_points};

/// The vertices of an OFF file, if it is there.
fn vertices(test: &str, name: &str) -> Option<Vec<f64>> {
    let folder = std::env::var_os("TAUT_DATA").map(PathBuf::from).unwrap_or_default();
    let Ok(packed) = std::fs::read(folder.join("surface").join(name)) else {
        eprintln!("skipped: {test}, as TAUT_DATA does not hold {name}");
        return None;
    };
    let mut text = String::new();
    liblzma::read::XzDecoder::new(&packed[..]).read_to_string(&mut text).expect("an xz file");
    let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    assert!(lines.next().is_some_and(|line| line.starts_with("OFF")));
    let words = |line: &str| -> Vec<f64> {
        line.split_whitespace().take(3).map(|word| word.parse().expect("numbers")).collect()
    };
    let count = words(lines.next().expect("counts"))[0] as usize;
    Some(lines.take(count).flat_map(words).collect())
}

/// Returns the counts of a surface: components, loops, pinches, points left out, candidates.
fn measured(points: &[f64], extent: Extent) -> [usize; 5] {
    let points = Points::new(points, 3).expect("whole rows");
    let options = ThesisOptions { extent, ..Default::default() };
    let (space, surface) =
        thesis_surface_of_points(&points, &options, &Monitor::silent()).expect("spans space");
    let sites: Vec<[f64; 3]> = (0..space.site_count() as u32).map(|s| space.site(s)).collect();
    let triangles = surface.on_sites();
    let mesh = TriangleMesh::new(&sites, &triangles).expect("sites");
    let shape = topology(&mesh);
    assert_eq!((shape.non_manifold_edges, shape.inconsistent_edges), (0, 0));
    assert!(self_intersections(&mesh).is_embedded());
    let (loops, pinches) = (surface.boundary_loops, surface.pinches.len());
    let candidates = surface.counters.candidates as usize;
    [shape.components.len(), loops, pinches, surface.unused.len(), candidates]
}

/// An earlier program that read the thesis in the same way had 50 loops, 329 pinches, 3 points left out, and 84 thousand candidates.
#[test]
fn the_bunny_is_one_piece_with_holes() {
    let test = "the_bunny_is_one_piece_with_holes";
    let Some(points) = vertices(test, "stanford_bunny.off.xz") else { return };
    let [components, loops, pinches, unused, candidates] = measured(&points, Extent::Front);
    println!("bunny: {loops} loops, {pinches} pinches, {unused} unused, {candidates} candidates");
    assert_eq!((components, candidates), (1, 84_328));
    assert!((5..=80).contains(&loops) && pinches <= 330 && unused <= 10);
}

/// Two knots: one front finds one of them.
#[test]
fn linked_knots_need_a_restart() {
    let test = "linked_knots_need_a_restart";
    let Some(points) = vertices(test, "knot2.off.xz") else { return };
    let [components, _, _, unused, _] = measured(&points, Extent::Front);
    assert_eq!((components, unused), (1, 2880));
    let [components, loops, pinches, unused, _] = measured(&points, Extent::Restarts);
    println!("knots: {loops} loops, {pinches} pinches");
    assert_eq!((components, unused), (2, 0));
}
