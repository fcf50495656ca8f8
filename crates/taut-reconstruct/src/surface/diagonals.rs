//! Diagonals of quadrangles: of the two triangles on one side of a cell, and the two on its other side, those that suit the surface.
//!
//! *Problem.* Four points nearly on a circle of a sheet make a flat cell, and on which side of it the surface passes hangs on little. The
//! wrong pair of triangles cuts off a sharp edge, or is long and thin.
//! *Idea.* Turning over a cell with two facets on the border swaps the diagonal of the quadrangle that these are. First it is done where
//! that makes the circumcircles of the triangles smaller, which Delaunay's diagonals have; then where it takes more than [`ANGLE_GAIN_MIN`] off
//! the sum of the angles of the surface along the diagonal and the four sides, and a sharp edge is among these.
//! *Guarantee.* All triangles remain facets, and a surface remains one of the same kind, as the new diagonal must not be an edge yet.
//! At most [`ROUNDS_MAX`] rounds in the order of cells: a function of the points. O(n).
//! *Trap.* Either criterion alone loses: by circles alone, thin triangles cut off the edges of machine parts; by angles alone, smooth
//! surfaces that are sampled sparsely fall to long triangles along their curvature.
//! *Reference.* Dyn, Levin and Rippa, Data dependent triangulations for piecewise linear interpolation, IMA J. Numer. Anal. 10, 1990,
//! for the angles.

use std::f64::consts::{FRAC_PI_2, PI};

use taut_delaunay::{GHOST, decode};
use taut_points::parallel::IntoParallel;

use super::cells::Cells;
use super::quad_quality::{QuadQuality, quad_qualities, quad_quality};
use super::spheres::{Point, cross, dot, minus};

/// The sum of angles must be less by more than this, in radians.
const ANGLE_GAIN_MIN: f64 = 1.0;
/// (cos 0.8)²: the least angle of a sharp edge is 0.8.
const SHARP_COS_SQUARE: f64 = 0.485_400_238_849_355_57;
const ROUNDS_MAX: usize = 16;
/// Cells of one task.
const TASK: usize = 1 << 12;

/// Swaps diagonals of the border, and says how many.
pub(super) fn swap(cells: &Cells, points: &[Point], inside: &mut [bool]) -> u64 {
    let labels = &*inside;
    let task = |begin: usize| {
        let some = begin as u32..cells.len().min(begin + TASK) as u32;
        let all: Vec<_> = some.filter_map(|cell| Quadrangle::of(cell, cells, labels)).collect();
        let quad_qualities = quad_qualities(&all, cells, points);
        let seen = all.into_iter().map(|quadrangle| quadrangle.cell).zip(quad_qualities);
        seen.filter(|(_, quad_quality)| quad_quality.is_rounder || quad_quality.is_bent).collect()
    };
    // Most are as they should be, which is seen in parallel; the others are looked at again, one after another.
    let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
    let looks_by_task: Vec<Vec<(u32, QuadQuality)>> = begins.into_par_iter().map(task).collect();
    let qualities_of_all = looks_by_task.concat();
    let of = |is: fn(&QuadQuality) -> bool| {
        let those = qualities_of_all.iter().filter(move |(_, quad_quality)| is(quad_quality));
        those.map(|&(cell, _)| cell).collect::<Vec<u32>>()
    };
    let is_rounder =
        |quadrangle: &Quadrangle, _: &[bool]| quad_quality(quadrangle, cells, points).is_rounder;
    let is_flatter =
        |quadrangle: &Quadrangle, inside: &[bool]| quadrangle.is_flatter(cells, points, inside);
    let rounder = of(|quad_quality| quad_quality.is_rounder);
    let (first, mut bent) = swap_where(is_rounder, Quadrangle::neighbors, rounder, cells, inside);
    bent.extend(of(|quad_quality| quad_quality.is_bent));
    bent.sort_unstable();
    bent.dedup();
    let (second, _) = swap_where(is_flatter, Quadrangle::around, bent, cells, inside);
    first + second
}

