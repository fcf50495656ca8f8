//! Damaged surfaces and certificates: every one must be refused, also when the rest was made to fit.

use surface::{Case, both, cube, reversed, sphere, tetrahedron};
use taut_certify::{AnySolution, Apex, Surface, SurfaceMode};
use taut_points::Points;

use crate::surface;

/// Surfaces of all kinds, with rows unused for every reason.
fn valid() -> Vec<(&'static str, Case)> {
    let mut rich = both(&sphere([0.0; 3], 4.0, 1), &reversed(sphere([0.5, 0.25, 0.0], 1.5, 1)));
    let twice = rich.rows[3];
    // One between the spheres, two within the inner one.
    rich.rows.extend([twice, [2.5, 0.5, 0.25], [0.625, 0.25, -0.125], [0.5, 0.25, 0.125], twice]);
    let first = rich.rows.len() as u32 - 5;
    rich.answer().unused.interior = vec![first + 1];
    rich.answer().unused.outliers = vec![first + 2];
    rich.fit();
    // The smallest balls of the outer sphere reach the inner one.
    rich.certificate().apexes[..32].fill(Apex::Hull);
    let mut moved = cube();
    moved.answer().vertices = moved.rows.iter().map(|p| p.map(|x| x + 0.125)).collect();
    moved.certificate().displacement = 0.125 * 3f64.sqrt();
    let mut alpha = tetrahedron();
    alpha.certificate().mode = SurfaceMode::Alpha { radius: 1.0 };
    alpha.answer().triangles.pop();
    alpha.certificate().apexes.pop();
    alpha.fit();
    let all = vec![
        ("tetrahedron", tetrahedron()),
        ("cube", cube()),
        ("spheres", rich),
        ("moved", moved),
        ("alpha", alpha),
    ];
    for (name, case) in &all {
        let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(verdict.certified, "{name}: {:?}", verdict.doubt);
    }
    all
}

/// Takes copies of a valid case and changes them.
struct Damage<'a> {
    name: &'static str,
    case: &'a Case,
    count: usize,
}

impl Damage<'_> {
    fn refused(&mut self, kind: &str, change: impl FnOnce(&mut Case)) {
        let mut case = self.case.clone();
        change(&mut case);
        assert_ne!(case, *self.case, "{} {kind}: nothing was changed", self.name);
        assert!(case.check().is_err(), "{}: {kind} is accepted", self.name);
        self.count += 1;
    }
}

#[test]
fn triangles_that_are_changed_are_refused() {
    for (name, case) in valid() {
        let mut damage = Damage { name, case: &case, count: 0 };
        let triangles = case.solution.answer.triangles.clone();
        let rows = case.rows.len() as u32;
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            damage.refused("a triangle taken away", |case| {
                case.answer().triangles.remove(t);
                case.certificate().apexes.remove(t);
            });
            damage.refused("a triangle turned over", |case| case.answer().triangles[t] = [a, c, b]);
            damage.refused("a triangle turned over, with its topology", |case| {
                case.answer().triangles[t] = [a, c, b];
                case.topology();
                // Alone it has no neighbor to disagree with.
                assert!(!case.solution.answer.topology.is_oriented());
            });
            damage.refused("a triangle twice", |case| {
                case.answer().triangles.push([b, c, a]);
                case.certificate().apexes.push(Apex::Gabriel);
                case.topology();
            });
            damage.refused("a vertex twice", |case| case.answer().triangles[t] = [a, b, a]);
            damage.refused("a corner that is no row", |case| case.answer().triangles[t][2] = rows);
            damage.refused("another corner", |case| case.answer().triangles[t][1] = (b + 1) % rows);
        }
        assert!(damage.count > 6 * triangles.len());
    }
}

