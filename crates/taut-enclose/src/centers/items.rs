//! Items as the search sees them: coordinates in one piece, and one number more where they are balls or carry weights.
//!
//! The dimension of the plane and of space is known to the compiler ([`Position`]), as a search spends its time on balls of
//! two to ten items; others are slices.

use std::marker::PhantomData;

use super::tree::Search;

/// d coordinates: an array where d is known, else a vector.
pub(super) trait Position: Clone + Send + Sync + AsRef<[f64]> + AsMut<[f64]> {
    /// The origin.
    fn zeros(dim: usize) -> Self;

    /// d, known to the compiler for arrays.
    fn width(dim: usize) -> usize;

    /// Returns the search if it is one of the plane; nogoods are recorded there alone.
    fn in_plane<'s, 'c>(_: &'s mut Search<'c, Self>) -> Option<&'s mut Search<'c, [f64; 2]>> {
        None
    }
}

impl Position for [f64; 2] {
    #[inline(always)]
    fn zeros(_: usize) -> Self {
        [0.0; 2]
    }

    #[inline(always)]
    fn width(_: usize) -> usize {
        2
    }

    fn in_plane<'s, 'c>(search: &'s mut Search<'c, Self>) -> Option<&'s mut Search<'c, [f64; 2]>> {
        Some(search)
    }
}

impl Position for [f64; 3] {
    #[inline(always)]
    fn zeros(_: usize) -> Self {
        [0.0; 3]
    }

    #[inline(always)]
    fn width(_: usize) -> usize {
        3
    }
}

impl Position for Vec<f64> {
    fn zeros(dim: usize) -> Self {
        vec![0.0; dim]
    }

    fn width(dim: usize) -> usize {
        dim
    }
}

/// The shape of an item, which determines how far it reaches from a center at distance D.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// A point: D.
    Points,
    /// A point of weight w: w·D.
    Weighted,
    /// A ball of radius r: D + r.
    Balls,
}

/// Items by number.
#[derive(Clone, Debug)]
pub(super) struct ItemSet<P> {
    shape: Shape,
    dim: usize,
    /// n × d.
    coordinates: Vec<f64>,
    /// Weights or radii; empty for points.
    extras: Vec<f64>,
    position: PhantomData<P>,
}

impl<P: Position> ItemSet<P> {
    pub(super) fn new(shape: Shape, dim: usize) -> Self {
        ItemSet { shape, dim, coordinates: vec![], extras: vec![], position: PhantomData }
    }

    pub(super) fn some(&self, which: &[u32]) -> Self {
        let mut some = ItemSet::new(self.shape, self.dim);
        for &item in which {
            let item = item as usize;
            some.push(self.at(item), if self.extras.is_empty() { 0.0 } else { self.extras[item] });
        }
        some
    }

    pub(super) fn shape(&self) -> Shape {
        self.shape
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    pub(super) fn len(&self) -> usize {
        self.coordinates.len() / P::width(self.dim)
    }

    /// Appends an item; `extra` is its weight or radius, and of no meaning for a point.
    pub(super) fn push(&mut self, position: &[f64], extra: f64) {
        self.coordinates.extend_from_slice(position);
        if self.shape != Shape::Points {
            self.extras.push(extra);
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, item: usize) -> &[f64] {
        let width = P::width(self.dim);
        &self.coordinates[item * width..][..width]
    }

    pub(super) fn position(&self, item: usize) -> P {
        let mut position = P::zeros(self.dim);
        position.as_mut().copy_from_slice(self.at(item));
        position
    }

    /// The weight of an item; 1 where there are none.
    #[inline(always)]
    pub(super) fn weight(&self, item: usize) -> f64 {
        if self.shape == Shape::Weighted { self.extras[item] } else { 1.0 }
    }

    /// The radius of an item; 0 for a point.
    #[inline(always)]
    pub(super) fn radius(&self, item: usize) -> f64 {
        if self.shape == Shape::Balls { self.extras[item] } else { 0.0 }
    }

    /// The weight or radius; 0 for a point.
    pub(super) fn extra(&self, item: usize) -> f64 {
        if self.shape == Shape::Points { 0.0 } else { self.extras[item] }
    }

    /// Returns how far an item reaches from a center at this distance.
    #[inline(always)]
    pub(super) fn reach_at(&self, item: usize, distance: f64) -> f64 {
        match self.shape {
            Shape::Points => distance,
            Shape::Weighted => self.extras[item] * distance,
            Shape::Balls => distance + self.extras[item],
        }
    }

    /// Returns how far an item reaches from a center.
    #[inline(always)]
    pub(super) fn reach(&self, item: usize, center: &P) -> f64 {
        self.reach_at(item, square(self.at(item), center.as_ref()).sqrt())
    }

    /// The squared distance of the positions of two items.
    #[inline(always)]
    pub(super) fn square(&self, a: usize, b: usize) -> f64 {
        square(self.at(a), self.at(b))
    }

    /// The radius of the smallest ball of two items: half their distance D; vwD/(v + w) for weights v and w; for balls,
    /// half of D and both radii, but no less than one of them.
    #[inline(always)]
    pub(super) fn pair_radius(&self, a: usize, b: usize) -> f64 {
        let distance = square(self.at(a), self.at(b)).sqrt();
        match self.shape {
            Shape::Points => 0.5 * distance,
            Shape::Weighted => {
                let (v, w) = (self.extras[a], self.extras[b]);
                v * (w / (v + w)) * distance
            }
            Shape::Balls => {
                let (r, s) = (self.extras[a], self.extras[b]);
                (0.5 * (distance + r + s)).max(r).max(s)
            }
        }
    }
}

/// |a − b|².
#[inline(always)]
pub(super) fn square(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += (a - b) * (a - b);
    }
    sum
}

/// |a − b|.
#[inline(always)]
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    square(a, b).sqrt()
}
