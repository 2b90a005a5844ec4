//! `completions` and `man`: what shells and `man` know of the command line.

use super::answer::{Failure, data, talk};
use crate::files::write_whole;
use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::COMPLETIONS)]
pub(super) struct CompletionsArgs {
    /// Shell for which the completions are printed
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::MAN)]
pub(super) struct ManArgs {
    /// Directory for the pages of all commands [default: the main page to the standard output]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the completions of a shell.
pub(super) fn completions(args: &CompletionsArgs, mut command: Command) -> Result<u8, Failure> {
    let mut script = Vec::new();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    data(String::from_utf8_lossy(&script).trim_end())?;
    Ok(0)
}

/// Prints the manual's main page, or writes the pages of all commands.
pub(super) fn man(args: &ManArgs, command: Command) -> Result<u8, Failure> {
    let Some(directory) = &args.out else {
        data(page(command)?.trim_end())?;
        return Ok(0);
    };
    let name = command.get_name().to_owned();
    write_pages(directory, command, &name)
}

/// Writes the page of a command and those of its subcommands, `sil-harness-bench-qp.1` for one.
fn write_pages(directory: &Path, mut command: Command, name: &str) -> Result<u8, Failure> {
    command.build();
    for subcommand in command
        .get_subcommands()
        .filter(|sub| sub.get_name() != "help")
    {
        let name = format!("{name}-{}", subcommand.get_name());
        write_pages(directory, subcommand.clone(), &name)?;
    }
    let path = directory.join(format!("{name}.1"));
    let named = command.display_name(name.to_owned());
    write_whole(&path, page(named)?.as_bytes())?;
    talk(path.display());
    Ok(0)
}

fn page(command: Command) -> Result<String, Failure> {
    let mut text = Vec::new();
    let made = Man::new(command).render(&mut text);
    made.map_err(Failure::failed)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
