//! Bad input is refused by name: which file, which line or element, which value.

use taut_io::{Encoding, Error, Format, MeshOptions};

use super::{
    ENCODINGS, Surface, message, open_surface, read, sample, single, with, write_to, write_with,
    written,
};

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n";

#[test]
fn text_is_refused_with_its_line() {
    let ply = |body: &str| format!("{PLY}{body}");
    let one = "property float x\nproperty float y\nproperty float z\nend_header\n";
    for (name, text, wanted) in [
        ("s.ply", "plx\n".into(), "s.ply is damaged or no ply file: line 1: the first line is not `ply`"),
        ("s.ply", "ply\nformat octal 1.0\n".into(), "line 2: the format is `octal`, which is none of ply"),
        ("s.ply", "ply\nformat ascii 2.0\n".into(), "line 2: the version is `2.0`, not `1.0`"),
        ("s.ply", "ply\nend_header\n".into(), "the header names no format"),
        ("s.ply", "ply\nformat ascii 1.0\nelement vertex -3\n".into(), "line 3: the count of an element is no whole number"),
        ("s.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n".into(), "line 4: a property is of no known type"),
        ("s.ply", "ply\nformat ascii 1.0\nend_header\n".into(), "it does not declare elements `vertex` once"),
        ("s.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int z\nend_header\n0 0\n".into(), "its vertices have no property `y`"),
        ("s.ply", "ply\nformat ascii 1.0\nelement vertex 1\nend_header\n".into(), "elements `vertex` have no properties"),
        ("s.ply", format!("ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nelement vertex 0\n{one}"), "there are elements `tristrips`, which is not read: write the mesh with elements `vertex` and `face`"),
        ("s.ply", format!("ply\nformat ascii 1.0\nelement vertex 0\n{one}"), "s.ply holds no vertex"),
        ("s.ply", ply("0 0 0\n1 0 0\n"), "it ends before vertex 2"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n"), "it ends before face 0"),
        ("s.ply", ply("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "line 11: it has fewer values than the header declares"),
        ("s.ply", ply("0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n"), "line 11: it has more values than the header declares"),
        ("s.ply", ply("0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n"), "line 11: `zero` is no number"),
        ("s.ply", ply("0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"), "line 11: coordinate z is NaN, and must be finite"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "line 13: it names vertex 3, but there are 3"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), "line 13: it names vertex -1"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"), "line 13: `1.5` is no number of the declared type"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n2 0 1\n"), "line 13: a face has 2 vertices, not at least 3"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n-1 0 1\n"), "line 13: a list has the length -1"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"), "line 13: it has fewer values"),
        ("s.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"), "line 14: it goes on after its last element"),
        ("s.obj", "v 0 0\n".into(), "line 1: a vertex has 2 values, which is none of obj"),
        ("s.obj", "v 0 0 x\n".into(), "s.obj is damaged or no obj file: line 1: `x` is no number"),
        ("s.obj", "v 0 -inf 0\n".into(), "line 1: coordinate y is -inf, and must be finite"),
        ("s.obj", "v 0 0 0 1 300 0\n".into(), "line 1: a color is 300"),
        ("s.obj", "v 0 0 0\nvn 0 0\n".into(), "line 2: a normal has 2 values, not 3"),
        ("s.obj", "v 0 0 0\nvn 0 0 nan\n".into(), "line 2: normal z is NaN"),
        ("s.obj", "v 0 0 0\nf 1 1 2\n".into(), "line 2: it names vertex 2, but there are 1"),
        ("s.obj", "v 0 0 0\nf 1 1 0\n".into(), "line 2: it names vertex 0"),
        ("s.obj", "v 0 0 0\nf 1 1 -2\n".into(), "line 2: it names vertex 0"),
        ("s.obj", "v 0 0 0\nf 1 1\n".into(), "line 2: a face has 2 vertices"),
        ("s.obj", "v 0 0 0\nf 1//1 1 1\n".into(), "line 2: it names normal 1, but there are 0"),
        ("s.obj", "v 0 0 0\nf a 1 1\n".into(), "line 2: `a` is no corner of a face"),
        ("s.obj", "v 0 0 0\nf 1/1/1/1 1 1\n".into(), "line 2: it names normal 1"),
        ("s.obj", "v 0 0 0\nvn 0 0 1\nf 1/1/1/1 1 1\n".into(), "line 3: `1/1/1/1` is no corner of a face"),
        ("s.obj", "v 0 0 0\nsurf 0 1\n".into(), "line 2: it is a free-form curve or surface, which is not read"),
        ("s.obj", "v 0 0 0\nwavefront\n".into(), "line 2: `wavefront` is no keyword of obj files"),
        ("s.obj", "\u{1b}[31m\n".into(), "line 1: `\\u{1b}[31m` is no keyword"),
        ("s.obj", "# nothing\n".into(), "s.obj holds no vertex"),
        ("s.obj", "# 2 vertices, 0 simplices\nv 0 0 0\n".into(), "it promises 2 vertices, but has 1"),
        ("s.obj", "# 1 vertices, 2 simplices\nv 0 0 0\nf 1 1 1\n".into(), "it promises 2 simplices, but has 1"),
        ("s.obj", "# 1 vertices, 0 simplices\nv 0 0 0".into(), "its last line has no end"),
        ("s.off", "OF\n".into(), "line 1: the first word is `OF`, not `OFF`"),
        ("s.off", "4OFF\n".into(), "line 1: it begins with `4OFF`, which is not read: write the mesh as text, of polygons in space"),
        ("s.off", "OFF BINARY\n".into(), "line 1: it is binary, which is not read: write the mesh as text"),
        ("s.off", "OFF\n-1 0 0\n".into(), "line 2: it does not count"),
        ("s.off", "OFF\n".into(), "it ends before its counts"),
        ("s.off", "OFF\n2 0 0\n0 0 0\n".into(), "it ends before vertex 1 of 2"),
        ("s.off", "OFF\n4000000000 9 0\n0 0 0\n".into(), "it ends before vertex 1 of 4000000000"),
        ("s.off", "OFF\n1 1 0\n0 0 0\n".into(), "it ends before face 0 of 1"),
        ("s.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n".into(), "line 4: it names vertex 1, but there are 1"),
        ("s.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n".into(), "line 4: a face says 3 vertices, but 2 numbers follow"),
        ("s.off", "OFF\n1 1 0\n0 0 0\n-3 0 0\n".into(), "line 4: a face says -3 vertices"),
        ("s.off", "OFF\n1 1 0\n0 0 0\nx\n".into(), "line 4: a face begins with the number of its vertices"),
        ("s.off", "OFF\n1 0 0\n0 0 0\n3 0 0 0\n".into(), "line 4: there is more than the counts say"),
        ("s.off", "OFF\n1 0 0\n0 0 inf\n".into(), "line 3: coordinate z is inf"),
        ("s.off", "COFF\n1 0 0\n0 0 0\n".into(), "line 3: a vertex has 3 values, which is none of OFF"),
        ("s.off", "NOFF\n1 0 0\n0 0 0 0 0 nan\n".into(), "line 3: normal z is NaN"),
        ("s.stl", "solid a\nfacit\n".into(), "line 2: it begins with `facit`, not `facet` or `endsolid`"),
        ("s.stl", "solid a\nfacet\nouter loop\nvertex 0 0\n".into(), "line 4: a vertex needs three numbers"),
        ("s.stl", "solid a\nfacet\nouter loop\nvertex 0 0 nan\n".into(), "line 4: coordinate z is NaN"),
        ("s.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\n".into(), "line 5: it begins with `endloop`, not `vertex`"),
        ("s.stl", "solid a\nfacet\n".into(), "it ends where `outer` was expected"),
        ("s.stl", "solid a\n".into(), "it ends where `facet` or `endsolid` was expected"),
        ("s.stl", "solid a\nendsolid\n".into(), "s.stl holds no vertex"),
        ("s.stl", "solid a\nendsolid\nfacet\n".into(), "line 3: it begins with `facet`, not `solid`"),
        ("s.stl", "nothing".into(), "the file ends here, too early"),
        ("s.xyz", "0 0 0\n0 0\n".into(), "line 2: 2 columns, where the first row has 3"),
        ("s.xyz", "0 0\n".into(), "line 1: it has rows of 2 columns, which is not read: write the mesh as x y z"),
        ("s.xyz", "0 0 a\n".into(), "line 1: `a` is no number"),
        ("s.xyz", "0 0 nan\n".into(), "line 1: coordinate z is NaN"),
        ("s.xyz", "0 0 0 0 inf 0\n".into(), "line 1: what stands after the coordinates, y is inf"),
        ("s.xyz", "0 0 0 3 4 -5\n".into(), "three columns are neither normals nor colors"),
        ("s.xyz", "0 0 0 0 0 1 0 1 0\n".into(), "six columns are two normals or two colors"),
        ("s.xyz", "0 0 0 2 2 2 3 3 3\n".into(), "six columns are two normals or two colors"),
        ("s.xyz", "# no row\n".into(), "s.xyz holds no vertex"),
        ("s.pts", "3\n0 0 0\n".into(), "it promises 3 points, but has 1"),
        ("s.pts", "-3\n0 0 0\n".into(), "it promises -3 points"),
        ("s.dxf", "0\n".into(), "s.dxf: dxf files are written, not read; read one of ply, obj, off, stl, xyz"),
        ("s.3ds", "0\n".into(), "s.3ds: the format of the mesh cannot be told from the name; give it one of the extensions .ply, .obj"),
        ("s.ply", String::new(), "s.ply is empty"),
    ] {
        let refused = message(read(name, text.clone()));
        assert!(refused.contains(wanted), "{text:?}: {refused}");
        assert!(refused.starts_with(name) && !refused.contains('\u{1b}'), "{refused}");
    }
}

