//! Segments as few long lines, which take a third of the room.
//!
//! *Idea.* From the first segment that is left, walk on over segments that begin where the last one ended, each once.

use std::collections::HashMap;

/// A place in hundredths of a pixel.
pub(super) type Place = [i64; 2];

/// A line has at most this many places: programs that show SVG slow down over very long ones.
const TRAIL_PLACES_MAX: usize = 500;

/// Lines over all segments, each segment in one of them.
pub(super) fn trails(segments: &[[Place; 2]]) -> Vec<Vec<Place>> {
    let mut around: HashMap<Place, Vec<usize>> = HashMap::new();
    for (number, ends) in segments.iter().enumerate().rev() {
        ends.iter().for_each(|end| around.entry(*end).or_default().push(number));
    }
    let mut walked = vec![false; segments.len()];
    let mut trails = Vec::new();
    for (number, &[from, to]) in segments.iter().enumerate() {
        if walked[number] {
            continue;
        }
        walked[number] = true;
        let mut trail = vec![from, to];
        let mut at = to;
        while trail.len() < TRAIL_PLACES_MAX {
            let left = around.get_mut(&at);
            let Some(next) = left.and_then(|left| {
                left.truncate(left.iter().rposition(|&i| !walked[i]).map_or(0, |last| last + 1));
                left.pop()
            }) else {
                break;
            };
            walked[next] = true;
            let [one, other] = segments[next];
            at = if one == at { other } else { one };
            trail.push(at);
        }
        trails.push(trail);
    }
    trails
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_segment_is_walked_once() {
        // A grid with its diagonals.
        let mut segments = Vec::new();
        for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))) {
            for to in [[i + 1, j], [i, j + 1], [i + 1, j + 1]] {
                segments.push([[i, j], to]);
            }
        }
        let trails = trails(&segments);
        let sorted = |mut ends: Vec<[Place; 2]>| {
            ends.iter_mut().for_each(|pair| pair.sort_unstable());
            ends.sort_unstable();
            ends
        };
        let walked =
            trails.iter().flat_map(|trail| trail.windows(2)).map(|pair| [pair[0], pair[1]]);
        assert_eq!(sorted(walked.collect()), sorted(segments.clone()));
        assert!(trails.len() * 6 < segments.len(), "{}", trails.len());
    }
}
