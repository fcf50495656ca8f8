//! Rectangles of any direction in polygons: those of the circles.

use taut::inscribe::{OrientedRectangleOptions, inscribed_oriented_rectangle};

use super::{CELLS_MAX, Case, Solved, cases, circle, document};

/// Returns the cases of the largest rectangle of any direction in a polygon.
pub fn all() -> Vec<Case> {
    cases(circle::polygons(), |input| {
        let base = OrientedRectangleOptions {
            max_cells: CELLS_MAX,
            ..OrientedRectangleOptions::default()
        };
        let ways = [
            ("1e-2", OrientedRectangleOptions { epsilon: 1e-2, ..base.clone() }),
            ("3e-1", OrientedRectangleOptions { epsilon: 3e-1, ..base.clone() }),
            ("one cell", OrientedRectangleOptions { max_cells: 1, ..base }),
        ];
        let solve = |(way, options): (&str, OrientedRectangleOptions<'_>)| -> (String, _) {
            let found = input.with(|source| inscribed_oriented_rectangle(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        };
        ways.into_iter().map(solve).collect::<Vec<Solved>>()
    })
}
