//! The top of the command line: the subcommands and what is said about all of them.

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::commands::{
    ball, centers, classify, completions, convert, curve, delaunay, dop, draw, ellipsoid, formats,
    generate, hand, info, inscribe, man, memory, near, stream, surface, tour, verify,
};
use crate::exit::Outcome;

/// Tight shapes around, through and inside point sets, with proof.
#[derive(Debug, Parser)]
#[command(name = "taut", version, max_term_width = 100)]
#[command(after_help = "\
Exit: 0 done and as asked · 1 a check failed · 2 bad input or usage, nothing written ·
      3 stopped early by a budget, or where rounding hides the gap that was asked for;
        the gap reached is reported · 130 interrupted
Start: taut tour, then open tour.html")]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Ball(ball::Args),
    Ellipsoid(ellipsoid::Args),
    Dop(dop::Args),
    Centers(centers::Args),
    Near(near::Args),
    Delaunay(delaunay::Args),
    Stream(stream::Args),
    Curve(curve::Args),
    Surface(surface::Args),
    Inscribe(inscribe::Args),
    Classify(classify::Args),
    Hand(hand::Args),
    Verify(verify::Args),
    Draw(draw::Args),
    Memory(memory::Args),
    Info(info::Args),
    Convert(convert::Args),
    Generate(generate::Args),
    Tour(tour::Args),
    Formats(formats::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Cli {
    /// Parses the words of the command line; the short help of a subcommand fits on a screen.
    pub(crate) fn parsed() -> Result<Self, clap::Error> {
        let mut command = short_help::shortened(Self::command());
        let matches = command.try_get_matches_from_mut(std::env::args_os())?;
        Self::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
    }

    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.command {
            Command::Ball(args) => args.run(),
            Command::Ellipsoid(args) => args.run(),
            Command::Dop(args) => args.run(),
            Command::Centers(args) => args.run(),
            Command::Near(args) => args.run(),
            Command::Delaunay(args) => args.run(),
            Command::Stream(args) => args.run(),
            Command::Curve(args) => args.run(),
            Command::Surface(args) => args.run(),
            Command::Inscribe(args) => args.run(),
            Command::Classify(args) => args.run(),
            Command::Hand(args) => args.run(),
            Command::Verify(args) => args.run(),
            Command::Draw(args) => args.run(),
            Command::Memory(args) => args.run(),
            Command::Info(args) => args.run(),
            Command::Convert(args) => args.run(),
            Command::Generate(args) => args.run(),
            Command::Tour(args) => args.run(),
            Command::Formats(args) => args.run(),
            Command::Completions(args) => args.run(),
            Command::Man(args) => args.run(),
        }
    }
}

#[cfg(test)]
mod options_table;
mod short_help;

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_declaration_is_sound() {
        super::Cli::command().debug_assert();
    }

    #[test]
    fn every_subcommand_and_option_is_explained() {
        let top = super::Cli::command();
        let mut commands: Vec<_> = top.get_subcommands().collect();
        while let Some(command) = commands.pop() {
            let name = command.get_name();
            assert!(command.get_about().is_some(), "{name} has no description");
            assert!(command.get_after_help().is_some(), "{name} has no example");
            for argument in command.get_arguments() {
                assert!(argument.get_help().is_some(), "{name}: {} has no help", argument.get_id());
            }
            commands.extend(command.get_subcommands());
        }
    }
    /// Lines are broken where the terminal ends. A line that goes on in the next one would be broken twice.
    #[test]
    fn help_leaves_breaking_lines_to_the_terminal() {
        const HEADS: [&str; 5] = ["Exit: ", "Example: ", "See: ", "Start: ", " "];
        let top = super::Cli::command();
        let mut commands = vec![&top];
        while let Some(command) = commands.pop() {
            let help = command.get_after_help().map(|help| help.to_string()).unwrap_or_default();
            let lines: Vec<&str> = help.lines().collect();
            let has_head = |line: &str| HEADS.iter().any(|head| line.starts_with(head));
            for pair in lines.windows(2) {
                let goes_on =
                    !pair.iter().any(|line| has_head(line)) && !pair[0].ends_with(['.', ':']);
                assert!(!goes_on, "{}: {}", command.get_name(), pair[0]);
            }
            for line in lines.iter().filter(|line| has_head(line)) {
                assert!(line.chars().count() <= 100, "{}: {line}", command.get_name());
            }
            commands.extend(command.get_subcommands());
        }
    }
}
