//! That every row is a vertex or listed as unused, once, and that duplicates are all that they are said to be.

use taut_points::OrderBy;
use taut_points::parallel::ParallelSlice;

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
    let place = |row: u32| places.all[row as usize];
    // Rows in one place have one number, as 0 has one sign; few others share it. Numbers are sorted faster than places.
    let numbered = |row: u32| (number(&place(row)), row);
    let mut order: Vec<(u64, u32)> = (0..places.all.len() as u32).map(numbered).collect();
    order.par_sort_unstable();
    let mut firsts = vec![0; order.len()];
    for alike in order.chunk_by_mut(|a, b| a.0 == b.0) {
        // All are finite. Each of few numbers has rows in different places, and then they are sorted apart.
        alike.order_by(&|&(_, a), &(_, b)| {
            place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(&b))
        });
        for same in alike.chunk_by(|&(_, a), &(_, b)| place(a) == place(b)) {
            same.iter().for_each(|&(_, row)| firsts[row as usize] = same[0].1);
        }
    }
    firsts
}

/// A number of a place, by which places are sorted: any function will do that tells most of them apart.
fn number(place: &[f64; 3]) -> u64 {
    // An odd factor far from powers of two: 2⁶⁴ over the golden ratio.
    const FACTOR: u64 = 0x9E37_79B9_7F4A_7C15;
    place.iter().fold(0u64, |number, x| {
        let mixed = (number ^ x.to_bits()).wrapping_mul(FACTOR);
        mixed ^ mixed >> 29
    })
}
