//! Small files, written down: what others write is read, and what we write is what it was.

use taut_io::Encoding;

use super::{Surface, bytes_of, read, single, text_of};

/// A square of two triangles, with normals and colors.
fn square() -> Surface {
    Surface {
        vertices: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        normals: Some(vec![[0.0, 0.0, 1.0]; 4]),
        colors: Some(vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [51, 102, 204]]),
    }
}

fn bare() -> Surface {
    Surface { normals: None, colors: None, ..square() }
}

#[test]
fn ply_in_text() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
        property double nx\nproperty double ny\nproperty double nz\nproperty uchar red\nproperty uchar green\n\
        property uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n1 1 0 0 0 1 0 0 255\n0 1 0.5 0 0 1 51 102 204\n3 0 1 2\n3 0 2 3\n";
    assert_eq!(text_of(&square(), "s.ply"), text);
    assert_eq!(read("s.ply", text).unwrap(), square());
    // A last line without its end, Windows' line ends, and blank lines.
    assert_eq!(read("s.ply", text.trim_end()).unwrap(), square());
    assert_eq!(read("s.ply", text.replace('\n', "\r\n")).unwrap(), square());
    assert_eq!(read("s.ply", text.replace("3 0 2 3", "\n3 0 2 3")).unwrap(), square());
}

/// Values of any type, elements in any order, lists of textures, and a polygon.
const STRANGE: &str = "ply\nformat FORMAT 1.0\ncomment by hand\nobj_info none\nelement face 1\n\
    property list ushort float uv\nproperty list uint ushort vertex_index\nelement edge 1\nproperty int a\n\
    element vertex 4\nproperty uchar alpha\nproperty float z\nproperty short y\nproperty int8 x\n\
    property float blue\nproperty float green\nproperty float red\nend_header\n";

#[test]
fn ply_of_others_in_text_and_in_either_byte_order() {
    let wanted = Surface {
        vertices: vec![[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [1.0, -2.0, 0.5], [0.0, 1.0, -4.0]],
        triangles: vec![[3, 0, 1], [3, 1, 2]],
        normals: None,
        colors: Some(vec![[255, 51, 0], [0, 0, 0], [0, 0, 0], [0, 0, 255]]),
    };
    let text = STRANGE.replace("FORMAT", "ascii")
        + "2 0.5 0.25 4 3 0 1 2\n-7\n9 0.5 0 0 0 0.2 1\n9 .5 0 1 0 0 0\n9 5e-1 -2 1 0 0 0\n9 -4 1 0 1 0 0\n";
    assert_eq!(read("s.ply", text).unwrap(), wanted);
    for big in [false, true] {
        let word = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = STRANGE.replace("FORMAT", word).into_bytes();
        let mut put = |value: &[u8]| match big {
            true => bytes.extend(value.iter().rev()),
            false => bytes.extend(value),
        };
        put(&2u16.to_le_bytes());
        put(&0.5f32.to_le_bytes());
        put(&0.25f32.to_le_bytes());
        put(&4u32.to_le_bytes());
        [3u16, 0, 1, 2].iter().for_each(|id| put(&id.to_le_bytes()));
        put(&(-7i32).to_le_bytes());
        for (z, y, x, color) in [
            (0.5f32, 0i16, 0i8, [0.0f32, 0.2, 1.0]),
            (0.5, 0, 1, [0.0; 3]),
            (0.5, -2, 1, [0.0; 3]),
            (-4.0, 1, 0, [1.0, 0.0, 0.0]),
        ] {
            put(&[9]);
            put(&z.to_le_bytes());
            put(&y.to_le_bytes());
            put(&x.to_le_bytes());
            color.iter().for_each(|value| put(&value.to_le_bytes()));
        }
        assert_eq!(read("s.ply", bytes).unwrap(), wanted, "{word}");
    }
}

#[test]
fn obj() {
    let text = "# 4 vertices, 2 simplices\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0.5 0.2 0.4 0.8\n\
        vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\nf 1//1 3//3 4//4\n";
    assert_eq!(text_of(&square(), "s.obj"), text);
    assert_eq!(read("s.obj", text).unwrap(), square());
}

#[test]
fn obj_of_others() {
    // All forms of a corner, counted from either end, a polygon, a joined line, and what is passed over.
    let text = "mtllib a.mtl\no thing\nv 0 0 0 1.0\nv 1 0 0 1.0\nv 1 1 0 1.0\nvt 0 0\nvn 0 0 1\ng a b\ns off\nusemtl m\n\
        f 1/1/1 2/1/1 3/1/-1 # a corner\nv 0 1 0\nv 2 2 2\nf -5//1 \\\n  -3//1 -2\nl 1 2\np 5\nf 1/1 2 3 4 5";
    let shape = read("s.obj", text).unwrap();
    assert_eq!(shape.vertices.len(), 5);
    let wanted = [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 3], [0, 3, 4]];
    assert_eq!(shape.triangles, wanted);
    // Two vertices have no normal, none has a color.
    assert_eq!((shape.normals, shape.colors), (None, None));
}

