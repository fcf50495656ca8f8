//! Surfaces through samples of space.
//!
//! *Problem.* Points were sampled from the boundary of bodies, or from sheets. Find the surface that has them for its vertices.
//! *Idea.* Do not grow the surface: label the cells of the Delaunay triangulation. How the spheres of two neighboring cells meet says
//! whether they are of one medium or on two sides of the surface, and how surely (`dual_edges`); the strongest spanning tree of what is
//! said labels all cells (`tree`); parts that the facets around them object to are turned over, small ones along the tree (`relabel_parts`)
//! and any by minimum cuts (`signed_cut`); the surface is where the labels change (`border`), and where that is no surface, single cells are
//! turned over (`repair`). What remains in doubt is named (`doubts`).
//! *Guarantee.* A function of the point set: neither the order of the input, nor the number of threads, nor the unit matters. Triangles
//! are Delaunay facets, so they meet in common edges and vertices alone; without defects named, it is a surface.
//! *Trap.* Nothing is promised about samples that are too sparse for the sheets they are from: those may be joined or cut.

pub mod alpha;
mod answer;
mod border;
mod cells;
mod changes;
mod circles;
mod cycles;
mod denoise;
mod diagonals;
mod doubts;
mod dual_edges;
mod facing;
mod filter;
mod flats;
mod given;
mod label_trace;
mod labeled;
mod lanes;
mod merge;
mod merged_labelings;
mod neighbors;
mod noise;
mod one_sided;
mod options;
mod orient;
mod outliers;
mod outward;
mod parity;
mod prune;
mod quad_quality;
mod relabel_parts;
mod relabel_regions;
mod repair;
mod scaled;
mod sheet_fit;
mod sides;
mod signed_cut;
mod spheres;
mod spikes;
mod stars;
pub mod thesis;
mod tree;
mod two_sum;
mod vector;
mod witness;

use std::collections::BTreeSet;

use taut_certify::{Solution, Surface, SurfaceMode as Promise, TopologyDoubt, TopologyReason};
use taut_delaunay::{Complex, DelaunayOptions, Space};
use taut_points::{
    InputError, Monitor, PointSource, Points, PointsHash, Rows, Scratch, hash_points, on_threads,
};

use crate::{Error, Span};
use alpha::{alpha_shape, filtered_hull, optimal_alpha};
use answer::{Facets, Sites, finish};
use cells::Cells;
use changes::Changes;
use denoise::{Denoised, denoise};
use doubts::doubt_of_noise;
use labeled::surface_of_labels;
use scaled::Scale;
use thesis::{ThesisOptions, thesis_surface};

pub use given::given_surface;
pub use label_trace::{LabelBorder, LabelFacet, LabelTrace, label_trace};
pub use one_sided::looks_one_sided;
pub use options::{Denoise, HullOptions, Positions, SurfaceMethod, SurfaceMode, SurfaceOptions};

/// A surface through points without outliers is sought so often at most; each time but the first without the tips of spikes before.
const PASSES_MAX: usize = 5;

