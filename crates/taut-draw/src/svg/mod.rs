//! Figures as SVG.
//!
//! *Idea.* Marks carry classes that name their meaning; colors come from a style sheet, inside the document where
//! it stands alone, of the page where it is part of one.
//! *Guarantee.* Every number written is finite; text from outside is escaped; the same figure gives the same bytes.
//! *Trap.* Marks that are not finite cannot be placed: they are left out, so check data before it comes here.

mod camera;
mod canvas;
mod frame;
mod opaque;
mod plane;
mod plot;
mod space;
mod stage;
mod trails;

use crate::axes::AxisMap;
use crate::{Figure, Style};
pub(crate) use camera::{EYE_DISTANCE, V3, add, cross, dot};
use canvas::Canvas;
#[cfg(feature = "png")]
pub(crate) use canvas::PlacedImage;
pub(crate) use frame::Chrome;
pub(crate) use space::{WIRED_SPHERES_MAX, enlargement, legend};
pub(crate) use stage::{Stage, finite, stage};

/// The figure as an SVG document: title, marks, legend and caption.
pub fn to_svg(figure: &Figure, style: &Style) -> String {
    draw(figure, Chrome::Full(style.theme)).document
}

/// A mark that answers to the pointer: its pixel, the number of its item, what is known of it.
#[derive(Clone, Debug)]
pub(crate) struct Hover {
    pub(crate) at: [f64; 2],
    pub(crate) id: Option<u64>,
    /// Coordinates, then what else there is to say.
    pub(crate) words: Vec<String>,
}

/// More points than this are dots of few paths in a page.
const DISCS_MAX: usize = 200;

/// Embedded images have this many pixels to each unit of a document: those of a fine screen.
const PIXELS_PER_UNIT: f64 = 2.0;

/// A figure as a document, and what a page does with it.
pub(crate) struct Drawn {
    pub(crate) document: String,
    /// The marks for the pointer.
    pub(crate) hovers: Vec<Hover>,
    /// The number of these after each layer that can be hidden.
    pub(crate) ends: Vec<usize>,
    /// From numbers to pixels, where both axes have such a map.
    pub(crate) map: Option<[AxisMap; 2]>,
}

pub(crate) fn draw(figure: &Figure, chrome: Chrome) -> Drawn {
    draw_at(figure, chrome, PIXELS_PER_UNIT)
}

/// A figure in the colors of a page, with images of one pixel to each unit.
pub(crate) fn draw_coarse(figure: &Figure) -> Drawn {
    draw_at(figure, Chrome::Bare, 1.0)
}

fn draw_at(figure: &Figure, chrome: Chrome, density: f64) -> Drawn {
    let mut canvas = Canvas::new(density, true);
    fill(figure, chrome, &mut canvas);
    let document = canvas.document(figure.title(), figure.caption(), chrome);
    Drawn { document, hovers: canvas.hovers, ends: canvas.ends, map: canvas.map }
}

/// A figure for a renderer that draws no images: a document, images to lay over it, and a document to lay over these.
#[cfg(feature = "png")]
pub(crate) struct Layers {
    pub(crate) under: String,
    pub(crate) images: Vec<PlacedImage>,
    pub(crate) over: String,
}

/// The figure with images of so many pixels to each unit.
#[cfg(feature = "png")]
pub(crate) fn layers(figure: &Figure, style: &Style, density: f64) -> Layers {
    let chrome = Chrome::Full(style.theme);
    let mut canvas = Canvas::new(density, false);
    fill(figure, chrome, &mut canvas);
    let images = std::mem::take(&mut canvas.images);
    let [under, over] = canvas.documents(chrome);
    Layers { under, images, over }
}

fn fill(figure: &Figure, chrome: Chrome, canvas: &mut Canvas) {
    canvas.titled = chrome != Chrome::Bare;
    match figure {
        Figure::Plane(scene) => plane::draw(scene, chrome, canvas),
        Figure::Space(scene) => space::draw(scene, chrome, canvas),
        Figure::Views(views) => space::draw_views(views, chrome, canvas),
        Figure::Plot(plot) => plot::draw(plot, chrome, canvas),
    }
}
