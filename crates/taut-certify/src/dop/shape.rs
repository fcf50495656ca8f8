//! The vertices and the volume of half-spaces whose offsets are any numbers.
//!
//! *Idea.* Offsets are rounded down and up to a grid of 2⁻⁴³ to 2⁻⁴⁴ of the longest side. The dop lies between the two bodies with
//! whole half-spaces, whose vertices are exact and whose volumes have proved bounds. Its vertices are taken from the outer one.
//! *Guarantee.* The bounds of the volume hold. Each vertex of the dop is near one of the outer body, and the other way round: with
//! normals of −1, 0 and 1 three planes that meet in a point have a determinant of 1 to 4, so that a unit of an offset moves it by
//! a few units.
//! *Trap.* Points in a plane with one of the normals have a dop without interior: its volume is 0, which no bound would say.

use super::{DopViolation, check};
use crate::ConvexBody;
use crate::bodies::volume;

/// The longest side has from 2⁴³ to 2⁴⁴ units, so that offsets with sums of three coordinates are below 2⁴⁸.
const SIDE_BITS: i32 = 43;

/// Units for which neither they nor their cubes leave the range of normal numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -300..=310;

/// Offsets are at most this in units from the origin, as the volume of bodies takes them.
const UNITS_MAX: i128 = 1 << 48;

/// Units by which the outer body is made larger where its middle is not in its interior: more than a middle is moved by rounding.
const WIDENED_UNITS: i64 = 4;

/// Facets, at most: all vectors of −1, 0 and 1.
const FACETS_MAX: usize = 26;

/// The dop between two bodies on a grid.
pub(super) struct Shape {
    /// The longest side along an axis.
    side: f64,
    unit: f64,
    /// The origin of the grid, in units.
    origin: [i128; 3],
    inner: ConvexBody,
    outer: ConvexBody,
    /// Whether all of it lies in a plane with one of the normals.
    is_flat: bool,
    /// The low corner of its box, which is all of it if the side is 0.
    low: [f64; 3],
}

impl Shape {
    pub(super) fn of(normals: &[[i64; 3]], offsets: &[f64]) -> Result<Self, DopViolation> {
        check_facets(normals, offsets)?;
        let offset_of = |u: [i64; 3]| {
            let found = normals.iter().position(|normal| *normal == u);
            let problem = "is missing: the six normals of the axes must be among the others";
            found.map(|at| offsets[at]).ok_or(DopViolation::Facet { facet: normals.len(), problem })
        };
        let axis = |c: usize, sign: i64| {
            let mut u = [0; 3];
            u[c] = sign;
            offset_of(u)
        };
        let (mut low, mut side) = ([0.0; 3], 0.0f64);
        for c in 0..3 {
            low[c] = 0.0 - axis(c, -1)?;
            side = side.max(axis(c, 1)? - low[c]);
        }
        let is_flat = normals.iter().zip(offsets).any(|(normal, h)| {
            let opposite = offset_of(normal.map(|n| -n));
            opposite.is_ok_and(|other| h + other <= 0.0)
        });
        let of_body = |offsets| ConvexBody { normals: normals.to_vec(), offsets, volume: 0.0 };
        if side <= 0.0 {
            let (inner, outer) = (of_body(vec![]), of_body(vec![]));
            let (unit, origin) = (1.0, [0; 3]);
            return Ok(Shape { side: 0.0, unit, origin, inner, outer, is_flat: true, low });
        }
        let exponent = (side.to_bits() >> 52) as i32 - 1023 - SIDE_BITS;
        if !EXPONENTS.contains(&exponent) {
            return Err(DopViolation::Range { side });
        }
        let far = |facet| DopViolation::Facet {
            facet,
            problem: "is far from all others, or they are far from 0 beside the longest side",
        };
        let mut origin = [0; 3];
        for c in 0..3 {
            origin[c] = whole(low[c], exponent).ok_or_else(|| far(c))?.0;
        }
        let (mut floors, mut ceilings) = (vec![], vec![]);
        for (facet, (normal, &h)) in normals.iter().zip(offsets).enumerate() {
            let (floor, is_exact) = whole(h, exponent).ok_or_else(|| far(facet))?;
            let shift: i128 = (0..3).map(|c| i128::from(normal[c]) * origin[c]).sum();
            let units = floor - shift;
            if !(-UNITS_MAX..UNITS_MAX).contains(&units) {
                return Err(far(facet));
            }
            floors.push(units as i64);
            ceilings.push(units as i64 + i64::from(!is_exact));
        }
        let (inner, outer) = (of_body(floors), of_body(ceilings));
        Ok(Shape { side, unit: 2f64.powi(exponent), origin, inner, outer, is_flat, low })
    }

