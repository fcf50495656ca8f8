//! Held and Karp's bound on tours.
//!
//! *Problem.* Potentials π for which the least 1-tree under |ij| + πᵢ + πⱼ, less 2Σπ, is as heavy as can be. No tour is shorter.
//! *Idea.* A 1-tree is a spanning tree of all sites but one and the two least edges of that one; tours are the 1-trees in which all
//! degrees are 2. Potentials rise where the degree is above 2 and fall where it is 1, by Polyak's step towards the length
//! of the tour that is known; after some steps in coordinates of [`super::cluster_direction`]. Of paths: a spanning tree and two ends.
//! *Guarantee.* The best of all steps is kept. If the 1-tree becomes a tour, that tour is the shortest of the candidates.
//! *Trap.* The bound is one of tours of candidates. What holds for all tours is found from the potentials afterwards. Without a good
//! special site the 1-tree of a dense sample of a curve lacks its longest edge: the special site is the leaf of the least
//! tree whose second edge is the longest.
//! *Reference.* Held and Karp, Operations Research 18, 1970, and Mathematical Programming 1, 1971; the special site after Helsgaun
//! 2000; Polyak 1969.

use taut_points::Monitor;

use super::candidates::Candidates;
use super::cluster_direction::ClusterDirection;
use super::tree::LeastTree;
use crate::Error;

/// The next direction has this share of the last, after Volgenant and Jonker 1982 and Helsgaun 2000.
const MOMENTUM: f64 = 0.3;
/// Steps get shorter after this many without a better bound.
const STEPS_WITHOUT_PROGRESS_MAX: u32 = 4;
/// Steps get shorter by this factor.
const STEP_FACTOR: f64 = 0.7;
/// This many steps are made without coordinates of clusters: on samples of one curve they are all it takes.
const STEPS_WITHOUT_CLUSTERS: u64 = 5;
/// Steps have this length after a restart, against the first.
const RESTART_STEP_RATIO: f64 = 0.3;
/// The bound is as good as the tour.
const CLOSED_GAP: f64 = 1e-7;

pub(super) struct Ascent<'a> {
    candidates: &'a Candidates,
    tree: LeastTree<'a>,
    /// The special site; none for paths.
    pub(super) special: Option<u32>,
    /// Current and best.
    potentials: Vec<f64>,
    pub(super) best: Vec<f64>,
    pub(super) bound: f64,
    /// Degrees less 2 of the best 1-tree.
    open: Vec<i32>,
    direction: Vec<f64>,
    /// That of the last step alone.
    latest: Vec<f64>,
    /// Built when they are needed.
    cluster_direction: Option<ClusterDirection>,
    degrees: Vec<i32>,
    factor: f64,
    waited: u32,
    pub(super) steps: u64,
}

impl<'a> Ascent<'a> {
    /// From potentials, one for each site.
    pub(super) fn new(
        candidates: &'a Candidates,
        special: Option<u32>,
        potentials: Vec<f64>,
    ) -> Self {
        let n = potentials.len();
        Self {
            candidates,
            tree: LeastTree::new(candidates, n, special),
            special,
            potentials,
            best: vec![0.0; n],
            bound: f64::NEG_INFINITY,
            open: vec![0; n],
            direction: vec![0.0; n],
            latest: vec![0.0; n],
            cluster_direction: None,
            degrees: vec![0; n],
            factor: 1.0,
            waited: 0,
            steps: 0,
        }
    }

    /// The sites at which the best 1-tree is no tour.
    pub(super) fn open_sites(&self) -> Vec<u32> {
        (0..).zip(&self.open).filter(|&(_, &degree)| degree != 0).map(|(v, _)| v).collect()
    }

    /// Goes on from the best potentials, with longer steps again.
    pub(super) fn restart(&mut self) {
        self.potentials.copy_from_slice(&self.best);
        self.direction.fill(0.0);
        self.factor = RESTART_STEP_RATIO;
        self.waited = 0;
    }

