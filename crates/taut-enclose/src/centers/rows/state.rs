//! A node of the search: which item of X is in which cluster, and what that leaves open.
//!
//! *Idea.* A cluster is the set of rows that have all its items within the radius; it is not feasible when that is
//! empty, and holds an item for good when all of these rows have it. Children with a cluster that is not feasible are pruned. For each cluster a column counts, for each item, how many
//! of its rows have that item, too.
//! *Branching.* The item with the fewest places to go (Brélaz 1979, DSATUR), among equals the one that would leave
//! its clusters the fewest rows.

use std::sync::Arc;

use super::core_set::{CoreSet, Words, size};
use crate::centers::depth_first::{self, Place};
use crate::centers::links::{Links, cluster_of};
use crate::centers::proof_tree::{ProofLog, Proving, Step};

/// At the root, sets of items apart are sought from this many starts, divided by |X|: from every item while X is small.
const ROOT_TESTS: usize = 1 << 16;

/// Items that some row has within the radius.
#[derive(Clone)]
pub(super) struct Cluster {
    /// The rows that have them all.
    pub(super) words: Words,
    size: u32,
    /// For each item of X, how many of these have it, too; may be shorter than X.
    column: Vec<u32>,
}

/// A node.
#[derive(Clone)]
pub(super) struct State<'s> {
    /// X, which states share until one of them adds to it.
    pub(super) core: Arc<CoreSet<'s>>,
    pub(super) k: usize,
    pub(super) outliers: usize,
    pub(super) clusters: Vec<Cluster>,
    /// For each item, whether it was given to a cluster or left out; may be shorter than X.
    given: Vec<bool>,
    pub(super) left_out: Vec<usize>,
    /// None where each row stands for itself.
    links: Option<Links>,
    /// Items to branch on first, of which no two fit in one ball.
    lead: Vec<usize>,
}

pub(super) enum NodeState {
    /// Every item is held for good, or left out.
    StreamingReport,
    /// Branch on this item.
    Branch(usize),
    /// No way on: branching on these in turn shows it.
    Dead(Vec<usize>),
}

/// The data to take a step back.
pub(super) struct Undo {
    item: usize,
    place: Place,
    /// The cluster as it was, if the item joined one.
    before: Option<Cluster>,
}

impl<'s> State<'s> {
    pub(super) fn new(core: Arc<CoreSet<'s>>, k: usize, outliers: usize) -> Self {
        let (clusters, given, left_out, lead) = (vec![], vec![], vec![], vec![]);
        let links = core.sites.are_grouped().then(|| {
            let mut links = Links::default();
            let groups = core.members.iter().filter_map(|&site| core.sites.group(site));
            groups.for_each(|group| links.add(group));
            links
        });
        State { core, k, outliers, clusters, given, left_out, links, lead }
    }

    /// Adds an item to X.
    pub(super) fn add(&mut self, site: usize) {
        Arc::make_mut(&mut self.core).add(site);
        if let (Some(links), Some(group)) = (&mut self.links, self.core.sites.group(site)) {
            links.add(group);
        }
    }

    /// For a site that reaches too far from all centers, the one to be added to X: itself, or where its group has items in X that one of
    /// the clusters' centers has all within the radius, the site of the group that reaches farthest from there, which is not in X.
    pub(super) fn witness(&self, farthest: usize, centers: &[usize]) -> usize {
        let (Some(links), Some(group)) = (&self.links, self.core.sites.group(farthest)) else {
            return farthest;
        };
        let (known, sites) = (links.known(group), self.core.sites);
        let holds = |&&center: &&usize| {
            known.iter().all(|&item| {
                sites.is_near(self.core.members[item as usize], center, self.core.radius)
            })
        };
        match centers.iter().find(holds).filter(|_| !known.is_empty()) {
            Some(&center) => sites.farthest_linked(farthest, center),
            None => farthest,
        }
    }

    /// Returns true if it is decided that an item's group is left out.
    fn is_out(&self, item: usize) -> bool {
        let home = self.links.as_ref().and_then(|links| links.home(item as u32));
        home.is_some_and(|home| home.cluster.is_none())
    }

    /// Returns true if it is decided where the group of an item is.
    fn is_settled(&self, item: usize) -> bool {
        self.links.as_ref().is_some_and(|links| links.home(item as u32).is_some())
    }

