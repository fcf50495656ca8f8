//! Figures 2, 21 and 22: curves through noisy points.
//!
//! *What is redrawn.* The thesis shows three pictures and gives neither their points nor their number. Figure 2 is an example,
//! of figure 21 the reconstruction is called jagged (4.1.2), figure 22 is of points with sharp turns. Each is drawn here of points
//! of our own; 21 and 22 by the crude method that the thesis used for them, and beside it by the default.

use super::*;
use taut_certify::Curve;
use taut_draw::Figure;
use taut_reconstruct::curve;

/// One picture.
struct Picture {
    /// Number in the thesis, with a letter where there are several.
    number: &'static str,
    title: &'static str,
    points: Vec<f64>,
    method: CurveMethod,
}

/// A star of five corners, points uniform along its sides and shifted at will in a box of half-width `noise`.
fn star(n: usize, noise: f64) -> Result<Vec<f64>> {
    let corner = |k: usize| {
        let (sin, cos) = (std::f64::consts::PI * k as f64 / 5.0).sin_cos();
        let radius = if k.is_multiple_of(2) { 10.0 } else { 4.5 };
        [-radius * sin, radius * cos]
    };
    let lots: Vec<f64> = generate(Distribution::Uniform, n, 3, SEED)?;
    let point = |lot: &[f64]| {
        let place = 10.0 * lot[0];
        let (side, share) = (place as usize, place.fract());
        let (a, b) = (corner(side), corner((side + 1) % 10));
        let shift = |k: usize| noise * (2.0 * lot[1 + k] - 1.0);
        [0, 1].map(|k| a[k] + share * (b[k] - a[k]) + shift(k))
    };
    Ok(lots.chunks_exact(3).flat_map(point).collect())
}

fn pictures() -> Result<Vec<Picture>> {
    let noisy = |name: &str, n, delta| -> Result<Vec<f64>> {
        let truth = TestCurve::named(name).with_context(|| name.to_owned())?.build();
        let noise = CurveNoise { delta, ..CurveNoise::default() };
        Ok(sample_curve(&truth, n, &noise, SEED).points)
    };
    let (flower, sharp) = (noisy("flower5", 1200, 0.15)?, star(900, 0.25)?);
    let picture = |number, title, points: &[f64], method| Picture {
        number,
        title,
        points: points.to_vec(),
        method,
    };
    let (crude, default) =
        (CurveMethod::ThesisCrude(CurveThesisOptions::DEFAULT), CurveMethod::Auto);
    Ok(vec![
        picture("02", "curve reconstruction with noise", &noisy("multi4", 4000, 0.1)?, default),
        picture("21a", "the crude method: a jagged result", &flower, crude),
        picture("21b", "the same points, default method", &flower, default),
        picture("22a", "the crude method at sharp turns", &sharp, crude),
        picture("22b", "the same points, default method", &sharp, default),
    ])
}

/// Points below, curve above.
fn draw(picture: &Picture, found: &Curve) -> Figure {
    let dots = picture.points.chunks_exact(2).enumerate().map(|(row, p)| Point2 {
        id: Some(row as u64),
        at: [p[0], p[1]],
        size: 1.2,
        label: String::new(),
    });
    let of = |closed: bool| -> Vec<Vec<[f64; 2]>> {
        let curves = found.curves.iter().filter(|curve| curve.closed == closed);
        curves.map(|curve| curve.vertices.clone()).collect()
    };
    let layer = |name: &str, tone, line_style, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style,
        shape,
    };
    let mut layers =
        vec![layer("points", Tone::Point, LineStyle::Solid, Shape2::Points(dots.collect()))];
    for (closed, name) in [(true, "closed curve"), (false, "curve with ends")] {
        let chains = of(closed);
        if !chains.is_empty() {
            let shape = if closed { Shape2::Polygons(chains) } else { Shape2::Polylines(chains) };
            layers.push(layer(name, Tone::Answer, LineStyle::Solid, shape));
        }
    }
    let vertices: usize = found.curves.iter().map(|curve| curve.vertices.len()).sum();
    Figure::Plane(Scene2 {
        title: format!(
            "Figure {}, redrawn: {}",
            picture.number.trim_start_matches('0'),
            picture.title
        ),
        caption: format!(
            "{} points of our own, method {}: curves {}, vertices {vertices}, estimated noise \
                {:.3}, outliers {}.",
            picture.points.len() / 2,
            picture.method.name(),
            found.curves.len(),
            found.noise,
            found.outliers.len()
        ),
        x: Axis::default(),
        y: Axis::default(),
        aspect: Aspect::Equal,
        layers,
        width: 640.0,
        height: 560.0,
    })
}

/// Draws the pictures of one figure.
pub(super) fn write(plan: &Plan, figure: &str) -> Result<()> {
    for picture in pictures()?.iter().filter(|picture| picture.number.starts_with(figure)) {
        let options = CurveOptions { method: picture.method, ..CurveOptions::default() };
        let found = curve(&Points::new(&picture.points, 2)?, &options)?;
        let path = plan.out.join(format!("figure-{}.svg", picture.number));
        std::fs::write(&path, to_svg(&draw(picture, &found.answer), &Style::default()))?;
        println!("{}", path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_star_keeps_to_its_sides() {
        let points = star(500, 0.1).unwrap();
        assert!(points.chunks(2).all(|p| (2.0..10.2).contains(&p[0].hypot(p[1]))));
        let top = points.chunks(2).map(|p| p[1]).fold(f64::MIN, f64::max);
        assert!(top > 9.0, "{top}");
    }
}
