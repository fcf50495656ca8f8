//! Figures of surfaces through points of space.
//!
//! *Idea.* One scene to turn by hand and one sheet of fixed views hold the same: the surface with a tint for either side, its
//! boundary in an accent color, edges of more than two triangles, and the points that no triangle uses. A triangle that is turned
//! over, and what is seen through a hole, show the tint of the back.
//! *Guarantee.* Every triangle is drawn, whatever their number. Of unused points at most [`DrawOptions::max_points`] are, an even
//! sample, and the caption says so.
//! *Trap.* A page with a scene to turn holds all its triangles, 24 bytes each: beyond a million there are fixed views only, and the
//! caption says that too.

mod answer;
mod edges;

use taut_points::{Blocks, PointSource, Scratch};

use self::edges::Edges;
use crate::item_pass::spread;
use crate::marks::{agree, dot_size};
use crate::number::{count, counted};
use crate::{
    DrawOptions, Error, Figure, Layer3, LineStyle, Point3, Projection, Scene3, Shading, Shape3,
    Surface3, Tone, View, Views,
};
pub use answer::surface_figures;

/// A scene of at most this many triangles can be turned by hand.
const TURNED_TRIANGLES_MAX: usize = 1_000_000;

/// Up to this many triangles each has its own shade, so that it can be told from the next.
const FLAT_TRIANGLES_MAX: usize = 4000;

/// A surface and its points, as they are to be drawn; what found it does not matter.
#[derive(Clone, Copy)]
pub struct SurfaceView<'a> {
    /// The points, three coordinates each.
    pub points: &'a dyn PointSource,
    /// The place of each point where the surface has moved them; empty where it has not.
    pub moved: &'a [[f64; 3]],
    /// Three rows of points each, counter-clockwise from the front.
    pub triangles: &'a [[u32; 3]],
    /// Rows that are on no triangle, in groups with names, such as "outliers"; each is marked where it was before it was moved.
    pub unused: &'a [UnusedPoints<'a>],
    /// Sentences to add to what the caption says; may be empty.
    pub remarks: &'a str,
}

/// Points that are on no triangle, for one reason.
#[derive(Clone, Copy, Debug)]
pub struct UnusedPoints<'a> {
    /// Their name in legend and caption, in the plural.
    pub name: &'a str,
    /// Their rows.
    pub rows: &'a [u32],
}

/// Pictures of a surface: a scene to be turned by hand, unless it has more than a million triangles, and a sheet with the views
/// from the front, the side, the top and from between them.
///
/// ```
/// use taut_draw::{DrawOptions, Figure, SurfaceView, surface_scene};
///
/// let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
/// let view = SurfaceView {
///     points: &taut_points::Points::new(&corners, 3)?,
///     moved: &[],
///     triangles: &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
///     unused: &[],
///     remarks: "",
/// };
/// let figures = surface_scene(&view, &DrawOptions::default())?;
/// assert!(matches!(figures[..], [Figure::Space(_), Figure::Views(_)]));
/// assert_eq!(figures[0].caption(), "4 triangles with 4 vertices; no boundary.");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Mismatch`] when points have not three coordinates, when places are not as many as points, or when a row is not there;
/// [`Error::NonFinite`], [`Error::Option`], [`Error::Read`].
pub fn surface_scene(view: &SurfaceView<'_>, options: &DrawOptions) -> Result<Vec<Figure>, Error> {
    options.check()?;
    check(view)?;
    let places = places(view.points)?;
    if let Some((row, column)) = first_not_finite(view.moved) {
        let what = format!("coordinate {column} of the place of point {row}");
        return Err(Error::NonFinite { what, value: view.moved[row][column] });
    }
    let picture = Picture { view, options, places };
    let mut scene = picture.scene();
    let views = Figure::Views(Views { scene: picture.still(&scene), views: directions(options) });
    if view.triangles.len() > TURNED_TRIANGLES_MAX {
        return Ok(vec![views]);
    }
    scene.projection = Projection::Perspective;
    Ok(vec![Figure::Space(scene), views])
}

