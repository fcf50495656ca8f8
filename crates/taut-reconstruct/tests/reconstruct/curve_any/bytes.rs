//! Points of the plane made of any bytes: curves are found by every method, and judged by the checker. Shared with the fuzz target.

use taut_certify::{Curve, Solution};
use taut_points::Points;
use taut_reconstruct::{CurveMethod, CurveOptions, CurveThesisOptions, Ends, Error, curve};

/// Most points: small sets are the degenerate ones, and fast.
const POINTS_MAX: usize = 64;

/// Returns what a byte means as a coordinate: mostly small integers, so that points coincide and lie on common lines and circles; nearly a
/// circle; and the ends of what a double holds.
fn point([a, b]: [u8; 2], style: u8, place: usize) -> [f64; 2] {
    let small = |byte: u8| f64::from(byte % 8);
    let ends = [0.0, -0.0, 5e-324, 1e-300, 1.0, 1e150, -1e300, 1e300];
    match style % 8 {
        0 | 1 => [small(a), small(b)],
        2 => [small(a) * 0.1, f64::from(b / 64)],
        // Ties, or almost.
        3 => [small(a) + f64::from(a / 64) * f64::EPSILON, small(b)],
        4 => [f64::from(a), f64::from(b)],
        // A circle with noise, and another around it for every fourth point.
        5 | 6 => {
            let turn = (place as f64 + f64::from(a) / 256.0) * 0.4;
            let radius = if place % 4 == 3 { 2.0 } else { 1.0 } + f64::from(b) / 4096.0;
            [radius * turn.cos(), radius * turn.sin()]
        }
        _ => [a, b].map(|byte| ends[usize::from(byte % 8)]),
    }
}

/// Finds curves by every method, and again with the rows in reverse, and has the answers checked.
///
/// # Panics
/// If the checker rejects an answer, or the order of rows matters.
pub(crate) fn solve_and_check(bytes: &[u8]) {
    let [style, wish, rest @ ..] = bytes else { return };
    let mut points: Vec<[f64; 2]> = rest
        .as_chunks::<2>()
        .0
        .iter()
        .take(POINTS_MAX)
        .enumerate()
        .map(|(place, &pair)| point(pair, *style, place))
        .collect();
    let thesis = CurveThesisOptions {
        rho: if wish & 4 == 0 { 4.0 } else { 1.0 },
        omega: if wish & 8 == 0 { 0.1 } else { 1.0 },
        feature: if wish & 16 == 0 { None } else { Some(0.25) },
    };
    let methods = CurveMethod::ALL.map(|method| match method {
        CurveMethod::Thesis(_) => CurveMethod::Thesis(thesis),
        CurveMethod::ThesisCrude(_) => CurveMethod::ThesisCrude(thesis),
        other => other,
    });
    let options = |method| CurveOptions {
        method,
        ends: if wish & 1 == 0 { Ends::Auto } else { Ends::Open },
        places: wish & 2 != 0,
        ..CurveOptions::default()
    };
    let forth: Vec<_> = methods.iter().map(|&method| solved(&points, &options(method))).collect();
    points.reverse();
    for (found, method) in forth.iter().zip(methods) {
        let Some(found) = found else { continue };
        let again = solved(&points, &options(method)).expect("it was solved the other way round");
        let shape = |found: &Solution<Curve>| {
            let curves = found.answer.curves.iter();
            curves.map(|curve| (curve.vertices.clone(), curve.closed)).collect::<Vec<_>>()
        };
        assert_eq!(shape(found), shape(&again), "{method}: {points:?}");
    }
}

/// The answer, judged; `None` where coordinates are too large for a method.
fn solved(points: &[[f64; 2]], options: &CurveOptions<'_>) -> Option<Solution<Curve>> {
    let view = Points::new(points.as_flattened(), 2).expect("whole rows");
    match curve(&view, options) {
        Ok(found) => {
            let judged = found.check(&view);
            assert!(judged.is_ok(), "{:?}: {judged:?}\n{points:?}\n{found:?}", options.method);
            Some(found)
        }
        Err(Error::Triangulation(_)) => None,
        Err(other) => panic!("{:?}: {other}\n{points:?}", options.method),
    }
}
