//! One vocabulary: names are the field's terms, and prose is plain American English.
//!
//! Ordinary words are refused only as whole names of what a line declares, as prose and longer names may need them; odd
//! ones also as parts of names. This file lists them, so the search leaves it out.

use std::path::Path;

use super::{read, root, sources};

/// Names that say nothing, of types, modules, functions and variables: each has a standard term.
const NAMES: [&str; 58] = [
    "Answered",
    "Apart",
    "Beside",
    "Bond",
    "Building",
    "Cover",
    "Covered",
    "Delivery",
    "Desk",
    "Doubled",
    "Fact",
    "Few",
    "Gathered",
    "Guest",
    "Guests",
    "Halves",
    "Homeless",
    "Laid",
    "Look",
    "Looks",
    "Media",
    "MeshPlace",
    "Misread",
    "Moats",
    "Parting",
    "PlainTree",
    "Prospect",
    "Quick",
    "Said",
    "Shown",
    "Strand",
    "Survey",
    "Tell",
    "Unsound",
    "Walked",
    "Written",
    "blame",
    "bond",
    "bonds",
    "complain",
    "complains",
    "foot",
    "guest",
    "guests",
    "hear",
    "homeless",
    "kicks",
    "look_around",
    "looks",
    "media",
    "moats",
    "plain_tree",
    "probed",
    "say",
    "seam",
    "stray",
    "survey",
    "tell",
];

/// Parts of names, between underscores or capitals, in lower case.
const PARTS: [&str; 12] = [
    "blamed",
    "complains",
    "desk",
    "guest",
    "guests",
    "homeless",
    "lacuna",
    "moat",
    "moats",
    "strand",
    "strands",
    "stray",
];

/// Words and phrases that no line holds, whatever the case.
const PHRASES: [&str; 17] = [
    "anew",
    "at the door",
    "but so many",
    "convinces a stranger",
    "downstairs",
    "for ever",
    "goes on for ever",
    "guests",
    "homeless",
    "in vain",
    "moat",
    "of the house",
    "probed",
    "strangers",
    "the house",
    "upstairs",
    "vainly",
];

/// Beginnings of words in British spelling, whatever the case.
const STEMS: [&str; 20] = [
    "behaviour",
    "catalogue",
    "centre",
    "centring",
    "colour",
    "defence",
    "favour",
    "fulfil ",
    "grey",
    "honour",
    "kilometre",
    "labelled",
    "labelling",
    "licence",
    "millimetre",
    "modelled",
    "modelling",
    "neighbour",
    "programme ",
    "travelled",
];

/// Stems of verbs in -ize.
const VERBS: [&str; 31] = [
    "amort",
    "capital",
    "character",
    "discret",
    "emphas",
    "equal",
    "factor",
    "final",
    "general",
    "initial",
    "linear",
    "maxim",
    "minim",
    "normal",
    "optim",
    "organ",
    "orthogonal",
    "parallel",
    "penal",
    "quant",
    "random",
    "real",
    "recogn",
    "regular",
    "serial",
    "special",
    "standard",
    "summar",
    "symmetr",
    "util",
    "vector",
];

/// Spellings that stay: the value of an option, and the title of a paper.
const KEPT: [&str; 2] = ["circumcentre-distance", "natural neighbour interpolation"];

/// Returns the names that a line of Rust declares.
fn declared(line: &str) -> Vec<&str> {
    const KEYWORDS: [&str; 9] =
        ["const", "enum", "fn", "let", "mod", "static", "struct", "trait", "type"];
    let code = line.split("//").next().unwrap_or_default();
    let words: Vec<_> = code
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty() && *word != "mut")
        .collect();
    words.windows(2).filter(|pair| KEYWORDS.contains(&pair[0])).map(|pair| pair[1]).collect()
}

/// Returns the parts of a name in snake case or camel case, in lower case.
fn parts(name: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut was_lower = false;
    for c in name.chars() {
        if c == '_' || c.is_uppercase() && was_lower {
            parts.push(String::new());
        }
        parts.last_mut().expect("there is a part").extend(c.to_lowercase().filter(|&c| c != '_'));
        was_lower = c.is_lowercase();
    }
    parts
}