/// Checks what a surface and its points must agree in before anything is drawn.
fn check(view: &SurfaceView<'_>) -> Result<(), Error> {
    agree("number of coordinates", 3, view.points.dim())?;
    let n = view.points.len();
    if !view.moved.is_empty() && view.moved.len() as u64 != n {
        let expected = view.moved.len() as u64;
        return Err(Error::Mismatch { what: "number of points", expected, found: n });
    }
    let unused = view.unused.iter().flat_map(|group| group.rows);
    match view.triangles.as_flattened().iter().chain(unused).max() {
        Some(&row) if u64::from(row) >= n => Err(Error::Mismatch {
            what: "number of points",
            expected: u64::from(row) + 1,
            found: n,
        }),
        _ => Ok(()),
    }
}

fn places(source: &dyn PointSource) -> Result<Vec<[f64; 3]>, Error> {
    let mut places: Vec<[f64; 3]> = Vec::new();
    let mut scratch = Scratch::new();
    let blocks = Blocks::of(source);
    for block in 0..blocks.count() {
        let rows = source.read(blocks.range(block), &mut scratch)?;
        for i in 0..rows.len() {
            let mut at = [0.0; 3];
            rows.copy_row(i, &mut at);
            places.push(at);
        }
    }
    match first_not_finite(&places) {
        Some((row, column)) => {
            let what = format!("coordinate {column} of point {row}");
            Err(Error::NonFinite { what, value: places[row][column] })
        }
        None => Ok(places),
    }
}

fn first_not_finite(places: &[[f64; 3]]) -> Option<(usize, usize)> {
    let column = |at: &[f64; 3]| at.iter().position(|x| !x.is_finite());
    places.iter().enumerate().find_map(|(row, at)| Some((row, column(at)?)))
}

/// From where the fixed views are taken, in the words of the axes.
fn directions(options: &DrawOptions) -> Vec<View> {
    let axis = |k| options.axis(k, 3).name;
    let view = |name: String, azimuth, elevation| View { name, azimuth, elevation };
    vec![
        view(format!("Front, from −{}", axis(1)), -90.0, 0.0),
        view(format!("Side, from {}", axis(0)), 0.0, 0.0),
        view(format!("Top, from {}", axis(2)), -90.0, 90.0),
        view("Three-quarter".into(), AZIMUTH, ELEVATION),
    ]
}

/// Where the eye is first: right of the front and above it.
const AZIMUTH: f64 = -55.0;
const ELEVATION: f64 = 25.0;

/// The data that all pictures of one surface share.
struct Picture<'a> {
    view: &'a SurfaceView<'a>,
    options: &'a DrawOptions,
    places: Vec<[f64; 3]>,
}

