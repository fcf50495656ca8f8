//! What is written is read back, bit by bit.

use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use taut_io::{Content, Encoding, Format, open_mesh_bytes};

use super::{
    ENCODINGS, Surface, bits, bytes_of, open_surface, read, samples, single, with, write_with,
};

#[test]
fn ply_obj_and_off_keep_every_bit_packed_or_not() {
    let folder = tempfile::tempdir().unwrap();
    for shape in samples() {
        let names = ["s.ply", "s.obj", "s.off", "s.PLY", "s.ply.gz", "s.obj.xz", "s.off.zst"];
        for name in names.into_iter().filter(|name| crate::unpacks(name)) {
            for encoding in ENCODINGS {
                let path = folder.path().join(name);
                write_with(&shape, &path, encoding).unwrap();
                let found = open_surface(&path, None).unwrap();
                assert_eq!(bits(&found), bits(&shape), "{name} {encoding:?}");
            }
        }
    }
}

#[test]
fn vertices_alone_come_back() {
    for shape in samples().map(|shape| Surface { triangles: Vec::new(), ..shape }) {
        for name in ["s.ply", "s.obj", "s.off"] {
            for encoding in ENCODINGS {
                let found = read(name, bytes_of(&shape, name, encoding)).unwrap();
                assert_eq!(bits(&found), bits(&shape), "{name} {encoding:?}");
            }
        }
    }
}

#[test]
fn stl_keeps_what_it_can_hold() {
    for encoding in ENCODINGS {
        let found = read("s.stl", bytes_of(&single(), "s.stl", encoding)).unwrap();
        assert_eq!(bits(&found), bits(&single()), "{encoding:?}");
    }
    // As text it is exact; equal vertices become one, and those without a triangle go.
    let found = read("s.stl", bytes_of(&with(true, true), "s.stl", Encoding::Text)).unwrap();
    let shape = with(false, false);
    let v = &shape.vertices;
    assert_eq!(found.vertices, [v[0], v[1], v[3], v[4]]);
    assert_eq!(found.triangles, [[0, 1, 2], [3, 2, 1], [0, 3, 0], [1, 1, 3]]);
    assert_eq!((found.normals, found.colors), (None, None));
}

#[test]
fn equal_corners_of_stl_are_one_vertex_and_no_others() {
    let near = f64::from(f32::from_bits(1.0f32.to_bits() + 1));
    let shape = Surface {
        vertices: vec![[0.0, 1.0, 2.0], [-0.0, 1.0, 2.0], [0.0, near, 2.0]],
        triangles: vec![[0, 1, 2], [2, 1, 0]],
        ..Default::default()
    };
    for encoding in ENCODINGS {
        let found = read("s.stl", bytes_of(&shape, "s.stl", encoding)).unwrap();
        assert_eq!(found.vertices, [[0.0, 1.0, 2.0], [0.0, near, 2.0]], "{encoding:?}");
        assert_eq!(found.triangles, [[0, 0, 1], [1, 0, 0]], "{encoding:?}");
    }
}

#[test]
fn the_given_format_beats_the_extension() {
    let bytes = bytes_of(&single(), "s.off", Encoding::Text);
    let format = Some(Format::Off);
    let found = open_mesh_bytes(bytes.clone(), "s.ply", Content::Surface, format).unwrap();
    assert_eq!(bits(&found.into()), bits(&single()));
    assert!(open_mesh_bytes(bytes, "s.ply", Content::Surface, None).is_err());
    assert_eq!("WRL".parse::<Format>().unwrap(), Format::Vrml);
    let refused = "step".parse::<Format>().unwrap_err().to_string();
    assert!(refused.starts_with("`step` is no format; the formats are csv, tsv"), "{refused}");
    for format in Format::all() {
        assert_eq!(format.name().parse::<Format>().unwrap(), format);
        for extension in format.extensions() {
            assert_eq!(extension.parse::<Format>().unwrap(), format);
        }
    }
}

fn finite() -> impl Strategy<Value = f64> {
    any::<f64>().prop_filter("finite", |x| x.is_finite())
}

prop_compose! {
    fn shapes()(
        vertices in vec([finite(), finite(), finite()], 1..20),
        picks in vec(any::<[prop::sample::Index; 3]>(), 0..40),
        normals in option::of(vec([finite(), finite(), finite()], 20)),
        colors in option::of(vec(any::<[u8; 3]>(), 20)),
    ) -> Surface {
        let n = vertices.len();
        Surface {
            triangles: picks.iter().map(|pick| pick.map(|id| id.index(n) as u32)).collect(),
            normals: normals.map(|normals| normals[..n].to_vec()),
            colors: colors.map(|colors| colors[..n].to_vec()),
            vertices,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::test_length::long_or(256, 48)))]

    #[test]
    fn any_shape_comes_back(shape in shapes()) {
        for name in ["s.ply", "s.obj", "s.off"] {
            for encoding in ENCODINGS {
                let found = read(name, bytes_of(&shape, name, encoding)).unwrap();
                prop_assert_eq!(bits(&found), bits(&shape), "{} {:?}", name, encoding);
            }
        }
    }

    /// Corner by corner, as text holds every bit and binary those of single precision.
    #[test]
    fn any_triangles_come_back_from_stl(
        corners in vec([any::<f32>(), any::<f32>(), any::<f32>()].prop_filter("finite", |at| at.iter().all(|x| x.is_finite())), 3..60),
    ) {
        let n = corners.len() as u32 / 3;
        let vertices = corners.iter().map(|at| at.map(f64::from)).collect();
        let triangles = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let shape = Surface { vertices, triangles, ..Default::default() };
        for encoding in ENCODINGS {
            let found = read("s.stl", bytes_of(&shape, "s.stl", encoding)).unwrap();
            let soup: Vec<[f64; 3]> = found.triangles.iter().flatten().map(|&id| found.vertices[id as usize]).collect();
            // Equal as numbers: of 0 and −0, the first that comes is kept.
            prop_assert_eq!(&soup[..], &shape.vertices[..3 * n as usize]);
            let used: std::collections::BTreeSet<u32> = found.triangles.iter().flatten().copied().collect();
            prop_assert_eq!(used.len(), found.vertices.len());
        }
    }
}
