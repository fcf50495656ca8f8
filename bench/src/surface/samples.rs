//! Points of surfaces that are known: drawn from meshes, and made by formulas and taut's seeded generators.

use super::*;

/// A point of space.
pub(crate) type Point = [f64; 3];

/// Rows of `N` numbers in [0, 1).
pub(super) fn chances<const N: usize>(count: usize, seed: u64) -> Result<Vec<[f64; N]>> {
    let flat = generate(Distribution::Uniform, count, N, seed)?;
    Ok(flat.as_chunks().0.to_vec())
}

/// A share of the points, each kept or not by chance.
pub(super) fn thinned(points: &[Point], share: f64, seed: u64) -> Result<Vec<Point>> {
    let lots = chances::<1>(points.len(), seed)?;
    let kept = points.iter().zip(lots).filter(|(_, [lot])| *lot < share);
    Ok(kept.map(|(&point, _)| point).collect())
}

/// The points, each coordinate off by normal noise of this deviation.
pub(super) fn noisy(points: &[Point], deviation: f64, seed: u64) -> Result<Vec<Point>> {
    let noise = generate(Distribution::Normal, points.len(), 3, seed)?;
    let off = |(point, noise): (&Point, &Point)| [0, 1, 2].map(|k| point[k] + deviation * noise[k]);
    Ok(points.iter().zip(noise.as_chunks().0).map(off).collect())
}

/// Points of the triangles of a mesh, independent of each other and even by area.
pub(super) fn on_triangles(mesh: &Mesh, count: usize, seed: u64) -> Result<Vec<Point>> {
    let mut below = 0.0;
    let corners = mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices[v as usize]));
    let (triangles, areas): (Vec<[Point; 3]>, Vec<f64>) = corners
        .map(|[a, b, c]| {
            let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
            let normal = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                u[i] * v[j] - u[j] * v[i]
            });
            below += 0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            ([a, b, c], below)
        })
        .unzip();
    let place = |[lot, s, t]: [f64; 3]| {
        let at = areas.partition_point(|&area| area <= lot * below).min(triangles.len() - 1);
        let [a, b, c] = triangles[at];
        // Of the two halves of the parallelogram, the outer one is folded back.
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        [0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]))
    };
    Ok(chances(count, seed)?.into_iter().map(place).collect())
}

/// Random points of the unit sphere, even by area.
pub(super) fn sphere(count: usize, seed: u64) -> Result<Vec<Point>> {
    let flat = generate(Distribution::Sphere, count, 3, seed)?;
    Ok(flat.as_chunks().0.to_vec())
}

/// Those above its equator, about half of `count`.
pub(super) fn hemisphere(count: usize, seed: u64) -> Result<Vec<Point>> {
    let mut points = sphere(count, seed)?;
    points.retain(|point| point[2] > 0.0);
    Ok(points)
}

/// So many ellipsoids with the axes 3 : 2 : 1, of random points each, in a cubic grid with a gap of 2 between neighbors.
pub(super) fn ellipsoids(count: usize, each: usize, seed: u64) -> Result<Vec<Point>> {
    let side = (1..).find(|side| side * side * side >= count).unwrap_or(1);
    let points = sphere(count * each, seed)?.into_iter().enumerate().map(|(i, point)| {
        let k = i / each;
        let place = [k % side, k / side % side, k / side / side];
        [0, 1, 2].map(|axis| {
            let half = [3.0, 2.0, 1.0][axis];
            half * point[axis] + (2.0 * half + 2.0) * place[axis] as f64
        })
    });
    Ok(points.collect())
}

/// Two parallel unit squares of random points, so many mean spacings apart.
pub(super) fn sheets(each: usize, spacings: f64, seed: u64) -> Result<Vec<Point>> {
    let gap = spacings / (each as f64).sqrt();
    let lots = chances::<2>(2 * each, seed)?.into_iter().enumerate();
    Ok(lots.map(|(i, [x, y])| [x, y, if i < each { 0.0 } else { gap }]).collect())
}

