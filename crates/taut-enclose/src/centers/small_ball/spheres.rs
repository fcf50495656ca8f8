//! Balls through a few items, and the room in which they are worked out.
//!
//! *Through m + 1 items:* with eᵢ = pᵢ − p₀ and t = R², or R − r₀ for balls, 2eᵢ′(c − p₀) is linear in t, which a QR
//! factorization of the eᵢ turns into c = p₀ + Q(y₀ + t·y₁); what is left is one equation in t, of degree two.

use super::active_set::ActiveSet;
use super::{Ball, low_dimension};
use crate::centers::items::{ItemSet, Position, Shape, distance};

/// Edges whose part across the others is a smaller part of them than this span no ball of their own.
const DEPENDENT_RATIO: f64 = 1e-11;

/// Room for calculations, kept so that none of them asks for memory.
#[derive(Clone)]
pub(in crate::centers) struct Workspace<P> {
    /// Q by columns.
    basis: Vec<P>,
    /// R: entry (l, i), l ≤ i, at i(i + 1)/2 + l.
    upper: Vec<f64>,
    constant: Vec<f64>,
    linear: Vec<f64>,
    /// Items that a ball is to go through, the one that enters first.
    pub(super) through: Vec<u32>,
    pub(super) old: Vec<u32>,
    pub(super) spheres: [Option<(P, f64)>; 2],
    pub(super) shares: Vec<f64>,
    trial: Ball<P>,
    pub(super) active_set: ActiveSet,
}

impl<P: Position> Workspace<P> {
    pub(in crate::centers) fn new(dim: usize) -> Self {
        Workspace {
            basis: vec![],
            upper: vec![],
            constant: vec![],
            linear: vec![],
            through: vec![],
            old: vec![],
            spheres: [None, None],
            shares: vec![],
            trial: Ball { center: P::zeros(dim), radius: 0.0, support: vec![], shares: vec![] },
            active_set: ActiveSet::default(),
        }
    }

    /// The radius of the ball of `members`, whose ball is given, and one more; infinite where it is at least `limit`.
    pub(in crate::centers) fn radius_with(
        &mut self,
        items: &ItemSet<P>,
        ball: &Ball<P>,
        members: &[u32],
        more: u32,
        limit: f64,
    ) -> f64 {
        let quick = match P::width(items.dim()) {
            2 if items.shape() == Shape::Points => {
                low_dimension::radius_with::<2, P>(items, ball, members, more, limit)
            }
            3 if items.shape() == Shape::Points => {
                low_dimension::radius_with::<3, P>(items, ball, members, more, limit)
            }
            _ => None,
        };
        if let Some(radius) = quick {
            return radius;
        }
        let mut trial = std::mem::replace(
            &mut self.trial,
            Ball { center: P::zeros(0), radius: 0.0, support: vec![], shares: vec![] },
        );
        trial.center.clone_from(&ball.center);
        trial.radius = ball.radius;
        trial.support.clone_from(&ball.support);
        trial.shares.clone_from(&ball.shares);
        trial.grow(items, members, more, limit, self);
        let radius = trial.radius;
        self.trial = trial;
        if radius < limit { radius } else { f64::INFINITY }
    }

    /// The balls whose border goes through all of `through`, with their center in its affine hull: at most two.
    pub(super) fn spheres_through(&mut self, items: &ItemSet<P>) {
        self.spheres = [None, None];
        match self.through[..] {
            [first] => {
                let first = first as usize;
                self.spheres[0] = Some((items.position(first), items.radius(first)));
            }
            [first, other] => self.spheres[0] = pair(items, first as usize, other as usize),
            _ => {
                if self.factor(items) {
                    self.solve(items);
                }
            }
        }
    }

    /// QR of the edges from the first item, by modified Gram–Schmidt; false where they are dependent.
    fn factor(&mut self, items: &ItemSet<P>) -> bool {
        let origin = items.at(self.through[0] as usize);
        self.basis.clear();
        self.upper.clear();
        self.constant.clear();
        self.linear.clear();
        let first = self.through[0] as usize;
        let slack = |item: usize| 1.0 / (items.weight(item) * items.weight(item));
        for &item in &self.through[1..] {
            let item = item as usize;
            let mut edge = P::zeros(items.dim());
            for ((e, x), o) in edge.as_mut().iter_mut().zip(items.at(item)).zip(origin) {
                *e = x - o;
            }
            let length2 = dot(edge.as_ref(), edge.as_ref());
            let (mut constant, mut linear) = match items.shape() {
                Shape::Points => (0.5 * length2, 0.0),
                Shape::Weighted => (0.5 * length2, 0.5 * (slack(first) - slack(item))),
                Shape::Balls => {
                    let larger = items.radius(item) - items.radius(first);
                    (0.5 * (length2 - larger * larger), larger)
                }
            };
            for (l, direction) in self.basis.iter().enumerate() {
                let part = dot(direction.as_ref(), edge.as_ref());
                for (e, q) in edge.as_mut().iter_mut().zip(direction.as_ref()) {
                    *e -= part * q;
                }
                self.upper.push(part);
                constant -= part * self.constant[l];
                linear -= part * self.linear[l];
            }
            let across = dot(edge.as_ref(), edge.as_ref()).sqrt();
            // Also where numbers are none.
            let is_independent = across > DEPENDENT_RATIO * length2.sqrt();
            if !is_independent {
                return false;
            }
            edge.as_mut().iter_mut().for_each(|e| *e /= across);
            self.upper.push(across);
            self.basis.push(edge);
            self.constant.push(constant / across);
            self.linear.push(linear / across);
        }
        true
    }

