//! The exact smallest ball of a few items: points, points with weights, balls.
//!
//! *Problem.* Items p₁…pₘ, mostly two to twenty: the centre c that minimises the largest reach, |pᵢ − c| or wᵢ|pᵢ − c| or
//! |pᵢ − c| + rᵢ. A search asks for it again and again, each time with one item more.
//! *Idea.* The ball is that of its support, at most d + 1 items whose centres it holds in their hull: c = Σβᵢpᵢ, β ≥ 0. An
//! item q outside is in the support of the ball of the old support and q, so that one is among the balls through q and some of
//! the old support: up to four of these are all tried, and the one from whose centre the others reach least far is taken. Then
//! the farthest of all items enters, until none is outside. The radius grows with each.
//! *Through m + 1 items:* with eᵢ = pᵢ − p₀ and t = R², or R − r₀ for balls, 2eᵢ′(c − p₀) is linear in t, which a QR
//! factorisation of the eᵢ turns into c = p₀ + Q(y₀ + t·y₁); what is left is one equation in t, of degree two.
//! *Guarantee.* At any moment the ball is that of some of its items, and β proves a lower bound on its radius
//! ([`Ball::lower_bound`]) whatever rounding did before: for points of weight w, R² ≥ Σβᵢ|pᵢ − c|² / Σβᵢ/wᵢ² with c = Σβᵢpᵢ.
//! *Trap.* Balls through nearly dependent items have centres far away and weights of any sign; they are not judged by these
//! but by how far the others reach, and so never taken in place of a smaller one.
//! *Reference.* The loop is that of Gärtner, Fast and robust smallest enclosing balls, ESA 1999; that an entering item stays in
//! the support holds for balls, too (Fischer and Gärtner, SoCG 2003), where Welzl's recursion does not.

use super::items::{ItemSet, Position, Shape, distance, square};

/// What rounding may add to a reach; in parts of the radius.
pub(super) const TOLERANCE: f64 = 1e-13;
/// Edges whose part across the others is a smaller part of them than this span no ball of their own.
const DEPENDENT: f64 = 1e-11;
/// Supports up to this size are tried in full, larger ones only when dropping items one by one has led nowhere.
const FEW: usize = 4;

/// A smallest ball, with what proves it.
#[derive(Clone, Debug)]
pub(super) struct Ball<P> {
    pub(super) center: P,
    pub(super) radius: f64,
    /// Items that determine it.
    pub(super) support: Vec<u32>,
    /// β, one for each of the support, of sum 1.
    pub(super) shares: Vec<f64>,
}

/// Room for calculations, kept so that none of them asks for memory.
#[derive(Clone)]
pub(super) struct Workspace<P> {
    /// Q by columns.
    basis: Vec<P>,
    /// R: entry (l, i), l ≤ i, at i(i + 1)/2 + l.
    upper: Vec<f64>,
    constant: Vec<f64>,
    linear: Vec<f64>,
    /// Items that a ball is to go through, the one that enters first.
    through: Vec<u32>,
    old: Vec<u32>,
    spheres: [Option<(P, f64)>; 2],
    shares: Vec<f64>,
    trial: Ball<P>,
}

impl<P: Position> Ball<P> {
    /// That of one item.
    pub(super) fn of_one(items: &ItemSet<P>, item: u32) -> Self {
        let at = item as usize;
        let (center, radius) = (items.position(at), items.radius(at));
        Ball { center, radius, support: vec![item], shares: vec![1.0] }
    }

    /// That of all of these.
    pub(super) fn of_all(items: &ItemSet<P>, members: &[u32], work: &mut Workspace<P>) -> Self {
        let mut ball = Ball::of_one(items, members[0]);
        ball.grow(items, members, members[0], f64::INFINITY, work);
        ball
    }

    /// Whether an item is inside, but for rounding.
    #[inline(always)]
    pub(super) fn holds(&self, items: &ItemSet<P>, item: u32) -> bool {
        items.reach(item as usize, &self.center) <= self.radius * (1.0 + TOLERANCE)
    }

    /// Makes it the ball of `members`, whose ball or a part of whose it is, and of `more`; once its radius is at least `limit` it
    /// may stay that of a part of them.
    pub(super) fn grow(
        &mut self,
        items: &ItemSet<P>,
        members: &[u32],
        more: u32,
        limit: f64,
        work: &mut Workspace<P>,
    ) {
        let mut entering = more;
        if self.holds(items, more) {
            match self.farthest_outside(items, members, more) {
                Some((item, _)) => entering = item,
                None => return,
            }
        }
        loop {
            let before = self.radius;
            self.enter(items, entering, work);
            if self.radius >= limit {
                return;
            }
            let Some((item, reach)) = self.farthest_outside(items, members, more) else { return };
            // The radius grows unless rounding is all that is left.
            if self.radius <= before * (1.0 + TOLERANCE) || self.support.contains(&item) {
                self.radius = self.radius.max(reach);
                return;
            }
            entering = item;
        }
    }

