//! Long work on a thread of its own, while Python runs on and hears Ctrl-C.

use crate::errors::FlightError;
use mpp_sim::space::STACK;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

/// Time between two looks at the signals [s]: a person does not notice it, and it costs nothing.
const PATIENCE: Duration = Duration::from_millis(50);

/// Does some work without the lock of the interpreter. The work gets a flag that is set when Python has a signal
/// whose handler raised, for example `KeyboardInterrupt`; it should then end soon.
pub(crate) fn aside<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    let stop = &AtomicBool::new(false);
    scope(|scope| {
        let (send, mut receive) = channel();
        // Threads of Python may have a small stack.
        let builder = Builder::new().stack_size(STACK);
        builder.spawn_scoped(scope, move || {
            // Nobody listens after a signal.
            let _ = send.send(work(stop));
        })?;
        loop {
            let got;
            (receive, got) = py.detach(move || {
                let got = receive.recv_timeout(PATIENCE);
                (receive, got)
            });
            match got {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(FlightError::new_err("the flight broke: please report this"));
                }
            }
            if let Err(signal) = py.check_signals() {
                stop.store(true, Ordering::Relaxed);
                return Err(signal);
            }
        }
    })
}
