//! The rows at the border of those kept: another choice of them may have the lower determinant though no C-step leads
//! to it.
//!
//! *Problem.* C-steps end where the h rows kept are the nearest in their own metric. Of n points there are many such
//! ends close to each other, which differ in some rows at the border.
//! *Idea.* Rows well inside stay kept and rows well outside stay left out; only some thousand at the border are looked
//! at, in coordinates y in which those kept had mean 0 and covariance I. There three things lead down:
//! 1. C-steps.
//! 2. Exchanges. When row j takes the place of row i, the determinant is multiplied by 1 + g/(h − 1) with
//!    g = b − a − |zᵢ − zⱼ|²/h − (ab − (zᵢ·zⱼ)²)/(h − 1), where z is in the metric of the rows kept, a = |zᵢ|²,
//!    b = |zⱼ|². With a and b at most q that is negative only where b − a < (4q + q²)/(h − 1): some ten rows on
//!    either side, of which all pairs are tried.
//! 3. Kicks. Distances are bent a little along a row of the border, and 1 and 2 lead down from there; what is lower is
//!    gone on from. Bent by inner products in the metric itself, they do not depend on the coordinates.
//!
//! *Guarantee.* The determinant falls with all that is accepted. Where no exchange is left no C-step leads on: a row kept
//! that is farther than one left out has g < 0 with it.
//! *Trap.* Rows beyond the border are not looked at while it moves: C-steps on all rows follow, and then the border
//! again, until neither leads on.
//! *Reference.* Hawkins, Computational Statistics & Data Analysis 17, 1994, for exchanges; the factor follows from the
//! determinant lemma for the change of rank 2.

use taut_kernels::vector::{add_scaled, dot};
use taut_points::OrderBy;

use super::concentrate::Raw;
use super::search::{GOLDEN, mix};
use super::starts::nearest;
use crate::Error;
use crate::ellipsoid::dense::{cholesky, forward};
use crate::ellipsoid::point_reader::PointReader;

/// This many rows on either side are looked at. On 10⁵ points ends were no lower with 3000.
const BORDER_ROWS: usize = 2000;
/// Pairs are tried of this many rows on either side; where distances are equal all could be within reach.
const PAIRED_ROWS: usize = 100;
/// Part of the squared distances by which g has to be negative: a hundred times what rounding leaves of them.
const ROUNDING: f64 = 1e-12;

/// A perturbation bends distances, times h, at least this far; each size is twice the one before. On 10⁵ points perturbations of 128
/// and less led back to where they came from.
const KICK_SIZE_MIN: f64 = 256.0;
const KICK_SIZES: u64 = 6;

/// Rows at the border of those kept, in the metric these had at first.
pub(super) struct Border {
    dim: usize,
    h: usize,
    ids: Vec<u64>,
    /// y, row by row, in order of |y|.
    images: Vec<f64>,
    state: State,
}

#[derive(Clone)]
struct State {
    kept: Vec<bool>,
    /// Σ y of all rows kept.
    sum: Vec<f64>,
    /// Σ yy′ of all rows kept, lower triangle.
    products: Vec<f64>,
    log_det: f64,
}

/// z = L⁻¹(y − m).
struct Metric {
    mean: Vec<f64>,
    lower: Vec<f64>,
}

impl Metric {
    fn enter(&self, image: &mut [f64]) {
        image.iter_mut().zip(&self.mean).for_each(|(y, m)| *y -= m);
        forward(&self.lower, image.len(), image);
    }

    fn log_det(&self) -> f64 {
        let dim = self.mean.len();
        2.0 * (0..dim).map(|a| self.lower[a * dim + a].ln()).sum::<f64>()
    }
}

impl State {
    /// Row y comes in (1) or goes out (−1).
    fn add(&mut self, y: &[f64], sign: f64) {
        let dim = y.len();
        add_scaled(&mut self.sum, sign, y);
        for (a, row) in self.products.chunks_exact_mut(dim).enumerate() {
            add_scaled(&mut row[..=a], sign * y[a], &y[..=a]);
        }
    }

    /// Mean and covariance of the h rows kept; nothing where rounding makes the covariance flat.
    fn metric(&self, h: usize) -> Option<Metric> {
        let (dim, h) = (self.sum.len(), h as f64);
        let mean: Vec<f64> = self.sum.iter().map(|s| s / h).collect();
        let mut lower = self.products.clone();
        for a in 0..dim {
            for b in 0..=a {
                let entry = &mut lower[a * dim + b];
                *entry = (*entry - h * mean[a] * mean[b]) / (h - 1.0);
            }
        }
        cholesky(&mut lower, dim).then_some(Metric { mean, lower })
    }
}

