//! The rules of the architecture that a machine can check: who may import whom, what a file may hold.
//!
//! `ARCHITECTURE.md` draws the layers; the table below is the same picture for `cargo metadata`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Ends a test about the repository where there is none: in the package of this crate.
macro_rules! needs_repository {
    () => {
        if !crate::root().join("ARCHITECTURE.md").exists() {
            return println!("skipped: this package comes without its repository");
        }
    };
}

#[path = "tidy/published.rs"]
mod published;
#[path = "tidy/vocabulary.rs"]
mod vocabulary;

/// The layer of each package: an arrow may only go to a lower one.
const LAYERS: [(&str, i32); 21] = [
    ("taut-points", -1),
    ("taut-certify", 0),
    ("taut-io", 0),
    ("taut-kernels", 0),
    ("taut-mesh", 0),
    ("taut-oblivious", 0),
    ("taut-predicates", 0),
    ("taut-delaunay", 1),
    ("taut-enclose", 1),
    ("taut-reference", 1),
    ("taut-search", 1),
    ("taut-inscribe", 2),
    ("taut-recognize", 2),
    ("taut-reconstruct", 2),
    ("taut-draw", 3),
    ("taut", 3),
    ("taut-report", 4),
    ("taut-cli", 5),
    ("taut-pages", 5),
    ("taut-python", 5),
    ("taut-web", 5),
];

/// The arrows that stay in one layer.
const SAME_LAYER: [(&str, &str); 3] =
    [("taut-mesh", "taut-predicates"), ("taut-io", "taut-mesh"), ("taut-certify", "taut-mesh")];

/// Tools beside the layers, which nothing imports: they may import everything.
const TOOLS: [&str; 2] = ["bench", "fuzz"];

/// The crates with named kernels, where `unsafe` is denied but can be allowed with a reason.
const KERNELS: [&str; 7] = [
    "taut-points",
    "taut-kernels",
    "taut-enclose",
    "taut-delaunay",
    "taut-oblivious",
    "taut-reference",
    "taut-cli",
];

/// Words that cannot be searched for and say nothing: no constant has one of them as its whole name.
const BARE_WORDS: [&str; 109] = [
    "AHEAD", "ALIKE", "ALMOST", "ASKED", "BARELY", "BESIDE", "BIG", "BRIEF", "CLEAR", "CLOSE",
    "COARSE", "COARSER", "DEEP", "DEEPEST", "DENSE", "DENSER", "DOUBTFUL", "DRAWN", "END",
    "ENOUGH", "EVEN", "FALL", "FAR", "FARTHER", "FARTHEST", "FAST", "FEW", "FEWEST", "FINE",
    "FINEST", "FIRST", "FLATTER", "FORGIVEN", "FURTHER", "GAIN", "GOOD", "GREAT", "GROWTH", "HALF",
    "HIGH", "HIGHEST", "HUGE", "LARGE", "LARGEST", "LAST", "LATER", "LEAST", "LESS", "LITTLE",
    "LONG", "LONGEST", "LOOSE", "LOW", "LOWEST", "MANY", "MIDDLE", "MORE", "MOST", "MUCH", "NAMED",
    "NARROW", "NEAR", "NEARLY", "NEXT", "NOTHING", "OFTEN", "OUT", "PATIENCE", "PLENTY", "QUICK",
    "RARE", "REACH", "RISE", "ROOM", "ROUGH", "RUNS", "SAFE", "SELDOM", "SEVERAL", "SHORT",
    "SHORTER", "SHORTEST", "SHOWN", "SLACK", "SLOW", "SMALL", "SMALLEST", "SOME", "SPARE",
    "SPARSE", "STALE", "STEEP", "STEPS", "SURE", "THICK", "THIN", "TIGHT", "TIMES", "TINY",
    "TOGETHER", "TURNS", "TWICE", "USEFUL", "VAIN", "WIDE", "WIDER", "WIDEST", "WITHIN", "WORTH",
];

/// Functions at the root of the façade, at most: one for each noun, and some for those to come.
const FACADE_FUNCTIONS_MAX: usize = 14;

/// Names at the root of the façade, at most; all others are in the modules.
const FACADE_NAMES_MAX: usize = 47;

/// Lines a source file may have before it must be two.
const LINES_MAX: usize = 700;

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().expect("the root of the workspace is two folders up")
}

/// One package of the workspace.
struct Package {
    name: String,
    /// Roots of its library and its programs.
    roots: Vec<PathBuf>,
    /// The packages that it is built from; what only its tests use is left out, as a test may call a higher layer.
    imports: Vec<String>,
    /// All it names from outside the workspace, tests included.
    outside: Vec<String>,
}

