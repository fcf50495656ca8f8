//! A node of the search: which item of X is in which cluster, and what that leaves open.
//!
//! *Idea.* A cluster is the set of rows that have all its items within the radius; it is not feasible when that is
//! empty, and holds an item for good when all of these rows have it. For each cluster a column counts, for each item, how many
//! of its rows have that item, too.
//! *Branching.* The item with the fewest places to go (Brélaz 1979, DSATUR), among equals the one that would leave
//! its clusters the fewest rows.

use super::core_set::{CoreSet, Words, size};

/// At the root, sets of items apart are sought from this many starts, divided by |X|: from every item while X is small.
const ROOT_TESTS: usize = 1 << 16;

/// Items that some row has within the radius.
pub(super) struct Cluster {
    /// The rows that have them all.
    pub(super) words: Words,
    /// How many.
    size: u32,
    /// For each item of X, how many of these have it, too; may be shorter than X.
    column: Vec<u32>,
}

/// A node.
pub(super) struct State {
    k: usize,
    outliers: usize,
    pub(super) clusters: Vec<Cluster>,
    /// For each item, whether it was given to a cluster or left out; may be shorter than X.
    given: Vec<bool>,
    pub(super) left_out: Vec<usize>,
    /// Items to branch on first, of which no two fit in one ball.
    lead: Vec<usize>,
}

/// Where an item of a node may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Child {
    /// To a cluster that has items.
    Join(usize),
    /// To an empty one.
    Open,
    /// Nowhere.
    LeaveOut,
}

/// What a look at a node shows.
pub(super) enum Look {
    /// Every item is held for good, or left out.
    Covered,
    /// Branch on this item.
    Branch(usize),
    /// No way on: branching on these in turn shows it.
    Dead(Vec<usize>),
}

/// What [`State::enter`] changed.
pub(super) struct Undo(Option<Cluster>);

impl State {
    pub(super) fn new(k: usize, outliers: usize) -> Self {
        State { k, outliers, clusters: vec![], given: vec![], left_out: vec![], lead: vec![] }
    }

    /// Whether an item was given to a cluster or left out.
    fn is_given(&self, item: usize) -> bool {
        self.given.get(item).copied().unwrap_or(false)
    }

    /// Looks at the node; brings columns up to date with X.
    pub(super) fn look(&mut self, core: &CoreSet<'_>) -> Look {
        for cluster in &mut self.clusters {
            for item in cluster.column.len()..core.len() {
                cluster.column.push(core.count(&cluster.words, item));
            }
        }
        let empty = self.k - self.clusters.len();
        let spare = self.outliers - self.left_out.len();
        // Items that fit in no cluster that has items.
        let mut stray = vec![];
        let mut best: Option<(usize, bool, f64, usize)> = None;
        for item in (0..core.len()).filter(|&item| !self.is_given(item)) {
            let (mut places, mut room) = (0, f64::from(core.size(item)) / core.sites.len() as f64);
            let mut held = false;
            for cluster in &self.clusters {
                let count = cluster.column[item];
                held |= count == cluster.size;
                if count > 0 {
                    places += 1;
                    room += f64::from(count) / f64::from(cluster.size);
                }
            }
            if held {
                continue;
            }
            if places == 0 {
                stray.push(item);
            }
            // A ball of a radius may have no row that holds it.
            places += usize::from(empty > 0 && core.size(item) > 0) + usize::from(spare > 0);
            if places == 0 {
                return Look::Dead(vec![item]);
            }
            let key = (places, !self.lead.contains(&item), room, item);
            let less = |best: &(usize, bool, f64, usize)| {
                let order = (key.0, key.1).cmp(&(best.0, best.1));
                order.then(key.2.total_cmp(&best.2)).then(key.3.cmp(&best.3)).is_lt()
            };
            if best.as_ref().is_none_or(less) {
                best = Some(key);
            }
        }
        let Some((_, _, _, item)) = best else { return Look::Covered };
        if self.clusters.is_empty() && self.left_out.is_empty() {
            let enough = self.k + self.outliers;
            let apart = core.apart(&stray, ROOT_TESTS / stray.len().max(1) + 1, enough);
            if apart.len() > enough {
                return Look::Dead(apart);
            }
            self.lead = apart;
            return Look::Branch(self.lead.first().copied().unwrap_or(item));
        }
        match self.refute(core, stray, empty, spare) {
            Some(items) => Look::Dead(items),
            None => Look::Branch(item),
        }
    }

