//! Curves by hand are accepted, damaged ones refused for the right reason, and documents survive the way through JSON.

use taut_certify::{
    AnySolution, AnyVerdict, CheckError, Curve, CurveCertificate, CurveComponent, CurveDoubt,
    CurveVerdict, CurveViolation, Place, Solution, TourBound, Trace, Violation,
};
use taut_points::{Monitor, Points, PointsHash, hash_points};

type Loop = Vec<[f64; 2]>;

/// A point of a circle.
fn on_circle(center: [f64; 2], radius: f64, turn: f64) -> [f64; 2] {
    let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
    [center[0] + radius * cos, center[1] + radius * sin]
}

fn circle(center: [f64; 2], radius: f64, count: usize) -> Loop {
    (0..count).map(|k| on_circle(center, radius, k as f64 / count as f64)).collect()
}

fn component(vertices: Loop, closed: bool, first_row: Option<u64>) -> CurveComponent {
    let rows = first_row.map_or(vec![], |first| (first..first + vertices.len() as u64).collect());
    CurveComponent { vertices, closed, rows }
}

#[derive(Clone, Debug)]
struct Case {
    solution: Solution<Curve>,
    rows: Loop,
}

impl Case {
    fn of(curves: Vec<CurveComponent>, rows: Loop, outliers: Vec<u64>, band: f64) -> Self {
        let flat: Vec<f64> = rows.iter().flatten().copied().collect();
        let points = Points::new(&flat, 2).unwrap();
        let certificate = CurveCertificate {
            band,
            sampling_ratio: f64::MAX,
            noise_ratio: f64::MAX,
            certified: false,
            tour: None,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        };
        let answer = Curve { curves, noise: band, outliers, places: vec![] };
        Case { solution: Solution { answer, certificate, trace: Trace::default() }, rows }
    }

    fn check(&self) -> Result<CurveVerdict, Violation> {
        let flat: Vec<f64> = self.rows.iter().flatten().copied().collect();
        match self.solution.check(&Points::new(&flat, 2).unwrap()) {
            Ok(verdict) => Ok(verdict),
            Err(CheckError::Rejected(violation)) => Err(violation),
            Err(error) => panic!("{error}"),
        }
    }
}

/// Two circles through rows, one row twice, one outlier.
fn exact() -> Case {
    let (one, two) = (circle([0.0, 0.0], 1.0, 40), circle([6.0, 0.5], 1.5, 60));
    let mut rows: Loop = one.iter().chain(&two).copied().collect();
    rows.extend([[0.3, 0.1], one[7]]);
    let curves = vec![component(one, true, Some(0)), component(two, true, Some(40))];
    let mut case = Case::of(curves, rows, vec![100], 0.0);
    let certificate = &mut case.solution.certificate;
    (certificate.certified, certificate.noise_ratio, certificate.sampling_ratio) =
        (true, 0.0, 0.09);
    case
}

/// Two circles through a band of noise, with the places of all rows.
fn noisy() -> Case {
    let (one, two) = (circle([0.0, 0.0], 1.0, 80), circle([6.0, 0.5], 1.5, 120));
    let mut rows = vec![];
    for k in 0..400u64 {
        // Multiples of an irrational number are even.
        let off = 0.05 * ((k as f64 * 0.618_033_988_75).fract() * 2.0 - 1.0);
        rows.push(on_circle([0.0, 0.0], 1.0 + off, (k as f64 + 0.3) / 400.0));
        rows.push(on_circle([6.0, 0.5], 1.5 + off, (k as f64 + 0.7) / 400.0));
    }
    rows.push([1.5, 1.9]);
    let curves = vec![component(one, true, None), component(two, true, None)];
    let mut case = Case::of(curves, rows, vec![800], 0.055);
    let places = case.rows.iter().map(|p| nearest(&case.solution.answer, *p)).collect();
    case.solution.answer.places = places;
    let certificate = &mut case.solution.certificate;
    (certificate.certified, certificate.noise_ratio, certificate.sampling_ratio) =
        (true, 0.08, 0.06);
    case
}

