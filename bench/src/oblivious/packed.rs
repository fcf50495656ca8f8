//! Ordered sets: the packed-memory array beside std's B-tree and the crate indexset.

use super::*;

/// The peers, in the tables.
const TREE: &str = "BTreeSet";
const INDEX: &str = "indexset";

/// All three sets, and what they cost.
struct Sets {
    packed: PackedSet<u64>,
    tree: BTreeSet<u64>,
    index: IndexSet<u64>,
    draw: Draw,
    /// Seconds per key of the three.
    rows: Vec<(&'static str, [f64; 3])>,
}

/// Insertions one by one, scans, ranges, look-ups, batches, and moves in four patterns.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(10_000_000, 100_000);
    let (packed, tree, index) = (PackedSet::new(), BTreeSet::new(), IndexSet::new());
    let mut sets = Sets { packed, tree, index, draw: Draw(1), rows: vec![] };
    sets.insert("insert, from empty", n);
    sets.insert("insert, at full size", n / 50);
    sets.agree()?;
    sets.read(context, n)?;
    sets.batches(n / 100)?;
    sets.agree()?;
    let mut table = Table::new(
        "work | taut, per key:ns | BTreeSet, per key:ns | indexset, per key:ns | BTreeSet ÷ \
            taut:x | indexset ÷ taut:x",
    );
    for (what, [packed, tree, index]) in &sets.rows {
        table.push(json!([what, packed, tree, index, tree / packed, index / packed]));
    }
    let slots = sets.packed.slots() as f64 / sets.packed.len() as f64;
    out.table(&format!("{n} u64; {} slots per key", times(slots)), table);
    let bound = 1.5 * (n as f64).log2().powi(2);
    let mut moves = Table::new("pattern | moves per insertion:x | 1.5 log² n:x");
    let patterns = hammered(n)?;
    for (name, each) in &patterns {
        moves.push(json!([name, each, bound]));
    }
    out.table("", moves);
    for (what, bounds) in [
        ("full scan", 20.0.into()),
        ("batches", [5.0, 8.0].into()),
        ("insert, from empty", [1.0, 1.5].into()),
        ("ranges of 1000", Bounds::from(10.0)),
    ] {
        let row = sets.rows.iter().find(|row| row.0 == what);
        let ratio = row.map(|(_, [packed, tree, _])| tree / packed);
        out.at_least(format!("{what}: BTreeSet over taut"), ratio, bounds, Unit::Times);
    }
    let worst = patterns.iter().map(|pattern| pattern.1).fold(0.0, f64::max);
    out.at_most("moves per insertion, worst pattern", worst, bound, Unit::Times);
    Ok(())
}

impl Sets {
    /// New random keys one by one, in twenty stretches by turns.
    fn insert(&mut self, what: &'static str, n: usize) {
        let keys = self.draw.words(n);
        let [mut packed, mut tree, mut index] = [0.0; 3];
        for stretch in keys.chunks(n.div_ceil(20)) {
            packed += seconds(|| insert(stretch, |key| self.packed.insert(key)));
            tree += seconds(|| insert(stretch, |key| self.tree.insert(key)));
            index += seconds(|| insert(stretch, |key| self.index.insert(key)));
        }
        self.rows.push((what, [packed, tree, index].map(|seconds| seconds / n as f64)));
    }

    /// Batches, which the tree takes by `extend`; indexset takes none.
    fn batches(&mut self, n: usize) -> Result<()> {
        let [mut packed, mut tree, mut index] = [0.0; 3];
        for _ in 0..6 {
            let keys = self.draw.words(n);
            let mut new = 0;
            packed += seconds(|| new = self.packed.insert_batch(&keys));
            let before = self.tree.len();
            tree += seconds(|| self.tree.extend(keys.iter().copied()));
            index += seconds(|| insert(&keys, |key| self.index.insert(key)));
            ensure!(new == self.tree.len() - before, "a batch has another number of new keys");
        }
        let each = [packed, tree, index].map(|seconds| seconds / (6 * n) as f64);
        self.rows.push(("batches", each));
        Ok(())
    }

