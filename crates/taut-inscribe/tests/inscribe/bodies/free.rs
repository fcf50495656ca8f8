//! Bodies whose facets have any direction.

use taut_inscribe::{BodiesOptions, BodyShape, Objective};

use super::shapes::{Mesh, cuboid, free, hull, l_shape, octahedron, options, proved, wavy};
use crate::test_length::long_or;

/// A mesh turned by a rotation of whole numbers over 9, and shifted.
fn turned(mesh: &Mesh) -> Mesh {
    let rows = [[1.0, 8.0, 4.0], [-4.0, 4.0, -7.0], [-8.0, -1.0, 4.0]];
    let place =
        |p: [f64; 3]| rows.map(|row| (row[0] * p[0] + row[1] * p[1] + row[2] * p[2]) / 9.0 + 0.3);
    mesh.iter().map(|t| t.map(place)).collect()
}

#[test]
fn convex_meshes_are_filled_whichever_way_they_are_turned() {
    // The faces of a prism over a hexagon, and others: normals are turned by at most 2⁻¹³, and planes are moved inward by at most
    // 1/256 of their distance from the center. So the volume is at least (1 − 1/200)³ of that of the mesh.
    let least = 0.985;
    let height = 3f64.sqrt() / 2.0;
    let ring =
        [[1.0, 0.0], [0.5, height], [-0.5, height], [-1.0, 0.0], [-0.5, -height], [0.5, -height]];
    let vertices: Vec<[f64; 3]> =
        ring.into_iter().flat_map(|[x, y]| [[x, y, 0.0], [x, y, 2.0]]).collect();
    let turn = |k: usize| (std::f64::consts::TAU * (k as f64 + 0.5) / 6.0).sin_cos();
    let sides = (0..6).map(|k| [turn(k).1, turn(k).0, 0.0]);
    let directions: Vec<[f64; 3]> = sides.chain([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]).collect();
    for (mesh, volume) in [
        (cuboid([0.0; 3], [1.0, 2.0, 3.0]), 6.0),
        (octahedron(), 4.0 / 3.0),
        (hull(&vertices, &directions), 3.0 * height * 2.0),
    ] {
        for mesh in [mesh.clone(), turned(&mesh)].into_iter().skip(long_or(0, 1)) {
            for shape in [BodyShape::Free(256), BodyShape::Free(8)] {
                let (found, verdict) = proved(&mesh, &BodiesOptions { shape, ..free(256) });
                let part = verdict.largest / volume;
                assert!((least..=1.0).contains(&part), "{part} with {shape:?}: {:?}", found.answer);
            }
        }
    }
}

#[test]
fn facets_are_as_few_as_asked_for_and_more_of_them_cover_more() {
    let mesh = wavy(24, None);
    let covered = |facets: usize| {
        let options = BodiesOptions { count: 4, events: 12_000, ..free(facets) };
        let (found, verdict) = proved(&mesh, &options);
        let most = found.answer.bodies.iter().map(|body| body.normals.len()).max().unwrap();
        assert!(most <= facets && verdict.bodies >= 3, "{most} facets, not {facets}");
        assert!(facets > 26 || most > facets / 2, "{most} facets of {facets} allowed");
        found.trace.counters["covered"] as f64 / found.trace.counters["sample_points"] as f64
    };
    let [few, some, many, all] = [8, 16, 40, 256].map(covered);
    println!("covered with 8, 16, 40 and 256 facets: {few:.3} {some:.3} {many:.3} {all:.3}");
    // The search is random; twice as many facets or more are worth more than its luck.
    assert!(few < some && some < all && few < many && few > 0.1, "{few} {some} {many} {all}");
}

#[test]
fn one_facet_separates_each_triangle() {
    let (found, _) = proved(&wavy(20, None), &BodiesOptions { count: 5, ..free(256) });
    assert!(found.certificate.proofs.iter().all(|proof| proof.combined.is_empty()));
    assert!(found.answer.bodies.iter().any(|body| body.normals.len() > 26));
    let own = |at: usize| &found.answer.bodies[at].normals;
    assert!(own(0) != own(1));
}

#[test]
fn disjoint_bodies_are_proved_disjoint() {
    for mesh in [wavy(16, None), l_shape(), turned(&l_shape())] {
        let options = BodiesOptions { count: 6, disjoint: true, ..free(256) };
        let (found, verdict) = proved(&mesh, &options);
        assert!(verdict.disjoint && verdict.bodies >= 2, "{verdict:?}");
        let bodies = found.answer.bodies.len();
        assert_eq!(found.certificate.pairs.len(), bodies * (bodies - 1) / 2);
        let few = BodiesOptions { shape: BodyShape::Free(12), ..options };
        assert!(proved(&mesh, &few).1.bodies >= 2);
    }
}

