//! Solids with flat faces, and a smooth one, sampled at random: evenly by area, each point independent of the others.

use super::*;

/// A solid with flat faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Solid {
    /// A box with a hole right through it, an octagonal prism.
    Bored,
    /// Five steps.
    Stairs,
    /// A box with a rectangular hole right through it.
    Frame,
}

impl Solid {
    /// All of them, with what tables call them.
    pub(super) const ALL: [(Self, &'static str); 3] =
        [(Self::Bored, "bored box"), (Self::Stairs, "stairs"), (Self::Frame, "frame")];

    /// Its faces, cut into triangles; corners are not shared.
    fn shape(self) -> Mesh {
        match self {
            // A corner of the box belongs to every second corner of the octagon.
            Solid::Bored => ring(8, |k| {
                let angle = TAU * (k as f64 + 0.5) / 8.0;
                let outer = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
                [outer[k].map(f64::from), [0.5 * angle.cos(), 0.5 * angle.sin()]]
            }),
            Solid::Stairs => stairs(5),
            Solid::Frame => ring(4, |k| {
                let corner = [[1, 1], [-1, 1], [-1, -1], [1, -1]][k].map(f64::from);
                [corner, [0.5 * corner[0], 0.375 * corner[1]]]
            }),
        }
    }

    /// Random points of it.
    pub(super) fn points(self, place: Place, count: usize, seed: u64) -> Result<Vec<Point>> {
        Ok(place.of(on_triangles(&self.shape(), count, seed)?))
    }
}

/// How the points of a solid lie in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// As they are: most faces have one coordinate in common.
    Upright,
    /// Turned, and rounded: no four points of a face are exactly in one plane but by chance.
    Turned,
    /// On a fine grid, turned by a whole matrix: all points of a face are exactly in one plane, and that is level with no axis.
    Tilted,
}

impl Place {
    /// All of them, with what tables call them.
    pub(super) const ALL: [(Self, &'static str); 3] =
        [(Self::Upright, "upright"), (Self::Turned, "turned"), (Self::Tilted, "tilted")];

    fn of(self, mut points: Vec<Point>) -> Vec<Point> {
        // A turn and a reflection, times three.
        let tilt = |[x, y, z]: Point| {
            [x + 2.0 * y + 2.0 * z, 2.0 * x + y - 2.0 * z, 2.0 * x - 2.0 * y + z]
        };
        let turn = |a: f64, b: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [cos * a - sin * b, sin * a + cos * b]
        };
        for point in &mut points {
            let [x, y, z] = *point;
            *point = match self {
                Place::Upright => *point,
                Place::Turned => {
                    let [x, y] = turn(x, y, 0.5);
                    let [y, z] = turn(y, z, 0.7);
                    [x, y, z]
                }
                // Exact: 25 bits, and four more.
                Place::Tilted => tilt([x, y, z].map(|x| (x * 2f64.powi(24)).round())),
            };
        }
        points
    }
}

/// Triangles of four corners.
fn push_quad(shape: &mut Mesh, corners: [Point; 4]) {
    let first = shape.vertices.len() as u32;
    shape.vertices.extend(corners);
    let corners = [[0, 1, 2], [0, 2, 3]];
    shape.simplices.extend(corners.as_flattened().iter().map(|corner| first + corner));
}

/// The prism of height 1 over what lies between an outer and an inner polygon, given corner by corner.
fn ring(count: usize, corner: impl Fn(usize) -> [[f64; 2]; 2]) -> Mesh {
    let mut shape = Mesh::default();
    for k in 0..count {
        let ([outer, inner], [outer_next, inner_next]) = (corner(k), corner((k + 1) % count));
        let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
        for z in [0.0, 1.0] {
            push_quad(&mut shape, [outer, outer_next, inner_next, inner].map(|p| at(p, z)));
        }
        for [from, to] in [[outer, outer_next], [inner, inner_next]] {
            push_quad(&mut shape, [at(from, 0.0), at(to, 0.0), at(to, 1.0), at(from, 1.0)]);
        }
    }
    shape
}

/// So many steps of width and height 1/4, a unit deep.
fn stairs(steps: usize) -> Mesh {
    let mut shape = Mesh::default();
    let end = 0.25 * steps as f64;
    for step in 0..steps {
        let (from, to) = (0.25 * step as f64, 0.25 * (step + 1) as f64);
        let upright =
            |x: f64, z: [f64; 2]| [[x, 0.0, z[0]], [x, 1.0, z[0]], [x, 1.0, z[1]], [x, 0.0, z[1]]];
        let level = |z: f64| [[from, 0.0, z], [to, 0.0, z], [to, 1.0, z], [from, 1.0, z]];
        // The rise, the tread, what lies under it, and the two ends of this step.
        push_quad(&mut shape, upright(from, [from, to]));
        push_quad(&mut shape, level(to));
        push_quad(&mut shape, level(0.0));
        for y in [0.0, 1.0] {
            push_quad(&mut shape, [[from, y, 0.0], [to, y, 0.0], [to, y, to], [from, y, to]]);
        }
    }
    push_quad(&mut shape, [[end, 0.0, 0.0], [end, 1.0, 0.0], [end, 1.0, end], [end, 0.0, end]]);
    shape
}

/// Radius of a sphere around all of the blend.
const BLEND_RADIUS: f64 = 3.75;

/// Three rings in a row that run into each other: negative inside, and nowhere steeper than a distance.
fn blend([x, y, z]: Point) -> f64 {
    // The logarithm of a sum of exponentials is a smooth minimum; with 12, fillets are about a tenth of a unit wide.
    const SHARPNESS: f64 = 12.0;
    let ring = |center: f64| (((x - center).hypot(y) - 1.0).hypot(z)) - 0.35;
    let sum: f64 = [-2.25, 0.0, 2.25].map(|center| (-SHARPNESS * ring(center)).exp()).iter().sum();
    -sum.ln() / SHARPNESS
}

/// Random points of a smooth body with three handles.
///
/// A random line meets each part of a surface as often as its area says (Crofton), so these are where random lines meet it. Chords
/// shorter than a hundredth are passed over.
pub(super) fn handles(count: usize, seed: u64) -> Result<Vec<Point>> {
    const STEP: f64 = 0.01;
    let mut points = Vec::with_capacity(count);
    for round in 0.. {
        let lines = count - points.len();
        if lines == 0 {
            break;
        }
        let directions = generate(Distribution::Sphere, lines, 3, seed + 2 * round)?;
        let places = chances::<2>(lines, seed + 2 * round + 1)?;
        for (direction, [far, around]) in directions.as_chunks::<3>().0.iter().zip(places) {
            let [side, up] = across(direction);
            let radius = BLEND_RADIUS * far.sqrt();
            let (sin, cos) = (TAU * around).sin_cos();
            let middle = [0, 1, 2].map(|k| radius * (cos * side[k] + sin * up[k]));
            let at = |t: f64| [0, 1, 2].map(|k| middle[k] + t * direction[k]);
            let end = (BLEND_RADIUS * BLEND_RADIUS - radius * radius).sqrt();
            let (mut t, mut value) = (-end, blend(at(-end)));
            while t < end && points.len() < count {
                let next = t + value.abs().max(STEP);
                let found = blend(at(next));
                if (found < 0.0) != (value < 0.0) {
                    points.push(at(root(|t| blend(at(t)), t, next)));
                }
                (t, value) = (next, found);
            }
        }
    }
    Ok(points)
}

/// Two directions that are upright on a third one and on each other.
fn across(direction: &Point) -> [Point; 2] {
    let cross = |a: &Point, b: &Point| {
        [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let axis = if direction[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let side = cross(direction, &axis);
    let length = side.iter().map(|x| x * x).sum::<f64>().sqrt();
    let side = side.map(|x| x / length);
    [side, cross(direction, &side)]
}

/// Where a function changes its sign, by halving.
fn root(value: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let is_inside = value(from) < 0.0;
    for _ in 0..50 {
        let middle = 0.5 * (from + to);
        if (value(middle) < 0.0) == is_inside { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_have_the_area_of_their_faces() {
        let area = |solid: Solid| {
            let shape = solid.shape();
            let corners = shape.triangles().iter().map(|t| t.map(|v| shape.vertices[v as usize]));
            corners
                .map(|[a, b, c]| {
                    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
                    let n = [0, 1, 2]
                        .map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
                    0.5 * n.iter().map(|x| x * x).sum::<f64>().sqrt()
                })
                .sum::<f64>()
        };
        // Two caps of 4 − 0.75, and sides of the lengths 8 and 3.5.
        assert!((area(Solid::Frame) - (2.0 * 3.25 + 11.5)).abs() < 1e-12);
        // Treads and rises of 1.25 each, what lies under and behind them, and two ends of 15/16.
        assert!((area(Solid::Stairs) - (5.0 + 1.875)).abs() < 1e-12);
        let octagon = 8.0 * 0.125 * (TAU / 8.0).sin();
        let around = 16.0 * 0.5 * (TAU / 16.0).sin();
        assert!((area(Solid::Bored) - (2.0 * (4.0 - octagon) + 8.0 + around)).abs() < 1e-12);
    }

    #[test]
    fn tilted_faces_are_flat_exactly() {
        let points = Solid::Stairs.points(Place::Tilted, 400, 1).unwrap();
        // The matrix is its own inverse, times nine.
        let z = |[x, y, z]: Point| 2.0 * x - 2.0 * y + z;
        assert!(points.iter().filter(|&&p| z(p) == 0.0).count() > 40);
        assert!(points.iter().all(|p| p.iter().all(|x| x.fract() == 0.0)));
    }

    #[test]
    fn the_blend_is_met_where_it_is() {
        let points = handles(500, 3).unwrap();
        assert_eq!(points.len(), 500);
        assert!(points.iter().all(|&p| blend(p).abs() < 1e-12));
        // Three holes, and one body where rings meet.
        assert!([-2.25, 0.0, 2.25].iter().all(|&x| blend([x, 0.0, 0.0]) > 0.5));
        assert!([-1.125, 1.125].iter().all(|&x| blend([x, 0.0, 0.0]) < -0.1));
    }
}
