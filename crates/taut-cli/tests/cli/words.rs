//! Help, versions, formats, completions and the manual.

use crate::test_folder::TestFolder;

const COMMANDS: [&str; 19] = [
    "ball",
    "ellipsoid",
    "centers",
    "dop",
    "delaunay",
    "curve",
    "surface",
    "inscribe",
    "classify",
    "hand",
    "verify",
    "draw",
    "memory",
    "near",
    "generate",
    "tour",
    "formats",
    "completions",
    "man",
];

#[test]
fn help_explains_every_command_with_an_example() {
    let folder = TestFolder::new();
    let top = folder.taut("--help").ends(0).stdout_has(&["Exit: 0"]).out;
    for command in COMMANDS {
        assert!(top.contains(&format!("  {command} ")), "{command}");
        folder.taut(&format!("{command} --help")).ends(0).stdout_has(&[
            "Usage: taut ",
            "Example: ",
            &format!("taut {command}"),
        ]);
    }
    folder.taut("ball --help").ends(0).stdout_has(&[
        "[default: 1e-9,",
        "TAUT_THREADS",
        "Exit: 0 reached",
    ]);
    folder.taut("--version").ends(0).stdout_has(&[concat!("taut ", env!("CARGO_PKG_VERSION"))]);
}

#[test]
fn formats_lists_what_is_read_and_written() {
    let run = TestFolder::new().taut("formats").ends(0);
    for format in ["csv", "tsv", "whitespace", "npy", "parquet", "arrow", "tsplib", "xyz", "raw"] {
        if !cfg!(feature = "arrow") && matches!(format, "parquet" | "arrow") {
            continue;
        }
        let line = run.out.lines().find(|line| line.split_whitespace().next() == Some(format));
        let words: Vec<&str> =
            line.unwrap_or_else(|| panic!("no {format}")).split_whitespace().collect();
        assert_eq!(words[1..3], ["yes", if format == "tsplib" { "no" } else { "yes" }], "{format}");
    }
    if cfg!(all(feature = "xz", feature = "zstd")) {
        assert!(run.out.contains("gz, xz, zst"));
    }
    for format in ["ply", "obj", "off", "vtu", "geojson", "svg", "wkt"] {
        assert!(run.out.contains(&format!("\n{format} ")), "{format}");
    }
}

#[test]
fn shells_complete_and_the_manual_has_a_page_for_each_command() {
    let folder = TestFolder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        folder.taut(&format!("completions {shell}")).ends(0).stdout_has(&[
            "taut",
            "epsilon",
            "max-passes",
        ]);
    }
    folder.taut("completions tcsh").ends(2);
    folder.taut("man pages/man1").ends(0);
    let page = folder.text("pages/man1/taut.1");
    assert!(page.contains(".TH taut 1"), "{page}");
    for command in COMMANDS {
        let page = folder.text(&format!("pages/man1/taut-{command}.1"));
        assert!(page.contains(&format!("taut\\-{command}")) && page.contains("Example"), "{page}");
    }
    let page = folder.text("pages/man1/taut-inscribe-ellipsoid.1");
    assert!(page.contains("max\\-steps") && page.contains("Example"), "{page}");
}