    /// Items that fit in no cluster that has items, and that so many empty clusters and outliers do not hold either.
    fn refute(
        &self,
        core: &CoreSet<'_>,
        stray: Vec<usize>,
        empty: usize,
        spare: usize,
    ) -> Option<Vec<usize>> {
        if empty == 0 {
            return (stray.len() > spare).then_some(stray);
        }
        if empty == 1 && spare == 0 && stray.len() > 1 {
            let mut words = core.words(stray[0]).clone();
            let last = stray.iter().skip(1).position(|&item| {
                words = core.common(&words, item);
                words.is_empty()
            });
            return last.map(|last| stray[..last + 2].to_vec());
        }
        if stray.len() <= empty + spare {
            return None;
        }
        let apart = core.apart(&stray, 1, empty + spare);
        (apart.len() > empty + spare).then_some(apart)
    }

    /// Where an item may go, in the order in which a proof takes them.
    pub(super) fn children(&self, core: &CoreSet<'_>, item: usize) -> Vec<Child> {
        let joins = (0..self.clusters.len())
            .filter(|&j| self.clusters[j].column[item] > 0)
            .map(Child::Join);
        let opens = self.clusters.len() < self.k && core.size(item) > 0;
        let opens = opens.then_some(Child::Open);
        let leaves = (self.left_out.len() < self.outliers).then_some(Child::LeaveOut);
        joins.chain(opens).chain(leaves).collect()
    }

    /// The same, the most promising first: where most rows of the cluster remain.
    pub(super) fn promising(&self, core: &CoreSet<'_>, item: usize) -> Vec<Child> {
        let mut children = self.children(core, item);
        let rest = |child: &Child| match child {
            Child::Join(j) => {
                let cluster = &self.clusters[*j];
                f64::from(cluster.column[item]) / f64::from(cluster.size)
            }
            Child::Open => 0.0,
            Child::LeaveOut => -1.0,
        };
        children.sort_by(|a, b| rest(b).total_cmp(&rest(a)));
        children
    }

    /// Goes to a child.
    pub(super) fn enter(&mut self, core: &CoreSet<'_>, item: usize, child: Child) -> Undo {
        self.given.resize(core.len(), false);
        self.given[item] = true;
        let mut old = None;
        match child {
            Child::Join(j) => {
                let words = core.common(&self.clusters[j].words, item);
                let cluster = self.cluster(core, words, Some(&self.clusters[j].column));
                old = Some(std::mem::replace(&mut self.clusters[j], cluster));
            }
            Child::Open => {
                let cluster = self.cluster(core, core.words(item).clone(), None);
                self.clusters.push(cluster);
            }
            Child::LeaveOut => self.left_out.push(item),
        }
        Undo(old)
    }

    /// Comes back from a child.
    pub(super) fn leave(&mut self, item: usize, child: Child, undo: Undo) {
        self.given[item] = false;
        match (child, undo.0) {
            (Child::Join(j), Some(old)) => self.clusters[j] = old,
            (Child::Open, _) => drop(self.clusters.pop()),
            _ => drop(self.left_out.pop()),
        }
    }

    /// The cluster of these rows; an item that does not fit in a larger set of rows does not fit here.
    fn cluster(&self, core: &CoreSet<'_>, words: Words, before: Option<&Vec<u32>>) -> Cluster {
        let fits = |item: usize| before.is_none_or(|column| column.get(item) != Some(&0));
        let count = |item| match !self.is_given(item) && fits(item) {
            true => core.count(&words, item),
            false => 0,
        };
        let column = (0..core.len()).map(count).collect();
        Cluster { size: size(&words), words, column }
    }

    /// The items that the rows of each cluster have for good; each item is with the first.
    pub(super) fn held(&self, core: &CoreSet<'_>) -> Vec<Vec<usize>> {
        let mut held = vec![vec![]; self.clusters.len()];
        for item in 0..core.len() {
            let holds =
                |cluster: &Cluster| core.count(&cluster.words, item) == size(&cluster.words);
            if let Some(j) = self.clusters.iter().position(holds) {
                held[j].push(item);
            }
        }
        held
    }
}
