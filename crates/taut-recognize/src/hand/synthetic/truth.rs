//! The outline of a synthetic hand before pixels, and what follows from it.

use super::person::Person;
use super::pose::{KNUCKLE_MM, Page, Pose};
use super::random::length;
use super::shape::{Body, Strip};
use super::{Defect, Side, Truth};
use crate::hand::HandOptions;
use crate::hand::features;
use crate::hand::landmarks::Landmarks;
use crate::hand::mask::Mask;
use crate::hand::outline::{Outline, follow_cracks, twice_signed_area};

/// The side of the squares that are evaluated together, in pixels.
const TILE: usize = 16;

/// Distances are exact within this of the boundary, in mm; beyond they only have their sign. Shading needs 2 mm.
const BAND_MM: f64 = 2.6;

/// The function of [`Body::distance`] changes by at most this times the distance: a rounded union of two slopes has √2.
const STEEPNESS: f64 = 1.5;

/// A part whose distance is above this changes nothing: the largest radius of a joint.
const JOINT_MM: f64 = 10.0;

/// Fingers whose outlines meet so far above their base touch, in mm: the web fills the corner up to here.
const TOUCHING_MM: f64 = 8.0;

/// A hand on a page as a field of distances.
#[derive(Clone)]
pub(super) struct Outlined {
    pub(super) pose: Pose,
    pub(super) strips: [Strip; 5],
    /// The distance of each pixel's center from the outline in pixels, negative inside.
    pub(super) field: Vec<f32>,
    page: Page,
    is_cut_off: bool,
}

impl Outlined {
    pub(super) fn new(pose: &Pose, person: &Person, page: &Page) -> Self {
        let strips = pose.strips(person);
        let body = pose.body(person, &strips);
        let field = distances(pose, &body, page);
        // Below this the arm begins.
        let wrist = 0.17 * person.body[1];
        let is_out = |x: usize, y: usize| {
            let p = pose.to_hand(page, [x as f64 + 0.5, y as f64 + 0.5]);
            field[y * page.width + x] < 0.0 && p[1] > wrist
        };
        let (width, height) = (page.width, page.height);
        let is_cut_off = (0..width).any(|x| is_out(x, 0) || is_out(x, height - 1))
            || (0..height).any(|y| is_out(0, y) || is_out(width - 1, y));
        Self { pose: pose.clone(), strips, field, page: page.clone(), is_cut_off }
    }

    /// Tests whether a finger touches the next one above their web: there is no background between
    /// their axes where the web has ended.
    pub(super) fn is_touching(&self, first: usize) -> bool {
        let (a, b) = (&self.strips[first], &self.strips[first + 1]);
        let level = KNUCKLE_MM + TOUCHING_MM;
        let [p, q] = [a, b].map(|strip| {
            let end = strip.point(level, strip.axis(level)[0]);
            self.pose.to_page(&self.page, end)
        });
        let steps = length(q[0] - p[0], q[1] - p[1]) as usize + 1;
        !(0..=steps).any(|step| {
            let share = step as f64 / steps as f64;
            let [x, y] = [0, 1].map(|c| p[c] + share * (q[c] - p[c]));
            let is_on_page = x >= 0.0 && y >= 0.0;
            let (x, y) = (x as usize, y as usize);
            is_on_page
                && x < self.page.width
                && y < self.page.height
                && self.field[y * self.page.width + x] > 0.0
        })
    }

    /// Returns what is known of the scan.
    pub(super) fn into_truth(self, side: Side, defect: Option<Defect>, has_sleeve: bool) -> Truth {
        let (width, height) = (self.page.width, self.page.height);
        let mask = Mask::from_fn(width, height, |x, y| self.field[y * width + x] < 0.0);
        let tips = std::array::from_fn(|k| self.pose.to_page(&self.page, self.strips[k].tip()));
        let landmarks = self.landmarks(&mask, tips, side);
        let valleys = landmarks.as_ref().map(Landmarks::valley_points).unwrap_or_default();
        let features = landmarks.filter(|_| !self.is_cut_off).and_then(|landmarks| {
            let mm_per_pixel = 1.0 / self.page.pixels_per_mm;
            let measured = features::measure(&landmarks, &HandOptions::default(), mm_per_pixel);
            measured.map(|measured| measured.features)
        });
        let is_cut_off = self.is_cut_off;
        Truth { side, mask, tips, valleys, features, is_cut_off, defect, has_sleeve }
    }

