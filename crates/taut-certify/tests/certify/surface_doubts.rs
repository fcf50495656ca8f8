//! Doubts about the topology: evidence beside what is proved, and no proof of anything.

use surface::{Case, cube, tetrahedron};
use taut_certify::{AnySolution, SurfaceDoubt, SurfaceViolation, TopologyDoubt, TopologyReason};

use crate::surface;

fn doubted(mut case: Case, rows: &[u32]) -> Case {
    let doubt = TopologyDoubt { reason: TopologyReason::Rebuilt, rows: rows.to_vec() };
    case.certificate().doubts.push(doubt);
    case
}

#[test]
fn a_doubt_leaves_a_surface_sound_and_not_certified() {
    let plain = cube().check().expect("true");
    assert!(plain.is_sound && plain.is_confident && plain.certified);
    let verdict = doubted(cube(), &[3, 5]).check().expect("true");
    assert!(verdict.is_sound && !verdict.is_confident && !verdict.certified);
    let expected = SurfaceDoubt::Topology { reason: TopologyReason::Rebuilt, row: 3 };
    assert_eq!(verdict.doubt, Some(expected));
    assert_eq!(
        expected.to_string(),
        "the topology is in doubt near row 3: a repair changed the number of handles or parts"
    );
}

#[test]
fn what_is_not_sound_is_told_before_a_doubt() {
    let mut open = tetrahedron();
    open.certificate().apexes.clear();
    let verdict = doubted(open, &[0]).check().expect("true");
    assert!(!verdict.is_sound && !verdict.certified);
    assert_eq!(verdict.doubt, Some(SurfaceDoubt::NoBalls));
}

#[test]
fn doubts_name_rows_that_exist() {
    for (rows, named) in [(&[][..], "no row"), (&[1, 4], "row 4")] {
        let violation = doubted(tetrahedron(), rows).violation();
        let row = named.to_owned();
        assert_eq!(violation, SurfaceViolation::DoubtRows { doubt: 0, row, rows: 4 });
    }
}

#[test]
fn certificates_without_the_list_have_no_doubt() {
    let read = |text: &str| match AnySolution::from_json(text) {
        Ok(AnySolution::Surface(read)) => read,
        other => panic!("{other:?}"),
    };
    let text = tetrahedron().solution.to_json();
    assert!(!text.contains("doubts"));
    assert!(read(&text).certificate.doubts.is_empty());
    let text = doubted(tetrahedron(), &[2]).solution.to_json();
    let found = read(&text);
    assert_eq!(found.certificate.doubts[0].rows, [2]);
    assert_eq!(found.to_json(), text);
}
