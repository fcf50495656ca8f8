//! Meshes with holes, closed by caps.

use taut_inscribe::{BodiesOptions, Error};

use super::shapes::{Mesh, cuboid, free, octahedron, options, points, proved, solve, wavy};

fn closing(options: BodiesOptions<'static>) -> BodiesOptions<'static> {
    BodiesOptions { close_holes: true, ..options }
}

#[test]
fn flat_holes_are_closed_as_they_were() {
    // One face of a cube and one of an octahedron.
    for options in [options(14), free(256)].map(closing) {
        let (found, verdict) = proved(&cuboid([0.0; 3], [1.0; 3])[2..], &options);
        assert_eq!((verdict.caps, found.answer.caps.len()), (2, 2));
        assert!(verdict.largest > 0.98, "{verdict:?}");
        let (found, verdict) = proved(&octahedron()[1..], &options);
        assert_eq!(verdict.caps, 1);
        assert!(verdict.largest > 0.98 * 4.0 / 3.0, "{verdict:?}");
        // The cap has the three corners of the face that was removed, by their first places in the rows.
        let rows = &octahedron()[1..];
        let mut cap = found.answer.caps[0].map(|corner| rows.as_flattened()[corner as usize]);
        let mut gone = octahedron()[0];
        cap.sort_by(|p, q| p.partial_cmp(q).unwrap());
        gone.sort_by(|p, q| p.partial_cmp(q).unwrap());
        assert_eq!(cap, gone);
    }
}

#[test]
fn closed_meshes_need_no_caps_and_open_ones_are_named_unless_asked() {
    let (found, verdict) = proved(&octahedron(), &closing(options(14)));
    assert_eq!((found.answer.caps.len(), verdict.caps), (0, 0));
    assert_eq!(found.answer, proved(&octahedron(), &options(14)).0.answer);
    let error = solve(&octahedron()[1..], &options(14)).unwrap_err();
    assert!(matches!(error, Error::Open { edges: 3, .. }), "{error}");
}

#[test]
fn torn_tori_are_closed_and_no_body_leaves_them() {
    // Holes of many sizes, some of which touch each other in a corner.
    let whole = wavy(24, None);
    let torn: Mesh = (0..whole.len())
        .filter(|k| ![3, 4, 5, 100, 101, 102, 148, 149, 150, 500, 503, 700, 1001].contains(k))
        .map(|k| whole[k])
        .collect();
    for options in [options(18), free(256)] {
        let options = BodiesOptions { count: 5, ..closing(options) };
        let (found, verdict) = proved(&torn, &options);
        assert!(verdict.caps >= 13 && verdict.bodies >= 4, "{verdict:?}");
        let close = proved(&whole, &BodiesOptions { count: 5, ..options }).1;
        // Holes of a few triangles hardly change the inside.
        assert!(verdict.volume_lower > 0.8 * close.volume_lower, "{verdict:?} {close:?}");
        // The caps are part of what the checker sees.
        let mut changed = found.clone();
        changed.answer.caps.pop();
        let error = changed.check(&points(&torn)).unwrap_err().to_string();
        assert!(error.contains("belongs to an odd number of triangles"), "{error}");
    }
}

#[test]
fn sheets_have_no_inside_to_speak_of() {
    // A bowl: the cap over its opening fills at least a third of the view from everywhere inside.
    let bowl: Mesh = octahedron()
        .into_iter()
        .filter(|t| t.iter().all(|p| p[2] <= 0.0))
        .map(|t| t.map(|[x, y, z]| [x, y, 0.25 * z]))
        .collect();
    assert_eq!(bowl.len(), 4);
    for options in [options(18), free(256)] {
        let error = solve(&bowl, &closing(options)).unwrap_err();
        assert!(matches!(error, Error::Ambiguous), "{error}");
        let error = solve(&bowl, &BodiesOptions { at: &[[0.0, 0.0, -0.1]], ..closing(free(256)) });
        let error = error.unwrap_err().to_string();
        assert!(error.contains("caps fill at least a third of the view"), "{error}");
    }
}
