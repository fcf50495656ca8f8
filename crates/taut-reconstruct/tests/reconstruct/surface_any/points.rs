//! Points of known surfaces.

pub(crate) type Point = [f64; 3];

const TURN: f64 = std::f64::consts::TAU;

/// Numbers in [0, 1), the same for the same seed.
pub(crate) fn chances(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Random points of a sphere, evenly by area.
pub(crate) fn sphere(count: usize, center: Point, radius: f64, seed: u64) -> Vec<Point> {
    let mut chance = chances(seed);
    let point = |_| {
        let (z, t) = (2.0 * chance() - 1.0, TURN * chance());
        let r = (1.0 - z * z).sqrt();
        [center[0] + radius * r * t.cos(), center[1] + radius * r * t.sin(), center[2] + radius * z]
    };
    (0..count).map(point).collect()
}

/// A tube of radius `thick` around a closed curve: `rings` rings of `around` points, each turned against the last.
pub(crate) fn tube(
    curve: impl Fn(f64) -> Point,
    thick: f64,
    rings: usize,
    around: usize,
) -> Vec<Point> {
    let minus = |a: Point, b: Point| [0, 1, 2].map(|k| a[k] - b[k]);
    let cross = |a: Point, b: Point| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let unit = |a: Point| {
        let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        a.map(|x| x / length)
    };
    let mut points = Vec::new();
    for ring in 0..rings {
        let t = TURN * ring as f64 / rings as f64;
        let along = unit(minus(curve(t + 1e-4), curve(t - 1e-4)));
        let side = unit(cross(along, [0.3, 0.2, 0.93]));
        let up = cross(along, side);
        for k in 0..around {
            let s = TURN * (k as f64 + 0.5 * (ring % 2) as f64) / around as f64;
            let center = curve(t);
            points
                .push([0, 1, 2].map(|i| center[i] + thick * (s.cos() * side[i] + s.sin() * up[i])));
        }
    }
    points
}

/// A circle in the plane of x and y, or of x and z around (1, 0, 0).
pub(crate) fn circle(is_upright: bool) -> impl Fn(f64) -> Point {
    move |t| match is_upright {
        false => [t.cos(), t.sin(), 0.0],
        true => [1.0 + t.cos(), 0.0, t.sin()],
    }
}

/// The points of a cubic grid on the surface of a cube.
pub(crate) fn cube(edge: i32) -> Vec<Point> {
    let range = || 0..=edge;
    let all = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
    let on_surface = |p: &[i32; 3]| p.iter().any(|&x| x == 0 || x == edge);
    all.filter(on_surface).map(|p| p.map(f64::from)).collect()
}
