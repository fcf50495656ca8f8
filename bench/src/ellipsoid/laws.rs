//! Points as the literature on ellipsoids draws them, made of taut's seeded generators.

use super::*;

/// From what points are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Law {
    /// Each coordinate standard normal.
    Normal,
    /// Uniform in the unit cube.
    Uniform,
    /// Each coordinate a quotient of two normal ones.
    Cauchy,
    /// Uniform direction, distance uniform in (1 − t, 1], stretched along d axes from 1 to 1000 and turned.
    Shell(f64),
    /// Ten normal clouds of any shape around centers uniform in [−10, 10]ᵈ, after Sun and Freund.
    Mix,
}

impl std::fmt::Display for Law {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Law::Normal => write!(f, "normal"),
            Law::Uniform => write!(f, "uniform"),
            Law::Cauchy => write!(f, "Cauchy"),
            Law::Shell(thickness) => write!(f, "shell {thickness:e}"),
            Law::Mix => write!(f, "mix of ten clouds"),
        }
    }
}

/// Clouds of [`Law::Mix`].
const CLOUDS: usize = 10;

impl Law {
    /// n points of dimension d, row by row.
    pub(super) fn draw(self, n: usize, d: usize, seed: u64) -> Result<Vec<f64>> {
        // What is drawn beside the points has a seed far from theirs.
        let beside = seed ^ (1 << 40);
        Ok(match self {
            Law::Normal => generate(Distribution::Normal, n, d, seed)?,
            Law::Uniform => generate(Distribution::Uniform, n, d, seed)?,
            Law::Cauchy => {
                let pairs: Vec<f64> = generate(Distribution::Normal, n, 2 * d, seed)?;
                pairs.as_chunks::<2>().0.iter().map(|[above, below]| above / below).collect()
            }
            Law::Shell(thickness) => {
                let mut values: Vec<f64> = generate(Distribution::Sphere, n, d, seed)?;
                let depths: Vec<f64> = generate(Distribution::Uniform, n, 1, beside)?;
                let axes = rotation(d, beside + 1)?;
                let last = d.saturating_sub(1).max(1) as f64;
                let mut point = vec![0.0; d];
                for (row, depth) in values.chunks_exact_mut(d).zip(depths) {
                    point.fill(0.0);
                    for (j, (x, axis)) in row.iter().zip(axes.chunks_exact(d)).enumerate() {
                        let x = x * (1.0 - thickness * depth) * 1000f64.powf(j as f64 / last);
                        point.iter_mut().zip(axis).for_each(|(p, a)| *p += x * a);
                    }
                    row.copy_from_slice(&point);
                }
                values
            }
            Law::Mix => {
                let mut values: Vec<f64> = generate(Distribution::Normal, n, d, seed)?;
                let shapes: Vec<f64> = generate(Distribution::Normal, CLOUDS * d, d, beside)?;
                let centers: Vec<f64> = generate(Distribution::Uniform, CLOUDS, d, beside + 1)?;
                let size = (d as f64).sqrt();
                for (i, row) in values.chunks_exact_mut(d).enumerate() {
                    let cloud = i % CLOUDS;
                    let shape = &shapes[cloud * d * d..(cloud + 1) * d * d];
                    let center = &centers[cloud * d..(cloud + 1) * d];
                    let moved = shape.chunks_exact(d).zip(center).map(|(along, center)| {
                        let x: f64 = along.iter().zip(&*row).map(|(a, x)| a * x).sum();
                        x / size + 20.0 * center - 10.0
                    });
                    let moved: Vec<f64> = moved.collect();
                    row.copy_from_slice(&moved);
                }
                values
            }
        })
    }
}

/// d orthonormal rows of any direction.
fn rotation(d: usize, seed: u64) -> Result<Vec<f64>> {
    let mut rows: Vec<f64> = generate(Distribution::Normal, d, d, seed)?;
    for i in 0..d {
        let (before, row) = rows.split_at_mut(i * d);
        let row = &mut row[..d];
        // Twice, as once leaves what rounding spoils.
        for _ in 0..2 {
            for other in before.chunks_exact(d) {
                let along: f64 = row.iter().zip(other).map(|(x, y)| x * y).sum();
                row.iter_mut().zip(other).for_each(|(x, y)| *x -= along * y);
            }
        }
        let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        row.iter_mut().for_each(|x| *x /= length);
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_lies_between_two_ellipsoids() {
        let (d, thickness, seed) = (4, 0.1, 7);
        let values = Law::Shell(thickness).draw(500, d, seed).unwrap();
        let axes = rotation(d, (seed ^ (1 << 40)) + 1).unwrap();
        let mut reached: f64 = 1.0;
        for row in values.chunks_exact(d) {
            let square = axes.chunks_exact(d).enumerate().map(|(j, axis)| {
                let along: f64 = row.iter().zip(axis).map(|(x, a)| x * a).sum();
                (along / 10f64.powi(j as i32)).powi(2)
            });
            let norm = square.sum::<f64>().sqrt();
            assert!((0.9 - 1e-12..=1.0 + 1e-12).contains(&norm), "{norm}");
            reached = reached.min(norm);
        }
        assert!(reached < 0.91);
    }

    #[test]
    fn seeds_and_laws_differ_and_sizes_are_right() {
        for law in [Law::Normal, Law::Uniform, Law::Cauchy, Law::Shell(1e-2), Law::Mix] {
            let drawn = law.draw(30, 3, 1).unwrap();
            assert_eq!(drawn.len(), 90);
            assert!(drawn.iter().all(|x| x.is_finite()));
            assert_eq!(drawn, law.draw(30, 3, 1).unwrap());
            assert_ne!(drawn, law.draw(30, 3, 2).unwrap());
        }
    }
}