    /// How far a vertex may be from where it is found.
    pub(super) fn slack(&self) -> f64 {
        let ends = self.low.iter().map(|x| x.abs());
        1e-9 * self.side + 1e-15 * (ends.fold(0.0, f64::max) + self.side)
    }

    pub(super) fn vertices(&self) -> Vec<[f64; 3]> {
        match self.side > 0.0 {
            true => volume::vertices(&self.outer).into_iter().map(|y| self.place(y)).collect(),
            false => vec![self.low],
        }
    }

    /// The facets as polygons of a dop with an interior.
    pub(super) fn polygons(&self) -> Vec<Vec<[f64; 3]>> {
        let placed = |polygon: Vec<_>| polygon.into_iter().map(|y| self.place(y)).collect();
        volume::polygons(&self.outer).into_iter().map(placed).collect()
    }

    /// Bounds of the volume.
    pub(super) fn volume(&self) -> [f64; 2] {
        if self.is_flat {
            return [0.0; 2];
        }
        let vertices = volume::vertices(&self.outer);
        let middle = [0, 1, 2].map(|c| {
            let sum: f64 = vertices.iter().map(|vertex| vertex[c]).sum();
            (sum / vertices.len().max(1) as f64).round() as i64
        });
        let holds = |body: &ConvexBody| {
            body.normals.iter().zip(&body.offsets).all(|(normal, &h)| {
                let along: i64 = (0..3).map(|c| normal[c] * middle[c]).sum();
                along < h
            })
        };
        let mut outer = self.outer.clone();
        if !holds(&outer) {
            outer.offsets.iter_mut().for_each(|h| *h += WIDENED_UNITS);
        }
        let cube = self.unit * self.unit * self.unit;
        let lower = match holds(&self.inner) {
            true => volume::bounds(&self.inner, middle)[0],
            false => 0.0,
        };
        [lower * cube, volume::bounds(&outer, middle)[1] * cube]
    }

    fn place(&self, y: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| (self.origin[c] as f64 + y[c]) * self.unit)
    }
}

/// Refuses half-spaces that are malformed one by one.
fn check_facets(normals: &[[i64; 3]], offsets: &[f64]) -> Result<(), DopViolation> {
    if normals.len() != offsets.len() || normals.len() > FACETS_MAX {
        let problem = "is missing, or there are more than 26";
        return Err(DopViolation::Facet { facet: normals.len().min(offsets.len()), problem });
    }
    for (facet, normal) in normals.iter().enumerate() {
        let wrong = |problem| Err(DopViolation::Facet { facet, problem });
        if normal.iter().any(|&n| !(-1..=1).contains(&n)) || *normal == [0; 3] {
            return wrong("has a normal that is 0, or an entry other than -1, 0 and 1");
        }
        if normals[..facet].contains(normal) {
            return wrong("has the normal of an earlier facet");
        }
        if !offsets[facet].is_finite() || offsets[facet].abs() > check::OFFSET_MAX {
            return wrong("has an offset that is not finite, or above 1e300");
        }
    }
    Ok(())
}

