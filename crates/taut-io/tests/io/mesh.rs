//! Meshes: what is written is read back to the same bits, and what is damaged is refused.

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use taut_io::{Content, Error, Format, Mesh, MeshOptions, MeshView, write_mesh};
use taut_points::{Monitor, Points};

/// A point repeated, a negative zero, and numbers that need all their digits.
const PLANE: [f64; 10] = [0.1, -0.0, 1.0 / 3.0, 5e-324, 0.1, -0.0, -1e300, 2.0, 1e-9, 7.0];
const SPACE: [f64; 15] =
    [0.1, -0.0, 3.0, 1.0 / 3.0, 5e-324, 1.0, 0.1, -0.0, 3.0, -1e300, 2.0, 4.5, 1e-9, 7.0, 1e22];

/// Simplices of each width on five points.
const ROWS: [&[u32]; 4] =
    [&[3], &[0, 4, 4, 1], &[0, 1, 3, 4, 3, 1, 0, 4, 1], &[0, 1, 3, 4, 4, 3, 1, 0]];

fn formats(width: usize) -> impl Iterator<Item = Format> {
    let written = Format::all().filter(|format| format.writes(Content::Triangulation));
    written.filter(move |format| format.holds_simplices(width))
}

fn open_mesh(path: &Path) -> Result<Mesh, Error> {
    taut_io::open_mesh(path, Content::Triangulation, None)
}

fn open_mesh_bytes(bytes: Vec<u8>, name: &str) -> Result<Mesh, Error> {
    taut_io::open_mesh_bytes(bytes, name, Content::Triangulation, None)
}

fn write(values: &[f64], dim: usize, rows: &[u32], width: usize, path: &Path) -> Result<(), Error> {
    let points = Points::new(values, dim).unwrap();
    let mesh = MeshView::on_points(&points, rows, width);
    write_mesh(&mesh, path, &MeshOptions::default(), &Monitor::silent())
}

/// The bytes of a mesh of triangles in the plane.
fn sample(folder: &Path, name: &str) -> Vec<u8> {
    write(&PLANE, 2, ROWS[2], 3, &folder.join(name)).unwrap();
    std::fs::read(folder.join(name)).unwrap()
}

/// None of a format that holds ids alone.
fn bits(mesh: &Mesh) -> Option<Vec<[u64; 3]>> {
    let bits: Vec<_> = mesh.vertices.iter().map(|at| at.map(f64::to_bits)).collect();
    (!bits.is_empty()).then_some(bits)
}

#[test]
fn every_format_keeps_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    for (values, dim) in [(&PLANE[..], 2), (&SPACE[..], 3)] {
        let expected: Vec<[u64; 3]> = values
            .chunks(dim)
            .map(|row| [0, 1, 2].map(|k| row.get(k).copied().unwrap_or(0.0).to_bits()))
            .collect();
        for (width, rows) in (1..).zip(ROWS) {
            for format in formats(width) {
                for packed in ["", ".gz", ".xz", ".zst"].into_iter().filter(|p| crate::unpacks(p)) {
                    let path = folder.path().join(format!("mesh.{format}{packed}"));
                    write(values, dim, rows, width, &path).unwrap();
                    let mesh = open_mesh(&path).unwrap();
                    assert_eq!((mesh.width, &mesh.simplices[..]), (width, rows), "{format}");
                    let has_vertices = format != Format::Parquet;
                    assert_eq!(bits(&mesh), has_vertices.then(|| expected.clone()), "{format}");
                }
            }
        }
    }
}

#[test]
fn points_in_single_precision_are_their_exact_copies() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.off");
    let points = Points::new(&[0.1f32, 0.2, 0.3, 0.4, 0.5, 0.7], 2).unwrap();
    let mesh = MeshView::on_points(&points, &[0, 1, 2], 3);
    write_mesh(&mesh, &path, &MeshOptions::default(), &Monitor::silent()).unwrap();
    let mesh = open_mesh(&path).unwrap();
    assert_eq!(mesh.vertices[0], [f64::from(0.1f32), f64::from(0.2f32), 0.0]);
}

