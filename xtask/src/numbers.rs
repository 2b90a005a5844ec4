//! `numbers`: makes the tables of docs/planner-numbers.md from the comments of the code.

mod page;

use crate::folders::root;
use anyhow::Result;

#[derive(Debug, clap::Args)]
pub(crate) struct NumbersArgs {
    /// Write the page instead of printing it
    #[arg(long)]
    save: bool,
}

pub(crate) fn run(args: &NumbersArgs) -> Result<()> {
    let text = page::text(&root())?;
    if args.save {
        std::fs::write(root().join(page::PAGE), text)?;
    } else {
        print!("{text}");
    }
    Ok(())
}
