//! Figures 52 and 53: diamonds over cities of the USA, and times of triangulations larger than memory.
//!
//! *What is rerun.* Figure 52 of the 13,509 cities of TSPLIB's `usa13509`, with a sample of √n of them. Figure 53 by the method of
//! the thesis with taut's own triangulation in memory in the place of Triangle, beside the tree merge on the disk and the build in
//! memory. The thesis went to 79 million points of TIGER on a dual Athlon with 1 GB; here points are uniform.

use taut_delaunay::{DelaunayOptions, GHOST, Plane};
use taut_draw::Figure as Picture;

use super::*;
use crate::outofcore::diamonds;
use crate::outofcore::one::{Task, Way};
use crate::outofcore::{Set, write_points};

/// TSPLIB's cities, by latitude and by longitude to the west.
const CITIES: &str = "delaunay/tsplib_usa13509.tsp.xz";
/// Memory of a triangulation on the disk.
const MEMORY: u64 = 512 << 20;

/// Draws the diamonds of a sample of cities.
pub(super) fn figure_52(plan: &Plan) -> Result<()> {
    let Some(text) = data::read_xz(CITIES)? else { return Ok(()) };
    let cities = cities(&text);
    ensure!(cities.len() > 1000, "{CITIES}: {} cities", cities.len());
    let is_in = diamonds::sample(cities.len(), (cities.len() as f64).sqrt());
    let (rows, values) = diamonds::marked(&cities, &is_in);
    let built = Plane::build(&Points::new(&values, 2)?, &DelaunayOptions::default())?;
    let locator = built.locator();
    let lists = diamonds::Lists::new(&built, &locator, &cities, &is_in);
    let bounds =
        cities.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], p| {
            [[0, 1].map(|i| low[i].min(p[i])), [0, 1].map(|i| high[i].max(p[i]))]
        });
    let is_near = |p: &[f64; 2]| {
        (0..2).all(|i| {
            let margin = 0.05 * (bounds[1][i] - bounds[0][i]);
            (bounds[0][i] - margin..=bounds[1][i] + margin).contains(&p[i])
        })
    };
    let all: Vec<Vec<[f64; 2]>> = diamonds_of(&built);
    let drawn: Vec<Vec<[f64; 2]>> =
        all.iter().filter(|corners| corners.iter().all(is_near)).cloned().collect();
    let dots = |points: Vec<[f64; 2]>, size: f64| {
        let dot = |at: [f64; 2]| Point2 { id: None, at, size, label: String::new() };
        Shape2::Points(points.into_iter().map(dot).collect())
    };
    let layer = |name: &str, tone, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style: LineStyle::Solid,
        shape,
    };
    let sample: Vec<[f64; 2]> = rows.iter().map(|&row| cities[row as usize]).collect();
    let picture = Picture::Plane(Scene2 {
        title: "Figure 52, redrawn: diamonds of a sample of cities of the USA".to_owned(),
        caption: format!(
            "{} cities, of which {} are the sample; {} of {} bounded diamonds drawn, the others reach far beyond; a city is in \
             conflict with {:.2} diamonds on average.",
            cities.len(),
            sample.len(),
            drawn.len(),
            all.len(),
            lists.factor()
        ),
        x: Axis::default(),
        y: Axis::default(),
        aspect: Aspect::Equal,
        layers: vec![
            layer("cities", Tone::Point, dots(cities, 0.6)),
            layer("diamonds", Tone::Answer, Shape2::Polygons(drawn)),
            layer("sample", Tone::Second, dots(sample, 2.4)),
        ],
        width: 900.0,
        height: 560.0,
    });
    let path = plan.out.join("figure-52.svg");
    println!("## Figure 52: {} diamonds, factor {:.2}\n", lists.edges.len(), lists.factor());
    Ok(fs::write(path, to_svg(&picture, &Style::default()))?)
}

/// East to the right and north upward.
fn cities(text: &str) -> Vec<[f64; 2]> {
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() == 3);
    rows.map(|row| [-row[2], row[1]]).collect()
}

/// The corners of the bounded diamonds: two sites and the centers of the two triangles at their edge.
fn diamonds_of(built: &Plane) -> Vec<Vec<[f64; 2]>> {
    let is_finite = |t: u32| !built.vertices(t).contains(&GHOST);
    let center = |t: u32| diamonds::circumcenter(built.vertices(t).map(|v| built.site(v)));
    let mut found = vec![];
    for t in built.simplices() {
        let vertices = built.vertices(t);
        for i in 0..3 {
            let (other, _) = built.neighbor(t, i);
            let (v, w) = (vertices[(i + 1) % 3], vertices[(i + 2) % 3]);
            if is_finite(other) && t < other {
                found.push(vec![built.site(v), center(t), built.site(w), center(other)]);
            }
        }
    }
    found
}

/// Times against the number of points.
pub(super) fn figure_53(plan: &Plan) -> Result<()> {
    let mut figure = Figure::of_times(53, "triangulations of the plane, one thread", "points")
        .note("The thesis: 79 million points of TIGER, on one processor; here uniform points.");
    let sizes = plan.upto(&[20_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000], 1, 4);
    /// The way, given the folder for tiles.
    type WayIn = fn(PathBuf) -> Way;
    let ways: [(&str, WayIn); 3] = [
        ("diamonds of the thesis", |_| Way::Diamonds),
        ("tree merge on the disk, 512 MiB", |folder| Way::Folder { memory: MEMORY, folder }),
        ("in memory", |_| Way::Memory),
    ];
    for (name, way) in ways {
        let mut points = vec![];
        for &n in sizes {
            let folder = TempDir::new()?;
            let file = folder.path().join("points.f64");
            write_points(&file, &Set::uniform_plane(n), n)?;
            let task =
                Task { dim: 2, points: n, threads: 1, file, way: way(folder.path().join("tiles")) };
            match task.run(&plan.context, None)? {
                Ok(done) => points.push([n as f64, done.wall]),
                Err(silence) => {
                    figure.notes.push(format!("{name}, {n} points: {silence}."));
                    break;
                }
            }
        }
        figure.curves.push(Curve { name: name.to_owned(), points });
    }
    figure.show(plan)
}
