//! Which decisions of a search a dead end rests on, so that it can go back to the last of these at once.

/// A set of levels, from 1; level 0 stands for what is decided before the first decision, and is never in it.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels {
    words: Vec<u64>,
}

impl Levels {
    pub(super) fn insert(&mut self, level: u32) {
        if level > 0 {
            let word = level as usize / 64;
            if self.words.len() <= word {
                self.words.resize(word + 1, 0);
            }
            self.words[word] |= 1 << (level % 64);
        }
    }

    pub(super) fn remove(&mut self, level: u32) {
        if let Some(word) = self.words.get_mut(level as usize / 64) {
            *word &= !(1 << (level % 64));
        }
    }

    pub(super) fn contains(&self, level: u32) -> bool {
        self.words.get(level as usize / 64).is_some_and(|word| word >> (level % 64) & 1 == 1)
    }

    /// The last of the levels; 0 where there is none.
    pub(super) fn last(&self) -> u32 {
        let word = self.words.iter().rposition(|&word| word != 0);
        word.map_or(0, |at| at as u32 * 64 + self.words[at].ilog2())
    }

    pub(super) fn add_all(&mut self, other: &Levels) {
        if self.words.len() < other.words.len() {
            self.words.resize(other.words.len(), 0);
        }
        self.words.iter_mut().zip(&other.words).for_each(|(word, more)| *word |= more);
    }
}

#[cfg(test)]
mod tests {
    use super::Levels;

    #[test]
    fn sets_of_levels() {
        let (mut a, mut b) = (Levels::default(), Levels::default());
        [0, 1, 63, 64].into_iter().for_each(|level| a.insert(level));
        [2, 200].into_iter().for_each(|level| b.insert(level));
        a.add_all(&b);
        a.remove(63);
        a.remove(5000);
        let kept: Vec<u32> = (0..300).filter(|&level| a.contains(level)).collect();
        assert_eq!(kept, [1, 2, 64, 200]);
        assert_eq!((a.last(), Levels::default().last()), (200, 0));
        [1, 2, 64, 200].into_iter().for_each(|level| a.remove(level));
        assert_eq!(a.last(), 0);
    }
}