/// A band of random points around the unit circle, two thirds wide, with so many turns: half a turn makes a Möbius band.
pub(super) fn band(count: usize, turns: f64, seed: u64) -> Result<Vec<Point>> {
    let place = |[s, t]: [f64; 2]| {
        let (around, across) = (TAU * s, (2.0 * t - 1.0) / 3.0);
        let (sin, cos) = (turns * around).sin_cos();
        let radius = 1.0 + across * cos;
        [radius * around.cos(), radius * around.sin(), across * sin]
    };
    Ok(chances(count, seed)?.into_iter().map(place).collect())
}

/// Two patches of z = x² − y² over the unit square, one half a unit above the other.
pub(super) fn saddles(count: usize, seed: u64) -> Result<Vec<Point>> {
    let lots = chances::<2>(count, seed)?.into_iter().enumerate();
    let place = |(i, [s, t]): (usize, [f64; 2])| {
        let (x, y) = (2.0 * s - 1.0, 2.0 * t - 1.0);
        [x, y, x * x - y * y + 0.5 * (i % 2) as f64]
    };
    Ok(lots.map(place).collect())
}

/// A solid wedge on a grid: two faces that meet along an edge at an angle, with the back and the two ends that close it.
pub(super) fn wedge(angle: f64, steps: usize) -> Vec<Point> {
    let step = 1.0 / steps as f64;
    let mut points = vec![];
    for i in 0..=steps {
        let x = step * i as f64;
        let half = x * (0.5 * angle).tan();
        let layers = if i == 0 { 0 } else { (2.0 * half / step).ceil() as usize };
        for j in 0..=steps {
            let is_rim = i == steps || j == 0 || j == steps;
            for k in (0..=layers).filter(|&k| is_rim || k == 0 || k == layers) {
                let z =
                    if layers == 0 { 0.0 } else { half * (2 * k) as f64 / layers as f64 - half };
                points.push([x, step * j as f64, z]);
            }
        }
    }
    points
}

/// The first `count` points of rings of 64 points each, exactly alike and one above the other: cocircular up to rounding. They are
/// of a body that is wide, narrow and wide again, without its ends.
pub(super) fn rings(count: usize) -> Vec<Point> {
    let high = count.div_ceil(64) as f64;
    let place = |i: usize| {
        let (ring, at) = ((i / 64) as f64, (i % 64) as f64);
        let along = TAU * ring / high;
        let radius = 40.0 + 12.0 * along.cos() + 5.0 * (3.0 * along).sin();
        let (sin, cos) = (TAU * at / 64.0).sin_cos();
        [radius * cos, radius * sin, 3.9 * ring]
    };
    (0..count).map(place).collect()
}

/// Points on a spiral over the unit sphere, evenly spaced.
pub(super) fn spiral(count: usize) -> Vec<Point> {
    let turn = 0.5 * TAU * (3.0 - 5f64.sqrt());
    let place = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sin, cos) = (turn * i as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        [radius * cos, radius * sin, z]
    };
    (0..count).map(place).collect()
}

/// The same on a pear: thinner towards the top, and drawn out.
pub(super) fn pear(count: usize) -> Vec<Point> {
    let place = |[x, y, z]: Point| {
        let radius = 1.0 - 0.35 * (FRAC_PI_2 * z).sin();
        [radius * x, radius * y, 1.3 * z]
    };
    spiral(count).into_iter().map(place).collect()
}

/// Four fingers side by side, of the same number of points each, drawn out to different lengths.
pub(super) fn fist(each: usize) -> Vec<Point> {
    let finger = |k: usize| {
        let length = [2.5, 3.0, 2.8, 2.2][k];
        let place = move |[x, y, z]: Point| [x + 2.5 * k as f64, y, length * z];
        spiral(each).into_iter().map(place)
    };
    (0..4).flat_map(finger).collect()
}

/// A corner and two sides.
type Plate = [[i32; 3]; 3];