/// The place next to a point, by looking at every edge.
fn nearest(curve: &Curve, p: [f64; 2]) -> Place {
    let mut best = (f64::INFINITY, Place(0, 0.0));
    for (number, one) in curve.curves.iter().enumerate() {
        for k in 0..one.vertices.len() {
            let (a, b) = (one.vertices[k], one.vertices[(k + 1) % one.vertices.len()]);
            let (e, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
            let t = (e[0] * w[0] + e[1] * w[1]) / (e[0] * e[0] + e[1] * e[1]);
            let t = t.clamp(0.0, 1.0);
            let far = (w[0] - t * e[0]).hypot(w[1] - t * e[1]);
            if far < best.0 {
                best = (far, Place(number as u32, k as f64 + t));
            }
        }
    }
    best.1
}

#[test]
fn curves_by_hand_are_accepted() {
    for (name, case) in [("exact", exact()), ("noisy", noisy())] {
        let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(verdict.certified && verdict.is_simple && verdict.doubt.is_none(), "{name}");
    }
    assert_eq!(exact().check().unwrap().band, 0.0);
    let verdict = noisy().check().unwrap();
    assert!((0.05..0.0525).contains(&verdict.band), "{verdict:?}");
    // Of a circle φ is its radius, a little less for the polygon.
    let ratio = exact().check().unwrap().sampling_ratio;
    assert!((ratio / (std::f64::consts::PI / 40.0) - 1.0).abs() < 0.05, "{ratio}");
}

/// Behind many short edges a long one: the number of its vertex takes digits of the share.
#[test]
fn places_on_long_edges_far_along_are_accepted() {
    let arc = |k: u32| [f64::from(k) * 1e-4, -1e-9 * f64::from(k * k)];
    let mut vertices: Loop = (0..5000).map(arc).collect();
    vertices.push([0.3, 1.0]);
    let on = |share: f64| [0.3 * (1.0 - share), 1.0 - share];
    let rows: Loop = (1..400).map(|k| on(f64::from(k) / 400.1)).collect();
    let case = |rows: Loop, moved: f64| {
        let mut case = Case::of(vec![component(vertices.clone(), true, None)], rows, vec![], 1e-9);
        let share = |k: u32| 5000.0 + f64::from(k) / 400.1 + moved;
        case.solution.answer.places = (1..400).map(|k| Place(0, share(k))).collect();
        case
    };
    case(rows.clone(), 0.0).check().unwrap();
    assert!(case(rows, 1e-11).check().is_err());
}

#[test]
fn degenerate_inputs_are_judged() {
    let none = Case::of(vec![], vec![], vec![], 0.0);
    assert_eq!(none.check().unwrap().doubt, Some(CurveDoubt::Empty));
    let outlier = Case::of(vec![], vec![[1.0, 2.0]], vec![0], 0.0);
    assert_eq!(outlier.check().unwrap().doubt, Some(CurveDoubt::Empty));
    let point =
        Case::of(vec![component(vec![[1.0, 2.0]], false, Some(0))], vec![[1.0, 2.0]], vec![], 0.0);
    assert_eq!(point.check().unwrap().doubt, Some(CurveDoubt::Open { curve: 0 }));
    for scale in [1e-300, 1e-150, 1.0, 1e150, 1e300] {
        let line: Loop = (0..5).map(|k| [f64::from(k) * scale, f64::from(k) * scale]).collect();
        let path =
            Case::of(vec![component(line.clone(), false, Some(0))], line.clone(), vec![], 0.0);
        assert!(path.check().unwrap().is_simple, "{scale}");
        let ends = component(vec![line[0], line[4]], false, None);
        let fitted = Case::of(vec![ends], line, vec![], 1e-12 * scale);
        assert!(fitted.check().unwrap().band <= 1e-12 * scale, "{scale}");
    }
    for exponent in [-320, -300, 300, 320] {
        let scale = 10f64.powi(exponent.clamp(-300, 300));
        let mut case = exact();
        let all = case.solution.answer.curves.iter_mut().flat_map(|one| one.vertices.iter_mut());
        all.chain(&mut case.rows).flatten().for_each(|x| *x *= scale);
        let Case { solution, rows } = case;
        let again = Case::of(solution.answer.curves, rows, vec![100], 0.0);
        assert!(again.check().unwrap().certified, "{scale}: {:?}", again.check());
    }
}

/// The name of a change to a valid case, and whether it is refused for the right reason.
type Damage = (&'static str, fn(&mut Case, usize), fn(&Violation) -> bool);

/// Damage that takes a number, to be done in many places.
const DAMAGE: [Damage; 22] = [
    (
        "hash",
        |c, k| c.solution.certificate.points_hash = PointsHash(k as u64),
        |v| matches!(v, Violation::Hash { .. }),
    ),
    ("points", |c, k| at(&mut c.rows, k)[0] += 1e-9, |v| matches!(v, Violation::Hash { .. })),
    (
        "infinite vertex",
        |c, k| vertex(c, k)[k % 2] = f64::INFINITY,
        |v| matches!(v, Violation::Number { .. }),
    ),
    (
        "band",
        |c, _| c.solution.certificate.band = f64::NAN,
        |v| matches!(v, Violation::Number { .. }),
    ),
    (
        "ratio",
        |c, _| c.solution.certificate.noise_ratio = -1.0,
        |v| matches!(v, Violation::Number { .. }),
    ),
    (
        "few vertices",
        |c, k| curve(c, k).vertices.truncate(2),
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Vertices { .. })),
    ),
    (
        "equal neighbors",
        |c, k| {
            let one = curve(c, k);
            let (at, n) = (k % one.vertices.len(), one.vertices.len());
            one.vertices[(at + 1) % n] = one.vertices[at];
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Repeated { .. })),
    ),
    (
        "crossing",
        |c, k| {
            let one = curve(c, k);
            let n = one.vertices.len();
            let at = k % (n - 5);
            one.vertices.swap(at, at + 3);
            if !one.rows.is_empty() {
                one.rows.swap(at, at + 3);
            }
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Crossing { .. })),
    ),
    (
        "curves that touch",
        |c, k| {
            let p = c.solution.answer.curves[0].vertices[k % 40];
            c.solution.answer.curves.push(component(vec![p], false, None));
            if !c.solution.answer.curves[0].rows.is_empty() {
                let row = c.solution.answer.curves[0].rows[k % 40];
                c.solution.answer.curves[2].rows = vec![row];
            }
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Crossing { .. })),
    ),
    (
        "outlier that is not",
        |c, k| c.solution.answer.outliers.push(900 + k as u64),
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Outlier { .. })),
    ),
    (
        "outliers twice",
        |c, _| {
            let row = c.solution.answer.outliers[0];
            c.solution.answer.outliers.push(row);
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Outlier { .. })),
    ),
    (
        "outlier forgotten",
        |c, _| c.solution.answer.outliers.clear(),
        |v| {
            curve_violation(v, |v| {
                matches!(v, CurveViolation::NoVertex { .. } | CurveViolation::OutsideBand { .. })
            })
        },
    ),
    (
        "a curve forgotten",
        |c, k| {
            c.solution.answer.places.clear();
            c.solution.answer.curves.remove(k % 2);
        },
        |v| {
            curve_violation(v, |v| {
                matches!(v, CurveViolation::NoVertex { .. } | CurveViolation::OutsideBand { .. })
            })
        },
    ),
    (
        "sampling ratio",
        |c, k| c.solution.certificate.sampling_ratio *= 0.01 * (k % 10) as f64,
        |v| {
            curve_violation(v, |v| {
                matches!(v, CurveViolation::Figure { figure: "sampling ratio", .. })
            })
        },
    ),
    (
        "many outliers",
        |c, _| {
            c.solution.answer.outliers = (40 * 5..c.rows.len() as u64).collect();
            if !c.solution.answer.curves[0].rows.is_empty() {
                c.solution.answer.outliers = (0..c.rows.len() as u64).collect();
            }
        },
        |v| {
            curve_violation(v, |v| {
                let is_vertex = matches!(v, CurveViolation::Row { .. });
                is_vertex
                    || matches!(
                        v,
                        CurveViolation::NotCertified { .. } | CurveViolation::Figure { .. }
                    )
            })
        },
    ),
    (
        "an end",
        |c, k| {
            c.solution.answer.places.clear();
            curve(c, k).closed = false;
        },
        |v| {
            curve_violation(v, |v| {
                matches!(v, CurveViolation::Figure { .. } | CurveViolation::OutsideBand { .. })
            })
        },
    ),
    (
        "a tour of two",
        |c, _| {
            c.solution.certificate.tour = Some(TourBound { potentials: vec![], lower: 0.0 });
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::NoTour { .. })),
    ),
    (
        "mixed",
        |c, k| {
            let one = curve(c, k);
            one.rows =
                if one.rows.is_empty() { (0..one.vertices.len() as u64).collect() } else { vec![] };
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::Mixed { .. })),
    ),
    (
        "place on no curve",
        |c, k| {
            c.solution.answer.places = vec![Place(0, 0.0); c.rows.len()];
            at(&mut c.solution.answer.places, k).0 = 7;
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::NoPlace { .. })),
    ),
    (
        "place beyond the curve",
        |c, k| {
            c.solution.answer.places = vec![Place(0, 0.0); c.rows.len()];
            at(&mut c.solution.answer.places, k).1 = [-0.5, 200.0, f64::NAN][k % 3];
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::NoPlace { .. })),
    ),
    (
        "place elsewhere",
        |c, k| {
            let answer = &c.solution.answer;
            let mut places: Vec<Place> = c.rows.iter().map(|p| nearest(answer, *p)).collect();
            let place = at(&mut places, k);
            place.1 = (place.1 + 11.0) % 40.0;
            c.solution.answer.places = places;
        },
        |v| curve_violation(v, |v| matches!(v, CurveViolation::FarPlace { .. })),
    ),
    (
        "places of some",
        |c, k| c.solution.answer.places = vec![Place(0, 0.0); 1 + k % 50],
        |v| matches!(v, Violation::Length { .. }),
    ),
];

