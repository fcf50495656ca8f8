//! Points of space made of any bytes: surfaces are found by every method, and judged by the checker. Shared with the fuzz target.

use taut_certify::{Solution, Surface};
use taut_points::Points;
use taut_reconstruct::thesis::{AlphaFilter, Extent, Pinches, Priority, ThesisOptions};
use taut_reconstruct::{
    Denoise, Error, HullOptions, SurfaceMethod, SurfaceMode, SurfaceOptions, surface,
};

/// Most points: small sets are the degenerate ones, and fast.
const POINTS_MAX: usize = 40;

/// Returns what a byte means as a coordinate: mostly small integers, so that points coincide and lie on common planes and spheres; nearly a
/// sphere; and the ends of what a double holds.
fn point(bytes: [u8; 3], style: u8, place: usize) -> [f64; 3] {
    let small = |byte: u8| f64::from(byte % 4);
    let ends = [0.0, -0.0, 5e-324, 1e-300, 1.0, 1e150, -1e300, 1e300];
    match style % 8 {
        0 | 1 => bytes.map(small),
        2 => {
            let [a, b, c] = bytes;
            [small(a) * 0.1, small(b), f64::from(c / 128)]
        }
        // Ties, or almost.
        3 => bytes.map(|byte| small(byte) + f64::from(byte / 64) * f64::EPSILON),
        4 => bytes.map(f64::from),
        // A sphere with noise, and another around it for every fourth point.
        5 | 6 => {
            let [a, b, c] = bytes.map(f64::from);
            let (turn, z) = (place as f64 * 2.4 + a / 512.0, b / 127.5 - 1.0);
            let radius = if place % 4 == 3 { 2.0 } else { 1.0 } + c / 4096.0;
            let across = radius * (1.0 - z * z).max(0.0).sqrt();
            [across * turn.cos(), across * turn.sin(), radius * z]
        }
        _ => bytes.map(|byte| ends[usize::from(byte % 8)]),
    }
}

/// Finds surfaces by every method, and again with the rows in reverse, and has the answers checked.
///
/// # Panics
/// If the checker rejects an answer, or the order of rows matters.
pub(crate) fn solve_and_check(bytes: &[u8]) {
    let [style, wish, rest @ ..] = bytes else { return };
    let mut points: Vec<[f64; 3]> = rest
        .as_chunks::<3>()
        .0
        .iter()
        .take(POINTS_MAX)
        .enumerate()
        .map(|(place, &triple)| point(triple, *style, place))
        .collect();
    let chosen = |bit: u8| wish & bit != 0;
    let thesis = ThesisOptions {
        alpha: if chosen(1) { AlphaFilter::Circumradius(1.5) } else { AlphaFilter::None },
        priority: if chosen(2) { Priority::EmptyBall } else { Priority::CircumcenterDistance },
        extent: if chosen(4) { Extent::Restarts } else { Extent::Front },
        pinches: if chosen(8) { Pinches::Peel } else { Pinches::Keep },
        ..ThesisOptions::default()
    };
    let hull = HullOptions { alpha: thesis.alpha, ..HullOptions::default() };
    let methods = [
        SurfaceMethod::Tree(SurfaceMode::Open),
        SurfaceMethod::Tree(SurfaceMode::Closed),
        SurfaceMethod::Thesis(thesis),
        SurfaceMethod::Alpha(chosen(16).then_some(1.0)),
        SurfaceMethod::Hull(hull),
    ];
    let all = methods.map(|method| SurfaceOptions {
        method,
        denoise: chosen(32).then(|| Denoise { neighbors: Some(5), ..Denoise::default() }),
        ..SurfaceOptions::default()
    });
    let forth: Vec<_> = all.iter().map(|options| solved(&points, options)).collect();
    points.reverse();
    let last = points.len().saturating_sub(1) as u32;
    for (found, options) in forth.iter().zip(&all) {
        let again = solved(&points, options);
        let shape = |found: &Option<Solution<Surface>>, turned: bool| {
            let found = found.as_ref()?;
            let copies: std::collections::BTreeMap<u32, u32> =
                found.answer.unused.duplicates.iter().map(|&[row, of]| (of, row)).collect();
            let mut triangles: Vec<[u32; 3]> = found.answer.triangles.clone();
            for triangle in &mut triangles {
                if turned {
                    // Of equal rows the last is the first in reverse.
                    *triangle = triangle.map(|row| last - copies.get(&row).copied().unwrap_or(row));
                }
                let least = (0..3).min_by_key(|&k| triangle[k]).unwrap_or(0);
                triangle.rotate_left(least);
            }
            triangles.sort_unstable();
            Some(triangles)
        };
        assert_eq!(shape(found, false), shape(&again, true), "{options:?}: {points:?}");
    }
}

/// The answer, judged; `None` where there is no space between the points, or too much.
fn solved(points: &[[f64; 3]], options: &SurfaceOptions<'_>) -> Option<Solution<Surface>> {
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    match surface(&view, options) {
        Ok(found) => {
            let judged = found.check(&view);
            assert!(judged.is_ok(), "{options:?}: {judged:?}\n{points:?}\n{found:?}");
            Some(found)
        }
        Err(Error::Flat { .. } | Error::Triangulation(_)) => None,
        Err(other) => panic!("{options:?}: {other}\n{points:?}"),
    }
}
