//! The core as another process, over two FIFOs.

use hil_protocol::{Decoder, MAX_FRAME, Message, encode};
use mpp_sim::link::{Link, LinkError};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;

/// Two FIFOs in one directory: `to-core` and `to-harness`. A core that dies closes its end. The
/// link waits for a core that hangs.
pub struct FifoLink {
    to_core: File,
    to_harness: File,
    decoder: Decoder,
    received: Vec<u8>,
    used: usize,
}

impl FifoLink {
    /// Opens both FIFOs. Waits until the core has opened them too.
    ///
    /// # Errors
    /// [`LinkError::Io`] when they are not there.
    pub fn open(directory: &Path) -> Result<Self, LinkError> {
        let open = |name: &str, options: &OpenOptions| {
            let path = directory.join(name);
            options
                .open(&path)
                .map_err(|error| LinkError::Io(format!("opening {}", path.display()), error))
        };
        // The FIFOs are opened in the core's order, because each end waits for the other one.
        let to_core = open("to-core", OpenOptions::new().write(true))?;
        let to_harness = open("to-harness", OpenOptions::new().read(true))?;
        Ok(Self {
            to_core,
            to_harness,
            decoder: Decoder::new(),
            received: Vec::new(),
            used: 0,
        })
    }
}

impl Link for FifoLink {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = encode(message, &mut buffer)?;
        self.to_core
            .write_all(frame)
            .map_err(|error| LinkError::Io("sending to the core's FIFO".to_owned(), error))
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        loop {
            while let Some(byte) = self.received.get(self.used) {
                self.used += 1;
                match self.decoder.push(*byte) {
                    None => {}
                    Some(Ok(message)) => return Ok(message),
                    Some(Err(error)) => return Err(LinkError::Frame(error)),
                }
            }
            self.used = 0;
            self.received.resize(4096, 0);
            let count = self.to_harness.read(&mut self.received).map_err(|error| {
                LinkError::Io(format!("waiting for {awaited} from the core's FIFO"), error)
            })?;
            self.received.truncate(count);
            if count == 0 {
                let awaited = format!("{awaited} from the core's FIFO");
                return Err(LinkError::Closed { awaited });
            }
        }
    }
}
