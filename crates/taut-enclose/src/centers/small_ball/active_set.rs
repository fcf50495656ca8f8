//! The smallest ball of more items than can be tried in all ways: an active set over the shares.
//!
//! *Problem.* As in the module above, for supports of up to d + 1 items and d up to hundreds.
//! *Idea.* Fix R, and let gᵢ(c) = |pᵢ − c|² − ρᵢ² with ρᵢ = R, R/w or R − r: a ball of radius R exists just when some c has no
//! gᵢ(c) > 0. Over β ≥ 0 with Σβ = 1, V(β) = Σβᵢgᵢ(Σβⱼpⱼ) is concave, and its maximum is the least of the largest gᵢ(c).
//! The item that reaches farthest joins the support; from there to the maximum over all β of the support with Σβ = 1, as
//! far as β stays positive; an item whose share becomes 0 leaves, and the rest goes on. Where V > 0 in the end, R goes up to what β
//! proves, and again. For points V is R² but for a constant, and once is enough.
//! *Guarantee.* What β proves never falls, and rises with each item that is outside by more than rounding. It ends when it has
//! not risen for d and a few items; what has been proved stays proved.
//! *Trap.* Edges from one of the items would all change when that leaves. Instead each position has one coordinate more, the
//! same for all: positions are affinely independent just when these are linearly independent, no item is special, and
//! where Σβ = 1 it changes nothing.
//! *Reference.* Active sets on this dual: Gärtner and Schönherr, SoCG 2000; Fischer, Gärtner and Kutz, ESA 2003. Steps in R:
//! Dinkelbach, Management Science 13, 1967.

use taut_kernels::vector::{add_scaled, dot};

use super::Ball;
use crate::centers::items::{ItemSet, Position, Shape};

/// A position of which a smaller part is across the others depends on them.
const DEPENDENT_RATIO: f64 = 1e-11;
/// More than this counts as a rise of the radius, in parts of it.
const RADIUS_RISE_MIN: f64 = 4e-16;
/// Items may join without progress, one after the other, up to this many times beyond d.
const JOINS_WITHOUT_RISE_MAX: usize = 10;
/// R is found in at most this many steps, of which each doubles the digits.
const NEWTON_STEPS_MAX: usize = 60;

/// A support with its shares, and the factors QU of its positions: about the first of them and with one coordinate more.
#[derive(Clone, Default)]
pub(super) struct ActiveSet {
    dim: usize,
    origin: Vec<f64>,
    /// The coordinate that all have.
    height: f64,
    support: Vec<u32>,
    shares: Vec<f64>,
    places: Vec<Vec<f64>>,
    /// Q by columns.
    basis: Vec<Vec<f64>>,
    /// U by columns, down to the diagonal.
    upper: Vec<Vec<f64>>,
    /// Σβᵢpᵢ, about the origin.
    center: Vec<f64>,
}

impl ActiveSet {
    /// Makes `ball` that of `members` and `more`, of which it is that of a part and `entering` is outside; once its radius is at
    /// least `limit` it may stay that of a part of them.
    pub(super) fn grow<P: Position>(
        &mut self,
        items: &ItemSet<P>,
        ball: &mut Ball<P>,
        entering: u32,
        members: &[u32],
        more: u32,
        limit: f64,
    ) {
        let (mut entering, mut vain) = (entering, 0);
        let mut radius = self.begin(items, ball, entering);
        loop {
            let before = radius;
            if items.shape() == Shape::Balls && items.radius(entering as usize) >= radius {
                // R − r must not be negative for any of the support.
                self.clear();
                radius = items.radius(entering as usize);
            }
            self.enter(items, entering);
            radius = self.rise(items, radius);
            if self.center.iter().all(|c| c.is_finite()) {
                self.write(items, ball, radius);
            }
            if ball.radius >= limit {
                return;
            }
            let Some((item, reach)) = ball.farthest_outside(items, members, more) else { return };
            vain = if radius > before * (1.0 + RADIUS_RISE_MIN) { 0 } else { vain + 1 };
            if vain > self.dim + JOINS_WITHOUT_RISE_MAX {
                ball.radius = ball.radius.max(reach);
                return;
            }
            entering = item;
        }
    }

