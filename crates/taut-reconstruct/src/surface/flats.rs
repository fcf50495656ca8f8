//! Flat cells, which say nothing of their own.
//!
//! *Problem.* Four points nearly on one circle, as every square of a grid has, make a cell without volume within or upon a face. All
//! spheres through the circle are in one pencil, and that of the cell is somewhere between those of the cells beyond its facets: it
//! divides the angle between them, and where they meet in an angle that says "opposite", two smaller ones say "same".
//! *Idea.* A flat cell that says "same" to all its neighbors, and not surely to all, has the sphere of one of them for its own: of the one
//! most like it. One of its sides is then as one cell with that neighbor, and the facets of the other side say what the two that are no
//! flat cells have to say to each other. Where such cells are beside each other, as polygons on a circle have them, they take what their
//! neighbor took, along the surest tree: each looks to its surest neighbor, and so do groups that only look at each other, until
//! they look out.
//! *Guarantee.* A function of the points: what is equally sure is ordered by the numbers of facets. O(n + f log f) for f such cells.
//! *Trap.* A cell that is flat but whose corners are far from any circle has a sphere as large as a half-space, and much to say; but so
//! have its neighbors.

use std::cmp::Reverse;

use super::cells::Cells;
use super::dual_edges::{CERTAIN_STEPS, DualEdge, DualEdges, normal};
use super::spheres::{Point, Sphere, circumcircle};

/// A cell is flat if the square of its volume, six times as large as it is, is at most this beside the product of those of the edges
/// from its first vertex. From 10⁻⁶ down, wedges whose points are off by a thousandth of their spacing get handles; from 10⁻⁴ up, ellipsoids that are close merge.
pub(super) const FLAT_RATIO_MAX: f64 = 1e-5;
/// So much of "same" is sure.
const SURE_STRENGTH: i64 = CERTAIN_STEPS / 100 * 95;

/// A facet of a flat cell over which it may get its sphere; the surest is the greatest.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Offer {
    weight: i64,
    /// From the cell with the lower number.
    facet: Reverse<u32>,
}

/// Gives some of the flat cells the sphere of another one, and lists them. The dual edges are of all cells with spheres of their own.
pub(super) fn flats(
    flat: &[u32],
    dual_edges: &DualEdges,
    (cells, points): (&Cells, &[Point]),
    spheres: &mut [Sphere],
) -> Vec<u32> {
    let mut flat: Vec<u32> =
        flat.iter().copied().filter(|&cell| divides(cell, dual_edges)).collect();
    if flat.is_empty() {
        return Vec::new();
    }
    let mut number = vec![NONE; cells.len()];
    (0..).zip(&flat).for_each(|(k, &cell)| number[cell as usize] = k);
    // Where a facet of a flat cell leads.
    let beyond = |facet: u32| match number[(cells.mirror(facet) >> 2) as usize] {
        NONE => SphereSource::Out(facet),
        other => SphereSource::To(other),
    };
    let surest = |&cell: &u32| {
        offers(cell, dual_edges, cells).max().map_or(SphereSource::End, |(_, own)| beyond(own))
    };
    let mut groups = ends(&flat.iter().map(surest).collect::<Vec<SphereSource>>());
    // What hangs together with flat cells alone looks beyond itself.
    loop {
        let is_alone = |&k: &u32| matches!(groups[k as usize], SphereSource::To(_));
        let alone: Vec<u32> = (0..flat.len() as u32).filter(is_alone).collect();
        if alone.is_empty() {
            break;
        }
        let mut best: Vec<Option<(Offer, SphereSource)>> = vec![None; flat.len()];
        for &k in &alone {
            let SphereSource::To(group) = groups[k as usize] else { continue };
            for (offer, own) in offers(flat[k as usize], dual_edges, cells) {
                let way = match beyond(own) {
                    SphereSource::To(other) => groups[other as usize],
                    out => out,
                };
                let is_surer = best[group as usize].is_none_or(|(most, _)| offer > most);
                if is_surer && way != SphereSource::To(group) {
                    best[group as usize] = Some((offer, way));
                }
            }
        }
        let ways: Vec<SphereSource> =
            best.iter().map(|best| best.map_or(SphereSource::End, |(_, way)| way)).collect();
        let joined = ends(&ways);
        for k in alone {
            if let SphereSource::To(group) = groups[k as usize] {
                groups[k as usize] = joined[group as usize];
            }
        }
    }
    // What is beyond is not flat, and keeps its own.
    let mut groups = groups.into_iter();
    flat.retain(|&cell| {
        let Some(SphereSource::Out(facet)) = groups.next() else { return false };
        let from = cells.mirror(facet) >> 2;
        spheres[cell as usize] = match cells.is_ghost(from) {
            true => half_space(cells.facet(facet >> 2, facet as usize & 3), points),
            false => spheres[from as usize],
        };
        true
    });
    flat
}

