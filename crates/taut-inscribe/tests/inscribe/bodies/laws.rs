//! What does not change the bodies, or changes them in a known way.

use taut_inscribe::BodiesOptions;

use super::shapes::{Mesh, options, proved, solve, wavy};

fn covered(mesh: &Mesh, k: usize) -> u64 {
    let options = BodiesOptions { count: 3, events: 6000, ..options(k) };
    proved(mesh, &options).0.trace.counters["searched_covered"]
}

#[test]
fn more_directions_cover_no_less() {
    for mesh in [wavy(20, None), wavy(9, Some(0.125))] {
        let [six, fourteen, eighteen, all] = [6, 14, 18, 26].map(|k| covered(&mesh, k));
        assert!(six <= fourteen && six <= eighteen, "{six} {fourteen} {eighteen}");
        assert!(fourteen <= all && eighteen <= all, "{fourteen} {eighteen} {all}");
    }
}

#[test]
fn answers_depend_on_mesh_and_options_alone() {
    let mesh = wavy(14, None);
    let options = BodiesOptions { count: 2, ..options(18) };
    let found = solve(&mesh, &options).unwrap();
    for threads in [1, 2, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let again = pool.install(|| solve(&mesh, &options).unwrap());
        assert_eq!(again.to_json(), found.to_json(), "{threads} threads");
    }
    let other = solve(&mesh, &BodiesOptions { seed: 1, ..options }).unwrap();
    assert_ne!(other.answer, found.answer);
}

#[test]
fn turned_triangles_and_quarter_turns_are_proved_too() {
    let mesh = wavy(14, Some(1.0 / 64.0));
    let options = BodiesOptions { count: 2, events: 4000, ..options(18) };
    let (found, verdict) = proved(&mesh, &options);
    // Inside does not depend on the orientation; neither do events.
    let inverted: Mesh = mesh.iter().map(|&[a, b, c]| [b, a, c]).collect();
    assert_eq!(proved(&inverted, &options).0.answer, found.answer);
    let turns: [fn([f64; 3]) -> [f64; 3]; 3] =
        [|[x, y, z]| [y, -x, z], |[x, y, z]| [-y, z, -x], |[x, y, z]| [z, x, y]];
    for turn in turns {
        let turned: Mesh = mesh.iter().map(|t| t.map(turn)).collect();
        let (_, other) = proved(&turned, &options);
        // The search starts elsewhere; bodies of half the size would mean that it failed.
        assert!(other.volume_lower > 0.5 * verdict.volume_lower, "{other:?}, {verdict:?}");
    }
    let mut permuted = mesh.clone();
    permuted.reverse();
    permuted.iter_mut().for_each(|t| t.rotate_left(1));
    let (_, other) = proved(&permuted, &options);
    assert!(other.volume_lower > 0.5 * verdict.volume_lower, "{other:?}, {verdict:?}");
}

#[test]
fn disjoint_bodies_are_proved_disjoint() {
    for k in [6, 18, 26] {
        let options = BodiesOptions { count: 5, disjoint: true, events: 6000, ..options(k) };
        let (found, verdict) = proved(&wavy(16, None), &options);
        assert!(verdict.disjoint && verdict.bodies >= 4, "{verdict:?}");
        let pairs = found.answer.bodies.len() * (found.answer.bodies.len() - 1) / 2;
        assert_eq!(found.certificate.pairs.len(), pairs);
    }
}