impl Border {
    /// Of the rows kept in `raw`; nothing where all are kept.
    pub(super) fn of(data: &mut PointReader<'_>, raw: &Raw) -> Result<Option<Border>, Error> {
        let dim = data.dim();
        let distances = raw.estimate.distances(data)?;
        let h = raw.kept.iter().filter(|kept| **kept).count();
        if h == raw.kept.len() || h <= dim {
            return Ok(None);
        }
        let mut rows: Vec<(f64, u64)> = vec![];
        for side in [true, false] {
            let all = distances.iter().zip(&raw.kept).zip(0..);
            let mut these: Vec<(f64, u64)> =
                all.filter(|((_, kept), _)| **kept == side).map(|((d, _), id)| (*d, id)).collect();
            let outward = |a: &(f64, u64), b: &(f64, u64)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            if these.len() > BORDER_ROWS {
                let order = |a: &_, b: &_| if side { outward(b, a) } else { outward(a, b) };
                these.select_nth_unstable_by(BORDER_ROWS, order);
                these.truncate(BORDER_ROWS);
            }
            these.sort_unstable_by(outward);
            rows.extend(these);
        }
        rows.retain(|(distance, _)| distance.is_finite());
        let ids: Vec<u64> = rows.into_iter().map(|(_, id)| id).collect();
        let values = data.rows(&ids)?;
        let images = values.chunks_exact(dim).flat_map(|x| raw.estimate.image(x)).collect();
        let kept = ids.iter().map(|&id| raw.kept[id as usize]).collect();
        let mut products = vec![0.0; dim * dim];
        (0..dim).for_each(|a| products[a * dim + a] = h as f64 - 1.0);
        let state = State { kept, sum: vec![0.0; dim], products, log_det: 0.0 };
        Ok(Some(Border { dim, h, ids, images, state }))
    }

    /// Goes down by C-steps and exchanges, and from this many `perturbations`; the rows kept in the end, where some were changed.
    pub(super) fn search(mut self, raw: &Raw, perturbations: u64) -> Option<Vec<bool>> {
        let first = self.state.clone();
        self.settle();
        for which in 0..perturbations {
            let here = self.state.clone();
            let is_lower = self.perturb(which).is_some() && {
                self.settle();
                self.state.log_det < here.log_det - ROUNDING / self.h as f64
            };
            if !is_lower {
                self.state = here;
            }
        }
        (self.state.kept != first.kept).then(|| {
            let mut kept = raw.kept.clone();
            for (&id, &now) in self.ids.iter().zip(&self.state.kept) {
                kept[id as usize] = now;
            }
            kept
        })
    }

    /// Keeps the rows that are marked instead of those that are.
    fn keep(&mut self, marks: &[bool]) -> Option<()> {
        for (at, y) in self.images.chunks_exact(self.dim).enumerate() {
            if self.state.kept[at] != marks[at] {
                self.state.add(y, if marks[at] { 1.0 } else { -1.0 });
                self.state.kept[at] = marks[at];
            }
        }
        self.state.log_det = self.state.metric(self.h)?.log_det();
        Some(())
    }

    /// All rows in a metric.
    fn seen(&self, metric: &Metric) -> Vec<f64> {
        let mut images = self.images.clone();
        images.chunks_exact_mut(self.dim).for_each(|image| metric.enter(image));
        images
    }

    /// C-steps and exchanges until neither leads down.
    fn settle(&mut self) {
        let count = self.state.kept.iter().filter(|kept| **kept).count();
        while let Some(metric) = self.state.metric(self.h) {
            self.state.log_det = metric.log_det();
            let images = self.seen(&metric);
            let squares: Vec<f64> = images.chunks_exact(self.dim).map(|z| dot(z, z)).collect();
            let steps: [&dyn Fn() -> Option<Vec<bool>>; 2] =
                [&|| Some(nearest(&squares, count)), &|| self.exchanged(&images, &squares)];
            let before = self.state.clone();
            let mut leads_on = false;
            for marks in steps.map(|step| step()).into_iter().flatten() {
                let moved = marks != self.state.kept && self.keep(&marks).is_some();
                leads_on = moved && self.state.log_det < before.log_det;
                if leads_on {
                    break;
                }
                self.state = before.clone();
            }
            if !leads_on {
                break;
            }
        }
    }