    /// The support and the shares of a ball; what they prove.
    fn begin<P: Position>(&mut self, items: &ItemSet<P>, ball: &Ball<P>, entering: u32) -> f64 {
        self.clear();
        self.dim = items.dim();
        self.origin.clear();
        self.origin.extend_from_slice(items.at(ball.support[0] as usize));
        self.height = 0.0;
        let all = ball.support.iter().chain([&entering]);
        let places: Vec<Vec<f64>> = all.map(|&item| self.lifted(items, item)).collect();
        self.height = places.iter().flatten().fold(0.0, |most, x| x.abs().max(most));
        for (&item, &share) in ball.support.iter().zip(&ball.shares) {
            if share > 0.0 {
                let place = self.lifted(items, item);
                let (column, rest, across) = self.split(&place);
                if across > 0.0 && self.support.len() <= self.dim {
                    self.append(item, share, place, column, rest, across);
                }
            }
        }
        let total: f64 = self.shares.iter().sum();
        self.shares.iter_mut().for_each(|share| *share /= total);
        let radius = self.proved(items);
        self.rise(items, radius)
    }

    fn clear(&mut self) {
        self.support.clear();
        self.shares.clear();
        self.places.clear();
        self.basis.clear();
        self.upper.clear();
    }

    /// The position of an item about the origin, and the height.
    fn lifted<P: Position>(&self, items: &ItemSet<P>, item: u32) -> Vec<f64> {
        let position = items.at(item as usize).iter();
        let about = position.zip(&self.origin).map(|(x, o)| x - o);
        about.chain([self.height]).collect()
    }

    /// Returns what a place is along the basis, what is left of it, of length 1, and how long that was; 0 where it depends on the support.
    fn split(&self, place: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
        let mut rest = place.to_vec();
        let mut column = vec![0.0; self.basis.len()];
        // Twice is enough to make the rest orthogonal to the last digits.
        for _ in 0..2 {
            for (along, direction) in column.iter_mut().zip(&self.basis) {
                let part = dot(direction, &rest);
                *along += part;
                add_scaled(&mut rest, -part, direction);
            }
        }
        let across = dot(&rest, &rest).sqrt();
        let is_independent = across > DEPENDENT_RATIO * dot(place, place).sqrt();
        if !is_independent {
            return (column, rest, 0.0);
        }
        rest.iter_mut().for_each(|x| *x /= across);
        (column, rest, across)
    }

    fn append(
        &mut self,
        item: u32,
        share: f64,
        place: Vec<f64>,
        mut column: Vec<f64>,
        direction: Vec<f64>,
        across: f64,
    ) {
        column.push(across);
        self.support.push(item);
        self.shares.push(share);
        self.places.push(place);
        self.basis.push(direction);
        self.upper.push(column);
    }

