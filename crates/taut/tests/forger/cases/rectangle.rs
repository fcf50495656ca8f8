//! Rectangles in polygons: those of the circles.

use taut::inscribe::{RectangleOptions, inscribed_rectangle};

use super::{CELLS_MAX, Case, Solved, cases, circle, document};

/// Returns the cases of the largest rectangle in a polygon.
pub fn all() -> Vec<Case> {
    cases(circle::polygons(), |input| {
        let base = RectangleOptions { max_cells: CELLS_MAX, ..RectangleOptions::default() };
        let ways = [
            ("1e-3", base.clone()),
            ("1e-1", RectangleOptions { epsilon: 1e-1, ..base.clone() }),
            ("1e-6", RectangleOptions { epsilon: 1e-6, ..base.clone() }),
            ("one cell", RectangleOptions { max_cells: 1, ..base }),
        ];
        let solve = |(way, options): (&str, RectangleOptions<'_>)| -> (String, _) {
            let found = input.with(|source| inscribed_rectangle(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        };
        ways.into_iter().map(solve).collect::<Vec<Solved>>()
    })
}
