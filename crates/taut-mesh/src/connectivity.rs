//! Decides whether found curves are the true ones in the sense of connectivity.
//!
//! *Idea.* Each found curve must lie next to one true curve alone, another one for each, close where that one closes, and run along
//! it without turning back: the places of its vertices, as shares of the length of the true curve, rise or fall all the way.
//! *Guarantee.* A closed curve runs around exactly once; one with ends covers more than half of the true one. Places may fall back
//! by a thousandth of the length in all, not at each step: vertices near the center of a bend have places that jitter.
//! *Trap.* This sees vertices, not edges: what edges cross is seen by [`crossings`](crate::crossings), how far they deviate by the
//! Hausdorff distance.

/// At most this share of the length may be lost on the way.
const BACKTRACK_RATIO_MAX: f64 = 1e-3;

/// Where a vertex lies: number of the true curve, and share of its length before the place.
pub(crate) type Place = (u32, f64);

/// Tests whether each found curve (places of its vertices in order, and whether it closes) belongs to a true curve of its own; `closed`
/// tells of each true curve whether it does.
pub(crate) fn homeomorphic(closed: &[bool], found: &[(Vec<Place>, bool)]) -> bool {
    let mut taken = vec![false; closed.len()];
    found.len() == closed.len()
        && found.iter().all(|(places, closes)| {
            let Some(&(curve, _)) = places.first() else { return false };
            let own = !std::mem::replace(&mut taken[curve as usize], true);
            own && places.iter().all(|place| place.0 == curve)
                && *closes == closed[curve as usize]
                && runs_along(places, *closes)
        })
}

/// Tests whether places of one curve rise or fall all the way.
fn runs_along(places: &[Place], closed: bool) -> bool {
    let mut steps: Vec<f64> = places.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    if closed {
        steps.push(places[0].1 - places[places.len() - 1].1);
        // The shorter way around.
        steps.iter_mut().for_each(|step| *step -= step.round());
    }
    let mut sum: f64 = steps.iter().sum();
    if sum < 0.0 {
        steps.iter_mut().for_each(|step| *step = -*step);
        sum = -sum;
    }
    let (mut at, mut highest) = (0.0f64, 0.0f64);
    let steady = steps.iter().all(|step| {
        at += step;
        highest = highest.max(at);
        at >= highest - BACKTRACK_RATIO_MAX
    });
    steady && if closed { (sum - 1.0).abs() < 1e-6 } else { sum > 0.5 }
}