/// The floor of x in units of 2^exponent, and whether it is x; none where it is too large.
fn whole(x: f64, exponent: i32) -> Option<(i128, bool)> {
    let bits = x.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, (bits & ((1 << 52) - 1)) as i128);
    let (mantissa, place) =
        if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    let mantissa = if x < 0.0 { -mantissa } else { mantissa };
    match place - exponent {
        up @ 0..=70 => Some((mantissa << up, true)),
        71.. => (mantissa == 0).then_some((0, true)),
        down => {
            // A shift by 64 leaves the sign alone.
            let down = (-down).min(64) as u32;
            let floor = mantissa >> down;
            Some((floor, floor << down == mantissa))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BoundingDop;

    #[test]
    fn floors_are_exact() {
        for (x, exponent, expected) in [
            (5.0, 0, Some((5, true))),
            (-5.5, 0, Some((-6, false))),
            (0.75, -1, Some((1, false))),
            (-1e-300, 0, Some((-1, false))),
            (-0.0, 3, Some((0, true))),
            (2f64.powi(200), 1, None),
            (2f64.powi(100), 60, Some((1 << 40, true))),
            (f64::from_bits(1), -1074, Some((1, true))),
        ] {
            assert_eq!(whole(x, exponent), expected, "{x} {exponent}");
        }
    }

    #[test]
    fn boxes_have_their_vertices_and_volumes() {
        let normals = BoundingDop::directions(6);
        // The thin box is two million units thick, so that a unit is 5e-7 of it.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
        for (offsets, vertices, volume) in [
            (vec![3.0, 0.0, 4.0, 0.0, 5.0, 0.0], 8, 60.0),
            (vec![0.3, -0.1, 1e-6, 0.0, 7.7, 0.1], 8, 0.2 * 1e-6 * 7.8),
            (vec![1e6 + 1.0, -1e6, 1.0, 0.0, 1.0, 0.0], 8, 1.0),
            (vec![3.0, -3.0, 4.0, 0.0, 5.0, 0.0], 4, 0.0),
            (vec![3.0, -3.0, 4.0, -4.0, 5.0, 0.0], 2, 0.0),
            (vec![3.0, -3.0, 4.0, -4.0, 5.0, -5.0], 1, 0.0),
        ] {
            let dop = BoundingDop::of_half_spaces(normals.clone(), offsets.clone()).unwrap();
            assert_eq!(dop.vertices.len(), vertices, "{offsets:?}");
            assert!(near(dop.volume, volume), "{offsets:?}: {}", dop.volume);
            let polygons = dop.polygons();
            assert_eq!(
                polygons.iter().filter(|polygon| polygon.len() == 4).count() == 6,
                volume > 0.0
            );
            let [lower, upper] = Shape::of(&normals, &offsets).unwrap().volume();
            assert!(lower <= upper && upper <= lower * (1.0 + 1e-6), "{lower} {upper}");
        }
        // One corner of the cube is cut off, through its three neighbors.
        let mut offsets = vec![1.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        let all = BoundingDop::directions(14);
        offsets.extend([2.0, 0.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0]);
        let dop = BoundingDop::of_half_spaces(all, offsets).unwrap();
        assert_eq!(dop.vertices.len(), 7);
        assert!(near(dop.volume, 5.0 / 6.0), "{}", dop.volume);
    }

    #[test]
    fn malformed_half_spaces_are_refused() {
        let six = BoundingDop::directions(6);
        let offsets = [1.0; 6];
        let refused = |normals: &[[i64; 3]], offsets: &[f64]| {
            BoundingDop::of_half_spaces(normals.to_vec(), offsets.to_vec()).unwrap_err().to_string()
        };
        assert!(refused(&six[1..], &offsets[1..]).contains("facet 5 is missing"));
        assert!(refused(&six, &offsets[1..]).contains("facet 5 is missing"));
        let with = |u: [i64; 3]| [&six[..], &[u]].concat();
        assert!(refused(&with([0, 2, 1]), &[1.0; 7]).contains("facet 6 has a normal that is 0"));
        assert!(refused(&with([0; 3]), &[1.0; 7]).contains("facet 6 has a normal that is 0"));
        assert!(refused(&with([0, 1, 0]), &[1.0; 7]).contains("normal of an earlier"));
        assert!(refused(&six, &[f64::NAN, 1.0, 1.0, 1.0, 1.0, 1.0]).contains("not finite"));
        assert!(refused(&six, &[1e200; 6]).contains("longest side"));
        assert!(refused(&six, &[1e-90; 6]).contains("longest side"));
        let far = [1.0, 1.0, 1.0, 1.0, 1.0, -1e40];
        assert!(refused(&six, &far).contains("far from"));
        assert!(
            refused(&with([1, 1, 0]), &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1e9]).contains("far from")
        );
    }
}
