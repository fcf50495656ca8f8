//! Which of the discs with one point hold each other point.
//!
//! *Idea.* The discs stand side by side: for each point that any of them holds, a bit for each disc. To find the discs that hold none of some points, or
//! how many of them each disc holds, then takes a few operations for 64 discs at once; counts are sums of bits with one word for each binary digit.
//! *Growth.* Discs may be taken away, others come, and new points are held by old discs: a table is brought up to date by what is new.
//! *Cost.* Points asked for × discs / 64. A table takes a bit for each disc and each point near by.
//! *Evidence.* 15,112 cities, 20 centers, gap 2 %: a point is in 900 discs. Beside a look at the set of each disc, the whole search took
//! 0.7 times as long; to make all of a table again whenever a point near by came was a sixth of it.

use super::item_set::ItemSet;
use super::transpose::transpose;

/// Discs of which a word has a bit each.
const SIDE_BY_SIDE: usize = u64::BITS as usize;
/// Words that are added up together.
const BLOCK: usize = 4;
/// Binary digits of a count of points: sets have fewer than 2¹² of them.
const DIGITS: usize = 12;

/// Some of the discs of a table, by their place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct DiscSet(Vec<u64>);

impl DiscSet {
    fn insert(&mut self, at: usize) {
        self.0[at / SIDE_BY_SIDE] |= 1 << (at % SIDE_BY_SIDE);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|&word| word == 0)
    }

    pub(super) fn len(&self) -> u32 {
        self.0.iter().map(|word| word.count_ones()).sum()
    }

    pub(super) fn intersection(&self, other: &Self) -> Self {
        DiscSet(self.0.iter().zip(&other.0).map(|(a, b)| a & b).collect())
    }

    pub(super) fn remove_all(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a &= !b);
    }

    fn last(&self) -> Option<usize> {
        let at = self.0.iter().rposition(|&word| word != 0)?;
        Some(SIDE_BY_SIDE * at + self.0[at].ilog2() as usize)
    }
}

/// The discs with one point.
#[derive(Clone, Debug)]
pub(super) struct DiscTable<const WORDS: usize> {
    /// The numbers of the discs, growing; some may be gone.
    discs: Vec<u32>,
    /// Those that are not gone.
    all: DiscSet,
    /// The points that any of them holds.
    near: ItemSet<WORDS>,
    /// For each of these points, in the order in which they came, the discs that hold it: `words` words each.
    holders: Vec<u64>,
    words: usize,
    /// For each of these points, how many came before it; of others it says nothing.
    rows: Vec<u16>,
}

impl<const WORDS: usize> DiscTable<WORDS> {
    const COUNTS_FIT: () = assert!(ItemSet::<WORDS>::ITEMS_MAX < 1 << DIGITS);

    /// An empty table with room for so many discs of so many points.
    pub(super) fn with_room(discs: usize, points: usize) -> Self {
        let words = discs.div_ceil(SIDE_BY_SIDE);
        DiscTable {
            discs: vec![],
            all: DiscSet(vec![0; words]),
            near: ItemSet::default(),
            holders: vec![],
            words,
            rows: vec![0; points],
        }
    }

