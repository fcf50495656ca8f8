//! Doctored answers and certificates, each of which the checker has to refuse.

use taut_certify::{InscribedBodies, Solution};
use taut_inscribe::BodiesOptions;

use super::shapes::{
    Mesh, cuboid, directions, free, hull, l_shape, octahedron, options, permutations, points,
    proved, wavy,
};

type Bodies = Solution<InscribedBodies>;

/// What the checker says of a changed copy.
fn refused(found: &Bodies, mesh: &Mesh, change: impl FnOnce(&mut Bodies)) -> String {
    let mut changed = found.clone();
    change(&mut changed);
    assert_ne!(&changed, found);
    match changed.check(&points(mesh)) {
        Err(error) => error.to_string(),
        Ok(verdict) => panic!("accepted: {verdict:?}, {:?}", changed.answer),
    }
}

#[test]
fn facets_in_the_faces_of_a_mesh_moved_outward_are_refused() {
    let truncated = hull(&permutations([0.0, 1.0, 2.0]), &directions(&[1, 3]));
    for (mesh, k, tight) in [
        (cuboid([0.0; 3], [1.0; 3]), 6, 0..6),
        (cuboid([0.0; 3], [1.0; 3]), 26, 0..6),
        (octahedron(), 14, 6..14),
        (truncated, 14, 0..14),
        (cuboid([-1.0, 0.0, 2.0], [3.0, 0.5, 4.0]), 18, 0..6),
    ] {
        let (found, _) = proved(&mesh, &options(k));
        for facet in tight {
            let error = refused(&found, &mesh, |f| f.answer.bodies[0].offsets[facet] += 2);
            assert!(error.contains("is not proved to stay out of body 0"), "{error}");
        }
    }
}

#[test]
fn bodies_that_leave_the_mesh_are_refused() {
    let mesh = l_shape();
    let (found, _) = proved(&mesh, &options(6));
    let far = 10 << 23;
    let outside = refused(&found, &mesh, |found| {
        let body = &mut found.answer.bodies[0];
        (body.offsets[0], body.offsets[1]) = (body.offsets[0] + far, body.offsets[1] - far);
        found.certificate.proofs[0].inside[0] += far;
        found.certificate.proofs[0].combined.clear();
    });
    assert_eq!(outside, "body 0 is not inside the mesh");
    let all = refused(&found, &mesh, |found| {
        found.answer.bodies[0].offsets.iter_mut().for_each(|h| *h += far);
    });
    assert!(all.contains("is not proved to stay out of body 0"), "{all}");
    let mut open = mesh.clone();
    open.pop();
    let mut changed = found.clone();
    let hash = taut_points::hash_points(&points(&open), &taut_points::Monitor::silent()).unwrap();
    changed.certificate.points_hash = hash;
    let error = changed.check(&points(&open)).unwrap_err().to_string();
    assert!(error.contains("belongs to an odd number of triangles"), "{error}");
}

