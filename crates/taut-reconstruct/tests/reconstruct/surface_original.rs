//! Surfaces found among moved points and delivered where these were given: all claims are about the places that are delivered.

use points::{Point, chances, circle, sphere, tube};
use taut_certify::SurfaceMode::{Alpha, Open};
use taut_certify::{Solution, Surface, SurfaceMethod as Kind, SurfaceVerdict};
use taut_points::Points;
use taut_predicates::space::equatorial_radius;
use taut_reconstruct::{
    Denoise, Error, Positions, SurfaceMethod, SurfaceMode, SurfaceOptions, surface,
};

use crate::surface_any::points;

/// Points of a sphere of radius 1, evenly by area, along a spiral of the golden angle.
fn fibonacci(count: u32) -> Vec<Point> {
    let point = |k: u32| {
        let z = 1.0 - f64::from(2 * k + 1) / f64::from(count);
        let (r, t) = ((1.0 - z * z).sqrt(), 2.399_963_229_728_653 * f64::from(k));
        [r * t.cos(), r * t.sin(), z]
    };
    (0..count).map(point).collect()
}

/// Small samples with names, on which one round of denoising moves points by as much as they are apart.
fn samples() -> Vec<(String, Vec<Point>)> {
    let mut all: Vec<(String, Vec<Point>)> =
        [4, 6, 12, 30, 60].map(|n| (format!("sphere of {n}"), fibonacci(n))).into();
    all.push(("torus".into(), tube(circle(false), 0.4, 12, 5)));
    let mut chance = chances(25);
    all.push(("random".into(), (0..25).map(|_| [chance(), chance(), chance()]).collect()));
    let mut nested = sphere(60, [0.0; 3], 1.0, 3);
    nested.extend(sphere(40, [0.0; 3], 0.4, 4));
    all.push(("nested spheres".into(), nested));
    all
}

fn in_place(kind: Kind, mode: SurfaceMode, iterations: u32) -> SurfaceOptions<'static> {
    let method = match kind {
        Kind::Tree => SurfaceMethod::Tree(mode),
        other => other.into(),
    };
    let denoise = Some(Denoise { neighbors: Some(8), iterations, positions: Positions::Original });
    SurfaceOptions { method, denoise, ..Default::default() }
}

/// The answer with what was proved of it; `None` where nothing spans space once points are moved.
fn checked(
    name: &str,
    points: &[Point],
    options: &SurfaceOptions<'_>,
) -> Option<(Solution<Surface>, SurfaceVerdict)> {
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    match surface(&view, options) {
        Err(Error::Flat { .. }) => None,
        Err(other) => panic!("{name}, {options:?}: {other}"),
        Ok(found) => match found.check(&view) {
            Ok(verdict) => Some((found, verdict)),
            Err(refused) => panic!("{name}, {options:?}: {refused}"),
        },
    }
}

#[test]
fn claims_hold_for_original_positions_not_for_moved_ones() {
    let (mut answers, mut closed) = (0, 0);
    for (name, points) in samples() {
        for method in Kind::ALL {
            for mode in [SurfaceMode::Closed, SurfaceMode::Open] {
                for iterations in [1, 2, 5] {
                    let options = in_place(method, mode, iterations);
                    let Some((_, verdict)) = checked(&name, &points, &options) else { continue };
                    answers += 1;
                    // What has a side and meets itself nowhere is turned to face outwards.
                    let is_sided = verdict.is_manifold && verdict.is_oriented;
                    assert_eq!(verdict.is_outward, is_sided && verdict.is_embedded, "{options:?}");
                    closed += usize::from(verdict.is_outward && verdict.is_closed);
                }
            }
        }
    }
    println!("{answers} answers, {closed} of them closed and outward");
    assert!(answers > 150 && closed > 50, "{answers} answers, {closed} of them closed and outward");
}

#[test]
fn small_spheres_face_outwards_at_original_positions() {
    for count in [4, 6] {
        for method in [Kind::Tree, Kind::Alpha] {
            let options = in_place(method, SurfaceMode::Closed, 1);
            let found = checked("sphere", &fibonacci(count), &options);
            let (_, verdict) = found.expect("points that span space");
            assert!(verdict.is_closed && verdict.is_embedded && verdict.is_outward, "{count}");
        }
    }
}

#[test]
fn the_alpha_radius_is_the_least_that_holds_at_original_positions() {
    let mut grown = 0;
    for (name, points) in samples() {
        let of = |positions| {
            let options = in_place(Kind::Alpha, SurfaceMode::Closed, 1);
            let denoise = options.denoise.map(|how| Denoise { positions, ..how });
            checked(&name, &points, &SurfaceOptions { denoise, ..options })
        };
        let (Some((moved, _)), Some((found, _))) =
            (of(Positions::Projected), of(Positions::Original))
        else {
            continue;
        };
        let (Alpha { radius: before }, Alpha { radius }) =
            (moved.certificate.mode, found.certificate.mode)
        else {
            panic!("{name}: no triangle of these is flat")
        };
        let fits = |rho: f64| {
            found.answer.triangles.iter().all(|triangle| {
                let [a, b, c] = triangle.map(|row| points[row as usize]);
                !equatorial_radius(a, b, c, rho).is_negative()
            })
        };
        println!("{name}: {before} among moved points, {radius} among original ones");
        assert!(radius >= before && fits(radius), "{name}");
        assert!(radius == before || !fits(radius.next_down()), "{name}: {radius} is not least");
        grown += usize::from(radius > before);
    }
    assert!(grown >= 3, "in {grown} samples a circle is larger where its points were given");
}

#[test]
fn an_alpha_surface_with_a_flat_triangle_at_original_positions_claims_no_radius() {
    // Three points on an edge of a cubic grid are on a line, and no longer once they are moved.
    let points = points::cube(2);
    let denoise =
        Some(Denoise { neighbors: Some(24), iterations: 5, positions: Positions::Original });
    let method = SurfaceMethod::Alpha(None);
    let options = SurfaceOptions { method, denoise, ..Default::default() };
    let (found, verdict) = checked("grid", &points, &options).expect("points that span space");
    let is_flat = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|row| points[row as usize]);
        equatorial_radius(a, b, c, f64::MAX).is_negative()
    };
    assert!(found.answer.triangles.iter().any(is_flat) && !verdict.is_embedded);
    assert_eq!(found.certificate.mode, Open);
}