    /// Learns which discs there are now, by their growing numbers, of so many points. What a disc held, it still holds; it may hold new
    /// points, too.
    pub(super) fn update<'d>(
        &mut self,
        numbers: &[u32],
        points: usize,
        held: impl Fn(u32) -> &'d ItemSet<WORDS>,
    ) {
        let last = self.discs.last().copied();
        let first_new = numbers.partition_point(|&number| Some(number) <= last);
        let (old, new) = numbers.split_at(first_new);
        let is_full = self.discs.len() + new.len() > SIDE_BY_SIDE * self.words;
        if is_full || old.len() < self.discs.len() / 2 {
            // Some of it is for discs that come later.
            *self = DiscTable::with_room(numbers.len() + numbers.len() / 8, points);
            self.add_all(numbers, held);
            return;
        }
        let new_points = self.rows.len() as u32..points as u32;
        self.rows.resize(points, 0);
        self.all.0.fill(0);
        let mut at = 0;
        for &number in old {
            while self.discs[at] != number {
                at += 1;
            }
            self.all.insert(at);
            let held = held(number);
            new_points
                .clone()
                .filter(|&item| held.contains(item))
                .for_each(|item| self.insert(item, at));
        }
        self.add_all(new, held);
    }

    /// Takes more discs, by their numbers, where there is room for them: those of one word at once.
    pub(super) fn add_all<'d>(
        &mut self,
        mut numbers: &[u32],
        held: impl Fn(u32) -> &'d ItemSet<WORDS>,
    ) {
        while !numbers.is_empty() {
            let first = self.discs.len();
            let offset = first % SIDE_BY_SIDE;
            let (some, rest) = numbers.split_at(numbers.len().min(SIDE_BY_SIDE - offset));
            for word in 0..WORDS {
                let mut bits = [0; SIDE_BY_SIDE];
                for (bits, &number) in bits[offset..].iter_mut().zip(some) {
                    *bits = held(number).word(word);
                }
                if bits == [0; SIDE_BY_SIDE] {
                    continue;
                }
                transpose(&mut bits);
                for (item, &discs) in bits.iter().enumerate().filter(|&(_, &discs)| discs != 0) {
                    let from = self.row_or_new((SIDE_BY_SIDE * word + item) as u32);
                    self.holders[from + first / SIDE_BY_SIDE] |= discs;
                }
            }
            (first..first + some.len()).for_each(|at| self.all.insert(at));
            self.discs.extend_from_slice(some);
            numbers = rest;
        }
    }

    /// Takes one disc more, where there is room for it.
    pub(super) fn add(&mut self, number: u32, held: &ItemSet<WORDS>) {
        let at = self.discs.len();
        self.discs.push(number);
        self.all.insert(at);
        held.items().for_each(|item| self.insert(item, at));
    }

    /// Notes that a disc holds a point.
    fn insert(&mut self, item: u32, disc: usize) {
        let from = self.row_or_new(item);
        self.holders[from + disc / SIDE_BY_SIDE] |= 1 << (disc % SIDE_BY_SIDE);
    }

    /// Where the discs that hold a point begin; a point that none has held yet gets a row of its own, the last.
    fn row_or_new(&mut self, item: u32) -> usize {
        if !self.near.contains(item) {
            self.rows[item as usize] = self.near.len() as u16;
            self.near.insert(item);
            self.holders.resize(self.holders.len() + self.words, 0);
        }
        self.words * usize::from(self.rows[item as usize])
    }

    /// The discs that hold a point, which must be one of those that any of them holds.
    fn row(&self, item: u32) -> &[u64] {
        &self.holders[self.words * usize::from(self.rows[item as usize])..][..self.words]
    }

    /// All discs.
    pub(super) fn all(&self) -> &DiscSet {
        &self.all
    }

    /// The discs that hold none of these points.
    pub(super) fn without(&self, items: &ItemSet<WORDS>) -> DiscSet {
        let mut discs = self.all.clone();
        for item in items.intersection(&self.near).items() {
            discs.0.iter_mut().zip(self.row(item)).for_each(|(disc, held)| *disc &= !held);
        }
        discs
    }

    /// Tests whether there is a disc that holds all of these points.
    pub(super) fn has_one_with(&self, items: &ItemSet<WORDS>) -> bool {
        let mut discs = self.all.clone();
        for item in items.items() {
            if !self.near.contains(item) {
                return false;
            }
            discs.0.iter_mut().zip(self.row(item)).for_each(|(disc, held)| *disc &= held);
        }
        !discs.is_empty()
    }

    /// How many of these points each disc holds.
    pub(super) fn counts(&self, items: &ItemSet<WORDS>) -> Counts {
        let () = Self::COUNTS_FIT;
        let words = self.words;
        let items: Vec<u32> = items.intersection(&self.near).items().collect();
        let mut digits =
            vec![vec![0; words]; (items.len() + 1).next_power_of_two().ilog2() as usize];
        for from in (0..words).step_by(BLOCK) {
            let to = words.min(from + BLOCK);
            let mut sum = BitSum::default();
            for &item in &items {
                let mut block = [0; BLOCK];
                block[..to - from].copy_from_slice(&self.row(item)[from..to]);
                sum.add(block);
            }
            for (digit, sum) in digits.iter_mut().zip(sum.finish()) {
                digit[from..to].copy_from_slice(&sum[..to - from]);
            }
        }
        Counts { digits: digits.into_iter().map(DiscSet).collect() }
    }

    /// Of some discs the number of the one with the greatest count, the last of these.
    pub(super) fn fullest(&self, discs: &DiscSet, counts: &Counts) -> Option<u32> {
        let mut best = discs.clone();
        for digit in counts.digits.iter().rev() {
            let some = best.intersection(digit);
            if !some.is_empty() {
                best = some;
            }
        }
        best.last().map(|at| self.discs[at])
    }
}

/// A count for each disc: the discs with each binary digit, the lowest first.
#[derive(Clone, Debug)]
pub(super) struct Counts {
    digits: Vec<DiscSet>,
}

type Block = [u64; BLOCK];

/// Sums of many words, bit by bit: each full adder makes one word of twice the weight of three.
#[derive(Default)]
struct BitSum {
    sums: [Block; DIGITS],
    /// Words that wait for another one of the same weight, where the binary digit of `added` is 1.
    waiting: [Block; DIGITS],
    added: usize,
}

impl BitSum {
    fn add(&mut self, mut word: Block) {
        for weight in 0..DIGITS {
            if self.added >> weight & 1 == 0 {
                self.waiting[weight] = word;
                break;
            }
            word = full_adder(&mut self.sums[weight], &self.waiting[weight], &word);
        }
        self.added += 1;
    }

    fn finish(mut self) -> [Block; DIGITS] {
        let mut carry = [0; BLOCK];
        for weight in 0..DIGITS {
            let waiting =
                if self.added >> weight & 1 == 1 { self.waiting[weight] } else { [0; BLOCK] };
            carry = full_adder(&mut self.sums[weight], &waiting, &carry);
        }
        self.sums
    }
}