fn at<T>(list: &mut [T], k: usize) -> &mut T {
    let n = list.len();
    &mut list[k % n]
}

fn curve(case: &mut Case, k: usize) -> &mut CurveComponent {
    at(&mut case.solution.answer.curves, k)
}

fn vertex(case: &mut Case, k: usize) -> &mut [f64; 2] {
    at(&mut curve(case, k).vertices, k / 2)
}

fn curve_violation(violation: &Violation, is_right: fn(&CurveViolation) -> bool) -> bool {
    matches!(violation, Violation::Curve(violation) if is_right(violation))
}

#[test]
fn damage_is_refused_for_the_right_reason() {
    let mut refused = 0;
    for valid in [exact(), noisy()] {
        for (name, change, is_right) in DAMAGE {
            for k in 0..60 {
                let mut case = valid.clone();
                change(&mut case, k * 7 + 1);
                let violation = case.check().expect_err(name);
                assert!(is_right(&violation), "{name}, {k}: {violation}");
                refused += 1;
            }
        }
    }
    assert!(refused >= 2500);
}

#[test]
fn rows_of_vertices_are_looked_at() {
    for k in 0..100 {
        let mut case = exact();
        let one = curve(&mut case, k);
        let n = one.rows.len();
        one.rows[k % n] = [100, 1_000, one.rows[(k + 1) % n]][k % 3];
        let violation = case.check().unwrap_err();
        assert!(
            curve_violation(&violation, |v| matches!(v, CurveViolation::Row { .. })),
            "{violation}"
        );
    }
}

