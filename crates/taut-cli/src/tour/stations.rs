//! The stops of the tour, in order. `samples/README.md` tells where each sample comes from.

use taut::Items;

/// A sample, what is to be seen in it, and the command that shows the same.
pub(super) struct Station {
    pub(super) heading: &'static str,
    pub(super) text: &'static str,
    pub(super) file: &'static str,
    pub(super) bytes: &'static [u8],
    pub(super) items: Items,
    pub(super) command: &'static str,
    /// Whether a ball that is a little too small is shown to the checker as well.
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
        bytes: include_bytes!("../../samples/clouds.csv"),
        items: Items::Points,
        command: "taut ball clouds.csv --epsilon 0 --draw clouds.html",
        doctored: true,
    },
    Station {
        heading: "Points in space",
        text: "A knotted tube, as a scanner might deliver it: positions only, in an xyz file. Turn it with the \
               mouse.",
        file: "knot.xyz",
        bytes: include_bytes!("../../samples/knot.xyz"),
        items: Items::Points,
        command: "taut ball knot.xyz --epsilon 0 --draw knot.html",
        doctored: false,
    },
    Station {
        heading: "Many dimensions",
        text: "Normal points in 64 dimensions, single precision, in a NumPy file. They all lie close to a \
               sphere, so many of them touch the ball; still a few passes over the points suffice. The pictures \
               are projections and the distances from the centre.",
        file: "normal-64.npy",
        bytes: include_bytes!("../../samples/normal-64.npy"),
        items: Items::Points,
        command: "taut ball normal-64.npy --epsilon 0 --draw normal-64.html",
        doctored: false,
    },
    Station {
        heading: "Balls around balls",
        text: "Rows need not be points: with --balls each row is a centre and a radius, and the answer is the \
               smallest disc that holds all discs.",
        file: "discs.csv",
        bytes: include_bytes!("../../samples/discs.csv"),
        items: Items::Balls,
        command: "taut ball discs.csv --balls --epsilon 0 --draw discs.html",
        doctored: false,
    },
    Station {
        heading: "A hard case: the cube",
        text: "Vertices of a cube in fifty dimensions, packed with gzip. Every point has the same distance from \
               the answer's centre, so no point is more important than another: the case in which careless \
               methods cycle. The radius is √50 / 2 = 3.5355…",
        file: "cube-50.tsv.gz",
        bytes: include_bytes!("../../samples/cube-50.tsv.gz"),
        items: Items::Points,
        command: "taut ball cube-50.tsv.gz --epsilon 0 --draw cube-50.html",
        doctored: false,
    },
];