    /// Takes at most so many steps towards the length of a tour that is known; true if the bound reached it.
    pub(super) fn climb(
        &mut self,
        target: f64,
        steps: usize,
        monitor: &Monitor<'_>,
    ) -> Result<bool, Error> {
        for _ in 0..steps {
            monitor.check()?;
            let bound = self.one_tree();
            self.steps += 1;
            if bound > self.bound {
                self.bound = bound;
                self.best.copy_from_slice(&self.potentials);
                self.open.copy_from_slice(&self.degrees);
                self.waited = 0;
            } else {
                self.waited += 1;
                if self.waited == STEPS_WITHOUT_PROGRESS_MAX {
                    self.waited = 0;
                    self.factor *= STEP_FACTOR;
                }
            }
            let square = self.slope();
            if square == 0.0 || target - self.bound <= CLOSED_GAP * target {
                return Ok(true);
            }
            let step = self.factor * (target - bound) / square;
            for v in 0..self.degrees.len() {
                let along = &mut self.direction[v];
                *along = (1.0 - MOMENTUM) * self.latest[v] + MOMENTUM * *along;
                self.potentials[v] += step * *along;
            }
        }
        Ok(false)
    }

    /// The direction of steepest ascent, in coordinates of sites at first and then of clusters; its square, 0 at a tour.
    fn slope(&mut self) -> f64 {
        if self.steps <= STEPS_WITHOUT_CLUSTERS {
            let mut square = 0.0;
            for (along, &degree) in self.latest.iter_mut().zip(&self.degrees) {
                *along = f64::from(degree);
                square += *along * *along;
            }
            return square;
        }
        let Self { cluster_direction, candidates, degrees, direction, potentials, best, .. } = self;
        let cluster_direction = cluster_direction.get_or_insert_with(|| {
            // What there is of a direction is in other units.
            direction.fill(0.0);
            potentials.copy_from_slice(best);
            ClusterDirection::of(candidates, degrees.len())
        });
        cluster_direction.direct(degrees, &mut self.latest)
    }

    /// The least 1-tree: what it bounds, and its degrees less 2.
    fn one_tree(&mut self) -> f64 {
        self.degrees.fill(-2);
        let degrees = &mut self.degrees;
        let total = self.tree.find(&self.potentials, |a, b| {
            degrees[a as usize] += 1;
            degrees[b as usize] += 1;
        });
        let potentials = &self.potentials;
        let mut two = [(f64::INFINITY, 0); 2];
        let mut offer = |weight: f64, v: u32| {
            if weight < two[0].0 {
                two = [(weight, v), two[0]];
            } else if weight < two[1].0 {
                two[1] = (weight, v);
            }
        };
        match self.special {
            Some(s) => {
                let pi = potentials[s as usize];
                self.candidates
                    .edges(s)
                    .for_each(|(u, length)| offer(length + (pi + potentials[u as usize]), u));
                degrees[s as usize] += 2;
            }
            None => (0u32..).zip(potentials).for_each(|(v, &pi)| offer(pi, v)),
        }
        two.iter().for_each(|&(_, v)| degrees[v as usize] += 1);
        total + two[0].0 + two[1].0 - 2.0 * potentials.iter().sum::<f64>()
    }
}

/// The leaf of the least spanning tree whose second edge is the longest.
pub(super) fn special_site(candidates: &Candidates, n: usize) -> u32 {
    let mut degrees = vec![0u32; n];
    LeastTree::new(candidates, n, None).find(&vec![0.0; n], |a, b| {
        degrees[a as usize] += 1;
        degrees[b as usize] += 1;
    });
    let second = |v: u32| candidates.edges(v).nth(1).map_or(0.0, |(_, length)| length);
    let leaves = (0..n as u32).filter(|&v| degrees[v as usize] == 1);
    leaves.map(|v| (second(v), v)).fold((-1.0, 0), |a, b| if b.0 > a.0 { b } else { a }).1
}
