//! Tests what the lists of a surface claim of rows, and how far vertices were moved.

use std::collections::{BTreeSet, HashMap};

use taut::Solution;
use taut::certify::Surface;
use taut::certify::SurfaceVerdict;

use super::super::lattice::{Lattice, difference, dot};
use super::scene::Scene;
use super::{Judged, Point, ensure};

/// The largest deviation of the displacement of a certificate from the true one, relatively, as documented.
const DISPLACEMENT_SLACK: f64 = 1e-9;

/// Vertices that were moved: as many as rows, and none farther than told.
pub(super) fn vertices(
    solution: &Solution<Surface>,
    verdict: &SurfaceVerdict,
    rows: &[Point],
) -> Judged {
    let vertices = &solution.answer.vertices;
    let claimed = solution.certificate.displacement * (1.0 + 2.0 * DISPLACEMENT_SLACK);
    for told in [verdict.displacement, claimed] {
        ensure(told >= 0.0, || format!("the displacement is told to be {told}"))?;
    }
    if vertices.is_empty() {
        return ensure(verdict.displacement == 0.0 && claimed == 0.0, || "nothing moved".into());
    }
    ensure(vertices.len() == rows.len(), || "not a vertex for each row".into())?;
    let all = || vertices.as_flattened().iter().copied();
    ensure(all().all(f64::is_finite), || "a vertex is not finite".into())?;
    for (row, (from, to)) in rows.iter().zip(vertices).enumerate() {
        for told in [verdict.displacement, claimed].into_iter().filter(|told| told.is_finite()) {
            let at = Lattice::of(&[*from, *to, [told, 0.0, 0.0]].concat(), 3).points;
            let moved = difference(&at[1], &at[0]);
            ensure(dot(&moved, &moved) <= dot(&at[2], &at[2]), || {
                format!("row {row} was moved by more than {told:e}")
            })?;
        }
    }
    Ok(())
}

/// Triangles name three different rows, no three twice; each other row is in one list, for a reason that holds.
pub(super) fn rows(surface: &Surface, scene: &Scene) -> Judged {
    let n = scene.places.len();
    let mut triples = BTreeSet::new();
    let mut uses = vec![0u32; n];
    for (number, triangle) in surface.triangles.iter().enumerate() {
        let mut sorted = *triangle;
        sorted.sort_unstable();
        let are_rows = (sorted[2] as usize) < n && sorted[0] < sorted[1] && sorted[1] < sorted[2];
        ensure(are_rows, || format!("triangle {number} names {triangle:?}"))?;
        ensure(triples.insert(sorted), || format!("triangle {number} is there twice"))?;
        sorted.iter().for_each(|&row| uses[row as usize] = 1);
    }
    let unused = &surface.unused;
    let duplicates: Vec<u32> = unused.duplicates.iter().map(|pair| pair[0]).collect();
    for (name, list) in [
        ("duplicates", &duplicates),
        ("outliers", &unused.outliers),
        ("interior", &unused.interior),
        ("unreferenced", &unused.unreferenced),
    ] {
        ensure(list.is_sorted_by(|a, b| a < b), || format!("{name}: not ascending"))?;
        ensure(list.last().is_none_or(|&row| (row as usize) < n), || format!("{name}: no row"))?;
        list.iter().for_each(|&row| uses[row as usize] += 1);
    }
    let other = uses.iter().position(|&uses| uses != 1);
    ensure(other.is_none(), || format!("row {other:?} is used or listed not just once"))?;
    let mut first = HashMap::new();
    let mut copies = vec![];
    for (row, place) in (0u32..).zip(&scene.places) {
        // −0 is 0.
        let first = *first.entry(place.map(|x| (x + 0.0).to_bits())).or_insert(row);
        if first != row {
            copies.push([row, first]);
        }
    }
    ensure(unused.duplicates == copies, || format!("the duplicates are {copies:?}"))
}

/// The rows that balls must not hold: those that are no duplicates and no outliers.
pub(super) fn sites(surface: &Surface, rows: usize) -> Vec<bool> {
    let mut is_site = vec![true; rows];
    let duplicates = surface.unused.duplicates.iter().map(|pair| pair[0]);
    duplicates.chain(surface.unused.outliers.iter().copied()).for_each(|row| {
        is_site[row as usize] = false;
    });
    is_site
}
