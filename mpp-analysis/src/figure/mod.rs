//! Figures: counterparts of the paper's figures.
//!
//! [`flight_svg`] draws one flight, like Figure 7 of the paper: the flight through the field, true
//! to scale, and the motion over time below it. The other figures are one column wide: the
//! challenge scenes (Figure 1), the steps of a planning cycle (Figures 4 to 6) and success rates
//! (Figure 8). The same colour means the same thing in all figures.

mod axis;
mod challenge;
mod error;
mod field;
mod flight;
mod mark;
mod marks;
mod one_replan;
mod page;
mod palette;
mod panel;
mod process;
mod range;
mod strips;
mod success;

pub use challenge::challenge_svg;
pub use error::FigureError;
pub use flight::flight_svg;
pub use one_replan::{Candidate, OneReplan};
pub use process::{candidates_svg, rays_svg, scan_svg, trajectory_svg};
pub use success::{Rule, success_svg};

#[cfg(test)]
mod tests;