#[test]
fn what_a_format_cannot_hold_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["mesh.obj", "mesh.off"] {
        let refused = write(&SPACE, 3, ROWS[3], 4, &folder.path().join(name)).unwrap_err();
        assert!(
            refused.to_string().contains("hold no tetrahedra; write one of ply, vtu"),
            "{refused}"
        );
    }
    let refused = write(&PLANE, 2, ROWS[2], 3, &folder.path().join("mesh.stl")).unwrap_err();
    let said = "stl files are not written as triangulations; write one of ply, obj, off, vtu";
    assert!(refused.to_string().contains(said), "{refused}");
    let refused = write(&PLANE, 2, ROWS[2], 3, &folder.path().join("mesh.step")).unwrap_err();
    assert!(
        refused.to_string().contains("give it one of the extensions .ply, .obj, .off, .vtu"),
        "{refused}"
    );
    for content in [Content::Points, Content::Curves] {
        let refused = taut_io::open_mesh_bytes(b"0 0 0\n".to_vec(), "mesh.xyz", content, None);
        assert!(matches!(refused, Err(Error::NotMesh { .. })), "{content}");
    }
    let four = write(&[0.0; 4], 4, &[0], 1, &folder.path().join("mesh.ply")).unwrap_err();
    assert!(four.to_string().contains("points of dimension 1, 2 or 3, not 4"), "{four}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn no_cut_gives_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    for format in formats(3) {
        for packed in ["", ".gz"] {
            let name = format!("mesh.{format}{packed}");
            let whole = sample(folder.path(), &name);
            let mesh = open_mesh_bytes(whole.clone(), &name).unwrap();
            for cut in 0..whole.len() {
                match open_mesh_bytes(whole[..cut].to_vec(), &name) {
                    Err(refused) => assert!(refused.to_string().starts_with(&name), "{refused}"),
                    // Of a vtu file only the line feed after its last tag can be missed.
                    Ok(read) => assert_eq!((cut, &read), (whole.len() - 1, &mesh), "{name}"),
                }
            }
        }
    }
}

