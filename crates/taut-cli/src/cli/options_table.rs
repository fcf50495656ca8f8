//! The table of all subcommands, their options and outputs in `docs/command-line.md`, made from the declarations.
//!
//! Set `TAUT_BLESS=1` to write it again.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, Command, CommandFactory};

/// Where the table begins and ends.
const MARKS: [&str; 2] = ["<!-- begin of the table -->\n", "<!-- end of the table -->\n"];

/// Names that several subcommands have with other words of help, and the one meaning that all of these state.
const MEANINGS: &[(&str, &str)] = &[
    ("alpha", "Radius of the alpha shape or of the alpha complex"),
    ("balls", "Rows are balls, a center and a radius each"),
    ("directions", "Directions of the facets of a dop"),
    ("dpi", "Dots per inch of scans"),
    ("draw", "Draw the answer, as .svg, .png or .html"),
    ("ellipsoids", "Rows are ellipsoids, a center and the lower triangle of the shape matrix each"),
    ("epsilon", "Proved gap to reach, or to accept"),
    ("folds", "Folds of a cross-validation"),
    ("format", "Format of the points"),
    ("item-bytes", "Bytes of a record or of an element"),
    ("json", "Print JSON instead of words or CSV"),
    ("k", "How many: centers, or nearest rows"),
    ("label", "Column of the labels"),
    ("max-passes", "Most reads of all points"),
    ("memory", "Most memory"),
    ("method", "The way to find the answer"),
    ("model", "The file of the model, which training writes and others read"),
    ("no-verify", "Do without the independent check"),
    ("nu", "Share of the points that may be outside a ball"),
    ("open", "Leave open where samples end"),
    ("out", "Where to write; the extension chooses the format"),
    ("raw-offset", "Bytes of the file before the first number"),
    ("sample-count", "Points that a method of the thesis draws"),
    ("scores", "Tell the scores as well"),
    ("scratch", "Folder for temporary files"),
    ("seed", "Chooses what is random"),
    ("thesis-steps", "Steps of Algorithm 11 of the thesis"),
    ("type", "Type of a coordinate, f32 or f64"),
];

/// Short names that stand for a second option in subcommands without the first: -k and -n count there, too.
const SECOND_LONGS: &[(char, &str)] =
    &[('k', "directions"), ('k', "draws"), ('n', "count"), ('n', "of")];

/// An option of a subcommand.
struct Use {
    command: String,
    value: String,
    help: String,
}

/// All uses of options, by name.
fn uses() -> BTreeMap<String, Vec<Use>> {
    let top = crate::cli::Cli::command();
    let mut uses: BTreeMap<String, Vec<Use>> = BTreeMap::new();
    visit(&top, "", &mut |name, command| {
        for option in command.get_arguments().filter(|option| option.get_long().is_some()) {
            let long = option.get_long().unwrap_or_default().to_owned();
            if option.is_hide_set() || ["help", "version"].contains(&&*long) {
                continue;
            }
            let help = option.get_help().map(|help| help.to_string()).unwrap_or_default();
            let (command, value) = (name.to_owned(), value_of(option));
            uses.entry(long).or_default().push(Use { command, value, help });
        }
    });
    uses
}

/// Calls `work` with each subcommand that does something, and its name.
fn visit(command: &Command, name: &str, work: &mut dyn FnMut(&str, &Command)) {
    let mut subcommands = command.get_subcommands().peekable();
    if subcommands.peek().is_none() {
        work(name, command);
    }
    for subcommand in subcommands.filter(|subcommand| subcommand.get_name() != "help") {
        let name = format!("{name} {}", subcommand.get_name());
        visit(subcommand, name.trim_start(), work);
    }
}

/// The word for the value of an option; empty for a flag.
fn value_of(option: &Arg) -> String {
    let takes = matches!(option.get_action(), ArgAction::Set | ArgAction::Append);
    match option.get_value_names() {
        Some([only]) if takes => only.to_string(),
        Some(names) if takes => {
            names.iter().map(|name| name.to_string()).collect::<Vec<_>>().join(" ")
        }
        _ => String::new(),
    }
}

/// The first sentence of a help, or the first clause of a long one.
fn first_sentence(help: &str) -> String {
    let end = [". ", "; ", ": ", " ["].iter().filter_map(|mark| help.find(mark)).min();
    help[..end.unwrap_or(help.len())].replace('|', "\\|").trim_end_matches('.').to_owned()
}

