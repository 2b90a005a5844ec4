//! `--verbose` and `--quiet`: how much a command says besides its result.

use super::answer::{be_quiet, is_quiet, talk};
use super::help::OUTPUT;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::{Display, Write};

#[derive(Clone, Copy, Debug, clap::Args)]
#[command(next_help_heading = OUTPUT)]
pub(super) struct Loudness {
    /// Say more about what is flown
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,
    /// Print the result and errors only
    #[arg(short, long)]
    quiet: bool,
}

impl Loudness {
    /// Silences the command if it has to be quiet.
    pub(super) fn set(self) {
        if self.quiet {
            be_quiet();
        }
    }

    /// Prints what only a verbose command says.
    pub(super) fn tell<T: Display>(self, text: impl FnOnce() -> T) {
        if self.verbose {
            talk(text());
        }
    }
}

/// Makes a progress bar over things such as `flights`. It is drawn on a terminal only, and not by a quiet command.
pub(super) fn progress_bar(length: u64, things: &str) -> ProgressBar {
    if is_quiet() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    let template =
        format!("{{wide_bar}} {{pos}}/{{len}} {things}, {{rate}} {things}/s, {{eta}} left");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        // The bar has no other place for an error of its writer.
        let rate = |state: &ProgressState, out: &mut dyn Write| {
            let _ = write!(out, "{}", rate(state.per_sec()));
        };
        bar.set_style(style.with_key("rate", rate));
    }
    bar
}

/// A rate as people read it: one digit behind the point.
fn rate(per_second: f64) -> String {
    format!("{per_second:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_has_one_digit_behind_the_point() {
        assert_eq!(rate(12.7345), "12.7");
        assert_eq!(rate(0.04), "0.0");
    }
}