#[test]
fn answers_depend_on_mesh_and_options_alone() {
    let mesh = wavy(14, None);
    for facets in [16, 256] {
        let options = BodiesOptions { count: 3, ..free(facets) };
        let (found, _) = proved(&mesh, &options);
        for threads in [1, 2, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let again = pool.install(|| proved(&mesh, &options).0);
            assert_eq!(again.to_json(), found.to_json(), "{threads} threads");
        }
        let (other, _) = proved(&mesh, &BodiesOptions { seed: 1, ..options });
        assert_ne!(other.answer, found.answer);
    }
}

#[test]
fn no_more_bodies_are_added_once_the_coverage_is_reached() {
    let mesh = wavy(20, None);
    let bodies = |coverage: f64| {
        let coverage = Some(coverage);
        let (found, _) = proved(&mesh, &BodiesOptions { count: 40, coverage, ..free(256) });
        let counters = &found.trace.counters;
        let part = counters["searched_covered"] as f64 / counters["searched_points"] as f64;
        (part, found.answer.bodies.len())
    };
    let mut before = 0;
    for coverage in [0.1, 0.5, 0.8] {
        let (part, count) = bodies(coverage);
        println!("{count} bodies cover {part:.3}, {coverage} asked for");
        assert!(part >= coverage && (1..40).contains(&count) && count >= before);
        before = count;
    }
    assert!(before > 1);
}

#[test]
fn no_more_bodies_are_added_once_enough_lines_are_hidden() {
    let mesh = wavy(20, None);
    let objective = Objective::Occlusion;
    for base in [free(256), options(18)] {
        let mut before = 0;
        for part in [0.2, 0.6, 0.85] {
            let options =
                BodiesOptions { count: 40, objective, hidden: Some(part), ..base.clone() };
            let (found, _) = proved(&mesh, &options);
            let counters = &found.trace.counters;
            let share = counters["searched_hidden"] as f64 / counters["searched_lines"] as f64;
            let count = found.answer.bodies.len();
            println!("{count} bodies hide {share:.3}, {part} asked for");
            assert!(share >= part && (1..40).contains(&count) && count >= before);
            before = count;
        }
        assert!(before > 1);
    }
}

/// The part of what the search counts that stays, and the number of bodies.
fn merged(mesh: &Mesh, options: &BodiesOptions<'_>) -> (u64, usize) {
    let (found, verdict) = proved(mesh, options);
    let name = match options.objective {
        Objective::Volume => "searched_covered",
        Objective::Occlusion => "searched_hidden",
    };
    assert_eq!(verdict.disjoint, options.disjoint);
    (found.trace.counters[name], found.answer.bodies.len())
}

#[test]
fn merging_leaves_fewer_bodies_that_keep_what_was_asked_for() {
    let mesh = wavy(20, None);
    for base in [free(256), options(18)].into_iter().take(long_or(usize::MAX, 1)) {
        for (objective, disjoint) in
            [(Objective::Volume, false), (Objective::Volume, true), (Objective::Occlusion, false)]
        {
            let base = BodiesOptions {
                count: 24,
                events: long_or(12_000, 1500),
                objective,
                disjoint,
                ..base.clone()
            };
            let (all, many) = merged(&mesh, &base);
            let mut before = many;
            for &loss in long_or(&[0.0, 0.05, 0.3][..], &[0.05, 0.3]) {
                let options = BodiesOptions { merge_within: Some(loss), ..base.clone() };
                let (kept, bodies) = merged(&mesh, &options);
                println!(
                    "{:?} {objective:?}: {many} bodies, {bodies} with a loss of {loss}, {kept} of {all}",
                    base.shape
                );
                assert!(kept as f64 >= (1.0 - loss) * all as f64, "{kept} of {all}");
                assert!((1..=before).contains(&bodies), "{bodies} of {before}");
                before = bodies;
            }
            assert!(before < many / 2, "{before} of {many}");
        }
    }
}

/// Two boxes side by side are one box; bodies around given points stay as they are.
#[test]
fn merging_keeps_bodies_around_points() {
    let mesh = cuboid([0.0; 3], [2.0, 1.0, 1.0]);
    let at = [[0.5; 3], [1.5, 0.5, 0.5]];
    let base = BodiesOptions { at: &at, count: 4, merge_within: Some(0.9), ..options(6) };
    let (found, verdict) = proved(&mesh, &base);
    assert_eq!((verdict.at, found.answer.bodies.len()), (2, 2));
    let none = BodiesOptions { at: &[], ..base };
    assert_eq!(proved(&mesh, &none).1.bodies, 1);
}
