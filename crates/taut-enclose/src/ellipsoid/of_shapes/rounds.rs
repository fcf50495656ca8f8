//! The rounds: a working set's ellipsoid, a pass for what lies outside, and that joins the working set.

use taut_certify::{Ellipsoid, PassBounds, Solution, Stop, Trace};
use taut_points::{Monitor, ReadError};

use super::base::Base;
use super::pass::pass;
use super::support_points::{Axes, SupportPoint, axes, first_working_set};
use crate::Error;
use crate::ellipsoid::counters::Counters;
use crate::ellipsoid::newton::{self, Tolerance, gap};
use crate::ellipsoid::outcome::trial_log_volume;
use crate::ellipsoid::whitener::Whitener;
use crate::ellipsoid::working_set::WorkingSet;
use crate::ellipsoid::{EllipsoidOptions, ROUNDING};
use crate::shapes::Shapes;
use crate::shapes::frame::{Framed, Map};

/// After a pass, this many points may join for each of the d(d + 3)/2 that can be needed.
const JOINING_FACTOR: usize = 2;
/// A point of the working set with no multiplier whose |y|² is below this part of d is of no use any more.
const LEVERAGE_RATIO_MIN: f64 = 0.98;
/// This many passes without a better gap show that rounding is in the way, of gaps below [`SMALL_GAP`].
const STALE_PASSES_MAX: u32 = 4;
/// Below this gap, rounding may be what keeps passes from improving it.
const SMALL_GAP: f64 = 1e-6;

/// The best multipliers so far, and what they mean.
pub(super) struct Best {
    pub(super) largest: f64,
    pub(super) squares: Vec<f64>,
    pub(super) matrix: Vec<f64>,
    pub(super) center: Vec<f64>,
    pub(super) support: Vec<(SupportPoint, f64)>,
}

impl Base {
    /// Solves the items, which `shapes` holds, in these coordinates.
    pub(super) fn solve(
        &self,
        shapes: &Shapes,
        options: &EllipsoidOptions<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Ellipsoid>, Error> {
        let framed = Framed::of(shapes, Map { matrix: &self.matrix, center: &self.center });
        if !framed.is_finite() {
            return Err(Error::Overflow);
        }
        let rank = self.rank;
        let wanted = options.epsilon.max(ROUNDING * rank as f64);
        let mut counters = Counters::default();
        let mut whitener = Whitener::of_scales(&vec![1.0; rank]);
        let axes = axes(&framed);
        let widths: Vec<f64> = axes.iter().map(Axes::longest).collect();
        let (mut set, mut support_points) = first_working_set(&framed, axes);
        let later = JOINING_FACTOR * (rank + 1) * (rank + 2) / 2;
        let later = later.max(64);
        let mut best: Option<Best> = None;
        let mut history = vec![];
        let mut tolerance = 1e-2;
        let (mut passes, mut stale) = (1, 0);
        let base_logs: f64 = (0..rank).map(|a| self.lower[a * rank + a].ln()).sum();
        let stop = loop {
            let sharp = Tolerance { easy: tolerance, hard: tolerance, basis: true };
            newton::solve(&mut set, &mut whitener, sharp, &mut counters, monitor)?;
            passes += 1;
            monitor.pass(passes, shapes.len() as u64);
            monitor.check().map_err(ReadError::from)?;
            let matrix = whitener.matrix();
            let center = whitener.center();
            let seeds = support_points.seeds(&set, shapes.len());
            let found = pass(&framed, &widths, matrix, &center, &seeds);
            monitor.points(shapes.len() as u64);
            if !found.largest.is_finite() {
                return Err(Error::Overflow);
            }
            let lower = trial_log_volume(rank, matrix) - base_logs;
            let reached = gap(rank, found.largest);
            history.push(PassBounds {
                lower,
                upper: lower + reached,
                working_set: set.len() as u64,
            });
            let is_better = best.as_ref().is_none_or(|best| found.largest < best.largest);
            stale = if is_better { 0 } else { stale + 1 };
            let outside = found.outside;
            if is_better {
                best = Some(Best {
                    largest: found.largest,
                    squares: found.squares,
                    matrix: matrix.to_vec(),
                    center,
                    support: support_points.support(&set),
                });
            }
            let best_gap = best.as_ref().map_or(f64::INFINITY, |best| gap(rank, best.largest));
            if best_gap <= wanted {
                break Stop::Converged;
            }
            if passes >= options.max_passes {
                break Stop::PassBudget;
            }
            if stale >= STALE_PASSES_MAX && best_gap < SMALL_GAP
                || outside.is_empty() && tolerance == 0.0
            {
                break Stop::Rounding;
            }
            drop_useless(&mut set, &whitener);
            let sharper = if 1e-2 * reached < 1e-3 {
                (1e-2 * reached).max(0.1 * wanted)
            } else {
                1e-2 * reached
            };
            tolerance = if outside.is_empty() { 0.0 } else { sharper };
            for (_, support_point) in outside.into_iter().take(later) {
                let point = framed.touching(support_point.item, &support_point.direction);
                set.push(support_points.list.len() as u64, &point, 0.0);
                support_points.list.push(support_point);
            }
        };
        let best = best.expect("the loop ends after a pass");
        counters.others.insert("touching-points".into(), support_points.list.len() as u64);
        let trace = Trace {
            method: options.method.name().to_owned(),
            stop,
            passes,
            iterations: counters.steps,
            core_set: set.len() as u64,
            history,
            counters: counters.into_named(),
        };
        self.prove(shapes, best, trace, options)
    }
}

/// Points with no multiplier, well inside, leave the working set.
fn drop_useless(set: &mut WorkingSet, whitener: &Whitener) {
    let dim = set.dim() as f64;
    let leverages = whitener.apply(set).leverages;
    let weights = set.weights().to_vec();
    set.retain(|i| weights[i] > 0.0 || leverages[i] > LEVERAGE_RATIO_MIN * dim);
}
