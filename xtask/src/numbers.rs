//! `numbers`: makes the tables of docs/planner-numbers.md from the comments of the code, and the ranges of
//! docs/aircraft.md from its lists.

mod page;
mod ranges;

use crate::folders::root;
use anyhow::Result;

#[derive(Debug, clap::Args)]
pub(crate) struct NumbersArgs {
    /// Write the pages instead of printing them
    #[arg(long)]
    save: bool,
}

pub(crate) fn run(args: &NumbersArgs) -> Result<()> {
    let root = root();
    let pages = [
        (page::PAGE, page::text(&root)?),
        (ranges::PAGE, ranges::text(&root)?),
    ];
    for (page, text) in pages {
        if args.save {
            std::fs::write(root.join(page), text)?;
        } else {
            print!("{text}");
        }
    }
    Ok(())
}
