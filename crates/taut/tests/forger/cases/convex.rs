//! Convex polygons in polygons: those of the circles.

use taut::inscribe::{ConvexOptions, inscribed_polygon};

use super::{Case, Solved, cases, circle, document};

/// Returns the cases of large convex polygons in a polygon.
pub fn all() -> Vec<Case> {
    cases(circle::polygons(), |input| {
        let base = ConvexOptions { rounds: 20, starts: 8, ..Default::default() };
        let ways = [
            ("default", base.clone()),
            ("first body", ConvexOptions { rounds: 0, starts: 1, ..base.clone() }),
            ("tight bound", ConvexOptions { epsilon: 1e-4, ..base }),
        ];
        let solve = |(way, options): (&str, ConvexOptions<'_>)| -> (String, _) {
            let found = input.with(|source| inscribed_polygon(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        };
        ways.into_iter().map(solve).collect::<Vec<Solved>>()
    })
}