/// The surface that points of space were sampled from, with its certificate.
///
/// ```
/// use taut_points::Points;
/// use taut_reconstruct::{SurfaceOptions, surface};
///
/// let octahedron = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
/// let flat: Vec<f64> = octahedron.as_flattened().iter().map(|&x| f64::from(x)).collect();
/// let points = Points::new(&flat, 3)?;
/// let found = surface(&points, &SurfaceOptions::default())?;
/// assert_eq!((found.answer.triangles.len(), found.answer.topology.genus), (8, Some(0)));
/// assert!(found.check(&points)?.certified);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// n points of three coordinates each, held in memory; O(n log n) beside their triangulation. The method `tree` is that of this crate, `thesis` and `hull`
/// those of sections 4.2 to 4.5 of the thesis, `alpha` that of Edelsbrunner and Mücke, ACM Transactions on Graphics 13(1), 1994.
///
/// # Errors
/// [`Error::Input`], also when the points cannot be read or the monitor stops the work; [`Error::Flat`]; and
/// [`Error::Triangulation`] for more cells than can be numbered.
pub fn surface(
    source: &dyn PointSource,
    options: &SurfaceOptions<'_>,
) -> Result<Solution<Surface>, Error> {
    let monitor = &options.monitor;
    check_dim(source)?;
    if let Some(how) = &options.denoise {
        how.check()?;
    }
    on_threads(options.threads, || {
        monitor.check()?;
        let mut given = read(source)?;
        let points_hash = hash_points(source, monitor)?;
        let Some(how) = &options.denoise else {
            return solve(&given, None, Changes::default(), options, points_hash, monitor);
        };
        let scale = Scale::of(&given);
        given.iter_mut().for_each(|point| *point = scale.apply(*point));
        let Denoised { points, rows, mut outliers, unclear } = denoise(&given, how, monitor)?;
        let given = read(source)?;
        let points: Vec<[f64; 3]> = match how.iterations {
            0 => rows.iter().map(|&row| given[row as usize]).collect(),
            _ => points.into_iter().map(|point| scale.inverse().apply(point)).collect(),
        };
        let solve_without = |outliers: Vec<u32>| {
            let is_in = |row: &u32| outliers.binary_search(row).is_err();
            let kept = rows.iter().copied().zip(points.iter().copied());
            let kept = kept.filter(|(row, _)| is_in(row)).unzip();
            let (mut changes, rows, points) = Changes::of(given.clone(), how, outliers, kept);
            changes.doubts.extend(doubt_of_noise(&unclear, rows.len()));
            solve(&points, Some(&rows), changes, options, points_hash, monitor)
        };
        let mut found = solve_without(outliers.clone())?;
        // Tips of spikes are outliers that were too near to a sheet, or to each other, to be told from it.
        for _ in 1..PASSES_MAX {
            let of_spikes = |doubt: &&TopologyDoubt| doubt.reason == TopologyReason::Spikes;
            let tips = found.certificate.doubts.iter().filter(of_spikes);
            let mut tips: Vec<u32> = tips.flat_map(|doubt| doubt.rows.iter().copied()).collect();
            if tips.is_empty() {
                break;
            }
            with_copies(&mut tips, &rows, &points);
            outliers.extend(tips);
            outliers.sort_unstable();
            outliers.dedup();
            found = solve_without(outliers.clone())?;
        }
        Ok(found)
    })
}

/// Adds to some of the rows those that are in their places.
fn with_copies(some: &mut Vec<u32>, rows: &[u32], points: &[[f64; 3]]) {
    let bits = |place: &[f64; 3]| place.map(|x| (x + 0.0).to_bits());
    let of_some = |row: &u32| rows.binary_search(row).ok().map(|k| bits(&points[k]));
    let places: BTreeSet<[u64; 3]> = some.iter().filter_map(of_some).collect();
    let all = rows.iter().zip(points).filter(|(_, place)| places.contains(&bits(place)));
    some.extend(all.map(|(row, _)| *row));
}

fn check_dim(source: &dyn PointSource) -> Result<(), Error> {
    match source.dim() {
        3 => Ok(()),
        dim => {
            let expected = "3, as surfaces are sought in space";
            Err(Error::Input(InputError::Dimension { dim, expected }))
        }
    }
}

/// Reads all points, and refuses what is no finite number.
fn read(source: &dyn PointSource) -> Result<Vec<[f64; 3]>, Error> {
    let mut scratch = Scratch::new();
    let rows = source.read(0..source.len(), &mut scratch)?;
    rows.check_finite(0)?;
    Ok(match rows {
        Rows::F32(points) => points.rows().map(|p| [0, 1, 2].map(|k| f64::from(p[k]))).collect(),
        Rows::F64(points) => points.rows().map(|p| [p[0], p[1], p[2]]).collect(),
    })
}

/// Triangulates points, which have to span space.
fn triangulated(points: &[[f64; 3]], monitor: &Monitor<'_>) -> Result<Space, Error> {
    let view = Points::new(points.as_flattened(), 3);
    let Ok(view) = view else { return Err(Error::Flat { points: 0, span: Span::Nothing }) };
    let space =
        Space::build(&view, &DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() })?;
    check_span(&space)?;
    Ok(space)
}

