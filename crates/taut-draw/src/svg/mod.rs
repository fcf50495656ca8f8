//! Figures as SVG.
//!
//! *Idea.* Marks carry classes that name their meaning; colours come from a style sheet, inside the document where
//! it stands alone, of the page where it is part of one.
//! *Guarantee.* Every number written is finite; text from outside is escaped; the same figure gives the same bytes.
//! *Trap.* Marks that are not finite cannot be placed: they are left out, so check data before it comes here.

mod canvas;
mod frame;
mod plane;
mod plot;
mod space;

use crate::{Figure, Style};
use canvas::Canvas;
pub(crate) use frame::Chrome;
pub(crate) use space::{EYE, Stage, WIRED, finite, legend, stage};

/// The figure as an SVG document: title, marks, legend and caption.
pub fn to_svg(figure: &Figure, style: &Style) -> String {
    draw(figure, Chrome::Full(style.theme)).0
}

/// A mark that answers to the pointer: its pixel, the number of its item, what is known of it.
#[derive(Clone, Debug)]
pub(crate) struct Hover {
    pub(crate) at: [f64; 2],
    pub(crate) id: Option<u64>,
    /// Coordinates, then what else there is to say.
    pub(crate) words: Vec<String>,
}

/// The document, its width and height, and its marks for the pointer.
pub(crate) fn draw(figure: &Figure, chrome: Chrome) -> (String, [f64; 2], Vec<Hover>) {
    let mut canvas = Canvas::default();
    canvas.titled = chrome != Chrome::Bare;
    match figure {
        Figure::Plane(scene) => plane::draw(scene, chrome, &mut canvas),
        Figure::Space(scene) => space::draw(scene, chrome, &mut canvas),
        Figure::Plot(plot) => plot::draw(plot, chrome, &mut canvas),
    }
    let size = canvas.size;
    let hovers = std::mem::take(&mut canvas.hovers);
    (canvas.document(figure.title(), figure.caption(), chrome), size, hovers)
}
