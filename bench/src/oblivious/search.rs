//! Lower bounds among sorted keys, in all layouts.

use super::*;
#[cfg(target_os = "linux")]
use memmap2::Advice;

/// Independent look-ups one by one, in a batch, and dependent ones.
struct Names {
    single: &'static str,
    batch: &'static str,
    dependent: &'static str,
}

/// std's binary search; its keys on pages of 4 KiB and on those of 2 MiB.
const STD: Names = Names { single: "std", batch: "", dependent: "std, dependent" };
const STD_HUGE: Names =
    Names { single: "std, huge pages", batch: "", dependent: "std, huge pages, dependent" };

/// What is asked, and what the answers are.
struct Queries {
    keys: Vec<u64>,
    ranks: Vec<usize>,
    /// The ranks if the last bit of each key is turned where the rank before was odd.
    chained: Vec<usize>,
}

/// Of each layout the ratio to std.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (n, asked) = context.size((1 << 24, 1 << 20), (1 << 16, 1 << 14));
    let mut keys = Draw(1).words(n);
    taut_oblivious::sort(&mut keys);
    ensure!(keys.is_sorted(), "the keys are not in order");
    let huge = on_huge_pages(&keys)?;
    let huge: &[u64] = bytemuck::cast_slice(&huge);
    let queries = Queries::draw(&keys, asked);
    let sorted = Sorted::new(&keys)?;
    let eytzinger = Eytzinger::new(&keys)?;
    let veb = VebTree::new(&keys)?;
    let blocked = BlockedVanEmdeBoas::new(&keys)?;
    let splus = SPlusTree::new(&keys)?;
    let layouts = [
        Names { single: "sorted", batch: "sorted, batch", dependent: "sorted, dependent" },
        Names { single: "Eytzinger", batch: "Eytzinger, batch", dependent: "Eytzinger, dependent" },
        Names { single: "vEB", batch: "", dependent: "vEB, dependent" },
        Names { single: "blocked", batch: "blocked, batch", dependent: "blocked, dependent" },
        Names { single: "S+ tree", batch: "S+ tree, batch", dependent: "S+ tree, dependent" },
    ];
    let mut lanes = Lanes::default();
    for _ in 0..context.runs {
        queries.ask(&mut lanes, &STD, |key| binary_search(&keys, key))?;
        queries.ask(&mut lanes, &STD_HUGE, |key| binary_search(huge, key))?;
        queries.ask_index(&mut lanes, &layouts[0], &sorted)?;
        queries.ask_index(&mut lanes, &layouts[1], &eytzinger)?;
        queries.ask(&mut lanes, &layouts[2], |key| veb.lower_bound(key))?;
        queries.ask_index(&mut lanes, &layouts[3], &blocked)?;
        queries.ask_index(&mut lanes, &layouts[4], &splus)?;
    }
    show(out, n, asked, &lanes, &layouts);
    Ok(())
}

/// The table and goals.
fn show(out: &mut Outcome, n: usize, asked: usize, lanes: &Lanes, layouts: &[Names]) {
    let each = |name: &str| lanes.of(name) / asked as f64;
    let mut table = Table::new(
        "layout | one by one:ns | batch:ns | std ÷ batch:x | std on huge pages ÷ batch:x | \
            dependent:ns | dependent ÷ std:x",
    );
    for names in [&STD, &STD_HUGE].into_iter().chain(layouts) {
        table.push(json!({
            "layout": names.single, "one by one": each(names.single), "batch": each(names.batch),
            "std ÷ batch": lanes.faster(names.batch, STD.single),
            "std on huge pages ÷ batch": lanes.faster(names.batch, STD_HUGE.single),
            "dependent": each(names.dependent),
            "dependent ÷ std": lanes.faster(STD.dependent, names.dependent),
        }));
    }
    out.table(&format!("{n} keys, {asked} look-ups"), table);
    out.keep("lanes", lanes.json(asked));
    let batch = lanes.faster("S+ tree, batch", STD.single);
    out.at_least("batches: std over taut", batch, [30.0, 40.0], Unit::Times);
    let dependent = lanes.faster(STD.dependent, "S+ tree, dependent");
    out.at_most("dependent look-ups over std's", dependent, 0.4, Unit::Times);
}

fn binary_search(keys: &[u64], key: u64) -> usize {
    keys.binary_search(&key).unwrap_or_else(|rank| rank)
}

/// A copy of the keys that asked for pages of 2 MiB before it was written, as the indices of taut do.
fn on_huge_pages(keys: &[u64]) -> Result<MmapMut> {
    let mut pages = MmapMut::map_anon(size_of_val(keys))?;
    #[cfg(target_os = "linux")]
    pages.advise(Advice::HugePage)?;
    bytemuck::cast_slice_mut(&mut pages).copy_from_slice(keys);
    Ok(pages)
}

impl Queries {
    /// Random keys; the ranks are those by halving, which is independent of all that is timed.
    fn draw(sorted: &[u64], asked: usize) -> Self {
        let keys = Draw(2).words(asked);
        let rank = |key: u64| sorted.partition_point(|&other| other < key);
        let ranks = keys.iter().map(|&key| rank(key)).collect();
        let mut before = 0;
        let chained = keys.iter().map(|&key| {
            before = rank(key ^ (before as u64 & 1));
            before
        });
        let chained = chained.collect();
        Queries { keys, ranks, chained }
    }

    /// One by one, then each key depending on the rank before it. Keys are distinct, so that an exact hit has one rank.
    fn ask(&self, lanes: &mut Lanes, names: &Names, rank: impl Fn(u64) -> usize) -> Result<()> {
        let mut found = Vec::with_capacity(self.keys.len());
        lanes.time(names.single, || found.extend(self.keys.iter().map(|&key| rank(key))));
        ensure!(found == self.ranks, "{}: a wrong rank", names.single);
        found.clear();
        lanes.time(names.dependent, || {
            let mut before = 0;
            for &key in &self.keys {
                before = rank(key ^ (before as u64 & 1));
                found.push(before);
            }
        });
        ensure!(found == self.chained, "{}: a wrong rank", names.dependent);
        Ok(())
    }

    /// The same, and a batch.
    fn ask_index(
        &self,
        lanes: &mut Lanes,
        names: &Names,
        index: &impl SortedIndex<u64>,
    ) -> Result<()> {
        self.ask(lanes, names, |key| index.lower_bound(key))?;
        let mut found = Vec::with_capacity(self.keys.len());
        lanes.time(names.batch, || index.lower_bounds(&self.keys, &mut found));
        ensure!(found == self.ranks, "{}: a wrong rank", names.batch);
        Ok(())
    }
}
