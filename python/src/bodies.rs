//! `taut.inscribed_bodies` and `taut.inscribed_dops`, behind their Python signatures.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::inscribe::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, Objective, Scene, ThesisSeeds,
};

use crate::choice::{check_method_options, choice};
use crate::found::{Found, solve_points};
use crate::numbers::whole;

/// Convex bodies inside the mesh whose triangles are the rows of an array. `facets` is the most facets of a body, if they are free,
/// else the number of directions, unless these are `given`.
#[pyfunction]
pub(crate) fn inscribed_bodies(
    py: Python<'_>,
    rows: &Bound<'_, PyAny>,
    is_free: bool,
    facets: &Bound<'_, PyAny>,
    given: Vec<[i64; 3]>,
    objective: &str,
    count: &Bound<'_, PyAny>,
    disjoint: bool,
    at: Vec<[f64; 3]>,
    ends: Vec<[f64; 3]>,
    coverage: Option<f64>,
    hidden: Option<f64>,
    merge_within: Option<f64>,
    close_holes: bool,
    events: &Bound<'_, PyAny>,
    seed: &Bound<'_, PyAny>,
    method: &str,
    seeds: &str,
    cells: &Bound<'_, PyAny>,
    votes: &Bound<'_, PyAny>,
    translate: bool,
    merge: bool,
) -> PyResult<Found> {
    let shape = match is_free {
        true => BodyShape::Free(whole("facets", facets, "from 8 to 256")?),
        false if !given.is_empty() => BodyShape::Directions(&given),
        false => BodyShape::Dop(whole("directions", facets, "6, 14, 18 or 26")?),
    };
    let objective = choice::<Objective>("objective", objective)?;
    let count = whole("count", count, "from 1 to 1000")?;
    let events = whole("events", events, "at least 1")?;
    let thesis = BodiesThesisOptions {
        seeds: choice::<ThesisSeeds>("seeds", seeds)?,
        cells: whole("cells", cells, "from 2 to 256")?,
        votes: whole("votes", votes, "from 1 to 100")?,
        translate,
        merge,
    };
    let usual = BodiesThesisOptions::default();
    let changed = [
        ("seeds", thesis.seeds != usual.seeds),
        ("cells", thesis.cells != usual.cells),
        ("votes", thesis.votes != usual.votes),
        ("translate", translate),
        ("merge", merge),
    ];
    let chosen = choice::<BodiesMethod>("method", method)?;
    check_method_options(method, &changed, |_, method: &BodiesMethod| {
        matches!(method, BodiesMethod::Thesis(_))
    })?;
    let method = match chosen {
        BodiesMethod::Thesis(_) => BodiesMethod::Thesis(thesis),
        other => other,
    };
    let seed = whole("seed", seed, "from 0 to 2^64 - 1")?;
    solve_points(py, rows, |source, monitor| {
        let options = BodiesOptions {
            shape,
            method,
            objective,
            count,
            disjoint,
            at: &at,
            ends: &ends,
            coverage,
            hidden,
            merge_within,
            close_holes,
            events,
            seed,
            monitor: *monitor,
        };
        taut::inscribe::inscribed_bodies(source, &options)
    })
}

/// The rows of the 12 triangles of the bounding box of points.
#[pyfunction]
pub(crate) fn box_rows(points: Vec<[f64; 3]>) -> Vec<f64> {
    taut::inscribe::box_rows(&points)
}

/// The rows of a mesh, of surfaces in it and of points, each of 10 numbers.
#[pyfunction]
pub(crate) fn scene_rows(
    mesh: Vec<f64>,
    surfaces: Vec<Vec<f64>>,
    points: Vec<[f64; 3]>,
) -> PyResult<Vec<f64>> {
    let wrong = |error: taut::inscribe::Error| PyValueError::new_err(error.to_string());
    let mut scene = Scene::around(&mesh).map_err(wrong)?;
    for surface in &surfaces {
        scene.add_surface(surface).map_err(wrong)?;
    }
    scene.add_points(&points);
    Ok(scene.into_rows())
}
