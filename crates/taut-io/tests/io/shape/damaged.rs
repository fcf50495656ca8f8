//! Files that were cut short or changed, and counts that are not true: an error or another shape, never a panic.

use std::time::Instant;

use proptest::prelude::*;
use taut_io::{Content, Encoding, Format, open_mesh_bytes};

use super::{ENCODINGS, bytes_of, message, read, single, with};

#[test]
fn no_cut_of_a_binary_file_gives_a_shape() {
    for (name, shape) in [("s.ply", with(true, true)), ("s.stl", single()), ("s.ply.gz", single())]
    {
        let whole = bytes_of(&shape, name, Encoding::Binary);
        assert!(read(name, whole.clone()).is_ok());
        for cut in 0..whole.len() {
            let refused = message(read(name, &whole[..cut]));
            assert!(refused.starts_with(name), "{cut}: {refused}");
        }
        if !name.ends_with("gz") {
            message(read(name, [&whole[..], b"x"].concat()));
        }
    }
}

/// Of text, only the end of the last line can be missed, or the name after `endsolid`; our obj says how much there is and
/// is refused even then.
#[test]
fn no_cut_of_a_text_file_gives_another_shape() {
    for name in ["s.ply", "s.obj", "s.off", "s.stl"] {
        let whole = bytes_of(&single(), name, Encoding::Text);
        for cut in 0..whole.len() {
            let Ok(found) = read(name, &whole[..cut]) else { continue };
            assert!(name != "s.obj" && found == single(), "{name} cut at {cut}");
        }
    }
}

/// A header may promise anything: memory and time follow what is there.
#[test]
fn counts_that_are_not_true_cost_nothing() {
    let start = Instant::now();
    for count in ["4000000000", "18446744073709551615"] {
        for word in ["ascii", "binary_little_endian", "binary_big_endian"] {
            for element in ["vertex", "face", "other"] {
                let text = format!(
                    "ply\nformat {word} 1.0\nelement {element} {count}\nproperty float x\nproperty float y\nproperty float z\n\
                     property list uint int vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}12345678"
                );
                message(read("s.ply", text));
            }
        }
        message(read("s.off", format!("OFF\n{count} {count} 0\n0 0 0\n")));
        message(read("s.off", format!("OFF\n1 1 0\n0 0 0\n{count} 0 0 0\n")));
        message(read("s.pts", format!("{count}\n0 0 0\n")));
        message(read("s.obj", format!("# {count} vertices, {count} simplices\nv 0 0 0\n")));
    }
    let mut stl = vec![0; 100];
    stl[80..84].fill(0xff);
    message(read("s.stl", stl));
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::test_length::long_or(256, 16)))]

    #[test]
    fn changed_bytes_are_no_panic(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        for name in ["s.ply", "s.obj", "s.off", "s.stl"] {
            for encoding in ENCODINGS {
                let mut bytes = bytes_of(&single(), name, encoding);
                for (place, byte) in &changes {
                    let at = place.index(bytes.len());
                    bytes[at] = *byte;
                }
                if let Ok(shape) = read(name, bytes) {
                    prop_assert!(shape.mesh().view().is_ok());
                }
            }
        }
    }

    /// Text made of what such files are made of goes deeper than any bytes do.
    #[test]
    fn any_words_are_a_shape_or_an_error(
        which in 0_usize..5,
        content in "((v|vn|f|OFF|COFF|solid|facet|outer|vertex|endloop|endfacet|endsolid|[0-9]|-1|0\\.5|1e9|nan|1//1|#|//)[ \n]){0,60}",
    ) {
        let readable: Vec<_> = Format::all().filter(|format| format.reads(Content::Surface)).collect();
        let format = Some(readable[which]);
        if let Ok(mesh) = open_mesh_bytes(content.into_bytes(), "any", Content::Surface, format) {
            prop_assert!(mesh.view().is_ok());
        }
    }
}
