//! The points that are known of ellipsoids: the items of the search, each ellipsoid a group of them.

use std::collections::HashMap;

use super::bodies::Bodies;
use crate::centers::cloud::Cloud;
use crate::centers::items::{ItemSet, Position, Shape};

/// Points in the order in which they became known.
pub(super) struct Pool<'a, P> {
    bodies: &'a Bodies<'a>,
    pub(super) places: ItemSet<P>,
    /// The ellipsoid of each, and the direction in which it lies farthest.
    names: Vec<(usize, Vec<f64>)>,
    /// The group of each.
    groups: Vec<u32>,
    /// The points of each group.
    members: Vec<Vec<u32>>,
    /// The group of each ellipsoid that has one.
    numbers: HashMap<usize, u32>,
}

impl<'a, P: Position> Pool<'a, P> {
    pub(super) fn new(bodies: &'a Bodies<'a>) -> Self {
        Pool {
            bodies,
            places: ItemSet::new(Shape::Points, bodies.dim()),
            names: vec![],
            groups: vec![],
            members: vec![],
            numbers: HashMap::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    /// The ellipsoid and the direction of a point.
    pub(super) fn name(&self, point: u32) -> (u64, Vec<f64>) {
        let (i, direction) = &self.names[point as usize];
        (*i as u64, direction.clone())
    }

    /// The known points of an ellipsoid.
    pub(super) fn points_of(&self, i: usize) -> &[u32] {
        self.numbers.get(&i).map_or(&[], |&group| &self.members[group as usize])
    }

    /// Takes an ellipsoid in by the ends of a longest axis, if it has no points here.
    pub(super) fn take(&mut self, i: usize) {
        if !self.numbers.contains_key(&i) {
            self.bodies.ends(i).into_iter().for_each(|direction| self.add(i, direction));
        }
    }

    /// Adds a point of an ellipsoid, unless it is known.
    pub(super) fn add(&mut self, i: usize, direction: Vec<f64>) {
        let place = self.bodies.point(i, &direction);
        if self.points_of(i).iter().any(|&known| self.places.at(known as usize) == place) {
            return;
        }
        let next = self.members.len() as u32;
        let group = *self.numbers.entry(i).or_insert(next);
        if group == next {
            self.members.push(vec![]);
        }
        let point = self.names.len() as u32;
        self.members[group as usize].push(point);
        self.groups.push(group);
        self.places.push(&place, 0.0);
        self.names.push((i, direction));
    }

    /// All points as the items of a search.
    pub(super) fn cloud(&self) -> Numbered<P> {
        let mut cloud = Cloud::new(self.places.clone(), &self.groups);
        cloud.place_error = self.bodies.place_error;
        let mut numbers = vec![0; self.len()];
        for (item, &point) in (0..).zip(&cloud.rows) {
            numbers[point as usize] = item;
        }
        Numbered { cloud, numbers }
    }
}

/// A cloud, and the number in it of each point.
pub(super) struct Numbered<P> {
    pub(super) cloud: Cloud<P>,
    numbers: Vec<u32>,
}

impl<P> Numbered<P> {
    /// Items of points.
    pub(super) fn items(&self, points: &[u32]) -> Vec<u32> {
        points.iter().map(|&point| self.numbers[point as usize]).collect()
    }

    /// Points of items.
    pub(super) fn points(&self, items: &[u32]) -> Vec<u32> {
        items.iter().map(|&item| self.cloud.rows[item as usize] as u32).collect()
    }
}
