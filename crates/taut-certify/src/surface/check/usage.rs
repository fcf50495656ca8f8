//! That every row is a vertex or listed as unused, once, and that duplicates are all that they are said to be.

use super::super::{Surface, SurfaceViolation};
use super::places::Places;

/// Of a row: nothing is known yet, it is a vertex, it is listed.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    None,
    Vertex,
    Listed,
}

/// The rows that balls must not hold: all but duplicates, whose first row speaks for them, and outliers.
pub(super) fn check(surface: &Surface, places: &Places) -> Result<Vec<u32>, SurfaceViolation> {
    let mut uses = vec![Use::None; places.all.len()];
    surface.triangles.iter().flatten().for_each(|&row| uses[row as usize] = Use::Vertex);
    let unused = &surface.unused;
    let duplicates: Vec<u32> = unused.duplicates.iter().map(|pair| pair[0]).collect();
    for (name, list) in [
        ("duplicates", &duplicates),
        ("outliers", &unused.outliers),
        ("interior rows", &unused.interior),
        ("unreferenced rows", &unused.unreferenced),
    ] {
        enter(name, list, &mut uses)?;
    }
    if let Some(row) = uses.iter().position(|&one| one == Use::None) {
        return Err(SurfaceViolation::Missing { row: row as u32 });
    }
    let firsts = firsts(places);
    for (position, &[row, first]) in unused.duplicates.iter().enumerate() {
        let true_first = firsts[row as usize];
        let problem = match () {
            () if true_first == row => "but no earlier row is in its place",
            () if true_first != first => "with a row that is not the first in its place",
            () => continue,
        };
        return Err(SurfaceViolation::Unused { list: "duplicates", position, row, problem });
    }
    let copies = (0u32..).zip(&firsts).filter(|&(row, &first)| row != first);
    // All entries are true and ascending: the first difference is one that is missing.
    let listed = duplicates.iter().map(Some).chain(std::iter::once(None));
    for ((row, &first), listed) in copies.zip(listed) {
        if listed != Some(&row) {
            return Err(SurfaceViolation::MissingDuplicate { row, first });
        }
    }
    let mut is_site = vec![true; places.all.len()];
    duplicates.iter().chain(&unused.outliers).for_each(|&row| is_site[row as usize] = false);
    Ok((0u32..).zip(is_site).filter(|one| one.1).map(|one| one.0).collect())
}

/// Enters a list into what is known.
fn enter(list: &'static str, rows: &[u32], uses: &mut [Use]) -> Result<(), SurfaceViolation> {
    let mut before = None;
    for (position, &row) in rows.iter().enumerate() {
        let problem = match uses.get(row as usize) {
            None => "but there are not so many",
            Some(_) if before == Some(row) => "as does the entry before it",
            Some(_) if before > Some(row) => "which is less than the entry before it",
            Some(Use::Vertex) => "but that is the vertex of a triangle",
            Some(Use::Listed) => "which another list names as well",
            Some(Use::None) => {
                uses[row as usize] = Use::Listed;
                before = Some(row);
                continue;
            }
        };
        return Err(SurfaceViolation::Unused { list, position, row, problem });
    }
    Ok(())
}

/// For each row the first one in its place.
fn firsts(places: &Places) -> Vec<u32> {
    let mut order: Vec<u32> = (0..places.all.len() as u32).collect();
    let place = |row: u32| places.all[row as usize];
    order.sort_unstable_by(|&a, &b| {
        // All are finite, and 0 has one sign.
        place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(&b))
    });
    let mut firsts = vec![0; order.len()];
    for same in order.chunk_by(|&a, &b| place(a) == place(b)) {
        same.iter().for_each(|&row| firsts[row as usize] = same[0]);
    }
    firsts
}
