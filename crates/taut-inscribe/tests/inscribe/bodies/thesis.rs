//! The procedure of the thesis.

use taut_inscribe::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, Error, Objective, ThesisSeeds,
};
use taut_points::InputError;

use super::shapes::{Mesh, cuboid, octahedron, options, proved, solve, wavy};

/// All seeds, with and without translation, and merged spheres.
fn variants() -> Vec<BodiesThesisOptions> {
    let usual = BodiesThesisOptions { cells: 16, ..BodiesThesisOptions::default() };
    let mut all = vec![BodiesThesisOptions { merge: true, ..usual }];
    for seeds in ThesisSeeds::ALL {
        for translate in [false, true] {
            all.push(BodiesThesisOptions { seeds, translate, ..usual });
        }
    }
    all
}

fn thesis(directions: usize, variant: BodiesThesisOptions) -> BodiesOptions<'static> {
    BodiesOptions { method: BodiesMethod::Thesis(variant), ..options(directions) }
}

#[test]
fn shapes_that_are_dops_are_filled() {
    let plank = cuboid([-3.0, 1.0, 0.5], [5.0, 2.0, 3.5]);
    let turned: Mesh = plank.iter().map(|&[a, b, c]| [b, a, c]).collect();
    for variant in variants() {
        for (mesh, k, volume) in [
            (&plank, 6, 24.0),
            (&plank, 18, 24.0),
            (&turned, 26, 24.0),
            (&octahedron(), 14, 4.0 / 3.0),
        ] {
            let (found, verdict) = proved(mesh, &thesis(k, variant));
            assert!((verdict.largest - volume).abs() < 1e-3, "{variant:?}, {k}: {verdict:?}");
            assert!(found.answer.disjoint && found.trace.method == "thesis");
        }
    }
}

#[test]
fn packings_are_disjoint_and_the_same_for_all_threads() {
    let mesh = wavy(20, None);
    for variant in variants() {
        let options = BodiesOptions { count: 8, ..thesis(18, variant) };
        let (found, verdict) = proved(&mesh, &options);
        let counters = &found.trace.counters;
        let share = counters["covered"] as f64 / counters["sample_points"] as f64;
        println!("{variant:?}: {} bodies cover {share:.3}", verdict.bodies);
        // A wavy torus; one dop covers about a tenth of it.
        assert!(verdict.disjoint && verdict.bodies >= 5 && share > 0.2, "{verdict:?} {share}");
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let again = pool.install(|| solve(&mesh, &options).unwrap());
            assert_eq!(again.to_json(), found.to_json());
        }
    }
}

#[test]
fn a_coverage_ends_the_search_and_more_seeds_find_more() {
    let mesh = wavy(16, None);
    let with = |count, coverage| {
        let options = thesis(14, BodiesThesisOptions::default());
        let (found, _) = proved(&mesh, &BodiesOptions { count, coverage, ..options });
        (found.answer.bodies.len(), found.trace.counters["searched_covered"])
    };
    let (few, many, part) = (with(3, None), with(20, None), with(1000, Some(0.3)));
    assert!(few.0 == 3 && many.0 > 3 && few.1 < many.1, "{few:?} {many:?}");
    assert!(part.0 < many.0, "{part:?} {many:?}");
}

#[test]
fn options_out_of_range_are_refused_by_name() {
    let mesh = octahedron();
    let usual = BodiesThesisOptions::default();
    let refused = |options: &BodiesOptions<'_>, expected: &str| match solve(&mesh, options) {
        Err(Error::Input(InputError::Option { name, .. })) => assert_eq!(name, expected),
        other => panic!("{expected}: {:?}", other.map(|found| found.answer)),
    };
    refused(&thesis(18, BodiesThesisOptions { cells: 1, ..usual }), "cells");
    refused(&thesis(18, BodiesThesisOptions { votes: 0, ..usual }), "votes");
    let base = thesis(18, usual);
    refused(&BodiesOptions { shape: BodyShape::Free(20), ..base.clone() }, "method");
    refused(&BodiesOptions { objective: Objective::Occlusion, ..base.clone() }, "objective");
    refused(&BodiesOptions { at: &[[0.0; 3]], ..base.clone() }, "at");
    refused(&BodiesOptions { merge_within: Some(0.1), ..base }, "merge_within");
}
