//! Pictures of space: layers of marks in data coordinates, and the view of them.

use crate::{Axis, DrawOptions, LineStyle, Tone};

/// A picture in space, in data coordinates: layers of marks and a view.
///
/// In HTML the view is where turning starts; in SVG and PNG it is all there is.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene3 {
    /// The subject of the picture.
    pub title: String,
    /// A description in sentences, with every count named.
    pub caption: String,
    /// The three axes.
    pub axes: [Axis; 3],
    /// The marks.
    pub layers: Vec<Layer3>,
    /// The way in which space is shown on the plane.
    pub projection: Projection,
    /// Turn of the view around the third axis, degrees.
    pub azimuth: f64,
    /// Height of the eye above the plane of the first two axes, degrees, −90 to 90.
    pub elevation: f64,
    /// Width of the picture, pixels.
    pub width: f64,
    /// Height of the picture without caption, pixels.
    pub height: f64,
}

impl Scene3 {
    /// Layers seen in perspective from a little above.
    pub(crate) fn space(
        title: String,
        caption: String,
        layers: Vec<Layer3>,
        options: &DrawOptions,
    ) -> Self {
        Scene3 {
            title,
            caption,
            axes: [0, 1, 2].map(|k| options.axis(k, 3)),
            layers,
            projection: Projection::Perspective,
            azimuth: 35.0,
            elevation: 22.0,
            width: options.width,
            height: options.height,
        }
    }
}

/// The way in which space is shown on the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Far objects are smaller.
    #[default]
    Perspective,
    /// Parallel lines stay parallel.
    Orthographic,
}

/// Marks of one meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer3 {
    /// The entry in the legend; an empty name makes none.
    pub name: String,
    /// The role of the marks.
    pub tone: Tone,
    /// The way in which lines and areas are drawn; points ignore it.
    pub line_style: LineStyle,
    /// The marks.
    pub shape: Shape3,
}

/// The marks a layer can have; all coordinates are data coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape3 {
    /// Discs of a size in pixels, smaller the farther they are.
    Points(Vec<Point3>),
    /// Crosses of a fixed size in pixels.
    Crosses(Vec<[f64; 3]>),
    /// Spheres, as an outline with circles of latitude and longitude.
    Spheres(Vec<Sphere3>),
    /// Open chains of segments.
    Polylines(Vec<Vec<[f64; 3]>>),
    /// A translucent surface of triangles.
    Mesh(Mesh3),
    /// An opaque surface of triangles: what is behind it is hidden, or pale where it is a line or a point.
    Surface(Surface3),
}

/// A point as a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Point3 {
    /// Its number in the input, from 0, shown on hovering.
    pub id: Option<u64>,
    /// Where it is.
    pub at: [f64; 3],
    /// Radius of the disc, pixels.
    pub size: f64,
    /// Further text on hovering; may be empty.
    pub label: String,
}

/// A sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere3 {
    /// Its number in the input, from 0, shown on hovering.
    pub id: Option<u64>,
    /// Its center.
    pub center: [f64; 3],
    /// Its radius, at least 0, in data units.
    pub radius: f64,
}

/// A surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh3 {
    /// The corners.
    pub vertices: Vec<[f64; 3]>,
    /// Three corners each, counter-clockwise from outside. A triangle that names a missing corner is not drawn.
    pub triangles: Vec<[usize; 3]>,
}

/// An opaque surface of triangles with two sides of different tints; the tone of the layer is that of the front.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface3 {
    /// The corners.
    pub vertices: Vec<[f64; 3]>,
    /// Three corners each, counter-clockwise from the front. A triangle that names a missing corner, or one that is not finite, is
    /// not drawn.
    pub triangles: Vec<[u32; 3]>,
    /// The tone of the side from which triangles run clockwise.
    pub back: Tone,
    /// The way in which light falls on it.
    pub shading: Shading,
}

/// The way in which light falls on a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shading {
    /// Each triangle has one shade, so that triangles can be told apart. In SVG few of them are polygons.
    #[default]
    Flat,
    /// Shades flow over edges, except over sharp ones. In SVG the surface is an image.
    Smooth,
}

/// One scene seen from several fixed directions, panel by panel; azimuth and elevation of the scene itself are not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Views {
    /// The visible scene; its width and height are those of all panels together.
    pub scene: Scene3,
    /// From where, in reading order.
    pub views: Vec<View>,
}

/// A direction from which a scene is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The name, which stands above the panel.
    pub name: String,
    /// Turn of the view around the third axis, degrees.
    pub azimuth: f64,
    /// Height of the eye above the plane of the first two axes, degrees, −90 to 90.
    pub elevation: f64,
}
