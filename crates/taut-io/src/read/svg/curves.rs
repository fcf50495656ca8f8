//! Curves as chords.
//!
//! *Guarantee.* No point of a curve is farther from its chords than [`CHORD_ERROR`] times the size of the curve: the longer side of
//! the box of its control points, or the larger radius of an arc. A curve has at most some 250 chords, so a text of n bytes never
//! becomes more than a multiple of n vertices.
//! *Trap.* Sine and cosine are not the same on all machines, and points are known by their hash: arcs are halved by square roots,
//! and angles turned by a series, which are.
//! *Reference.* Wang's bound for chords of Bézier curves; SVG 2, appendix B.2.4 for the center of an arc.

use crate::read::chains::Stop;

/// A point of the plane.
pub(super) type Place = [f64; 2];

/// The distance of chords from their curve, relative to its size: a hundredth of a unit in a drawing of 100 units.
const CHORD_ERROR: f64 = 1e-4;

/// The cosine of the half angle at which the chord of a circle is [`CHORD_ERROR`] radii from its arc.
const CHORD_COSINE: f64 = 1.0 - CHORD_ERROR;

/// Halvings of an arc, at most: 2π/2⁸ is below the angle of [`CHORD_COSINE`] twice.
const HALVINGS_MAX: u32 = 8;

type Each<'a> = dyn FnMut(Place) -> Result<(), Stop> + 'a;

/// The ends of the chords of a cubic Bézier curve, but for its begin.
pub(super) fn cubic(p: [Place; 4], each: &mut Each<'_>) -> Result<(), Stop> {
    // The second derivative is at most 6 times the larger of these.
    let bend = 6.0 * second(p[0], p[1], p[2]).max(second(p[1], p[2], p[3]));
    let chords = chords(bend, &p);
    for k in 1..chords {
        let t = k as f64 / chords as f64;
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        each([0, 1].map(|c| (0..4).map(|i| weights[i] * p[i][c]).sum()))?;
    }
    each(p[3])
}

/// The same of a quadratic one.
pub(super) fn quadratic(p: [Place; 3], each: &mut Each<'_>) -> Result<(), Stop> {
    let chords = chords(2.0 * second(p[0], p[1], p[2]), &p);
    for k in 1..chords {
        let t = k as f64 / chords as f64;
        let s = 1.0 - t;
        let weights = [s * s, 2.0 * s * t, t * t];
        each([0, 1].map(|c| (0..3).map(|i| weights[i] * p[i][c]).sum()))?;
    }
    each(p[2])
}

/// The length of a − 2b + c.
fn second(a: Place, b: Place, c: Place) -> f64 {
    (a[0] - 2.0 * b[0] + c[0]).hypot(a[1] - 2.0 * b[1] + c[1])
}

