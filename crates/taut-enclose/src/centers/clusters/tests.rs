use std::sync::Arc;

use super::*;

/// Deterministic numbers in [0, 1).
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
        (self.0 >> 33) as f64 / 2f64.powi(31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }
}

/// The state without anything that is kept from one decision to the next: its fits are counted again.
fn recounted<P: Position>(state: &Clusters<P>) -> Clusters<P> {
    let mut fresh = state.clone();
    fresh.fit_counts = FitCounts::new(fresh.items.len(), fresh.threshold);
    fresh.placeless = None;
    (0..fresh.clusters.len()).for_each(|at| fresh.count(at));
    fresh
}

/// What is next, in a form that can be compared.
fn next<P: Position>(state: &mut Clusters<P>) -> (Option<u32>, Vec<u32>) {
    match state.examine(false) {
        NodeState::Branch(item) => (Some(item), vec![]),
        NodeState::Stuck => (None, state.conflicting.clone()),
        NodeState::StreamingReport => (Some(u32::MAX), vec![]),
    }
}

/// Puts an item where a decision has left one without a place, and asks of all feasible items of that cluster.
fn put_in_full<P: Position>(state: &mut Clusters<P>, item: u32, at: usize) {
    let items = state.items.clone();
    let cluster = &mut state.clusters[at];
    cluster.ball.grow(&items, &cluster.members, item, f64::INFINITY, &mut state.work);
    cluster.members.push(item);
    cluster.feasible.clear();
    cluster.asked = 0;
}

/// A walk through decisions and back, with new items and a threshold that comes down; returns how many dead ends were told early.
fn walk(shape: Shape, z: u64, grid: f64, seed: u64) -> usize {
    let mut draws = Draws(seed);
    let mut items = ItemSet::<[f64; 2]>::new(shape, 2);
    let place = |draws: &mut Draws| [0; 2].map(|_| (draws.next() * grid).round() / grid);
    for _ in 0..30 {
        let position = place(&mut draws);
        let extra = 0.05 + 0.1 * draws.next();
        items.push(&position, if shape == Shape::Weighted { 1.0 + extra } else { extra });
    }
    let mut state = Clusters::new(Arc::new(items), None, 3, z, 0.45, shape == Shape::Points);
    state.end_early();
    let mut undos: Vec<Undo<[f64; 2]>> = vec![];
    let mut early = 0;
    for step in 0..600 {
        if step % 97 == 96 {
            let position = place(&mut draws);
            state.add(&position, 0.1, None);
        }
        if step % 151 == 150 {
            state.threshold *= 0.98;
        }
        let was_told = state.placeless.is_some();
        let mut fresh = recounted(&state);
        let found = next(&mut state);
        if was_told {
            early += 1;
            // Compared below, where the decision is made. A copy can be taken back, too.
            assert_eq!(found.0, None, "{shape:?}, {seed}, step {step}");
            let mut copy = state.clone();
            copy.undo(undos.last().expect("it was decided").clone());
            let again = format!("{:?}", recounted(&copy).fit_counts);
            if copy.fit_counts.threshold == copy.threshold {
                assert_eq!(
                    format!("{:?}", copy.fit_counts),
                    again,
                    "{shape:?}, {seed}, step {step}"
                );
            }
        } else {
            assert_eq!(found, next(&mut fresh), "{shape:?}, {seed}, step {step}");
            if state.fit_counts.threshold == state.threshold {
                let (kept, again) = (&state.fit_counts, &recounted(&state).fit_counts);
                let what = format!("{shape:?}, {seed}, step {step}");
                assert_eq!(format!("{kept:?}"), format!("{again:?}"), "{what}");
            }
        }
        let item = match found.0 {
            Some(item) if item != u32::MAX && undos.len() < 25 => item,
            _ => {
                // Back by a few decisions.
                for _ in 0..=draws.below(4) {
                    if let Some(undo) = undos.pop() {
                        state.undo(undo);
                    }
                }
                continue;
            }
        };
        let places = state.places(item);
        let Some(&(_, place)) = places.get(draws.below(places.len().max(1))) else {
            if let Some(undo) = undos.pop() {
                state.undo(undo);
            }
            continue;
        };
        let mut in_full = state.clone();
        undos.push(state.put_at(item, place, undos.len() as u32 + 1));
        if let (Some(told), Place::Into(at)) = (state.placeless, place) {
            put_in_full(&mut in_full, item, at);
            let (branch, conflicting) = next(&mut recounted(&in_full));
            assert_eq!((branch, conflicting), (None, vec![told]), "{shape:?}, {seed}, step {step}");
            // The threshold may come down before the dead end is asked for.
            state.threshold *= if draws.next() < 0.02 { 0.999 } else { 1.0 };
        }
    }
    while let Some(undo) = undos.pop() {
        state.undo(undo);
    }
    assert!(state.clusters.is_empty() && state.placeless.is_none());
    early
}

#[test]
fn fits_are_counted_as_if_recounted_and_dead_ends_told_early_are_dead_ends() {
    let mut early = 0;
    for seed in 1..=12 {
        for grid in [6.0, 1e9] {
            for z in [0, 3] {
                for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
                    let told = walk(shape, z, grid, seed);
                    assert!(shape != Shape::Balls || told == 0);
                    early += told;
                }
            }
        }
    }
    assert!(early > 100, "{early}");
}

/// What a point raises a radius to is bounded from below, also where rounding has moved the center: by flat sets, and by tight sets far from
/// the origin.
#[test]
fn radii_are_at_least_their_bounds() {
    let mut draws = Draws(3);
    let mut work = Workspace::new(2);
    for (offset, size) in [
        (0.0, 1.0),
        (1.0, 1e-3),
        (1.0, 1e-6),
        (1.0, 1e-9),
        (1.0, 1e-11),
        (1.0, 1e-13),
        (1.0, 1e-15),
    ] {
        let (mut near, mut bounded) = (0, 0);
        for round in 0..3000 {
            let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
            let flat = [1.0, 1e-3, 1e-7][round % 3];
            for _ in 0..5 {
                let [x, y] = [draws.next(), flat * draws.next()];
                items.push(&[offset + size * x, offset + size * y], 0.0);
            }
            let members: Vec<u32> = (0..4).collect();
            let ball = Ball::of_all(&items, &members, &mut work);
            let mut grown = ball.clone();
            let cluster = Cluster { members: members.clone(), ball, feasible: vec![], asked: 0 };
            grown.grow(&items, &members, 4, f64::INFINITY, &mut work);
            let bound = cluster.radius_at_least(&items, 4);
            assert!(bound < grown.lower_bound(&items), "{size}: {bound} {}", grown.radius);
            near += usize::from(bound > 0.999 * grown.radius);
            bounded += usize::from(bound > 0.0);
        }
        let is_known = size > 1e-7;
        assert!((near > 20) == is_known && (bounded > 500) == is_known, "{size}: {near} {bounded}");
    }
}