/// What cargo says of the workspace.
fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo writes JSON")
}

fn packages() -> Vec<Package> {
    let metadata = metadata();
    let text = |value: &Value| value.as_str().expect("a string").to_owned();
    let list = |value: &Value| value.as_array().expect("a list").clone();
    list(&metadata["packages"])
        .iter()
        .map(|package| {
            let dependencies = list(&package["dependencies"]);
            let named = |keep: &dyn Fn(&Value) -> bool| {
                dependencies.iter().filter(|&d| keep(d)).map(|d| text(&d["name"])).collect()
            };
            let roots = list(&package["targets"])
                .iter()
                .filter(|target| {
                    let kind = text(&target["kind"][0]);
                    ["lib", "cdylib", "bin"].contains(&kind.as_str())
                })
                .map(|target| PathBuf::from(text(&target["src_path"])))
                .collect();
            Package {
                name: text(&package["name"]),
                roots,
                imports: named(&|d| d["path"].is_string() && d["kind"] != "dev"),
                outside: named(&|d| d["path"].is_null()),
            }
        })
        .collect()
}

#[test]
fn arrows_only_go_down() {
    needs_repository!();
    let layers = BTreeMap::from(LAYERS);
    let layer = |name: &str| {
        *layers.get(name).unwrap_or_else(|| panic!("{name} has no layer: give it one above"))
    };
    let packages = packages();
    assert!(packages.len() >= 9, "cargo metadata shows the whole workspace");
    for package in &packages {
        if TOOLS.contains(&package.name.as_str()) {
            continue;
        }
        for import in &package.imports {
            let (from, to) = (package.name.as_str(), import.as_str());
            assert!(
                layer(from) > layer(to) || SAME_LAYER.contains(&(from, to)),
                "{from} (layer {}) imports {to} (layer {}): move the type to a lower layer",
                layer(from),
                layer(to)
            );
        }
    }
}

