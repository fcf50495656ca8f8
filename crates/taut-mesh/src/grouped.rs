//! Things grouped by small numbers.
//!
//! *Idea.* Count how many there are of each number, then put each in its place: few things share a number, and what is sorted within
//! a group takes no time, where one sort of everything would take most of it.
//! *Guarantee.* O(n + things); within a group, things are in the order in which they came.

pub(crate) struct Grouped<T> {
    pub(crate) all: Vec<T>,
    /// Where each group ends.
    ends: Vec<u32>,
}

impl<T: Copy> Grouped<T> {
    /// The things by their numbers below n; they are gone through twice.
    pub(crate) fn of<I: Iterator<Item = (u32, T)>>(n: usize, things: impl Fn() -> I) -> Self {
        let mut ends = vec![0u32; n + 1];
        let mut any = None;
        for (number, thing) in things() {
            ends[number as usize + 1] += 1;
            any = Some(thing);
        }
        for k in 1..ends.len() {
            ends[k] += ends[k - 1];
        }
        // Each beginning moves on to the end of its group.
        let mut all = any.map_or(Vec::new(), |thing| vec![thing; ends[n] as usize]);
        for (number, thing) in things() {
            let place = &mut ends[number as usize];
            all[*place as usize] = thing;
            *place += 1;
        }
        ends.truncate(n);
        Self { all, ends }
    }

    /// The groups that are not empty, with their numbers.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (usize, &[T])> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        let groups =
            begins.zip(&self.ends).map(|(begin, &end)| &self.all[begin as usize..end as usize]);
        groups.enumerate().filter(|(_, group)| !group.is_empty())
    }

    pub(crate) fn groups_mut(&mut self, mut change: impl FnMut(&mut [T])) {
        let mut begin = 0;
        for &end in &self.ends {
            change(&mut self.all[begin as usize..end as usize]);
            begin = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keep_the_order_of_things() {
        let things = [(3, 'a'), (0, 'b'), (3, 'c'), (1, 'd')];
        let mut grouped = Grouped::of(5, || things.iter().copied());
        let groups: Vec<_> = grouped.groups().map(|(n, group)| (n, group.to_vec())).collect();
        assert_eq!(groups, [(0, vec!['b']), (1, vec!['d']), (3, vec!['a', 'c'])]);
        grouped.groups_mut(<[char]>::reverse);
        assert_eq!(grouped.all, ['b', 'd', 'c', 'a']);
        assert!(Grouped::<u8>::of(0, std::iter::empty).all.is_empty());
    }
}
