//! Alpha complexes and Voronoi cells of folders of many tiles, and of one tile in memory, against those of the triangulation.

use std::collections::BTreeMap;

use taut_points::{Monitor, Points};

use super::super::{AlphaPart, Mosaic};
use super::sets::{plane, some, space};
use super::write_folder;
use crate::test_length::long_or;
use crate::{AlphaComplex, DelaunayOptions, Plane, Polygon, Polyhedron, Space, Triangulation};

/// Simplices, boundary and singular facets in rows, in any order.
type Parts = [Vec<Vec<u64>>; 3];

/// Rotates a simplex or facet to its smallest row; an odd permutation of what is left would be another orientation.
fn rotated(rows: &[u64]) -> Vec<u64> {
    let least = (0..rows.len()).min_by_key(|&i| rows[i]).unwrap();
    match rows.len() {
        2 => rows.to_vec(),
        4 => {
            // Even permutations only: sort, and exchange the first two if that was odd.
            let mut sorted = rows.to_vec();
            let mut odd = false;
            for i in 0..4 {
                for j in (i + 1..4).rev() {
                    if sorted[j - 1] > sorted[j] {
                        sorted.swap(j - 1, j);
                        odd = !odd;
                    }
                }
            }
            if odd {
                sorted.swap(2, 3);
            }
            sorted
        }
        width => (0..width).map(|i| rows[(least + i) % width]).collect(),
    }
}

fn sorted(mut parts: Parts) -> Parts {
    parts.iter_mut().for_each(|part| part.sort());
    parts
}

fn of_complex<const D: usize, const V: usize>(
    of: &Triangulation<D, V>,
    complex: &AlphaComplex<D>,
) -> Parts {
    let rows =
        |sites: &[u32]| rotated(&sites.iter().map(|&v| of.row(v).into()).collect::<Vec<u64>>());
    sorted([
        complex.simplices.iter().map(|&t| rows(&of.vertices(t))).collect(),
        complex.boundary.iter().map(|facet| rows(facet)).collect(),
        complex
            .singular
            .iter()
            .map(|facet| {
                // Neither side is the outer one.
                let mut rows = rows(facet);
                rows.sort_unstable();
                rows
            })
            .collect(),
    ])
}

macro_rules! collected {
    ($mosaic:expr, $alpha:expr) => {{
        let mut parts = Parts::default();
        let put = &mut |part: AlphaPart<'_>| {
            match part {
                AlphaPart::Simplex(rows) => parts[0].push(rotated(rows)),
                AlphaPart::Boundary(rows) => parts[1].push(rotated(rows)),
                AlphaPart::Singular(rows) => parts[2].push(rows.to_vec()),
            }
            Ok(())
        };
        $mosaic.alpha_complex($alpha, &Monitor::silent(), put).unwrap();
        sorted(parts)
    }};
}

macro_rules! test_of {
    ($name:ident, $sets:ident, $kind:ident, $d:literal, $shape:ident) => {
        #[test]
        fn $name() {
            let (mut facets, mut cells) = (0, 0);
            for (name, points) in some($sets(), 1) {
                let view = Points::new(points.as_flattened(), $d).unwrap();
                let built = $kind::build(&view, &DelaunayOptions::default()).unwrap();
                let folder = tempfile::tempdir().unwrap();
                write_folder(&points, 4, folder.path());
                let mosaics =
                    [Mosaic::<$d>::of(&built), Mosaic::open(folder.path(), 1 << 24).unwrap()];
                for alpha in [0.02, 0.7, 40.0] {
                    let expected = of_complex(&built, &built.alpha_complex(alpha));
                    facets += expected[1].len() + expected[2].len();
                    for mosaic in &mosaics {
                        assert!(collected!(mosaic, alpha) == expected, "{name}, {alpha}");
                    }
                }
                // What needs another scale has other bits.
                if points
                    .iter()
                    .flatten()
                    .any(|x| x.abs() > 1e9 || (x.abs() > 0.0 && x.abs() < 1e-9))
                {
                    continue;
                }
                let Some([low, high]) = mosaics[1].extent().unwrap() else { continue };
                let frame = [low.map(|x| x - 1.0), high.map(|x| x + 1.0)];
                let locator = built.locator();
                let expected: BTreeMap<u64, $shape> = (0..built.site_count() as u32)
                    .map(|v| {
                        let cell = locator.voronoi_cell(v, frame[0], frame[1]);
                        (built.row(v).into(), cell)
                    })
                    .collect();
                cells += expected.len();
                for mosaic in &mosaics {
                    if mosaic.simplices() == 0 {
                        continue;
                    }
                    let mut found = BTreeMap::new();
                    let put = &mut |row: u64, cell: &$shape| {
                        assert!(
                            found.insert(row, cell.clone()).is_none(),
                            "{name}: row {row} twice"
                        );
                        Ok(())
                    };
                    mosaic.voronoi_cells(frame, &Monitor::silent(), put).unwrap();
                    assert!(found == expected, "{name}");
                }
            }
            let least = long_or(5000, 1000);
            assert!(facets > least && cells > least, "{facets} facets, {cells} cells");
        }
    };
}

test_of!(parts_and_cells_of_the_plane, plane, Plane, 2, Polygon);
test_of!(parts_and_cells_of_space, space, Space, 3, Polyhedron);
