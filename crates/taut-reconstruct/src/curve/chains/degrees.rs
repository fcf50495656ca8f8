//! At most two edges to a site.

use taut_points::OrderBy;

/// Keeps at each site with more than two edges the best pair, and drops edges that one of their ends gave up. Tells how many were
/// dropped.
///
/// Of edges a and b that turn by the angle α the best have the least (|a| + |b|)(2 − cos α): a fold counts as three times its
/// length, a straight pair as it is.
pub(super) fn limit(sites: &[[f64; 2]], edges: &mut Vec<[u32; 2]>) -> u64 {
    let mut degrees = vec![0u32; sites.len()];
    edges.iter().flatten().for_each(|&site| degrees[site as usize] += 1);
    if degrees.iter().all(|&degree| degree <= 2) {
        return 0;
    }
    // Neighbors of crowded sites only, by site.
    let mut spokes: Vec<[u32; 2]> = edges
        .iter()
        .flat_map(|&[a, b]| [[a, b], [b, a]])
        .filter(|&[site, _]| degrees[site as usize] > 2)
        .collect();
    spokes.sort_unstable();
    let kept: Vec<[u32; 2]> =
        spokes.chunk_by(|a, b| a[0] == b[0]).flat_map(|around| best_pair(sites, around)).collect();
    let keeps =
        |site: u32, to: u32| degrees[site as usize] <= 2 || kept.binary_search(&[site, to]).is_ok();
    let before = edges.len();
    edges.retain(|&[a, b]| keeps(a, b) && keeps(b, a));
    (before - edges.len()) as u64
}

/// The two of the edges around a site that go on best, in order.
fn best_pair(sites: &[[f64; 2]], around: &[[u32; 2]]) -> [[u32; 2]; 2] {
    /// With more edges than this only the shortest are compared.
    const COMPARED_EDGES_MAX: usize = 16;
    let spoke = |&[site, to]: &[u32; 2]| {
        let ([x, y], [u, v]) = (sites[site as usize], sites[to as usize]);
        let (dx, dy) = (u - x, v - y);
        (dx.hypot(dy), dx, dy, [site, to])
    };
    let mut spokes: Vec<_> = around.iter().map(spoke).collect();
    spokes.order_by(&|a, b| a.0.total_cmp(&b.0).then(a.3.cmp(&b.3)));
    spokes.truncate(COMPARED_EDGES_MAX);
    let (mut best, mut least) = ([spokes[0].3, spokes[1].3], f64::INFINITY);
    for (i, a) in spokes.iter().enumerate() {
        for b in &spokes[..i] {
            let cosine = (a.1 / a.0) * (b.1 / b.0) + (a.2 / a.0) * (b.2 / b.0);
            let cost = (a.0 + b.0) * (2.0 + cosine);
            if cost < least {
                (best, least) = ([b.3, a.3], cost);
            }
        }
    }
    best.sort_unstable();
    best
}