    /// Returns the outline before pixels with the true tips and valleys.
    fn landmarks(&self, mask: &Mask, tips: [[f64; 2]; 5], side: Side) -> Option<Landmarks> {
        let width = self.page.width;
        let cracks = follow_cracks(mask);
        let outline = Outline::new(&cracks, 1.0, |[x, y]| {
            let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
            let inside = x < width && y < self.page.height;
            inside.then(|| -f64::from(self.field[y * width + x]))
        })?;
        // From the thumb over the fingers.
        let is_forward = twice_signed_area(&tips) > 0.0;
        let outline = if is_forward { outline } else { outline.reversed() };
        let count = outline.points().len() as f64;
        let mut places = tips.map(|tip| nearest(&outline, tip));
        for k in 1..5 {
            while places[k] <= places[k - 1] {
                places[k] += count;
            }
        }
        if places[4] >= places[0] + count {
            return None;
        }
        let valleys = std::array::from_fn(|k| {
            let direction = |finger: usize| {
                let strip = &self.strips[finger];
                let [a, b] =
                    [strip.point(0.0, 0.0), strip.tip()].map(|p| self.pose.to_page(&self.page, p));
                let size = length(b[0] - a[0], b[1] - a[1]);
                [(b[0] - a[0]) / size, (b[1] - a[1]) / size]
            };
            let (a, b) = (direction(k), direction(k + 1));
            let bisector = [a[0] + b[0], a[1] + b[1]];
            let along = |place: f64| {
                let p = outline.at(place);
                p[0] * bisector[0] + p[1] * bisector[1]
            };
            // The mean of the places within 0.9 mm of the lowest point, weighted by how far they are below.
            let steps = (places[k + 1] - places[k]) as usize;
            let heights: Vec<f64> = (0..steps).map(|step| along(places[k] + step as f64)).collect();
            let size = length(bisector[0], bisector[1]);
            let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let limit = least + 0.9 * self.page.pixels_per_mm * size;
            let (mut weights, mut moment) = (0.0, 0.0);
            for (step, height) in heights.iter().enumerate().filter(|(_, h)| **h < limit) {
                weights += limit - height;
                moment += (limit - height) * step as f64;
            }
            places[k] + moment / weights
        });
        Some(Landmarks {
            outline,
            tips: places,
            valleys,
            tip_angles: [0.0; 5],
            valley_angles: [0.0; 4],
            side,
        })
    }
}

/// Returns the place of an outline that is nearest to a point, to a tenth of a sample.
fn nearest(outline: &Outline, p: [f64; 2]) -> f64 {
    let square = |q: [f64; 2]| (q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1]);
    let best = |places: &mut dyn Iterator<Item = f64>| {
        let key = |place: f64| square(outline.at(place));
        places.min_by(|&a, &b| key(a).total_cmp(&key(b))).unwrap_or(0.0)
    };
    let coarse = best(&mut (0..outline.points().len()).map(|place| place as f64));
    best(&mut (-10..=10).map(|tenth| coarse + f64::from(tenth) / 10.0))
}

/// Evaluates the distances of all pixels; tiles that the outline does not come near are filled at once.
fn distances(pose: &Pose, body: &Body, page: &Page) -> Vec<f32> {
    let mut field = vec![0f32; page.width * page.height];
    let radius = 0.5 * TILE as f64 * std::f64::consts::SQRT_2 / page.pixels_per_mm;
    for top in (0..page.height).step_by(TILE) {
        for left in (0..page.width).step_by(TILE) {
            let middle = [left as f64 + 0.5 * TILE as f64, top as f64 + 0.5 * TILE as f64];
            let middle = pose.to_hand(page, middle);
            let is_near: Vec<bool> = body
                .parts
                .iter()
                .map(|(part, _)| part.distance(middle) < JOINT_MM + BAND_MM + STEEPNESS * radius)
                .collect();
            let center = body.distance(middle, &is_near);
            let is_uniform = center.abs() > BAND_MM + STEEPNESS * radius;
            for y in top..(top + TILE).min(page.height) {
                for x in left..(left + TILE).min(page.width) {
                    let mm = if is_uniform {
                        center
                    } else {
                        let p = pose.to_hand(page, [x as f64 + 0.5, y as f64 + 0.5]);
                        body.distance(p, &is_near)
                    };
                    field[y * page.width + x] = (mm.min(100.0) * page.pixels_per_mm) as f32;
                }
            }
        }
    }
    field
}