/// Refuses sites that do not span space.
fn check_span(space: &Space) -> Result<(), Error> {
    let span = match space.complex() {
        Complex::Full => return Ok(()),
        Complex::Nothing => Span::Nothing,
        Complex::Point => Span::Point,
        Complex::Line(_) => Span::Line,
        Complex::Flat(_) => Span::Plane,
    };
    let points = (space.site_count() + space.duplicates().len()) as u64;
    Err(Error::Flat { points, span })
}

/// The surface through points, which are some of all rows if any are named.
fn solve(
    points: &[[f64; 3]],
    rows: Option<&[u32]>,
    changes: Changes,
    options: &SurfaceOptions<'_>,
    points_hash: PointsHash,
    monitor: &Monitor<'_>,
) -> Result<Solution<Surface>, Error> {
    let space = triangulated(points, monitor)?;
    // The labels of cells number them themselves.
    let space = match options.method {
        SurfaceMethod::Tree(_) => space,
        _ => space.renumbered(),
    };
    let sites = Sites::of(&space, rows);
    let (mode, facets, cells) = match options.method {
        SurfaceMethod::Tree(mode) => {
            let cells = Cells::of(space.into_slots(), sites.points.len());
            let facets = surface_of_labels(&cells, &sites.points, mode, monitor)?;
            let mode = match mode {
                SurfaceMode::Closed => Promise::Closed,
                SurfaceMode::Open => Promise::Open,
            };
            (mode, facets, cells)
        }
        SurfaceMethod::Thesis(how) => {
            let facets = of_front(&space, &how, monitor)?;
            (Promise::Open, facets, Cells::of(space.into_slots(), sites.points.len()))
        }
        SurfaceMethod::Alpha(radius) => {
            let (mode, facets) = of_alpha(&space, radius)?;
            (mode, facets, Cells::of(space.into_slots(), sites.points.len()))
        }
        SurfaceMethod::Hull(HullOptions { epsilon, emptiness, alpha }) => {
            let found = filtered_hull(&space, epsilon, emptiness, alpha)?;
            let facets = Facets { triangles: found.triangles, ..Facets::default() };
            (Promise::Open, facets, Cells::of(space.into_slots(), sites.points.len()))
        }
    };
    monitor.check()?;
    finish(options.method.kind(), mode, facets, (&cells, &sites), changes, points_hash)
}

/// Returns what the front of the thesis finds.
fn of_front(space: &Space, how: &ThesisOptions, monitor: &Monitor<'_>) -> Result<Facets, Error> {
    if let Some(seed) = how.joggle {
        let (value, expected) = (seed.to_string(), "none, as joggled points are not those given");
        return Err(Error::Input(InputError::Option { name: "joggle", value, expected }));
    }
    let found = thesis_surface(space, &ThesisOptions { threads: None, ..*how }, monitor)?;
    let counters = [
        ("candidates", found.counters.candidates),
        ("pinches", found.pinches.len() as u64),
        ("seeds", found.counters.seeds),
    ];
    Ok(Facets {
        triangles: found.on_sites(),
        counters: counters.map(|(name, count)| (name.to_owned(), count)).into(),
        ..Facets::default()
    })
}

/// The alpha shape of a radius, or of the least one that holds all points in one solid.
fn of_alpha(space: &Space, radius: Option<f64>) -> Result<(Promise, Facets), Error> {
    let radius = match radius {
        Some(radius) => radius,
        None => optimal_alpha(space, 1)?,
    };
    let found = alpha_shape(space, radius)?;
    let counters = [("solids", found.solids), ("singular", found.singular.len())];
    let facets = Facets {
        triangles: found.regular,
        is_outward: true,
        counters: counters.map(|(name, count)| (name.to_owned(), count as u64)).into(),
        ..Facets::default()
    };
    // A radius without end says nothing, and no JSON holds it.
    let mode = if radius.is_finite() { Promise::Alpha { radius } } else { Promise::Closed };
    Ok((mode, facets))
}
