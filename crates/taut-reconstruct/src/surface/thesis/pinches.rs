//! Sites where parts of the surface meet in a point.
//!
//! *Idea.* Corners of triangles that share an edge at a site belong to one fan. A site with several fans is a pinch; it can be given
//! once for each fan, or all fans but the largest are taken away.
//! *Trap.* To take away a fan makes new borders, and can make pinches of sites around: that is repeated until there is none.

use std::collections::HashMap;

/// The fan of each corner of each triangle: the lowest corner of it, three times the triangle and 0, 1 or 2.
fn fans(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut parent: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    // The triangle that runs along an edge, from its first corner on.
    let mut along: HashMap<(u32, u32), u32> = HashMap::with_capacity(3 * triangles.len());
    for (t, sites) in (0u32..).zip(triangles) {
        for i in 0..3 {
            let (j, from, to) = ((i + 1) % 3, sites[i], sites[(i + 1) % 3]);
            let (i, j) = (3 * t + i as u32, 3 * t + j as u32);
            if let Some(&other) = along.get(&(to, from)) {
                // There, `other` is at `to` and the next corner at `from`.
                let next = 3 * (other / 3) + (other + 1) % 3;
                join(&mut parent, j, other);
                join(&mut parent, i, next);
            }
            along.insert((from, to), i);
        }
    }
    (0..triangles.len() as u32).map(|t| [0, 1, 2].map(|i| root(&mut parent, 3 * t + i))).collect()
}

fn root(parent: &mut [u32], mut corner: u32) -> u32 {
    while parent[corner as usize] != corner {
        parent[corner as usize] = parent[parent[corner as usize] as usize];
        corner = parent[corner as usize];
    }
    corner
}

/// The lower root stays one.
fn join(parent: &mut [u32], one: u32, other: u32) {
    let (one, other) = (root(parent, one), root(parent, other));
    parent[one.max(other) as usize] = one.min(other);
}

/// Visits each fan once, with its site and its name.
fn each_fan(fans: &[[u32; 3]], triangles: &[[u32; 3]], mut visit: impl FnMut(u32, u32)) {
    for (t, (fan, sites)) in (0u32..).zip(fans.iter().zip(triangles)) {
        for i in (0..3).filter(|&i| fan[i] == 3 * t + i as u32) {
            visit(sites[i], fan[i]);
        }
    }
}

/// Gives each fan a vertex of its own: the site of each vertex, and the triangles on these. Vertices are in the order of their sites,
/// those of a pinch in that of the first triangles of its fans.
pub(super) fn split(triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<[u32; 3]>) {
    let fans = fans(triangles);
    let mut all = Vec::new();
    each_fan(&fans, triangles, |site, fan| all.push((site, fan)));
    all.sort_unstable();
    let number: HashMap<u32, u32> = all.iter().map(|&(_, fan)| fan).zip(0..).collect();
    let on_vertices = fans.iter().map(|fan| fan.map(|corner| number[&corner]));
    let on_vertices = on_vertices.collect();
    (all.into_iter().map(|(site, _)| site).collect(), on_vertices)
}

/// Which triangles stay when only the largest fan of each pinch does; of equal ones the one that the surface reached first.
pub(super) fn peel(triangles: &[[u32; 3]]) -> Vec<bool> {
    let mut stays = vec![true; triangles.len()];
    loop {
        let places: Vec<usize> = (0..triangles.len()).filter(|&t| stays[t]).collect();
        let left: Vec<[u32; 3]> = places.iter().map(|&t| triangles[t]).collect();
        let fans = fans(&left);
        let mut size = vec![0u32; 3 * left.len()];
        fans.as_flattened().iter().for_each(|&fan| size[fan as usize] += 1);
        // By site, the largest fan so far.
        let mut largest: HashMap<u32, u32> = HashMap::new();
        each_fan(&fans, &left, |site, fan| {
            let best = largest.entry(site).or_insert(fan);
            if size[fan as usize] > size[*best as usize] {
                *best = fan;
            }
        });
        let mut peeled = false;
        for (place, (fan, sites)) in places.into_iter().zip(fans.iter().zip(&left)) {
            if (0..3).any(|i| largest[&sites[i]] != fan[i]) {
                stays[place] = false;
                peeled = true;
            }
        }
        if !peeled {
            return stays;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles beside each other, and a single one that touches them in site 2.
    const BOW: [[u32; 3]; 3] = [[2, 4, 5], [0, 1, 2], [2, 1, 3]];

    #[test]
    fn fans_are_split() {
        let (sites, triangles) = split(&BOW);
        assert_eq!(sites, [0, 1, 2, 2, 3, 4, 5]);
        assert_eq!(triangles, [[2, 5, 6], [0, 1, 3], [3, 1, 4]]);
    }

    #[test]
    fn the_larger_fan_stays() {
        assert_eq!(peel(&BOW), [false, true, true]);
        // Of two equal fans the first.
        assert_eq!(peel(&[[0, 1, 2], [2, 3, 4]]), [true, false]);
    }
}
