//! Half-spaces as the ellipsoid inside sees them.
//!
//! *Idea.* In the coordinates y of x = c + Gy the ellipsoid is the unit ball, and a half-space aᵀx ≤ b is ñᵀy ≤ h with ñ of
//! length 1: h is 1 where it touches. Around the largest ellipsoid the polytope lies within |y| ≤ d, so that pictures need
//! no scale of their own, and the half-spaces that bound it are among those of small h.

use std::collections::BTreeSet;

use taut_certify::{InscribedCertificate, InscribedEllipsoid};
use taut_points::{Blocks, OrderBy, PointSource, Scratch};

use crate::Error;
use crate::body::length;

/// One half-space.
pub(super) struct Side {
    pub(super) id: u64,
    /// a, and b − aᵀc.
    pub(super) normal: Vec<f64>,
    pub(super) slack: f64,
    /// ñ.
    pub(super) seen: Vec<f64>,
    /// h.
    pub(super) distance: f64,
    /// λ|Gᵀa|, which does not depend on the length of a; 0 for those without a multiplier.
    pub(super) weight: f64,
}

/// The half-spaces that are drawn, the nearest first.
pub(super) struct Sides {
    pub(super) near: Vec<Side>,
    pub(super) largest: f64,
    /// The number of sides that come within a thousandth of touching.
    pub(super) close: u64,
    /// The number of sides that reach into the ellipsoid by more than rounding.
    pub(super) cutting: u64,
}

/// Of h, by how much rounding may move it.
const ROUNDING: f64 = 1e-9;
/// A half-space counts as nearly touching up to a distance of 1 and this, where the ellipsoid reaches 1.
pub(super) const TOUCH_TOLERANCE: f64 = 1e-3;

impl Sides {
    /// Reads all half-spaces and keeps those of the support and the nearest others, `most` in all.
    pub(super) fn read(
        ellipsoid: &InscribedEllipsoid,
        certificate: &InscribedCertificate,
        source: &dyn PointSource,
        most: usize,
    ) -> Result<Self, Error> {
        let dim = ellipsoid.center.len();
        let mut near: Vec<Side> = Vec::new();
        let (mut close, mut cutting) = (0, 0);
        let support: BTreeSet<u64> = certificate.support.iter().copied().collect();
        let mut row = vec![0.0; dim + 1];
        let mut scratch = Scratch::new();
        let blocks = Blocks::of(source);
        for block in 0..blocks.count() {
            let range = blocks.range(block);
            let first = range.start;
            let rows = source.read(range, &mut scratch)?;
            for i in 0..rows.len() {
                let id = first + i as u64;
                rows.copy_row(i, &mut row);
                if let Some(column) = row.iter().position(|v| !v.is_finite()) {
                    let what = format!("number {column} of half-space {id}");
                    return Err(Error::NonFinite { what, value: row[column] });
                }
                let Some(side) = Side::of(ellipsoid, id, &row)? else { continue };
                close += u64::from(side.distance <= 1.0 + TOUCH_TOLERANCE);
                cutting += u64::from(side.distance < 1.0 - ROUNDING);
                near.push(side);
            }
            // What is beyond is let go now and then, so that memory stays in proportion to what is drawn.
            if near.len() > 4 * most {
                nearest(&mut near, &support, most);
            }
        }
        nearest(&mut near, &support, most);
        for side in &mut near {
            if let Ok(place) = certificate.support.binary_search(&side.id) {
                side.weight *= certificate.multipliers[place];
            } else {
                side.weight = 0.0;
            }
        }
        let largest = near.iter().fold(0.0f64, |m, side| m.max(side.weight));
        Ok(Sides { near, largest, close, cutting })
    }

    /// Those with a multiplier that counts: a proof may give some little weight to others, which do not touch.
    pub(super) fn support(&self) -> impl Iterator<Item = &Side> {
        self.near.iter().filter(|side| side.weight > 1e-6 * self.largest)
    }
}

/// Keeps the support and the nearest others, the nearest first.
fn nearest(sides: &mut Vec<Side>, support: &BTreeSet<u64>, most: usize) {
    sides.order_by(&|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
    let mut room = most.saturating_sub(support.len());
    sides.retain(|side| {
        let is_other = !support.contains(&side.id);
        let stays = !is_other || room > 0;
        room -= usize::from(is_other && stays);
        stays
    });
}

impl Side {
    /// `None` for a row without a normal, which bounds nothing.
    fn of(ellipsoid: &InscribedEllipsoid, id: u64, row: &[f64]) -> Result<Option<Self>, Error> {
        let (normal, offset) = row.split_at(ellipsoid.center.len());
        let size = length(normal);
        if size == 0.0 {
            return Ok(None);
        }
        // A normal of length 1, so that nothing overflows or vanishes that need not.
        let normal: Vec<f64> = normal.iter().map(|a| a / size).collect();
        let slack = offset[0] / size
            - normal.iter().zip(&ellipsoid.center).map(|(a, c)| a * c).sum::<f64>();
        let mut seen = vec![0.0; normal.len()];
        for (a, axes) in normal.iter().zip(&ellipsoid.axes) {
            seen.iter_mut().zip(axes).for_each(|(sum, g)| *sum += a * g);
        }
        let wide = length(&seen);
        let distance = slack / wide;
        if !distance.is_finite() {
            let what = format!("distance of half-space {id} from the center, in half axes,");
            return Err(Error::NonFinite { what, value: distance });
        }
        seen.iter_mut().for_each(|v| *v /= wide);
        Ok(Some(Side { id, normal, slack, seen, distance, weight: wide * size }))
    }
}
