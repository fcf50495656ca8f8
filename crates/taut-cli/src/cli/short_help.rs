//! What `-h` leaves to `--help`: it is to fit on a screen.

use clap::{Arg, Command};

/// Headings whose options are listed in the long help alone.
const LONG_HEADINGS: [&str; 6] =
    ["Reading", "Running", "Drawing", "Kernels", "Robust", "Alpha complex"];

/// Other options that few people need.
const LONG_OPTIONS: [&str; 4] = ["direction", "hidden", "merge-within", "occlusion"];

/// Options under these headings that are listed all the same.
const SHORT_OPTIONS: [&str; 3] = ["columns", "missing", "quiet"];

/// The beginnings of helps for options of methods that few people ask for.
const OF_METHODS: [&str; 2] = ["Of thesis", "Of alpha"];

/// What the short help says of the rest.
const REST_HINT: &str = "More options and words: --help";

/// The command with a short help for each subcommand.
pub(crate) fn shortened(command: Command) -> Command {
    let command = command.mut_subcommands(shortened);
    if command.get_subcommands().next().is_some() {
        return command;
    }
    let words = command.get_after_help().map(|words| words.to_string()).unwrap_or_default();
    let example = words.find("Example: ").map_or("", |at| &words[at..]);
    let short = format!("{REST_HINT}\n{example}").trim_end().to_owned();
    command.after_help(short).after_long_help(words).mut_args(|option| {
        if is_for_long_help(&option) { option.hide_short_help(true) } else { option }
    })
}

fn is_for_long_help(option: &Arg) -> bool {
    let has_long_heading =
        option.get_help_heading().is_some_and(|heading| LONG_HEADINGS.contains(&heading));
    let is_one_of = |names: &[&str]| option.get_long().is_some_and(|name| names.contains(&name));
    let is_listed = is_one_of(&SHORT_OPTIONS);
    let help = option.get_help().map(|help| help.to_string()).unwrap_or_default();
    let is_of_method = OF_METHODS.iter().any(|begin| help.starts_with(begin));
    is_of_method || is_one_of(&LONG_OPTIONS) || has_long_heading && !is_listed
}

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory};

    use super::shortened;

    /// Lines of a short help, at most.
    const LINES_MAX: usize = 60;

    fn too_long(command: &mut Command, name: &str, found: &mut Vec<String>) {
        let lines = command.render_help().to_string().lines().count();
        if lines > LINES_MAX {
            found.push(format!("{name}: {lines} lines"));
        }
        for subcommand in command.get_subcommands_mut() {
            let name = format!("{name} {}", subcommand.get_name());
            too_long(subcommand, &name, found);
        }
    }

    #[test]
    fn short_helps_fit_on_a_screen() {
        let mut command = shortened(crate::cli::Cli::command().term_width(100));
        command.build();
        let mut found = vec![];
        too_long(&mut command, "taut", &mut found);
        assert!(found.is_empty(), "{found:#?}");
    }
}