/// Swaps where it is better, then looks again at what that changes. How many were swapped, and the quadrangles that came of it.
fn swap_where(
    is_better: impl Fn(&Quadrangle, &[bool]) -> bool,
    changed: fn(&Quadrangle, &Cells, &[bool]) -> Vec<u32>,
    mut waiting: Vec<u32>,
    cells: &Cells,
    inside: &mut [bool],
) -> (u64, Vec<u32>) {
    let (mut swapped, mut touched) = (0, Vec::new());
    for _ in 0..ROUNDS_MAX {
        let mut next = Vec::new();
        for &cell in &waiting {
            let quadrangle = Quadrangle::of(cell, cells, inside).filter(|q| is_better(q, inside));
            let Some(quadrangle) = quadrangle.filter(|q| q.can_be_swapped(cells, inside)) else {
                continue;
            };
            inside[cell as usize] = !inside[cell as usize];
            swapped += 1;
            let changed = changed(&quadrangle, cells, inside).into_iter();
            next.extend(changed.filter(|&cell| Quadrangle::of(cell, cells, inside).is_some()));
        }
        if next.is_empty() {
            break;
        }
        next.sort_unstable();
        next.dedup();
        touched.extend_from_slice(&next);
        waiting = next;
    }
    (swapped, touched)
}

/// A cell that is no ghost with two facets on the border.
pub(super) struct Quadrangle {
    pub(super) cell: u32,
    /// Places of the ends of the diagonal. The facets opposite them are not on the border.
    pub(super) ends: [usize; 2],
    /// Places of the other two corners.
    pub(super) others: [usize; 2],
}

impl Quadrangle {
    pub(super) fn of(cell: u32, cells: &Cells, inside: &[bool]) -> Option<Self> {
        let own = inside[cell as usize];
        let is_border =
            |i: usize| usize::from(inside[cells.across(cell, i).0 as usize] != own) << i;
        let border = is_border(0) | is_border(1) | is_border(2) | is_border(3);
        // A table, as four branches would be guessed wrong half the time.
        let [others, ends] = PLACES[border]?;
        (!cells.is_ghost(cell)).then_some(Self { cell, ends, others })
    }

    /// The normals of the four triangles, outward from the cell, as long as twice their areas.
    #[inline]
    fn normals(&self, cells: &Cells, points: &[Point]) -> [Point; 4] {
        let [a, b, c, d] = cells.sites(self.cell).map(|site| points[site as usize]);
        [normal(b, c, d), normal(a, d, c), normal(a, b, d), normal(a, c, b)]
    }

