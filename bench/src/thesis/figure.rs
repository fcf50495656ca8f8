//! One figure: its curves as a table, as CSV and as SVG.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Result;
use taut_draw::{Axis, Figure as Drawing, Plot, Scale, Series, SeriesStyle, Style, Tone, to_svg};

use crate::table::Table;

/// A curve: values of y by x.
pub(super) struct Curve {
    /// What it is of.
    pub(super) name: String,
    /// (x, y), ascending in x.
    pub(super) points: Vec<[f64; 2]>,
}

/// A figure of the thesis, rerun.
pub(super) struct Figure {
    /// Its number in the thesis.
    pub(super) number: u32,
    /// A letter where one figure of the thesis became several; may be empty.
    pub(super) part: &'static str,
    /// What is plotted, over what, of what input.
    pub(super) title: String,
    /// Name of the horizontal quantity.
    pub(super) x: &'static str,
    /// Name of the vertical quantity.
    pub(super) y: &'static str,
    /// Unit of the vertical quantity; may be empty.
    pub(super) unit: &'static str,
    /// Scale of the vertical axis.
    pub(super) scale: Scale,
    /// Its curves.
    pub(super) curves: Vec<Curve>,
    /// What the thesis says of it, what was left out, where curves stop early.
    pub(super) notes: Vec<String>,
}

impl Figure {
    /// Prints the values as a table, a row for each x.
    pub(super) fn print(&self) {
        let mut head = vec![self.x];
        head.extend(self.curves.iter().map(|curve| curve.name.as_str()));
        let mut table = Table::new(&head);
        let mut all: Vec<f64> = self.curves.iter().flat_map(|c| &c.points).map(|p| p[0]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        for x in all {
            let mut row = vec![number(x)];
            row.extend(self.curves.iter().map(|curve| {
                curve.points.iter().find(|p| p[0] == x).map_or(String::new(), |p| number(p[1]))
            }));
            table.push(row);
        }
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        println!(
            "## Figure {}{}: {}\n{}{unit}\n\n{table}",
            self.number, self.part, self.title, self.y
        );
        for note in &self.notes {
            println!("- {note}");
        }
        println!();
    }

    /// Writes `figure-NN.csv` and `figure-NN.svg`, with the part behind the number, to `folder`.
    pub(super) fn write(&self, folder: &Path) -> Result<()> {
        let mut csv = String::from("series,x,y\n");
        for curve in &self.curves {
            for [x, y] in &curve.points {
                writeln!(csv, "\"{}\",{x},{y}", curve.name)?;
            }
        }
        let path = folder.join(format!("figure-{:02}{}", self.number, self.part));
        std::fs::write(path.with_extension("csv"), csv)?;
        let drawing = Drawing::Plot(self.plot());
        Ok(std::fs::write(path.with_extension("svg"), to_svg(&drawing, &Style::default()))?)
    }

    fn plot(&self) -> Plot {
        const TONES: [Tone; 6] =
            [Tone::Answer, Tone::Second, Tone::Third, Tone::Fourth, Tone::Bound, Tone::Support];
        // More curves than tones come round again with another look.
        const LOOKS: [SeriesStyle; 3] =
            [SeriesStyle::LineAndDots, SeriesStyle::Dashed, SeriesStyle::Line];
        let series = self.curves.iter().enumerate().map(|(at, curve)| Series {
            name: curve.name.clone(),
            tone: TONES[at % TONES.len()],
            style: LOOKS[at / TONES.len() % LOOKS.len()],
            points: curve.points.clone(),
        });
        Plot {
            title: format!("Figure {}{}, rerun: {}", self.number, self.part, self.title),
            caption: self.notes.join(" "),
            x: Axis::named(self.x),
            y: Axis { name: self.y.to_owned(), unit: self.unit.to_owned() },
            x_scale: Scale::Linear,
            y_scale: self.scale,
            series: series.collect(),
            bars: Vec::new(),
            levels: Vec::new(),
            width: 720.0,
            height: 440.0,
        }
    }
}

fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value}")
    } else if value.abs() >= 0.1 {
        format!("{value:.3}")
    } else {
        format!("{value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_written_as_values_and_as_picture() {
        let figure = Figure {
            number: 8,
            part: "",
            title: "core-set size".into(),
            x: "dimension",
            y: "points",
            unit: "",
            scale: Scale::Linear,
            curves: vec![Curve { name: "n = 10⁴".into(), points: vec![[2.0, 3.0], [3.0, 4.0]] }],
            notes: vec!["The thesis: 30–170.".into()],
        };
        let folder = tempfile::tempdir().unwrap();
        figure.write(folder.path()).unwrap();
        let csv = std::fs::read_to_string(folder.path().join("figure-08.csv")).unwrap();
        assert_eq!(csv, "series,x,y\n\"n = 10⁴\",2,3\n\"n = 10⁴\",3,4\n");
        let svg = std::fs::read_to_string(folder.path().join("figure-08.svg")).unwrap();
        assert!(svg.starts_with("<svg"), "{svg}");
    }
}
