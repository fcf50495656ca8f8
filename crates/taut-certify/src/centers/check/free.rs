//! Balls with their centers anywhere: the center that is deepest within all balls in which it must lie, and the proof that
//! there is none.
//!
//! *Problem.* Items i of a cluster ask for a center c with |pᵢ − c| < ρᵢ. Is there one?
//! *Idea.* Let gᵢ(c) = |pᵢ − c|² − ρᵢ² and v = min over c of max over i of gᵢ(c): a center exists just when v < 0. For λ ≥ 0
//! with Σλᵢ = W and p̄ = Σλᵢpᵢ/W, Σλᵢgᵢ(c) = Σλᵢgᵢ(p̄) + W|c − p̄|² for every c, so that Σλᵢgᵢ(p̄) ≥ 0 proves v ≥ 0. For
//! equal ρᵢ this is the smallest enclosing ball and the proof that it is too large.
//! *Method.* v and λ grow item by item. At the optimum of a cluster, gᵢ(c) = v on a support S of affinely independent
//! items with λᵢ > 0, and c = Σλᵢpᵢ. A new item x with gₓ(c) > v gets weight t: with its projection Σαᵢpᵢ (Σαᵢ = 1) on the
//! affine hull of S and the rest n, c moves to c + tn, λ on S to λ − tα. As n is orthogonal to the hull, all gᵢ of S stay
//! equal to each other, and gₓ comes nearer to them by 2t|n|²: so t = (gₓ − gₛ)/2|n|², or as far as λ stays positive; then
//! the item whose λ is 0 leaves S and the same starts again. This is the dual method for quadratic programs; v rises
//! with each step, so it ends.
//! *Proof.* λ from the above is only approximate, which costs v to second order. What counts is the sum over the support in
//! plain arithmetic, with a bound on all that was rounded: [`Free::is_refuted`].
//! *Reference.* Goldfarb, Idnani, Math. Programming 27, 1983, of which this is a special case.

use taut_points::Cancelled;

use super::avoiding;
use super::core::{Core, Pairs};
use super::distance::difference;
use super::meter::Meter;
use super::oracle::Oracle;
use crate::arithmetic::U;

/// Items in one ball with its center anywhere.
///
/// Places are measured from the first member, yᵢ = (pᵢ − p₀)·scale, rounded once; they are formed again wherever they are
/// needed, as there may be many clusters.
#[derive(Debug, Default)]
pub(super) struct Cluster {
    members: Vec<usize>,
    fit: Fit,
}

/// The center that is deepest within the balls of a cluster, its depth, and multipliers; about p₀ and scaled.
#[derive(Debug, Default)]
pub(super) struct Fit {
    center: Vec<f64>,
    /// v.
    value: f64,
    /// Positions in the list of members, with their λ.
    support: Vec<(usize, f64)>,
}

// Written out for `clone_from`, by which scratch space is used again.
impl Clone for Fit {
    fn clone(&self) -> Self {
        Fit { center: self.center.clone(), value: self.value, support: self.support.clone() }
    }

    fn clone_from(&mut self, other: &Self) {
        self.center.clone_from(&other.center);
        self.value = other.value;
        self.support.clone_from(&other.support);
    }
}

/// A core-set with its pairs, and scratch space.
pub(super) struct Free<'a> {
    core: &'a Core,
    pairs: &'a Pairs,
    scratch: Cluster,
    hull: Hull,
}

/// The result for a cluster with one item more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tried {
    Refuted,
    /// The item lies where the deepest center is as deep as before.
    Unchanged,
    /// The scratch space holds the cluster.
    Changed,
}

impl<'a> Free<'a> {
    pub(super) fn of(core: &'a Core, pairs: &'a Pairs) -> Self {
        Free { core, pairs, scratch: Cluster::default(), hull: Hull::default() }
    }

    fn tried(
        &mut self,
        cluster: &Cluster,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Tried, Cancelled> {
        meter.spend(cluster.members.len() + self.core.dim)?;
        if !self.core.is_free(item)
            || cluster.members.iter().any(|&m| self.pairs.are_apart(item, m))
        {
            return Ok(Tried::Refuted);
        }
        if excess(self.core, cluster, item) <= cluster.fit.value {
            return Ok(Tried::Unchanged);
        }
        let scratch = &mut self.scratch;
        scratch.members.clone_from(&cluster.members);
        scratch.fit.clone_from(&cluster.fit);
        scratch.members.push(item);
        fit(self.core, scratch, &mut self.hull, meter)?;
        Ok(match scratch.fit.value >= -1e-9 && is_refuted(self.core, scratch) {
            true => Tried::Refuted,
            false => Tried::Changed,
        })
    }
}

impl Oracle for Free<'_> {
    type Cluster = Cluster;
    /// The fit before, where it changed.
    type Undo = Option<Fit>;

