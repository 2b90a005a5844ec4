use super::*;
use clap::CommandFactory;

#[test]
fn the_command_line_is_sound() {
    Cli::command().debug_assert();
}

/// The examples in the help of a command and of those below it.
fn examples(command: &clap::Command) -> Vec<String> {
    let help = command
        .get_after_help()
        .map(ToString::to_string)
        .unwrap_or_default();
    let lines = help
        .lines()
        .filter(|line| line.starts_with("  sil-harness "));
    let own = lines.map(|line| {
        line.split(['#', '>', '|', '&'])
            .next()
            .unwrap_or_default()
            .to_owned()
    });
    own.chain(command.get_subcommands().flat_map(examples))
        .collect()
}

#[test]
fn every_example_in_the_help_is_a_valid_command() {
    let examples = examples(&Cli::command());
    assert!(examples.len() > 15, "{examples:?}");
    for example in examples {
        let parsed = Cli::try_parse_from(example.split_whitespace());
        assert!(parsed.is_ok(), "{example}: {:?}", parsed.err());
    }
}