/// Options that so many subcommands have are listed once.
const COMMON_USES: usize = 15;

fn table() -> String {
    let uses = uses();
    let common: Vec<&str> = uses
        .iter()
        .filter(|(_, uses)| uses.len() >= COMMON_USES)
        .map(|(name, _)| &**name)
        .collect();
    let mut text =
        "| subcommand | takes | outputs | options of its own |\n|---|---|---|---|\n".to_owned();
    let shown = |option: &Arg| {
        let short = option.get_short().map(|short| format!("-{short}, ")).unwrap_or_default();
        format!("`{short}--{}`", option.get_long().unwrap_or_default())
    };
    visit(&crate::cli::Cli::command(), "", &mut |name, command| {
        let options = || {
            command.get_opts().filter(|option| !option.is_hide_set() && option.get_long().is_some())
        };
        let is_output = |option: &&Arg| option.get_help_heading() == Some("Writing");
        let takes: Vec<String> =
            command.get_positionals().map(|option| value_of(option).replace('|', "\\|")).collect();
        let outputs: Vec<String> = options().filter(is_output).map(shown).collect();
        let own = options().filter(|option| !is_output(option));
        let own: Vec<String> = own
            .filter(|option| !common.contains(&option.get_long().unwrap_or_default()))
            .map(shown)
            .collect();
        writeln!(
            text,
            "| `{name}` | {} | {} | {} |",
            takes.join(" "),
            outputs.join(" "),
            own.join(" ")
        )
        .ok();
    });
    text += "\n| option | value | subcommands | meaning |\n|---|---|---|---|\n";
    for (name, uses) in &uses {
        let first = &uses[0];
        let known = MEANINGS.iter().find(|(known, _)| known == name);
        let meaning =
            known.map_or_else(|| first_sentence(&first.help), |(_, meaning)| (*meaning).to_owned());
        let commands: Vec<String> = match uses.len() >= COMMON_USES {
            true => vec![format!("{} of them", uses.len())],
            false => uses.iter().map(|one| format!("`{}`", one.command)).collect(),
        };
        let value = first.value.replace('|', "\\|");
        writeln!(text, "| `--{name}` | {value} | {} | {meaning} |", commands.join(", ")).ok();
    }
    text
}

#[test]
fn the_table_in_the_documentation_is_that_of_the_declarations() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/command-line.md");
    if !path.parent().is_some_and(Path::is_dir) {
        return println!("skipped: this package comes without the pages");
    }
    let page = std::fs::read_to_string(&path).expect("the page is there");
    let (before, rest) = page.split_once(MARKS[0]).expect("the table has a begin");
    let (found, after) = rest.split_once(MARKS[1]).expect("the table has an end");
    let table = table();
    if found != table && std::env::var_os("TAUT_BLESS").is_some() {
        let page = [before, MARKS[0], &table, MARKS[1], after].concat();
        std::fs::write(&path, page).expect("the page can be written");
        return;
    }
    assert!(found == table, "docs/command-line.md is old: run the test with TAUT_BLESS=1");
}

#[test]
fn no_name_has_two_meanings() {
    for (name, uses) in uses() {
        let first = &uses[0];
        for other in &uses {
            assert_eq!(
                first.value, other.value,
                "--{name} of `{}` and of `{}` take different values",
                first.command, other.command
            );
        }
        let is_one = uses.iter().all(|other| other.help == first.help);
        let is_known = MEANINGS.iter().any(|(known, _)| *known == name);
        assert!(
            is_one || is_known,
            "--{name} is explained in two ways: give it another name, or state its one meaning in MEANINGS"
        );
    }
    for (name, _) in MEANINGS {
        assert!(uses().contains_key(*name), "--{name} is gone: take it out of MEANINGS");
    }
}

#[test]
fn no_short_name_has_two_meanings() {
    let mut longs: BTreeMap<char, (String, String)> = BTreeMap::new();
    visit(&crate::cli::Cli::command(), "", &mut |name, command| {
        for option in command.get_arguments() {
            let (Some(short), Some(long)) = (option.get_short(), option.get_long()) else {
                continue;
            };
            if SECOND_LONGS.contains(&(short, long)) {
                continue;
            }
            let first = longs.entry(short).or_insert_with(|| (long.to_owned(), name.to_owned()));
            assert_eq!(first.0, long, "-{short} of `{}` and of `{name}`", first.1);
        }
    });
    assert!(longs.contains_key(&'o'), "{longs:?}");
}