    /// Returns true if an item stands for others of its group, whose place is open.
    fn stands_for_group(&self, item: usize) -> bool {
        self.links.as_ref().is_none_or(|links| {
            links.home(item as u32).is_some()
                || links.linked(item as u32).first() == Some(&(item as u32))
        })
    }

    /// The number of rows of a cluster that have an item, or those that have the item of its group that fewest have; 0 for clusters that the
    /// group is not in, if it is in one.
    fn count(&self, item: usize, number: usize) -> u32 {
        let column = &self.clusters[number].column;
        let Some(links) = &self.links else { return column[item] };
        match links.home(item as u32) {
            Some(home) if home.cluster == Some(number) => column[item],
            Some(_) => 0,
            None => {
                let linked = links.linked(item as u32).iter();
                linked.map(|&other| column[other as usize]).min().unwrap_or(0)
            }
        }
    }

    /// Tests whether an item was given to a cluster or left out.
    fn is_given(&self, item: usize) -> bool {
        self.given.get(item).copied().unwrap_or(false)
    }

    /// Looks at the node; brings columns up to date with X.
    pub(super) fn examine(&mut self) -> NodeState {
        let core = &*Arc::clone(&self.core);
        for cluster in &mut self.clusters {
            for item in cluster.column.len()..core.len() {
                cluster.column.push(core.count(&cluster.words, item));
            }
        }
        let empty = self.k - self.clusters.len();
        let outliers_left = self.outliers - self.left_out.len();
        // Items that fit in no cluster that has items.
        let mut unplaced = vec![];
        let mut best: Option<(usize, bool, f64, usize)> = None;
        let is_open = |&item: &usize| {
            !self.is_given(item) && !self.is_out(item) && self.stands_for_group(item)
        };
        for item in (0..core.len()).filter(is_open) {
            let (mut places, mut freedom) =
                (0, f64::from(core.size(item)) / core.sites.len() as f64);
            let mut held = false;
            for (number, cluster) in self.clusters.iter().enumerate() {
                let count = self.count(item, number);
                held |= count == cluster.size;
                if count > 0 {
                    places += 1;
                    freedom += f64::from(count) / f64::from(cluster.size);
                }
            }
            if held {
                continue;
            }
            let is_settled = self.is_settled(item);
            if places == 0 && !is_settled {
                unplaced.push(item);
            }
            // A ball of a radius may have no row that holds it.
            if !is_settled {
                places +=
                    usize::from(empty > 0 && core.size(item) > 0) + usize::from(outliers_left > 0);
            }
            if places == 0 {
                return NodeState::Dead(vec![item]);
            }
            let key = (places, !self.lead.contains(&item), freedom, item);
            let less = |best: &(usize, bool, f64, usize)| {
                let order = (key.0, key.1).cmp(&(best.0, best.1));
                order.then(key.2.total_cmp(&best.2)).then(key.3.cmp(&best.3)).is_lt()
            };
            if best.as_ref().is_none_or(less) {
                best = Some(key);
            }
        }
        let Some((_, _, _, item)) = best else { return NodeState::StreamingReport };
        if self.clusters.is_empty() && self.left_out.is_empty() {
            let enough = self.k + self.outliers;
            let separated =
                core.separated(&unplaced, ROOT_TESTS / unplaced.len().max(1) + 1, enough);
            if separated.len() > enough {
                return NodeState::Dead(separated);
            }
            self.lead = separated;
            return NodeState::Branch(self.lead.first().copied().unwrap_or(item));
        }
        match self.refute(unplaced, empty, outliers_left) {
            Some(items) => NodeState::Dead(items),
            None => NodeState::Branch(item),
        }
    }

    /// Items that fit in no cluster that has items, and that so many empty clusters and outliers do not hold either.
    fn refute(
        &self,
        unplaced: Vec<usize>,
        empty: usize,
        outliers_left: usize,
    ) -> Option<Vec<usize>> {
        let core = &*self.core;
        if empty == 0 {
            return (unplaced.len() > outliers_left).then_some(unplaced);
        }
        if empty == 1 && outliers_left == 0 && unplaced.len() > 1 {
            let mut words = core.words(unplaced[0]).clone();
            let last = unplaced.iter().skip(1).position(|&item| {
                words = core.common(&words, item);
                words.is_empty()
            });
            return last.map(|last| unplaced[..last + 2].to_vec());
        }
        if unplaced.len() <= empty + outliers_left {
            return None;
        }
        let separated = core.separated(&unplaced, 1, empty + outliers_left);
        (separated.len() > empty + outliers_left).then_some(separated)
    }