#[test]
fn normals_of_obj_are_kept_where_corners_agree() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    let normals = |text: &str| read("s.obj", format!("{vertices}{text}")).unwrap().normals;
    let [up, down] = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    // Shared by all, given twice, and by number where nothing else is said.
    assert_eq!(normals("vn 0 0 1\nf 1//1 2//1 3//1\n"), Some(vec![up; 3]));
    let twice = "vn 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1//2 2//2 3//1\n";
    assert_eq!(normals(twice), Some(vec![up; 3]));
    let by_number = "vn 0 0 1\nvn 0 0 -1\nvn 0 0 1\n";
    assert_eq!(normals(by_number), Some(vec![up, down, up]));
    assert_eq!(normals(&format!("{by_number}f 1//3 1//1 1//1\n")), Some(vec![up, down, up]));
    // Where they differ, or are not enough, there are none.
    assert_eq!(normals("vn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 1//2 2//2 3//2\n"), None);
    assert_eq!(normals("vn 0 0 1\nf 1//1 2//1 3\n"), None);
    assert_eq!(normals("vn 0 0 1\nvn 0 0 1\n"), None);
    assert_eq!(normals(&format!("{by_number}vn 0 0 1\nf 1//1 1//1 1//1\n")), None);
}

#[test]
fn off() {
    let text = "CNOFF\n4 2 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 0 255 0 255\n1 1 0 0 0 1 0 0 255 255\n\
        0 1 0.5 0 0 1 51 102 204 255\n3 0 1 2\n3 0 2 3\n";
    assert_eq!(text_of(&square(), "s.off"), text);
    assert_eq!(read("s.off", text).unwrap(), square());
    let plain = text_of(&bare(), "s.off");
    assert_eq!(plain, "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n");
}

#[test]
fn off_of_others() {
    // Comments everywhere, counts on the first line, a polygon with a color of its own, colors as fractions.
    let text = "# by hand\nCOFF 4 1 5 # counts\n\n0 0 0 1.0 0 0 1\n # one\n1 0 0 0 1.0 0 1\n1 1 0 0 0 1 1\n0 1 0.5 0.2 0.4 0.8 1\n4 0 1 2 3 0.5 0.5 0.5";
    let wanted = Surface { normals: None, ..square() };
    assert_eq!(read("s.off", text).unwrap(), wanted);
    let unsaid = text.replace("COFF", "OFF");
    assert_eq!(read("s.off", unsaid).unwrap(), wanted);
    let textured = "STNOFF\n1 0 0\n0 0 0 0 0 1 0.5 0.5\n";
    assert_eq!(read("s.off", textured).unwrap().normals, Some(vec![[0.0, 0.0, 1.0]]));
    let nearly_black = "OFF\n1 0\n0 0 0 1 0 1\n";
    assert_eq!(read("s.off", nearly_black).unwrap().colors, Some(vec![[1, 0, 1]]));
    // Colors that only some have are none.
    assert_eq!(read("s.off", "OFF\n2 0\n0 0 0\n0 0 0 1 0 1\n").unwrap().colors, None);
}

const FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 0\nendloop\nendfacet\n";

#[test]
fn stl_in_text() {
    let triangle = Surface {
        vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        ..Default::default()
    };
    assert_eq!(text_of(&triangle, "s.stl"), format!("solid shape\n{FACET}endsolid shape\n"));
    // Names, capitals, indents, and several solids, which share their vertices.
    let text = format!(
        "  Solid a b c\r\n{}ENDSOLID a\n\nsolid\nendsolid\nsolid z\n{FACET}endsolid z",
        FACET.replace('\n', "\r\n\t").to_uppercase()
    );
    let found = read("s.stl", text).unwrap();
    assert_eq!(found, Surface { triangles: vec![[0, 1, 2]; 2], ..triangle });
    // A triangle without area has no normal.
    let flat = Surface { triangles: vec![[0, 1, 1]], ..single() };
    assert!(text_of(&flat, "s.stl").contains("facet normal 0 0 0\n"));
}

#[test]
fn stl_in_binary() {
    let bytes = bytes_of(&bare(), "s.stl", Encoding::Binary);
    assert_eq!(bytes.len(), 84 + 2 * 50);
    assert!(bytes.starts_with(b"binary stl   "));
    assert_eq!(bytes[80..84], 2u32.to_le_bytes());
    let first: Vec<f32> =
        bytes[84..132].chunks(4).map(|x| f32::from_le_bytes(x.try_into().unwrap())).collect();
    assert_eq!(first, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
    assert_eq!(bytes[132..134], [0, 0]);
    assert_eq!(read("s.stl", bytes.clone()).unwrap(), bare());
    // Some programs begin a binary file as if it were text.
    let mut solid = bytes;
    solid[..80].fill(b' ');
    solid[..9].copy_from_slice(b"solid fan");
    assert_eq!(read("s.stl", solid).unwrap(), bare());
}

#[test]
fn xyz_in_every_order_of_columns() {
    let places = vec![[0.0, 1.0, 2.0], [0.5, -1.0, 1e3]];
    let normals = Some(vec![[0.0, 0.6, 0.8], [0.0, 0.0, -1.0]]);
    let colors = Some(vec![[255, 0, 1], [0, 2, 51]]);
    let shape = |normals: &Option<_>, colors: &Option<_>| Surface {
        vertices: places.clone(),
        triangles: Vec::new(),
        normals: Option::clone(normals),
        colors: Option::clone(colors),
    };
    let rows = |rows: [&str; 2]| format!("0 1 2 {}\n0.5\t-1 1e3 {}\n", rows[0], rows[1]);
    for (text, wanted) in [
        (rows(["", ""]), shape(&None, &None)),
        (format!("2\n{}", rows(["", ""])), shape(&None, &None)),
        (format!("# a\n//X Y Z\n\n{}", rows(["", ""])), shape(&None, &None)),
        (rows(["-77", "0.5"]), shape(&None, &None)),
        (rows(["0 .6 .8", "0 0 -1"]), shape(&normals, &None)),
        (rows(["255 0 1", "0 2 51"]), shape(&None, &colors)),
        (rows(["7 255 0 1", "7 0 2 51"]), shape(&None, &colors)),
        (rows(["255 0 1 0 .6 .8", "0 2 51 0 0 -1"]), shape(&normals, &colors)),
        (rows(["0 .6 .8 255 0 1", "0 0 -1 0 2 51"]), shape(&normals, &colors)),
        (rows(["7 0 .6 .8 255 0 1", "7 0 0 -1 0 2 51"]), shape(&normals, &colors)),
        (rows(["0 0 0", "0 0 0"]), shape(&None, &Some(vec![[0; 3]; 2]))),
        (rows(["0.2 0.4 0.8", "1 1 1"]), shape(&None, &Some(vec![[51, 102, 204], [255; 3]]))),
    ] {
        for name in ["s.xyz", "s.pts"] {
            assert_eq!(read(name, text.clone()).unwrap(), wanted, "{text}");
        }
    }
    // Few digits are enough for a normal.
    let rounded = read("s.xyz", rows([".577 .577 -.577", "0 0.707 0.707"])).unwrap().normals;
    assert_eq!(rounded, Some(vec![[0.577, 0.577, -0.577], [0.0, 0.707, 0.707]]));
    // The extension decides what the values leave open.
    let red = rows(["1 0 0", "0 0 1"]);
    let axes = Some(vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(read("s.xyz", red.clone()).unwrap(), shape(&axes, &None));
    assert_eq!(read("s.xyzn", red.clone()).unwrap(), shape(&axes, &None));
    let red = red.replace('1', "1.0");
    let pure = read("s.xyzrgb.gz", packed(&red)).unwrap().colors;
    assert_eq!(pure, Some(vec![[255, 0, 0], [0, 0, 255]]));
}

/// Compressed by gzip.
fn packed(text: &str) -> Vec<u8> {
    use std::io::Write as _;
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn dxf() {
    let triangle = Surface {
        vertices: vec![[0.0, 0.5, -1.0], [1e-9, 2.0, 3.0], [4.0, 5.0, 6.0]],
        triangles: vec![[0, 1, 2]],
        ..Default::default()
    };
    assert_eq!(
        text_of(&triangle, "s.dxf"),
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
         0\n3DFACE\n8\n0\n10\n0\n20\n0.5\n30\n-1\n11\n1e-9\n21\n2\n31\n3\n12\n4\n22\n5\n32\n6\n13\n4\n23\n5\n33\n6\n\
         0\nENDSEC\n0\nEOF\n"
    );
}

#[test]
fn vrml() {
    let text = "#VRML V2.0 utf8\nShape {\nappearance Appearance { material Material { } }\ngeometry IndexedFaceSet {\n\
        solid FALSE\ncoord Coordinate { point [\n0 0 0,\n1 0 0,\n1 1 0,\n0 1 0.5,\n] }\n\
        normal Normal { vector [\n0 0 1,\n0 0 1,\n0 0 1,\n0 0 1,\n] }\n\
        color Color { color [\n1 0 0,\n0 1 0,\n0 0 1,\n0.2 0.4 0.8,\n] }\n\
        coordIndex [\n0,1,2,-1,\n0,2,3,-1,\n]\n}\n}\n";
    assert_eq!(text_of(&square(), "s.wrl"), text);
    let plain = text_of(&bare(), "s.vrml");
    assert!(!plain.contains("Normal") && !plain.contains("Color "), "{plain}");
}

#[test]
fn pov() {
    // The last two triangles have no area, and POV-Ray would refuse them.
    let triangles = vec![[0, 1, 2], [0, 2, 3], [1, 1, 2], [0, 1, 4]];
    let mut shape = Surface { triangles, ..square() };
    shape.vertices.push([2.0, 0.0, 0.0]);
    shape.normals.as_mut().unwrap().push([0.0, 0.0, 1.0]);
    shape.colors.as_mut().unwrap().push([0; 3]);
    assert_eq!(
        text_of(&shape, "s.pov"),
        "#declare Shape = mesh2 {\nvertex_vectors { 5,\n<0,0,0>,\n<1,0,0>,\n<1,1,0>,\n<0,1,0.5>,\n<2,0,0>\n}\n\
         normal_vectors { 5,\n<0,0,1>,\n<0,0,1>,\n<0,0,1>,\n<0,0,1>,\n<0,0,1>\n}\n\
         face_indices { 2,\n<0,1,2>,\n<0,2,3>\n}\n}\n"
    );
}

#[test]
fn a_byte_order_mark_is_no_word() {
    for name in ["s.obj", "s.off", "s.stl"] {
        let text = format!("\u{feff}{}", text_of(&bare(), name));
        assert_eq!(read(name, text).unwrap(), bare(), "{name}");
    }
    assert_eq!(read("s.xyz", "\u{feff}1 2 3\n").unwrap().vertices, [[1.0, 2.0, 3.0]]);
}