    /// The equation in t that is left.
    fn solve(&mut self, items: &ItemSet<P>) {
        let first = self.through[0] as usize;
        if items.shape() == Shape::Points {
            let radius = dot(&self.constant, &self.constant).sqrt();
            self.spheres[0] = Some((self.center_at(items, 0.0), radius));
            return;
        }
        // a·t² + 2b·t + c = 0.
        let c = dot(&self.constant, &self.constant);
        let mut b = dot(&self.constant, &self.linear);
        let mut a = dot(&self.linear, &self.linear);
        match items.shape() {
            Shape::Weighted => b -= 0.5 / (items.weight(first) * items.weight(first)),
            _ => a -= 1.0,
        }
        let root = (b * b - a * c).max(0.0).sqrt();
        let sum = if b > 0.0 { -b - root } else { -b + root };
        for (which, t) in [c / sum, sum / a].into_iter().enumerate() {
            if !(t.is_finite() && t >= 0.0) {
                continue;
            }
            let center = self.center_at(items, t);
            // Of the wrong root, items reach elsewhere: the largest reach is what counts.
            let reaches = self.through.iter().map(|&item| items.reach(item as usize, &center));
            let radius = reaches.fold(0.0, f64::max);
            self.spheres[which] = Some((center, radius));
        }
    }

    /// p₀ + Q(y₀ + t·y₁).
    fn center_at(&self, items: &ItemSet<P>, t: f64) -> P {
        let mut center = items.position(self.through[0] as usize);
        for ((direction, constant), linear) in
            self.basis.iter().zip(&self.constant).zip(&self.linear)
        {
            let along = constant + t * linear;
            for (c, q) in center.as_mut().iter_mut().zip(direction.as_ref()) {
                *c += along * q;
            }
        }
        center
    }

    /// β of the center of a sphere: Rβ = Q′(c − p₀).
    pub(super) fn find_shares(&mut self, items: &ItemSet<P>, which: usize) {
        let count = self.through.len();
        self.shares.clear();
        self.shares.resize(count, 0.0);
        let Some((center, _)) = &self.spheres[which] else { return };
        let origin = items.at(self.through[0] as usize);
        match count {
            1 => {}
            2 => {
                let edge = distance(items.at(self.through[1] as usize), origin);
                self.shares[1] = distance(center.as_ref(), origin) / edge;
            }
            _ => {
                for l in (0..count - 1).rev() {
                    let mut value = 0.0;
                    for ((q, c), o) in
                        self.basis[l].as_ref().iter().zip(center.as_ref()).zip(origin)
                    {
                        value += q * (c - o);
                    }
                    for i in l + 1..count - 1 {
                        value -= self.upper[i * (i + 1) / 2 + l] * self.shares[i + 1];
                    }
                    self.shares[l + 1] = value / self.upper[l * (l + 1) / 2 + l];
                }
            }
        }
        self.shares[0] = 1.0 - self.shares[1..].iter().sum::<f64>();
    }
}

/// The ball of two items that touches both.
fn pair<P: Position>(items: &ItemSet<P>, a: usize, b: usize) -> Option<(P, f64)> {
    let apart = distance(items.at(a), items.at(b));
    if apart == 0.0 {
        return None;
    }
    let radius = items.pair_radius(a, b);
    // The distance of the center from a, in parts of the distance.
    let part = match items.shape() {
        Shape::Points => 0.5,
        Shape::Weighted => items.weight(b) / (items.weight(a) + items.weight(b)),
        Shape::Balls => (radius - items.radius(a)) / apart,
    };
    if part > 1.0 {
        return None;
    }
    let mut center = items.position(a);
    for (c, x) in center.as_mut().iter_mut().zip(items.at(b)) {
        *c += part * (x - *c);
    }
    Some((center, radius))
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
