//! Which of the discs with one point hold each other point.
//!
//! *Idea.* The discs stand side by side: for each point that any of them holds, a bit for each disc. What holds nothing of some points, and how many of
//! some points each disc holds, then takes a few operations for 64 discs at once; counts are sums of bits with one word for each binary digit.
//! *Cost.* Points asked for × discs / 64.
//! *Evidence.* 15,112 cities, 20 centers, gap 2 %: a point is in 900 discs. FIGURES

use super::discs::Disc;
use super::item_set::ItemSet;

/// Discs of which a word has a bit each.
const SIDE_BY_SIDE: usize = u64::BITS as usize;
/// Words that are added up together.
const BLOCK: usize = 4;
/// Binary digits of a count of points.
const DIGITS: usize = 12;

/// Some of the discs of a table, by their place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct DiscSet(Vec<u64>);

impl DiscSet {
    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|&word| word == 0)
    }

    pub(super) fn len(&self) -> u32 {
        self.0.iter().map(|word| word.count_ones()).sum()
    }

    pub(super) fn is_subset(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a & !b == 0)
    }

    pub(super) fn intersection(&self, other: &Self) -> Self {
        DiscSet(self.0.iter().zip(&other.0).map(|(a, b)| a & b).collect())
    }

    pub(super) fn remove_all(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a &= !b);
    }

    pub(super) fn add_all(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a |= b);
    }

    fn last(&self) -> Option<usize> {
        let at = self.0.iter().rposition(|&word| word != 0)?;
        Some(SIDE_BY_SIDE * at + self.0[at].ilog2() as usize)
    }
}

/// The discs with one point.
#[derive(Clone, Debug)]
pub(super) struct DiscTable<const WORDS: usize> {
    /// Their numbers, growing.
    discs: Vec<u32>,
    /// The points that any of them holds.
    near: ItemSet<WORDS>,
    /// For each of these points, by number, the discs that hold it.
    holders: Vec<u64>,
    /// For each of all points, how many of these come before it.
    rows: Vec<u16>,
}

impl<const WORDS: usize> DiscTable<WORDS> {
    /// The table of discs with these numbers.
    pub(super) fn new<'d>(numbers: &[u32], disc: impl Fn(u32) -> &'d Disc<WORDS>) -> Self {
        let mut near = ItemSet::default();
        numbers.iter().for_each(|&number| near.add_all(&disc(number).held));
        let words = numbers.len().div_ceil(SIDE_BY_SIDE);
        let mut rows = vec![0; ItemSet::<WORDS>::ITEMS_MAX];
        near.items().zip(0..).for_each(|(item, row)| rows[item as usize] = row);
        let mut holders = vec![0; near.len() as usize * words];
        for (at, &number) in numbers.iter().enumerate() {
            for item in disc(number).held.items() {
                let row = usize::from(rows[item as usize]);
                holders[row * words + at / SIDE_BY_SIDE] |= 1 << (at % SIDE_BY_SIDE);
            }
        }
        DiscTable { discs: numbers.to_vec(), near, holders, rows }
    }

    fn words(&self) -> usize {
        self.discs.len().div_ceil(SIDE_BY_SIDE)
    }

    /// The discs that hold a point that any of them holds.
    fn row(&self, item: u32) -> &[u64] {
        let words = self.words();
        &self.holders[usize::from(self.rows[item as usize]) * words..][..words]
    }

    /// All discs.
    pub(super) fn all(&self) -> DiscSet {
        let mut all = DiscSet(vec![u64::MAX; self.words()]);
        let rest = self.discs.len() % SIDE_BY_SIDE;
        if let (Some(last), true) = (all.0.last_mut(), rest > 0) {
            *last >>= SIDE_BY_SIDE - rest;
        }
        all
    }

    /// The discs that hold none of these points.
    pub(super) fn without(&self, items: &ItemSet<WORDS>) -> DiscSet {
        let mut discs = self.all();
        for item in items.intersection(&self.near).items() {
            discs.0.iter_mut().zip(self.row(item)).for_each(|(disc, held)| *disc &= !held);
        }
        discs
    }

    /// How many of these points each disc holds.
    pub(super) fn counts(&self, items: &ItemSet<WORDS>) -> Counts {
        let words = self.words();
        let items: Vec<u32> = items.intersection(&self.near).items().collect();
        let mut digits = vec![vec![0; words]; (items.len() + 1).next_power_of_two().ilog2() as usize];
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