/// Tests whether a text in lower case holds words that stand by themselves.
fn holds(text: &str, words: &str) -> bool {
    text.match_indices(words).any(|(at, _)| {
        let ends = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
        ends(text[..at].chars().next_back()) && ends(text[at + words.len()..].chars().next())
    })
}

/// Returns the first British spelling in a text in lower case.
fn british(text: &str) -> Option<String> {
    const ENDINGS: [&str; 5] = ["able", "ation", "e", "ing", "or"];
    let is_verb = |verb: &&&str| {
        let stem = format!("{verb}is");
        text.match_indices(&stem).any(|(at, _)| {
            let rest = &text[at + stem.len()..];
            ENDINGS.iter().any(|ending| rest.starts_with(ending))
        })
    };
    let stem = STEMS.iter().find(|&stem| text.contains(stem)).map(|&stem| stem.to_owned());
    stem.or_else(|| VERBS.iter().find(is_verb).map(|verb| format!("{verb}is…")))
}

/// Returns what a line of a file holds against the vocabulary.
fn problems(line: &str, is_rust: bool) -> Vec<String> {
    let mut found = vec![];
    for name in if is_rust { declared(line) } else { vec![] } {
        let parts = parts(name);
        let part = PARTS.iter().find(|&&part| parts.iter().any(|own| own == part));
        if NAMES.contains(&name) || part.is_some() {
            found.push(format!("the name {name}"));
        }
    }
    let text = KEPT.iter().fold(line.to_lowercase(), |text, kept| text.replace(kept, ""));
    let phrase = PHRASES.iter().find(|phrase| holds(&text, phrase));
    found.extend(phrase.map(|phrase| format!("the words \"{phrase}\"")));
    found.extend(british(&text).map(|stem| format!("the spelling \"{stem}\"")));
    found
}

#[test]
fn words_are_the_fields() {
    needs_repository!();
    let (mut lines, mut all) = (0, vec![]);
    for path in sources(&root()) {
        let kind = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let is_searched = ["md", "py", "pyi", "rs"].contains(&kind.as_str());
        if !is_searched || path.ends_with(Path::new("tidy/vocabulary.rs")) {
            continue;
        }
        for (number, line) in (1..).zip(read(&path).lines()) {
            lines += 1;
            let found = problems(line, kind == "rs").join(", ");
            if !found.is_empty() {
                all.push(format!("{}:{number}: {found}", path.display()));
            }
        }
    }
    assert!(lines > 100_000, "{lines} lines read");
    assert!(all.is_empty(), "{}\n{} lines; see CONTRIBUTING.md", all.join("\n"), all.len());
}

#[test]
fn planted_words_are_found() {
    for name in NAMES {
        for line in [format!("pub(super) struct {name} {{"), format!("    fn {name}(&self) {{")] {
            assert_eq!(problems(&line, true)[0], format!("the name {name}"));
        }
        assert_eq!(problems(&format!("let mut {name} = 1;"), true)[0], format!("the name {name}"));
    }
    for part in PARTS {
        let camel = part[..1].to_uppercase() + &part[1..];
        for name in [format!("first_{part}"), format!("{part}_of_all"), format!("First{camel}")] {
            assert_eq!(
                problems(&format!("type {name} = u8;"), true)[0],
                format!("the name {name}")
            );
        }
    }
    for words in PHRASES {
        assert!(!problems(&format!("/// All of it, {words}."), false).is_empty(), "{words}");
    }
    for stem in STEMS.map(str::to_owned).into_iter().chain(VERBS.map(|verb| format!("{verb}ised")))
    {
        assert_eq!(problems(&format!("    // It is {stem} here"), true).len(), 1, "{stem}");
    }
    let names = ["let look_up = 1;", "fn stray_light() {", "mod covering;", "struct CoverPage;"];
    let found = names.map(|line| problems(line, true).len());
    assert_eq!(found, [0, 1, 0, 0]);
    for line in [
        "// A realistic optimist, and a finalist: a characteristic surprise.",
        "/// Look at the cover.",
        "center, color, neighbor, normalize",
        "the value `circumcentre-distance`",
        "renewed, whenever",
    ] {
        assert_eq!(problems(line, true), Vec::<String>::new(), "{line}");
    }
}
