//! Figures as PNG, through their SVG.
//!
//! *Idea.* The renderer has no decoders of images, which are most of what such a renderer is built from: images of surfaces are
//! laid, pixel on pixel, between a document under them and one over them.
//! *Guarantee.* The same figure gives the same bytes on every machine: the only fonts are two faces of Inter that
//! are part of this crate (`assets/`, under the SIL Open Font License); no font of the system is read.
//! *Trap.* The faces hold Latin, Greek and mathematical signs; letters of other scripts show as empty boxes.

use std::sync::{Arc, OnceLock};

use resvg::usvg::{self, fontdb};

use crate::svg::{PlacedImage, layers};
use crate::{Error, Figure, Style};

/// Largest number of pixels of a picture: about 256 MiB while it is drawn.
const MAX_PIXELS: f64 = 67_108_864.0;

/// The figure as PNG, `scale` pixels to each unit of its width and height, 0.1 to 10.
///
/// # Errors
/// [`Error::Option`] for a scale out of range, [`Error::Png`] for a picture of more than 67 million pixels.
pub fn to_png(figure: &Figure, style: &Style, scale: f32) -> Result<Vec<u8>, Error> {
    if !(0.1..=10.0).contains(&scale) {
        return Err(Error::Option {
            name: "scale",
            value: format!("{scale:?}"),
            expected: "0.1 to 10",
        });
    }
    let wrong = |reason: String| Error::Png { reason };
    let options =
        usvg::Options { font_family: "Inter".into(), fontdb: fonts(), ..usvg::Options::default() };
    let layers = layers(figure, style, f64::from(scale));
    let tree =
        |document: &str| usvg::Tree::from_str(document, &options).map_err(|e| wrong(e.to_string()));
    let (under, over) = (tree(&layers.under)?, tree(&layers.over)?);
    let [width, height] = [under.size().width(), under.size().height()].map(|s| (s * scale).ceil());
    if f64::from(width) * f64::from(height) > MAX_PIXELS {
        return Err(wrong(format!(
            "{width} × {height} pixels are more than 67,108,864; ask for a smaller scale"
        )));
    }
    let mut pixels = tiny_skia::Pixmap::new(width as u32, height as u32)
        .ok_or_else(|| wrong(format!("{width} × {height} pixels cannot be held")))?;
    let zoom = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&under, zoom, &mut pixels.as_mut());
    for laid in &layers.images {
        lay(laid, zoom, &mut pixels).ok_or_else(|| wrong("an image has no pixels".into()))?;
    }
    resvg::render(&over, zoom, &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| wrong(e.to_string()))
}

fn lay(laid: &PlacedImage, zoom: tiny_skia::Transform, onto: &mut tiny_skia::Pixmap) -> Option<()> {
    let (width, height) = (laid.image.width, laid.image.height);
    let mut pixels = tiny_skia::Pixmap::new(width as u32, height as u32)?;
    for (pixel, &[r, g, b, a]) in pixels.pixels_mut().iter_mut().zip(&laid.image.pixels) {
        *pixel = tiny_skia::ColorU8::from_rgba(r, g, b, a).premultiply();
    }
    let [sx, sy] = [laid.size[0] / width as f64, laid.size[1] / height as f64];
    let place = tiny_skia::Transform::from_row(
        sx as f32,
        0.0,
        0.0,
        sy as f32,
        laid.at[0] as f32,
        laid.at[1] as f32,
    );
    let paint = tiny_skia::PixmapPaint {
        quality: tiny_skia::FilterQuality::Bilinear,
        ..tiny_skia::PixmapPaint::default()
    };
    onto.draw_pixmap(0, 0, pixels.as_ref(), &paint, place.post_concat(zoom), None);
    Some(())
}

fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    FONTS
        .get_or_init(|| {
            let mut fonts = fontdb::Database::new();
            fonts.load_font_data(include_bytes!("../assets/Inter-Regular.otf").to_vec());
            fonts.load_font_data(include_bytes!("../assets/Inter-SemiBold.otf").to_vec());
            // Whatever family a document asks for, this is the one there is.
            fonts.set_sans_serif_family("Inter");
            fonts.set_serif_family("Inter");
            fonts.set_monospace_family("Inter");
            Arc::new(fonts)
        })
        .clone()
}