    /// Returns true if the angles around the other two triangles are much less, and one of them is that of a sharp edge.
    fn is_flatter(&self, cells: &Cells, points: &[Point], inside: &[bool]) -> bool {
        let normals = self.normals(cells, points);
        let now = self.others.map(|i| normals[i]);
        let then = self.ends.map(|i| minus([0.0; 3], normals[i]));
        // At the diagonals and at the sides: what turns against what, now and then.
        let mut turns = [[[[0.0; 3]; 2]; 2]; 5];
        turns[0] = [now, then];
        let mut count = 1;
        // At a side, what turns now and what turns then differ by no more than the two triangles of the quadrangle do. Few could come to
        // so much, and for most others it shows before all sides are known.
        let sides = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[e, o]| [now[1 - o], then[1 - e]]);
        let at_most = sides.map(most);
        let mut bound = nearly_angle(now) - nearly_angle(then) + at_most.iter().sum::<f64>();
        for (e, &end) in self.ends.iter().enumerate() {
            for (o, &other) in self.others.iter().enumerate() {
                if bound + BOUND_TOLERANCE <= ANGLE_GAIN_MIN {
                    return false;
                }
                bound -= at_most[2 * e + o];
                // At the side from the one to the other, opposite the third and the fourth corner.
                let Some(facet) = self.beyond(cells, inside, [end, other], self.ends[1 - e]) else {
                    continue;
                };
                let (cell, i) = decode(facet);
                let sites = cells.facet(cell, i);
                if sites.contains(&GHOST) {
                    continue;
                }
                let [a, b, c] = sites.map(|site| points[site as usize]);
                let beside = normal(a, b, c);
                let [now, then] = sides[2 * e + o];
                turns[count] = [[now, beside], [then, beside]];
                bound += nearly_angle([now, beside]) - nearly_angle([then, beside]);
                count += 1;
            }
        }
        let turns = &turns[..count];
        // A sharp edge is seen without an angle.
        let has_sharp = is_sharp(now) || turns.iter().any(|&[_, then]| is_sharp(then));
        has_sharp && is_more(turns)
    }

    /// Returns true if the other diagonal is no edge of the border.
    fn can_be_swapped(&self, cells: &Cells, inside: &[bool]) -> bool {
        self.beyond(cells, inside, self.others, self.ends[0]).is_none()
    }

    /// Round an edge from the cell on, which is left by the facet at `out`: the first facet of the border, seen from the side that the
    /// cell is on. None if there is none on the way back to the cell.
    fn beyond(&self, cells: &Cells, inside: &[bool], edge: [usize; 2], out: usize) -> Option<u32> {
        let sites = cells.sites(self.cell);
        let ends = edge.map(|i| sites[i]);
        let (mut at, mut out) = (self.cell, out);
        loop {
            let (next, back) = cells.across(at, out);
            if inside[next as usize] != inside[self.cell as usize] {
                return Some(at << 2 | out as u32);
            }
            if next == self.cell {
                return None;
            }
            let sites = cells.sites(next);
            // All four places add up to 6. Which of them is left is not searched for, as that cannot be guessed.
            let place =
                |site: u32| (1..4).map(|i| i * usize::from(sites[i] == site)).sum::<usize>();
            out = 6 - back - place(ends[0]) - place(ends[1]);
            at = next;
        }
    }

    fn neighbors(&self, cells: &Cells, _: &[bool]) -> Vec<u32> {
        (0..4).map(|i| cells.across(self.cell, i).0).collect()
    }

    /// The cells across, and those at the triangles beside the quadrangle, which was just swapped.
    fn around(&self, cells: &Cells, inside: &[bool]) -> Vec<u32> {
        let mut around = self.neighbors(cells, inside);
        for &end in &self.ends {
            for (o, &other) in self.others.iter().enumerate() {
                if let Some(facet) = self.beyond(cells, inside, [end, other], self.others[1 - o]) {
                    around.extend([facet, cells.mirror(facet)].map(|facet| facet >> 2));
                }
            }
        }
        around
    }
}

/// (b − a) × (c − a).
#[inline]
fn normal(a: Point, b: Point, c: Point) -> Point {
    cross(minus(b, a), minus(c, a))
}

/// Tests whether the angles now are larger in sum than those then, by more than [`ANGLE_GAIN_MIN`].
fn is_more(turns: &[[[Point; 2]; 2]]) -> bool {
    let sum = |angle: fn([Point; 2]) -> f64| {
        turns.iter().map(|&[now, then]| angle(now) - angle(then)).sum::<f64>()
    };
    let nearly = sum(nearly_angle);
    // Most are far from the bound.
    let is_clear = (nearly - ANGLE_GAIN_MIN).abs() > 2.0 * turns.len() as f64 * ANGLE_TOLERANCE;
    if is_clear { nearly > ANGLE_GAIN_MIN } else { sum(angle) > ANGLE_GAIN_MIN }
}

/// The angle between two vectors.
fn angle([a, b]: [Point; 2]) -> f64 {
    let c = cross(a, b);
    dot(c, c).sqrt().atan2(dot(a, b))
}

/// Returns how much the angles of two vectors to any third one differ at most: their own angle, if they have one. Of a third one that is so short
/// itself, angles are roundings, which nothing bounds; no swap hangs on these.
fn most([a, b]: [Point; 2]) -> f64 {
    /// Squares of vectors so short that products of two of them are no longer numbers of full precision.
    const SQUARE_MIN: f64 = 1e-140;
    if dot(a, a).min(dot(b, b)) < SQUARE_MIN { PI } else { nearly_angle([a, b]) }
}

/// The angles in a bound can be off by this together: two at the diagonals, four that bound the sides, two for each
/// side that is known.
const BOUND_TOLERANCE: f64 = 14.0 * ANGLE_TOLERANCE;

/// [`nearly_angle`] is at most this much less or more than the angle.
const ANGLE_TOLERANCE: f64 = 1e-4;