impl Picture<'_> {
    fn vertex(&self, row: u32) -> [f64; 3] {
        let places = if self.view.moved.is_empty() { &self.places } else { self.view.moved };
        places[row as usize]
    }

    fn scene(&self) -> Scene3 {
        let triangles = self.view.triangles;
        let mut rows = triangles.as_flattened().to_vec();
        rows.sort_unstable();
        rows.dedup();
        let edges = Edges::of(triangles);
        let mut layers = Vec::new();
        if !triangles.is_empty() {
            layers.push(Layer3 {
                name: "surface".into(),
                tone: Tone::Answer,
                line_style: LineStyle::Solid,
                shape: Shape3::Surface(self.surface(&rows)),
            });
        }
        let chains = |chains: &[Vec<u32>]| {
            let chain = |rows: &Vec<u32>| rows.iter().map(|&row| self.vertex(row)).collect();
            Shape3::Polylines(chains.iter().map(chain).collect())
        };
        for (name, tone, lines) in [
            ("boundary", Tone::Support, &edges.boundary),
            ("edges of more than two triangles", Tone::Bound, &edges.branching),
        ] {
            if !lines.is_empty() {
                let (name, shape) = (name.to_owned(), chains(lines));
                layers.push(Layer3 { name, tone, line_style: LineStyle::Solid, shape });
            }
        }
        let mut caption = counts(triangles.len(), rows.len(), &edges);
        caption += &self.unused(&mut layers);
        let remarks = self.view.remarks.trim();
        if !remarks.is_empty() {
            caption += &format!(" {remarks}");
        }
        let title = format!("Surface through {}", counted(self.places.len() as u64, "point"));
        Scene3 {
            projection: Projection::Orthographic,
            azimuth: AZIMUTH,
            elevation: ELEVATION,
            ..Scene3::space(title, caption, layers, self.options)
        }
    }

    /// The scene on the sheet of fixed views.
    fn still(&self, scene: &Scene3) -> Scene3 {
        let mut still = scene.clone();
        still.title += ": four views";
        // Room for two rows of panels.
        still.height = scene.height.max(0.9 * scene.width);
        if self.view.triangles.len() > TURNED_TRIANGLES_MAX {
            still.caption += &format!(
                " More than {} triangles: there is no scene to turn by hand.",
                count(TURNED_TRIANGLES_MAX as u64)
            );
        }
        still
    }

    /// The triangles with their own vertices alone, `rows` ascending.
    fn surface(&self, rows: &[u32]) -> Surface3 {
        let place = |row: &u32| rows.binary_search(row).unwrap_or(0) as u32;
        let few = self.view.triangles.len() <= FLAT_TRIANGLES_MAX;
        Surface3 {
            vertices: rows.iter().map(|&row| self.vertex(row)).collect(),
            triangles: self
                .view
                .triangles
                .iter()
                .map(|t| [place(&t[0]), place(&t[1]), place(&t[2])])
                .collect(),
            back: Tone::Second,
            shading: if few { Shading::Flat } else { Shading::Smooth },
        }
    }

    /// Adds a layer for each group of unused points, and tells how many there are.
    fn unused(&self, layers: &mut Vec<Layer3>) -> String {
        let groups = || self.view.unused.iter().filter(|group| !group.rows.is_empty());
        let all: usize = groups().map(|group| group.rows.len()).sum();
        if all == 0 {
            return String::new();
        }
        let most = self.options.max_points;
        // The hash up to which rows are drawn: an even sample over all groups.
        let mut hashes: Vec<u64> =
            groups().flat_map(|group| group.rows).map(|&row| spread(row.into())).collect();
        let limit = match all > most {
            true => *hashes.select_nth_unstable(most - 1).1,
            false => u64::MAX,
        };
        let size = dot_size(all.min(most));
        let tones = [Tone::Third, Tone::Ink, Tone::Muted];
        for (i, group) in groups().enumerate() {
            let point = |&row: &u32| Point3 {
                id: Some(row.into()),
                at: self.places[row as usize],
                size,
                label: group.name.to_owned(),
            };
            let drawn = group.rows.iter().filter(|&&row| spread(row.into()) <= limit);
            layers.push(Layer3 {
                name: group.name.to_owned(),
                tone: tones[i.min(tones.len() - 1)],
                line_style: LineStyle::Solid,
                shape: Shape3::Points(drawn.map(point).collect()),
            });
        }
        let named: Vec<String> = groups()
            .map(|group| format!("{} {}", count(group.rows.len() as u64), group.name))
            .collect();
        let mut words = format!(" On no triangle: {}.", named.join(", "));
        if all > most {
            words += &format!(
                " {} of these {} points are drawn, an even sample.",
                count(most as u64),
                count(all as u64)
            );
        }
        words
    }
}

/// Returns how many triangles, vertices and boundary loops there are, in sentences.
fn counts(triangles: usize, vertices: usize, edges: &Edges) -> String {
    if triangles == 0 {
        return "There are no triangles.".into();
    }
    let mut words = format!(
        "{} with {}; ",
        counted(triangles as u64, "triangle"),
        match vertices {
            1 => "1 vertex".to_owned(),
            more => format!("{} vertices", count(more as u64)),
        }
    );
    words += &match edges.loops {
        0 => "no boundary.".to_owned(),
        loops => format!(
            "{} of {}.",
            counted(loops, "boundary loop"),
            counted(edges.boundary_edges, "edge")
        ),
    };
    match edges.branching.len() as u64 {
        0 => {}
        1 => words += " 1 edge has more than two triangles.",
        more => words += &format!(" {} edges have more than two triangles.", count(more)),
    }
    words
}
