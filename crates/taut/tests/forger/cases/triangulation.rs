//! Delaunay triangulations in the plane and in space.

use taut::{DelaunayOptions, delaunay};

use super::{Case, cases, clouds, document};

/// Returns the cases of triangulations.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(2, 14), (3, 10)] {
        found.extend(cases(clouds::points(dim, count), |input| {
            let options = DelaunayOptions::default();
            let found = input.with(|source| delaunay(source, &options));
            vec![("delaunay".to_owned(), found.ok().map(|found| document(&found)))]
        }));
    }
    found
}
