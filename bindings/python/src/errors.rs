//! Exceptions for the errors of core and simulation. `python/mppflight/errors.py` defines them.

use mpp_sim::flight::FlyError;
use mpp_sim::link::LinkError;
use mpp_sim::scenario::ScenarioError;
use pyo3::{PyErr, import_exception};
use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, TryLockError};

import_exception!(mppflight.errors, BusyError);
import_exception!(mppflight.errors, FlightError);
import_exception!(mppflight.errors, InputError);
import_exception!(mppflight.errors, SetUpError);
import_exception!(mppflight.errors, StateError);

/// A value that makes no sense.
pub(crate) fn input(error: impl Display) -> PyErr {
    InputError::new_err(error.to_string())
}

/// Something that was asked for too early or too late.
pub(crate) fn state(advice: &str) -> PyErr {
    StateError::new_err(advice.to_owned())
}

/// A core that cannot be set up.
pub(crate) fn set_up(error: impl Display) -> PyErr {
    SetUpError::new_err(error.to_string())
}

/// A scenario that cannot be flown.
pub(crate) fn scenario(error: ScenarioError) -> PyErr {
    input(error)
}

/// A flight without an outcome.
pub(crate) fn flight(error: FlyError) -> PyErr {
    match error {
        FlyError::Scenario(error) => scenario(error),
        FlyError::Trim(_) | FlyError::SetUp(_) | FlyError::Link(LinkError::Refused(_)) => {
            set_up(error)
        }
        FlyError::Link(_) | FlyError::Plant(_) => FlightError::new_err(error.to_string()),
    }
}

/// A core or a planner for this thread alone.
pub(crate) fn alone<'a, T>(guarded: &'a Mutex<T>, what: &str) -> Result<MutexGuard<'a, T>, PyErr> {
    guarded.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => BusyError::new_err(format!(
            "another thread uses this {what}: give each thread one of its own"
        )),
        TryLockError::Poisoned(_) => StateError::new_err(format!(
            "this {what} broke in an earlier call: make a new one"
        )),
    })
}
