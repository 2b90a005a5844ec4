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
        let command = with_negative_numbers(Cli::command());
        let parsed = command.try_get_matches_from(example.split_whitespace());
        assert!(parsed.is_ok(), "{example}: {:?}", parsed.err());
    }
}

/// `unexpected argument '-1'` does not say what to give.
#[test]
fn a_negative_number_is_a_value_of_its_flag() {
    for line in [
        "campaign --trials -1",
        "campaign --threads -2",
        "aircraft x8 --flights -2",
        "aircraft x8 --obstacles -1",
        "fly --obstacles -3",
        "fly --live -1",
    ] {
        let arguments = ["sil-harness"].into_iter().chain(line.split(' '));
        let parsed = with_negative_numbers(Cli::command()).try_get_matches_from(arguments);
        let text = parsed.unwrap_err().to_string();
        assert!(text.contains("invalid value '-"), "{line}: {text}");
    }
}
