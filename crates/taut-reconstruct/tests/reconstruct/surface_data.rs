//! Sets of points whose surface is known, where the folder `TAUT_DATA` holds them under `surface/`.

use std::io::Read;
use std::path::PathBuf;

use judge::{assert_exact, closed, found};
use taut_mesh::{SurfaceOptions as Sampling, TriangleMesh, compare_surfaces};
use taut_reconstruct::{SurfaceMethod, SurfaceMode, SurfaceOptions};

use crate::surface_any::judge;

type Point = [f64; 3];

/// The seven sets that count, with their components and handles.
const SEVEN: [(&str, usize, u64); 7] = [
    ("reconbench_anchor", 1, 4),
    ("reconbench_daratech", 1, 7),
    ("reconbench_dc", 1, 8),
    ("fandisk", 1, 0),
    ("horse", 1, 0),
    ("hoppe_mechpart", 1, 3),
    ("knot2", 2, 2),
];

/// The vertices and triangles of a mesh, if it is there.
fn mesh(test: &str, name: &str) -> Option<(Vec<Point>, Vec<[u32; 3]>)> {
    let folder = std::env::var_os("TAUT_DATA").map(PathBuf::from).unwrap_or_default();
    let Ok(packed) = std::fs::read(folder.join("surface").join(format!("{name}.off.xz"))) else {
        eprintln!("skipped: {test}, as TAUT_DATA does not hold {name}");
        return None;
    };
    let mut text = String::new();
    liblzma::read::XzDecoder::new(&packed[..]).read_to_string(&mut text).expect("an xz file");
    let mut words = text.split_whitespace().skip(1);
    let count: usize = words.next().and_then(|word| word.parse().ok()).expect("a count");
    words.by_ref().take(2).for_each(drop);
    let numbers: Vec<f64> =
        words.by_ref().take(3 * count).map(|word| word.parse().expect("numbers")).collect();
    let faces: Vec<u32> = words.map(|word| word.parse().expect("numbers")).collect();
    let vertices = numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    Some((vertices, faces.chunks_exact(4).map(|f| [f[1], f[2], f[3]]).collect()))
}

#[test]
fn the_seven_are_exact() {
    for (name, components, genus) in SEVEN.into_iter().step_by(crate::test_length::long_or(1, 2)) {
        let Some((points, _)) = mesh("the_seven_are_exact", name) else { return };
        assert_exact(&closed(&points), components, genus);
    }
}

#[test]
fn undersampled_and_open_ones_close() {
    for name in ["hoppe_blob5", "stanford_bunny"] {
        let Some((points, _)) = mesh("undersampled_and_open_ones_close", name) else { return };
        assert_exact(&closed(&points), 1, 0);
    }
}

#[test]
fn most_are_exact_at_seven_tenths_and_at_half() {
    let test = "most_are_exact_at_seven_tenths_and_at_half";
    for &(keep, least) in crate::test_length::long_or(&[(0.5, 4), (0.7, 5)][..], &[(0.5, 4)]) {
        let mut exact = 0;
        for (name, components, genus) in SEVEN {
            let Some((mut points, _)) = mesh(test, name) else { return };
            let mut state = 101u64;
            points.retain(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((state >> 11) as f64) < keep * (1u64 << 53) as f64
            });
            let found = closed(&points);
            let t = &found.topology;
            let is_exact = found.is_closed() && found.is_through_all();
            exact +=
                usize::from(is_exact && (t.components.len(), t.genus) == (components, Some(genus)));
        }
        assert!(exact >= least, "{exact} of 7 at {keep}");
    }
}

#[test]
fn the_bunny_keeps_its_holes() {
    let Some((points, triangles)) = mesh("the_bunny_keeps_its_holes", "stanford_bunny") else {
        return;
    };
    let found = found(
        &points,
        &SurfaceOptions { method: SurfaceMethod::Tree(SurfaceMode::Open), ..Default::default() },
    );
    let loops = found.topology.boundary_loops.len();
    assert!((2..=8).contains(&loops), "{loops} loops");
    let reference = TriangleMesh::new(&points, &triangles).expect("a mesh");
    let result = TriangleMesh::new(&points, &found.triangles).expect("a mesh");
    let quality = compare_surfaces(&reference, &result, &Sampling::default());
    assert!(quality.result_to_reference.hausdorff_relative <= 0.02);
    assert!(quality.reference_to_result.hausdorff_relative <= 0.01);
}
