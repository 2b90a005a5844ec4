//! Ctrl-C, and the end that a service manager asks for.

use super::answer::Failure;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What signals ask for: the first one an orderly end, the second one the end at once.
pub(super) struct Signals(Arc<AtomicUsize>);

impl Signals {
    /// From now on signals end nothing by themselves.
    pub(super) fn heed() -> Result<Self, Failure> {
        let raised = Arc::new(AtomicUsize::new(0));
        let listen = |signal: i32| -> io::Result<()> {
            let code = 128 + signal;
            let again = Arc::new(AtomicBool::new(false));
            flag::register_usize(signal, Arc::clone(&raised), code as usize)?;
            // In this order: at the first signal this does nothing yet.
            flag::register_conditional_shutdown(signal, code, Arc::clone(&again))?;
            flag::register(signal, again)?;
            Ok(())
        };
        listen(SIGINT)
            .and_then(|()| listen(SIGTERM))
            .map_err(|error| Failure::failed(format!("cannot heed signals: {error}")))?;
        Ok(Self(raised))
    }

    /// The exit code of the signal that came, if one did.
    pub(super) fn raised(&self) -> Option<u8> {
        let code = self.0.load(Ordering::Relaxed);
        u8::try_from(code).ok().filter(|code| *code > 0)
    }
}
