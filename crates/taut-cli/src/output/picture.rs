//! A picture file of an answer: SVG, PNG or a page of HTML, by the extension.

use std::path::Path;

use anyhow::{anyhow, bail};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use taut_draw::{
    DrawOptions, Error as DrawError, Field, Figure, Page, Section, Style, Theme, to_html, to_svg,
};

use crate::input::reading::{Opened, wrong_option};
use crate::reports::{Report, Summary, worth_drawing};

/// The kinds of picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Picture {
    Svg,
    #[cfg(feature = "png")]
    Png,
    Html,
}

/// Options for the appearance of a picture.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Drawing")]
pub(crate) struct PictureOptions {
    /// Which picture to draw to SVG or PNG, from 1: the scene comes first, then plots
    #[arg(long, value_name = "N", default_value_t = 1)]
    figure: usize,
    /// Colors of SVG and PNG; HTML follows the reader
    #[arg(long, value_name = "NAME", default_value = "light", value_parser = themes())]
    theme: Theme,
    /// Width, pixels, from 240 to 10000
    #[arg(long = "image-width", alias = "width", value_name = "PX", default_value_t = DrawOptions::default().width)]
    width: f64,
    /// Height without the caption, pixels, from 180 to 10000
    #[arg(long = "image-height", alias = "height", value_name = "PX", default_value_t = DrawOptions::default().height)]
    height: f64,
    /// Pixels of a PNG for each pixel of width, from 0.1 to 10
    #[cfg(feature = "png")]
    #[arg(long = "image-scale", alias = "scale", value_name = "REAL", default_value_t = 2.0)]
    scale: f32,
    /// Most points drawn, at least 1; the support is always drawn
    #[arg(long, value_name = "N", default_value_t = DrawOptions::default().max_points)]
    max_points: usize,
}

impl Default for PictureOptions {
    fn default() -> Self {
        let DrawOptions { width, height, max_points, .. } = DrawOptions::default();
        PictureOptions {
            figure: 1,
            theme: Theme::Light,
            width,
            height,
            #[cfg(feature = "png")]
            scale: 2.0,
            max_points,
        }
    }
}

impl PictureOptions {
    /// Returns these options as the library takes them; `columns` are the names of the coordinates.
    pub(crate) fn options(&self, columns: Vec<String>) -> DrawOptions {
        let PictureOptions { max_points, width, height, .. } = *self;
        DrawOptions { max_points, width, height, columns, ..DrawOptions::default() }
    }
}

/// Pictures of an answer, and what stands beside them.
pub(crate) struct Drawing {
    pub(crate) title: String,
    /// The file of the points.
    pub(crate) heading: String,
    pub(crate) fields: Vec<Field>,
    pub(crate) figures: Vec<Figure>,
}

impl Drawing {
    /// The pictures of a report about these points, and what stands beside them.
    pub(crate) fn of<A: Summary>(
        report: &Report<'_, A>,
        points: &Opened,
        style: &PictureOptions,
    ) -> anyhow::Result<Self> {
        if let Some(why) = A::no_picture(report.found) {
            bail!(why)
        }
        let claims = |verdict| A::claims(report.found, verdict, report.points);
        let options = DrawOptions {
            proved_gap: report.verdict.as_ref().and_then(|verdict| claims(verdict).gap),
            ..style.options(points.names(A::dim(report)))
        };
        let figures = A::figures(report.found, report.points, &options)
            .map_err(|error| refused(error, points))?;
        Ok(Drawing {
            title: report.title(),
            heading: points.name().to_owned(),
            fields: report.fields().into_iter().map(Into::into).chain(notes(points)).collect(),
            figures,
        })
    }
}

/// What is known of how the points were read or made, with all its words.
pub(crate) fn notes(points: &Opened) -> impl Iterator<Item = Field> {
    points.notes().into_iter().map(|note| match note.remark {
        Some(remark) => Field::new(note.name, format!("{}; {remark}", note.value)),
        None => Field::new(note.name, note.value),
    })
}

fn themes() -> impl TypedValueParser<Value = Theme> {
    PossibleValuesParser::new(["light", "dark"]).map(|name| match name.as_str() {
        "dark" => Theme::Dark,
        _ => Theme::Light,
    })
}

impl Picture {
    /// The kind that the name of a file tells.
    pub(crate) fn of_path(path: &Path) -> anyhow::Result<Self> {
        let extension = path.extension().map(|e| e.to_ascii_lowercase());
        match extension.as_deref().and_then(|e| e.to_str()) {
            Some("svg") => Ok(Picture::Svg),
            Some("png") => png(),
            Some("html" | "htm") => Ok(Picture::Html),
            _ => bail!("{}: pictures are .svg, .png or .html; name one of these", path.display()),
        }
    }

    /// The bytes of the file.
    pub(crate) fn draw(
        self,
        drawing: Drawing,
        options: &PictureOptions,
    ) -> anyhow::Result<Vec<u8>> {
        let Drawing { title, heading, fields, mut figures } = drawing;
        let style = Style { theme: options.theme };
        if self == Picture::Html {
            let page = Page {
                title,
                intro: String::new(),
                sections: vec![Section {
                    heading,
                    text: String::new(),
                    command: command(),
                    fields,
                    figures: worth_drawing(figures),
                }],
                footer: format!("Drawn by taut {}.", env!("CARGO_PKG_VERSION")),
            };
            return Ok(to_html(&page).into_bytes());
        }
        let drawn = figures.len();
        if options.figure == 0 || options.figure > drawn {
            bail!("option `--figure` is {}: expected 1 to {drawn}", options.figure);
        }
        let figure = figures.swap_remove(options.figure - 1);
        match self {
            #[cfg(feature = "png")]
            Picture::Png => taut_draw::to_png(&figure, &style, options.scale).map_err(explain),
            _ => Ok(to_svg(&figure, &style).into_bytes()),
        }
    }
}

#[cfg(feature = "png")]
fn png() -> anyhow::Result<Picture> {
    Ok(Picture::Png)
}

#[cfg(not(feature = "png"))]
fn png() -> anyhow::Result<Picture> {
    bail!("this build of taut draws no PNG: draw SVG or HTML, or build it with the feature `png`")
}

pub(crate) fn refused(error: DrawError, points: &Opened) -> anyhow::Error {
    match error {
        DrawError::Read(error) => points.reading_failed(error),
        DrawError::Option { .. } => explain(error),
        other => anyhow!("{}: {other}", points.name()),
    }
}

fn explain(error: DrawError) -> anyhow::Error {
    match error {
        DrawError::Option { name, value, expected } => {
            let is_of_image = ["width", "height", "scale"].contains(&name);
            let name = if is_of_image { format!("image-{name}") } else { name.to_owned() };
            wrong_option(&name, &value, expected)
        }
        other => other.into(),
    }
}

/// The command that is running, as it would be typed.
fn command() -> String {
    let typed = std::env::args_os().skip(1).map(|word| {
        let word = word.to_string_lossy().into_owned();
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
        match word.chars().all(plain) && !word.is_empty() {
            true => word,
            false => format!("'{}'", word.replace('\'', r"'\''")),
        }
    });
    std::iter::once("taut".to_owned()).chain(typed).collect::<Vec<_>>().join(" ")
}
