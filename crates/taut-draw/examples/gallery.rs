//! Writes pictures of balls to a folder: `cargo run -p taut-draw --example gallery -- FOLDER`.

use std::error::Error;
use std::path::PathBuf;

use taut_draw::{
    DrawOptions, Field, Page, Section, Style, Theme, ball_figures, to_html, to_png, to_svg,
};
use taut_enclose::{BallOptions, ball};
use taut_points::{Distribution, Points, generate};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: gallery FOLDER")?);
    let clusters = Distribution::Clusters { count: 5, spread: 0.12 };
    let sets: Vec<(&str, Vec<f64>, usize, f64)> = vec![
        ("plane", generate(clusters, 800, 2, 1)?, 2, 1e-4),
        ("early", generate(Distribution::Uniform, 300, 2, 3)?, 2, 0.1),
        ("space", generate(Distribution::Normal, 2000, 3, 2)?, 3, 1e-4),
        ("ten", generate(Distribution::Normal, 3000, 10, 5)?, 10, 1e-4),
        ("line", generate(Distribution::Normal, 60, 1, 4)?, 1, 1e-4),
        ("many", generate(Distribution::Normal, 100_000, 2, 6)?, 2, 1e-2),
        ("far", far(), 2, 1e-3),
        ("one", vec![3.0, 4.0], 2, 1e-3),
    ];
    let mut page = Page {
        title: "Smallest balls".into(),
        intro: "Each ball below encloses its points, and each comes with a certificate.".into(),
        footer: "Written by the gallery of taut-draw.".into(),
        ..Page::default()
    };
    for (name, values, dim, epsilon) in &sets {
        let points = Points::new(values, *dim)?;
        let options = BallOptions { epsilon: *epsilon, max_passes: 20_000, ..Default::default() };
        let found = ball(&points, &options)?;
        let figures = ball_figures(&found, &points, &DrawOptions::default())?;
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
                "taut ball {name}.csv -o {name}.json && taut verify {name}.json {name}.csv"
            ),
            fields: vec![
                Field::new("radius", found.answer.radius),
                Field::new("relative gap, proved", format!("{:.1e}", found.certificate.gap)),
                Field::new("support", format!("{} points", found.certificate.support.len())),
                Field::new("passes over all points", found.trace.passes),
            ],
            figures,
        });
    }
    std::fs::write(folder.join("gallery.html"), to_html(&page))?;
    Ok(())
}

/// Points close together, far from the origin.
fn far() -> Vec<f64> {
    (0..40)
        .flat_map(|i| {
            let (s, c) = (f64::from(i) * 2.4).sin_cos();
            let r = (f64::from(i) / 40.0).sqrt() * 2e-4;
            [1e6 + r * c, -3e6 + r * s]
        })
        .collect()
}