    fn len(&self) -> usize {
        self.core.len()
    }

    fn open(&mut self, item: usize) -> Option<Cluster> {
        let fit = Fit {
            center: vec![0.0; self.core.dim],
            value: -square(self.core.reach(item)),
            support: vec![(0, 1.0)],
        };
        self.core.is_free(item).then_some(Cluster { members: vec![item], fit })
    }

    fn grow(
        &mut self,
        cluster: &mut Cluster,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Option<Fit>>, Cancelled> {
        let before = match self.tried(cluster, item, meter)? {
            Tried::Refuted => return Ok(None),
            Tried::Unchanged => None,
            Tried::Changed => Some(std::mem::replace(&mut cluster.fit, self.scratch.fit.clone())),
        };
        cluster.members.push(item);
        Ok(Some(before))
    }

    fn undo(&self, cluster: &mut Cluster, before: Option<Fit>) {
        cluster.members.pop();
        if let Some(fit) = before {
            cluster.fit = fit;
        }
    }

    fn is_held_out(
        &self,
        cluster: &Cluster,
        left_out: &[usize],
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        avoiding::is_held_out(self.core, &cluster.members, left_out, meter)
    }

    fn undo_bytes(before: &Option<Fit>) -> usize {
        let bytes = |fit: &Fit| size_of_val(&fit.center[..]) + size_of_val(&fit.support[..]);
        before.as_ref().map_or(0, bytes)
    }
}

fn square(value: f64) -> f64 {
    value * value
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// (p − o)·scale.
fn relative(core: &Core, origin: usize, item: usize) -> impl Iterator<Item = f64> {
    let places = core.place(item).iter().zip(core.place(origin));
    places.map(|(&x, &o)| difference(x, o, core.scale))
}

/// yᵢ of a member.
fn place(core: &Core, cluster: &Cluster, member: usize) -> impl Iterator<Item = f64> {
    relative(core, cluster.members[0], cluster.members[member])
}

/// gᵢ(c) of any item.
fn excess(core: &Core, cluster: &Cluster, item: usize) -> f64 {
    let places = relative(core, cluster.members[0], item).zip(&cluster.fit.center);
    let distance: f64 = places.map(|(y, c)| square(y - c)).sum();
    distance - square(core.reach(item))
}

/// Brings the fit of a cluster to its optimum, when all but the last member are at theirs, and that one is farther.
fn fit(
    core: &Core,
    cluster: &mut Cluster,
    hull: &mut Hull,
    meter: &mut Meter<'_>,
) -> Result<(), Cancelled> {
    // The depth counts in units of ρ², which is 1 or more.
    const DEPTH_TOLERANCE: f64 = 1e-15;
    let mut member = cluster.members.len() - 1;
    // Each round raises v, so no support occurs twice; rounding alone needs an end set.
    for _ in 0..8 + 4 * cluster.members.len() {
        admit(core, cluster, member, hull, meter)?;
        meter.spend(cluster.members.len() * core.dim)?;
        let mut least = f64::NEG_INFINITY;
        member = 0;
        for (other, &item) in cluster.members.iter().enumerate() {
            let excess = excess(core, cluster, item);
            if excess > least {
                (member, least) = (other, excess);
            }
        }
        let scale = least.abs().max(square(core.reach(cluster.members[member])));
        let is_in_support = cluster.fit.support.iter().any(|&(other, _)| other == member);
        if is_in_support || least <= cluster.fit.value + DEPTH_TOLERANCE * scale {
            break;
        }
    }
    Ok(())
}

/// Gives weight to one member that is farther than the support.
fn admit(
    core: &Core,
    cluster: &mut Cluster,
    member: usize,
    hull: &mut Hull,
    meter: &mut Meter<'_>,
) -> Result<(), Cancelled> {
    let item = cluster.members[member];
    let mut weight = 0.0;
    while !cluster.fit.support.is_empty() {
        hull.project(core, cluster, member, meter)?;
        let first = cluster.members[cluster.fit.support[0].0];
        let wanted = excess(core, cluster, item) - excess(core, cluster, first);
        let full = match hull.is_flat {
            true => f64::INFINITY,
            false => (wanted / (2.0 * hull.rest_square)).max(0.0),
        };
        let (mut step, mut leaves) = (full, None);
        for (position, (&alpha, &(_, lambda))) in
            hull.alpha.iter().zip(&cluster.fit.support).enumerate()
        {
            if alpha > 0.0 && lambda / alpha < step {
                (step, leaves) = (lambda / alpha, Some(position));
            }
        }
        if step == f64::INFINITY {
            break;
        }
        weight += step;
        for (c, n) in cluster.fit.center.iter_mut().zip(&hull.rest) {
            *c += step * n;
        }
        for ((_, lambda), alpha) in cluster.fit.support.iter_mut().zip(&hull.alpha) {
            *lambda = (*lambda - step * alpha).max(0.0);
        }
        match leaves {
            Some(position) => drop(cluster.fit.support.swap_remove(position)),
            None => break,
        }
    }
    if cluster.fit.support.is_empty() {
        cluster.fit.center.clear();
        cluster.fit.center.extend(relative(core, cluster.members[0], item));
        weight = 1.0;
    }
    cluster.fit.support.push((member, weight));
    cluster.fit.value = excess(core, cluster, item);
    Ok(())
}

/// The projection of a place on the affine hull of the support; scratch space.
#[derive(Default)]
struct Hull {
    /// An orthonormal basis of the hull, from its first place.
    basis: Vec<f64>,
    /// The triangle R with edges = R·basis, row by row.
    triangle: Vec<f64>,
    /// α.
    alpha: Vec<f64>,
    /// n and |n|².
    rest: Vec<f64>,
    rest_square: f64,
    /// True if nothing of n can be told from rounding.
    is_flat: bool,
    coefficients: Vec<f64>,
}

impl Hull {
    fn project(
        &mut self,
        core: &Core,
        cluster: &Cluster,
        member: usize,
        meter: &mut Meter<'_>,
    ) -> Result<(), Cancelled> {
        let (support, dim) = (&cluster.fit.support, core.dim);
        let (origin, edges) = (support[0].0, support.len() - 1);
        meter.spend(2 * dim * (edges + 1) * (edges + 2))?;
        self.basis.clear();
        self.triangle.clear();
        self.triangle.resize(edges * edges, 0.0);
        for edge in 0..edges {
            self.take(core, cluster, origin, support[edge + 1].0);
            let before = self.coefficients.len();
            let length = self.rest_square.sqrt();
            for (column, &coefficient) in self.coefficients.iter().enumerate() {
                self.triangle[edge * edges + column] = coefficient;
            }
            debug_assert_eq!(before, edge);
            self.triangle[edge * edges + edge] = length;
            let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
            self.basis.extend(self.rest.iter().map(|n| n * inverse));
        }
        let size = self.take(core, cluster, origin, member);
        self.is_flat = edges >= dim || self.rest_square <= 1e-24 * size;
        // Σ βₑ·edgeₑ = Σ coefficients·basis, from the last edge to the first.
        self.alpha.clear();
        self.alpha.resize(edges + 1, 0.0);
        for edge in (0..edges).rev() {
            let above: f64 = (edge + 1..edges)
                .map(|later| self.alpha[later + 1] * self.triangle[later * edges + edge])
                .sum();
            let diagonal = self.triangle[edge * edges + edge];
            let beta = (self.coefficients[edge] - above) / diagonal;
            self.alpha[edge + 1] = if beta.is_finite() { beta } else { 0.0 };
        }
        self.alpha[0] = 1.0 - self.alpha[1..].iter().sum::<f64>();
        if self.is_flat {
            self.rest.fill(0.0);
            self.rest_square = 0.0;
        }
        Ok(())
    }

    /// Splits the edge from `origin` to `member` into its part within the basis and the rest; the square of its length.
    fn take(&mut self, core: &Core, cluster: &Cluster, origin: usize, member: usize) -> f64 {
        let dim = core.dim;
        self.rest.clear();
        let ends = place(core, cluster, member).zip(place(core, cluster, origin));
        self.rest.extend(ends.map(|(p, o)| p - o));
        let size = dot(&self.rest, &self.rest);
        self.coefficients.clear();
        self.coefficients.resize(self.basis.len() / dim, 0.0);
        // Twice is enough to make the rest orthogonal to the last bits.
        for _ in 0..2 {
            for (coefficient, direction) in
                self.coefficients.iter_mut().zip(self.basis.chunks_exact(dim))
            {
                let along = dot(&self.rest, direction);
                *coefficient += along;
                for (n, q) in self.rest.iter_mut().zip(direction) {
                    *n -= along * q;
                }
            }
        }
        self.rest_square = dot(&self.rest, &self.rest);
        size
    }
}

/// Returns true if the multipliers prove that no center exists.
///
/// With W = Σλᵢ, any c and M = Σλᵢ(pᵢ − c), Σλᵢgᵢ(p̄) = Σλᵢgᵢ(c) − |M|²/W. Of the differences tᵢ = yᵢ − c, where yᵢ is
/// pᵢ − p₀ rounded, each is off by a vector no longer than u(|tᵢ| + |yᵢ|). So |tᵢ|² is off by at most
/// u((d/8 + 20)|tᵢ|² + 3|tᵢ||yᵢ|), as it is summed in eight parts, and with S = Σλᵢ(|tᵢ|² + |yᵢ|² + ρᵢ²) over m items the sum of
/// λᵢgᵢ(c) by less than u(d/8 + m + 24)S; M by less than u(d + m + 8)·Σλᵢ(|tᵢ| + |yᵢ|), so that |M|²/W is at most twice
/// the square of what was computed over W, and less than uS. Multipliers below 2⁻⁶⁰ are not looked at, and 2⁻⁹⁰⁰ is
/// more than what can underflow.
fn is_refuted(core: &Core, cluster: &Cluster) -> bool {
    const MULTIPLIER_MIN: f64 = f64::from_bits((1023 - 60) << 52);
    let (dim, center) = (core.dim, &cluster.fit.center);
    let used = || cluster.fit.support.iter().filter(|&&(_, lambda)| lambda >= MULTIPLIER_MIN);
    let (mut sum, mut size, mut weight) = (0.0, 0.0, 0.0);
    for &(member, lambda) in used() {
        let (mut square_of, mut from_origin) = ([0.0; 8], [0.0; 8]);
        for (column, (y, c)) in place(core, cluster, member).zip(center).enumerate() {
            square_of[column % 8] += square(y - c);
            from_origin[column % 8] += square(y);
        }
        let [distance, from_origin]: [f64; 2] = [square_of, from_origin].map(|s| s.iter().sum());
        let reach = square(core.reach(cluster.members[member]));
        sum += lambda * (distance - reach);
        size += lambda * (distance + from_origin + reach);
        weight += lambda;
    }
    let mut along = vec![0.0; dim];
    for &(member, lambda) in used() {
        for (along, (y, c)) in along.iter_mut().zip(place(core, cluster, member).zip(center)) {
            *along += lambda * (y - c);
        }
    }
    let moment: f64 = along.iter().map(|&along| square(along)).sum();
    let count = cluster.fit.support.len();
    let lost = ((dim / 8 + count + 32) as f64 * U * size + 4.0 * moment / weight) * (1.0 + 1e-9);
    sum - lost >= f64::from_bits((1023 - 900) << 52)
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::item::Kind;
    use super::*;

    /// Returns true if a ball of radius less than `bound` is proved not to hold these rows.
    fn refuted(rows: &[f64], columns: usize, kind: Kind, bound: f64) -> bool {
        let core = Core::of(rows, columns, kind, bound);
        let mut meter = Meter::of(&Monitor::silent());
        let pairs = Pairs::of(&core, &mut meter).unwrap();
        let mut free = Free::of(&core, &pairs);
        let Some(mut cluster) = free.open(0) else { return true };
        (1..core.len()).any(|item| free.grow(&mut cluster, item, &mut meter).unwrap().is_none())
    }

    fn is_radius(rows: &[f64], columns: usize, kind: Kind, radius: f64) {
        assert!(refuted(rows, columns, kind, radius * (1.0 - 1e-13)), "{radius} is too small");
        assert!(!refuted(rows, columns, kind, radius * (1.0 + 1e-13)), "{radius} is too large");
    }

    /// Differences of coordinates are beyond the range, the balls are not.
    #[test]
    fn balls_at_the_end_of_the_range_are_not_refuted() {
        is_radius(&[-1.2e308, 0.0, 1.2e308, 0.0], 2, Kind::Points, 1.2e308);
        let corners = [-1e308, -1e308, 1e308, 1e308, -1e308, 1e308, 1e308, -1e308];
        is_radius(&corners, 2, Kind::Points, 2f64.sqrt() * 1e308);
    }

    #[test]
    fn closed_forms_are_met_to_thirteen_digits() {
        let root3 = 3f64.sqrt();
        let triangle = [0.0, 0.0, 1.0, 0.0, 0.5, root3 / 2.0];
        is_radius(&triangle, 2, Kind::Points, 1.0 / root3);
        is_radius(&[0.0, 0.0, 4.0, 0.0, 1.0, 1.0, 1.0, 1.0], 2, Kind::Points, 2.0);
        is_radius(
            &[0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 2.0, 1.0, 1.0],
            2,
            Kind::Points,
            2f64.sqrt(),
        );
        // A regular simplex of d points with edges √2.
        for dim in [3, 7, 40] {
            let rows: Vec<f64> = (0..dim * dim).map(|i| f64::from(i % (dim + 1) == 0)).collect();
            let n = f64::from(dim);
            is_radius(&rows, dim as usize, Kind::Points, ((n - 1.0) / n).sqrt());
        }
        // Two balls, and one within another.
        is_radius(&[0.0, 0.0, 1.0, 6.0, 8.0, 2.0], 3, Kind::Balls, 6.5);
        is_radius(&[0.0, 0.0, 5.0, 1.0, 0.0, 2.0], 3, Kind::Balls, 5.0);
        // w₁w₂D/(w₁ + w₂).
        is_radius(&[0.0, 2.0, 7.0, 3.0], 2, Kind::Weighted, 7.0 * 6.0 / 5.0);
    }

    /// The radius of the smallest ball around a few points of the plane, by brute force: the smallest circle through two of
    /// them, as a diameter, or through three that holds all.
    fn brute_radius(points: &[[f64; 2]]) -> f64 {
        let mut circles = vec![];
        for (i, &[ax, ay]) in points.iter().enumerate() {
            for (j, &[bx, by]) in points.iter().enumerate().skip(i + 1) {
                circles.push(([(ax + bx) / 2.0, (ay + by) / 2.0], i));
                for &[cx, cy] in &points[j + 1..] {
                    let [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
                    let area = 2.0 * (ux * vy - uy * vx);
                    let (u, v) = (ux * ux + uy * uy, vx * vx + vy * vy);
                    if area != 0.0 {
                        let center = [ax + (vy * u - uy * v) / area, ay + (ux * v - vx * u) / area];
                        circles.push((center, i));
                    }
                }
            }
        }
        let distance = |[x, y]: [f64; 2], [a, b]: [f64; 2]| (x - a).hypot(y - b);
        let radii = circles.into_iter().filter_map(|(center, on)| {
            let radius = distance(center, points[on]);
            // On this grid distances that differ do so by far more.
            points.iter().all(|&p| distance(center, p) <= radius * (1.0 + 1e-9)).then_some(radius)
        });
        radii.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn random_groups_agree_with_brute_force_over_subsets() {
        let mut state = 7u64;
        let mut draw = |count: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % count) as f64
        };
        for _ in 0..2000 {
            let count = 2 + draw(6) as usize;
            let points: Vec<[f64; 2]> = (0..count).map(|_| [draw(9), draw(9)]).collect();
            let radius = brute_radius(&points);
            if radius > 0.0 {
                is_radius(points.as_flattened(), 2, Kind::Points, radius);
            }
            // On a line two items decide (Helly): the pair that asks for the largest ball.
            let rows: Vec<[f64; 2]> = (0..count).map(|_| [draw(50), 1.0 + draw(9)]).collect();
            let pairs = || rows.iter().flat_map(|&a| rows.iter().map(move |&b| (a, b)));
            let balls = pairs().map(|([p, r], [q, s])| ((p + r) - (q - s)) / 2.0);
            is_radius(rows.as_flattened(), 2, Kind::Balls, balls.fold(0.0, f64::max));
            let weighted = pairs().map(|([p, w], [q, v])| (p - q).abs() * w * v / (w + v));
            let weighted = weighted.fold(0.0, f64::max);
            if weighted > 0.0 {
                is_radius(rows.as_flattened(), 2, Kind::Weighted, weighted);
            }
        }
    }

    #[test]
    fn scale_and_place_do_not_matter() {
        for (scale, shift) in [(1e-200, 0.0), (1e200, 0.0), (1.0, 1e8), (2f64.powi(-1000), 0.0)] {
            let unit = [0.0, 0.0, 6.0, 8.0, 0.0, 8.0, 3.0, 1.0];
            let rows: Vec<f64> = unit.iter().map(|x| x * scale + shift).collect();
            is_radius(&rows, 2, Kind::Points, 5.0 * scale);
        }
    }
}
