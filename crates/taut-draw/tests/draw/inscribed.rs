//! Tests what pictures of inscribed ellipsoids must hold: a polytope that contains the ellipsoid and touches it where it says.

use taut_certify::{InscribedCertificate, InscribedEllipsoid, Solution, Trace};
use taut_draw::{
    DrawOptions, Error, Figure, Layer2, Scene2, Shape2, Shape3, Style, inscribed_figures, to_svg,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// {c + Gz} in the half-spaces that touch it along directions z: an answer by hand, though not a largest one.
fn touching(dim: usize, directions: &[f64]) -> (Vec<f64>, Solution<InscribedEllipsoid>) {
    let center: Vec<f64> = (0..dim).map(|j| 2.0 - j as f64).collect();
    let axes: Vec<Vec<f64>> = (0..dim)
        .map(|j| (0..dim).map(|k| if j == k { 1.0 + j as f64 } else { 0.25 }).collect())
        .collect();
    // a = G⁻ᵀz would touch at z; any a touches at Gᵀa, and b = |Gᵀa| + a·c.
    let mut rows = Vec::new();
    for a in directions.chunks_exact(dim) {
        let seen = (0..dim).map(|k| (0..dim).map(|j| axes[j][k] * a[j]).sum::<f64>());
        let length = seen.map(|v| v * v).sum::<f64>().sqrt();
        let along: f64 = a.iter().zip(&center).map(|(a, c)| a * c).sum();
        rows.extend(a.iter().copied().chain([length + along]));
    }
    let n = directions.len() / dim;
    let hash = hash_points(&Points::new(&rows, dim + 1).unwrap(), &Monitor::silent()).unwrap();
    let found = Solution {
        answer: InscribedEllipsoid { center, axes, log_volume: 1.5 },
        certificate: InscribedCertificate {
            support: (0..n as u64).collect(),
            multipliers: vec![1.0; n],
            gap: 1e-9,
            points_hash: hash,
        },
        trace: Trace::default(),
    };
    (rows, found)
}

/// Directions of a cross and others between.
fn around(dim: usize, n: usize) -> Vec<f64> {
    let mut directions: Vec<f64> = generate(Distribution::Sphere, n, dim, 4).unwrap();
    for j in 0..dim {
        for sign in [1.0, -1.0] {
            directions.extend((0..dim).map(|k| if k == j { sign } else { 0.0 }));
        }
    }
    directions
}

fn drawn(rows: &[f64], dim: usize, found: &Solution<InscribedEllipsoid>) -> Vec<Figure> {
    let rows = Points::new(rows, dim + 1).unwrap();
    let figures = inscribed_figures(found, &rows, &DrawOptions::default()).unwrap();
    for figure in &figures {
        let text = to_svg(figure, &Style::default());
        assert!(!text.contains("NaN") && !text.contains("inf"), "{dim}");
    }
    figures
}

fn layer<'a>(scene: &'a Scene2, name: &str) -> &'a Layer2 {
    scene.layers.iter().find(|layer| layer.name.starts_with(name)).expect(name)
}

fn polygons<'a>(scene: &'a Scene2, name: &str) -> &'a [Vec<[f64; 2]>] {
    match &layer(scene, name).shape {
        Shape2::Polygons(polygons) => polygons,
        other => panic!("{other:?}"),
    }
}

#[test]
fn in_the_plane_every_corner_meets_two_half_planes_and_the_ellipse_all() {
    let (rows, found) = touching(2, &around(2, 7));
    let figures = drawn(&rows, 2, &found);
    let Figure::Plane(scene) = &figures[0] else { panic!("no plane") };
    let excess = |x: &[f64; 2], row: &[f64]| row[0] * x[0] + row[1] * x[1] - row[2];
    let polygon = &polygons(scene, "polytope")[0];
    assert!(polygon.len() >= 4);
    for corner in polygon {
        let excesses: Vec<f64> = rows.chunks(3).map(|row| excess(corner, row)).collect();
        assert!(excesses.iter().all(|&e| e < 1e-9), "{corner:?} is cut off");
        let meeting = excesses.iter().filter(|e| e.abs() < 1e-9).count();
        assert!(meeting >= 2, "{corner:?} meets {meeting}");
    }
    for at in &polygons(scene, "largest ellipsoid")[0] {
        assert!(rows.chunks(3).all(|row| excess(at, row) < 1e-9));
    }
    let Shape2::Points(marks) = &layer(scene, "touching").shape else { panic!("no marks") };
    assert_eq!(marks.len(), 11);
    for mark in marks {
        let row = &rows[3 * mark.id.unwrap() as usize..][..3];
        assert!(excess(&mark.at, row).abs() < 1e-9, "{mark:?}");
    }
}

