//! Triangles in polygons: those of the circles.

use taut::inscribe::{TriangleOptions, inscribed_triangle};

use super::{CELLS_MAX, Case, Solved, cases, circle, document};

/// Returns the cases of the largest triangle in a polygon.
pub fn all() -> Vec<Case> {
    cases(circle::polygons(), |input| {
        let base = TriangleOptions { max_cells: CELLS_MAX, ..TriangleOptions::default() };
        let ways = [
            ("1e-3", base.clone()),
            ("1e-1", TriangleOptions { epsilon: 1e-1, ..base.clone() }),
            ("1e-9", TriangleOptions { epsilon: 1e-9, ..base.clone() }),
            ("one cell", TriangleOptions { max_cells: 1, ..base }),
        ];
        let solve = |(way, options): (&str, TriangleOptions<'_>)| -> (String, _) {
            let found = input.with(|source| inscribed_triangle(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        };
        ways.into_iter().map(solve).collect::<Vec<Solved>>()
    })
}