    /// Takes the item at a place of the support away; the columns of U after it are turned back to a triangle.
    fn remove(&mut self, at: usize) {
        self.support.remove(at);
        self.shares.remove(at);
        self.places.remove(at);
        self.upper.remove(at);
        for i in at..self.upper.len() {
            let (a, b) = (self.upper[i][i], self.upper[i][i + 1]);
            let length = a.hypot(b);
            let (cos, sin) = (a / length, b / length);
            for column in &mut self.upper[i..] {
                let (x, y) = (column[i], column[i + 1]);
                (column[i], column[i + 1]) = (cos * x + sin * y, cos * y - sin * x);
            }
            self.upper[i].truncate(i + 1);
            let (head, tail) = self.basis.split_at_mut(i + 1);
            for (x, y) in head[i].iter_mut().zip(&mut tail[0]) {
                (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
            }
        }
        self.basis.pop();
    }

    /// Takes an item to the support. While it depends on that, shares move to it along the dependence, until an item has none left
    /// and leaves.
    fn enter<P: Position>(&mut self, items: &ItemSet<P>, item: u32) {
        let place = self.lifted(items, item);
        let mut share = if self.support.is_empty() { 1.0 } else { 0.0 };
        loop {
            let (column, rest, across) = self.split(&place);
            if across > 0.0 && self.support.len() <= self.dim {
                self.append(item, share, place, column, rest, across);
                return;
            }
            let parts = self.back(column);
            let mut leaving: Option<(usize, f64)> = None;
            for (at, (part, share)) in parts.iter().zip(&self.shares).enumerate() {
                let step = share / part;
                if *part > 0.0 && leaving.is_none_or(|(_, least)| step < least) {
                    leaving = Some((at, step));
                }
            }
            // The parts have sum 1.
            let Some((leaving, step)) = leaving else { return };
            for (share, part) in self.shares.iter_mut().zip(&parts) {
                *share = (*share - step * part).max(0.0);
            }
            share += step;
            self.remove(leaving);
        }
    }

    /// x with U′x = v.
    fn forward(&self, mut v: Vec<f64>) -> Vec<f64> {
        for (i, column) in self.upper.iter().enumerate() {
            v[i] = (v[i] - dot(&column[..i], &v[..i])) / column[i];
        }
        v
    }

    /// x with Ux = v.
    fn back(&self, mut v: Vec<f64>) -> Vec<f64> {
        for (i, column) in self.upper.iter().enumerate().rev() {
            v[i] /= column[i];
            let x = v[i];
            add_scaled(&mut v[..i], -x, &column[..i]);
        }
        v
    }

    /// To the maximum of V over the shares of the support, for one R.
    fn settle<P: Position>(&mut self, items: &ItemSet<P>, radius: f64) {
        while self.support.len() > 1 {
            // 2U′Uβ = b − μ1 with bᵢ = |pᵢ|² − ρᵢ².
            let half: Vec<f64> = self
                .support
                .iter()
                .zip(&self.places)
                .map(|(&item, place)| {
                    let (item, place) = (item as usize, &place[..self.dim]);
                    let reach = match items.shape() {
                        Shape::Points => 0.0,
                        Shape::Weighted => radius / items.weight(item),
                        Shape::Balls => radius - items.radius(item),
                    };
                    0.5 * (dot(place, place) - reach * reach)
                })
                .collect();
            let plain = self.back(self.forward(half));
            let of_ones = self.back(self.forward(vec![1.0; self.support.len()]));
            let nu = (1.0 - plain.iter().sum::<f64>()) / of_ones.iter().sum::<f64>();
            let target: Vec<f64> = plain.iter().zip(&of_ones).map(|(p, o)| p + nu * o).collect();
            let mut leaving: Option<(usize, f64)> = None;
            for (at, (&to, &from)) in target.iter().zip(&self.shares).enumerate() {
                // Also where numbers are none.
                if to > 0.0 {
                    continue;
                }
                let step = if from > 0.0 && to <= 0.0 { from / (from - to) } else { 0.0 };
                if leaving.is_none_or(|(_, least)| step < least) {
                    leaving = Some((at, step));
                }
            }
            let Some((leaving, step)) = leaving else {
                self.shares = target;
                return;
            };
            if step > 0.0 {
                for (share, to) in self.shares.iter_mut().zip(&target) {
                    *share += step * (to - *share);
                }
            }
            self.remove(leaving);
        }
        self.shares.fill(1.0);
    }

    /// The radius that the shares prove, of the support alone; sets the center.
    fn proved<P: Position>(&mut self, items: &ItemSet<P>) -> f64 {
        self.center.clear();
        self.center.resize(self.dim, 0.0);
        let mut mean = 0.0;
        for ((&item, share), place) in self.support.iter().zip(&self.shares).zip(&self.places) {
            add_scaled(&mut self.center, *share, &place[..self.dim]);
            mean += share * items.radius(item as usize);
        }
        let (mut squares, mut slack) = (0.0, 0.0);
        for ((&item, share), place) in self.support.iter().zip(&self.shares).zip(&self.places) {
            let item = item as usize;
            let offsets = place.iter().zip(&self.center).map(|(x, c)| (x - c) * (x - c));
            let beyond = items.radius(item) - mean;
            squares += share * (offsets.sum::<f64>() - beyond * beyond);
            slack += share / (items.weight(item) * items.weight(item));
        }
        mean + (squares.max(0.0) / slack).sqrt()
    }

    /// To the smallest ball of the support, from a radius that is not above its own.
    fn rise<P: Position>(&mut self, items: &ItemSet<P>, radius: f64) -> f64 {
        let mut radius = radius;
        for _ in 0..NEWTON_STEPS_MAX {
            self.settle(items, radius);
            let before = radius;
            radius = self.proved(items).max(before);
            if items.shape() == Shape::Points || radius <= before * (1.0 + RADIUS_RISE_MIN) {
                break;
            }
        }
        radius
    }

    fn write<P: Position>(&self, items: &ItemSet<P>, ball: &mut Ball<P>, radius: f64) {
        let about = self.origin.iter().zip(&self.center);
        ball.center.as_mut().iter_mut().zip(about).for_each(|(c, (o, x))| *c = o + x);
        ball.support.clone_from(&self.support);
        ball.shares.clone_from(&self.shares);
        let reaches = self.support.iter().map(|&item| items.reach(item as usize, &ball.center));
        ball.radius = reaches.fold(radius, f64::max);
    }
}
