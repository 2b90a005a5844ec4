//! Analysis of simulated flights: recordings, benchmarks, checks, campaigns in numbers, pictures.
//!
//! These are the modules in the order in which data flows through them:
//!
//! ```text
//!                   recorded texts of the authors' code
//!                                  |
//!                                  v
//!            recording    instance --> check_reference
//!             |  |  |        |
//!             |  |  +-----> bench        ours beside others, on the same programs and cycles
//!  flights -->|  |
//!  (mpp-sim)  |  +---> picture           a flight as a page
//!             |
//!             +------> figure <-- campaign <-- rows of flights
//! ```
//!
//! * [`recording`]: records the planning cycles of a flight, to plan them again.
//! * [`instance`]: a candidate's program, as other solvers read it.
//! * [`check_reference`]: checks core and plant against data recorded from the authors' code.
//! * [`mod@bench`]: times our parts beside others.
//! * [`campaign`]: reports about many flights over a grid, with intervals; [`rows`]: the first line of a file of them.
//! * [`aircraft`]: what follows from an aircraft file before any flight.
//! * [`ceiling`]: which fields can be passed at all, proven either way.
//! * [`figure`]: counterparts of the paper's figures; [`picture`]: pages for a browser.
//!
//! The caller reads and writes the files, and runs the threads if there are any.

pub mod recording;

pub mod instance;

pub mod check_reference;

pub mod bench;

pub mod campaign;

pub mod rows;

pub mod aircraft;

pub mod ceiling;

pub mod figure;

pub mod closest;

pub mod picture;
