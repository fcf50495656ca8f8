//! Upper bounds of the distances of all rows from a center that moves.
//!
//! *Idea.* Where a center moves from c to c′, |φ(x) − c′| ≤ |φ(x) − c| + |c′ − c|. The last steps of a search are small, so that what an
//! earlier pass found proves nearly all rows to be inside, without a look at them.
//! *Way of the center.* |c′ − c|² = Σ λ′ᵢaᵢ − D − D′, where a and D belong to c; what rounding may hide is added.
//! *Cost.* One number for each row.

use super::pairs::Pairs;

/// Rows up to which bounds are kept: 512 MiB.
const ROWS_MAX: u64 = 1 << 26;

/// Bounds of all rows.
pub(super) struct Reaches {
    /// For each row: its bound, less the drift at that time.
    bounds: Vec<f64>,
    /// The sum of the ways of the center.
    drift: f64,
}

impl Reaches {
    /// Bounds for so many rows, none of them known so far; `None` where there are too many rows.
    pub(super) fn new(rows: u64) -> Option<Self> {
        (rows <= ROWS_MAX)
            .then(|| Reaches { bounds: vec![f64::INFINITY; rows as usize], drift: 0.0 })
    }

    /// Takes into account that the center has moved.
    pub(super) fn drift_by(&mut self, way: f64) {
        self.drift += way;
    }

    /// The bound to keep for a squared distance from the present center.
    fn kept(&self, square: f64) -> f64 {
        // Rounding up: of the root, the sum and the difference, and of the sum when it is read.
        (square.max(0.0).sqrt() + self.drift) * (1.0 + 4.0 * f64::EPSILON) - 2.0 * self.drift
    }

    /// Takes the squared distance of a row.
    pub(super) fn know(&mut self, row: u64, square: f64) {
        self.bounds[row as usize] = self.kept(square);
    }

    /// The squared bounds of rows from `first` on; infinity for those that are not known.
    pub(super) fn squares(&self, first: u64, rows: usize) -> Vec<f64> {
        let bounds = &self.bounds[first as usize..][..rows];
        bounds.iter().map(|bound| (bound + self.drift).powi(2)).collect()
    }

    /// Puts the squared bounds of all rows, block by block, in the place of those kept.
    pub(super) fn replace(&mut self, squares: Vec<Vec<f64>>) {
        self.bounds = squares.into_iter().flatten().map(|square| self.kept(square)).collect();
    }
}

/// Multipliers as they were: Σ λⱼρᵢⱼ for each point of the working set, and D.
pub(super) struct Before {
    mean: Vec<f64>,
    spread: f64,
}

impl Before {
    pub(super) fn of(pairs: &Pairs) -> Self {
        Before { mean: pairs.mean.clone(), spread: pairs.spread() }
    }

    /// At least the way of the center from these multipliers to the present ones of the same working set.
    pub(super) fn way(&self, pairs: &Pairs) -> f64 {
        let cross: f64 = self.mean.iter().zip(&pairs.lambda).map(|(a, l)| a * l).sum();
        let spread = pairs.spread();
        let count = pairs.lambda.iter().filter(|&&l| l > 0.0).count();
        let relative = (pairs.dim + 4 * count + 60) as f64 * f64::EPSILON;
        let room = 4.0 * relative * (cross + spread + self.spread);
        ((cross - spread - self.spread).max(0.0) + room).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use taut_certify::Kernel;
    use taut_points::Monitor;

    use super::super::features::Features;
    use super::*;

    /// Points of a spiral, which are in no special place.
    fn spiral(count: usize) -> Features {
        let rows = (0..count).flat_map(|i| {
            let t = i as f64 * 0.37;
            [t.cos() * t, t.sin() * t * 0.5, (2.3 * t).sin()]
        });
        Features { ids: (0..count as u64).collect(), rows: rows.collect(), own: vec![] }
    }

    fn pairs(kernel: Kernel) -> Pairs {
        let features = spiral(60);
        let mut lambda = vec![0.0; features.len()];
        lambda[0] = 1.0;
        Pairs::new(kernel, 3, features, lambda, 1.0)
    }

    #[test]
    fn bounds_hold_while_the_center_moves_and_are_close() {
        for kernel in [Kernel::Gaussian { gamma: 0.02 }, Kernel::Linear] {
            let mut pairs = pairs(kernel);
            let mut reaches = Reaches::new(60).unwrap();
            let squares: Vec<f64> = pairs.mean.iter().map(|a| a - pairs.spread()).collect();
            reaches.replace(squares.chunks(7).map(<[f64]>::to_vec).collect());
            for tolerance in [0.5, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12] {
                let before = Before::of(&pairs);
                let old = pairs.lambda.clone();
                pairs.maximize(tolerance, &Monitor::silent()).unwrap();
                let way = before.way(&pairs);
                // |c′ − c|² = −½ Σ (λ′ᵢ − λᵢ)(λ′ⱼ − λⱼ)ρᵢⱼ.
                let mut column = vec![0.0; 60];
                let mut square = 0.0;
                for i in 0..60 {
                    pairs.features.distances_from(kernel, &pairs.features, i, 3, &mut column);
                    let change = |k: usize| pairs.lambda[k] - old[k];
                    square -= 0.5 * change(i) * (0..60).map(|j| change(j) * column[j]).sum::<f64>();
                }
                let (root, room) = (square.max(0.0).sqrt(), 1e-5 * pairs.spread().sqrt());
                assert!(way >= root * (1.0 - 1e-6) && way <= root + room, "{way} {root}");
                reaches.drift_by(way);
                let bounds = reaches.squares(0, 60);
                for (bound, a) in bounds.iter().zip(&pairs.mean) {
                    assert!(*bound >= a - pairs.spread(), "{kernel:?} {tolerance}");
                }
            }
        }
    }

    #[test]
    fn a_known_distance_comes_back_as_it_was_but_for_rounding() {
        let mut reaches = Reaches::new(2).unwrap();
        assert_eq!(reaches.squares(0, 2), [f64::INFINITY; 2]);
        reaches.drift_by(3.0);
        reaches.know(1, 4.0);
        let square = reaches.squares(1, 1)[0];
        assert!((4.0..4.0 + 1e-13).contains(&square), "{square}");
        reaches.drift_by(0.5);
        assert!((reaches.squares(1, 1)[0] - 6.25).abs() < 1e-13);
    }
}