/// The lattice of `per_unit` squares a unit length on plates, with their edges, each point once.
fn plated(plates: &[Plate], per_unit: i32) -> Vec<Point> {
    let mut places = vec![];
    for [corner, u, v] in plates {
        let squares = |side: &[i32; 3]| per_unit * side.iter().map(|x| x.abs()).sum::<i32>();
        let ([along, across], unit) =
            ([squares(u), squares(v)], |side: &[i32; 3]| side.map(i32::signum));
        for i in 0..=along {
            for j in 0..=across {
                let (u, v) = (unit(u), unit(v));
                places.push([0, 1, 2].map(|k| per_unit * corner[k] + i * u[k] + j * v[k]));
            }
        }
    }
    places.sort_unstable();
    places.dedup();
    places.into_iter().map(|place| place.map(|x| f64::from(x) / f64::from(per_unit))).collect()
}

/// Five square towers on a sheet with one border: sharp edges, concave ones among them.
pub(super) fn towers(per_unit: i32) -> Vec<Point> {
    const HEIGHTS: [i32; 5] = [2, 3, 3, 3, 2];
    let (x, y) = ([1, 0, 0], [0, 1, 0]);
    let mut plates: Vec<Plate> = vec![];
    for i in 0..11 {
        for j in 0..3 {
            let height = if j == 1 && i % 2 == 1 { HEIGHTS[i as usize / 2] } else { 0 };
            plates.push([[i, j, height], x, y]);
            if height > 0 {
                let up = [0, 0, height];
                plates.extend([
                    [[i, j, 0], x, up],
                    [[i, j + 1, 0], x, up],
                    [[i, j, 0], y, up],
                    [[i + 1, j, 0], y, up],
                ]);
            }
        }
    }
    plated(&plates, per_unit)
}

/// Six stairs of width 6: a sheet with one border and sharp edges of both kinds.
pub(super) fn staircase(per_unit: i32) -> Vec<Point> {
    let stair = |i: i32| [[[i, 0, i], [0, 0, 1], [0, 6, 0]], [[i, 0, i + 1], [1, 0, 0], [0, 6, 0]]];
    let plates: Vec<Plate> = (0..6).flat_map(stair).collect();
    plated(&plates, per_unit)
}

/// Points of a sphere above a plane that cuts a fourth off: a surface with one border.
pub(super) fn cap(count: usize) -> Vec<Point> {
    let mut points = spiral(count * 4 / 3);
    points.truncate(count);
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_of_plates_have_each_point_once() {
        // Twelve plates of 6 × 1 that share eleven edges.
        assert_eq!(staircase(2).len(), 13 * (12 * 2 + 1));
        let found = towers(1);
        // The sheet has 12 × 4 corners, and each tower 4 more on each level above.
        assert_eq!(found.len(), 12 * 4 + 4 * (2 + 3 + 3 + 3 + 2));
        assert_eq!(cap(100).len(), 100);
    }

    #[test]
    fn points_of_triangles_are_on_them_by_area() {
        let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]];
        let mesh = Mesh::of_triangles(vertices, &[[0, 1, 2], [0, 1, 3]]);
        let points = on_triangles(&mesh, 10_000, 1).unwrap();
        let flat = points.iter().filter(|point| point[2] == 0.0).count();
        assert!((2300..2700).contains(&flat), "{flat}");
        assert!(points.iter().all(|p| p[1] == 0.0 || p[2] == 0.0));
        assert!(points.iter().all(|[x, y, z]| x + y + z / 3.0 <= 1.0 + 1e-12));
    }

    #[test]
    fn samples_have_the_size_that_was_asked_for() {
        assert_eq!(rings(12_947).len(), 12_947);
        assert_eq!(fist(4096).len(), 16_384);
        assert_eq!(ellipsoids(300, 100, 1).unwrap().len(), 30_000);
        let wedge = wedge(0.5, 20);
        let mut distinct: Vec<[u64; 3]> = wedge.iter().map(|p| p.map(f64::to_bits)).collect();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), wedge.len());
    }
}