    fn farthest_outside(
        &self,
        items: &ItemSet<P>,
        members: &[u32],
        more: u32,
    ) -> Option<(u32, f64)> {
        let mut farthest = None;
        let mut most = self.radius * (1.0 + TOLERANCE);
        for &item in members.iter().chain(&[more]) {
            let reach = items.reach(item as usize, &self.center);
            if reach > most {
                (farthest, most) = (Some((item, reach)), reach);
            }
        }
        farthest
    }

    /// Makes it the ball of its support and an item outside.
    fn enter(&mut self, items: &ItemSet<P>, item: u32, work: &mut Workspace<P>) {
        work.old.clear();
        work.old.extend_from_slice(&self.support);
        let known = work.old.len();
        if known > FEW && self.enter_by_dropping(items, item, work) {
            return;
        }
        let mut least = f64::INFINITY;
        let alone = usize::from(items.shape() != Shape::Balls);
        for size in alone..=known.min(items.dim()) {
            for subset in (0..1u64 << known).filter(|s| s.count_ones() as usize == size) {
                work.through.clear();
                work.through.push(item);
                for (at, &old) in work.old.iter().enumerate() {
                    if subset >> at & 1 == 1 {
                        work.through.push(old);
                    }
                }
                work.spheres_through(items);
                for which in 0..2 {
                    let Some((center, radius)) = &work.spheres[which] else { continue };
                    let reaches = work.old.iter().enumerate().map(|(at, &old)| {
                        if subset >> at & 1 == 1 { 0.0 } else { items.reach(old as usize, center) }
                    });
                    let reach = reaches.fold(*radius, f64::max);
                    if reach < least {
                        least = reach;
                        self.center.clone_from(center);
                        self.radius = reach;
                        self.support.clone_from(&work.through);
                        let is_tight = reach <= radius * (1.0 + TOLERANCE);
                        work.find_shares(items, which);
                        self.shares.clone_from(&work.shares);
                        if is_tight && self.shares.iter().all(|&share| share >= -TOLERANCE) {
                            return;
                        }
                    }
                }
            }
        }
    }

    /// The same for larger supports: from the ball through all of them, items whose share is negative leave one by one. False
    /// where that ends in a ball that does not hold the others.
    fn enter_by_dropping(
        &mut self,
        items: &ItemSet<P>,
        item: u32,
        work: &mut Workspace<P>,
    ) -> bool {
        work.through.clear();
        work.through.push(item);
        work.through.extend_from_slice(&self.support);
        loop {
            work.spheres_through(items);
            let Some((center, radius)) = work.spheres[0].clone() else { return false };
            work.find_shares(items, 0);
            let worst = (1..work.shares.len())
                .min_by(|&a, &b| work.shares[a].total_cmp(&work.shares[b]))
                .filter(|&at| work.shares[at] < 0.0);
            if let Some(at) = worst {
                work.through.remove(at);
                continue;
            }
            let reaches = work.old.iter().map(|&old| items.reach(old as usize, &center));
            if reaches.fold(0.0, f64::max) > radius * (1.0 + TOLERANCE) {
                return false;
            }
            self.center = center;
            self.radius = radius;
            self.support.clone_from(&work.through);
            self.shares.clone_from(&work.shares);
            return true;
        }
    }

    /// What the shares prove: no ball that holds the support has a smaller radius, but for a few roundings.
    pub(super) fn lower_bound(&self, items: &ItemSet<P>) -> f64 {
        let shares = || self.shares.iter().map(|share| share.max(0.0));
        let total: f64 = shares().sum();
        let first = items.at(self.support[0] as usize);
        let mut center = P::zeros(items.dim());
        for (&item, share) in self.support.iter().zip(shares()) {
            let row = items.at(item as usize);
            for ((c, x), o) in center.as_mut().iter_mut().zip(row).zip(first) {
                *c += share / total * (x - o);
            }
        }
        center.as_mut().iter_mut().zip(first).for_each(|(c, o)| *c += o);
        let mean: f64 = self
            .support
            .iter()
            .zip(shares())
            .map(|(&item, share)| share / total * items.radius(item as usize))
            .sum();
        let (mut squares, mut weights, mut largest) = (0.0, 0.0, 0.0f64);
        for (&item, share) in self.support.iter().zip(shares()) {
            let (at, share) = (item as usize, share / total);
            let beyond = items.radius(at) - mean;
            squares += share * (square(items.at(at), center.as_ref()) - beyond * beyond);
            weights += share / (items.weight(at) * items.weight(at));
            largest = largest.max(items.radius(at));
        }
        (mean + (squares.max(0.0) / weights).sqrt()).max(largest)
    }
}