#[test]
fn in_space_facets_lie_in_their_planes_and_none_is_cut_off() {
    // A copy of a half-space, and one too far away to be a facet.
    let mut directions = around(3, 12);
    directions.extend_from_within(0..3);
    let (mut rows, found) = touching(3, &directions);
    rows.extend([1.0, 0.0, 0.0, 1e6]);
    let figures = drawn(&rows, 3, &found);
    let Figure::Space(scene) = &figures[0] else { panic!("no space") };
    let facets = scene.layers.iter().find(|layer| layer.name == "polytope").unwrap();
    let Shape3::Polylines(rings) = &facets.shape else { panic!("no rings") };
    // Each tangent plane of a round body has a facet; the copy shares one.
    assert_eq!(rings.len(), 18);
    for ring in rings {
        assert_eq!(ring.first(), ring.last());
        let excess =
            |at: &[f64; 3], row: &[f64]| (0..3).map(|k| row[k] * at[k]).sum::<f64>() - row[3];
        assert!(ring.iter().all(|at| rows.chunks(4).all(|row| excess(at, row) < 1e-9)));
        let own = |row: &[f64]| ring.iter().all(|at| excess(at, row).abs() < 1e-9);
        assert!(rows.chunks(4).any(own), "a ring in no plane");
    }
}

#[test]
fn beyond_space_cuts_hold_the_cut_of_the_ellipsoid() {
    for dim in [4, 9] {
        let (rows, found) = touching(dim, &around(dim, 20));
        let figures = drawn(&rows, dim, &found);
        let Figure::Plane(scene) = &figures[0] else { panic!("no plane") };
        let (outer, inner) = (polygons(scene, "polytope"), polygons(scene, "largest"));
        let coordinates = if dim <= 7 { dim } else { 6 };
        assert_eq!((outer.len(), inner.len()), (coordinates * (coordinates - 1) / 2, outer.len()));
        for (outer, inner) in outer.iter().zip(inner) {
            // Counter-clockwise, and to the left of every edge.
            for (i, a) in outer.iter().enumerate() {
                let b = outer[(i + 1) % outer.len()];
                let left = |p: &[f64; 2]| {
                    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > -1e-9
                };
                assert!(
                    inner.iter().all(left),
                    "the cut of the ellipsoid leaves that of the polytope"
                );
            }
        }
        assert!(
            matches!(&figures[1], Figure::Plot(plot) if plot.series[1].points.len() == 20 + 2 * dim)
        );
    }
}

#[test]
fn what_is_left_out_or_wrong_is_said() {
    let (rows, mut found) = touching(2, &around(2, 40));
    found.certificate.support.truncate(3);
    found.certificate.multipliers.truncate(3);
    let points = Points::new(&rows, 3).unwrap();
    let options = DrawOptions { max_points: 10, ..DrawOptions::default() };
    let figures = inscribed_figures(&found, &points, &options).unwrap();
    let caption = figures[0].caption();
    assert!(caption.contains("10 of 44 half-spaces are drawn"), "{caption}");

    found.answer.axes[0][0] *= 1.5;
    let caption = drawn(&rows, 2, &found)[0].caption().to_owned();
    assert!(caption.contains("does not fit these half-spaces"), "{caption}");

    // A wedge, of which an answer without proof may still be drawn.
    let (rows, found) = touching(2, &[1.0, 0.0, 0.0, 1.0]);
    let caption = drawn(&rows, 2, &found)[0].caption().to_owned();
    assert!(caption.contains("cut off"), "{caption}");

    let error = |columns: usize, values: &[f64], found: &Solution<InscribedEllipsoid>| {
        let points = Points::new(values, columns).unwrap();
        inscribed_figures(found, &points, &DrawOptions::default()).unwrap_err()
    };
    assert!(matches!(error(2, &rows, &found), Error::Mismatch { what: "number of columns", .. }));
    let short = error(3, &rows[..3], &found);
    assert!(matches!(short, Error::Mismatch { what: "number of half-spaces", .. }), "{short}");
    let mut nan = rows.clone();
    nan[1] = f64::NAN;
    assert!(matches!(error(3, &nan, &found), Error::NonFinite { .. }));
    let mut bad = found.clone();
    bad.answer.axes[1].pop();
    assert!(matches!(error(3, &rows, &bad), Error::Mismatch { .. }));
    let mut bad = found;
    bad.answer.axes = vec![vec![0.0; 2]; 2];
    assert!(matches!(error(3, &rows, &bad), Error::NonFinite { .. }));
}