#[test]
fn numbers_that_are_changed_are_refused() {
    for (name, case) in valid() {
        let mut damage = Damage { name, case: &case, count: 0 };
        type Change = fn(&mut Surface);
        let changes: [(&str, Change); 17] = [
            ("vertices", |s| s.topology.vertices += 1),
            ("edges", |s| s.topology.edges -= 1),
            ("boundary edges", |s| s.topology.boundary_edges += 1),
            ("boundary loops", |s| s.topology.boundary_loops += 1),
            ("non-manifold edges", |s| s.topology.non_manifold_edges += 1),
            ("non-manifold vertices", |s| s.topology.non_manifold_vertices += 1),
            ("inconsistent edges", |s| s.topology.inconsistent_edges += 1),
            ("Euler characteristic", |s| s.topology.euler_characteristic -= 2),
            ("genus", |s| s.topology.genus = Some(1)),
            ("no genus", |s| s.topology.genus = None),
            ("components", |s| s.topology.components.push(s.topology.components[0])),
            ("first triangle", |s| s.topology.components[0].first_triangle += 1),
            ("vertices of a component", |s| s.topology.components[0].vertices += 1),
            ("triangles of a component", |s| s.topology.components[0].triangles += 1),
            ("loops of a component", |s| s.topology.components[0].boundary_loops += 1),
            ("orientable", |s| s.topology.components[0].orientable = false),
            ("genus of a component", |s| s.topology.components[0].genus = Some(7)),
        ];
        for (what, change) in changes {
            damage.refused(what, |case| change(case.answer()));
        }
        damage.refused("edges of a component", |case| {
            case.answer().topology.components[0].edges += 1
        });
        damage.refused("embedded", |case| case.certificate().embedded = false);
        damage.refused("outward", |case| case.certificate().outward = false);
        damage.refused("displacement", |case| case.certificate().displacement += 1e-6);
        damage.refused("no displacement", |case| case.certificate().displacement = -1.0);
        damage.refused("hash", |case| case.certificate().points_hash.0 ^= 1);
        damage.refused("a row moved", |case| case.rows[1][2] += 0.5);
        damage
            .refused("radius", |case| case.certificate().mode = SurfaceMode::Alpha { radius: 0.5 });
        damage.refused("no radius", |case| {
            case.certificate().mode = SurfaceMode::Alpha { radius: f64::NAN };
        });
        damage.refused("too few apexes", |case| _ = case.certificate().apexes.pop());
        damage.refused("too many apexes", |case| case.certificate().apexes.push(Apex::Hull));
        if !case.solution.answer.topology.is_closed() {
            damage.refused("closed", |case| case.certificate().mode = SurfaceMode::Closed);
        }
        if !case.solution.answer.vertices.is_empty() {
            damage.refused("one vertex less", |case| _ = case.answer().vertices.pop());
            damage.refused("no vertices", |case| case.answer().vertices.clear());
            damage.refused("a vertex moved", |case| case.answer().vertices[2][0] -= 0.5);
            damage.refused("no number", |case| case.answer().vertices[2][0] = f64::INFINITY);
        }
    }
}

/// An apex is accepted just where exact arithmetic finds its ball empty.
#[test]
fn apexes_that_are_changed_are_judged_again() {
    for (name, case) in valid() {
        let places = case.places();
        let unused = &case.solution.answer.unused;
        let is_site = |row: &u32| {
            !unused.outliers.contains(row) && !unused.duplicates.iter().any(|pair| pair[0] == *row)
        };
        let sites: Vec<u32> = (0..case.rows.len() as u32).filter(is_site).collect();
        let (mut refused, step) = (0, case.rows.len() / 6 + 1);
        for t in (0..case.solution.answer.triangles.len()).step_by(step) {
            let rows = (0..case.rows.len() as u32 + 1).step_by(step).map(Apex::Row);
            for apex in rows.chain([Apex::Hull, Apex::Gabriel]) {
                let mut changed = case.clone();
                changed.certificate().apexes[t] = apex;
                let triangle = case.solution.answer.triangles[t];
                let expected = surface::oracle::is_empty(&places, &sites, triangle, apex);
                assert_eq!(changed.check().is_ok(), expected, "{name}: triangle {t}, {apex:?}");
                refused += usize::from(!expected);
            }
        }
        assert!(refused > 0, "{name}");
    }
}