impl<P: Position> Workspace<P> {
    pub(super) fn new(dim: usize) -> Self {
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
        }
    }

    /// The radius of the ball of `members`, whose ball is given, and one more; infinite where it is at least `limit`.
    pub(super) fn radius_with(
        &mut self,
        items: &ItemSet<P>,
        ball: &Ball<P>,
        members: &[u32],
        more: u32,
        limit: f64,
    ) -> f64 {
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

    /// The balls whose border goes through all of `through`, with their centre in its affine hull: at most two.
    fn spheres_through(&mut self, items: &ItemSet<P>) {
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
            let is_independent = across > DEPENDENT * length2.sqrt();
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

    /// β of the centre of a sphere: Rβ = Q′(c − p₀).
    fn find_shares(&mut self, items: &ItemSet<P>, which: usize) {
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
    // How far the centre is from a, in parts of the distance.
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

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, Points, generate};

    use super::*;
    use crate::{BallOptions, ball, ball_of_balls};

    /// Optimal by its own proof: all items are inside, and no smaller ball holds the support.
    fn judge<P: Position>(items: &ItemSet<P>, what: &str) -> f64 {
        let members: Vec<u32> = (0..items.len() as u32).collect();
        let mut work = Workspace::new(items.dim());
        let all = Ball::of_all(items, &members, &mut work);
        // One by one, as a search does.
        let mut grown = Ball::of_one(items, 0);
        for at in 1..members.len() {
            let known = &members[..at];
            let radius = work.radius_with(items, &grown, known, members[at], f64::INFINITY);
            grown.grow(items, known, members[at], f64::INFINITY, &mut work);
            assert_eq!(radius, grown.radius, "{what}");
        }
        for ball in [&all, &grown] {
            let lower = ball.lower_bound(items);
            let error = (ball.radius - lower).abs();
            assert!(error <= 1e-12 * ball.radius, "{what}: {lower} to {}", ball.radius);
            let reaches = (0..items.len()).map(|item| items.reach(item, &ball.center));
            let reach = reaches.fold(0.0, f64::max);
            assert!(reach <= ball.radius * (1.0 + 1e-12), "{what}: {reach} of {}", ball.radius);
            assert!(ball.support.len() <= items.dim() + 1, "{what}");
        }
        all.radius
    }

    fn sets<P: Position>(dim: usize) {
        for seed in 0..150 {
            let n = 1 + seed as usize % 23;
            let values: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
            // Every third set is a grid, with copies, lines and cospherical items.
            let values: Vec<f64> = match seed % 3 {
                0 => values.iter().map(|v| (2.0 * v).round()).collect(),
                _ => values,
            };
            let extras: Vec<f64> = generate(Distribution::Uniform, n, 1, seed).unwrap();
            let extras: Vec<f64> = match seed % 3 {
                0 => extras.iter().map(|v| (2.0 * v.abs()).round() + 0.5).collect(),
                _ => extras.iter().map(|v| v.abs() + 0.01).collect(),
            };
            for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
                let mut items = ItemSet::<P>::new(shape, dim);
                for (row, &extra) in values.chunks_exact(dim).zip(&extras) {
                    items.push(row, extra);
                }
                let what = format!("{shape:?} {dim} × {n}, seed {seed}");
                let radius = judge(&items, &what);
                let options = BallOptions { epsilon: 1e-12, ..BallOptions::default() };
                let wanted = match shape {
                    Shape::Points => ball(&Points::new(&values, dim).unwrap(), &options),
                    Shape::Balls => {
                        let rows: Vec<f64> = (values.chunks_exact(dim).zip(&extras))
                            .flat_map(|(row, &r)| row.iter().copied().chain([r]))
                            .collect();
                        ball_of_balls(&Points::new(&rows, dim + 1).unwrap(), &options)
                    }
                    Shape::Weighted => continue,
                };
                let wanted = wanted.unwrap().answer.radius;
                assert!((radius - wanted).abs() <= 1e-11 * wanted, "{what}: {radius}, {wanted}");
            }
        }
    }

    #[test]
    fn balls_prove_themselves() {
        sets::<[f64; 1]>(1);
        sets::<[f64; 2]>(2);
        sets::<[f64; 3]>(3);
        sets::<Vec<f64>>(2);
        sets::<Vec<f64>>(6);
    }

    /// Three points on a circle of radius 5 around (1, 2), and its centre.
    #[test]
    fn a_circle() {
        let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
        for row in [[1.0, 2.0], [6.0, 2.0], [-3.0, 5.0], [-2.0, -2.0]] {
            items.push(&row, 0.0);
        }
        let ball = Ball::of_all(&items, &[0, 1, 2, 3], &mut Workspace::new(2));
        assert!((ball.radius - 5.0).abs() <= 1e-14);
        assert!(distance(&ball.center, &[1.0, 2.0]) <= 1e-14);
        assert_eq!(ball.support.len(), 3);
        assert!((ball.shares.iter().sum::<f64>() - 1.0).abs() <= 1e-15);
    }
}