/// No number.
const NONE: u32 = u32::MAX;

/// Where a flat cell, or a group of them, gets its sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SphereSource {
    /// From the cell beyond a facet, which is not flat.
    Out(u32),
    /// From whatever this one gets it from; from itself, if the two look at each other.
    To(u32),
    /// From nowhere.
    End,
}

/// Follows ways to their ends: out, or to the lower of two that look at each other. There is no other way round, as each goes by its
/// surest offer.
fn ends(ways: &[SphereSource]) -> Vec<SphereSource> {
    let mut ends = vec![None; ways.len()];
    let mut path = Vec::new();
    for start in 0..ways.len() {
        let mut at = start as u32;
        let end = loop {
            if let Some(end) = ends[at as usize] {
                break end;
            }
            path.push(at);
            match ways[at as usize] {
                SphereSource::To(next) if ways[next as usize] == SphereSource::To(at) => {
                    break SphereSource::To(at.min(next));
                }
                SphereSource::To(next) => at = next,
                end => break end,
            }
        };
        path.drain(..).for_each(|at| ends[at as usize] = Some(end));
    }
    ends.into_iter().map(|end| end.unwrap_or(SphereSource::End)).collect()
}

/// Returns true if a cell says "same" to all its neighbors, though not surely to one of them.
fn divides(cell: u32, dual_edges: &DualEdges) -> bool {
    let least = dual_edges.of_cell(cell).map(DualEdge::signed).into_iter().min();
    least.is_some_and(|least| (0..SURE_STRENGTH).contains(&least))
}

/// Returns what may be taken over the facets of a cell, each with the facet as the cell has it. It counts how flat cells lie in their pencil, which
/// is known from their own spheres: so an offer is the same from both sides.
fn offers<'a>(
    cell: u32,
    dual_edges: &'a DualEdges,
    cells: &'a Cells,
) -> impl Iterator<Item = (Offer, u32)> + 'a {
    (0..).zip(dual_edges.of_cell(cell)).map(move |(i, dual_edge)| {
        let facet = cell << 2 | i;
        let first = Reverse(facet.min(cells.mirror(facet)));
        (Offer { weight: dual_edge.signed(), facet: first }, facet)
    })
}

/// The half-space beyond a facet of the hull, as the sphere through its corners that is larger than any other by far.
fn half_space(facet: [u32; 3], points: &[Point]) -> Sphere {
    const RADIUS_FACTOR: f64 = (1u64 << 40) as f64;
    let mut sites = facet;
    sites.sort_unstable();
    let [a, b, c] = sites.map(|site| points[site as usize]);
    let circle = circumcircle(a, b, c);
    let (normal, _) = normal(facet, points);
    let radius = RADIUS_FACTOR * circle.radius;
    Sphere { center: [0, 1, 2].map(|k| circle.center[k] + radius * normal[k]), radius }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_end_outside_or_in_pairs() {
        use SphereSource::{End, Out, To};
        let ways = [To(1), To(2), Out(40), To(4), To(3), To(4), To(7), End];
        assert_eq!(ends(&ways), [Out(40), Out(40), Out(40), To(3), To(3), To(3), End, End]);
    }
}
