//! The pages of the guide: what they tell a shell to do runs, and what they say of the command is so.
//!
//! A package comes without the pages, and skips these tests.

use std::path::{Path, PathBuf};

use super::test_folder::TestFolder;

/// The page of each tool, which opens with a picture and the shortest example in each language.
const TOOLS: [&str; 20] = [
    "ball",
    "bodies",
    "centers",
    "circle",
    "classify",
    "curve",
    "delaunay",
    "dop",
    "ellipse",
    "ellipsoid",
    "hands",
    "kernel-ball",
    "memory",
    "polygon",
    "rectangle",
    "robust",
    "sphere-tree",
    "surface",
    "terrain",
    "triangle",
];

/// Lines of an example, at most, with its imports.
const EXAMPLE_LINES_MAX: usize = 12;

/// The folder of the pages.
fn docs() -> Option<PathBuf> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    if !docs.exists() {
        println!("skipped: this package comes without the pages");
    }
    docs.exists().then_some(docs)
}

fn page(docs: &Path, name: &str) -> String {
    std::fs::read_to_string(docs.join(format!("{name}.md"))).expect("a page")
}

/// The blocks of code at the head of a page, before its first other paragraph, as language and text.
fn opening(text: &str) -> (Option<&str>, Vec<(&str, &str)>) {
    let (mut picture, mut blocks) = (None, vec![]);
    let mut rest = text.split_once('\n').map_or("", |(_, rest)| rest).trim_start();
    if let Some(image) = rest.strip_prefix("![") {
        let (line, below) = image.split_once('\n').unwrap_or((image, ""));
        picture = line.split_once("](").map(|(_, path)| path.trim_end_matches(')'));
        rest = below.trim_start();
    }
    while let Some(block) = rest.strip_prefix("```") {
        let Some((code, below)) = block.split_once("\n```") else { break };
        let Some(block) = code.split_once('\n') else { break };
        blocks.push(block);
        rest = below.trim_start();
    }
    (picture, blocks)
}

#[test]
fn pages_open_with_a_picture_and_short_examples() {
    let Some(docs) = docs() else { return };
    for name in TOOLS {
        let text = page(&docs, name);
        let (picture, blocks) = opening(&text);
        let picture = picture.unwrap_or_else(|| panic!("{name} opens without a picture"));
        assert!(docs.join(picture).exists(), "{name}: {picture}");
        let languages: Vec<_> = blocks.iter().map(|block| block.0).collect();
        // Hands are not in the Python package.
        let expected = if name == "hands" { &["sh", "rust"][..] } else { &["sh", "pycon", "rust"] };
        assert_eq!(languages, expected, "{name}");
        for (language, code) in blocks {
            let lines = code.lines().filter(|line| !line.starts_with("# ")).count();
            assert!(lines <= EXAMPLE_LINES_MAX, "{name}: {lines} lines of {language}");
        }
    }
}

#[cfg(unix)]
#[test]
fn first_examples_of_the_pages_run_in_a_shell() {
    let Some(docs) = docs() else { return };
    for name in TOOLS {
        let text = page(&docs, name);
        let (_, blocks) = opening(&text);
        let code = blocks.iter().find(|block| block.0 == "sh").expect("an example").1;
        let ran = TestFolder::new().shell(&format!("set -e\n{code}"));
        assert_eq!(ran.code, 0, "{name}: {}", ran.err);
    }
}

/// The names of our column of the tables of a page, such as `taut ball --balls` and `taut.ball`.
fn our_names(text: &str) -> Vec<&str> {
    let rows = text.lines().filter(|line| line.starts_with('|'));
    let cells = rows.filter_map(|line| line.split('|').nth(2));
    cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect()
}

#[test]
fn the_comparison_names_what_there_is() {
    let Some(docs) = docs() else { return };
    let text = page(&docs, "compare");
    let names = our_names(&text);
    assert!(names.len() > 80, "{} names", names.len());
    let folder = TestFolder::new();
    let mut commands = 0;
    for name in names {
        if let Some(words) = name.strip_prefix("taut ") {
            let (below, option) = words.split_once(" --").unwrap_or((words, ""));
            let help = folder.taut(&format!("{below} --help"));
            assert_eq!(help.code, 0, "{name}: {}", help.err);
            let is_there =
                |word: &str| word.trim_end_matches([',', '.', ']']) == format!("--{option}");
            assert!(
                option.is_empty() || help.out.split_whitespace().any(is_there),
                "{name}: no such option"
            );
            commands += 1;
        } else if let Some(path) = name.strip_prefix("taut::") {
            // The block at the end of the page is compiled; here it has to name the same.
            let last = path.rsplit("::").next().unwrap_or(path);
            let block = text.split("```rust").nth(1).unwrap_or_default();
            let mut words = block.split(|c: char| !c.is_alphanumeric() && c != '_');
            assert!(words.any(|word| word == last), "{name}: not compiled below");
        } else {
            assert!(name.starts_with("taut."), "{name} is of no language");
        }
    }
    assert!(commands > 30, "{commands} commands");
}
