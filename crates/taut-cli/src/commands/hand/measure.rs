//! `taut hand measure`.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use serde_json::json;
use taut::recognize::hand::circle::Circle;
use taut::recognize::hand::{
    FEATURE_NAMES, Gate, Hand, HandError, HandOptions, ImageError, Side, Threshold, profile_names,
};
use taut_draw::{
    Aspect, Axis, Circle2, Field, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone,
};

use crate::exit::Outcome;
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing::{self, Outputs};

/// Measure the hand in an image: the thirty features of the thesis, and the width profile.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The hand lies flat with spread fingers on a background that is less yellow than skin, such as the white of a scanner. \
What cannot be measured reliably is refused with the reason: a hand that is cut off, fingers that touch, a ring or a \
bandage. Lengths are in mm, areas in mm².
Exit: 0 measured · 2 bad input or usage, or an image that gives no reliable features;
        nothing written
Example: taut hand measure scan.png -o hand.json --draw hand.svg")]
pub(super) struct Args {
    /// The image, in PNG, JPEG or TIFF
    #[arg(value_name = "IMAGE")]
    path: PathBuf,
    /// Dots per inch, 20 to 2400 [default: that of the file]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    dpi: Option<f64>,
    /// The b* of CIELAB above which a pixel is skin [default: from the image]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    threshold: Option<f64>,
    /// Return features that may be wrong, with the reasons
    #[arg(long)]
    no_gate: bool,
    /// Write the features as JSON; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Draw the outline with tips, valleys and circles, as .svg, .png or .html
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let files: Vec<_> = self.out.iter().chain(&self.draw).map(PathBuf::as_path).collect();
        writing::check_writable(&files, &[&self.path])?;
        if let Some(out) = &self.out {
            writing::check_json(out, "-o")?;
        }
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        let hand = Hand::from_file(&self.path, &self.options())
            .map_err(|error| explain(&self.path, error))?;
        let mut outputs = Outputs::default();
        if let Some(out) = &self.out {
            outputs.add(out, (json_of(&hand) + "\n").as_bytes())?;
        }
        if let (Some(path), Some(picture)) = (&self.draw, picture) {
            let drawing = Drawing {
                title: title(&hand),
                heading: self.path.display().to_string(),
                fields: fields(&hand),
                figures: vec![figure(&hand)],
            };
            outputs.add(path, &picture.draw(drawing, &PictureOptions::default())?)?;
        }
        let to_terminal = !self.out.as_deref().is_some_and(writing::is_stream);
        if to_terminal {
            outputs.print(&summary(&hand));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    fn options(&self) -> HandOptions {
        HandOptions {
            dots_per_inch: self.dpi,
            threshold: self.threshold.map_or(Threshold::Adaptive, Threshold::Fixed),
            gate: if self.no_gate { Gate::Report } else { Gate::Refuse },
            ..HandOptions::default()
        }
    }
}

/// The error with the file, and options by their names on the command line.
pub(super) fn explain(path: &Path, error: HandError) -> anyhow::Error {
    let name = path.display();
    match error {
        HandError::Image(ImageError::Io { error, .. }) => anyhow!("{name}: {error}"),
        HandError::Option { name: "dots_per_inch", value, expected } => {
            anyhow!("option `--dpi` is {value}: expected {expected}")
        }
        HandError::Option { name, value, expected } => {
            anyhow!("option `--{name}` is {value}: expected {expected}")
        }
        error => anyhow!("{name}: {}", error.to_string().replace("`dots_per_inch`", "`--dpi`")),
    }
}

fn side(hand: &Hand) -> &'static str {
    match hand.side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

fn title(hand: &Hand) -> String {
    format!("A {} hand at {:.0} dots per inch", side(hand), hand.dots_per_inch)
}

fn fields(hand: &Hand) -> Vec<Field> {
    let feature = |(name, value): (&&str, &f64)| {
        let unit = if name.ends_with("area") { "mm²" } else { "mm" };
        Field::new(*name, format!("{value:.2} {unit}"))
    };
    FEATURE_NAMES.iter().zip(&hand.features).map(feature).collect()
}

fn summary(hand: &Hand) -> String {
    let mut text = title(hand) + "\n";
    for (name, value) in FEATURE_NAMES.iter().zip(&hand.features) {
        text += &format!("  {name:<20} {value:.2}\n");
    }
    for concern in &hand.concerns {
        text += &format!("  may be wrong: {concern}\n");
    }
    text
}

fn json_of(hand: &Hand) -> String {
    let named =
        |names: Vec<String>, values: &[f64]| -> serde_json::Map<String, serde_json::Value> {
            names.into_iter().zip(values.iter().map(|&value| json!(value))).collect()
        };
    let concerns: Vec<String> = hand.concerns.iter().map(ToString::to_string).collect();
    let features = named(FEATURE_NAMES.map(str::to_owned).to_vec(), &hand.features);
    let value = json!({
        "side": side(hand),
        "dots_per_inch": hand.dots_per_inch,
        "threshold": hand.threshold,
        "features": features,
        "profile": named(profile_names(), &hand.profile),
        "tips": hand.landmarks.tip_points(),
        "valleys": hand.landmarks.valley_points(),
        "concerns": concerns,
    });
    value.to_string()
}

/// The outline with what was found on it, as in figure 54 of the thesis; y grows upward in pictures, and downward in images.
pub(crate) fn figure(hand: &Hand) -> Figure {
    let up = |p: [f64; 2]| [p[0], -p[1]];
    let points = |list: &[[f64; 2]]| {
        let point = |&p: &[f64; 2]| Point2 { id: None, at: up(p), size: 3.0, label: String::new() };
        Shape2::Points(list.iter().map(point).collect())
    };
    let circle =
        |circle: &Circle| Circle2 { id: None, center: up(circle.center), radius: circle.radius };
    let outline: Vec<[f64; 2]> = hand.landmarks.outline.points().iter().map(|&p| up(p)).collect();
    let layer = |name: &str, tone, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style: LineStyle::Solid,
        shape,
    };
    Figure::Plane(Scene2 {
        title: title(hand),
        caption: "The outline, the largest circles in the fingers and in the hand, five tips and four valleys.".to_owned(),
        x: Axis::default(),
        y: Axis::default(),
        aspect: Aspect::Equal,
        layers: vec![
            layer("outline", Tone::Point, Shape2::Polygons(vec![outline])),
            layer("circles", Tone::Answer, Shape2::Circles(hand.circles.iter().map(circle).collect())),
            layer("tips", Tone::Support, points(&hand.landmarks.tip_points())),
            layer("valleys", Tone::Support, points(&hand.landmarks.valley_points())),
        ],
        width: 560.0,
        height: 720.0,
    })
}
