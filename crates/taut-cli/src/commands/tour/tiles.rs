//! The stop at triangulations larger than memory: a set that is cut into small parts, as if no more than one fitted.

use anyhow::anyhow;
use taut::certify::Fingerprint;
use taut::delaunay::outofcore::{
    CellBox, FINE_LEVELS, Front, Magnitudes, NodeJob, NodePoints, Router, Tile, Tree, Whole,
    finish, summarize,
};
use taut::points::Scratch;
use taut::{DelaunayOptions, Monitor, Points};
use taut_draw::{
    Aspect, Axis, Field, Figure, Layer2, LineStyle, Point2, Scene2, Section, Shape2, Tone,
};

use super::Stop;
use crate::input::reading::Opened;
use crate::output::numbers::count;

pub(super) const HEADING: &str = "A triangulation larger than memory";

const CITIES: &[u8] = include_bytes!("../../../samples/cities.csv");
/// The cities are cut into 2³ parts.
const LEVELS: u32 = 3;

/// What the parts and the root finished.
struct Parts {
    leaves: Vec<Tile<2>>,
    root: Tile<2>,
    /// Sites that went up.
    front: u64,
}

/// Triangulates the cities part by part; verified means that the hash is that of the verified triangulation in memory.
pub(super) fn stop() -> anyhow::Result<Stop> {
    let opened = Opened::of_bytes(CITIES, "cities.csv")?;
    let source = opened.source();
    let (mut scratch, mut row) = (Scratch::new(), [0.0; 2]);
    let rows = source.read(0..source.len(), &mut scratch)?;
    let cities: Vec<[f64; 2]> = (0..rows.len())
        .map(|i| {
            rows.copy_row(i, &mut row);
            row
        })
        .collect();
    let parts = by_parts(&cities)?;
    let points = Points::new(cities.as_flattened(), 2).map_err(|error| anyhow!("{error}"))?;
    let found = taut::delaunay(&points, &DelaunayOptions::default())?;
    let mut hash = Fingerprint::default();
    parts.leaves.iter().chain([&parts.root]).for_each(|tile| hash.merge(tile.counts.fingerprint));
    let verified = found.check(&points).is_ok() && hash == found.certificate.fingerprint;
    let early: u64 = parts.leaves.iter().map(|tile| tile.counts.simplices).sum();
    let late = parts.root.counts.simplices;
    let n = cities.len() as u64;
    let field = |name: &str, value: String| Field::new(name, value);
    let fields = vec![
        field("cities", count(n)),
        field("finished by parts", format!("{} triangles", count(early))),
        field("went up", format!("{} cities", count(parts.front))),
        field("finished at the root", format!("{} triangles", count(late))),
        field(
            "fingerprint",
            format!("{hash}, that of the triangulation in memory, which is verified"),
        ),
    ];
    let text = "The cities once more, cut into eight parts, as if memory held no more than one of them. A triangle is finished \
                where it is found if its circle meets no box with cities of other parts; it is written and forgotten. Only the \
                cities of the others go up, and are joined at the root.\n\n\
                On large sets less than one city in a hundred goes up, so a billion points fit through a small memory.";
    let section = Section {
        heading: HEADING.to_owned(),
        text: text.to_owned(),
        command: "taut delaunay cities.csv --memory 64M -o tiles/".to_owned(),
        fields,
        figures: vec![Figure::Plane(picture(&cities, &parts))],
    };
    let summary = format!("{} of {} cities went up", count(parts.front), count(n));
    Ok(Stop { section, summary, verified })
}

/// Cuts, triangulates each part, and joins what is left.
fn by_parts(cities: &[[f64; 2]]) -> anyhow::Result<Parts> {
    let router = Router::new(cities.to_vec(), LEVELS + FINE_LEVELS);
    let mut cells = vec![CellBox::EMPTY; router.cells()];
    let mut magnitudes = Magnitudes::EMPTY;
    let mut points = vec![NodePoints::default(); 1 << LEVELS];
    for (row, &p) in (0u64..).zip(cities) {
        let cell = router.cell(p);
        cells[cell].add(p);
        p.iter().for_each(|&x| magnitudes.add(x));
        points[cell >> FINE_LEVELS].push(p, row);
    }
    let whole = Whole::new(&Tree::new(&cells), magnitudes, true);
    let job = |node| NodeJob { node, row_bytes: 4, output: "memory" };
    let (mut all, mut leaves, silent) = (Front::empty(), Vec::new(), Monitor::silent());
    for (node, points) in ((1u32 << LEVELS) - 1..).zip(points) {
        let mut bytes = Vec::new();
        let (_, front) = summarize(&whole, job(node), points, &mut bytes, &silent)?;
        leaves.push(Tile::from_bytes(&bytes)?);
        all.append(front);
    }
    let (front, mut bytes) = (all.len() as u64, Vec::new());
    finish(&whole, job(0), all, &mut bytes, &silent)?;
    Ok(Parts { leaves, root: Tile::from_bytes(&bytes)?, front })
}

/// Triangles of the parts below those of the root.
fn picture(cities: &[[f64; 2]], parts: &Parts) -> Scene2 {
    let triangles = |tile: &Tile<2>| -> Vec<Vec<[f64; 2]>> {
        let corners = |t: &[u32]| t.iter().map(|&v| tile.coordinates[v as usize]).collect();
        tile.simplex_rows().map(corners).collect()
    };
    let layer = |name: &str, tone, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style: LineStyle::Solid,
        shape,
    };
    let dot = |(row, &at): (u64, &[f64; 2])| Point2 {
        id: Some(row),
        at,
        size: 1.2,
        label: String::new(),
    };
    Scene2 {
        title: "Triangles that the parts finished, and those of the root".to_owned(),
        caption: format!(
            "{} parts; {} of {} cities went up.",
            parts.leaves.len(),
            count(parts.front),
            count(cities.len() as u64)
        ),
        x: Axis::default(),
        y: Axis::default(),
        aspect: Aspect::Equal,
        layers: vec![
            layer(
                "finished by parts",
                Tone::Answer,
                Shape2::Polygons(parts.leaves.iter().flat_map(triangles).collect()),
            ),
            layer("finished at the root", Tone::Second, Shape2::Polygons(triangles(&parts.root))),
            layer("cities", Tone::Point, Shape2::Points((0u64..).zip(cities).map(dot).collect())),
        ],
        width: 640.0,
        height: 480.0,
    }
}
