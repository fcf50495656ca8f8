//! The eye that sees the unit ball, and the sheet it draws on.

use super::frame::PlotArea;
use crate::Projection;

/// The eye is this far from the middle of the scene, in radii of the scene.
pub(crate) const EYE_DISTANCE: f64 = 4.0;

pub(crate) type V3 = [f64; 3];

pub(crate) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a + t·b.
pub(crate) fn add(a: V3, b: V3, t: f64) -> V3 {
    [0, 1, 2].map(|k| a[k] + t * b[k])
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The eye and the sheet it draws on.
#[derive(Clone, Copy)]
pub(super) struct Camera {
    /// Right, up, and towards the eye.
    frame: [V3; 3],
    projection: Projection,
    middle: [f64; 2],
    /// Pixels of a unit at the middle of the scene.
    scale: f64,
}

impl Camera {
    /// An eye at an azimuth and an elevation, in degrees, that sees the unit ball fill the room.
    pub(super) fn new(
        projection: Projection,
        azimuth: f64,
        elevation: f64,
        room: PlotArea,
    ) -> Self {
        let (sa, ca) = sin_cos(azimuth);
        let (se, ce) = sin_cos(elevation.clamp(-90.0, 90.0));
        let frame = [[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
        let half = (room.right - room.left).min(room.bottom - room.top).max(20.0) / 2.0;
        // The outline of the unit ball seen from EYE_DISTANCE has radius EYE_DISTANCE/√(EYE_DISTANCE² − 1).
        let outline = match projection {
            Projection::Perspective => EYE_DISTANCE / (EYE_DISTANCE * EYE_DISTANCE - 1.0).sqrt(),
            Projection::Orthographic => 1.0,
        };
        let middle = [(room.left + room.right) / 2.0, (room.top + room.bottom) / 2.0];
        Camera { frame, projection, middle, scale: 0.97 * half / outline }
    }

    /// Returns how far balls of the stage reach from the middle of a room that the eye fills, in halves of its width or height.
    pub(super) fn reach(&self, room: PlotArea, balls: &[(V3, f64)]) -> f64 {
        let half = [(room.right - room.left) / 2.0, (room.bottom - room.top) / 2.0];
        let of = |&(place, radius): &(V3, f64)| {
            let v = self.turn(place);
            let (at, radius) = (self.pixel(v), radius * self.scale * self.zoom(v[2]));
            let part = |k: usize| ((at[k] - self.middle[k]).abs() + radius) / half[k].max(1.0);
            part(0).max(part(1))
        };
        balls.iter().map(of).fold(0.0, f64::max)
    }

    /// The same eye with a larger sheet.
    pub(super) fn enlarged(mut self, factor: f64) -> Self {
        self.scale *= factor;
        self
    }

    /// Turns a place of the stage: right, up, towards the eye.
    pub(super) fn turn(&self, p: V3) -> V3 {
        self.frame.map(|axis| dot(axis, p))
    }

    /// Returns how much larger things look at a depth.
    pub(super) fn zoom(&self, depth: f64) -> f64 {
        match self.projection {
            Projection::Perspective => EYE_DISTANCE / (EYE_DISTANCE - depth),
            Projection::Orthographic => 1.0,
        }
    }

    /// Returns how near a depth is, above 0 and affine on the sheet.
    pub(super) fn nearness(&self, depth: f64) -> f64 {
        match self.projection {
            Projection::Perspective => self.zoom(depth),
            Projection::Orthographic => 1.0 + depth / EYE_DISTANCE,
        }
    }

    /// The pixel of a turned place.
    pub(super) fn pixel(&self, v: V3) -> [f64; 2] {
        let s = self.scale * self.zoom(v[2]);
        [self.middle[0] + s * v[0], self.middle[1] - s * v[1]]
    }

    /// The direction from a turned place to the eye.
    pub(super) fn to_eye(self, v: V3) -> V3 {
        match self.projection {
            Projection::Perspective => [-v[0], -v[1], EYE_DISTANCE - v[2]],
            Projection::Orthographic => [0.0, 0.0, 1.0],
        }
    }

    /// The outline of a sphere: the circle where lines from the eye touch it.
    pub(super) fn outline(&self, center: V3, radius: f64) -> Vec<[f64; 2]> {
        let to_eye = self.to_eye(center);
        let distance = dot(to_eye, to_eye).sqrt();
        let sine = match self.projection {
            Projection::Perspective => (radius / distance).min(0.999),
            Projection::Orthographic => 0.0,
        };
        let axis = to_eye.map(|v| v / distance);
        let middle = add(center, axis, radius * sine);
        let ring = radius * (1.0 - sine * sine).sqrt();
        let [u, w] = across(axis);
        (0..96)
            .map(|i| {
                let (s, c) = (f64::from(i) / 96.0 * std::f64::consts::TAU).sin_cos();
                self.pixel(add(add(middle, u, ring * c), w, ring * s))
            })
            .collect()
    }
}

/// Two directions that make a frame with a unit vector.
fn across(axis: V3) -> [V3; 2] {
    let helper = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = add(helper, axis, -dot(helper, axis));
    let u = u.map(|v| v / dot(u, u).sqrt());
    [u, cross(axis, u)]
}

/// Sine and cosine of an angle in degrees, the same on every machine: the functions of the system differ in last bits.
/// They are exact at multiples of 90. What is not a number is no turn.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let degrees = if degrees.is_finite() { degrees % 360.0 } else { 0.0 };
    let quarters = (degrees / 90.0).round();
    let x = (degrees - 90.0 * quarters) * (std::f64::consts::PI / 180.0);
    // Taylor's series around 0; |x| ≤ π/4, so the first term left out is below 1e-18.
    let (mut sin, mut cos, mut term) = (0.0, 0.0, 1.0);
    for k in 0..9 {
        cos += term;
        term *= x / f64::from(2 * k + 1);
        sin += term;
        term *= -x / f64::from(2 * k + 2);
    }
    match quarters as i64 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    #[test]
    fn angles_are_those_of_the_system_and_exact_at_quarters() {
        for i in -1000..1000 {
            let degrees = f64::from(i) * 0.77;
            let (own, system) = (sin_cos(degrees), degrees.to_radians().sin_cos());
            assert!((own.0 - system.0).abs() + (own.1 - system.1).abs() < 1e-14, "{degrees}");
        }
        let quarters = [0.0, 90.0, 180.0, -90.0].map(sin_cos);
        assert_eq!(quarters, [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]);
        assert_eq!(sin_cos(f64::NAN), (0.0, 1.0));
    }
}