#[test]
fn a_band_too_narrow_by_an_ulp_is_refused() {
    let mut case = noisy();
    let band = case.check().unwrap().band;
    case.solution.certificate.band = band;
    assert_eq!(case.check().unwrap().band, band);
    case.solution.certificate.band = band.next_down();
    let violation = case.check().unwrap_err();
    assert!(curve_violation(&violation, |v| matches!(v, CurveViolation::OutsideBand { .. })));
}

#[test]
fn tours_are_judged_by_their_potentials() {
    let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let tour = |vertices: &Loop, lower: f64| {
        let mut case = Case::of(
            vec![component(vertices.clone(), true, Some(0))],
            vertices.clone(),
            vec![],
            0.0,
        );
        case.solution.certificate.tour = Some(TourBound { potentials: vec![0.0; 4], lower });
        case
    };
    let verdict = tour(&square, 3.999).check().unwrap();
    assert!(verdict.tour_gap.unwrap() < 3e-4 && verdict.is_simple);
    let violation = tour(&square, 4.001).check().unwrap_err();
    assert!(curve_violation(&violation, |v| matches!(v, CurveViolation::TourBound { .. })));
    // A tour may cross itself; it is told.
    let crossed = vec![square[0], square[2], square[1], square[3]];
    let verdict = tour(&crossed, 3.999).check().unwrap();
    assert!(!verdict.is_simple && matches!(verdict.doubt, Some(CurveDoubt::Crossing { .. })));
    assert!((verdict.tour_gap.unwrap() - ((2.0 + 8f64.sqrt()) / 3.999 - 1.0)).abs() < 1e-9);
}

