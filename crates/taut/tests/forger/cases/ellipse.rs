//! Ellipses in polygons: those of the circles.

use taut::inscribe::{EllipseOptions, inscribed_ellipse};

use super::{CELLS_MAX, Case, Solved, cases, circle, document};

/// Returns the cases of the largest ellipse in a polygon.
pub fn all() -> Vec<Case> {
    cases(circle::polygons(), |input| {
        let base = EllipseOptions { max_cells: CELLS_MAX, ..EllipseOptions::default() };
        let ways = [
            ("1e-3", base.clone()),
            ("1e-1", EllipseOptions { epsilon: 1e-1, ..base.clone() }),
            ("1e-9", EllipseOptions { epsilon: 1e-9, ..base.clone() }),
            ("one cell", EllipseOptions { max_cells: 1, ..base }),
        ];
        let solve = |(way, options): (&str, EllipseOptions<'_>)| -> (String, _) {
            let found = input.with(|source| inscribed_ellipse(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        };
        ways.into_iter().map(solve).collect::<Vec<Solved>>()
    })
}
