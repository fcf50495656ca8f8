//! An id that is no row is named by the checker by its place, however far from there it is met first.

use taut_certify::{CheckError, MeshViolation, NO_NEIGHBOR, Solution, Triangulation, Violation};
use taut_delaunay::{DelaunayOptions, Plane};
use taut_points::{Distribution, Monitor, Points, generate};

fn violation(solution: &Solution<Triangulation>, points: &Points<'_, f64>) -> MeshViolation {
    match solution.check(points) {
        Err(CheckError::Rejected(Violation::Mesh(violation))) => violation,
        other => panic!("{other:?}"),
    }
}

/// A facet of an earlier simplex leads to the wrong id. It is met as the vertex beyond that facet, and where the neighbor
/// does not fit, by a search for the facet; an earlier simplex that is wrong as well is not named in its place.
#[test]
fn the_first_wrong_id_is_named_wherever_it_is_met() {
    const N: usize = 8000;
    let values: Vec<f64> = generate(Distribution::Uniform, N, 2, 7).unwrap();
    let points = Points::new(&values, 2).unwrap();
    let options = DelaunayOptions::default();
    let built = Plane::build(&points, &options).unwrap();
    let right = built.solution(&points, &Monitor::silent()).unwrap();
    let neighbors = right.certificate.neighbors.as_chunks::<3>().0.to_vec();
    let simplices = neighbors.len();
    assert!(simplices > 10_000);
    let mut met = 0;
    for (t, of_t) in neighbors.iter().enumerate() {
        // Far apart: the later simplex is checked with others, and by another thread.
        let Some(&u) = of_t.iter().find(|&&u| u != NO_NEIGHBOR && u as usize > t + 1500) else {
            continue;
        };
        let u = u as usize;
        let opposite = neighbors[u].iter().position(|&n| n as usize == t).unwrap();
        for id in [u32::MAX, N as u32] {
            let expected = MeshViolation::Id { list: "simplices", position: u, id };
            let mut wrong = right.clone();
            wrong.answer.simplices[3 * u + opposite] = id;
            assert_eq!(violation(&wrong, &points), expected);
            // u names t twice.
            let mut twice = wrong.clone();
            twice.certificate.neighbors[3 * u + (opposite + 1) % 3] = t as u32;
            assert_eq!(violation(&twice, &points), expected);
            // The first simplex is turned over.
            wrong.answer.simplices.swap(0, 1);
            assert_eq!(violation(&wrong, &points), expected);
        }
        met += 1;
        if met == 12 {
            break;
        }
    }
    assert_eq!(met, 12);
}