/// The same to within [`ANGLE_TOLERANCE`], in a third of the time. The polynomial is 4.4.47 of Abramowitz and Stegun, Handbook of Mathematical
/// Functions, 1964, for the arc tangent from 0 to 1: with these digits it is 1.2e-5 off at most.
fn nearly_angle([a, b]: [Point; 2]) -> f64 {
    let c = cross(a, b);
    let (across, along) = (dot(c, c).sqrt(), dot(a, b));
    let (least, most) = (across.min(along.abs()), across.max(along.abs()));
    // Where nothing is across and nothing along, the sign of that nothing decides, as it does for atan2.
    let z = if most > 0.0 { least / most } else { 0.0 };
    let zz = z * z;
    let arc = z
        * (0.999_866_0
            + zz * (-0.330_299_5 + zz * (0.180_141_0 + zz * (-0.085_133_0 + zz * 0.020_835_1))));
    let acute = if across > along.abs() { FRAC_PI_2 - arc } else { arc };
    if along.is_sign_negative() { PI - acute } else { acute }
}

/// Tests whether it is that of a sharp edge.
fn is_sharp([a, b]: [Point; 2]) -> bool {
    let along = dot(a, b);
    along <= 0.0 || along * along <= SHARP_COS_SQUARE * dot(a, a) * dot(b, b)
}

/// For each set of facets, one bit each, the places of these and of the others, if there are two of both.
const PLACES: [Option<[[usize; 2]; 2]>; 16] = {
    let mut all = [None; 16];
    let pairs = [[[0, 1], [2, 3]], [[0, 2], [1, 3]], [[0, 3], [1, 2]]];
    let mut k = 0;
    while k < 3 {
        let [one, other] = pairs[k];
        all[1 << one[0] | 1 << one[1]] = Some([one, other]);
        all[1 << other[0] | 1 << other[1]] = Some([other, one]);
        k += 1;
    }
    all
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_and_angles() {
        let [a, b, c] = [[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
        assert_eq!(normal(a, b, c), [0.0, 0.0, 12.0]);
        assert_eq!(angle([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]), std::f64::consts::FRAC_PI_2);
        let turned = |x: f64| [[2.0, 0.0, 0.0], [x.cos(), x.sin(), 0.0]];
        assert!(!is_sharp(turned(0.0)) && !is_sharp(turned(0.799)) && is_sharp(turned(-0.801)));
        assert!(is_sharp(turned(3.0)));
    }

    #[test]
    fn nearly_angles() {
        for k in 0..=20_000 {
            let x = f64::from(k) * (PI / 20_000.0);
            for scale in [1e-30, 1.0, 1e30] {
                let pair = [[scale, 0.0, 0.0], [3.0 * x.cos(), 0.0, 3.0 * x.sin()]];
                assert!(
                    (nearly_angle(pair) - x).abs() < ANGLE_TOLERANCE
                        && (angle(pair) - x).abs() < 1e-15 * 4.0
                );
            }
        }
        let nothing = [[0.0; 3], [1.0, 2.0, 3.0]];
        assert_eq!((nearly_angle(nothing), angle(nothing)), (0.0, 0.0));
        let less_than_nothing = [[-0.0; 3], [1.0, 2.0, 3.0]];
        assert_eq!((nearly_angle(less_than_nothing), angle(less_than_nothing)), (PI, PI));
    }

    #[test]
    fn the_bound_is_found_however_near_the_angles_are() {
        let turned = |x: f64| [[1.0, 0.0, 0.0], [x.cos(), x.sin(), 0.0]];
        for beyond in [-1e-2, -1e-5, -1e-9, 1e-9, 1e-5, 1e-2] {
            let turns = [[turned(0.9 + beyond), turned(0.2)], [turned(0.5), turned(0.2)]];
            assert_eq!(is_more(&turns), beyond > 0.0, "{beyond}");
        }
    }

    #[test]
    fn places_of_two_facets() {
        assert_eq!(PLACES[0b0110], Some([[1, 2], [0, 3]]));
        assert_eq!(PLACES.iter().flatten().count(), 6);
    }
}
