//! How the error of the default method falls with the number of points.

use super::*;

const SIZES: [usize; 5] = [1000, 4000, 16_000, 64_000, 250_000];

/// Errors over sizes, and at 10⁴ points.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let pool = context.pool()?;
    let options = CurveOptions::default();
    let sizes = context.size(&SIZES[..], &SIZES[..3]);
    let mut table = Table::new(
        "curve | noise | n | rms:ee | largest:ee | right | noise told:ee | median time of a draw:s",
    );
    let mut add = |name, truth: &_, n, noise: &CurveNoise| -> Result<f64> {
        let seeds = context.seeds.clone();
        let trials = Trials::run(Some(&pool), (name, truth), n, noise, &options, seeds)?;
        let law = if noise.gaussian { "normal" } else { "uniform" };
        let mut row = trials.row();
        row["noise"] = format!("{law} {}", noise.delta).into();
        table.push(row);
        Ok(trials.rms())
    };
    let normal = CurveNoise { delta: 0.03, gaussian: true, ..NOISE };
    for (name, noise) in
        [("circle", NOISE), ("bumpy", NOISE), ("circle", normal), ("bumpy", normal)]
    {
        // So many points that chords between them stray by far less than any error that is measured.
        let truth = truth(name, 40_000)?;
        let mut points = vec![];
        for &n in sizes {
            points.push([(n as f64).ln(), add(name, &truth, n, &noise)?.ln()]);
        }
        let (law, bounds) = match noise.gaussian {
            true => (", normal noise", aim_only(-0.38)),
            false => ("", [-0.5, -0.62].into()),
        };
        let what = format!("{name}{law}: slope of ln rms over ln n");
        out.at_most(what, slope(&points), bounds, Unit::Fixed(2));
    }
    for (name, bounds) in [
        ("circle", [1e-3, 5e-4].into()),
        // Hoped for alone.
        ("ellipse3", aim_only(1.5e-3)),
        ("flower5", [6e-3, 3.5e-3].into()),
        ("bumpy", aim_only(6e-3)),
    ] {
        let rms = add(name, &truth(name, TestCurve::VERTICES)?, 10_000, &NOISE)?;
        out.at_most(format!("{name}, n = 10⁴: rms"), rms, bounds, Unit::Error);
    }
    out.table("", table);
    Ok(())
}

/// Slope of the line that fits best, in the sense of least squares.
pub(super) fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let cross: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    cross / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_power_law_has_its_exponent_as_slope() {
        let points: Vec<[f64; 2]> =
            [1e3f64, 4e3, 1.6e4].iter().map(|n| [n.ln(), (3.0 * n.powf(-0.6)).ln()]).collect();
        assert!((super::slope(&points) + 0.6).abs() < 1e-12);
    }
}