    /// Where an item may go, in the order in which a proof takes them.
    fn places(&self, item: usize) -> Vec<Place> {
        let home = self.links.as_ref().and_then(|links| links.home(item as u32));
        let joins = (0..self.clusters.len())
            .filter(|&j| home.is_none_or(|home| home.cluster == Some(j)))
            .filter(|&j| self.clusters[j].column[item] > 0)
            .map(Place::Into);
        if home.is_some() {
            return joins.collect();
        }
        let opens = self.clusters.len() < self.k && self.core.size(item) > 0;
        let opens = opens.then_some(Place::Open);
        let leaves = (self.left_out.len() < self.outliers).then_some(Place::LeaveOut);
        joins.chain(opens).chain(leaves).collect()
    }

    /// The same, the most promising first: where most rows of the cluster remain.
    pub(super) fn promising(&self, item: usize) -> Vec<Place> {
        let mut places = self.places(item);
        let rest = |place: &Place| match place {
            Place::Into(j) => {
                let cluster = &self.clusters[*j];
                f64::from(cluster.column[item]) / f64::from(cluster.size)
            }
            Place::Open => 0.0,
            Place::LeaveOut => -1.0,
        };
        places.sort_by(|a, b| rest(b).total_cmp(&rest(a)));
        places
    }

    /// The cluster of these rows; an item that does not fit in a larger set of rows does not fit here.
    fn cluster(&self, words: Words, before: Option<&Vec<u32>>) -> Cluster {
        let core = &*self.core;
        let fits = |item: usize| before.is_none_or(|column| column.get(item) != Some(&0));
        let count = |item| match !self.is_given(item) && fits(item) {
            true => core.count(&words, item),
            false => 0,
        };
        let column = (0..core.len()).map(count).collect();
        Cluster { size: size(&words), words, column }
    }

    /// The items that the rows of each cluster have for good; each item is with the first.
    pub(super) fn held(&self) -> Vec<Vec<usize>> {
        let core = &*self.core;
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

impl depth_first::State for State<'_> {
    type Undo = Undo;

    fn put(&mut self, item: u32, place: Place) -> Undo {
        let item = item as usize;
        self.given.resize(self.core.len(), false);
        self.given[item] = true;
        let cluster = cluster_of(place, self.clusters.len());
        if let Some(links) = &mut self.links {
            links.decide(item as u32, cluster, 0);
        }
        let mut before = None;
        match place {
            Place::Into(j) => {
                let words = self.core.common(&self.clusters[j].words, item);
                let cluster = self.cluster(words, Some(&self.clusters[j].column));
                before = Some(std::mem::replace(&mut self.clusters[j], cluster));
            }
            Place::Open => {
                let cluster = self.cluster(self.core.words(item).clone(), None);
                self.clusters.push(cluster);
            }
            Place::LeaveOut => self.left_out.push(item),
        }
        Undo { item, place, before }
    }

    fn undo(&mut self, Undo { item, place, before }: Undo) {
        self.given[item] = false;
        if let Some(links) = &mut self.links {
            links.undo();
        }
        match (place, before) {
            (Place::Into(j), Some(before)) => self.clusters[j] = before,
            (Place::Open, _) => drop(self.clusters.pop()),
            _ => drop(self.left_out.pop()),
        }
    }
}

impl Proving for State<'_> {
    fn step(&mut self) -> Step {
        match self.examine() {
            NodeState::StreamingReport => Step::Open,
            NodeState::Branch(item) => Step::Branch(vec![item as u32]),
            // What is left of a group when one of its items is decided is looked at again.
            NodeState::Dead(items) if self.links.is_some() => Step::Branch(vec![items[0] as u32]),
            NodeState::Dead(items) => {
                Step::Branch(items.into_iter().map(|item| item as u32).collect())
            }
        }
    }

    fn open_places(&mut self, item: u32, _: &mut ProofLog) -> Vec<Place> {
        self.places(item as usize)
    }
}