#[test]
fn documents_survive_json_and_its_damage() {
    for case in [exact(), noisy()] {
        let text = case.solution.to_json();
        let Ok(AnySolution::Curve(again)) = AnySolution::from_json(&text) else { panic!("{text}") };
        assert_eq!(again, case.solution);
        let flat: Vec<f64> = case.rows.iter().flatten().copied().collect();
        let points = Points::new(&flat, 2).unwrap();
        let verdict = AnySolution::Curve(again).check(&points, &Monitor::silent()).unwrap();
        assert!(matches!(verdict, AnyVerdict::Curve(verdict) if verdict.certified));
        for cut in (0..text.len()).step_by(97) {
            assert!(AnySolution::from_json(&text[..cut]).is_err());
        }
        for (from, to) in [
            ("\"closed\": true", "\"closed\": 1"),
            ("\"band\"", "\"bend\""),
            ("\"curves\"", "\"x\""),
        ] {
            assert!(AnySolution::from_json(&text.replacen(from, to, 1)).is_err(), "{from}");
        }
        // Whatever is read, the checker does not panic over it.
        for k in 0..300 {
            let digits: Vec<usize> =
                text.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(at, _)| at).collect();
            let at = digits[(k * 7919) % digits.len()];
            let changed = format!("{}{}{}", &text[..at], k % 10, &text[at + 1..]);
            if let Ok(any) = AnySolution::from_json(&changed) {
                let _ = any.check(&points, &Monitor::silent());
            }
        }
    }
}

/// Rows 1e-152 off a small circle, beside which one vertex is moved out to 1e308: when all are scaled alike, the small
/// coordinates underflow, and the distances with them.
#[test]
fn no_band_is_narrow_because_coordinates_underflow() {
    let unit = 1e-150;
    let small = circle([0.0, 0.0], unit, 40);
    let mut rows = small.clone();
    rows[17] = [rows[17][0] * 1.01, rows[17][1] * 1.01];
    let mut vertices = small;
    vertices[3][0] = 1e308;
    let mut case = Case::of(vec![component(vertices, true, None)], rows, vec![], 1e-150);
    match case.check() {
        Ok(verdict) => assert!(verdict.band >= 1e-152, "{verdict:?}"),
        Err(violation) => assert!(violation.to_string().contains("band"), "{violation}"),
    }
    case.solution.certificate.band = 0.0;
    assert!(case.check().is_err());
}

/// A row far out widens the tolerance of no place but its own.
#[test]
fn places_are_near_their_rows_beside_a_far_outlier() {
    let mut case = noisy();
    case.rows.push([1e16, 3.3e15]);
    let far = nearest(&case.solution.answer, [1e16, 3.3e15]);
    case.solution.answer.places.push(far);
    case.solution.answer.outliers.push(801);
    let flat: Vec<f64> = case.rows.iter().flatten().copied().collect();
    let points = Points::new(&flat, 2).unwrap();
    case.solution.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    case.check().unwrap();
    case.solution.answer.places.swap(10, 300);
    match case.check() {
        Err(Violation::Curve(CurveViolation::FarPlace { row: 10, .. })) => {}
        other => panic!("{other:?}"),
    }
}

/// A bound of 0 proves nothing of a tour, whatever its sign.
#[test]
fn a_lower_bound_of_zero_leaves_a_tour_without_a_gap() {
    let rows: Loop = (0..8).map(|k| [f64::from(k % 4) * 1.5, f64::from(k / 4)]).collect();
    let tour: Loop = [0, 5, 2, 7, 1, 4, 3, 6].into_iter().map(|k| rows[k]).collect();
    let numbers: Vec<u64> = vec![0, 5, 2, 7, 1, 4, 3, 6];
    let mut component = component(tour, true, Some(0));
    component.rows = numbers;
    let mut case = Case::of(vec![component], rows, vec![], 0.0);
    for lower in [0.0, -0.0] {
        case.solution.certificate.tour = Some(TourBound { potentials: vec![0.0; 8], lower });
        let gap = case.check().unwrap().tour_gap.unwrap();
        assert_eq!(gap, f64::INFINITY, "{lower:?}");
    }
}
