//! The items of the core-set, and which two of them no ball of a radius less than ρ holds.
//!
//! *Idea.* An item lies in the ball of center c and radius less than ρ just when |p − c| < ρᵢ, with ρᵢ = ρ for points,
//! ρ − r for balls and ρ/w for points of weight w: whatever items are, each asks for a center in an open ball of its own,
//! and a ball that holds some of them exists just when these have a common point. Two have none when
//! |p − q| ≥ ρᵢ + ρⱼ, which is r ≥ ρ in the words of the papers for r = D/2, (D + rᵢ + rⱼ)/2, wᵢwⱼD/(wᵢ + wⱼ).
//! *Rounding.* ρᵢ is rounded up, so that what has no common point had none before. Two items are told apart exactly.

use std::cmp::Ordering;
use std::collections::HashMap;

use taut_points::Cancelled;

use super::distance::{Scale, compare, compare_weighted, kappa, square};
use super::item::Kind;
use super::meter::Meter;

/// The core-set, for one bound ρ > 0.
pub(super) struct Core {
    pub(super) dim: usize,
    /// The power of two by which lengths are multiplied.
    pub(super) scale: Scale,
    kind: Kind,
    /// ρ.
    bound: f64,
    /// Coordinates as given, row by row.
    places: Vec<f64>,
    /// r of balls, w of points with weights.
    extras: Vec<f64>,
    /// For each item the number of its group, by first appearance.
    groups: Vec<usize>,
    is_grouped: bool,
    /// ρᵢ, scaled and rounded up; where it is not above 0, nothing holds the item.
    reaches: Vec<f64>,
}

impl Core {
    /// The items of these rows of so many columns, each a group of its own.
    pub(super) fn of(rows: &[f64], columns: usize, kind: Kind, bound: f64) -> Self {
        let dim = kind.dim(columns);
        let items = || rows.chunks_exact(columns).map(|row| kind.item(row));
        let places = items().flat_map(|item| item.position.iter().copied()).collect();
        let extras: Vec<f64> = match kind {
            Kind::Points => vec![],
            Kind::Balls => items().map(|item| item.radius).collect(),
            Kind::Weighted => items().map(|item| item.weight).collect(),
        };
        let lengths: Vec<f64> = items()
            .map(|item| match kind {
                Kind::Points => bound,
                Kind::Balls if bound - item.radius > 0.0 => (bound - item.radius).next_up(),
                Kind::Balls => 0.0,
                Kind::Weighted => (bound / item.weight).next_up(),
            })
            .collect();
        let of_scale = match kind {
            Kind::Weighted => lengths.iter().copied().fold(f64::INFINITY, f64::min),
            _ => bound,
        };
        let scale = Scale::of(of_scale);
        let reaches: Vec<f64> = lengths.iter().map(|&length| length * scale.up).collect();
        let groups = (0..reaches.len()).collect();
        let is_grouped = false;
        Core { dim, scale, kind, bound, places, extras, groups, is_grouped, reaches }
    }

    /// The same items, those of one name in one group.
    pub(super) fn with_groups(mut self, names: impl Iterator<Item = u64>) -> Self {
        let mut numbers: HashMap<u64, usize> = HashMap::new();
        self.groups = names
            .map(|name| {
                let next = numbers.len();
                *numbers.entry(name).or_insert(next)
            })
            .collect();
        self.is_grouped = true;
        self
    }

    /// Returns true if the items are points of the plane, each for itself.
    pub(super) fn is_plain_plane(&self) -> bool {
        matches!(self.kind, Kind::Points) && self.dim == 2 && !self.is_grouped
    }

    /// Returns true if items are in groups.
    pub(super) fn is_grouped(&self) -> bool {
        self.is_grouped
    }

    /// For each item the number of its group, from 0 by first appearance.
    pub(super) fn groups(&self) -> &[usize] {
        &self.groups
    }

    /// Number of groups.
    pub(super) fn group_count(&self) -> usize {
        self.groups.iter().max().map_or(0, |last| last + 1)
    }

    pub(super) fn len(&self) -> usize {
        self.reaches.len()
    }

