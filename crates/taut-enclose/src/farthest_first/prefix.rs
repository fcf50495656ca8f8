//! The beginnings of a traversal as answers to the k-center problem.

use taut_certify::{Centers, Placement, Solution};
use taut_points::{InputError, PointSource, gather};

use super::FarthestFirst;
use crate::Error;
use crate::separated_set::SeparatedSet;

impl FarthestFirst {
    /// The first `k` points as centers of all, with the proof that no k centers have half their radius.
    ///
    /// `source` holds the points of the traversal; up to k of them are read. Where the order is shorter than `k` because all
    /// other points are copies, there are fewer centers, the radius is 0, and so is the lower bound. `placement` says among which
    /// centers to compare: the bound holds for both.
    ///
    /// ```
    /// use taut_certify::Placement;
    /// use taut_enclose::farthest_first;
    ///
    /// let points = taut_points::Points::new(&[0.0, 1.0, 5.0, 8.0, 9.0], 1)?;
    /// let order = farthest_first(&points, 4, &Default::default())?;
    /// for k in 1..=4 {
    ///     let found = order.solution(k, Placement::Free, &points)?;
    ///     assert_eq!(found.answer.centers.len(), k as usize);
    ///     assert!(found.answer.radius <= 2.0 * found.answer.lower_bound * (1.0 + 2e-12));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] when `k` is 0, or more than were asked for; [`Error::Input`] when `source` has other rows than those of
    /// the traversal; [`Error::Overflow`] where the lower bound is too small to be a number.
    pub fn solution(
        &self,
        k: u64,
        placement: Placement,
        source: &dyn PointSource,
    ) -> Result<Solution<Centers>, Error> {
        let known = self.order.len() as u64;
        if k == 0 || (k > known && self.next.is_some()) {
            return Err(Error::Input(InputError::Option {
                name: "k",
                value: k.to_string(),
                expected: "from 1 to the number of points that the traversal was asked for",
            }));
        }
        let taken = k.min(known) as usize;
        let radius = self.radii[taken - 1];
        let rows = self.order[..taken].to_vec();
        let after = self.order.get(taken).copied().or(self.next);
        let separated = match after {
            Some(next) if radius > 0.0 => rows.iter().copied().chain([next]).collect(),
            _ => vec![],
        };
        let dim = source.dim();
        let centers = gather(source, &rows)?.chunks_exact(dim).map(<[f64]>::to_vec).collect();
        // The next point is as far from the nearest of the first k as any, and each of these was farther when it came.
        SeparatedSet { rows: separated, distance: radius }.prove(
            Centers {
                centers,
                rows: if placement == Placement::Rows { rows } else { vec![] },
                radius,
                lower_bound: 0.0,
                outliers: vec![],
                assignment: vec![],
            },
            k,
            placement,
            self.points_hash,
            self.trace.clone(),
        )
    }
}
