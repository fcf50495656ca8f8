//! Decides whether a list has just the facets of the hull.
//!
//! *Idea.* A list in the order of the simplices, as `taut` writes it, is compared as it comes. Any other is sorted. The
//! checker has to know nothing of the order: it only is the faster for it.

use super::super::MeshViolation;
use super::facets::Facets;

/// Checks that `listed` has each of the `open` facets once, in any order and from any vertex on, and nothing else.
/// Vertices of `open` are below `rows`. `place` tells the simplex and the facet of an open one.
pub(super) fn check<const V: usize, const F: usize>(
    open: &[[u32; F]],
    listed: &[u32],
    rows: usize,
    place: impl Fn(usize) -> (usize, usize),
) -> Result<(), MeshViolation>
where
    [u32; V]: Facets<F>,
{
    let turned = <[u32; V]>::turned;
    let listed: &[[u32; F]] = listed.as_chunks().0;
    if listed.len() == open.len() && listed.iter().zip(open).all(|(&f, &g)| turned(f) == turned(g))
    {
        return Ok(());
    }
    let keys = |facets: &[[u32; F]]| -> Vec<u128> {
        (0u32..).zip(facets).map(|(place, &facet)| packed(turned(facet), place)).collect()
    };
    let mut found = sorted(keys(open), rows).into_iter().peekable();
    let mut missing = None;
    for claim in sorted(keys(listed), rows) {
        while let Some(before) = found.next_if(|found| found >> 32 < claim >> 32) {
            missing.get_or_insert(before);
        }
        if found.next_if(|found| found >> 32 == claim >> 32).is_none() {
            return Err(MeshViolation::HullFacet { position: claim as u32 as usize });
        }
    }
    match missing.or(found.next()) {
        Some(missing) => {
            let (simplex, facet) = place(missing as u32 as usize);
            Err(MeshViolation::Open { simplex, facet })
        }
        None => Ok(()),
    }
}

/// A facet and its place in a list, as one number that sorts fast: first vertex, other vertices, place.
fn packed<const F: usize>(facet: [u32; F], place: u32) -> u128 {
    let vertices = facet.iter().fold(0, |all, &v| all << 32 | u128::from(v));
    vertices << (32 * (4 - F)) | u128::from(place)
}

/// Sorted, by counting first vertices where there are many: few facets have the same one. Vertices that are no rows
/// come last.
fn sorted(mut facets: Vec<u128>, rows: usize) -> Vec<u128> {
    if facets.len() < rows / 8 {
        facets.sort_unstable();
        return facets;
    }
    let first = |facet: &u128| ((facet >> 96) as usize).min(rows);
    let mut starts = vec![0usize; rows + 2];
    for facet in &facets {
        starts[first(facet) + 1] += 1;
    }
    for vertex in 0..=rows {
        starts[vertex + 1] += starts[vertex];
    }
    let mut sorted = vec![0; facets.len()];
    for facet in facets {
        let place = &mut starts[first(&facet)];
        sorted[*place] = facet;
        *place += 1;
    }
    sorted.chunk_by_mut(|a, b| first(a) == first(b)).for_each(<[u128]>::sort_unstable);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge(listed: &[[u32; 3]]) -> Result<(), MeshViolation> {
        let open = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        check::<4, 3>(&open, listed.as_flattened(), 4, |place| (7, place))
    }

    #[test]
    fn any_order_and_any_first_vertex_will_do() {
        let (a, b, c, d) = ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]);
        assert_eq!(judge(&[a, b, c, d]), Ok(()));
        assert_eq!(judge(&[[3, 1, 2], b, [1, 3, 0], d]), Ok(()));
        assert_eq!(judge(&[d, b, [3, 1, 2], c]), Ok(()));
    }

    #[test]
    fn what_is_missing_twice_or_turned_over_is_named() {
        let (a, b, c, d) = ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]);
        let missing = MeshViolation::Open { simplex: 7, facet: 2 };
        assert_eq!(judge(&[a, b, d]), Err(missing));
        assert_eq!(judge(&[a, b, c, d, b]), Err(MeshViolation::HullFacet { position: 4 }));
        assert_eq!(judge(&[a, [0, 2, 3], c, d]), Err(MeshViolation::HullFacet { position: 1 }));
        assert_eq!(judge(&[a, b, c, [0, 2, 9]]), Err(MeshViolation::HullFacet { position: 3 }));
    }

    #[test]
    fn an_edge_of_the_plane_has_a_direction() {
        let open = [[0, 1], [1, 2], [2, 0]];
        let judge = |listed: &[[u32; 2]]| {
            check::<3, 2>(&open, listed.as_flattened(), 3, |place| (place, 0))
        };
        assert_eq!(judge(&[[0, 1], [1, 2], [2, 0]]), Ok(()));
        assert_eq!(judge(&[[2, 0], [1, 2], [0, 1]]), Ok(()));
        let wrong = Err(MeshViolation::HullFacet { position: 1 });
        assert_eq!(judge(&[[0, 1], [2, 1], [2, 0]]), wrong);
    }
}