    /// The marks after all exchanges at the very border, where some lower the determinant.
    fn exchanged(&self, images: &[f64], squares: &[f64]) -> Option<Vec<bool>> {
        let side = |side: bool| (0..squares.len()).filter(move |&at| self.state.kept[at] == side);
        let farthest = side(true).fold(0.0f64, |far, at| far.max(squares[at]));
        let nearest = side(false).fold(f64::INFINITY, |near, at| near.min(squares[at]));
        let reach = (4.0 * farthest + farthest * farthest) / (self.h as f64 - 1.0);
        let edge = |kept: bool| -> Vec<Edge> {
            let is_near = |d: f64| if kept { d >= nearest - reach } else { d <= farthest + reach };
            let mut rows: Vec<usize> = side(kept).filter(|&at| is_near(squares[at])).collect();
            rows.order_by(&|&a, &b| {
                let outward = squares[a].total_cmp(&squares[b]);
                if kept { outward.reverse() } else { outward }
            });
            rows.truncate(PAIRED_ROWS);
            let image = |at: usize| images[at * self.dim..(at + 1) * self.dim].to_vec();
            rows.into_iter().map(|at| Edge { at, image: image(at) }).collect()
        };
        let (mut inside, mut outside) = (edge(true), edge(false));
        let mut marks = None;
        while let Some((i, j)) = best_pair(&inside, &outside, self.h) {
            let Some(metric) = after(&inside[i].image, &outside[j].image, self.h) else { break };
            let marks = marks.get_or_insert_with(|| self.state.kept.clone());
            (marks[inside[i].at], marks[outside[j].at]) = (false, true);
            std::mem::swap(&mut inside[i], &mut outside[j]);
            inside.iter_mut().chain(&mut outside).for_each(|edge| metric.enter(&mut edge.image));
        }
        marks
    }

    /// Keeps the rows that are nearest when distances are bent along a row of the border.
    fn perturb(&mut self, which: u64) -> Option<()> {
        let metric = self.state.metric(self.h)?;
        let images = self.seen(&metric);
        let count = self.state.kept.iter().filter(|kept| **kept).count();
        let lot = mix((which + 1).wrapping_mul(GOLDEN));
        let rows = self.state.kept.len();
        let row = (lot >> 8) as usize % rows;
        let along = &images[row * self.dim..(row + 1) * self.dim];
        let length = dot(along, along).sqrt();
        let size = (KICK_SIZE_MIN * f64::from(1u32 << (lot % KICK_SIZES)) / self.h as f64).min(0.5);
        let size = if lot & (1 << 60) == 0 { size } else { -size };
        let bent = |z: &[f64]| {
            let product = dot(z, along);
            let bend = if lot & (1 << 61) == 0 { product } else { product * product / length };
            dot(z, z) + size * bend / length
        };
        let squares: Vec<f64> = images.chunks_exact(self.dim).map(bent).collect();
        self.keep(&nearest(&squares, count))
    }
}

/// A row at the very border.
struct Edge {
    at: usize,
    /// z.
    image: Vec<f64>,
}

/// The pair whose exchange lowers the determinant most, if one does; of equal ones the first.
fn best_pair(inside: &[Edge], outside: &[Edge], h: usize) -> Option<(usize, usize)> {
    let squares: Vec<f64> = outside.iter().map(|edge| dot(&edge.image, &edge.image)).collect();
    let (mut best, mut pair) = (0.0, None);
    for (i, one) in inside.iter().enumerate() {
        let a = dot(&one.image, &one.image);
        for (j, (other, &b)) in outside.iter().zip(&squares).enumerate() {
            let change = change(a, b, dot(&one.image, &other.image), h);
            if change < best && change < -ROUNDING * (a + b) {
                (best, pair) = (change, Some((i, j)));
            }
        }
    }
    pair
}

/// g for squared distances a and b, and their inner product: an exchange multiplies the determinant by 1 + g/(h − 1).
fn change(a: f64, b: f64, product: f64, h: usize) -> f64 {
    let h = h as f64;
    let apart = a + b - 2.0 * product;
    b - a - apart / h - (a * b - product * product) / (h - 1.0)
}

/// The metric after the row at y gave its place to that at z, of h rows, as seen from the one before; nothing where
/// rounding makes it flat.
fn after(y: &[f64], z: &[f64], h: usize) -> Option<Metric> {
    let dim = y.len();
    let mut products = vec![0.0; dim * dim];
    (0..dim).for_each(|a| products[a * dim + a] = h as f64 - 1.0);
    let mut state = State { kept: vec![], sum: vec![0.0; dim], products, log_det: 0.0 };
    state.add(y, -1.0);
    state.add(z, 1.0);
    state.metric(h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exchange_multiplies_the_determinant_as_said() {
        let rows = [[1.2, -0.3, 0.7], [0.1, 1.9, -0.4], [-0.8, 0.2, 0.3], [0.0, 0.0, 2.5]];
        for h in [10, 30, 5000] {
            for y in &rows {
                for z in &rows {
                    let g = change(dot(y, y), dot(z, z), dot(y, z), h);
                    let wanted = (g / (h as f64 - 1.0)).ln_1p();
                    let found = after(y, z, h).expect("not flat").log_det();
                    assert!((found - wanted).abs() < 1e-14, "{h}: {found} of {wanted}");
                }
            }
        }
    }
}