#[test]
fn lists_that_are_changed_are_refused() {
    let (name, case) = valid().swap_remove(2);
    let mut damage = Damage { name, case: &case, count: 0 };
    let unused = case.solution.answer.unused.clone();
    assert_eq!((unused.duplicates.len(), unused.unreferenced.len()), (2, 1));
    let (inside, outlier, other) = (unused.interior[0], unused.outliers[0], unused.unreferenced[0]);
    damage.refused("a duplicate less", |case| _ = case.answer().unused.duplicates.pop());
    damage.refused("duplicates in another order", |case| case.answer().unused.duplicates.reverse());
    damage.refused("a duplicate twice", |case| {
        case.answer().unused.duplicates[1] = unused.duplicates[0]
    });
    damage.refused("another first", |case| case.answer().unused.duplicates[0][1] += 1);
    damage.refused("not the first", |case| {
        case.answer().unused.duplicates[1][1] = unused.duplicates[0][0]
    });
    damage.refused("a duplicate that is none", |case| {
        case.answer().unused.unreferenced.clear();
        case.answer().unused.duplicates.insert(1, [other, 0]);
    });
    damage.refused("a duplicate as an outlier", |case| {
        let [row, _] = case.answer().unused.duplicates.remove(1);
        case.answer().unused.outliers.push(row);
    });
    damage.refused("a duplicate as interior", |case| {
        let [row, _] = case.answer().unused.duplicates.remove(0);
        case.answer().unused.interior.insert(0, row);
    });
    damage.refused("a row of no list", |case| case.answer().unused.unreferenced.clear());
    damage.refused("a row twice", |case| case.answer().unused.unreferenced.push(other));
    damage
        .refused("a row of two lists", |case| case.answer().unused.unreferenced.insert(0, outlier));
    damage.refused("a vertex", |case| case.answer().unused.unreferenced.insert(0, 0));
    damage.refused("no row", |case| case.answer().unused.unreferenced.push(1000));
    damage.refused("inside that is outside", |case| {
        case.answer().unused.unreferenced.clear();
        case.answer().unused.interior.push(other);
    });
    // What is inside may be left without saying so, and the only outlier is in no ball.
    let mut less = case.clone();
    less.answer().unused.interior.clear();
    less.answer().unused.outliers.clear();
    less.answer().unused.unreferenced = vec![inside, outlier, other];
    assert!(less.check().unwrap().certified);
    // A row in the cavity is not inside.
    let mut cavity = case.clone();
    cavity.rows[inside as usize] = [0.5, 0.5, 0.25];
    cavity.hash();
    assert!(cavity.check().is_err());
}

/// Whatever becomes of a document, it is read or refused, and judged or refused, without a panic.
#[test]
fn documents_that_are_damaged_do_no_harm() {
    for (name, case) in valid() {
        let text = case.solution.to_json();
        let points = Points::new(case.rows.as_flattened(), 3).unwrap();
        let mut accepted = 0;
        for at in (0..text.len()).step_by(7) {
            for with in ["0", "9", "-", "]", "1e9"] {
                let changed = format!("{}{with}{}", &text[..at], &text[at + 1..]);
                if let Ok(AnySolution::Surface(read)) = AnySolution::from_json(&changed) {
                    let same = read == case.solution;
                    let told = read.trace != case.solution.trace;
                    let is_fine = read.check(&points).is_ok();
                    accepted += usize::from(is_fine && !same && !told);
                }
            }
        }
        // Another apex with an empty ball, or another radius that is large enough.
        assert!(accepted < 40, "{name}: {accepted}");
    }
}