/// Adds three words bit by bit: the first becomes the sum, and the carry is returned.
fn full_adder(sum: &mut Block, b: &Block, c: &Block) -> Block {
    let mut carry = [0; BLOCK];
    for at in 0..BLOCK {
        let (a, b, c) = (sum[at], b[at], c[at]);
        sum[at] = a ^ b ^ c;
        carry[at] = (a & b) | (c & (a ^ b));
    }
    carry
}

#[cfg(test)]
mod tests {
    use super::super::discs::Discs;
    use super::*;

    /// Tables of growing discs, brought up to date now and then, say what a look at each disc does.
    #[test]
    fn tables_are_as_the_sets_of_their_discs() {
        let mut state = 11u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        let mut discs = Discs::<4>::new(1.0, std::iter::empty());
        let (mut most, mut gone) = (0, 0);
        for count in 1..=200 {
            discs.add([5.0 * draw(), 3.0 * draw()]);
            for _ in 0..4 {
                let point = (draw() * f64::from(count)) as u32;
                discs.update_table(point);
                let table = discs.table(point);
                let of = discs.of(point);
                let at =
                    |number: u32| table.discs.iter().position(|&other| other == number).unwrap();
                let set = |numbers: &[u32]| {
                    let mut set = DiscSet(vec![0; table.words]);
                    numbers.iter().for_each(|&number| set.insert(at(number)));
                    set
                };
                assert_eq!(*table.all(), set(of));
                let items: ItemSet<4> = (0..count).filter(|_| draw() < 0.1).collect();
                let holds_none = |&number: &u32| discs.disc(number).held.is_disjoint(&items);
                let without: Vec<u32> = of.iter().copied().filter(holds_none).collect();
                assert_eq!(table.without(&items), set(&without));
                let some: Vec<u32> = of.iter().copied().filter(|_| draw() < 0.5).collect();
                let holds = |&number: &u32| discs.disc(number).held.intersection(&items).len();
                let fullest = some.iter().copied().max_by_key(|number| (holds(number), *number));
                assert_eq!(table.fullest(&set(&some), &table.counts(&items)), fullest);
                assert_eq!(set(&some).len() as usize, some.len());
                let holds_all = |&number: &u32| items.without(&discs.disc(number).held).is_empty();
                let few: ItemSet<4> = items.items().take(2).collect();
                let holds_few = |&number: &u32| few.without(&discs.disc(number).held).is_empty();
                assert_eq!(table.has_one_with(&items), of.iter().any(holds_all));
                assert_eq!(table.has_one_with(&few), of.iter().any(holds_few));
                (most, gone) = (most.max(of.len()), gone + table.discs.len() - of.len());
            }
        }
        // More than a word of discs, and some that are gone.
        assert!(most > 128 && gone > 100, "{most} {gone}");
    }

    /// Discs taken at once, from any place of a word and over several words, are as one after the other.
    #[test]
    fn discs_at_once_are_as_one_by_one() {
        let mut state = 5u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 40) as u32
        };
        let held: Vec<ItemSet<4>> =
            (0..300).map(|_| (0..250).filter(|_| draw() % 20 == 0).collect()).collect();
        for (before, count) in [(0, 1), (1, 62), (1, 63), (1, 64), (63, 130), (64, 64), (65, 200)] {
            let mut one_by_one = DiscTable::with_room(300, 250);
            (0..before + count).for_each(|at| one_by_one.add(at, &held[at as usize]));
            let mut at_once = DiscTable::with_room(300, 250);
            (0..before).for_each(|at| at_once.add(at, &held[at as usize]));
            let numbers: Vec<u32> = (before..before + count).collect();
            at_once.add_all(&numbers, |at| &held[at as usize]);
            assert_eq!((&at_once.discs, &at_once.all), (&one_by_one.discs, &one_by_one.all));
            assert_eq!(at_once.near, one_by_one.near);
            for item in at_once.near.items() {
                assert_eq!(at_once.row(item), one_by_one.row(item), "{before}, {count}, {item}");
            }
        }
    }

    /// Sums of up to 2048 words of few and of many ones are those of their bits.
    #[test]
    fn sums_of_bits_are_counts() {
        let mut state = 1u64;
        for count in [0, 1, 2, 3, 4, 7, 8, 64, 1000, 2048] {
            let (mut sum, mut expected) = (BitSum::default(), [[0; SIDE_BY_SIDE]; BLOCK]);
            for _ in 0..count {
                let mut block = [0; BLOCK];
                for (word, counts) in block.iter_mut().zip(&mut expected) {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
                    *word = (state >> 7) | 1;
                    counts.iter_mut().enumerate().for_each(|(at, sum)| *sum += *word >> at & 1);
                }
                sum.add(block);
            }
            let digits = sum.finish();
            for (at, counts) in expected.iter().enumerate() {
                for (bit, &expected) in counts.iter().enumerate() {
                    let value = |digit: usize| (digits[digit][at] >> bit & 1) << digit;
                    assert_eq!((0..DIGITS).map(value).sum::<u64>(), expected);
                }
            }
        }
    }
}
