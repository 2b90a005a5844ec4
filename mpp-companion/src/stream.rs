//! Ways that end when the other side goes, and are opened anew.

use crate::port::Port;
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Both ends of a stream.
pub(crate) type Ends = (Box<dyn Read + Send>, Box<dyn Write + Send>);

/// How often a stream is opened anew before the companion ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tries {
    most: u32,
    pause: Duration,
}

impl Tries {
    /// A minute.
    pub(crate) const USUAL: Self = Self {
        most: 60,
        pause: Duration::from_secs(1),
    };
}

/// A way by a stream that is opened now, and again whenever it ends. Meanwhile nothing comes, and what is sent is lost.
///
/// # Errors
/// When the stream cannot be opened now.
pub(crate) fn lasting(
    name: &str,
    tries: Tries,
    open: impl Fn() -> Result<Ends> + Send + 'static,
) -> Result<Port> {
    let (mut read, write) = open()?;
    let end = Arc::new(Mutex::new(Some(write)));
    let own = Arc::clone(&end);
    let name = name.to_owned();
    Ok(Port {
        read: Box::new(move |buffer| {
            match read.read(buffer) {
                Ok(size) if size > 0 => return Ok(size),
                Err(error) if error.kind() == ErrorKind::Interrupted => return Ok(0),
                _ => {}
            }
            *own.lock().unwrap_or_else(PoisonError::into_inner) = None;
            println!("{name} has ended");
            let (again, write) = reopen(&name, tries, &open)?;
            read = again;
            *own.lock().unwrap_or_else(PoisonError::into_inner) = Some(write);
            Ok(0)
        }),
        write: Box::new(move |frame| {
            let mut end = end.lock().unwrap_or_else(PoisonError::into_inner);
            end.as_mut().map_or(Ok(()), |end| end.write_all(frame))
        }),
    })
}

fn reopen(name: &str, tries: Tries, open: &impl Fn() -> Result<Ends>) -> Result<Ends> {
    let mut last = Error::from(ErrorKind::NotConnected);
    for number in 1..=tries.most {
        std::thread::sleep(tries.pause);
        match open() {
            Ok(ends) => {
                println!("{name} is open again after {number} tries");
                return Ok(ends);
            }
            Err(error) => {
                println!("{name}, try {number} of {}: {error}", tries.most);
                last = error;
            }
        }
    }
    Err(last)
}

/// A TCP connection. One over which nothing comes for 5 s has ended: an autopilot sends a heartbeat each second.
pub(crate) fn tcp(peer: &str) -> Result<Ends> {
    let refused = || Error::new(ErrorKind::InvalidInput, "give a host and a port");
    let address = peer.to_socket_addrs()?.next().ok_or_else(refused)?;
    let stream = TcpStream::connect_timeout(&address, Duration::from_secs(3))?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(Duration::from_secs(5)))?;
    // A peer that takes nothing must not hold up the companion.
    stream.set_write_timeout(Some(Duration::from_millis(20)))?;
    Ok((Box::new(stream.try_clone()?), Box::new(stream)))
}

/// A serial port that passes each byte as it is: 8 bits, no parity, no control of the flow.
#[cfg(unix)]
pub(crate) fn serial(device: &str, baud: u32) -> Result<Ends> {
    use rustix::fs::{Mode, OFlags, fcntl_setfl, open};
    use rustix::termios::{ControlModes, OptionalActions, tcgetattr, tcsetattr};
    // A port with the lines of a modem would wait for its carrier.
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
    let port = open(device, flags | OFlags::NONBLOCK, Mode::empty())?;
    let mut line = tcgetattr(&port)?;
    line.make_raw();
    line.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
    line.control_modes -= ControlModes::CRTSCTS | ControlModes::CSTOPB;
    line.set_speed(baud)?;
    tcsetattr(&port, OptionalActions::Now, &line)?;
    let given = tcgetattr(&port)?.output_speed();
    // A receiver bears 3 %.
    if given.abs_diff(baud) > baud / 33 {
        let text = format!("the port makes {given} of {baud} baud: give a speed that it has");
        return Err(Error::new(ErrorKind::InvalidInput, text));
    }
    fcntl_setfl(&port, OFlags::RDWR)?;
    let port = std::fs::File::from(port);
    Ok((Box::new(port.try_clone()?), Box::new(port)))
}

/// There is none.
#[cfg(not(unix))]
pub(crate) fn serial(_: &str, _: u32) -> Result<Ends> {
    let text = "serial ports are there on Linux and macOS: give a way by UDP or TCP";
    Err(Error::new(ErrorKind::Unsupported, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    const BRIEF: Tries = Tries {
        most: 3,
        pause: Duration::from_millis(1),
    };

    /// ArduPlane's simulation waits for a client.
    #[test]
    fn a_connection_that_ended_is_opened_again_and_tries_are_bounded() {
        let waits = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("tcp:{}", waits.local_addr().unwrap());
        let Port {
            mut read,
            mut write,
        } = Port::open(&address, BRIEF).unwrap();
        let mut buffer = [0; 8];
        for _ in 0..2 {
            let (mut peer, _) = waits.accept().unwrap();
            peer.write_all(b"beat").unwrap();
            assert_eq!(read(&mut buffer).unwrap(), 4);
            write(b"set").unwrap();
            assert_eq!(peer.read(&mut buffer).unwrap(), 3);
            drop(peer);
            assert_eq!(read(&mut buffer).unwrap(), 0);
        }
        drop(waits);
        assert!(read(&mut buffer).is_err());
        assert!(write(b"lost").is_ok());
    }

    /// A pseudo terminal is a serial port whose other end a program holds.
    #[cfg(unix)]
    #[test]
    fn a_serial_port_passes_each_byte_as_it_is_and_its_loss_is_bounded_too() {
        use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
        let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&end).unwrap();
        unlockpt(&end).unwrap();
        let name = ptsname(&end, Vec::new()).unwrap();
        let address = format!("serial:{}:57600", name.to_str().unwrap());
        let Port {
            mut read,
            mut write,
        } = Port::open(&address, BRIEF).unwrap();
        let mut autopilot = std::fs::File::from(end);
        let all: Vec<u8> = (0..=255).collect();
        autopilot.write_all(&all).unwrap();
        let (mut buffer, mut come) = ([0; 300], Vec::new());
        while come.len() < all.len() {
            let size = read(&mut buffer).unwrap();
            come.extend_from_slice(&buffer[..size]);
        }
        assert_eq!(come, all);
        write(&all).unwrap();
        let mut sent = [0; 256];
        autopilot.read_exact(&mut sent).unwrap();
        assert_eq!(sent.to_vec(), all);
        drop(autopilot);
        assert!(read(&mut buffer).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_bad_speed_and_a_device_that_is_not_there_are_refused_with_advice() {
        for (address, advice) in [
            ("serial:/dev/none:57600", "/dev/serial/by-id"),
            ("serial:/dev/null:57600", "/dev/serial/by-id"),
            ("serial:/dev/none:57k", "serial:DEVICE:BAUD"),
            ("serial:/dev/none:0", "1200 to 4000000 baud"),
            ("serial:/dev/none", "serial:DEVICE:BAUD"),
        ] {
            let refused = Port::open(address, BRIEF).err().unwrap().to_string();
            assert!(refused.contains(advice), "{refused}");
        }
    }
}
