//! The stops of the tour, in order. `samples/README.md` tells where each sample comes from.

use taut::Items;

/// The use of a sample.
#[derive(Clone, Copy)]
pub(super) enum Tool {
    /// The smallest ball.
    Ball(Items),
    /// The ellipsoid of least volume.
    Ellipsoid,
    /// Center, scatter and outliers.
    Robust,
    /// The ellipsoid of largest volume in a polytope.
    Inscribed,
    /// The largest ellipse in a polygon.
    Ellipse,
    /// So many convex bodies in a mesh.
    Bodies(usize),
    /// So many centers.
    Centers(usize),
    /// The Delaunay triangulation.
    Delaunay,
    /// The curves that points were sampled from.
    Curve,
    /// The surface that points were sampled from.
    Surface,
}

/// A sample, what is to be seen in it, and the command that shows the same.
pub(super) struct Station {
    pub(super) heading: &'static str,
    pub(super) text: &'static str,
    pub(super) file: &'static str,
    pub(super) bytes: &'static [u8],
    pub(super) tool: Tool,
    pub(super) command: &'static str,
    /// True if a wrong answer is shown to the checker as well: a shape a little too small, an edge turned.
    pub(super) doctored: bool,
}

pub(super) const STATIONS: &[Station] = &[
    Station {
        heading: "Points in the plane",
        text: "Five clouds. The smallest disc that holds them all is decided by two or three points, its support; \
               every other point could be taken away without changing it.\n\n\
               A proof must be able to fail: shown a disc that is a millionth smaller, the checker names a point \
               that lies outside.",
        file: "clouds.csv",
        bytes: include_bytes!("../../../samples/clouds.csv"),
        tool: Tool::Ball(Items::Points),
        command: "taut ball clouds.csv --epsilon 0 --draw clouds.html",
        doctored: true,
    },
    Station {
        heading: "Points in space",
        text: "A knotted tube, as a scanner might deliver it: positions only, in an xyz file. Turn it with the \
               mouse.",
        file: "knot.xyz",
        bytes: include_bytes!("../../../samples/knot.xyz"),
        tool: Tool::Ball(Items::Points),
        command: "taut ball knot.xyz --epsilon 0 --draw knot.html",
        doctored: false,
    },
    Station {
        heading: "Many dimensions",
        text: "Normal points in 64 dimensions, single precision, in a NumPy file. They all lie close to a \
               sphere, so many of them touch the ball; still a few passes over the points suffice. The pictures \
               are projections and the distances from the center.",
        file: "normal-64.npy",
        bytes: include_bytes!("../../../samples/normal-64.npy"),
        tool: Tool::Ball(Items::Points),
        command: "taut ball normal-64.npy --epsilon 0 --draw normal-64.html",
        doctored: false,
    },
    Station {
        heading: "Balls around balls",
        text: "Rows need not be points: with --balls each row is a center and a radius, and the answer is the \
               smallest disc that holds all discs.",
        file: "discs.csv",
        bytes: include_bytes!("../../../samples/discs.csv"),
        tool: Tool::Ball(Items::Balls),
        command: "taut ball discs.csv --balls --epsilon 0 --draw discs.html",
        doctored: false,
    },
    Station {
        heading: "A hard case: the cube",
        text: "Vertices of a cube in fifty dimensions, packed with gzip. Every point has the same distance from \
               the answer's center, so no point is more important than another: the case in which careless \
               methods cycle. The radius is √50 / 2 = 3.5355…",
        file: "cube-50.tsv.gz",
        bytes: include_bytes!("../../../samples/cube-50.tsv.gz"),
        tool: Tool::Ball(Items::Points),
        command: "taut ball cube-50.tsv.gz --epsilon 0 --draw cube-50.html",
        doctored: false,
    },
    Station {
        heading: "Around them, closer: an ellipsoid",
        text: "Four lengths of 150 irises, in centimeters (UCI Machine Learning Repository, CC BY 4.0). No ellipsoid of \
               four dimensions around them has less volume; what is shown are its shadows on each pair of \
               lengths. It follows how lengths grow together, which a ball cannot, and does not depend on \
               their units.\n\n\
               Shown an ellipsoid that is a millionth flatter, the checker names a flower that lies outside.",
        file: "iris.csv",
        bytes: include_bytes!("../../../samples/iris.csv"),
        tool: Tool::Ellipsoid,
        command: "taut ellipsoid iris.csv --epsilon 0 --draw iris.html",
        doctored: true,
    },
    Station {
        heading: "An ellipsoid in space",
        text: "The knot once more: it is flatter than a ball, and so is what holds it.",
        file: "knot.xyz",
        bytes: include_bytes!("../../../samples/knot.xyz"),
        tool: Tool::Ellipsoid,
        command: "taut ellipsoid knot.xyz --epsilon 0 --draw knot-ellipsoid.html",
        doctored: false,
    },
    Station {
        heading: "Most of the points: outliers",
        text: "Heights and weights of 160 people, made up for this page; in every thirteenth row somebody wrote the two \
               the wrong way round. The mean and the smallest ellipsoid would be drawn towards these rows. Here the \
               half of the points that lie closest together decides where the others should be, and what is not \
               there is an outlier.\n\n\
               The checker calculates all of it again from the rows that were kept. Shown a list of outliers in which \
               the last is missing, it names the row.",
        file: "people.csv",
        bytes: include_bytes!("../../../samples/people.csv"),
        tool: Tool::Robust,
        command: "taut ellipsoid people.csv --robust mcd --draw people.html",
        doctored: true,
    },
    Station {
        heading: "Near to all: k centers",
        text: "The larger cities of Europe (places of GeoNames, CC BY 4.0), here on a map in kilometers. Where \
               would eight helicopters stand, so that the farthest city is as near to one of them as can be? No eight \
               places do better than these by more than a millionth: the cities of the core-set alone prove it.\n\n\
               The checker replays the log of the search, branch by branch. Shown a radius that is a millionth smaller, it names a city that lies outside.",
        file: "europe.csv",
        bytes: include_bytes!("../../../samples/europe.csv"),
        tool: Tool::Centers(8),
        command: "taut centers europe.csv -k 8 --epsilon 1e-6 --draw centers.html",
        doctored: true,
    },
    Station {
        heading: "From within: a polytope",
        text: "A cut stone: 25 half-spaces, a row each. No ellipsoid inside has a larger volume; the marks are where it \
               touches, and their weights are the proof.\n\n\
               Shown an ellipsoid that is a millionth longer, the checker names a half-space that it crosses.",
        file: "gem.csv",
        bytes: include_bytes!("../../../samples/gem.csv"),
        tool: Tool::Inscribed,
        command: "taut inscribe ellipsoid gem.csv --draw gem.html",
        doctored: true,
    },
    Station {
        heading: "From within: an ellipse in a lake",
        text: "The shore of a lake with an island, made up for this page. The largest ellipse of open water: no other one in the lake \
               has an area larger by more than a thousandth.\n\n\
               The certificate divides all shapes and centers into cells, and bounds each. Shown an ellipse that is a \
               thousandth longer, the checker names an edge that enters it.",
        file: "lake.csv",
        bytes: include_bytes!("../../../samples/lake.csv"),
        tool: Tool::Ellipse,
        command: "taut inscribe ellipse lake.csv --draw lake.html",
        doctored: true,
    },
    Station {
        heading: "From within: bodies in a mesh",
        text: "A pawn of 416 triangles, and four convex bodies with facets in 18 directions that fill much of it, as games and robots \
               use them instead of the mesh. Each lies inside, which whole numbers prove; how much they cover is an estimate.\n\n\
               Shown the first body a little larger, the checker names a triangle that may reach into it.",
        file: "pawn.csv",
        bytes: include_bytes!("../../../samples/pawn.csv"),
        tool: Tool::Bodies(4),
        command: "taut inscribe dops pawn.csv --count 4 --max-events 20000 --draw pawn.html",
        doctored: true,
    },
    Station {
        heading: "Through the points: a triangulation",
        text: "The larger cities of Europe again, by longitude and latitude, joined by triangles whose circumcircles hold \
               no other city. The Voronoi diagram beside it shows which places are nearest to which city.\n\n\
               The checker goes over all pairs of neighboring triangles, in exact arithmetic. Shown the same \
               triangulation with one edge turned, it names the place that is wrong.",
        file: "cities.csv",
        bytes: include_bytes!("../../../samples/cities.csv"),
        tool: Tool::Delaunay,
        command: "taut delaunay cities.csv -o cities.vtu --draw cities.html",
        doctored: true,
    },
    Station {
        heading: "A triangulation of space",
        text: "The knot again, now filled with tetrahedra: what is shown is the convex hull around them.",
        file: "knot.xyz",
        bytes: include_bytes!("../../../samples/knot.xyz"),
        tool: Tool::Delaunay,
        command: "taut delaunay knot.xyz -o knot.vtu --draw knot-hull.html",
        doctored: false,
    },
    Station {
        heading: "Along the points: curves",
        text: "Points near four curves, three of which are closed, two of them within the third, and a few points that belong to \
               none. Which curves were they? The dashed lines are the band of noise, as estimated from the points.\n\n\
               The checker measures how far each point is from the curves, makes sure by exact signs that they meet nowhere, and \
               says whether points are dense enough beside the features of the curves to be sure of their connectivity; where it \
               cannot, it says why. Shown the same answer with one vertex moved, it names what is wrong.",
        file: "loops.csv",
        bytes: include_bytes!("../../../samples/loops.csv"),
        tool: Tool::Curve,
        command: "taut curve loops.csv --draw loops.html",
        doctored: true,
    },
    Station {
        heading: "Over the points: a surface",
        text: "The knot a last time, and at last as what it is: a tube. All space is labeled as inside or outside by how the spheres \
               of neighboring tetrahedra meet, and the surface is the border between the two. One handle, no hole, every point used.\n\n\
               The checker counts parts, handles and holes, makes sure by exact signs that no two triangles meet where they should \
               not and that the ball of each triangle is empty, and finds out which side is outside. Shown the same surface with \
               one triangle turned over, it names what is wrong.",
        file: "knot.xyz",
        bytes: include_bytes!("../../../samples/knot.xyz"),
        tool: Tool::Surface,
        command: "taut surface knot.xyz -o knot.ply --draw knot-surface.html",
        doctored: true,
    },
];