    /// What does not change them; sums of keys, and numbers of those found, must be the same.
    fn read(&mut self, context: &Context, n: usize) -> Result<()> {
        let starts: Vec<u64> = self.draw.words(2000.min(n)).iter().map(|word| word >> 1).collect();
        let wanted = self.draw.words(n / 50);
        let (packed, tree, index) = (&self.packed, &self.tree, &self.index);
        let [mut scans, mut ranges, mut finds]: [Lanes; 3] = Default::default();
        let (add, from) = (u64::wrapping_add, |&from: &u64| from..);
        for _ in 0..context.runs {
            let ours = scans.time("taut", || packed.iter().fold(0, add));
            let theirs = [
                scans.time(TREE, || tree.iter().copied().fold(0, add)),
                scans.time(INDEX, || index.iter().copied().fold(0, add)),
            ];
            ensure!(theirs == [ours; 2], "scans differ");
            let ours = ranges.time("taut", || {
                starts.iter().map(from).fold(0, |s, r| packed.range(r).take(1000).fold(s, add))
            });
            let theirs = [
                ranges.time(TREE, || {
                    let each = |s, r| tree.range(r).take(1000).copied().fold(s, add);
                    starts.iter().map(from).fold(0, each)
                }),
                ranges.time(INDEX, || {
                    let each = |s, r| index.range(r).take(1000).copied().fold(s, add);
                    starts.iter().map(from).fold(0, each)
                }),
            ];
            ensure!(theirs == [ours; 2], "ranges differ");
            let ours =
                finds.time("taut", || wanted.iter().filter(|&&key| packed.contains(key)).count());
            let theirs = [
                finds.time(TREE, || wanted.iter().filter(|&key| tree.contains(key)).count()),
                finds.time(INDEX, || wanted.iter().filter(|&key| index.contains(key)).count()),
            ];
            ensure!(theirs == [ours; 2], "look-ups differ");
        }
        for (what, lanes, keys) in [
            ("full scan", scans, packed.len()),
            ("ranges of 1000", ranges, 1000 * starts.len()),
            ("look-ups", finds, wanted.len()),
        ] {
            self.rows.push((what, ["taut", TREE, INDEX].map(|name| lanes.of(name) / keys as f64)));
        }
        Ok(())
    }

    /// The same keys, and all densities within bounds.
    fn agree(&self) -> Result<()> {
        ensure!(self.packed.check().is_ok(), "a density is out of bounds");
        ensure!(self.packed.iter().eq(self.tree.iter().copied()), "the sets differ");
        ensure!(self.packed.iter().eq(self.index.iter().copied()), "indexset: another set");
        Ok(())
    }
}

/// The key of an insertion, from the middle of all keys and its number.
type Keys = fn(u64, u64) -> u64;

/// Moves per insertion: falling keys from empty, then falling, rising and in two places by turns amid random ones.
fn hammered(n: usize) -> Result<[(&'static str, f64); 4]> {
    let random = Draw(1).words(n / 2);
    let middle = 1 << 62;
    let patterns: [(&str, Keys); 4] = [
        ("falling, from empty", |_, i| u64::MAX / 2 - i),
        ("falling, in the middle", |middle, i| middle - i),
        ("rising, in the middle", |middle, i| middle + i),
        ("two places by turns", |middle, i| if i % 2 == 0 { middle + i } else { 3 * middle - i }),
    ];
    let mut found = [("", f64::NAN); 4];
    for (at, (name, key)) in patterns.into_iter().enumerate() {
        let mut set = PackedSet::new();
        if at > 0 {
            set.insert_batch(&random);
        }
        let (before, keys) = (set.moves(), (n - set.len()) as u64);
        for i in 0..keys {
            set.insert(key(middle, i));
        }
        ensure!(set.check().is_ok(), "{name}: a density is out of bounds");
        found[at] = (name, (set.moves() - before) as f64 / keys as f64);
    }
    Ok(found)
}

/// One by one.
fn insert(keys: &[u64], mut one: impl FnMut(u64) -> bool) {
    for &key in keys {
        one(key);
    }
}

/// Processor time of this thread.
fn seconds(work: impl FnOnce()) -> f64 {
    let start = thread_cpu();
    work();
    thread_cpu() - start
}
