//! Sets whose ellipsoid is known: simplices, cubes, cross-polytopes, polygons, the moment curve, real data.

use ellipsoids::{exact, log_unit_ball, mapped, normal, rotation};

use crate::ellipsoids;

/// The gap asked of every case.
const GAP: f64 = 1e-12;

fn volume(name: &str, values: &[f64], dim: usize, wanted: f64) {
    let found = exact(name, values, dim, GAP);
    let difference = found.answer.log_volume - wanted;
    assert!(difference.abs() <= 2.0 * GAP + 1e-14 * wanted.abs(), "{name}: {difference:e} beside");
    assert_eq!(found.answer.hull, None, "{name}");
}

#[test]
fn simplices_have_equal_multipliers() {
    for dim in 1..=12 {
        // The unit vectors and the origin: Σ = (1 − J/(d + 1))/(d + 1), det Σ = (d + 1)^−(d + 1).
        let mut values = vec![0.0; (dim + 1) * dim];
        (0..dim).for_each(|j| values[j * dim + j] = 1.0);
        let (d, m) = (dim as f64, dim as f64 + 1.0);
        let wanted = log_unit_ball(dim) + 0.5 * d * d.ln() - 0.5 * m * m.ln();
        volume(&format!("simplex in dimension {dim}"), &values, dim, wanted);
        let found = exact("simplex", &values, dim, GAP);
        assert!(found.certificate.multipliers.iter().all(|u| (u - 1.0 / m).abs() < 1e-13));
        // Copies of vertices change nothing.
        let copies: Vec<f64> =
            values.iter().chain(&values).chain(&values[..dim]).copied().collect();
        volume(&format!("simplex in dimension {dim} with copies"), &copies, dim, wanted);
    }
}

#[test]
fn cubes_and_cross_polytopes_have_balls() {
    for dim in 1..=10 {
        let d = dim as f64;
        let vertex = |k: usize| (0..dim).map(move |j| if k >> j & 1 == 0 { -1.0 } else { 1.0 });
        let cube: Vec<f64> = (0..1 << dim).flat_map(vertex).collect();
        volume(&format!("{dim}-cube"), &cube, dim, log_unit_ball(dim) + 0.5 * d * d.ln());
        let mut cross = vec![0.0; 2 * dim * dim];
        for j in 0..dim {
            cross[2 * j * dim + j] = 1.0;
            cross[(2 * j + 1) * dim + j] = -1.0;
        }
        volume(&format!("{dim}-cross-polytope"), &cross, dim, log_unit_ball(dim));
    }
}

#[test]
fn polygons_have_circles_and_ellipses() {
    for corners in [3, 4, 5, 6, 7, 100, 100_001] {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64;
        let circle: Vec<f64> =
            (0..corners).flat_map(|k| [angle(k).cos(), angle(k).sin()]).collect();
        volume(&format!("{corners}-gon"), &circle, 2, std::f64::consts::PI.ln());
        let ellipse = mapped(&circle, &[3.0, 1.0, 0.0, 0.01], &[5.0, -7.0]);
        let wanted = std::f64::consts::PI.ln() + 0.03f64.ln();
        volume(&format!("stretched {corners}-gon"), &ellipse, 2, wanted);
    }
}

/// The optimal design of polynomial regression: on [−1, 1] the support on t ↦ (t, …, tᵈ) is the zeros of (1 − t²)·P′_d,
/// each with weight 1/(d + 1).
#[test]
fn the_moment_curve_touches_at_the_zeros_of_a_legendre_derivative() {
    for (dim, inner) in
        [(2, vec![0.0]), (3, vec![0.2f64.sqrt()]), (4, vec![0.0, (3.0f64 / 7.0).sqrt()])]
    {
        let mut zeros = vec![1.0, -1.0];
        inner.iter().for_each(|&t| zeros.extend(if t == 0.0 { vec![0.0] } else { vec![t, -t] }));
        let grid = (0..=2000).map(|k| f64::from(k) / 1000.0 - 1.0);
        let values: Vec<f64> = zeros
            .iter()
            .copied()
            .chain(grid)
            .flat_map(|t| (1..=dim).map(move |k| t.powi(k)))
            .collect();
        let found = exact("moment curve", &values, dim as usize, GAP);
        let m = zeros.len() as f64;
        let touching: f64 = (found.certificate.support.iter().zip(&found.certificate.multipliers))
            .filter(|(i, _)| **i < zeros.len() as u64)
            .map(|(_, u)| (u * m - 1.0).abs())
            .fold(0.0, f64::max);
        // The ends of the curve are also on the grid, so weights may be shared there.
        assert!(
            touching < 1e-5 || found.certificate.support.len() > zeros.len(),
            "{dim}: {touching:e}"
        );
        let lower: Vec<f64> =
            zeros.iter().flat_map(|t| (1..=dim).map(move |k| t.powi(k))).collect();
        let alone = exact("support of the moment curve", &lower, dim as usize, GAP);
        assert!((alone.answer.log_volume - found.answer.log_volume).abs() < 2e-12, "{dim}");
    }
}

#[test]
fn points_inside_a_known_ellipsoid_do_not_matter() {
    for dim in [2, 3, 7] {
        let d = dim as f64;
        let mut values: Vec<f64> = normal(3000, dim, 9).iter().map(|v| 0.1 * v / d).collect();
        for j in 0..dim {
            for sign in [-1.0, 1.0] {
                let start = values.len();
                values.resize(start + dim, 0.0);
                values[start + j] = sign;
            }
        }
        let turned = mapped(&values, &rotation(dim, 4), &vec![1e3; dim]);
        volume(
            &format!("turned cross in {dim} dimensions, filled"),
            &turned,
            dim,
            log_unit_ball(dim),
        );
    }
}

/// The optima of 30 real sets, where `TAUT_DATA` names the folder that holds `ellipsoid/`.
#[test]
fn real_sets_lie_in_their_reference_brackets() {
    let Some(folder) = std::env::var_os("TAUT_DATA").map(std::path::PathBuf::from) else {
        println!("skipped real_sets_lie_in_their_reference_brackets: TAUT_DATA is not set");
        return;
    };
    let folder = folder.join("ellipsoid");
    let Ok(text) = std::fs::read_to_string(folder.join("reference_optima.json")) else {
        println!(
            "skipped real_sets_lie_in_their_reference_brackets: TAUT_DATA holds no ellipsoids"
        );
        return;
    };
    // { "name": { "n": …, "log_volume_lower": …, … }, … }
    let number = |part: &str, key: &str| -> Option<f64> {
        let rest = part.split_once(&format!("\"{key}\":"))?.1;
        rest.trim_start().split([',', '\n', '}']).next()?.trim().parse().ok()
    };
    let mut tried = 0;
    for part in text.split("}") {
        let Some(name) = part.split('"').nth(1) else { continue };
        let (Some(lower), Some(upper)) =
            (number(part, "log_volume_lower"), number(part, "log_volume_upper"))
        else {
            continue;
        };
        let csv = std::fs::read_to_string(folder.join(name)).unwrap();
        let rows: Vec<Vec<f64>> = csv
            .lines()
            .filter_map(|line| line.split(',').map(|field| field.trim().parse().ok()).collect())
            .collect();
        let dim = rows[0].len();
        let found = exact(name, &rows.concat(), dim, GAP);
        let outside = (found.answer.log_volume - upper).max(lower - found.answer.log_volume);
        assert!(outside <= 1e-12, "{name}: {outside:e} outside the bracket");
        tried += 1;
    }
    assert_eq!(tried, 30);
}