/// How many chords a curve needs whose second derivative is at most `bend`: a chord of the n-th part is within bend/(8n²) of it.
fn chords(bend: f64, controls: &[Place]) -> usize {
    let side = |c: usize| {
        let along = controls.iter().map(|p| p[c]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let error = CHORD_ERROR * side(0).max(side(1));
    // Where the curve is a point, or out of range, this is no number, and one chord.
    (bend / (8.0 * error)).sqrt().ceil().clamp(1.0, 1000.0) as usize
}

/// An arc of an ellipse as SVG has it.
pub(super) struct Arc {
    pub(super) from: Place,
    pub(super) to: Place,
    pub(super) radii: [f64; 2],
    /// The angle of the first axis, in degrees.
    pub(super) turn: f64,
    pub(super) is_large: bool,
    /// Whether it leads towards larger angles.
    pub(super) is_positive: bool,
}

/// The ends of the chords of an arc, but for its begin.
pub(super) fn arc(arc: &Arc, each: &mut Each<'_>) -> Result<(), Stop> {
    let [rx, ry] = arc.radii.map(f64::abs);
    if arc.from == arc.to {
        return Ok(());
    }
    if rx == 0.0 || ry == 0.0 {
        return each(arc.to);
    }
    let [cosine, sine] = cosine_and_sine(arc.turn);
    let middle = [0, 1].map(|c| 0.5 * arc.from[c] + 0.5 * arc.to[c]);
    let half = [0, 1].map(|c| 0.5 * arc.from[c] - 0.5 * arc.to[c]);
    // The half chord in the frame in which the ellipse is the unit circle.
    let a = (cosine * half[0] + sine * half[1]) / rx;
    let b = (cosine * half[1] - sine * half[0]) / ry;
    let length = a.hypot(b);
    // Radii that are too small for the chord grow until they reach.
    let grown = length.max(1.0);
    let (a, b, length) = (a / grown, b / grown, length / grown);
    let off = ((1.0 - length) * (1.0 + length)).max(0.0).sqrt() / length;
    let off = if arc.is_large == arc.is_positive { -off } else { off };
    let center = [off * b, -off * a];
    let begin = unit([a - center[0], b - center[1]]);
    let end = unit([-a - center[0], -b - center[1]]);
    let place = |[x, y]: Place| {
        let [x, y] = [grown * rx * (center[0] + x), grown * ry * (center[1] + y)];
        [middle[0] + cosine * x - sine * y, middle[1] + sine * x + cosine * y]
    };
    // The middle of the arc is to the right of its chord where angles grow.
    let side = if arc.is_positive { 1.0 } else { -1.0 };
    let top = unit([side * (end[1] - begin[1]), -side * (end[0] - begin[0])]);
    halve(begin, top, 1, &place, each)?;
    each(place(top))?;
    halve(top, end, 1, &place, each)?;
    each(arc.to)
}

/// Hands on the points between two points of the unit circle that are at most a half circle apart.
fn halve(
    from: Place,
    to: Place,
    halvings: u32,
    place: &dyn Fn(Place) -> Place,
    each: &mut Each<'_>,
) -> Result<(), Stop> {
    let middle = unit([from[0] + to[0], from[1] + to[1]]);
    let cosine = from[0] * middle[0] + from[1] * middle[1];
    // Not a number where the ends are opposite, which only numbers out of range make them.
    if halvings >= HALVINGS_MAX || cosine.is_nan() || cosine >= CHORD_COSINE {
        return Ok(());
    }
    halve(from, middle, halvings + 1, place, each)?;
    each(place(middle))?;
    halve(middle, to, halvings + 1, place, each)
}

fn unit([x, y]: Place) -> Place {
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}

/// Cosine and sine of an angle in degrees, the same on every machine.
fn cosine_and_sine(degrees: f64) -> [f64; 2] {
    // Quarter turns are exact, and the rest is at most an eighth of a turn.
    let degrees = degrees % 360.0;
    let quarters = (degrees / 90.0).round();
    let x = (degrees - 90.0 * quarters).to_radians();
    // Terms of the series to below half a roundoff: x²ᵏ/(2k)! with x ≤ π/4 and k = 9.
    let (mut cosine, mut sine) = (1.0, 1.0);
    for k in (1..=9).rev() {
        let k = f64::from(k);
        cosine = 1.0 - x * x / ((2.0 * k - 1.0) * (2.0 * k)) * cosine;
        sine = 1.0 - x * x / ((2.0 * k) * (2.0 * k + 1.0)) * sine;
    }
    let sine = x * sine;
    match (quarters as i32).rem_euclid(4) {
        0 => [cosine, sine],
        1 => [-sine, cosine],
        2 => [-cosine, -sine],
        _ => [sine, -cosine],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(curve: impl FnOnce(&mut Each<'_>) -> Result<(), Stop>) -> Vec<Place> {
        let mut ends = vec![];
        let done = curve(&mut |at| {
            ends.push(at);
            Ok(())
        });
        assert!(done.is_ok());
        ends
    }

    #[test]
    fn cosines_and_sines_are_those_of_the_library() {
        for k in -900..900 {
            let degrees = 0.7 * f64::from(k);
            let [cosine, sine] = cosine_and_sine(degrees);
            let radians = degrees.to_radians();
            // The angle itself is rounded by up to 12 radians times the unit roundoff.
            assert!((cosine - radians.cos()).abs() < 2e-15 && (sine - radians.sin()).abs() < 2e-15);
        }
        assert_eq!(cosine_and_sine(-90.0), [0.0, -1.0]);
    }

    #[test]
    fn arcs_stay_on_their_ellipse_and_chords_near_it() {
        for (is_large, is_positive) in [(false, false), (false, true), (true, false), (true, true)]
        {
            for turn in [0.0, 30.0, -117.0] {
                let (from, to, radii) = ([1.0, 2.0], [4.0, 1.0], [3.0, 2.0]);
                let arc_ = Arc { from, to, radii, turn, is_large, is_positive };
                let ends = ends(|each| arc(&arc_, each));
                assert!(ends.len() > 8 && ends.len() <= 256, "{}", ends.len());
                assert_eq!(ends.last(), Some(&to));
                // The ellipse around the center that the first three points tell, in its own frame.
                let [cosine, sine] = cosine_and_sine(turn);
                let frame = |[x, y]: Place| {
                    [(cosine * x + sine * y) / radii[0], (cosine * y - sine * x) / radii[1]]
                };
                let circle: Vec<Place> =
                    std::iter::once(from).chain(ends.iter().copied()).map(frame).collect();
                let [a, b, c] = [0, circle.len() / 2, circle.len() - 1].map(|k| circle[k]);
                let center = circumcenter(a, b, c);
                let mut turned = 0.0;
                for pair in circle.windows(2) {
                    let [p, q] = [0, 1].map(|k| [pair[k][0] - center[0], pair[k][1] - center[1]]);
                    assert!((p[0].hypot(p[1]) - 1.0).abs() < 1e-12);
                    let chord = (0.5 * (p[0] + q[0])).hypot(0.5 * (p[1] + q[1]));
                    assert!(1.0 - chord <= CHORD_ERROR, "{chord}");
                    turned += (p[0] * q[1] - p[1] * q[0]).asin();
                }
                assert_eq!(turned > 0.0, is_positive);
                assert_eq!(turned.abs() > std::f64::consts::PI, is_large);
            }
        }
    }

    fn circumcenter(a: Place, b: Place, c: Place) -> Place {
        let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
        let doubled = 2.0 * (u[0] * v[1] - u[1] * v[0]);
        let [uu, vv] = [u, v].map(|p| p[0] * p[0] + p[1] * p[1]);
        [a[0] + (v[1] * uu - u[1] * vv) / doubled, a[1] + (u[0] * vv - v[0] * uu) / doubled]
    }

    #[test]
    fn chords_of_bezier_curves_are_near_them() {
        let p = [[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 1.0]];
        let at = |t: f64| {
            let s = 1.0 - t;
            let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
            [0, 1].map(|c| (0..4).map(|i| weights[i] * p[i][c]).sum::<f64>())
        };
        let ends: Vec<Place> = std::iter::once(p[0]).chain(ends(|each| cubic(p, each))).collect();
        let to_chords = |q: Place| {
            let to_chord = |pair: &[Place]| {
                let along = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
                let off = [q[0] - pair[0][0], q[1] - pair[0][1]];
                let square = along[0] * along[0] + along[1] * along[1];
                let t = ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0);
                (off[0] - t * along[0]).hypot(off[1] - t * along[1])
            };
            ends.windows(2).map(to_chord).fold(f64::INFINITY, f64::min)
        };
        let worst = (0..=1000).map(|k| to_chords(at(f64::from(k) / 1000.0))).fold(0.0, f64::max);
        assert!(worst <= 4.0 * CHORD_ERROR && worst > 0.1 * CHORD_ERROR, "{worst}");
        assert_eq!(
            super::tests::ends(|each| quadratic([p[0], [2.0, 0.5], [4.0, 1.0]], each)).len(),
            1
        );
    }

    #[test]
    fn degenerate_curves_end_where_they_should() {
        let point = [3.0, 3.0];
        assert_eq!(ends(|each| cubic([point; 4], each)), [point]);
        let huge = [[-1e308, 0.0], [1e308, 1e308], [1e308, -1e308], [0.0, 0.0]];
        assert!(ends(|each| cubic(huge, each)).len() <= 1000);
        for radii in [[0.0, 1.0], [1e-320, 1e-320], [1e308, 1e-308], [1e200, 1e200]] {
            let arc_ = Arc {
                from: [0.0, 0.0],
                to: point,
                radii,
                turn: 1e300,
                is_large: true,
                is_positive: false,
            };
            assert!(ends(|each| arc(&arc_, each)).last() == Some(&point));
        }
    }
}
