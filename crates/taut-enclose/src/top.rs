//! The farthest items met so far, under one total order, so that threads may meet them in any order.

use std::cmp::Ordering;
use std::collections::BTreeMap;

/// An item and how far it reaches from the center of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Far {
    pub(crate) id: u64,
    /// (|x − c| + r)², with r = 0 for a point.
    pub(crate) reach2: f64,
}

/// Farther first; equal reaches by row number.
fn farther_first(a: &Far, b: &Far) -> Ordering {
    b.reach2.total_cmp(&a.reach2).then(a.id.cmp(&b.id))
}

/// The `keep` farthest of the items offered, whatever the order of the offers.
#[derive(Clone, Debug)]
pub(crate) struct Top {
    keep: usize,
    items: Vec<Far>,
    /// Once `keep` items are known: the last of them. Nothing behind it can belong to the result.
    last: Option<Far>,
}

impl Top {
    pub(crate) fn new(keep: usize) -> Self {
        Top { keep: keep.max(1), items: Vec::new(), last: None }
    }

    /// Items that reach less than this cannot belong to the result.
    pub(crate) fn bound(&self) -> f64 {
        self.last.map_or(0.0, |last| last.reach2)
    }

    pub(crate) fn offer(&mut self, far: Far) {
        if self.last.is_some_and(|last| farther_first(&far, &last).is_ge()) {
            return;
        }
        self.items.push(far);
        if self.items.len() / 2 >= self.keep {
            self.trim();
        }
    }

    fn trim(&mut self) {
        if self.items.len() >= self.keep {
            let (_, last, _) = self.items.select_nth_unstable_by(self.keep - 1, farther_first);
            self.last = Some(*last);
            self.items.truncate(self.keep);
        }
    }

    /// Takes over all items of another list.
    pub(crate) fn merge(&mut self, other: Top) {
        for far in other.items {
            self.offer(far);
        }
        self.trim();
    }

    /// The result, farthest first.
    pub(crate) fn into_sorted(mut self) -> Vec<Far> {
        self.trim();
        self.items.sort_unstable_by(farther_first);
        self.items
    }
}

/// Towards which face of the cube around the center an item lies: the coordinate of the largest |xⱼ − cⱼ|, signed.
pub(crate) type Face = (usize, bool);

/// At most two of the farthest items per [`Face`]: without this, many near-copies of one far point fill a batch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TopByFace {
    faces: BTreeMap<Face, Vec<Far>>,
}

impl TopByFace {
    const PER_FACE: usize = 2;

    pub(crate) fn offer(&mut self, face: Face, far: Far) {
        let items = self.faces.entry(face).or_default();
        items.push(far);
        items.sort_unstable_by(farther_first);
        items.truncate(Self::PER_FACE);
    }

    pub(crate) fn merge(&mut self, other: TopByFace) {
        for (face, items) in other.faces {
            for far in items {
                self.offer(face, far);
            }
        }
    }

    /// All items with their faces.
    pub(crate) fn items(&self) -> impl Iterator<Item = (Face, Far)> {
        self.faces.iter().flat_map(|(&face, items)| items.iter().map(move |&far| (face, far)))
    }

    /// The `keep` farthest, farthest first.
    pub(crate) fn into_sorted(self, keep: usize) -> Vec<Far> {
        let mut top = Top::new(keep);
        for far in self.faces.into_values().flatten() {
            top.offer(far);
        }
        top.into_sorted()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fars(reaches: &[u32]) -> Vec<Far> {
        reaches.iter().enumerate().map(|(i, &r)| Far { id: i as u64, reach2: r.into() }).collect()
    }

    #[test]
    fn the_farthest_are_kept_in_any_order_of_offers() {
        let items = fars(&[3, 9, 9, 1, 4, 9, 2, 8, 8, 0]);
        let wanted: Vec<u64> = vec![1, 2, 5, 7];
        for turn in 0..items.len() {
            let mut first = Top::new(4);
            let mut second = Top::new(4);
            for (k, &far) in items[turn..].iter().chain(&items[..turn]).enumerate() {
                if k % 3 == 0 { first.offer(far) } else { second.offer(far) }
            }
            first.merge(second);
            assert_eq!(first.bound(), 8.0);
            assert_eq!(first.into_sorted().iter().map(|f| f.id).collect::<Vec<_>>(), wanted);
        }
    }

    #[test]
    fn fewer_items_than_places_are_all_kept() {
        let mut top = Top::new(10);
        fars(&[1, 3, 2]).into_iter().for_each(|far| top.offer(far));
        assert_eq!(top.bound(), 0.0);
        assert_eq!(top.into_sorted().iter().map(|f| f.id).collect::<Vec<_>>(), [1, 2, 0]);
    }

    #[test]
    fn one_face_gives_at_most_two() {
        let mut top = TopByFace::default();
        for far in fars(&[7, 7, 7, 7]) {
            top.offer((0, true), far);
        }
        top.offer((1, false), Far { id: 9, reach2: 1.0 });
        assert_eq!(top.into_sorted(10).iter().map(|f| f.id).collect::<Vec<_>>(), [0, 1, 9]);
    }
}
