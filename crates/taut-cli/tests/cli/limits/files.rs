//! Pieces of files that are too large to be held: lines, points, shapes.

use std::fs::File;
use std::io::Write;

use liblzma::write::XzEncoder;

use super::{gzip, npy_header};

use crate::test_folder::TestFolder;
use crate::test_length::long_or;
/// Files of each text format, whose line with the given number goes on and on.
fn endless_lines() -> Vec<(&'static str, u64, Vec<u8>)> {
    let long = |start: &str, piece: &str| {
        let mut text = start.as_bytes().to_vec();
        while text.len() < (1 << 20) + (1 << 19) {
            text.extend_from_slice(piece.as_bytes());
        }
        text
    };
    let tsp = "NAME: x\nDIMENSION: 2\nNODE_COORD_SECTION\n1 0 0\n2 1 ";
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
               property float z\nend_header\n1 1 1\n2 2 ";
    vec![
        ("a.csv", 1, long("", "1,")),
        ("b.tsv", 2, long("1\t2\n", "1\t")),
        ("c.txt", 3, long("1 2\n3 4\n", "1")),
        ("comment.csv", 2, long("1,2\n# ", "and so on ")),
        ("d.tsp", 5, long(tsp, "0")),
        ("e.xyz", 2, long("1 2 3\n1 2 ", "3 ")),
        ("f.obj", 2, long("v 1 2 3\nv 1 2 ", "3 ")),
        ("g.off", 3, long("OFF\n1 0 0\n", "1 ")),
        ("h.ply", 9, long(ply, "2")),
        ("i.stl", 2, long("solid x\nfacet normal ", "0 ")),
    ]
}

#[test]
fn a_line_without_end_is_an_error_that_names_file_line_and_limit() {
    let folder = TestFolder::new();
    for (name, line, text) in endless_lines() {
        let said = format!("{name}: line {line} is longer than 1048576 bytes");
        folder.put(name, &text);
        folder.taut(&format!("ball {name} --memory 1M")).ends(2).stderr_has(&[&said]);
        let (packed, said) = (format!("{name}.gz"), said.replace(name, &format!("{name}.gz")));
        folder.put(&packed, gzip(&text));
        folder.taut(&format!("ball {packed} --memory 1M")).ends(2).stderr_has(&[&said]);
    }
    let text = &endless_lines()[0].2;
    let mut encoder = XzEncoder::new(Vec::new(), 1);
    encoder.write_all(text).unwrap();
    folder.put("a.csv.xz", encoder.finish().unwrap());
    let said = match cfg!(feature = "xz") {
        true => "a.csv.xz: line 1 is longer",
        false => "a.csv.xz: this build of taut reads and writes no xz files",
    };
    folder.taut("ball a.csv.xz --memory 1M").ends(2).stderr_has(&[said]);
    folder
        .pipe(gzip(text), "ball - --memory 1M")
        .ends(2)
        .stderr_has(&["standard input: line 1 is longer than 1048576 bytes"]);
    // The end of the line makes all the difference.
    folder.taut("ball b.tsv --columns 0 --memory 1G").ends(2).stderr_has(&["row 2 (line 2) has"]);
}

#[test]
fn a_line_has_a_longest_length_without_a_limit_on_memory() {
    let folder = TestFolder::new();
    // Zero bytes that take no room on the disk.
    let file = File::create(folder.path("zeros.obj")).unwrap();
    file.set_len((64 << 20) + 2).unwrap();
    let said = "line 1 is longer than 67108864 bytes";
    folder.taut("ball zeros.obj").ends(2).stderr_has(&["zeros.obj", said, "a point per line"]);
    folder.taut("verify zeros.obj zeros.obj").ends(2).stderr_has(&["zeros.obj", said]);
}

#[test]
fn compressed_arrays_are_read_in_pieces_within_the_allowed_memory() {
    let folder = TestFolder::new();
    let rows = long_or(2_000_000, 300_000);
    let zeros = [npy_header("<f8", rows, 2), vec![0; 16 * rows as usize]].concat();
    folder.put("zeros.npy.gz", gzip(&zeros));
    // A single point of 24 MB is a piece.
    folder
        .put("wide.npy.gz", gzip(&[npy_header("<f8", 1, 3_000_000), vec![0; 24_000_000]].concat()));
    folder.put("wide.raw.gz", gzip(&vec![0; 24_000_000]));
    folder.put("wide.npy", [npy_header("<f8", 1, 3_000_000), vec![0; 24_000_000]].concat());
    folder.taut("ball zeros.npy.gz --memory 1M --quiet").ends(0);
    let said =
        ["a single point must be held in memory, which takes at least 24000000 bytes", "1048576"];
    folder.taut("ball wide.npy.gz --memory 1M").ends(2).stderr_has(&said);
    folder.taut("ball wide.npy --memory 1M").ends(2).stderr_has(&said);
    folder
        .taut("ball wide.raw.gz --memory 1M --raw-dim 3000000 --raw-type f64")
        .ends(2)
        .stderr_has(&said);
    folder.taut("ball wide.npy.gz --quiet").ends(0);
}

#[test]
fn a_shape_larger_than_the_allowed_memory_is_an_error() {
    let folder = TestFolder::new();
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 100000\n\
                  property float x\nproperty float y\nproperty float z\nend_header\n";
    let cloud = [header.as_bytes(), &vec![0; 1_200_000]].concat();
    folder.put("cloud.ply", &cloud);
    folder.put("cloud.ply.gz", gzip(&cloud));
    for name in ["cloud.ply", "cloud.ply.gz"] {
        folder.taut(&format!("ball {name} --memory 2M")).ends(2).stderr_has(&[
            name,
            "all its vertices and triangles must be held in memory",
            "convert it to npy",
        ]);
        folder.taut(&format!("ball {name} --memory 10M --quiet")).ends(0);
    }
}

#[test]
fn an_output_larger_than_the_free_space_is_refused_before_it_is_begun() {
    let folder = TestFolder::new();
    for (name, bytes) in [
        ("points.npy", "8000000000000000000"),
        ("points.csv", "2000000000000000000"),
        ("points.csv.gz", "61035156250000"),
    ] {
        folder.put("points.csv", "earlier");
        folder
            .taut(&format!("generate normal -n 1000000000000 -d 1000000 -o {name}"))
            .ends(2)
            .stderr_has(&[name, &format!("at least {bytes} bytes would be written"), "left"]);
        assert_eq!(folder.files(), ["points.csv"]);
        assert_eq!(folder.text("points.csv"), "earlier");
    }
    // What cannot be counted is refused everywhere.
    for out in ["-", "points.npy"] {
        folder
            .taut(&format!("generate normal -n 1000000000000000000 -d 1000000 -o {out}"))
            .ends(2)
            .stderr_has(&["option `--n` is 1000000000000000000", "can be counted"]);
    }
    folder.taut("generate normal -n 1 -d 4000000000000000000 --type f32").ends(2);
}