#[test]
fn refusals_name_file_and_place() {
    for (name, text, wanted) in [
        (
            "m.obj",
            "v 0 0 0\nv 1 0 0\nf 1 2 3\n",
            "m.obj is damaged or no obj file: line 3: it names vertex 3",
        ),
        ("m.obj", "v 0 0 0\nf 1 0 1\n", "line 2: it names vertex 0"),
        ("m.obj", "v 0 0 x\n", "line 1: `x` is no number"),
        ("m.obj", "v 0 0 NaN\n", "line 1: coordinate z is NaN, and must be finite"),
        (
            "m.obj",
            "v 0 0 0\nf 1 1 1 1\n",
            "m.obj: line 2: it has 4 vertices, not 3, which is not read",
        ),
        ("m.obj", "v 0 0 0\nf 1 1 1\nl 1 1\n", "line 3: 2 vertices, where the first simplex has 3"),
        ("m.obj", "v 0 0 0\nf 1 1 1", "line 2: it does not end with a line feed"),
        (
            "m.obj",
            "# 2 vertices, 1 simplices\nv 0 0 0\nf 1 1 1\n",
            "it promises 2 vertices, but has 1",
        ),
        ("m.obj", "v 0 0 0\n", "m.obj holds no simplex"),
        ("m.obj", "\u{1b}[31m\n", "line 1: `\\u{1b}[31m` is no keyword of obj files"),
        ("m.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "line 4: it names vertex 1, but there are 1"),
        ("m.off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n", "it ends before face 1 of 2"),
        ("m.off", "OFF\n1 1 0\n0 0 0\n3 0 0 0\n7 8 9\n", "line 5: there is more"),
        ("m.off", "OFF\n1 1 0\n0 0 0\n4 0 0 0 0\n", "m.off: line 4: it has 4 vertices, not 3"),
        ("m.off", "OFF\n-1 1 0\n", "line 2: it does not count"),
        ("m.off", "QOFF\n", "m.off: line 1: it begins with `QOFF`, which is not read"),
        ("m.off", "OFF\n1 1 0\n0 0 0\n3 0 0 0", "line 4: it does not end with a line feed"),
        (
            "m.ply",
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\n\
             element strip 1\nproperty int n\nend_header\n",
            "m.ply: there are elements `strip`, which is not read",
        ),
        ("m.ply", "plX\n", "line 1: the first line is not `ply`"),
        ("m.ply", "ply\nproperty int x\n", "line 2: a property stands before any element"),
        (
            "m.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 9\nend_header\n",
            "have no properties",
        ),
        ("m.ply", "ply\nformat binary_little_endian 1.0\n", "line 3: the header does not end"),
        (
            "m.vtu",
            "<VTKFile type=\"PolyData\"><AppendedData encoding=\"raw\">_",
            "its `type` is not UnstructuredGrid",
        ),
        ("m.vtu", "<VTKFile>", "there is no appended data"),
        ("m.parquet", "PAR1", "m.parquet is damaged or no parquet file"),
        (
            "m.stl",
            "solid",
            "m.stl: stl files are not read as triangulations; read one of ply, obj, off, vtu",
        ),
        ("m.ply", "", "m.ply is empty"),
    ] {
        if !cfg!(feature = "arrow") && name == "m.parquet" {
            continue;
        }
        let refused = open_mesh_bytes(text.into(), name).expect_err(wanted).to_string();
        assert!(refused.contains(wanted), "{text:?}: {refused}");
        assert!(!refused.contains('\u{1b}'));
    }
}

#[test]
fn ids_that_are_far_too_large_are_refused() {
    for id in ["4294967296", "9223372036854775807", "-9223372036854775808", "99999999999999999999"]
    {
        let text = format!("v 0 0 0\nf 1 1 {id}\n");
        assert!(open_mesh_bytes(text.into(), "m.obj").is_err(), "{id}");
    }
    // Counted back from the last vertex, and with textures and normals.
    let mesh =
        open_mesh_bytes(b"v 0 0 0\nv 1 0 0\nvn 0 0 1\nf -1 -2 1/7/1\n".to_vec(), "m.obj").unwrap();
    assert_eq!(mesh.simplices, [1, 0, 0]);
}

/// Text and the other byte order are read as those of a surface are, edges and tetrahedra too.
#[test]
fn simplices_of_ply_are_read_in_every_encoding() {
    let header = |word: &str, rest: &str| {
        format!(
            "ply\nformat {word} 1.0\nelement vertex 4\nproperty uchar x\nproperty uchar y\n\
             property uchar z\n{rest}end_header\n"
        )
    };
    let edges = "element edge 1\nproperty int vertex1\nproperty int vertex2\n";
    let text = header("ascii", edges) + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 1\n";
    let mesh = open_mesh_bytes(text.into(), "m.ply").unwrap();
    assert_eq!((mesh.width, &mesh.simplices[..]), (2, &[3, 1][..]));
    let tetra = "element tetra 1\nproperty list uchar short vertex_indices\n";
    let mut bytes = header("binary_big_endian", tetra).into_bytes();
    bytes.extend([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 4, 0, 3, 0, 1, 0, 2, 0, 0]);
    let mesh = open_mesh_bytes(bytes, "m.ply").unwrap();
    assert_eq!((mesh.width, &mesh.simplices[..]), (4, &[3, 1, 2, 0][..]));
}

#[test]
fn other_elements_and_properties_of_ply_are_passed_over() {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\ncomment x\nelement vertex 2\nproperty float x\n\
        property uchar red\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar float uv\n\
        property list uint8 uint32 vertex_index\nend_header\n"
        .to_vec();
    for (x, red) in [(1.0f32, 9u8), (2.0, 8)] {
        bytes.extend(x.to_le_bytes());
        bytes.push(red);
        bytes.extend([0; 8]);
    }
    bytes.extend([1, 0, 0, 0, 0, 3]);
    [0u32, 1, 1].iter().for_each(|id| bytes.extend(id.to_le_bytes()));
    let mesh = open_mesh_bytes(bytes.clone(), "m.ply").unwrap();
    assert_eq!(mesh.simplices, [0, 1, 1]);
    assert_eq!(mesh.vertices, [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    bytes.push(0);
    let refused = open_mesh_bytes(bytes, "m.ply").unwrap_err().to_string();
    assert!(refused.contains("goes on after its last element"), "{refused}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::test_length::long_or(256, 48)))]

    /// Any triangles and edges on any points come back from any format.
    #[test]
    fn random_meshes_come_back(
        values in vec(any::<f64>().prop_filter("finite", |x| x.is_finite()), 6..60),
        picks in vec(any::<prop::sample::Index>(), 12..240),
        width in 2usize..5,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let n = values.len() / 3;
        let ids: Vec<u32> = picks.iter().map(|pick| pick.index(n) as u32).collect();
        let ids = &ids[..ids.len() / width * width];
        for format in formats(width) {
            let path = folder.path().join(format!("m.{format}"));
            write(&values[..3 * n], 3, ids, width, &path).unwrap();
            let mesh = open_mesh(&path).unwrap();
            prop_assert_eq!(&mesh.simplices[..], ids);
            if let Some(vertices) = bits(&mesh) {
                let written: Vec<u64> = values[..3 * n].iter().map(|x| x.to_bits()).collect();
                prop_assert_eq!(vertices.concat(), written);
            }
        }
    }

    /// A changed byte gives an error or another mesh, never a panic.
    #[test]
    fn changed_bytes_are_no_panic(
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        let folder = tempfile::tempdir().unwrap();
        for format in formats(3) {
            let name = format!("m.{format}");
            let mut bytes = sample(folder.path(), &name);
            for (place, byte) in &changes {
                let at = place.index(bytes.len());
                bytes[at] = *byte;
            }
            if let Ok(mesh) = open_mesh_bytes(bytes, &name) {
                prop_assert!(mesh.simplices.len().is_multiple_of(mesh.width));
            }
        }
    }
}
