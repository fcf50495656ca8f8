//! One figure: its curves as a table, as CSV and as SVG.

use super::*;

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
    number: u32,
    /// A letter where one figure of the thesis became several; may be empty.
    part: &'static str,
    /// What is plotted, over what, of what input.
    title: String,
    /// Name of the horizontal quantity.
    x: &'static str,
    /// Name of the vertical quantity.
    y: &'static str,
    /// Unit of the vertical quantity; may be empty.
    unit: &'static str,
    /// Scale of the vertical axis.
    scale: Scale,
    /// Its curves.
    pub(super) curves: Vec<Curve>,
    /// What the thesis says of it, what was left out, where curves stop early.
    pub(super) notes: Vec<String>,
}

impl Figure {
    /// A figure of times.
    pub(super) fn of_times(number: u32, title: impl Into<String>, x: &'static str) -> Self {
        Figure::new(number, title.into(), x, ["time", "s"], Scale::Log)
    }

    /// A figure of core-set sizes.
    pub(super) fn of_sizes(number: u32, title: impl Into<String>, x: &'static str) -> Self {
        Figure::new(number, title.into(), x, ["points", ""], Scale::Linear)
    }

    /// A figure of shares.
    pub(super) fn of_shares(number: u32, title: impl Into<String>, x: &'static str) -> Self {
        Figure::new(number, title.into(), x, ["share", "%"], Scale::Linear)
    }

    /// A figure of numbers of errors.
    pub(super) fn of_counts(number: u32, title: impl Into<String>, x: &'static str) -> Self {
        Figure::new(number, title.into(), x, ["misclassified", ""], Scale::Linear)
    }

    fn new(
        number: u32,
        title: String,
        x: &'static str,
        [y, unit]: [&'static str; 2],
        scale: Scale,
    ) -> Self {
        Figure { number, part: "", title, x, y, unit, scale, curves: vec![], notes: vec![] }
    }

    /// The same as one part of what the thesis has in one figure.
    pub(super) fn part(self, part: &'static str) -> Self {
        Figure { part, ..self }
    }

    /// Adds a note.
    pub(super) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Prints the figure and writes it.
    pub(super) fn show(&self, plan: &Plan) -> Result<()> {
        self.print();
        self.write(&plan.out)
    }

    /// Prints the values as a table, a row for each x.
    fn print(&self) {
        let names: String = self.curves.iter().map(|curve| format!(" | {}", curve.name)).collect();
        let mut table = Table::new(&format!("{}{names}", self.x));
        let mut all: Vec<f64> = self.curves.iter().flat_map(|c| &c.points).map(|p| p[0]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        for x in all {
            let at = |curve: &Curve| curve.points.iter().find(|p| p[0] == x).map(|p| number(p[1]));
            let cells = self.curves.iter().map(|curve| at(curve).unwrap_or_default());
            table.push([number(x)].into_iter().chain(cells).collect::<Vec<String>>());
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
    fn write(&self, folder: &Path) -> Result<()> {
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
        // More curves than tones come round again in another style.
        const STYLES: [SeriesStyle; 3] =
            [SeriesStyle::LineAndDots, SeriesStyle::Dashed, SeriesStyle::Line];
        let series = self.curves.iter().enumerate().map(|(at, curve)| Series {
            name: curve.name.clone(),
            tone: TONES[at % TONES.len()],
            style: STYLES[at / TONES.len() % STYLES.len()],
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
        let mut figure =
            Figure::of_sizes(8, "core-set size", "dimension").note("The thesis: 30–170.");
        let points = vec![[2.0, 3.0], [3.0, 4.0]];
        figure.curves.push(Curve { name: "n = 10⁴".into(), points });
        let folder = tempfile::tempdir().unwrap();
        figure.write(folder.path()).unwrap();
        let csv = std::fs::read_to_string(folder.path().join("figure-08.csv")).unwrap();
        assert_eq!(csv, "series,x,y\n\"n = 10⁴\",2,3\n\"n = 10⁴\",3,4\n");
        let svg = std::fs::read_to_string(folder.path().join("figure-08.svg")).unwrap();
        assert!(svg.starts_with("<svg"), "{svg}");
    }
}