    pub(super) fn place(&self, item: usize) -> &[f64] {
        &self.places[item * self.dim..(item + 1) * self.dim]
    }

    /// ρᵢ, scaled.
    pub(super) fn reach(&self, item: usize) -> f64 {
        self.reaches[item]
    }

    /// Returns true if a ball of a radius less than ρ holds the item.
    pub(super) fn is_free(&self, item: usize) -> bool {
        self.reaches[item] > 0.0
    }

    /// Tests whether no ball of a radius less than ρ holds both.
    pub(super) fn are_apart(
        &self,
        i: usize,
        j: usize,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        meter.spend(self.dim + 4)?;
        if !self.is_free(i) || !self.is_free(j) {
            return Ok(true);
        }
        let (p, q) = (self.place(i), self.place(j));
        let nearer = match self.kind {
            Kind::Points => compare(p, q, 0.5, &[self.bound], self.scale, meter)?,
            Kind::Balls => {
                let square = square(p, q, [self.scale.up, 1.0]);
                let sum = self.reaches[i] + self.reaches[j];
                let (less, more) = (sum * (1.0 - kappa(self.dim)), sum * (1.0 + kappa(self.dim)));
                if less > 1e-70 && square < less * less {
                    return Ok(false);
                }
                if less > 1e-70 && square > more * more && square < f64::INFINITY {
                    return Ok(true);
                }
                let rho = [self.bound, self.bound, -self.extras[i], -self.extras[j]];
                compare(p, q, 1.0, &rho, self.scale, meter)?
            }
            Kind::Weighted => {
                let weights = [self.extras[i], self.extras[j]];
                compare_weighted(p, q, weights, self.bound, meter)?
            }
        };
        Ok(nearer != Ordering::Less)
    }

    /// Tests whether no ball of a radius less than ρ with its center at this place holds the item.
    pub(super) fn is_out_of_reach(
        &self,
        item: usize,
        center: &[f64],
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        let extra = self.extras.get(item).copied();
        let (weight, radius) = match (self.kind, extra) {
            (Kind::Weighted, Some(weight)) => (weight, 0.0),
            (Kind::Balls, Some(radius)) => (1.0, radius),
            _ => (1.0, 0.0),
        };
        let (scale, rho) = (Scale::of(self.bound), [self.bound, -radius]);
        Ok(compare(self.place(item), center, weight, &rho, scale, meter)? != Ordering::Less)
    }
}

/// A set of items, a bit each.
pub(super) type Bits = Vec<u64>;

pub(super) fn is_set(bits: &[u64], item: usize) -> bool {
    bits[item / 64] >> (item % 64) & 1 == 1
}

pub(super) fn set(bits: &mut [u64], item: usize) {
    bits[item / 64] |= 1 << (item % 64);
}

pub(super) fn clear(bits: &mut [u64], item: usize) {
    bits[item / 64] &= !(1 << (item % 64));
}

/// The items of a set, ascending.
pub(super) fn items(bits: &[u64]) -> impl Iterator<Item = usize> {
    bits.iter().enumerate().flat_map(|(word, &bits)| {
        let mut rest = bits;
        std::iter::from_fn(move || {
            let at = rest.trailing_zeros() as usize;
            (rest != 0).then(|| {
                rest &= rest - 1;
                64 * word + at
            })
        })
    })
}

/// For each item of the core-set, those that are apart from it.
pub(super) struct Pairs {
    rows: Vec<Bits>,
}

impl Pairs {
    /// All n(n − 1)/2 pairs.
    pub(super) fn of(core: &Core, meter: &mut Meter<'_>) -> Result<Self, Cancelled> {
        let n = core.len();
        let mut rows = vec![vec![0; n.div_ceil(64)]; n];
        for i in 0..n {
            for j in 0..i {
                if core.are_apart(i, j, meter)? {
                    set(&mut rows[i], j);
                    set(&mut rows[j], i);
                }
            }
        }
        Ok(Pairs { rows })
    }

    pub(super) fn are_apart(&self, i: usize, j: usize) -> bool {
        is_set(&self.rows[i], j)
    }
}
