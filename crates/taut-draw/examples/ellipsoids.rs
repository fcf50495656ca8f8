//! Writes pictures of ellipsoids to a folder: `cargo run -p taut-draw --example ellipsoids -- FOLDER`.

use std::error::Error;
use std::path::PathBuf;

use taut_draw::{
    DrawOptions, Field, Page, Section, Style, Theme, ellipsoid_figures, to_html, to_png, to_svg,
};
use taut_enclose::{EllipsoidOptions, ellipsoid};
use taut_points::{Distribution, Points, generate};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: ellipsoids FOLDER")?);
    let clusters = Distribution::Clusters { count: 5, spread: 0.12 };
    let sets: Vec<(&str, Vec<f64>, usize, f64)> = vec![
        ("plane", sheared(generate(clusters, 800, 2, 1)?, 2), 2, 1e-9),
        ("early", generate(Distribution::Uniform, 300, 2, 3)?, 2, 0.5),
        ("space", sheared(generate(Distribution::Normal, 2000, 3, 2)?, 3), 3, 1e-9),
        ("five", sheared(generate(Distribution::Normal, 3000, 5, 5)?, 5), 5, 1e-9),
        ("twenty", sheared(generate(Distribution::Uniform, 2000, 20, 5)?, 20), 20, 1e-9),
        ("line", generate(Distribution::Normal, 60, 1, 4)?, 1, 1e-9),
        ("flat", flat(generate(Distribution::Normal, 300, 2, 6)?), 3, 1e-9),
        ("one", vec![3.0, 4.0], 2, 1e-9),
    ];
    let mut page = Page {
        title: "Smallest ellipsoids".into(),
        intro: "Each ellipsoid below encloses its points, and each comes with a certificate."
            .into(),
        footer: "Written by an example of taut-draw.".into(),
        ..Page::default()
    };
    for (name, values, dim, epsilon) in &sets {
        let points = Points::new(values, *dim)?;
        let options = EllipsoidOptions { epsilon: *epsilon, ..Default::default() };
        let found = ellipsoid(&points, &options)?;
        found.check(&points)?;
        let figures = ellipsoid_figures(&found, &points, &DrawOptions::default())?;
        for (i, figure) in figures.iter().enumerate() {
            for (theme, word) in [(Theme::Light, ""), (Theme::Dark, "-dark")] {
                let style = Style { theme };
                let stem = folder.join(format!("{name}-{i}{word}"));
                std::fs::write(stem.with_extension("svg"), to_svg(figure, &style))?;
                std::fs::write(stem.with_extension("png"), to_png(figure, &style, 1.5)?)?;
            }
        }
        page.sections.push(Section {
            heading: format!("The set “{name}”"),
            text: "The points are generated from a seed.".into(),
            command: format!(
                "taut ellipsoid {name}.csv -o {name}.json && taut verify {name}.json {name}.csv"
            ),
            fields: vec![
                Field::new("log-volume", found.answer.log_volume),
                Field::new("gap, proved", format!("{:.1e}", found.certificate.gap)),
                Field::new("support", format!("{} points", found.certificate.support.len())),
                Field::new("passes over all points", found.trace.passes),
            ],
            figures,
        });
    }
    std::fs::write(folder.join("ellipsoids.html"), to_html(&page))?;
    Ok(())
}

/// Each coordinate takes a part of the one before it, so that the ellipsoid is tilted.
fn sheared(mut values: Vec<f64>, dim: usize) -> Vec<f64> {
    for row in values.chunks_exact_mut(dim) {
        for j in 1..dim {
            row[j] = 0.5 * row[j] + 0.8 * row[j - 1];
        }
    }
    values
}

/// A plane through space.
fn flat(values: Vec<f64>) -> Vec<f64> {
    values.chunks_exact(2).flat_map(|p| [p[0], p[1], 2.0 * p[0] - p[1]]).collect()
}
