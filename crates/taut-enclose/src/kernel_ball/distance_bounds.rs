//! Upper bounds of the distances of all rows from a center that moves.
//!
//! *Idea.* Where a center moves from c to c′, |φ(x) − c′| ≤ |φ(x) − c| + |c′ − c|. The last steps of a search are small, so that what an
//! earlier pass found proves nearly all rows to be inside, without a look at them.
//! *Displacement.* |c′ − c|² = Σ λ′ᵢaᵢ − D − D′, where a and D belong to c; what rounding may hide is added.
//! *Cost.* One number for each row, and for a moment a second one.

use super::pairs::Pairs;

/// Rows up to which bounds are kept: 512 MiB.
const ROWS_MAX: u64 = 1 << 26;

/// Bounds of all rows.
pub(super) struct DistanceBounds {
    /// For each row: its bound, less the drift at that time.
    bounds: Vec<f64>,
    /// The sum of the displacements of the center.
    drift: f64,
    /// How far squared distances from the present center may be off by rounding.
    room: f64,
}

impl DistanceBounds {
    /// Bounds for so many rows, none of them known so far; `None` where there are too many rows.
    pub(super) fn new(rows: u64) -> Option<Self> {
        (rows <= ROWS_MAX).then(|| DistanceBounds {
            bounds: vec![f64::INFINITY; rows as usize],
            drift: 0.0,
            room: 0.0,
        })
    }

    /// Takes into account that the center has moved.
    pub(super) fn move_center(&mut self, Displacement { length, room }: Displacement) {
        self.drift += length;
        self.room = room;
    }

    /// The bound to keep for a squared distance from the present center: its root less the drift, rounded up; infinity for what is no
    /// number.
    pub(super) fn kept(&self, square: f64) -> f64 {
        let root = (square + self.room).max(0.0).sqrt();
        let bound = (root + self.drift) * (1.0 + 4.0 * f64::EPSILON) - 2.0 * self.drift;
        if square.is_finite() && bound.is_finite() { bound } else { f64::INFINITY }
    }

    /// Takes the squared distance of a row.
    pub(super) fn set(&mut self, row: u64, square: f64) {
        self.bounds[row as usize] = self.kept(square);
    }

    /// The squared bounds of rows from `first` on; infinity for those that are not known.
    pub(super) fn squares(&self, first: u64, rows: usize) -> Vec<f64> {
        let bounds = &self.bounds[first as usize..][..rows];
        bounds.iter().map(|bound| (bound + self.drift).powi(2)).collect()
    }

    /// Puts bounds of all rows, as [`kept`](Self::kept) makes them, block by block in the place of those before.
    pub(super) fn replace(&mut self, kept: &[Vec<f64>]) {
        self.bounds.iter_mut().zip(kept.iter().flatten()).for_each(|(bound, &new)| *bound = new);
    }
}

/// How far a center has moved.
pub(super) struct Displacement {
    /// No less than |c′ − c|.
    pub(super) length: f64,
    /// The error of a squared distance from the new center.
    room: f64,
}

/// Multipliers as they were: Σ λⱼρᵢⱼ for each point of the working set, D, and how many are not 0.
pub(super) struct PreviousMultipliers {
    mean: Vec<f64>,
    dual: f64,
    count: usize,
}

impl PreviousMultipliers {
    pub(super) fn of(pairs: &Pairs) -> Self {
        PreviousMultipliers {
            mean: pairs.mean.clone(),
            dual: pairs.spread(),
            count: pairs.support_len(),
        }
    }

    /// How far the center has moved from these multipliers to the present ones of the same working set.
    pub(super) fn displacement(&self, pairs: &Pairs) -> Displacement {
        let cross: f64 = self.mean.iter().zip(&pairs.lambda).map(|(a, l)| a * l).sum();
        let dual = pairs.spread();
        let count = self.count.max(pairs.support_len());
        let relative = (pairs.dim + 4 * count + 60) as f64 * f64::EPSILON;
        let room = 4.0 * relative * (cross + dual + self.dual);
        Displacement { length: ((cross - dual - self.dual).max(0.0) + room).sqrt(), room }
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
            let mut bounds = DistanceBounds::new(60).unwrap();
            let squares: Vec<f64> = pairs.mean.iter().map(|a| a - pairs.spread()).collect();
            let kept: Vec<f64> = squares.into_iter().map(|square| bounds.kept(square)).collect();
            bounds.replace(&kept.chunks(7).map(<[f64]>::to_vec).collect::<Vec<_>>());
            for tolerance in [0.5, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12] {
                let before = PreviousMultipliers::of(&pairs);
                let old = pairs.lambda.clone();
                pairs.maximize(tolerance, false, &Monitor::silent()).unwrap();
                let displacement = before.displacement(&pairs);
                let way = displacement.length;
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
                bounds.move_center(displacement);
                let squares = bounds.squares(0, 60);
                for (bound, a) in squares.iter().zip(&pairs.mean) {
                    assert!(*bound >= a - pairs.spread(), "{kernel:?} {tolerance}");
                }
            }
        }
    }

    #[test]
    fn a_known_distance_comes_back_as_it_was_but_for_rounding() {
        let mut bounds = DistanceBounds::new(2).unwrap();
        assert_eq!(bounds.squares(0, 2), [f64::INFINITY; 2]);
        bounds.move_center(Displacement { length: 3.0, room: 0.0 });
        bounds.set(1, 4.0);
        let square = bounds.squares(1, 1)[0];
        assert!((4.0..4.0 + 1e-13).contains(&square), "{square}");
        bounds.move_center(Displacement { length: 0.5, room: 0.0 });
        assert!((bounds.squares(1, 1)[0] - 6.25).abs() < 1e-13);
    }

    #[test]
    fn what_is_no_number_is_no_bound() {
        let mut bounds = DistanceBounds::new(1).unwrap();
        for square in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            bounds.set(0, square);
            assert_eq!(bounds.squares(0, 1), [f64::INFINITY]);
        }
        bounds.move_center(Displacement { length: f64::INFINITY, room: 0.0 });
        bounds.set(0, 1.0);
        assert_eq!(bounds.squares(0, 1), [f64::INFINITY]);
    }
}
