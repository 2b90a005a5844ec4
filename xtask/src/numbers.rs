//! `numbers`: makes the ranges of docs/aircraft.md from the lists of the code.

mod ranges;

use crate::folders::root;
use anyhow::Result;

#[derive(Debug, clap::Args)]
pub(crate) struct NumbersArgs {
    /// Write the page instead of printing it
    #[arg(long)]
    save: bool,
}

pub(crate) fn run(args: &NumbersArgs) -> Result<()> {
    let root = root();
    let text = ranges::text(&root)?;
    if args.save {
        std::fs::write(root.join(ranges::PAGE), text)?;
    } else {
        print!("{text}");
    }
    Ok(())
}