/// `cargo run` at the root builds the command with all features that one of the default members asks for.
#[test]
fn no_default_member_asks_for_default_features() {
    needs_repository!();
    let metadata = metadata();
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let packages = list(&metadata["packages"]);
    let has_defaults = |name: &Value| {
        let package = packages.iter().find(|package| package["name"] == *name);
        package.is_some_and(|p| !p["features"]["default"].as_array().is_none_or(Vec::is_empty))
    };
    let members = list(&metadata["workspace_default_members"]);
    let mut count = 0;
    for package in packages.iter().filter(|package| members.contains(&package["id"])) {
        let dependencies = list(&package["dependencies"]);
        for named in dependencies.iter().filter(|d| d["kind"].is_null() && has_defaults(&d["name"]))
        {
            count += 1;
            assert_eq!(
                named["uses_default_features"], false,
                "{}: {}",
                package["name"], named["name"]
            );
        }
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn checkers_import_no_solver() {
    needs_repository!();
    for package in packages().iter().filter(|package| package.name == "taut-certify") {
        assert_eq!(package.imports, ["taut-points"]);
    }
}

#[test]
fn unsafe_code_stays_in_the_kernels() {
    needs_repository!();
    for package in packages() {
        assert!(!package.roots.is_empty(), "{} has a library or a program", package.name);
        for path in &package.roots {
            let forbids = read(path).contains("#![forbid(unsafe_code)]");
            let kernel = KERNELS.contains(&package.name.as_str());
            assert!(forbids != kernel, "{}: forbid(unsafe_code) or be a kernel", path.display());
        }
    }
    // The command has no kernel, only an allocator.
    for path in sources(&root().join("crates/taut-cli/src")) {
        let is_allocator = path.ends_with("out_of_memory.rs");
        assert_eq!(read(&path).contains("unsafe"), is_allocator, "{}", path.display());
    }
}

#[test]
fn the_processor_is_asked_in_one_place() {
    needs_repository!();
    for path in sources(&root().join("crates")) {
        let asks = read(&path).contains(concat!("is_x86_", "feature_detected"));
        let is_place = path.ends_with("taut-points/src/processor.rs");
        assert_eq!(asks, is_place, "{}: ask taut_points::instruction_set", path.display());
    }
}

#[test]
fn every_dependency_is_justified() {
    needs_repository!();
    let page = read(&root().join("ARCHITECTURE.md"));
    let packages = packages();
    let used: BTreeSet<_> = packages.iter().flat_map(|package| &package.outside).collect();
    let all = used.iter().copied().chain(packages.iter().map(|package| &package.name));
    let unexplained: Vec<_> = all.filter(|name| !page.contains(&format!("`{name}`"))).collect();
    assert!(unexplained.is_empty(), "ARCHITECTURE.md does not say why: {unexplained:?}");
    // Names in the first column of the last table, which stand between backquotes.
    let table = page.split("## Dependencies").nth(1).expect("the page has that section");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| `")?.split(" |").next());
    let stale: Vec<_> = rows
        .flat_map(|row| row.split(", "))
        .map(|name| name.trim_matches('`').to_owned())
        .filter(|name| !used.contains(name))
        .collect();
    assert!(stale.is_empty(), "ARCHITECTURE.md speaks of {stale:?}, which nothing uses");
}

#[test]
fn files_are_short_and_know_no_machine() {
    needs_repository!();
    let files = sources(&root());
    assert!(files.len() > 50, "{} files found", files.len());
    // Written in two parts, so that this file passes.
    let machine =
        [["/wo", "rk/"], ["/ro", "ot/"], ["/ho", "me/"], ["C:", "\\Users"]].map(|p| p.concat());
    let mut problems = Vec::new();
    for path in files {
        let text = read(&path);
        let lines = text.lines().count();
        let prose = path.extension().is_some_and(|extension| extension == "md");
        if !prose && lines > LINES_MAX {
            problems.push(format!("{}: {lines} lines", path.display()));
        }
        for (number, line) in (1..).zip(text.lines()) {
            for part in machine.iter().filter(|&part| line.contains(part)) {
                problems.push(format!("{}:{number}: names {part}", path.display()));
            }
            if line.ends_with(' ') {
                problems.push(format!("{}:{number}: ends in a blank", path.display()));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn constants_say_what_they_bound() {
    needs_repository!();
    let rust = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "rs");
    let (mut constants, mut problems) = (0, Vec::new());
    for path in sources(&root()).into_iter().filter(rust) {
        for (number, line) in (1..).zip(read(&path).lines()) {
            let names = constants_of(line);
            constants += names.len();
            for name in names.iter().filter(|&name| BARE_WORDS.contains(name)) {
                problems.push(format!("{}:{number}: {name} says nothing", path.display()));
            }
        }
    }
    assert!(constants > 1000, "{constants} constants found");
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Names of the constants, statics and const generics that a line declares.
fn constants_of(line: &str) -> Vec<&str> {
    let words = line.split(|c: char| !c.is_alphanumeric() && c != '_');
    let words: Vec<_> = words.filter(|word| !word.is_empty() && *word != "mut").collect();
    let declared = words.windows(2).filter(|pair| ["const", "static"].contains(&pair[0]));
    let is_name = |name: &&str| !name.contains(|c: char| c.is_lowercase());
    declared.map(|pair| pair[1]).filter(is_name).collect()
}

#[test]
fn constants_are_found() {
    // Written without the names, so that this file passes.
    let line = |name: &str| format!("pub(super) const {name}: usize = 1;");
    for word in BARE_WORDS {
        assert_eq!(constants_of(&line(word)), [word]);
        assert_eq!(constants_of(&format!("static mut {word}: u8 = 0;")), [word]);
        assert_eq!(
            constants_of(&format!("fn f<const D: usize, const {word}: u8>() {{")),
            ["D", word]
        );
    }
    assert_eq!(constants_of("const fn few() -> usize {"), Vec::<&str>::new());
    assert_eq!(constants_of("const SMALL_GAP: f64 = 1e-6; // SMALL"), ["SMALL_GAP"]);
}

/// Returns what a program sees at the root of `taut`: the functions, and all names.
fn public_names(source: &str) -> (Vec<String>, Vec<String>) {
    let (mut functions, mut names) = (vec![], vec![]);
    let items = source.split(';').flat_map(|item| item.split_once("pub ").map(|(_, item)| item));
    for item in items {
        let words: Vec<&str> = item.split_whitespace().collect();
        match &words[..] {
            ["mod", name] => names.push((*name).to_owned()),
            ["use", _, "as", name] => names.push((*name).to_owned()),
            ["use", path @ ..] => {
                let path = path.concat();
                let (_, list) = path.split_once("::").expect("a path has two parts");
                for name in list.trim_matches(['{', '}']).split(',').filter(|name| !name.is_empty())
                {
                    assert!(name != "*" && !name.contains("::"), "{name} hides what it names");
                    if name.starts_with(char::is_lowercase) {
                        functions.push(name.to_owned());
                    }
                    names.push(name.to_owned());
                }
            }
            other => panic!("the façade only names what is elsewhere, but says pub {other:?}"),
        }
    }
    // A word that names both a module and a function is one name.
    names.sort_unstable();
    names.dedup();
    (functions, names)
}

#[test]
fn the_facade_is_small() {
    needs_repository!();
    let source = read(&root().join("crates/taut/src/lib.rs"));
    let code: Vec<&str> = source.lines().filter(|line| !line.starts_with("//")).collect();
    let (functions, names) = public_names(&code.join("\n"));
    println!("{} functions and {} names: {names:?}", functions.len(), names.len());
    assert!(functions.contains(&"ball".to_owned()) && names.contains(&"certify".to_owned()));
    assert!(functions.len() <= FACADE_FUNCTIONS_MAX, "{} functions", functions.len());
    assert!(names.len() <= FACADE_NAMES_MAX, "{} names", names.len());
    let twice = functions.iter().find(|name| name.contains("_of_") || name.contains("_with_"));
    assert_eq!(twice, None, "what rows are and who watches are options, not functions");
}

#[test]
fn names_of_a_facade_are_counted() {
    let source = "mod error;\npub mod files;\nuse a::Hidden;\npub use a::{\n    Ball, ball,\n    curve,\n};\n\
                  pub use b::Error;\npub use c as curve;\n";
    let (functions, names) = public_names(source);
    assert_eq!(functions, ["ball", "curve"]);
    assert_eq!(names, ["Ball", "Error", "ball", "curve", "files"]);
}

#[test]
fn links_lead_to_files_that_a_clone_has() {
    needs_repository!();
    let tracked = tracked();
    let has = |path: &str| {
        let folder = format!("{path}/");
        tracked.iter().any(|file| file == path || file.starts_with(&folder))
    };
    let (mut links, mut broken) = (0, Vec::new());
    for page in tracked.iter().filter(|file| file.ends_with(".md")) {
        let text = read(&root().join(page));
        for target in targets(&text).filter(|target| !target.contains("://")) {
            links += 1;
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty() && !resolve(page, file).is_some_and(|path| has(&path)) {
                broken.push(format!("{page}: {target} is not in the repository"));
            }
        }
    }
    assert!(links > 10, "{links} links found");
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// Names of all files that git tracks, from the root on.
fn tracked() -> Vec<String> {
    let output = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let output = output.expect("git runs: the links of the pages are compared with what it tracks");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let names = String::from_utf8(output.stdout).expect("names in UTF-8");
    names.split_terminator('\0').map(str::to_owned).collect()
}

/// Targets of the links and images of a page, without those in its examples.
fn targets(page: &str) -> impl Iterator<Item = &str> {
    let prose = page.split("\n```").step_by(2);
    prose.flat_map(|part| part.split("](").skip(1)).filter_map(|rest| rest.split(')').next())
}

/// The path from the root on of what `page` calls `target`; `None` where that lies outside.
fn resolve(page: &str, target: &str) -> Option<String> {
    let mut parts: Vec<_> = page.split('/').collect();
    parts.pop();
    for part in target.trim_end_matches('/').split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()?),
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

#[test]
fn links_are_found_and_resolved() {
    let page = "![a](b.png), [c](../d#e)\n```rust\n[f](g)\n```\n[h](i)";
    assert_eq!(targets(page).collect::<Vec<_>>(), ["b.png", "../d#e", "i"]);
    assert_eq!(resolve("docs/ball.md", "../README.md").as_deref(), Some("README.md"));
    assert_eq!(resolve("docs/ball.md", "./ball.png").as_deref(), Some("docs/ball.png"));
    assert_eq!(resolve("README.md", "../outside"), None);
}

/// All text files of ours under `folder`, without what is built or fetched.
fn sources(folder: &Path) -> Vec<PathBuf> {
    const KINDS: [&str; 8] = ["rs", "py", "pyi", "md", "toml", "sh", "cpp", "js"];
    const NOT_OURS: [&str; 6] =
        ["target", "build", "runs", "corpus", "node_modules", "__pycache__"];
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of the repository can be read") {
        let path = entry.expect("an entry of it too").path();
        let name = path.file_name().expect("entries have names").to_string_lossy().into_owned();
        if path.is_dir() {
            if !name.starts_with('.') && !NOT_OURS.contains(&name.as_str()) {
                found.extend(sources(&path));
            }
        } else if path.extension().is_some_and(|e| KINDS.contains(&e.to_string_lossy().as_ref())) {
            found.push(path);
        }
    }
    found
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