fn binary(header: &str, values: &[&[u8]]) -> Vec<u8> {
    let start = format!("ply\nformat binary_little_endian 1.0\n{header}end_header\n");
    [start.as_bytes(), &values.concat()].concat()
}

#[test]
fn binary_is_refused_with_its_element() {
    let places = "property float x\nproperty float y\nproperty float z\n";
    let nan = [[0; 12], [0, 0, 0, 0, 0, 0, 0xc0, 0x7f, 0, 0, 0, 0]].concat();
    let header = format!("element vertex 2\n{places}");
    let refused = message(read("s.ply", binary(&header, &[&nan])));
    assert_eq!(
        refused,
        "s.ply is damaged or no ply file: vertex 1: coordinate y is NaN, and must be finite"
    );
    let refused = message(read("s.ply", binary(&header, &[&nan[..13]])));
    assert!(refused.contains("vertex 1: the file ends here, too early"), "{refused}");
    let faces =
        format!("element vertex 1\n{places}element face 1\nproperty list int int vertex_index\n");
    let face = |ids: &[i32]| -> Vec<u8> { ids.iter().flat_map(|id| id.to_le_bytes()).collect() };
    for (ids, wanted) in [
        (&[3, 0, 0, 1][..], "face 0: it names vertex 1, but there are 1"),
        (&[3, 0, 0, -1], "face 0: it names vertex -1, but there are 1"),
        (&[2, 0, 0], "face 0: a face has 2 vertices, not at least 3"),
        (&[-5, 0, 0], "face 0: a list has the length -5"),
        (&[i32::MAX, 0, 0], "face 0: the file ends here, too early"),
        (&[3, 0, 0, 0, 0], "it goes on after its last element"),
    ] {
        let refused = message(read("s.ply", binary(&faces, &[&[0; 12], &face(ids)])));
        assert!(refused.contains(wanted), "{ids:?}: {refused}");
    }
    let mut stl = vec![0; 84 + 50];
    stl[80] = 1;
    stl[84 + 12 + 12..84 + 12 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let refused = message(read("s.stl", stl.clone()));
    assert!(refused.contains("facet 0: coordinate x is inf, and must be finite"), "{refused}");
    stl[84..].fill(0);
    stl[80] = 2;
    let refused = message(read("s.stl", stl.clone()));
    assert!(refused.contains("facet 1: the file ends here, too early"), "{refused}");
    stl[80] = 0;
    let refused = message(read("s.stl", stl));
    assert!(refused.contains("it promises 0 facets, but goes on after them"), "{refused}");
}

#[test]
fn what_a_format_cannot_hold_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let said = |shape: &Surface, name: &str| {
        let refused = write_with(shape, &path(name), Encoding::Binary).unwrap_err();
        refused.to_string()
    };
    assert!(
        said(&sample(), "s.xyz")
            .contains("xyz files are not written as surfaces; write one of ply, obj, off, stl")
    );
    assert!(said(&sample(), "s.step").contains("cannot be told from the name"));
    for name in ["s.stl", "s.glb", "s.gltf"] {
        let refused = said(&sample(), name);
        assert!(
            refused.contains("coordinate 0 of vertex 3, both counted from 0, is -1e300, too large"),
            "{refused}"
        );
        // Far from the origin, and so small that single precision has no numbers for it.
        let moved = |scale: f64, at: f64| Surface {
            vertices: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.1]]
                .map(|[x, y]| [scale * x + at, scale * y, 0.3])
                .to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Default::default()
        };
        write_with(&moved(1.0, 1000.1), &path(name), Encoding::Binary).unwrap();
        std::fs::remove_file(path(name)).unwrap();
        let refused = said(&moved(1.0, 5e5 + 0.1), name);
        assert!(
            refused.contains("moves by more than 1/8192 of the mesh's longest side"),
            "{refused}"
        );
        let flat = |scale| Surface {
            vertices: moved(scale, 0.0).vertices.iter().map(|p| [p[0], p[1], 0.0]).collect(),
            ..moved(scale, 0.0)
        };
        assert!(said(&flat(1e-50), name).contains("1/8192"));
    }
    let points = Surface { triangles: Vec::new(), ..single() };
    for format in written() {
        let name = format!("s.{}", format.extensions()[0]);
        let refused = write_with(&points, &path(&name), Encoding::Text);
        assert_eq!(refused.is_ok(), format.holds_bare_vertices(), "{name}");
        let refused = said(&Surface::default(), &name);
        assert!(refused.contains("there is no triangle to write; vertices alone are written as ply, obj, off, glb, gltf"), "{refused}");
        for shape in [
            Surface { normals: Some(vec![[0.0; 3]; 3]), ..single() },
            Surface { colors: Some(vec![[0; 3]; 5]), ..single() },
        ] {
            let refused = said(&shape, &name);
            assert!(refused.contains("were given for 4 vertices: give one for each"), "{refused}");
        }
        let mut shape = with(true, false);
        shape.normals.as_mut().unwrap()[2][1] = f64::NAN;
        let refused = said(&shape, &name);
        assert!(
            refused.contains("coordinate 1 of normal 2, both counted from 0, is NaN"),
            "{refused}"
        );
    }
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, written().filter(|format| format.holds_bare_vertices()).count());
}

#[test]
fn folders_and_missing_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none.ply");
    assert!(matches!(open_surface(&path, None), Err(Error::NotFound { .. })));
    let refused = message(open_surface(std::path::Path::new("-"), None));
    assert!(refused.starts_with("standard input: the format of the mesh cannot"), "{refused}");
    let format = Some(Format::Ply);
    assert!(matches!(open_surface(folder.path(), format), Err(Error::Directory { .. })));
    let missing = folder.path().join("no/s.ply");
    let refused = write_to(&single(), &missing, &MeshOptions::default()).unwrap_err();
    assert!(matches!(refused, Error::NotFound { .. }));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_said() {
    let full = std::path::Path::new("/dev/full");
    if !full.exists() {
        println!("skipped a_full_device_is_said: there is no /dev/full");
        return;
    }
    let shape = single();
    for format in written() {
        for encoding in ENCODINGS {
            let options = MeshOptions { format: Some(format), encoding };
            let refused = write_to(&shape, full, &options).unwrap_err();
            assert!(refused.to_string().contains("/dev/full: writing failed"), "{refused}");
        }
    }
}