#[test]
fn each_field_is_checked() {
    let mesh = octahedron();
    let two = BodiesOptions { count: 2, disjoint: true, ..options(18) };
    let (found, _) = proved(&mesh, &two);
    let refused = |change: fn(&mut Bodies)| refused(&found, &mesh, change);
    let combined = &found.certificate.proofs[0].combined;
    assert!(!combined.is_empty() && found.certificate.pairs.len() == 1);
    for (change, expected) in [
        ((|f| f.answer.exponent += 1) as fn(&mut Bodies), "body 0"),
        (|f| f.answer.exponent = 400, "the exponent is not from -300 to 310"),
        (|f| f.answer.exponent = -200, "more than 2^30 units"),
        (|f| f.answer.origin[1] += 3, "body 0"),
        (|f| f.answer.origin[1] = i64::MIN, "more than 2^30 units"),
        (|f| f.answer.disjoint = false, "the list of pairs has 1"),
        (|f| f.answer.caps.push([0, 1, 2]), "belongs to an odd number of triangles"),
        (|f| f.answer.caps.extend([[0, 1, 2]; 2]), "more than the holes of the mesh need"),
        (|f| f.answer.caps.push([0, 1, 24]), "a corner that the mesh does not have"),
        (|f| f.answer.caps.push([0, 1, u64::MAX]), "a corner that the mesh does not have"),
        (|f| f.answer.at.push([0.9; 3]), "body 0 is not proved to contain the point"),
        (|f| f.answer.at.push([f64::NAN; 3]), "more than 2^30 units"),
        (|f| f.answer.at.extend([[0.0; 3]; 3]), "the list of points given has 3"),
        (|f| drop(f.answer.bodies.pop()), "the list of proofs has 2"),
        (|f| f.answer.bodies[0].offsets.truncate(17), "another number of offsets"),
        (|f| f.answer.bodies[0].normals.truncate(3), "another number of offsets"),
        (|f| f.answer.bodies[0].normals[0] = [0; 3], "common divisor"),
        (|f| f.answer.bodies[0].normals[0] = [2, 0, 0], "common divisor"),
        (|f| f.answer.bodies[0].normals[0] = [1 << 17, 1, 0], "an entry above 2^16"),
        (|f| f.answer.bodies[0].normals[3] = [1, 0, 0], "the normal of an earlier facet"),
        (|f| f.answer.bodies[1].offsets[0] = i64::MAX, "an offset above 2^48"),
        (|f| f.answer.bodies[0].offsets[0] = -(1 << 26), "its interior"),
        (|f| f.answer.bodies[0].volume *= 1.0 + 1e-8, "the volume of body 0"),
        (|f| f.answer.bodies[0].volume = f64::NAN, "the volume of body 0"),
        (|f| f.certificate.proofs[0].inside[2] = 1 << 40, "its interior"),
        (|f| drop(f.certificate.proofs.pop()), "the list of proofs has 1"),
        (|f| drop(f.certificate.proofs[0].combined.pop()), "is not proved to stay out of body 0"),
        (|f| f.certificate.proofs[0].combined.push(vec![]), "names no triangle"),
        (|f| f.certificate.proofs[0].combined.push(vec![99, 0, 1]), "names no triangle"),
        (|f| f.certificate.proofs[0].combined.reverse(), "body 0"),
        (|f| f.certificate.proofs[0].combined[0].truncate(1), "has not from 1 to 4 facets"),
        (|f| f.certificate.proofs[0].combined[0].truncate(2), "has not from 1 to 4 facets"),
        (|f| f.certificate.proofs[0].combined[0][1] = 18, "a facet that does not exist"),
        (|f| f.certificate.proofs[0].combined[0][2] = 0, "from 1 to 2^57"),
        (|f| f.certificate.proofs[0].combined[0][2] = u64::MAX, "from 1 to 2^57"),
        (|f| f.certificate.proofs[0].combined[0][2] += 1 << 40, "does not separate"),
        (|f| f.certificate.pairs[0].truncate(1), "from 1 to 4 facets"),
        (|f| f.certificate.pairs[0].clear(), "from 1 to 4 facets"),
        (|f| f.certificate.pairs[0][0] = 99, "a facet does not exist"),
        (|f| f.certificate.pairs[0][1] += 1, "do not separate"),
        (|f| f.certificate.pairs[0][1] = 0, "a weight is not from 1"),
    ] {
        let error = refused(change);
        assert!(error.contains(expected), "expected {expected:?}: {error}");
    }
    let mut other = mesh.clone();
    other[0].rotate_left(1);
    let error = found.check(&points(&other)).unwrap_err().to_string();
    assert!(error.contains("the data changed"), "{error}");
}

#[test]
fn tight_facets_of_free_bodies_moved_outward_are_refused() {
    let mesh = wavy(20, Some(1.0 / 64.0));
    let at = [[2.0, 0.0, 0.1]];
    let (found, _) = proved(&mesh, &BodiesOptions { count: 3, at: &at, ..free(256) });
    let mut refusals = 0;
    for body in 0..found.answer.bodies.len() {
        for facet in 0..found.answer.bodies[body].normals.len() {
            let normal = found.answer.bodies[body].normals[facet];
            // By two units of the grid along the normal.
            let outward = 2 * normal.iter().map(|n| n.abs()).sum::<i64>();
            let mut changed = found.clone();
            changed.answer.bodies[body].offsets[facet] += outward;
            match changed.check(&points(&mesh)) {
                Err(error) => {
                    let error = error.to_string();
                    let expected = "is not proved to stay out of body";
                    let is_expected = error.contains(expected) || error.contains("the volume of");
                    assert!(is_expected, "{error}");
                    refusals += usize::from(error.contains(expected));
                }
                // A facet that only others need: the volume stays.
                Ok(verdict) => assert_eq!(verdict.bodies, 3),
            }
        }
    }
    let facets: usize = found.answer.bodies.iter().map(|body| body.normals.len()).sum();
    println!("{refusals} of {facets} facets are tight");
    // Each plane touches a triangle that no plane before it kept out, though a later one may.
    assert!(2 * refusals > facets, "{refusals} of {facets}");
    let refused = |change: fn(&mut Bodies)| refused(&found, &mesh, change);
    for (change, expected) in [
        ((|f| f.answer.at[0] = [-2.0, 0.0, 0.1]) as fn(&mut Bodies), "to contain the point"),
        (|f| f.answer.bodies.swap(0, 1), "body 0"),
        (|f| f.answer.bodies[0].normals[0][0] += 1, "body 0"),
        (|f| f.answer.bodies[0].normals[0] = [40, 80, 120], "common divisor"),
        (|f| f.certificate.proofs[0].inside = f.certificate.proofs[1].inside, "body 0"),
    ] {
        let error = refused(change);
        assert!(error.contains(expected), "expected {expected:?}: {error}");
    }
}
